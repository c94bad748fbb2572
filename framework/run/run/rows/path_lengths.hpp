// Path lengths of the sensors of a run: the integral of their speed since the start (column
// `<sensor>.path`), by the quadrature of run_integral.hpp. Not installed.
#pragma once

#include <memory>
#include <vector>

#include <hamel/framework/lie/geometry.hpp>
#include <hamel/framework/mechanics/system_model.hpp>
#include <hamel/framework/run/run/rows/run_integral.hpp>

namespace hamel {

class PathLengths {
 public:
  PathLengths() = default;
  /// geometry: of a group that is registered, else there are none. inputs: of the run, null
  /// without.
  PathLengths(std::shared_ptr<const Geometry> geometry, const SystemModel& system,
              const std::shared_ptr<const Inputs>& inputs);
  bool active() const { return !paths_.empty(); }
  std::size_t count() const { return paths_.size(); }

  /// A node, from the start on; the end of a step from the time `begin`, with states within it
  /// (EnergyBalance::step).
  void node(const Snapshot& state);
  template <class Within>
  void step(double begin, const Snapshot& end, const Within& motion_within) {
    for (const double part : {0.25, 0.5, 0.75}) {
      if (!motion_within(begin + part * (end.time - begin), within_)) break;
      for (Path& path : paths_)
        path.length.within(within_, [&](const Snapshot& now) { return speed(path, now); });
    }
    node(end);
  }
  void row(const Snapshot& state);
  void impact(const Snapshot& after);
  void finish();
  /// Lengths at the recorded states that are complete and were not taken before, count() for each.
  void settled(std::vector<double>& out);

  template <class Archive>
  void serialize(Archive& archive) {
    for (Path& path : paths_) archive(path.length);
  }

 private:
  struct Path {
    Sensor sensor;
    RunIntegral length;
    std::vector<double> values;
  };
  double speed(Path& path, const Snapshot& state);

  std::shared_ptr<const Geometry> geometry_;
  std::vector<Path> paths_;
  std::vector<double> coordinates_;
  Snapshot within_;
  std::vector<double> lengths_;
};

}  // namespace hamel
