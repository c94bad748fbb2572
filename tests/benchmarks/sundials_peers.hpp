// SUNDIALS 6 as a user calls it: CVODE (Adams) and ARKODE (explicit pairs) on the equations reduced
// by hand, IDA on the equations with multipliers. What is allocated is allocated once; a run is a
// ReInit and the way to the end.
#pragma once

#include <algorithm>
#include <stdexcept>

#include <arkode/arkode_erkstep.h>
#include <cvode/cvode.h>
#include <ida/ida.h>
#include <nvector/nvector_serial.h>
#include <sunlinsol/sunlinsol_dense.h>
#include <sunmatrix/sunmatrix_dense.h>
#include <sunnonlinsol/sunnonlinsol_fixedpoint.h>

#include <hamel/framework/metric/equations_of_motion.hpp>
#include <hamel/framework/schemes/dynamic_problem.hpp>
#include <hamel/framework/schemes/static_problem.hpp>
#include <hamel/groups/cayley.hpp>

#include "hand_reduced.hpp"

namespace hamel::benchmarks {

/// A SUNDIALS context that lives as long as the program.
inline SUNContext sundials() {
  static SUNContext context = [] {
    SUNContext out = nullptr;
    if (SUNContext_Create(nullptr, &out) != 0) throw std::runtime_error("no SUNDIALS context");
    return out;
  }();
  return context;
}
inline void expect(int flag, const char* what) {
  if (flag < 0) throw std::runtime_error(what);
}

/// y' = f(y) by CVODE's Adams methods (order = 0) or by ARKODE's explicit pair of an order.
template <class Equations>
class SundialsOde {
  static constexpr auto n = static_cast<sunindextype>(Equations::size);
  using State = typename Equations::State;

 public:
  SundialsOde(const Equations& equations, int order)
      : equations_(equations), order_(order), y_(N_VNew_Serial(n, sundials())) {
    start();
    if (order_ > 0) {
      memory_ = ERKStepCreate(rate, 0, y_, sundials());
      expect(ERKStepSetOrder(memory_, order_), "order");
      expect(ERKStepSetUserData(memory_, this), "data");
      expect(ERKStepSetMaxNumSteps(memory_, 1000000), "steps");
      return;
    }
    memory_ = CVodeCreate(CV_ADAMS, sundials());
    expect(CVodeInit(memory_, rate, 0, y_), "init");
    expect(CVodeSetUserData(memory_, this), "data");
    CVodeSetErrFile(memory_, nullptr);
    expect(CVodeSetMaxNumSteps(memory_, 1000000), "steps");
    expect(CVodeSStolerances(memory_, 1e-6, 1e-6), "tolerances");
    solver_ = SUNNonlinSol_FixedPoint(y_, 0, sundials());
    expect(CVodeSetNonlinearSolver(memory_, solver_), "solver");
  }
  SundialsOde(const SundialsOde&) = delete;
  SundialsOde& operator=(const SundialsOde&) = delete;
  ~SundialsOde() {
    if (order_ > 0) ERKStepFree(&memory_);
    else CVodeFree(&memory_);
    if (solver_ != nullptr) SUNNonlinSolFree(solver_);
    N_VDestroy(y_);
  }

  bool operator()(double tolerance, double until) {
    start();
    double t = 0;
    if (order_ > 0) {
      ERKStepReInit(memory_, rate, 0, y_);
      ERKStepSStolerances(memory_, tolerance, tolerance);
      return ERKStepEvolve(memory_, until, y_, &t, ARK_NORMAL) >= 0;
    }
    CVodeReInit(memory_, 0, y_);
    CVodeSStolerances(memory_, tolerance, tolerance);
    return CVode(memory_, until, y_, &t, CV_NORMAL) >= 0;
  }
  std::vector<double> answer() const {
    State y;
    std::copy_n(N_VGetArrayPointer(y_), n, y.begin());
    return equations_.answer(y);
  }

 private:
  void start() {
    const State y = equations_.start();
    std::copy_n(y.begin(), n, N_VGetArrayPointer(y_));
  }
  static int rate(double t, N_Vector y, N_Vector dy, void* self) {
    const auto& equations = static_cast<SundialsOde*>(self)->equations_;
    equations(*reinterpret_cast<const State*>(N_VGetArrayPointer(y)),
              *reinterpret_cast<State*>(N_VGetArrayPointer(dy)), t);
    return 0;
  }

