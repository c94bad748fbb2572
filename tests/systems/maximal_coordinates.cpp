// A car with two knuckles in maximal coordinates: each body's Newton-Euler equations in world axes,
// joints and contacts as rows between bodies, nothing of the library's mechanics. The agreement of
// its wheels is Ackermann's relation, written by hand.
//
//   [M A^T; A 0] [x'; l] = [f; -gamma],   M x' = f + A^T l,   A x' = -A' x
#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <map>
#include <numbers>
#include <string>
#include <vector>

#include <Eigen/Dense>

#include <hamel/systems/mechanisms/mechanism.hpp>
#include <hamel/systems/simulate_typed.hpp>

namespace hamel {
namespace {

using Eigen::Matrix3d;
using Eigen::MatrixXd;
using Eigen::Vector3d;
using Eigen::VectorXd;

constexpr double kRadius = 0.3, kLength = 2.5, kHalf = 0.7;

double motor_of_left(double t) { return 3 * std::sin(2 * t); }
constexpr double kDrive = 20;

// ---- by parts -----------------------------------------------------------------------------------

Mechanism car() {
  Mechanism m("car");
  m.body("base", {.mass = 100, .at = {0.8, 0.03, 0.5}, .inertia = {10, 30, 45}});
  m.planar("road", "base");
  const std::map<std::string, Point> places = {{"left", {kLength, kHalf, kRadius}},
                                               {"right", {kLength, -kHalf, kRadius}},
                                               {"rear left", {0, kHalf, kRadius}},
                                               {"rear right", {0, -kHalf, kRadius}}};
  const Point axle = {0, 1, 0};
  for (const auto& [name, at] : places) {
    const bool steered = at[0] > 0;
    if (steered) {
      m.body("knuckle " + name, {.mass = 3, .at = at, .inertia = {0.2, 0.2, 0.15}});
      m.hinge(name, "base", "knuckle " + name, {.at = at});
    }
    const std::string wheel = name + " wheel";
    m.body(wheel, {.mass = 5, .at = at, .inertia = {0.12, 0.2, 0.12}});
    m.hinge(wheel, steered ? "knuckle " + name : "base", wheel, {.at = at, .axis = axle});
    m.wheel(wheel, wheel, {.at = at, .radius = kRadius});
  }
  m.redundant("drop");
  m.motor("left", [](const SignalInput& now) { return motor_of_left(now.t); });
  m.motor(
      "rear left wheel", [](const SignalInput&) { return kDrive; }, false);
  m.start({{"speed", 2}, {"left.angle", 0.1}});
  return m;
}

// ---- in maximal coordinates ---------------------------------------------------------------------

struct Body {
  double mass;
  Vector3d moments;
  Vector3d place, velocity = Vector3d::Zero(), spin = Vector3d::Zero();  // in the world
  Matrix3d turn = Matrix3d::Identity();
};
enum { kBase, kLeft, kRight, kLeftWheel, kRightWheel, kRearLeft, kRearRight, kBodies };
using Bodies = std::array<Body, kBodies>;

// Rows of A and what A x' has to be.
class Rows {
 public:
  Rows() : a_(MatrixXd::Zero(40, 6 * kBodies)), b_(VectorXd::Zero(40)) {}
  // Direction of the velocity of the point of a body at `arm` from its centre.
  void point(int body, const Vector3d& direction, const Vector3d& arm, double sign = 1) {
    a_.block<1, 3>(row_, 6 * body) += sign * direction.transpose();
    a_.block<1, 3>(row_, 6 * body + 3) += sign * arm.cross(direction).transpose();
  }
  void spin(int body, const Vector3d& direction, double sign = 1) {
    a_.block<1, 3>(row_, 6 * body + 3) += sign * direction.transpose();
  }
  void end(double right = 0) { b_[row_++] = right; }
  const MatrixXd& a() const { return a_; }
  const VectorXd& b() const { return b_; }
  Eigen::Index count() const { return row_; }

