// The programs of a RecordedLift: its equation over recorded numbers.
#include <hamel/framework/tangent/recorded_lift.hpp>

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>

#include <hamel/framework/graph/derivatives.hpp>
#include <hamel/framework/lie/concepts.hpp>

namespace hamel {
namespace {

using graph::Number;
using Numbers = std::vector<Number>;
using Traces = std::vector<Traced>;

constexpr std::size_t kMostRecords = 20;  // of one run

Traces traced(const Numbers& x) {  // of what no formula of a group branches on
  Traces out;
  for (const Number& one : x) out.emplace_back(one, 0);
  return out;
}
Numbers numbers_of(const Traces& x) {
  Numbers out;
  for (const Traced& one : x) out.push_back(one.number);
  return out;
}
Traces times(const Traced& factor, Traces x) {
  for (Traced& one : x) one = factor * one;
  return x;
}

}  // namespace

// Programs recorded at the inputs of a RecordedLift.
class LiftRecording {
 public:
  LiftRecording(const RecordedLift& out, RecordedLift::Record& record)
      : out_(out), record_(record), geometry_(*out.geometry_) {
    from_ = take("from", out.columns_);
    reference_ = take("reference", out.columns_);
    w_ = take("w", out.n_);
    u_ = take("u", out.inputs_);
    h_ = take("h", 1)[0];
    t_ = take("t", 1)[0];
    eta_ = take("eta", out.n_);
    zero_ = take("zero", out.n_);
    x_ = take("x", out.unknowns_);
    lambda_ = take("lambda", 2 * out.n_);
    rho_ = take("rho", out.unknowns_);
  }

  /// False where the formulas of the system do not allow it.
  bool record() {
    if (!equations()) return false;
    Numbers by = numbers_of(x_);
    const std::size_t unknowns = by.size();
    for (const Traces* part : {&eta_, &w_, &u_})
      for (const Traced& one : *part) by.push_back(one.number);
    by.push_back(h_.number);
    by.push_back(t_.number);
    const Numbers end = this->end();
    for (const Guards::Guard& guard : guards_.all()) record_.guards.push_back(guard.negative);

    Numbers all = residual_;
    all.insert(all.end(), end.begin(), end.end());
    std::vector<Numbers> columns;
    for (std::size_t j = 0; j < by.size(); ++j) {
      Numbers rates(by.size());
      rates[j] = 1;
      columns.push_back(graph::along(all, by, rates));
    }
    record_values(columns, unknowns);
    if (out_.curved_) record_curvature(by, all);
    return true;
  }

 private:
  struct Place {
    graph::SystemFormulas formulas;
    Numbers coordinates;
    std::vector<Numbers> slopes;  // of the coordinates, by eta: a column for each
    std::vector<Numbers> rows;    // A
    Numbers drift;
  };

  Traces take(const char* name, std::size_t count) {
    Traces out;
    for (std::size_t i = 0; i < count; ++i) {
      out.emplace_back(recording_.input(name + std::to_string(i)), out_.in_[taken_]);
      ++taken_;
    }
    return out;
  }
  // The formulas at g(from) way, with a velocity.
  bool find(const Traces& way, const Traced& t, const Numbers& velocity, Place& out) {
    Traces c(out_.columns_);
    geometry_.coordinates(from_.data(), way.data(), c.data());
    out.coordinates = numbers_of(c);
    if (std::ranges::any_of(out.coordinates, [](const Number& x) { return x.constant(); }))
      return false;
    Numbers variables = out.coordinates;
    variables.push_back(t.number);
    for (const Traced& u : u_) variables.push_back(u.number);
    variables.insert(variables.end(), velocity.begin(), velocity.end());
    out.formulas = out_.formulas_(variables);
    Traces moved(way.size());
    Traces aside(way.size());
    geometry_.tau(zero_.data(), aside.data());
    geometry_.compose(way.data(), aside.data(), moved.data());
    geometry_.coordinates(from_.data(), moved.data(), c.data());
    for (std::size_t j = 0; j < out_.n_; ++j) {
      Numbers rates(out_.n_);
      rates[j] = 1;
      out.slopes.push_back(graph::along(numbers_of(c), numbers_of(zero_), rates));
    }
    out.rows = out.formulas.rows;
    for (const Number& phi : out.formulas.holonomic) out.rows.push_back(differential(out, phi));
    out.drift = out.formulas.drift;
    out.drift.resize(out_.k_);
    return true;
  }
  // d y, left-trivialised.
  Numbers differential(const Place& place, const Number& y) const {
    Numbers out(out_.n_);
    if (y.constant()) return out;
    const Numbers by = graph::gradient({y}, {1}, place.coordinates);
    for (std::size_t j = 0; j < out_.n_; ++j)
      for (std::size_t i = 0; i < by.size(); ++i) out[j] += place.slopes[j][i] * by[i];
    return out;
  }
  Numbers momentum(const Place& place, const Numbers& xi) const {
    Numbers out(out_.n_);
    for (std::size_t i = 0; i < out_.n_; ++i)
      for (std::size_t j = 0; j < out_.n_; ++j) out[i] += place.formulas.inertia[i][j] * xi[j];
    return out;
  }
  // f - dV.
  Numbers applied(const Place& place) const {
    Numbers out = place.formulas.force;
    out.resize(out_.n_);
    const Numbers slope = differential(place, place.formulas.potential);
    for (std::size_t i = 0; i < out_.n_; ++i) out[i] -= slope[i];
    return out;
  }
  // 1/2 d(xi^T I xi).
  Numbers inertial(const Place& place, const Numbers& xi) const {
    const Numbers p = momentum(place, xi);
    Number twice = 0;
    for (std::size_t i = 0; i < out_.n_; ++i) twice += p[i] * xi[i];
    Numbers out = differential(place, 0.5 * twice);
    return out;
  }
  // r -= multipliers times rows; then A xi - b.
  void subtract_reaction(const Place& place, const Numbers& multipliers, Numbers& r) const {
    for (std::size_t i = 0; i < out_.k_; ++i)
      for (std::size_t j = 0; j < out_.n_; ++j) r[j] -= multipliers[i] * place.rows[i][j];
  }
  Number row_value(const Place& place, std::size_t i, const Numbers& xi) const {
    Number out = -place.drift[i];
    for (std::size_t j = 0; j < out_.n_; ++j) out += place.rows[i][j] * xi[j];
    return out;
  }
  Numbers unknowns(std::size_t& at, std::size_t count) const {
    Numbers out;
    for (std::size_t i = 0; i < count; ++i) out.push_back(x_[at++].number);
    return out;
  }

