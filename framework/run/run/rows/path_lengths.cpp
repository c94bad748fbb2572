#include <hamel/framework/run/run/rows/path_lengths.hpp>

#include <cmath>
#include <utility>

namespace hamel {

PathLengths::PathLengths(std::shared_ptr<const Geometry> geometry, const SystemModel& system,
                         const std::shared_ptr<const Inputs>& inputs)
    : geometry_(std::move(geometry)) {
  if (geometry_ == nullptr) return;
  coordinates_.resize(static_cast<std::size_t>(geometry_->columns()));
  for (const Sensor& sensor : system.sensors)
    if (sensor.velocity >= 0)
      paths_.push_back({sensor, RunIntegral(inputs), std::vector<double>(sensor.columns.size())});
}

// States within a step have no coordinates.
double PathLengths::speed(Path& path, const Snapshot& state) {
  const bool known = !state.coordinates.empty();
  if (!known) geometry_->coordinates(state.element.data(), coordinates_.data());
  path.sensor.value(known ? state.coordinates : coordinates_, state.velocity, {}, path.values);
  const double* const v = path.values.data() + path.sensor.velocity;
  return std::hypot(v[0], v[1], v[2]);
}

void PathLengths::node(const Snapshot& state) {
  for (Path& path : paths_)
    path.length.node(state, [&](const Snapshot& now) { return speed(path, now); });
}

void PathLengths::row(const Snapshot& state) {
  for (Path& path : paths_) path.length.row(state.time);
}

void PathLengths::impact(const Snapshot& after) {
  for (Path& path : paths_)
    path.length.impact(after, [&](const Snapshot& now) { return speed(path, now); });
}

void PathLengths::finish() {
  for (Path& path : paths_) path.length.finish();
}

void PathLengths::settled(std::vector<double>& out) {
  out.clear();
  for (std::size_t i = 0; i < paths_.size(); ++i) {
    paths_[i].length.settled(lengths_);
    out.resize(lengths_.size() * paths_.size());
    for (std::size_t row = 0; row < lengths_.size(); ++row)
      out[row * paths_.size() + i] = std::abs(lengths_[row]);
  }
}

}  // namespace hamel