 private:
  MatrixXd a_;
  VectorXd b_;
  Eigen::Index row_ = 0;
};

// `at` and `axis` as drawn, when no body is turned.
void hinge(Rows& rows, const Bodies& b, int parent, int child, const Vector3d& from_parent,
           const Vector3d& axis) {
  const Vector3d arm = b[parent].turn * from_parent;
  const Vector3d& w = b[parent].spin;
  for (int i = 0; i < 3; ++i) {  // the child's centre lies on the hinge
    const Vector3d e = Vector3d::Unit(i);
    rows.point(parent, e, arm);
    rows.point(child, e, Vector3d::Zero(), -1);
    rows.end(-w.cross(w.cross(arm))[i]);
  }
  for (int i = 0; i < 3; ++i) {
    if (axis[i] != 0) continue;
    const Vector3d e = b[parent].turn * Vector3d::Unit(i);
    rows.spin(child, e);
    rows.spin(parent, e, -1);
    rows.end(-w.cross(e).dot(b[child].spin - w));
  }
}

double angle_of(const Bodies& b, int knuckle) {
  const Matrix3d relative = b[kBase].turn.transpose() * b[knuckle].turn;
  return std::atan2(relative(1, 0), relative(0, 0));
}

Rows rows_of(const Bodies& b) {
  Rows rows;
  for (int i = 0; i < 3; ++i) {  // the base stays in its plane
    if (i == 2) rows.point(kBase, Vector3d::UnitZ(), Vector3d::Zero());
    else rows.spin(kBase, Vector3d::Unit(i));
    rows.end();
  }
  const Vector3d centre(0.8, 0.03, 0.5), up = Vector3d::UnitZ(), across = Vector3d::UnitY();
  const auto from_centre = [&](double x, double y) {
    return Vector3d(Vector3d(x, y, kRadius) - centre);
  };
  hinge(rows, b, kBase, kLeft, from_centre(kLength, kHalf), up);
  hinge(rows, b, kBase, kRight, from_centre(kLength, -kHalf), up);
  hinge(rows, b, kLeft, kLeftWheel, Vector3d::Zero(), across);
  hinge(rows, b, kRight, kRightWheel, Vector3d::Zero(), across);
  hinge(rows, b, kBase, kRearLeft, from_centre(0, kHalf), across);
  hinge(rows, b, kBase, kRearRight, from_centre(0, -kHalf), across);
  const Vector3d down = -kRadius * up;
  for (const int wheel : {kLeftWheel, kRightWheel, kRearLeft, kRearRight}) {
    const Vector3d axle = b[wheel].turn * across, ahead = axle.cross(up).normalized();
    rows.point(wheel, ahead, down);
    rows.end();  // its point at the ground has no velocity, which is all that ahead' multiplies
    if (wheel == kRightWheel || wheel == kRearRight) continue;  // follows from the others
    rows.point(wheel, up.cross(ahead), down);
    rows.end();
  }
  // F = kLength sin(l - r) - 2 kHalf sin l sin r = 0, F' = 0 and F'' = 0.
  const double l = angle_of(b, kLeft), r = angle_of(b, kRight), track = 2 * kHalf;
  const double l_rate = (b[kLeft].spin - b[kBase].spin).z(),
               r_rate = (b[kRight].spin - b[kBase].spin).z();
  const double along = kLength * std::cos(l - r), across_it = kLength * std::sin(l - r),
               product = track * std::sin(l) * std::sin(r);
  const double by_l = along - track * std::cos(l) * std::sin(r),
               by_r = -along - track * std::sin(l) * std::cos(r),
               twice = product - across_it,  // by l or r alone
      mixed = across_it - track * std::cos(l) * std::cos(r);
  rows.spin(kLeft, up, by_l);
  rows.spin(kRight, up, by_r);
  rows.spin(kBase, up, -by_l - by_r);
  rows.end(-twice * (l_rate * l_rate + r_rate * r_rate) - 2 * mixed * l_rate * r_rate);
  return rows;
}

// x': linear and angular accelerations of all bodies.
VectorXd accelerations(const Bodies& b, double t) {
  const Rows rows = rows_of(b);
  const Eigen::Index n = 6 * kBodies, k = rows.count();
  MatrixXd block = MatrixXd::Zero(n + k, n + k);
  VectorXd right(n + k);
  for (int i = 0; i < kBodies; ++i) {
    const Matrix3d inertia = b[i].turn * b[i].moments.asDiagonal() * b[i].turn.transpose();
    block.block<3, 3>(6 * i, 6 * i) = b[i].mass * Matrix3d::Identity();
    block.block<3, 3>(6 * i + 3, 6 * i + 3) = inertia;
    right.segment<3>(6 * i).setZero();
    right.segment<3>(6 * i + 3) = -b[i].spin.cross(inertia * b[i].spin);
  }
  const Vector3d steer = motor_of_left(t) * Vector3d::UnitZ(),
                 drive = kDrive * (b[kBase].turn * Vector3d::UnitY());
  right.segment<3>(6 * kLeft + 3) += steer;
  right.segment<3>(6 * kBase + 3) -= steer + drive;
  right.segment<3>(6 * kRearLeft + 3) += drive;
  block.bottomLeftCorner(k, n) = rows.a();
  block.topRightCorner(n, k) = -rows.a().transpose();
  right.tail(k) = rows.b();
  return block.partialPivLu().solve(right).head(n);
}

// Rates of places, of the columns of turns, of velocities and of spins.
using Rates = std::array<std::pair<Matrix3d, VectorXd>, kBodies>;

Rates rates(const Bodies& b, double t) {
  const VectorXd x = accelerations(b, t);
  Rates out;
  for (int i = 0; i < kBodies; ++i) {
    Matrix3d turns;
    for (int j = 0; j < 3; ++j) turns.col(j) = b[i].spin.cross(b[i].turn.col(j));
    VectorXd rest(9);
    rest << b[i].velocity, x.segment<6>(6 * i);
    out[i] = {turns, rest};
  }
  return out;
}

Bodies moved(Bodies b, const Rates& by, double h) {
  for (int i = 0; i < kBodies; ++i) {
    b[i].turn += h * by[i].first;
    b[i].place += h * by[i].second.head<3>();
    b[i].velocity += h * by[i].second.segment<3>(3);
    b[i].spin += h * by[i].second.tail<3>();
  }
  return b;
}

// The classical method of order 4.
Bodies step(const Bodies& b, double t, double h) {
  const Rates k1 = rates(b, t), k2 = rates(moved(b, k1, h / 2), t + h / 2),
              k3 = rates(moved(b, k2, h / 2), t + h / 2), k4 = rates(moved(b, k3, h), t + h);
  return moved(moved(moved(moved(b, k1, h / 6), k2, h / 3), k3, h / 3), k4, h / 6);
}

// The bodies at a recorded start: the base where it is, all else by its joints.
Bodies at_start(const Result& run) {
  const auto first = [&](const std::string& name) { return run.trajectory.column(name).front(); };
  Bodies b;
  b[kBase] = {100, {10, 30, 45}, {0.8, 0.03, 0.5}};
  const double v = first("v1"), w = first("omega");
  const auto rigid = [&](const Vector3d& at) {  // velocity of a point of the base
    return Vector3d(v - w * at.y(), first("v2") + w * at.x(), 0);
  };
  b[kBase].velocity = rigid(b[kBase].place);
  b[kBase].spin = {0, 0, w};
  const auto knuckle = [&](int i, const std::string& name, double y) {
    b[i] = {3, {0.2, 0.2, 0.15}, {kLength, y, kRadius}};
    b[i].velocity = rigid(b[i].place);
    b[i].turn = Eigen::AngleAxisd(first(name + ".angle"), Vector3d::UnitZ()).toRotationMatrix();
    b[i].spin = {0, 0, w + first(name + ".rate")};
  };
  knuckle(kLeft, "left", kHalf);
  knuckle(kRight, "right", -kHalf);
  const auto wheel = [&](int i, int carrier, const std::string& name, const Vector3d& at) {
    b[i] = {5, {0.12, 0.2, 0.12}, at};
    b[i].velocity = rigid(at);
    b[i].turn = b[carrier].turn;
    b[i].spin = b[carrier].spin + first(name + " wheel.rate") * (b[carrier].turn.col(1));
  };
  wheel(kLeftWheel, kLeft, "left", b[kLeft].place);
  wheel(kRightWheel, kRight, "right", b[kRight].place);
  wheel(kRearLeft, kBase, "rear left", {0, kHalf, kRadius});
  wheel(kRearRight, kBase, "rear right", {0, -kHalf, kRadius});
  return b;
}

TEST(MaximalCoordinates, GiveTheMotionOfACarWithTwoKnuckles) {
  const double until = 1.2;
  const Result run = simulate(car()).tolerance({.relative = 1e-12}).until(until).run();
  ASSERT_TRUE(run.status.ok) << run.status.reason;
  std::array<Bodies, 2> ends;
  for (const int twice : {0, 1}) {
    const int steps = twice == 0 ? 400 : 800;
    Bodies b = at_start(run);
    for (int i = 0; i < steps; ++i) b = step(b, i * until / steps, until / steps);
    ends[twice] = b;
  }
  // Of order 4: the finer one is known to a fifteenth of the difference.
  const auto at = [&](const auto& of) { return of(ends[1]) + (of(ends[1]) - of(ends[0])) / 15; };
  const auto last = [&](const std::string& name) { return run.trajectory.column(name).back(); };
  const double theta =
      at([](const Bodies& b) { return std::atan2(b[kBase].turn(1, 0), b[kBase].turn(0, 0)); });
  EXPECT_GT(std::abs(theta), 0.1);
  // It steers, past the angle where the axle of its left wheel meets the middle of the rear axle:
  // the car then turns there, and the left wheel alone no longer gives the turn by the speed.
  EXPECT_GT(last("left.angle"), std::numbers::pi / 2 + 0.5);
  EXPECT_NEAR(last("theta"), theta, 1e-9);
  const Vector3d centre(0.8, 0.03, 0.5);
  for (const int axis : {0, 1}) {
    const double place =
        at([&](const Bodies& b) { return (b[kBase].place - b[kBase].turn * centre)[axis]; });
    EXPECT_NEAR(last(axis == 0 ? "x" : "y"), place, 1e-9);
  }
  EXPECT_NEAR(last("left.angle"), at([](const Bodies& b) { return angle_of(b, kLeft); }), 1e-9);
  EXPECT_NEAR(last("right.angle"), at([](const Bodies& b) { return angle_of(b, kRight); }), 1e-9);
  EXPECT_NEAR(last("right wheel.rate"), at([](const Bodies& b) {
                return (b[kRightWheel].spin - b[kRight].spin).dot(b[kRight].turn.col(1));
              }),
              1e-8);
}

}  // namespace
}  // namespace hamel
