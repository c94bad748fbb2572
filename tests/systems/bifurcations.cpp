// Kinds of bifurcations do not depend on units: 200 random systems of two degrees of freedom with a
// planted bifurcation, in random linear coordinates and random units of length, time, energy and of
// the parameter over decades, on grids with a node on it and on coarse ones. Every verdict is right
// or "undecided", values are right to their errors.
#include <gtest/gtest.h>

#include <cmath>
#include <filesystem>
#include <fstream>
#include <random>

#include <fmt/format.h>
#include <unistd.h>

#include <hamel/framework/analysis/steady.hpp>
#include <hamel/systems/by_name.hpp>

namespace hamel {
namespace {

// y = P (x - shift)/length, in which the potential and the forces are
//   V = energy v(y, b),   Q = energy P^T f(y, time y')/length,   b = (a - critical)/unit.
struct Units {
  double p[2][2], shift[2];
  double length, time, energy, unit, critical;
};

struct Planted {
  Bifurcation kind;
  std::optional<bool> supercritical;
  std::string potential;              // of u, w and b
  std::string force[2] = {"0", "0"};  // of u, w, du, dw and b
  double start[2] = {0, 0};           // (u, w) at b = 1
};

std::string replaced(std::string text, const std::string& name, const std::string& by) {
  for (size_t at = 0; (at = text.find(name, at)) != std::string::npos; at += by.size())
    text.replace(at, name.size(), by);
  return text;
}

class RandomSystem {
 public:
  explicit RandomSystem(unsigned seed) : random_(seed) {
    do {
      for (auto& row : units_.p)
        for (double& entry : row) entry = between(-1, 1);
    } while (std::abs(determinant()) < 0.4);
    units_.length = std::pow(10, between(-3, 3));
    units_.time = std::pow(10, between(-2, 2));
    units_.energy = std::pow(10, between(-3, 3));
    units_.unit = std::pow(10, between(-3, 3)) * (random_() % 2 == 0 ? 1 : -1);
    units_.critical = units_.unit * between(-1, 1);
    for (double& shift : units_.shift) shift = units_.length * between(-1, 1);
    plant(static_cast<int>(seed % 4));
  }

  const Planted& planted() const { return planted_; }
  const Units& units() const { return units_; }
  double value(double b) const { return units_.critical + units_.unit * b; }

  std::string text() const {
    std::string out = "group = \"r2\"\n";
    const double m = units_.energy * std::pow(units_.time / units_.length, 2);
    double inertia[2][2];
    for (int i = 0; i < 2; ++i)
      for (int j = 0; j < 2; ++j)
        inertia[i][j] =
            m * (units_.p[0][i] * units_.p[0][j] + 1.7 * units_.p[1][i] * units_.p[1][j]);
    out += fmt::format("inertia = [[{:.17g}, {:.17g}], [{:.17g}, {:.17g}]]\n", inertia[0][0],
                       inertia[0][1], inertia[1][0], inertia[1][1]);
    out += fmt::format("potential = \"{:.17g}*({})\"\n", units_.energy, user(planted_.potential));
    out += "force = [";
    for (int j = 0; j < 2; ++j)
      out += fmt::format("\"{:.17g}*({:.17g}*({}) + {:.17g}*({}))\", ",
                         units_.energy / units_.length, units_.p[0][j], user(planted_.force[0]),
                         units_.p[1][j], user(planted_.force[1]));
    out += "]\n";
    // x - shift = length P^-1 y.
    const double *y = planted_.start, d = determinant();
    const double x = units_.length * (units_.p[1][1] * y[0] - units_.p[0][1] * y[1]) / d,
                 z = units_.length * (units_.p[0][0] * y[1] - units_.p[1][0] * y[0]) / d;
    out += fmt::format("configuration = [{:.17g}, {:.17g}]\nvelocity = [0, 0]\n",
                       units_.shift[0] + x, units_.shift[1] + z);
    return out + "[parameters]\na = 1\n";
  }

 private:
  double between(double a, double b) {
    return a + (b - a) * static_cast<double>(random_()) / 4294967295.0;
  }
  double determinant() const {
    return units_.p[0][0] * units_.p[1][1] - units_.p[0][1] * units_.p[1][0];
  }

  std::string user(std::string text) const {
    const auto row = [&](int i, const char* prime, double factor) {
      std::string out;
      for (int j = 0; j < 2; ++j)
        out +=
            fmt::format("{}{:.17g}*(x{}{} - {:.17g})", j > 0 ? " + " : "", units_.p[i][j] * factor,
                        j + 1, prime, *prime == 0 ? units_.shift[j] : 0.0);
      return "(" + out + ")";
    };
    text = replaced(text, "DU", row(0, "'", units_.time / units_.length));
    text = replaced(text, "DW", row(1, "'", units_.time / units_.length));
    text = replaced(text, "U", row(0, "", 1 / units_.length));
    text = replaced(text, "W", row(1, "", 1 / units_.length));
    return replaced(text, "B",
                    fmt::format("((a - {:.17g})/{:.17g})", units_.critical, units_.unit));
  }

