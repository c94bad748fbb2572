// Variations of a member: the names of an ensemble resolved in its system, and the numbers of
// each member. Not installed.
#pragma once

#include <string>
#include <vector>

#include <hamel/framework/ensemble/ensemble.hpp>
#include <hamel/framework/ensemble/random.hpp>
#include <hamel/framework/mechanics/system_model.hpp>

namespace hamel::ensemble {

/// Target that a variation sets.
struct Target {
  enum class Kind { parameter, input, speed, velocity, coordinate, rotation, moved, energy };
  Kind kind = Kind::parameter;
  std::string field;  // of a parameter or an input
  size_t index = 0;   // the entry of a parameter, the component of xi, the column of g
  std::string unit, meaning;
};

class Variations {
 public:
  /// Adds to mistakes what no member can have: unknown names, lists without entries, values out of
  /// a field's range. Completes config.members.
  Variations(EnsembleConfig& config, const SystemModel& system, std::vector<std::string>& mistakes);

  const std::vector<Variation>& all() const { return vary_; }
  const std::vector<Target>& targets() const { return targets_; }
  /// Variations that are one number each, by index into all(): the columns of a table.
  const std::vector<size_t>& numbered() const { return numbered_; }
  bool any(Target::Kind kind) const;
  /// The number of a member for a variation that is one.
  double number(size_t variation, long member) const;
  Draws draws(size_t variation, long member) const {
    return {seed_, static_cast<uint64_t>(member), streams_[variation]};
  }

 private:
  void resolve(const SystemModel& system, std::vector<std::string>& wrong);
  void count_members(EnsembleConfig& config, std::vector<std::string>& mistakes,
                     std::vector<std::string>& wrong);
  void check_ranges(long members, const SystemModel& system, std::vector<std::string>& wrong) const;

  std::vector<Variation> vary_;
  std::vector<Target> targets_;
  std::vector<size_t> numbered_;
  std::vector<uint32_t> streams_;
  std::vector<long> strides_;  // of the lists: entry (member / stride) % size
  uint64_t seed_;
};

/// Where the rotation of a so3 or se3 lies in the columns; its first column, or none.
std::vector<size_t> rotations_of(const GroupInfo& group);

}  // namespace hamel::ensemble
