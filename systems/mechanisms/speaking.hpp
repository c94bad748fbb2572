// A mechanism with its words, and what it says of a start. Not installed.
#pragma once

#include <algorithm>
#include <cmath>
#include <functional>
#include <memory>
#include <numbers>
#include <string>
#include <utility>
#include <vector>

#include <fmt/format.h>

#include <hamel/framework/mechanics/motion_words.hpp>
#include <hamel/systems/mechanisms/poses.hpp>
#include <hamel/systems/mechanisms/starts.hpp>

namespace hamel::mechanisms {

// A signal of a part, and how messages call it.
struct Watched {
  std::string what;
  Signal value;
};

// A coordinate with a prescribed value.
struct Held {
  std::string what;
  size_t column;
  bool turns;  // a hinge
  std::function<double(double t)> value;
};

// What a run is not to start without.
struct AtStart {
  std::vector<Said> rows;    // of all_rows(): those that are kept independent
  std::vector<int> dropped;  // of these: agree with those that are kept
  std::vector<Watched> signals;
  std::vector<Held> held;
};

// With its words; a run starts where its signals have values and where it is prescribed to be.
class Speaking final : public Multibody, public Worded {
 public:
  Speaking(const Multibody& system, MotionWords words, AtStart at_start,
           std::shared_ptr<const Inputs> inputs)
      : Multibody(system),
        words_(std::move(words)),
        at_start_(std::move(at_start)),
        inputs_(std::move(inputs)) {}
  const MotionWords& words() const override { return words_; }
  std::vector<std::string> mistakes_at(double t, const double* g, ConstVector xi) const override {
    std::vector<double> x(static_cast<size_t>(geometry().columns()));
    geometry().coordinates(g, x.data());
    const InputValues u = inputs_ == nullptr ? InputValues() : inputs_->at(t);
    const auto count = [](const auto& v) { return static_cast<size_t>(v.size()); };
    const Now now{t, x, {xi.data(), count(xi)}, {u.data(), count(u)}};
    std::vector<std::string> out;
    for (const Watched& signal : at_start_.signals) {
      if (const double value = signal.value(now); !std::isfinite(value))
        out.push_back(fmt::format("{} is {} at the start", signal.what, value));
    }
    for (const Held& held : at_start_.held) {
      const double value = held.value(t), apart = x[held.column] - value;
      // The start may be the last state of a run, whose scheme keeps the angle to its order.
      if (!(std::abs(held.turns ? std::remainder(apart, 2 * std::numbers::pi) : apart) < 0.01))
        out.push_back(fmt::format("{} is prescribed as {} at t = {}, but {} at the start",
                                  held.what, value, t, x[held.column]));
    }
    const std::vector<double> place(g, g + drawn().size());
    for (const auto& [row, repeat] : repeated_rows(*this, place, kept(), {t})) {
      const std::string beyond = in_words(repeat.others, at_start_.rows);
      const Said& said = at_start_.rows[static_cast<size_t>(row)];
      if (repeat.contradicts)
        out.push_back(fmt::format("{}{} at the start; start elsewhere, or leave one of them out",
                                  said.where, contradiction(said, beyond)));
      else if (beyond.empty())
        out.push_back(
            fmt::format("{}{} says nothing at the start; start elsewhere, or leave it out",
                        said.where, said.what));
      else
        out.push_back(
            fmt::format("{}{} says nothing beyond {} at the start; start elsewhere, or take a part "
                        "with fewer rows (a roller for a wheel)",
                        said.where, said.what, beyond));
    }
    add_contradictions(t, place, out);
    return out;
  }

 private:
  // Of rows that were dropped, at this place and time.
  void add_contradictions(double t, const std::vector<double>& place,
                          std::vector<std::string>& out) const {
    if (at_start_.dropped.empty()) return;
    std::vector<int> all = kept();
    all.insert(all.end(), at_start_.dropped.begin(), at_start_.dropped.end());
    std::sort(all.begin(), all.end());
    for (const auto& [row, repeat] : repeated_rows(*this, place, all, {t})) {
      const Said& said = at_start_.rows[static_cast<size_t>(row)];
      if (repeat.contradicts && std::ranges::count(at_start_.dropped, row) > 0)
        out.push_back(fmt::format("{}{} at t = {}; leave one of them out", said.where,
                                  contradiction(said, in_words(repeat.others, at_start_.rows)), t));
    }
  }

  MotionWords words_;
  AtStart at_start_;
  std::shared_ptr<const Inputs> inputs_;
};

}  // namespace hamel::mechanisms
