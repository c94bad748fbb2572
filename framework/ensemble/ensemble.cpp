// An ensemble from its beginning to its end: checked, resumed, run, joined.
#include <hamel/framework/ensemble/ensemble.hpp>

#include <algorithm>
#include <chrono>
#include <memory>
#include <mutex>
#include <utility>

#include <fmt/format.h>

#include <hamel/framework/ensemble/collector.hpp>
#include <hamel/framework/ensemble/lane_members.hpp>
#include <hamel/framework/batch/shards.hpp>
#include <hamel/framework/batch/workers.hpp>

namespace hamel {
namespace {

using ensemble::Collector;
using ensemble::kPiece;
using ensemble::Piece;

using Clock = std::chrono::steady_clock;
double seconds_since(Clock::time_point begin) {
  return std::chrono::duration<double>(Clock::now() - begin).count();
}

JournalSubject subject_of(const EnsembleConfig& config) {
  return {"ensemble", "members", config.fingerprint()};
}

// The first member of a shard; of the one behind the last, the number of members.
long first_of(const Shard& part, long members) {
  return std::min(members, kPiece * first_piece(part, ensemble::pieces_of(members)));
}
long behind(const Shard& part, long members) {
  return part.index == part.count ? members : first_of({part.index + 1, part.count}, members);
}

// The pieces that are not there yet, over threads.
class Session {
 public:
  Session(const ensemble::Plan& plan, Collector& collector, EnsembleResult& result,
          JournalFile* journal, const std::function<void(double)>& progress,
          const std::atomic<bool>* stop, bool lanes)
      : plan_(plan),
        collector_(collector),
        result_(result),
        journal_(journal),
        progress_(progress),
        stop_(stop),
        lanes_(lanes),
        done_(result.done) {}

  void run() {
    report(0);
    workers_.run(result_.threads, [this](int) { work(); });
  }

 private:
  void work() {
    ensemble::LaneMembers members(plan_, lanes_, stop_);
    for (long i = next_++; i < collector_.pieces() && !workers_.failed(); i = next_++) {
      const long number = collector_.first_piece() + i;
      if (collector_.has(number)) continue;
      Piece piece{number * kPiece, {}, {}};
      const long count = std::min(kPiece, result_.first + result_.members - piece.first);
      piece.rows.resize(static_cast<size_t>(count) * plan_.kept->width());
      if (!members.run(piece.first, piece.rows, piece.failures)) return;
      if (journal_ != nullptr) journal_->append(ensemble::line_of(piece));
      collector_.take(piece);
      report(count);
    }
  }
  void report(long members) {
    done_ += members;
    const std::unique_lock lock(reporting_, std::try_to_lock);
    if (progress_ && lock)
      progress_(static_cast<double>(done_) / static_cast<double>(std::max(result_.members, 1L)));
  }

  const ensemble::Plan& plan_;
  Collector& collector_;
  EnsembleResult& result_;
  JournalFile* journal_;
  const std::function<void(double)>& progress_;
  const std::atomic<bool>* stop_;
  bool lanes_;
  Workers workers_;
  std::atomic<long> next_ = 0, done_;
  std::mutex reporting_;
};

}  // namespace

Ensemble::Ensemble(const Registry& registry, EnsembleConfig config)
    : registry_(&registry), config_(std::move(config)) {
  std::vector<std::string> mistakes;
  ensemble::read_data(config_);
  ensemble::Plan(registry, config_, mistakes);
  if (!mistakes.empty()) throw ConfigError(mistakes);
}

Ensemble& Ensemble::threads(int count) {
  threads_ = count;
  return *this;
}
Ensemble& Ensemble::lanes(bool use) {
  lanes_ = use;
  return *this;
}
Ensemble& Ensemble::folder(std::string path) {
  folder_ = std::move(path);
  return *this;
}
Ensemble& Ensemble::shard(Shard part) {
  shard_ = checked(part);
  return *this;
}
Ensemble& Ensemble::fresh(bool forget) {
  fresh_ = forget;
  return *this;
}
Ensemble& Ensemble::progress(std::function<void(double)> report) {
  progress_ = std::move(report);
  return *this;
}
Ensemble& Ensemble::stop(const std::atomic<bool>* flag) {
  stop_ = flag;
  return *this;
}

EnsembleResult Ensemble::begun(Shard part) const {
  EnsembleResult out;
  out.config = config_;
  out.shard = part;
  out.first = first_of(part, config_.members);
  out.members = behind(part, config_.members) - out.first;
  out.threads = threads_or_cores(threads_);
  return out;
}

EnsembleResult Ensemble::run() const {
  const auto begin = Clock::now();
  if (shard_.count > 1 && folder_.empty())
    throw ConfigError({"shard: a part needs a folder for its journal"});
  EnsembleConfig config = config_;
  std::vector<std::string> mistakes;
  const ensemble::Plan plan(*registry_, config, mistakes);
  if (!mistakes.empty()) throw ConfigError(mistakes);
  EnsembleResult result = begun(shard_);
  Collector collector(plan, result);
  std::unique_ptr<JournalFile> journal;
  if (!folder_.empty()) {
    journal = std::make_unique<JournalFile>(folder_, journal_name(shard_),
                                            subject_of_part(subject_of(config_), shard_), fresh_);
    result.notes =
        journal->read([&](const std::string& line) { collector.take(ensemble::piece_of(line)); });
  }
  result.resumed = result.done;
  Session(plan, collector, result, journal.get(), progress_, stop_, lanes_).run();
  collector.finish();
  result.seconds = seconds_since(begin);
  return result;
}

EnsembleResult Ensemble::merge() const {
  const auto begin = Clock::now();
  EnsembleConfig config = config_;
  std::vector<std::string> mistakes;
  const ensemble::Plan plan(*registry_, config, mistakes);
  if (!mistakes.empty()) throw ConfigError(mistakes);
  const long count = shards_in(folder_);
  EnsembleResult result = begun({1, 1});
  Collector collector(plan, result);
  long before = 0;
  result.notes = join_shards(
      folder_, count, subject_of(config_),
      [&](const std::string& line) { collector.take(ensemble::piece_of(line)); },
      [&](const Shard& part) -> std::string {
        const long done = result.done - std::exchange(before, result.done),
                   expected = behind(part, config.members) - first_of(part, config.members);
        return done == expected ? "" : fmt::format("{} of {} members", done, expected);
      });
  collector.finish();
  result.shards = count;
  result.seconds = seconds_since(begin);
  return result;
}

Member Ensemble::member(long index) const {
  if (index < 0 || index >= config_.members)
    throw ConfigError(
        {fmt::format("member: got {}, expected 0 to {}", index, config_.members - 1)});
  EnsembleConfig config = config_;
  std::vector<std::string> mistakes;
  const ensemble::Plan plan(*registry_, config, mistakes);
  if (!mistakes.empty()) throw ConfigError(mistakes);
  ensemble::MemberRunner runner(plan, stop_);
  Member out;
  out.index = index;
  std::vector<double> row(plan.kept->width());
  runner.run(index, row, out.failure);
  out.failed = !out.failure.reason.empty();
  for (const size_t v : plan.variations->numbered())
    out.varied.emplace_back(plan.variations->all()[v].name, plan.variations->number(v, index));
  const size_t shown = plan.kept->kept() + (config.classes.names.empty() ? 0 : 1);
  for (size_t i = 0; i < shown; ++i) out.kept.emplace_back(plan.kept->columns()[i].name, row[i]);
  try {
    out.config = runner.config(index);
  } catch (const ConfigError&) {  // the reason of its failure
  }
  return out;
}

}  // namespace hamel
