// Bodies that slide on a plane: hamel's run by events and in steps of one size, and MuJoCo's
// mj_step, in one run.
//
//   build/tests/benchmarks/contacts_peer [--quick]
// Two motions of 1 s. A ball set sliding with spin, k = 2/5, R = 0.03 m, mu = 0.2, v = (2, 0) m/s,
// w = (40, -60, 7) rad/s: a parabola until 0.58 s, then straight on, in closed form. A table on
// four legs that slides and turns until it rests, against hamel at a tolerance of 1e-12 (which
// tests/systems/four_legs holds to planar equations). Columns: distance of the end from the right
// place; how much the end, turned back, depends on the direction of the start (0.3, 1, 2, pi/2
// rad); milliseconds a run, the least of blocks in turns. Fails where hamel's run by events is not
// within 1e-6 m of the closed form. Built where MuJoCo is found (tools/setup --peers).
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <functional>
#include <limits>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <hamel/hamel.hpp>

namespace {

using namespace hamel;  // a program, not a header
using Eigen::Vector2d;

constexpr double kGravity = 9.81;

// A body on the plane with its contacts, and how it starts.
struct Case {
  std::string name;
  double mass, height, friction;
  std::vector<double> moments;
  double radius;  // of a ball; 0: on the feet
  std::vector<Vector2d> feet;
  Vector2d velocity;     // m/s, of the mass centre
  Eigen::Vector3d rate;  // rad/s
};

Case ball() {
  const double radius = 0.03, moment = 0.4 * radius * radius;
  return {"ball", 1, radius, 0.2, {moment, moment, moment}, radius, {}, {2, 0}, {40, -60, 7}};
}
Case table() {
  return {"table",
          2,
          0.4,
          0.3,
          {0.1, 0.12, 0.2},
          0,
          {{0.3, 0.2}, {0.3, -0.25}, {-0.3, 0.2}, {-0.35, -0.2}},
          {1, 0.5},
          {0, 0, 3}};
}

Vector2d closed_end(const Case& c, double t) {
  const double k = 0.4;
  const Vector2d slip(c.velocity[0] - c.radius * c.rate[1], c.velocity[1] + c.radius * c.rate[0]);
  const double slides = k / (1 + k) * slip.norm() / (c.friction * kGravity);
  const double until = std::min(slides, t);
  const Vector2d pull = -c.friction * kGravity * slip.normalized();
  return c.velocity * t + pull * (until * until / 2 + until * (t - until));
}

Eigen::Matrix2d turn(double angle) { return Eigen::Rotation2Dd(angle).toRotationMatrix(); }

// The end of a run whose start is turned by an angle about the vertical, turned back.
struct Method {
  std::string name;
  std::function<Vector2d(const Case&, double angle, double until)> end;
};

// ---- hamel ----

Simulation run_of(const Case& c, double angle) {
  Mechanism m(c.name);
  m.body("body", {.mass = c.mass,
                  .at = {0, 0, c.height},
                  .inertia = {c.moments[0], c.moments[1], c.moments[2]}});
  m.free("root", "body", {.at = {0, 0, c.height}});
  if (c.radius > 0)
    m.ball("contact", "body", {.at = {0, 0, c.height}, .radius = c.radius, .friction = c.friction});
  for (size_t i = 0; i < c.feet.size(); ++i)
    m.point("leg" + std::to_string(i), "body",
            {.at = {c.feet[i][0], c.feet[i][1], 0}, .friction = c.friction});
  // The velocity is that of the body, which is turned whole.
  const Eigen::Matrix2d r = turn(angle);
  return simulate(m).slip().start(
      {.configuration = {r(0, 0), r(0, 1), 0, r(1, 0), r(1, 1), 0, 0, 0, 1, 0, 0, c.height},
       .velocity = {c.rate[0], c.rate[1], c.rate[2], c.velocity[0], c.velocity[1], 0}});
}
Vector2d end_of(Simulation simulation, double angle, double until) {
  const Result r = simulation.until(until).every(1000000).run();
  if (!r) throw std::runtime_error(r.status.reason);
  return turn(-angle) * Vector2d(r.last.coordinates[9], r.last.coordinates[10]);
}
Method by_events(double rtol) {
  return {fmt::format("hamel, dop853, rtol {:g}", rtol), [rtol](const Case& c, double a, double t) {
            return end_of(run_of(c, a).tolerance({.relative = rtol}), a, t);
          }};
}
Method nonsmooth(double step) {
  return {fmt::format("hamel, nonsmooth, h {:g}", step), [step](const Case& c, double a, double t) {
            return end_of(run_of(c, a).scheme("nonsmooth").step(step), a, t);
          }};
}

// ---- MuJoCo ----

struct Delete {
  void operator()(mjModel* model) const { mj_deleteModel(model); }
  void operator()(mjData* data) const { mj_deleteData(data); }
};

std::string mjcf(const Case& c, const std::string& options, double step) {
  std::string out = fmt::format(
      "<mujoco><option timestep='{}' gravity='0 0 -{}' {}/><worldbody>"
      "<geom type='plane' size='50 50 1' friction='{} 0 0' condim='3'/>"
      "<body pos='0 0 {}'><freejoint/><inertial pos='0 0 0' mass='{}' diaginertia='{} {} {}'/>",
      step, kGravity, options, c.friction, c.height, c.mass, c.moments[0], c.moments[1],
      c.moments[2]);
  const auto sphere = [&](double x, double y, double z, double radius) {
    out += fmt::format(
        "<geom type='sphere' pos='{} {} {}' size='{}' friction='{} 0 0' condim='3' mass='0'/>", x,
        y, z, radius, c.friction);
  };
  if (c.radius > 0) sphere(0, 0, 0, c.radius);
  constexpr double small = 1e-4;
  for (const Vector2d& foot : c.feet) sphere(foot[0], foot[1], small - c.height, small);
  return out + "</body></worldbody></mujoco>";
}

Method mujoco(const std::string& name, const std::string& options, double step) {
  return {fmt::format("MuJoCo, {}, h {:g}", name, step), [=](const Case& c, double a, double t) {
            char error[500] = "";
            mjSpec* spec =
                mj_parseXMLString(mjcf(c, options, step).c_str(), nullptr, error, sizeof error);
            if (spec == nullptr) throw std::runtime_error(error);
            const std::unique_ptr<mjModel, Delete> model(mj_compile(spec, nullptr));
            mj_deleteSpec(spec);
            const std::unique_ptr<mjData, Delete> data(mj_makeData(model.get()));
            data->qpos[3] = std::cos(a / 2);
            data->qpos[6] = std::sin(a / 2);
            const Vector2d v = turn(a) * c.velocity;  // of space; the rate that of the body
            data->qvel[0] = v[0];
            data->qvel[1] = v[1];
            for (int i = 0; i < 3; ++i) data->qvel[3 + i] = c.rate[i];
            for (long k = std::lround(t / step); k > 0; --k) mj_step(model.get(), data.get());
            return Vector2d(turn(-a) * Vector2d(data->qpos[0], data->qpos[1]));
          }};
}

double milliseconds(const Method& method, const Case& c, double until) {
  const auto begin = std::chrono::steady_clock::now();
  method.end(c, 0, until);
  return std::chrono::duration<double, std::milli>(std::chrono::steady_clock::now() - begin)
      .count();
}

}  // namespace

