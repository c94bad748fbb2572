// The state of a run as bytes, to resume from: every class that has a part of it lists it once, for
// both ways, by
//   template <class Archive> void serialize(Archive& archive) { archive(member, ...); }
// Read by the build that wrote it (io/version.hpp, build_name). Not installed.
#pragma once

#include <array>
#include <concepts>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include <Eigen/Core>

#include <hamel/framework/io/errors.hpp>
#include <hamel/framework/loop/kernel.hpp>
#include <hamel/framework/run/record/result.hpp>

namespace hamel {

template <class T>
concept PlainNumber = std::is_arithmetic_v<T>;

/// Members that are no numbers, for either archive.
template <class Archive>
void serialize(Archive& archive, Snapshot& s) {
  archive(s.step, s.time, s.coordinates, s.element, s.velocity, s.momentum, s.energy,
          s.constraint_rates, s.constraint, s.holonomic, s.group_defect, s.rotation, s.time_offset,
          s.iterations, s.residual);
}
template <class Archive>
void serialize(Archive& archive, Fallback& f) {
  archive(f.step, f.time, f.action);
}
template <class Archive>
void serialize(Archive& archive, SolverStats& s) {
  archive(s.iterations, s.evaluations, s.iterations_max, s.residual_max, s.rejected, s.fallbacks,
          s.first_fallbacks);
}
template <class Archive>
void serialize(Archive& archive, EventMet& e) {
  archive(e.name, e.time, e.coordinates, e.velocity, e.velocity_after);
}

class CheckpointWriter {
 public:
  template <class... Values>
  void operator()(Values&... values) {
    (put(values), ...);
  }
  const std::string& bytes() const { return bytes_; }

 private:
  void raw(const void* data, std::size_t size) {
    bytes_.append(static_cast<const char*>(data), size);
  }
  template <class Value>
  void put(Value& value) {
    if constexpr (PlainNumber<Value>) raw(&value, sizeof value);
    else if constexpr (requires { value.serialize(*this); }) value.serialize(*this);
    else if constexpr (requires { serialize(*this, value); }) serialize(*this, value);
    else {
      std::size_t size = static_cast<std::size_t>(value.size());
      put(size);
      for (auto& entry : value) put(entry);
    }
  }

  std::string bytes_;
};

class CheckpointReader {
 public:
  explicit CheckpointReader(std::string_view bytes) : left_(bytes) {}
  template <class... Values>
  void operator()(Values&... values) {
    (get(values), ...);
  }

 private:
  void raw(void* data, std::size_t size) {
    if (size > left_.size()) throw ConfigError({"continue: the state in the file is damaged"});
    std::memcpy(data, left_.data(), size);
    left_.remove_prefix(size);
  }
  template <class Value>
  void get(Value& value) {
    if constexpr (PlainNumber<Value>) raw(&value, sizeof value);
    else if constexpr (requires { value.serialize(*this); }) value.serialize(*this);
    else if constexpr (requires { serialize(*this, value); }) serialize(*this, value);
    else {
      std::size_t size = 0;
      get(size);
      if (size > left_.size()) throw ConfigError({"continue: the state in the file is damaged"});
      if constexpr (std::derived_from<Value, Eigen::VectorXd>)
        value.resize(static_cast<Eigen::Index>(size));
      else if constexpr (requires { value.resize(size); }) value.resize(size);
      for (auto& entry : value) get(entry);
    }
  }

  std::string_view left_;
};

}  // namespace hamel