  bool equations() {
    const std::size_t n = out_.n_, k = out_.k_;
    const KernelSetup& setup = out_.plan_->setup;
    const double s = setup.s;
    const bool nodal = setup.force_at == ForceAt::nodes;
    std::size_t at = 0;
    Numbers xi0 = numbers_of(w_), alpha;
    if (out_.projects_) {
      xi0 = unknowns(at, n);
      alpha = unknowns(at, k);
    }
    const std::size_t first_v = at;
    const Numbers v = unknowns(at, n), multipliers = unknowns(at, k), xi1 = unknowns(at, n),
                  kappa = unknowns(at, k);
    Traces z(x_.begin() + static_cast<std::ptrdiff_t>(first_v),
             x_.begin() + static_cast<std::ptrdiff_t>(first_v + n));
    z = times(h_, z);
    const auto size = static_cast<std::size_t>(geometry_.size());
    Traces start(size), f0(size), f1(size), middle(size), back(size);
    geometry_.tau(eta_.data(), start.data());
    geometry_.tau(times(1 - s, z).data(), f1.data());
    geometry_.tau(times(-s, z).data(), f0.data());
    geometry_.inverse(f0.data(), back.data());
    middle = start;
    if (s != 0) geometry_.compose(start.data(), back.data(), middle.data());
    end_.resize(size);
    geometry_.compose(middle.data(), f1.data(), end_.data());

    Place place0, base, place1;
    if (!find(start, t_, v, place0) || !find(middle, t_ + s * h_, v, base) ||
        !find(end_, t_ + h_, v, place1))
      return false;
    const Numbers p = momentum(base, v);
    Numbers nu = inertial(base, v);
    if (!nodal) {
      const Numbers f = applied(base);
      for (std::size_t i = 0; i < n; ++i) nu[i] += f[i];
    }
    for (Number& one : nu) one = h_.number * one;
    Traces m0(n), mu0(n), mu1(n);
    geometry_.base_momentum(s, z.data(), traced(p).data(), traced(nu).data(), m0.data());
    for (std::size_t i = 0; i < n; ++i) mu1[i] = m0[i] + Traced(nu[i], 0);
    mu0 = m0;
    if (s != 0) geometry_.Ad_transpose(f0.data(), m0.data(), mu0.data());
    geometry_.Ad_transpose(f1.data(), mu1.data(), mu1.data());

    const auto append = [&](const Numbers& r) {
      residual_.insert(residual_.end(), r.begin(), r.end());
    };
    if (out_.projects_) {
      Numbers change = xi0;
      for (std::size_t i = 0; i < n; ++i) change[i] -= w_[i].number;
      Numbers r = momentum(place0, change);
      subtract_reaction(place0, alpha, r);
      append(r);
      for (std::size_t i = 0; i < k; ++i) residual_.push_back(row_value(place0, i, xi0));
    }
    Numbers first = numbers_of(mu0), last = momentum(place1, xi1);
    const Numbers p0 = momentum(place0, xi0), half0 = applied(place0), half1 = applied(place1);
    for (std::size_t i = 0; i < n; ++i) {
      first[i] -= p0[i];
      last[i] -= mu1[i].number;
      if (!nodal) continue;
      first[i] -= 0.5 * h_.number * half0[i];
      last[i] -= 0.5 * h_.number * half1[i];
    }
    subtract_reaction(place0, multipliers, first);
    subtract_reaction(place1, kappa, last);
    append(first);
    for (std::size_t i = 0; i < k; ++i)
      residual_.push_back(i < k - out_.held_ ? row_value(base, i, v)
                                             : place1.formulas.holonomic[i - (k - out_.held_)]);
    append(last);
    for (std::size_t i = 0; i < k; ++i) residual_.push_back(row_value(place1, i, xi1));
    xi1_ = xi1;
    return true;
  }
  // tau^-1(g_ref^-1 g1), xi_1.
  Numbers end() {
    const auto size = static_cast<std::size_t>(geometry_.size());
    Traces from(size), way(size), e(out_.n_);
    geometry_.from_coordinates(reference_.data(), way.data());
    geometry_.inverse(way.data(), way.data());
    geometry_.from_coordinates(from_.data(), from.data());
    geometry_.compose(way.data(), from.data(), way.data());
    geometry_.compose(way.data(), end_.data(), way.data());
    geometry_.tau_inverse(way.data(), e.data());
    Numbers out = numbers_of(e);
    out.insert(out.end(), xi1_.begin(), xi1_.end());
    return out;
  }