int main(int argc, char** argv) {
  const bool quick = argc > 1 && std::string_view(argv[1]) == "--quick";
  const double until = 1;
  const std::vector<Method> methods = {
      by_events(1e-6),
      by_events(1e-10),
      nonsmooth(0.01),
      nonsmooth(0.002),
      mujoco("as it comes", "", 0.002),
      mujoco("elliptic cones", "cone='elliptic' impratio='10'", 0.002),
      mujoco("elliptic cones", "cone='elliptic' impratio='10'", 0.0002)};
  std::printf("MuJoCo %s, 1 s of motion\n", mj_versionString());
  bool right = true;
  for (const Case& c : {ball(), table()}) {
    const Vector2d end = c.radius > 0 ? closed_end(c, until) : by_events(1e-12).end(c, 0, until);
    std::printf("%-34s %12s %14s %10s\n", c.name.c_str(), "error, m", "by direction", "ms");
    std::vector<double> least(methods.size(), std::numeric_limits<double>::infinity());
    for (int block = 0; block < (quick ? 1 : 10); ++block)
      for (size_t i = 0; i < methods.size(); ++i)
        least[i] = std::min(least[i], milliseconds(methods[i], c, until));
    for (size_t i = 0; i < methods.size(); ++i) {
      const Vector2d straight = methods[i].end(c, 0, until);
      double depends = 0;
      for (const double a : {0.3, 1.0, 2.0, std::numbers::pi / 2})
        depends = std::max(depends, (methods[i].end(c, a, until) - straight).norm());
      const double error = (straight - end).norm();
      std::printf("%-34s %12.1e %14.1e %10.3f\n", methods[i].name.c_str(), error, depends,
                  least[i]);
      if (i < 2) right = right && error < 1e-6 && depends < 1e-6;
    }
  }
  if (!right) std::printf("hamel's run by events is more than 1e-6 m off\n");
  return right ? 0 : 1;
}
