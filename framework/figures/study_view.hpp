// A study seen as methods: the cells that were run, grouped by all axes but some.
#pragma once

#include <map>
#include <set>
#include <string>
#include <vector>

#include <hamel/framework/figures/figure.hpp>
#include <hamel/framework/study/study.hpp>

namespace hamel::figures {

/// An order measured this much below its claim falls short; one this much above it is no order yet.
constexpr double kShortOfClaim = 0.25, kFarAboveClaim = 0.5;
/// An order is not known to fall short before errors are below this part of the motion's extent.
constexpr double kSmall = 1e-4;

class StudyView {
 public:
  explicit StudyView(const StudyResult& result);

  const StudyResult& result() const { return result_; }
  const std::vector<size_t>& run() const { return run_; }
  const StudyCell& cell(size_t i) const { return result_.cells[i]; }
  const StudyMetrics& metrics(size_t i) const { return result_.metrics[i]; }
  double seconds(size_t i) const;

  /// Axes of which the cells that were run use more than one value.
  const std::vector<std::string>& varying() const { return varying_; }
  bool varies(const std::string& axis) const;
  /// The values of an axis that the cells that were run use, in the order of the study.
  std::vector<std::string> values(const std::string& axis) const;

  /// The cells that were run, grouped by the values of these axes, in the order of the study.
  using Group = std::pair<std::vector<std::string>, std::vector<size_t>>;
  std::vector<Group> groups(const std::vector<std::string>& axes) const;
  /// The axes that vary, without those.
  std::vector<std::string> varying_without(const std::vector<std::string>& axes) const;

  /// "lift, s = 0.5, cayley": the values of a cell on these axes. Axes not used are left out;
  /// where that leaves nothing, "solver unused". ", chosen steps" where the study takes a scheme
  /// with steps of one size too and the axes do not tell.
  std::string words(size_t i, const std::vector<std::string>& axes) const;
  std::string words(const std::vector<std::string>& axes,
                    const std::vector<std::string>& values) const;
  /// The names of a cell on all axes that vary but the step; never empty.
  std::string name(size_t i) const;
  /// The axes whose values all these cells share although the study has more: "solver nlopt; h 0.4,
  /// 0.8". `known` is left out.
  std::string where(const std::vector<size_t>& some, const std::string& known = "") const;
  /// Groups of cells that differ in one axis only, which all of them use. A cell that does not use
  /// another axis, as boxed does not use s, is in every group of its kind.
  std::vector<std::vector<size_t>> otherwise_equal(const std::string& axis) const;
  /// Order of cells that differ in their step, the slopes over all steps and over the two finest
  /// against the claim: "ok", "finest only"; "below its claim" where the slopes agree and the least
  /// error is below kSmall of the motion, else "not asymptotic": too few steps, or too large.
  /// "claims none", "not measured".
  const char* order_verdict(const std::vector<size_t>& cells) const;

 private:
  const StudyResult& result_;
  std::vector<size_t> run_;
  std::vector<std::string> varying_;
  std::set<std::string> both_ways_;  // schemes with steps of one size and with chosen ones
};

/// Text of tables for a value that a scheme makes no use of.
constexpr const char* kUnused = "unused";

/// An axis with a value as text shows it: "s = 0.5", "h = 0.1", "1e-13"; names as they are, nothing
/// for one that is not used.
std::string axis_words(const std::string& axis, const std::string& value);

/// Time per step against the parameter in which at least three systems of one name differ, and in
/// nothing else of their parameters. Adds nothing when there are none.
void add_growth(std::vector<Figure>& out, const StudyView& view);

}  // namespace hamel::figures
