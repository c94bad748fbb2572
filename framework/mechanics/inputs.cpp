#include <hamel/framework/mechanics/inputs.hpp>

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace hamel {
namespace {

// The piece of a table at t; before and behind it the first and the last.
std::size_t piece_at(const InputTable& table, double t) {
  const auto after = std::upper_bound(table.times.begin(), table.times.end(), t);
  const auto piece = std::max<std::ptrdiff_t>(after - table.times.begin() - 1, 0);
  const auto last = static_cast<std::ptrdiff_t>(table.times.size()) - (table.hold ? 1 : 2);
  return static_cast<std::size_t>(std::min(piece, std::max<std::ptrdiff_t>(last, 0)));
}

double line(const InputTable& table, std::size_t i, double t) {
  const double part = (t - table.times[i]) / (table.times[i + 1] - table.times[i]);
  return table.values[i] + part * (table.values[i + 1] - table.values[i]);
}

// Does a step lie within a piece, up to round-off in the times of its nodes?
bool within(const InputTable& table, std::size_t i, double t, double h) {
  if (table.times.size() == 1) return false;
  const double close = 1e-12 * (1 + std::abs(t));
  return std::min(t, t + h) >= table.times[i] - close &&
         std::max(t, t + h) <= table.times[i + 1] + close;
}

constexpr double infinite = std::numeric_limits<double>::infinity();

}  // namespace

double InputTable::at(double t) const {
  if (times.size() < 2) return values.front();
  const std::size_t i = piece_at(*this, t);
  return hold ? values[i] : line(*this, i, std::clamp(t, times.front(), times.back()));
}

Inputs::Inputs(std::vector<InputField> fields, std::vector<InputTable> tables)
    : fields_(std::move(fields)),
      tables_(std::move(tables)),
      pieces_(tables_.size()),
      smooth_(tables_.size()),
      now_(static_cast<Eigen::Index>(tables_.size())) {
  assert(tables_.size() == fields_.size() && fields_.size() <= kMostInputs);
  for (std::size_t i = 0; i < tables_.size(); ++i)
    now_[static_cast<Eigen::Index>(i)] = tables_[i].values.front();
  find_cover();
}

void Inputs::enter(double t, double h) {
  for (std::size_t i = 0; i < tables_.size(); ++i) {
    const InputTable& table = tables_[i];
    if (table.times.empty()) continue;
    const std::size_t piece = piece_at(table, t + h / 2);
    smooth_[i] = !table.hold && within(table, piece, t, h);
    if (piece == pieces_[i]) continue;
    pieces_[i] = piece;
    ++changes_;
    if (table.hold) now_[static_cast<Eigen::Index>(i)] = table.values[piece];
  }
}

InputValues Inputs::at(double t) const {
  InputValues out = now_;
  for (std::size_t i = 0; i < tables_.size(); ++i) {
    const InputTable& table = tables_[i];
    if (table.times.empty() || table.hold) continue;
    out[static_cast<Eigen::Index>(i)] = smooth_[i] ? line(table, pieces_[i], t) : table.at(t);
  }
  return out;
}

InputValues Inputs::slopes_at(double t) const {
  InputValues out = InputValues::Zero(now_.size());
  for (std::size_t i = 0; i < tables_.size(); ++i) {
    const InputTable& table = tables_[i];
    if (table.times.size() < 2 || table.hold) continue;
    if (!smooth_[i] && (t < table.times.front() || t > table.times.back())) continue;
    const std::size_t piece = smooth_[i] ? pieces_[i] : piece_at(table, t);
    out[static_cast<Eigen::Index>(i)] = (table.values[piece + 1] - table.values[piece]) /
                                        (table.times[piece + 1] - table.times[piece]);
  }
  return out;
}

void Inputs::set(std::size_t input, double value) {
  tables_[input] = {{}, {value}};
  smooth_[input] = false;
  now_[static_cast<Eigen::Index>(input)] = value;
  ++changes_;
  find_cover();
}

double Inputs::next_break(double t, double h) const {
  const double sign = h < 0 ? -1 : 1;
  const double beyond =
      t + sign * 1e-12 * (1 + std::abs(t));  // t itself, as round-off has it, is past
  double next = sign * infinite;
  for (const InputTable& table : tables_) {
    if (table.times.size() < 2) continue;
    const auto first = table.times.begin() + 1, last = table.times.end() - (table.hold ? 0 : 1);
    if (h < 0) {
      const auto at = std::lower_bound(first, last, beyond);
      if (at != first) next = std::max(next, *(at - 1));
    } else {
      const auto at = std::upper_bound(first, last, beyond);
      if (at != last) next = std::min(next, *at);
    }
  }
  return next;
}

void Inputs::find_cover() {
  first_ = -infinite, last_ = infinite;
  breaks_ = false;
  for (const InputTable& table : tables_) {
    if (table.times.empty()) continue;
    breaks_ = breaks_ || table.times.size() > 1;
    first_ = std::max(first_, table.times.front());
    last_ = std::min(last_, table.times.back());
  }
}

}  // namespace hamel