  Equations equations_;
  int order_;
  N_Vector y_;
  void* memory_ = nullptr;
  SUNNonlinearSolver solver_ = nullptr;
};

/// Positions as a user of the equations with multipliers has them: a quaternion for rotations.
template <class G>
struct Positions;
template <>
struct Positions<SO3> {
  static constexpr int size = 4;
  static SO3::Element<double> element(const double* q) { return rotation(q); }
  static void rate(const double* q, const double* xi, double* dq) { turn(q, xi, dq); }
  static void start(const SO3::Element<double>&, double* q) {
    std::fill_n(q, 4, 0.0);
    q[0] = 1;
  }
};
template <>
struct Positions<SE2> {
  static constexpr int size = 3;
  static SE2::Element<double> element(const double* x) {
    return SE2::from_coordinates(std::array{x[0], x[1], x[2]});
  }
  static void rate(const double* x, const double* xi, double* dx) {
    const double c = std::cos(x[0]), s = std::sin(x[0]);
    dx[0] = xi[0];
    dx[1] = c * xi[1] - s * xi[2];
    dx[2] = s * xi[1] + c * xi[2];
  }
  static void start(const SE2::Element<double>&, double* x) { std::fill_n(x, 3, 0.0); }
};
template <>
struct Positions<SE3> {
  static constexpr int size = 7;
  static SE3::Element<double> element(const double* x) {
    return {rotation(x), Vec<3>(x[4], x[5], x[6])};
  }
  static void rate(const double* x, const double* xi, double* dx) {
    turn(x, xi, dx);
    Eigen::Map<Vec<3>>(dx + 4) = rotation(x) * Vec<3>(xi[3], xi[4], xi[5]);
  }
  static void start(const SE3::Element<double>& g, double* x) {  // turned about the axis x
    const double angle = std::atan2(g.rotation(2, 1), g.rotation(1, 1));
    x[0] = std::cos(angle / 2), x[1] = std::sin(angle / 2), x[2] = x[3] = 0;
    for (int i = 0; i < 3; ++i) x[4 + i] = g.translation[i];
  }
};

/// The equations with multipliers, y = (positions, xi, lambda), of index 1 (of index 2, with A xi =
/// 0, IDA's first steps fail at tolerances below 1e-5 on the disk), the errors of lambda not
/// controlled:
///   g' = g xi,   I xi' = ad*_xi I xi + F + A^T lambda,   A(g) xi' + (dA/dt) xi = 0.
template <class S>
class Multipliers {
  using F = Formulas<S>;
  using G = typename S::Group;
  using At = Positions<G>;
  static constexpr int n = F::n, k = F::k, p = At::size;

 public:
  static constexpr int size = p + n + k;

  /// start: as a run of hamel has used it.
  Multipliers(const SystemModel& model, const S& system, const Start& start)
      : formulas_(system),
        rates_(model),
        y_(N_VNew_Serial(size, sundials())),
        rate_(N_VClone(y_)),
        id_(N_VClone(y_)),
        matrix_(SUNDenseMatrix(size, size, sundials())),
        linear_(SUNLinSol_Dense(y_, matrix_, sundials())) {
    formulas_.inertia({}, inertia_);
    const auto g = G::from_coordinates(start.configuration);
    if constexpr (F::constant_constraints()) formulas_.constraints(0, g, a_, b_);
    const auto geometry = std::make_shared<TypedGeometry<Cayley<G>>>();
    EquationsOfMotion<DynamicProblem> motion(DynamicProblem(geometry, model.mechanics));
    Eigen::VectorXd packed(geometry->size()),
        xi = Eigen::Map<const Eigen::VectorXd>(start.velocity.data(), n);
    geometry->from_coordinates(start.configuration, packed.data());
    motion.solve(0, packed, xi);
    y0_.setZero();
    rate0_.setZero();
    At::start(g, y0_.data());
    y0_.template segment<n>(p) = xi;
    y0_.template tail<k>() = motion.reaction();
    At::rate(y0_.data(), xi.data(), rate0_.data());
    rate0_.template segment<n>(p) = motion.acceleration();
    for (int i = 0; i < size; ++i) N_VGetArrayPointer(id_)[i] = i < p + n ? 1 : 0;
    set_out();
    memory_ = IDACreate(sundials());
    expect(IDAInit(memory_, residual, 0, y_, rate_), "init");
    expect(IDASStolerances(memory_, 1e-6, 1e-6), "tolerances");
    expect(IDASetUserData(memory_, this), "data");
    expect(IDASetMaxNumSteps(memory_, 1000000), "steps");
    expect(IDASetId(memory_, id_), "id");
    expect(IDASetSuppressAlg(memory_, 1), "algebraic");  // else it stays at order 1 on the disk
    IDASetErrFile(memory_, nullptr);
    expect(IDASetLinearSolver(memory_, linear_, matrix_), "solver");
  }
  Multipliers(const Multipliers&) = delete;
  Multipliers& operator=(const Multipliers&) = delete;
  ~Multipliers() {
    IDAFree(&memory_);
    SUNLinSolFree(linear_);
    SUNMatDestroy(matrix_);
    for (N_Vector v : {y_, rate_, id_}) N_VDestroy(v);
  }

