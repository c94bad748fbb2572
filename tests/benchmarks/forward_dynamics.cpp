// Forward dynamics of a chain of hinges: hamel's equations of motion and MuJoCo's mj_forward, in
// one run.
//
//   build/tests/benchmarks/forward_dynamics [--quick]
// The chain hangs from the ground in space, with gravity, its axes along x, y, z in turn. Both
// libraries get the same positions and rates, none seen before, and must give the same
// accelerations to 1e-9 of the largest. MuJoCo computes with contacts, limits and sensors off. A
// time is the least of blocks in turns, so that both see the same machine. Built where MuJoCo is
// found (tools/setup --peers).
#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <limits>
#include <memory>
#include <random>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include <fmt/format.h>
#include <mujoco/mujoco.h>

#include <hamel/framework/metric/equations_of_motion.hpp>
#include <hamel/framework/schemes/dynamic_problem.hpp>
#include <hamel/hamel.hpp>

namespace {

using namespace hamel;  // a program, not a header
using Eigen::VectorXd;

constexpr double kLength = 0.3, kMass = 1.2, kMoments[] = {0.02, 0.015, 0.01};
constexpr const char* kAxes[] = {"1 0 0", "0 1 0", "0 0 1"};

Point axis(int i) {
  Point out = {0, 0, 0};
  out[static_cast<size_t>(i % 3)] = 1;
  return out;
}

Mechanism chain(int n) {
  Mechanism m("chain");
  std::string before = kWorld;
  for (int i = 0; i < n; ++i) {
    const std::string link = fmt::format("link {}", i);
    m.body(link, {.mass = kMass,
                  .at = {0.1, 0, -kLength * (i + 0.5)},
                  .inertia = {kMoments[0], kMoments[1], kMoments[2]}});
    m.hinge(fmt::format("hinge {}", i), before, link,
            {.at = {0, 0, -kLength * i}, .axis = axis(i)});
    before = link;
  }
  return m;
}

std::string mjcf(int n) {
  std::string out =
      "<mujoco><option gravity='0 0 -9.81'><flag constraint='disable' sensor='disable'/></option>"
      "<worldbody>";
  for (int i = 0; i < n; ++i)
    out += fmt::format(
        "<body pos='0 0 {}'><joint type='hinge' axis='{}'/>"
        "<inertial pos='0.1 0 {}' mass='{}' diaginertia='{} {} {}'/>",
        i == 0 ? 0 : -kLength, kAxes[i % 3], -kLength / 2, kMass, kMoments[0], kMoments[1],
        kMoments[2]);
  for (int i = 0; i < n; ++i) out += "</body>";
  return out + "</worldbody></mujoco>";
}

struct State {
  VectorXd angles, rates;
};

/// Ours as an explicit scheme calls them: element, then accelerations.
class Hamel {
 public:
  explicit Hamel(int n)
      : model_(chain(n).model()),
        geometry_(registry().geometry(model_.group.name, "exp")),
        motion_(DynamicProblem(geometry_, model_.mechanics)),
        g_(geometry_->size()) {}
  const VectorXd& operator()(const State& state) {
    geometry_->from_coordinates({state.angles.data(), static_cast<size_t>(state.angles.size())},
                                g_.data());
    motion_.solve(0, g_, state.rates);
    return motion_.acceleration();
  }

 private:
  SystemModel model_;
  std::shared_ptr<const Geometry> geometry_;
  EquationsOfMotion<DynamicProblem> motion_;
  VectorXd g_;
};

class MuJoCo {
 public:
  explicit MuJoCo(int n) {
    char error[500] = "";
    mjSpec* spec = mj_parseXMLString(mjcf(n).c_str(), nullptr, error, sizeof error);
    if (spec == nullptr) throw std::runtime_error(error);
    model_.reset(mj_compile(spec, nullptr));
    mj_deleteSpec(spec);
    if (!model_) throw std::runtime_error("MuJoCo compiles no model");
    data_.reset(mj_makeData(model_.get()));
  }
  Eigen::Map<const VectorXd> operator()(const State& state) {
    std::copy(state.angles.begin(), state.angles.end(), data_->qpos);
    std::copy(state.rates.begin(), state.rates.end(), data_->qvel);
    mj_forward(model_.get(), data_.get());
    return {data_->qacc, state.rates.size()};
  }

 private:
  struct Delete {
    void operator()(mjModel* model) const { mj_deleteModel(model); }
    void operator()(mjData* data) const { mj_deleteData(data); }
  };
  std::unique_ptr<mjModel, Delete> model_;
  std::unique_ptr<mjData, Delete> data_;
};

std::vector<State> states(int n, int count) {
  std::mt19937 random(7);
  std::uniform_real_distribution<double> angle(-1.5, 1.5), rate(-2, 2);
  std::vector<State> out;
  for (int i = 0; i < count; ++i)
    out.push_back({VectorXd::NullaryExpr(n, [&] { return angle(random); }),
                   VectorXd::NullaryExpr(n, [&] { return rate(random); })});
  return out;
}

template <class Dynamics>
double nanoseconds(Dynamics& dynamics, const std::vector<State>& all) {
  const auto begin = std::chrono::steady_clock::now();
  double sum = 0;
  for (const State& state : all) sum += dynamics(state)[0];
  const std::chrono::duration<double, std::nano> spent = std::chrono::steady_clock::now() - begin;
  if (std::isnan(sum)) throw std::runtime_error("an acceleration is not a number");
  return spent.count() / static_cast<double>(all.size());
}

}  // namespace

int main(int argc, char** argv) {
  const bool quick = argc > 1 && std::string_view(argv[1]) == "--quick";
  std::printf("MuJoCo %s, nanoseconds an evaluation\n%8s %10s %10s %12s %12s\n", mj_versionString(),
              "hinges", "hamel", "MuJoCo", "hamel/it", "differ by");
  bool agree = true;
  for (const int n : {2, 5, 10, 20, 30, 60}) {
    Hamel ours(n);
    MuJoCo theirs(n);
    const std::vector<State> all = states(n, quick ? 10 : 200);
    double differ = 0;
    for (const State& state : all) {
      const VectorXd a = ours(state), b = theirs(state);
      differ = std::max(differ, (a - b).cwiseAbs().maxCoeff() / b.cwiseAbs().maxCoeff());
    }
    agree = agree && differ <= 1e-9;
    double mine = std::numeric_limits<double>::infinity(), other = mine;
    for (int block = 0; block < (quick ? 1 : 30); ++block) {
      mine = std::min(mine, nanoseconds(ours, all));
      other = std::min(other, nanoseconds(theirs, all));
    }
    std::printf("%8d %10.0f %10.0f %12.2f %12.1e\n", n, mine, other, mine / other, differ);
  }
  if (!agree) std::printf("the accelerations differ by more than 1e-9\n");
  return agree ? 0 : 1;
}
