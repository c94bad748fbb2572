// What mechanisms save (links in the plane, wheels as parts of what carries them, rows that stay)
// changes nothing: the same mechanism with a free root, and with wheels a little out of round, has
// the same motion.
#include <algorithm>
#include <cmath>

#include <gtest/gtest.h>

#include <hamel/hamel.hpp>

namespace hamel {
namespace {

using Eigen::MatrixXd;
using Eigen::VectorXd;

constexpr double kUneven = 1e-9;  // kg m^2, of five wheels: they are no rotors any more

// turning: the ground; a ball on a wheel, beside its axle, rolls there too.
Mechanism cart(bool plain, bool turning) {
  Mechanism m("cart");
  const double round = plain ? kUneven : 0;
  const auto wheel = [&](const std::string& name, const std::string& on, const Point& at,
                         const Point& axis) {
    // About its axis along y, or along z; across it the moments are equal but for `round`.
    if (axis[1] != 0) m.body(name, {.mass = 0.5, .at = at, .inertia = {0.01, 0.02, 0.01 + round}});
    else m.body(name, {.mass = 0.5, .at = at, .inertia = {0.01, 0.01 + round, 0.02}});
    m.hinge(name, on, name, {.at = at, .axis = axis});
  };
  m.body("deck", {.mass = 3, .at = {0.1, 0.05, 0.2}, .box = {0.6, 0.3, 0.1}});
  m.body("sled", {.mass = 1, .at = {0.3, 0.1, 0.3}, .box = {0.1, 0.2, 0.1}});
  m.body("arm", {.mass = 0.7, .at = {0.5, 0.3, 0.3}, .box = {0.4, 0.05, 0.05}});
  m.body("fork", {.mass = 0.6, .at = {-0.5, 0.02, 0.3}, .box = {0.1, 0.06, 0.5}});
  m.body("lump", {.mass = 0.4, .at = {-0.48, 0, 0.13}, .box = {0.1, 0.03, 0.2}});
  m.body("pole", {.mass = 0.3, .at = {0.3, 0.1, 0.8}, .box = {0.05, 0.05, 0.9}});
  const Point corner = {0.2, -0.1, 0};
  if (plain) m.free("root", "deck", {.at = corner});
  else m.planar("root", "deck", {.at = corner});
  m.slider("slide", "deck", "sled", {.at = {0.3, 0.1, 0.3}, .axis = {1, 2, 0}, .stiffness = 30});
  m.hinge("elbow", "sled", "arm", {.at = {0.35, 0.25, 0.3}, .axis = {0, 0, -1}, .damping = 0.1});
  m.hinge("steer", "deck", "fork", {.at = {-0.5, 0, 0}, .stiffness = 2});
  m.hinge("nod", "sled", "pole", {.at = {0.3, 0.1, 0.35}, .axis = {0.2, 1, 0.1}});
  m.hinge("lump", "fork", "lump", {.at = {-0.5, 0, 0.1}, .axis = {0, 1, 0}});
  m.body("rake", {.mass = 0.3, .at = {0.45, -0.2, 0.3}, .box = {0.1, 0.05, 0.4}});
  m.hinge("rake", "deck", "rake", {.at = {0.4, -0.2, 0.3}, .axis = {-0.3, 0.1, 1}});
  wheel("pivot", "arm", {0.8, 0.3, 0.1}, {0, 0, 1});
  wheel("left", "deck", {0, 0.4, 0.1}, {0, -1, 0});
  wheel("gyro", "pole", {0.3, 0.1, 1.2}, {0, 1, 0});
  wheel("caster", "arm", {0.6, 0.2, 0.1}, {0, 1, 0});
  wheel("raked", "rake", {0.5, -0.2, 0.1}, {0, 1, 0});
  m.blade("edge", "pivot", {.at = {0.8, 0.3, 0}, .along = {1, 0.3, 0}});
  m.wheel("left", "left", {.at = {0, 0.4, 0.1}, .radius = 0.1});
  m.roller("caster", "caster", {.at = {0.6, 0.2, 0.1}, .radius = 0.1, .angle = 0.4});
  m.wheel("lump", "lump", {.at = {-0.5, 0, 0.1}, .radius = 0.1});
  m.spring("cord", "left", "arm",
           {.from = {0.03, 0.4, 0.12}, .to = {0.6, 0.3, 0.3}, .stiffness = 5, .damping = 0.2});
  if (turning) {
    m.ground(0.7, {0.2, -0.1, 0});
    m.ball("stud", "raked", {.at = {0.53, -0.2, 0.1}, .radius = 0.1});
  }
  m.gravity({0.4, -0.2, -9.7});
  m.redundant("drop");
  return m;
}

struct Evaluated {
  MatrixXd inertia, a;
  VectorXd force, b;
  std::vector<std::string> reactions;
};

// At coordinates (theta, x, y) of the root and of the joints that follow.
Evaluated look(bool plain, bool turning, const VectorXd& coordinates, const VectorXd& velocities) {
  const SystemModel model = cart(plain, turning).model();
  const Mechanics& mechanics = *model.mechanics;
  const auto geometry = registry().geometry(model.group.name, "exp");
  const int more = plain ? 3 : 0, n = mechanics.dim(), joints = n - 3 - more;
  std::vector<double> values(coordinates.begin(), coordinates.end());
  if (plain) {
    const double c = std::cos(coordinates[0]), s = std::sin(coordinates[0]);
    values = {c, -s, 0, s, c, 0, 0, 0, 1, coordinates[1], coordinates[2], 0};
    values.insert(values.end(), coordinates.begin() + 3, coordinates.end());
  }
  VectorXd g(geometry->size()), xi = VectorXd::Zero(n);
  geometry->from_coordinates(values, g.data());
  // (w3, v1, v2) and the joints, of a free root (w1, w2, w3, v1, v2, v3).
  std::vector<int> columns = plain ? std::vector<int>{2, 3, 4} : std::vector<int>{0, 1, 2};
  for (int j = 0; j < joints; ++j) columns.push_back(3 + more + j);
  xi(columns) = velocities;
  Evaluated said{MatrixXd(n, n),
                 MatrixXd(mechanics.constraint_count(), n),
                 VectorXd(n),
                 VectorXd(mechanics.constraint_count()),
                 {}};
  // Elsewhere first: what is kept from there must not show.
  const VectorXd here = g, turn = VectorXd::Constant(n, 0.3);
  VectorXd step(g.size()), there(g.size());
  geometry->tau(turn.data(), step.data());
  geometry->compose(g.data(), step.data(), there.data());
  for (const VectorXd& at : {there, VectorXd(step), there, here}) {
    mechanics.inertia(at.data(), said.inertia);
    mechanics.constraints(0, at.data(), said.a, said.b);
    mechanics.force(0, at.data(), xi, said.force);
  }
  said.inertia = MatrixXd(said.inertia(columns, columns));
  said.a = MatrixXd(said.a(Eigen::all, columns));
  said.force = VectorXd(said.force(columns));
  said.reactions = model.reactions;
  return said;
}

void expect_equal(bool turning, size_t rows) {
  const int n = 3 + 11;
  VectorXd coordinates(n), velocities(n);
  for (int i = 0; i < n; ++i) {
    coordinates[i] = 0.6 * std::sin(3.0 * i + 1);
    velocities[i] = std::cos(2.0 * i);
  }
  const Evaluated ours = look(false, turning, coordinates, velocities),
                  plain = look(true, turning, coordinates, velocities);
  EXPECT_LT((ours.inertia - plain.inertia).lpNorm<Eigen::Infinity>(), 4 * kUneven);
  EXPECT_LT((ours.force - plain.force).lpNorm<Eigen::Infinity>(), 20 * kUneven);
  size_t compared = 0;
  for (size_t i = 0; i < ours.reactions.size(); ++i) {
    const auto same = std::find(plain.reactions.begin(), plain.reactions.end(), ours.reactions[i]);
    if (same == plain.reactions.end()) continue;
    ++compared;
    const auto row = static_cast<Eigen::Index>(i);
    const Eigen::Index other = same - plain.reactions.begin();
    EXPECT_LT((ours.a.row(row) - plain.a.row(other)).lpNorm<Eigen::Infinity>(), 1e-12)
        << ours.reactions[i];
    EXPECT_NEAR(ours.b[row], plain.b[other], 1e-12) << ours.reactions[i];
  }
  EXPECT_EQ(compared, rows);
}

TEST(Mechanisms, TakeShortcutsThatChangeNothing) { expect_equal(/*turning=*/false, 1 + 2 + 1 + 2); }

// Rows that change with the place of their carrier in the root.
TEST(Mechanisms, TakeShortcutsOnATurningGround) {
  expect_equal(/*turning=*/true, 1 + 2 + 1 + 2 + 3);
}

}  // namespace
}  // namespace hamel