  void add(graph::Program::Outputs& outputs, const Number& y) const {
    outputs.emplace_back("y", y);
  }
  std::unique_ptr<graph::Code> code(const graph::Program::Outputs& outputs) const {
    return std::make_unique<graph::Code>(
        std::make_shared<const graph::Program>(recording_, outputs));
  }
  void begin(graph::Program::Outputs& outputs) const {
    for (const Number& r : residual_) add(outputs, r);
    for (const Guards::Guard& guard : guards_.all()) add(outputs, guard.difference);
  }
  void record_values(const std::vector<Numbers>& columns, std::size_t unknowns) {
    graph::Program::Outputs equation, all;
    begin(equation);
    begin(all);
    const auto entry = [&](graph::Program::Outputs& outputs, RecordedLift::Sparse& to,
                           std::size_t row, std::size_t column, const Number& value) {
      if (value.is(0)) return;
      to.entries.push_back(
          {static_cast<Eigen::Index>(row), static_cast<Eigen::Index>(column), outputs.size()});
      add(outputs, value);
    };
    for (std::size_t j = 0; j < columns.size(); ++j) {
      const bool of_x = j < unknowns;
      const std::size_t column = of_x ? j : j - unknowns;
      for (std::size_t i = 0; i < columns[j].size(); ++i) {
        const bool of_end = i >= unknowns;
        const std::size_t row = of_end ? i - unknowns : i;
        RecordedLift::Sparse& to = of_end ? (of_x ? record_.end_by_x : record_.end_by_q)
                                          : (of_x ? record_.by_x : record_.by_q);
        entry(all, to, row, column, columns[j][i]);
        if (of_x && !of_end) entry(equation, record_.equation_by_x, row, column, columns[j][i]);
      }
    }
    record_.equation = code(equation);
    record_.first = code(all);
  }
  // The lower triangle of the second derivatives of lambda . S + rho . R.
  void record_curvature(const Numbers& by, const Numbers& all) {
    Numbers weights = numbers_of(rho_);
    for (const Traced& one : lambda_) weights.push_back(one.number);
    const std::vector<Numbers> second = graph::hessian(all, weights, by);
    graph::Program::Outputs outputs;
    for (std::size_t i = 0; i < by.size(); ++i)
      for (std::size_t j = 0; j <= i; ++j) {
        if (second[i][j].is(0)) continue;
        record_.curvature.entries.push_back(
            {static_cast<Eigen::Index>(i), static_cast<Eigen::Index>(j), outputs.size()});
        add(outputs, second[i][j]);
      }
    record_.second = code(outputs);
  }

  const RecordedLift& out_;
  RecordedLift::Record& record_;
  const RecordedGeometry& geometry_;
  graph::Recording recording_;
  Guards guards_;
  std::size_t taken_ = 0;
  Traces from_, reference_, w_, u_, eta_, zero_, x_, lambda_, rho_;
  Traced h_, t_;
  Numbers residual_, xi1_;
  Traces end_;
};

bool RecordedLift::record() {
  if (no_more_ || records_.size() >= kMostRecords) return false;
  auto record = std::make_unique<Record>();
  try {
    if (!LiftRecording(*this, *record).record()) {
      no_more_ = true;
      return false;
    }
  } catch (const DomainError&) {
    return false;
  } catch (const std::domain_error&) {  // a part of the system is no formula
    no_more_ = true;
    return false;
  }
  for (const graph::Code* code :
       {record->equation.get(), record->first.get(), record->second.get()}) {
    if (code == nullptr) continue;
    out_.resize(std::max(out_.size(), code->program().results().size()));
    work_.resize(std::max(work_.size(), code->work_size()));
  }
  records_.push_back(std::move(record));
  clear_matrices();
  return true;
}

}  // namespace hamel
