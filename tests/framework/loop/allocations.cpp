// A step allocates nothing on the heap: malloc and its family are counted while the loop runs, for
// every scheme, retraction and composition, m fixed and m chosen at run time.
#include <gtest/gtest.h>

#include <cstdlib>

#include <hamel/framework/contact/contact_problem.hpp>
#include <hamel/framework/run/data/data_system.hpp>
#include <hamel/framework/schemes/composition.hpp>
#include <hamel/groups/product.hpp>
#include <hamel/groups/se2.hpp>
#include <hamel/groups/se3.hpp>
#include <hamel/groups/so2.hpp>
#include <hamel/groups/so3.hpp>
#include <hamel/systems/simulate_typed.hpp>

#include "../schemes/bodies.hpp"

#if defined(__GLIBC__) && !defined(__SANITIZE_ADDRESS__)
#define HAMEL_COUNTS_MALLOC 1
namespace {
long allocations = 0;
}
extern "C" {
void* __libc_malloc(size_t);
void* __libc_calloc(size_t, size_t);
void* __libc_realloc(void*, size_t);
void* __libc_memalign(size_t, size_t);
// operator new and Eigen's allocator call these too.
void* malloc(size_t size) {
  ++allocations;
  return __libc_malloc(size);
}
void* calloc(size_t count, size_t size) {
  ++allocations;
  return __libc_calloc(count, size);
}
void* realloc(void* p, size_t size) {
  ++allocations;
  return __libc_realloc(p, size);
}
void* aligned_alloc(size_t alignment, size_t size) {
  ++allocations;
  return __libc_memalign(alignment, size);
}
}
#else
namespace {
long allocations = 0;
}
#endif