  bool operator()(double tolerance, double until) {
    set_out();
    double t = 0;
    IDAReInit(memory_, 0, y_, rate_);
    IDASStolerances(memory_, tolerance, tolerance);
    return IDASolve(memory_, until, &t, y_, rate_, IDA_NORMAL) >= 0;
  }
  std::vector<double> answer() const {
    const double* y = N_VGetArrayPointer(y_);
    std::vector<double> out = G::coordinates(At::element(y));
    out.insert(out.end(), y + p, y + p + n);
    return out;
  }

 private:
  void set_out() {
    std::copy_n(y0_.data(), size, N_VGetArrayPointer(y_));
    std::copy_n(rate0_.data(), size, N_VGetArrayPointer(rate_));
  }
  static int residual(double t, N_Vector state, N_Vector rates, N_Vector out, void* self) {
    auto& own = *static_cast<Multipliers*>(self);
    const double *y = N_VGetArrayPointer(state), *dy = N_VGetArrayPointer(rates);
    double* f = N_VGetArrayPointer(out);
    At::rate(y, y + p, f);
    for (int i = 0; i < p; ++i) f[i] = dy[i] - f[i];
    const Eigen::Map<const Vec<n>> xi(y + p), xi_rate(dy + p);
    const Eigen::Map<const Vec<k>> lambda(y + p + n);
    const Vec<n> mu = own.inertia_ * xi;
    Vec<n> force = Vec<n>::Zero();
    Eigen::Map<Vec<k>> rows(f + p + n);
    rows.setZero();
    if constexpr (!F::constant_constraints()) {
      const auto g = At::element(y);
      own.formulas_.constraints(t, g, own.a_, own.b_);
      own.formulas_.force(t, g, xi, force);
      Vec<k> row_rate;
      Vec<n> momentum_rate;
      own.rates_.problem.dual_rates(g, xi, own.a_, row_rate, own.inertia_, momentum_rate);
      rows = -row_rate;
    }
    Eigen::Map<Vec<n>>(f + p) =
        own.inertia_ * xi_rate - G::coad(mu) * xi - force - own.a_.transpose() * lambda;
    rows += own.a_ * xi_rate;
    return 0;
  }

  // dA/dt by one dual number, where A moves.
  struct Rates {
    StaticProblem<S, Cayley<G>> problem;
    explicit Rates(const SystemModel& model)
        : problem(std::shared_ptr<const Geometry>(), model.mechanics) {}
  };
  struct NoRates {
    explicit NoRates(const SystemModel& /*model*/) {}
  };

  F formulas_;
  std::conditional_t<F::constant_constraints(), NoRates, Rates> rates_;
  Mat<n, n> inertia_;
  Mat<k, n> a_;
  Vec<k> b_;
  Vec<size> y0_, rate0_;
  N_Vector y_, rate_, id_;
  SUNMatrix matrix_;
  SUNLinearSolver linear_;
  void* memory_ = nullptr;
};

}  // namespace hamel::benchmarks
