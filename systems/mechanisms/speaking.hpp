// A mechanism with its words, and what it says of a start. Not installed.
#pragma once

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
  std::vector<Said> rows;  // of all_rows(): those that are kept independent
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
    for (const auto& [row, others] : repeated_rows(*this, place, kept())) {
      std::vector<std::string> beyond;
      for (const int other : others)
        beyond.push_back(at_start_.rows[static_cast<size_t>(other)].what);
      const Said& said = at_start_.rows[static_cast<size_t>(row)];
      out.push_back(
          beyond.empty()
              ? fmt::format("{}{} says nothing at the start; start elsewhere, or leave it out",
                            said.where, said.what)
              : fmt::format("{}{} says nothing beyond {} at the start; start elsewhere, or take "
                            "a part with fewer rows (a roller for a wheel)",
                            said.where, said.what, join(beyond)));
    }
    return out;
  }

 private:
  MotionWords words_;
  AtStart at_start_;
  std::shared_ptr<const Inputs> inputs_;
};

}  // namespace hamel::mechanisms