namespace {

using namespace hamel;

class Allocations : public testing::Test {
 protected:
  void SetUp() override {
#ifndef HAMEL_COUNTS_MALLOC
    GTEST_SKIP() << "malloc belongs to the sanitizer here";
#endif
  }
};

TEST_F(Allocations, AreCounted) {
  // (Unknown functions: a compiler may leave out memory that nobody else sees.)
  const auto numbers_of = [](size_t count) { return std::vector<double>(count, 1.0); };
  const auto vector_of = [](size_t count) {
    return Eigen::VectorXd(Eigen::VectorXd::Ones(static_cast<Eigen::Index>(count)));
  };
  std::vector<double> (*volatile numbers)(size_t) = numbers_of;
  Eigen::VectorXd (*volatile vector)(size_t) = vector_of;
  const long before = allocations;
  const double sum = numbers(100).front() + vector(100)[0];
  EXPECT_EQ(allocations - before, 2);
  EXPECT_EQ(sum, 2);
}

long counted(hamel::Run& run, long steps, Status& status) {
  const long before = allocations;
  status = run.step(steps);
  return allocations - before;
}

template <class S>
void expect_none(const S& system, const std::string& compose = "none") {
  for (const std::string& scheme : registry().schemes()) {
    for (const std::string& retraction : registry().retractions(S::Group::name())) {
      for (const double s : {0.0, 0.3}) {
        // boxed_literal takes O(1) steps whatever h is: a small start keeps it inside every domain.
        Start start = system.start();
        for (double& v : start.velocity) v *= 0.2;
        hamel::Run run = simulate(system)
                             .scheme(scheme)
                             .s(s)
                             .retraction(retraction)
                             .start(start)
                             .compose(compose)
                             .with(&Config::force, true)
                             .step(0.02)
                             .build();
        Status status;
        (void)run.step(3);  // the first steps size what is kept
        EXPECT_EQ(counted(run, 20, status), 0)
            << S::Group::name() << " " << scheme << " " << retraction << " s = " << s;
        EXPECT_TRUE(status.ok) << scheme << " " << retraction << ": " << status.reason;
      }
    }
  }
}

TEST_F(Allocations, NoneOnSO3) { expect_none(test::Body<SO3, 1>{}); }  // m = 2: fixed and run time
TEST_F(Allocations, NoneOnSO3Free) { expect_none(test::FreeBody<SO3>{}); }  // m = 3: run time
TEST_F(Allocations, NoneOnSE2) { expect_none(test::Body<SE2, 1>{}); }
TEST_F(Allocations, NoneOnSE3) { expect_none(test::Body<SE3, 2>{}); }
TEST_F(Allocations, NoneOnAProduct) { expect_none(test::Body<Product<SE2, SO2>, 2>{}); }
/// Mechanisms by parts: recursions over a tree of any size.
TEST_F(Allocations, NoneOnMechanisms) {
  for (const std::string system : {"bicycle", "kick_scooter", "skateboard"}) {
    for (const char* scheme : {"lift", "balance", "rkmk4"}) {
      hamel::Run run = simulate(system).scheme(scheme).step(0.002).build();
      run.step(3);
      Status status;
      EXPECT_EQ(counted(run, 20, status), 0) << system << " " << scheme;
      EXPECT_TRUE(status.ok) << system << " " << scheme << ": " << status.reason;
    }
  }
}
/// Contacts that all roll, with their reactions looked at in each step.
TEST_F(Allocations, NoneWhereContactsRoll) {
  for (const char* system : {"falling_disk", "rattleback", "chaplygin_sleigh"}) {
    Simulation simulation = simulate(system);
    simulation.set("friction", 50).tolerance({.relative = 1e-9}).step(1e-3);
    hamel::Run run = simulation.build();
    (void)run.step(5);
    Status status;
    EXPECT_EQ(counted(run, 20, status), 0) << system;
    EXPECT_TRUE(status.ok) << system << ": " << status.reason;
  }
}
/// The contact problem: one contact, several, several with given loads.
TEST_F(Allocations, NoneInTheContactProblem) {
  for (const bool normal : {true, false}) {
    for (const int contacts : {1, 2, 4}) {
      const int each = normal ? 3 : 2, m = each * contacts;
      const Eigen::MatrixXd w = Eigen::MatrixXd::NullaryExpr(
          m, m + 2, [](Eigen::Index i, Eigen::Index j) { return std::sin(2. * i + 3. * j * j); });
      const Eigen::MatrixXd g = w * w.transpose();
      const Eigen::VectorXd c =
          Eigen::VectorXd::NullaryExpr(m, [&](Eigen::Index i) { return i % each == 0 ? -2. : 1.; });
      std::vector<ContactBlock> blocks;
      for (int i = 0; i < contacts; ++i)
        blocks.push_back({.first = each * i,
                          .normal = normal,
                          .tangential = 2,
                          .friction = 0.3,
                          .bound = normal ? 0. : 0.2});
      ContactProblem problem(m, contacts);
      const long before = allocations;
      const auto outcome = problem.solve(g, c, blocks);
      EXPECT_EQ(allocations - before, 0) << contacts << " contacts, normal " << normal;
      EXPECT_EQ(outcome, ContactProblem::Outcome::one);
      EXPECT_LT(contact_residual(g, c, blocks, problem.p()), 1e-13);
    }
  }
}
/// Formulas of every kind, on the run-time path.
TEST_F(Allocations, NoneOnSystemsByData) {
  const char* text = R"toml(
group = "se2*so2"
coordinates = ["theta", "x", "y", "steer"]
inertia = [["2 + cos(steer)^2", 0, 0, 0.1], [0, 2, 0, 0], [0, 0, 2, 0], [0.1, 0, 0, 0.1]]
constraints = [["0.9*cos(steer)", "-sin(steer)", "cos(steer)", 0]]
drift = ["0.01*sin(t)"]
holonomic = ["y - 0.1*sin(x)"]
potential = "0.3*x + 0.5*steer^2"
force = [0, "-0.1*v1", 0, "torque - 0.1*steer'"]
velocity = [0.1, 0.5, 0, 0.2]
[inputs]
torque = {}
)toml";
  for (const char* scheme : {"lift", "balance", "rkmk4"}) {
    for (const double torque : {0.0, 0.1}) {
      Simulation simulation(registry(), "data",
                            OwnSystem{data_system_maker(registry(), "data.toml", text)});
      if (torque != 0) simulation.input("torque", torque);
      hamel::Run run = simulation.scheme(scheme).step(0.002).build();
      (void)run.step(3);
      Status status;
      const long of_call = torque == 0 ? 0 : counted(run, 1, status);  // with inputs some a call
      EXPECT_EQ(counted(run, 20, status), of_call) << scheme << " " << torque;
      EXPECT_TRUE(status.ok) << scheme << ": " << status.reason;
    }
  }
}
/// General systems: fixed n (falling_disk, 6) and n at run time (differential_drive with lift: 5).
TEST_F(Allocations, NoneOnGeneralSystems) {
  for (const std::string& system : registry().systems()) {
    for (const std::string& scheme : registry().schemes()) {
      const SchemeInfo& info = *registry().scheme(scheme);
      if (!info.defined(registry().system(system)->make({}).mechanics->left_invariant())) continue;
      for (const double s : {0.0, 0.5}) {
        hamel::Run run = simulate(system).scheme(scheme).s(s).step(0.002).build();
        run.step(3);  // the first steps size what is kept
        Status status;
        EXPECT_EQ(counted(run, 20, status), 0) << system << " " << scheme << " s = " << s;
        EXPECT_TRUE(status.ok) << system << " " << scheme << ": " << status.reason;
      }
    }
  }
}
/// Of every group's elements, and of products put together at run time.
TEST_F(Allocations, NoneForCoordinates) {
  std::vector<std::string> groups = registry().groups();
  groups.push_back("so3*r2^2*so2");
  for (const std::string& group : groups) {
    std::vector<double> values = registry().group_or_product(group)->identity;
    const auto geometry = registry().geometry(group, "exp");
    std::vector<double> g(static_cast<size_t>(geometry->size()));
    const long before = allocations;
    geometry->from_coordinates(values, g.data());
    geometry->nearest(values, g.data());
    geometry->coordinates(g.data(), values.data());
    EXPECT_EQ(geometry->columns(), static_cast<int>(values.size()));
    EXPECT_EQ(allocations - before, 0) << group;
  }
}
TEST_F(Allocations, NoneWhenComposed) {
  for (const Composition& c : compositions()) expect_none(test::Body<SE2, 1>{}, c.name);
}

}  // namespace
