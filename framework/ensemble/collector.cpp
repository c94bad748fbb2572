#include <hamel/framework/ensemble/collector.hpp>

#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>
#include <stdexcept>

#include <fmt/format.h>
#include <nlohmann/json.hpp>

namespace hamel::ensemble {
namespace {

using Json = nlohmann::ordered_json;

// Numbers by their bits, so that they come back as they were.
std::string hex_of(const std::vector<double>& values) {
  constexpr const char* digits = "0123456789abcdef";
  std::string out;
  out.reserve(16 * values.size());
  for (const double x : values) {
    const auto bits = std::bit_cast<uint64_t>(x);
    for (int shift = 60; shift >= 0; shift -= 4) out += digits[bits >> shift & 15];
  }
  return out;
}

std::vector<double> numbers_of(const std::string& hex) {
  std::vector<double> out;
  if (hex.size() % 16 != 0) throw std::runtime_error("a number is cut");
  for (size_t at = 0; at < hex.size(); at += 16) {
    uint64_t bits = 0;
    for (size_t i = at; i < at + 16; ++i) {
      const char c = hex[i];
      const bool digit = c >= '0' && c <= '9', letter = c >= 'a' && c <= 'f';
      if (!digit && !letter) throw std::runtime_error("no number");
      bits = bits << 4 | static_cast<uint64_t>(digit ? c - '0' : c - 'a' + 10);
    }
    out.push_back(std::bit_cast<double>(bits));
  }
  return out;
}

// Conversion of 1e300 would be undefined.
long member_of(const Json& json) {
  if (!json.is_number_integer()) throw std::runtime_error("no piece of this ensemble");
  return json.get<long>();
}

}  // namespace

std::string line_of(const Piece& piece) {
  Json failures = Json::array();
  for (const MemberFailure& f : piece.failures)
    failures.push_back({f.member, hex_of({f.time}), f.reason});
  return fmt::format(R"({{"first":{},"rows":"{}","failures":{}}})", piece.first, hex_of(piece.rows),
                     failures.dump(-1, ' ', false, Json::error_handler_t::replace));
}

Piece piece_of(const std::string& line) {
  const Json json = Json::parse(line);
  Piece out{member_of(json.at("first")), numbers_of(json.at("rows").get<std::string>()), {}};
  for (const Json& f : json.at("failures")) {
    const std::vector<double> time = numbers_of(f.at(1).get<std::string>());
    if (time.size() != 1) throw std::runtime_error("a failure without its time");
    out.failures.push_back({member_of(f.at(0)), time[0], f.at(2).get<std::string>()});
  }
  return out;
}

Collector::Collector(const Plan& plan, EnsembleResult& result)
    : plan_(plan),
      result_(result),
      width_(plan.kept->width()),
      kept_(plan.kept->kept()),
      table_at_(plan.variations->numbered().size()),
      has_class_(!plan.config.classes.names.empty()),
      first_piece_(result.first / kPiece),
      there_(static_cast<size_t>(pieces_of(result.members))) {
  const auto members = static_cast<size_t>(result.members);
  auto& columns = result.table.columns;
  for (const size_t v : plan.variations->numbered()) {
    const Target& target = plan.variations->targets()[v];
    columns.push_back({plan.variations->all()[v].name, target.unit, "varied: " + target.meaning,
                       std::vector<double>()});
  }
  for (size_t i = 0; i < kept_; ++i) {
    const KeptColumn& column = plan.kept->columns()[i];
    result.kept.push_back(column.name);
    columns.push_back(
        {column.name, column.unit, column.meaning, std::vector<double>(members, kMissing)});
  }
  if (has_class_) {
    std::string meaning = "-1: none";
    const std::vector<std::string>& names = plan.config.classes.names;
    for (size_t i = 0; i < names.size(); ++i) meaning += fmt::format(", {}: {}", i, names[i]);
    columns.push_back({"class", "1", meaning, std::vector<long long>(members, -1)});
  }
  if (result.shard.count == 1) hidden_ = width_ - kept_ - (has_class_ ? 1 : 0);
  chunks_.assign(hidden_,
                 std::vector<Moments>(static_cast<size_t>((result.members + kChunk - 1) / kChunk)));
}

// Its failures are of its members, and its classes have names.
bool Collector::in_range(const Piece& piece, long count) const {
  for (const MemberFailure& failure : piece.failures)
    if (failure.member < piece.first || failure.member >= piece.first + count) return false;
  if (!has_class_) return true;
  const auto classes = static_cast<double>(plan_.config.classes.names.size());
  for (size_t i = kept_; i < piece.rows.size(); i += width_) {
    const double x = piece.rows[i];
    if (std::isfinite(x) && !(x >= 0 && x < classes && x == std::floor(x))) return false;
  }
  return true;
}

void Collector::take(const Piece& piece) {
  const long number = piece.first / kPiece, count = piece.count(width_);
  const long at = piece.first - result_.first;
  const bool mine = piece.first % kPiece == 0 && number >= first_piece_ &&
                    number < first_piece_ + static_cast<long>(there_.size());
  if (!mine || piece.rows.size() != static_cast<size_t>(count) * width_ ||
      count != std::min(kPiece, result_.members - at) || !in_range(piece, count))
    throw std::runtime_error("no piece of this ensemble");
  char& there = there_[static_cast<size_t>(number - first_piece_)];
  if (there != 0) return;
  for (size_t k = 0; k < static_cast<size_t>(count); ++k) {
    const double* row = piece.rows.data() + k * width_;
    const size_t to = static_cast<size_t>(at) + k;
    for (size_t i = 0; i < kept_; ++i)
      std::get<0>(result_.table.columns[table_at_ + i].values)[to] = row[i];
    if (has_class_ && std::isfinite(row[kept_]))
      std::get<1>(result_.table.columns[table_at_ + kept_].values)[to] =
          static_cast<long long>(row[kept_]);
  }
  const std::lock_guard lock(mutex_);
  there = 1;
  result_.done += count;
  result_.failures.insert(result_.failures.end(), piece.failures.begin(), piece.failures.end());
  if (hidden_ > 0) follow_chunk(piece);
}

// A chunk is measured when all its members are there, whatever order they came in.
void Collector::follow_chunk(const Piece& piece) {
  const long number = piece.first / kChunk, first = number * kChunk;
  const long members = std::min(kChunk, result_.members - first);
  Chunk& chunk = open_[number];
  if (chunk.columns.empty())
    chunk.columns.assign(hidden_, std::vector<double>(static_cast<size_t>(members), kMissing));
  const long count = piece.count(width_);
  for (long k = 0; k < count; ++k)
    for (size_t i = 0; i < hidden_; ++i)
      chunk.columns[i][static_cast<size_t>(piece.first - first + k)] =
          piece.rows[static_cast<size_t>(k) * width_ + width_ - hidden_ + i];
  chunk.members += count;
  if (chunk.members < members) return;
  for (size_t i = 0; i < hidden_; ++i)
    chunks_[i][static_cast<size_t>(number)] = moments_of(chunk.columns[i]);
  open_.erase(number);
}

// The reasons by their first members, from 1; 0 of a member that is good.
void Collector::name_failures() {
  std::ranges::sort(result_.failures, {}, &MemberFailure::member);
  std::vector<long long> numbers(static_cast<size_t>(result_.members));
  std::vector<std::string> reasons;
  constexpr size_t most = 1000;
  for (const MemberFailure& failure : result_.failures) {
    auto it = std::ranges::find(reasons, failure.reason);
    if (it == reasons.end() && reasons.size() < most) {
      reasons.push_back(failure.reason);
      it = reasons.end() - 1;
    }
    const auto number = std::min(static_cast<size_t>(it - reasons.begin()), most - 1) + 1;
    numbers.at(static_cast<size_t>(failure.member - result_.first)) =
        static_cast<long long>(number);
  }
  std::string meaning = "0: none";
  for (size_t i = 0; i < std::min<size_t>(reasons.size(), 20); ++i)
    meaning += fmt::format("; {}: {}", i + 1, reasons[i]);
  result_.table.columns.push_back({"failure", "1", meaning, std::move(numbers)});
}

void Collector::fill_varied() {
  const std::vector<size_t>& numbered = plan_.variations->numbered();
  for (size_t i = 0; i < numbered.size(); ++i) {
    auto& values = std::get<0>(result_.table.columns[i].values);
    values.resize(static_cast<size_t>(result_.members));
    for (long k = 0; k < result_.members; ++k)
      values[static_cast<size_t>(k)] = plan_.variations->number(numbered[i], result_.first + k);
  }
}

void Collector::finish() {
  name_failures();
  fill_varied();
  std::vector<std::span<const double>> kept;
  for (size_t i = 0; i < kept_; ++i) {
    const TableColumn& column = result_.table.columns[table_at_ + i];
    const auto& values = std::get<0>(column.values);
    kept.emplace_back(values);
    const Moments moments = moments_of_column(values, result_.first);
    result_.moments[column.name] = moments;
    if (const auto it = plan_.config.histograms.find(column.name);
        it != plan_.config.histograms.end())
      result_.histograms[column.name] = histogram_of(values, it->second, moments);
    if (plan_.config.quantiles.empty()) continue;
    std::vector<double> sorted;
    std::ranges::copy_if(values, std::back_inserter(sorted), [](double x) { return x == x; });
    std::ranges::sort(sorted);
    for (const double part : plan_.config.quantiles)
      result_.quantiles[column.name].push_back(quantile(sorted, part));
  }
  if (plan_.config.covariance) result_.covariance = covariance_of(kept, result_.first);
  result_.class_counts.assign(plan_.config.classes.names.size(), 0);
  if (has_class_)
    for (const long long c : std::get<1>(result_.table.columns[table_at_ + kept_].values))
      if (c >= 0) ++result_.class_counts[static_cast<size_t>(c)];
  if (hidden_ == 0) return;
  const std::vector<std::string>& names = plan_.kept->quantities();
  for (size_t i = 0; i < hidden_; ++i) {
    const size_t time = i / names.size(), quantity = i % names.size();
    if (quantity == 0) result_.statistics.push_back({plan_.config.statistics_at[time], {}});
    result_.statistics.back().quantities.emplace_back(names[quantity],
                                                      joined(std::move(chunks_[i])));
  }
}

}  // namespace hamel::ensemble