  void plant(int which) {
    const double k = between(0.5, 3), f = between(-0.4, 0.4), damping = between(0.2, 0.8);
    const double c = between(0.3, 3) * (random_() % 2 == 0 ? 1 : -1);
    const std::string rest =
        fmt::format("{:.17g}*W^2/2 + {:.17g}*U^2*W + {:.17g}*U*W^2", k, f, between(-0.4, 0.4));
    planted_.force[0] = fmt::format("-{:.17g}*DU", damping);
    planted_.force[1] = fmt::format("-{:.17g}*DW", damping + 0.1);
    if (which == 0) {
      planted_.kind = Bifurcation::transcritical;
      planted_.potential = fmt::format("-B*U^2/2 + {:.17g}*U^3/3 + {}", c, rest);
    } else if (which == 1) {
      // V(u, w(u)) = -b u^2/2 + (c - 2 f^2/k) u^4/4 + ...: supercritical where positive.
      planted_.kind = Bifurcation::pitchfork;
      planted_.potential =
          fmt::format("-B*U^2/2 + {:.17g}*U^4/4 + {:.17g}*W^2/2 + {:.17g}*U^2*W", c, k, f);
      planted_.supercritical = c - 2 * f * f / k > 0;
    } else if (which == 2) {
      planted_.kind = Bifurcation::fold;
      const double size = std::abs(c) + 0.5;
      planted_.potential =
          fmt::format("{:.17g}*U^3/3 - B*U + {:.17g}*W^2/2 + {:.17g}*U^2*W", size, k, 0.3 * f);
      planted_.start[0] = std::sqrt(1 / size);
    } else {
      // Circulatory and triangular: the rates are those of both coordinates by themselves.
      planted_.kind = Bifurcation::hopf;
      planted_.potential = fmt::format("{:.17g}*U^2/2 + {:.17g}*W^2/2 + U^4/4", between(0.3, 3), k);
      planted_.force[0] = fmt::format("B*DU + {:.17g}*W - DU^3", c);
    }
  }

  std::mt19937 random_;
  Units units_{};
  Planted planted_{};
};

class Bifurcations : public testing::Test {
 protected:
  Bifurcations()
      : path_(std::filesystem::temp_directory_path() /
              fmt::format("hamel_bifurcation_{}.toml", getpid())) {}
  ~Bifurcations() override { std::filesystem::remove(path_); }

  SteadySweep sweep(const RandomSystem& system, const std::vector<double>& grid) {
    std::ofstream(path_) << system.text();
    std::vector<double> values;
    for (const double b : grid) values.push_back(system.value(b));
    return sweep_steady(registry(), values,
                        [&](double a) { return simulate(path_.string()).set("a", a); });
  }

  std::filesystem::path path_;
};

const std::vector<std::vector<double>> kGrids = {
    {1, 0.5, 0, -0.5, -1}, {1, -1}, {1, 1.0 / 3, -1.0 / 3, -1}, {1, 0.7, 0.1, -0.3, -0.9}};

TEST_F(Bifurcations, KindsAndValuesOfRandomSystems) {
  int undecided = 0;
  for (unsigned seed = 0; seed < 200; ++seed) {
    const RandomSystem system(seed);
    const Planted& planted = system.planted();
    SCOPED_TRACE(fmt::format("seed {}, {}\n{}", seed, name_of(planted.kind), system.text()));
    const SteadySweep s = sweep(system, kGrids[seed / 4 % kGrids.size()]);
    const double unit = std::abs(system.units().unit);
    if (planted.kind == Bifurcation::fold) {
      EXPECT_TRUE(s.crossings.empty());
      ASSERT_EQ(s.ends.size(), 1u);
      const SteadyEnd& end = s.ends[0];
      EXPECT_LE(std::abs(end.value - system.value(0)), 3 * end.round_off + 1e-14 * unit);
      EXPECT_LT(end.round_off, 1e-6 * unit);
      const bool decided = end.kind != Bifurcation::undecided;
      undecided += decided ? 0 : 1;
      EXPECT_EQ(decided ? name_of(end.kind) : "fold", "fold");
      continue;
    }
    ASSERT_EQ(s.crossings.size(), 1u);
    const SteadyCrossing& crossing = s.crossings[0];
    EXPECT_EQ(crossing.pair, planted.kind == Bifurcation::hopf);
    EXPECT_LE(std::abs(crossing.value - system.value(0)), 3 * crossing.round_off + 1e-14 * unit);
    EXPECT_LT(crossing.round_off, 1e-6 * unit);
    EXPECT_TRUE(s.ends.empty());
    if (crossing.kind == Bifurcation::undecided) {
      ++undecided;
      continue;
    }
    EXPECT_EQ(name_of(crossing.kind), name_of(planted.kind));
    EXPECT_EQ(crossing.supercritical, planted.supercritical);
    EXPECT_EQ(crossing.other.has_value(), planted.kind != Bifurcation::hopf);
  }
  EXPECT_LT(undecided, 10);
}

}  // namespace
}  // namespace hamel
