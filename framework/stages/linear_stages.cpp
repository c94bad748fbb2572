#include <hamel/framework/stages/linear_stages.hpp>

#include <Eigen/Cholesky>

namespace hamel {

void LinearStage::resize(int state, int inputs, int next) {
  const int all = state + inputs;
  F.setZero(next, state);
  B.setZero(next, inputs);
  H.setZero(all, all);
  d.setZero(next);
  g.setZero(all);
  K.setZero(inputs, state);
  P.setZero(state, state);
  k.setZero(inputs);
  p.setZero(state);
  dz.setZero(state);
  du.setZero(inputs);
  FB.setZero(next, all);
  PF.setZero(next, all);
  M.setZero(all, all);
  q.setZero(next);
  m.setZero(all);
}

static bool is_positive(const Eigen::LLT<Eigen::MatrixXd>& factors) {
  return factors.info() == Eigen::Success && factors.matrixLLT().diagonal().allFinite();
}

// M = H + delta I + [F B]^T P+ [F B], m = g + [F B]^T (p+ + P+ d); the inputs are least:
// K = -M_uu^-1 M_uz, k = -M_uu^-1 m_u, P = M_zz + M_zu K, p = m_z + M_zu k.
bool LinearStages::eliminate(LinearStage& s, const LinearStage& next, double delta) {
  const Eigen::Index n = s.F.cols(), inputs = s.B.cols();
  s.FB.leftCols(n) = s.F;
  s.FB.rightCols(inputs) = s.B;
  s.PF.noalias() = next.P * s.FB;
  s.M = s.H;
  s.M.noalias() += s.FB.transpose() * s.PF;
  s.M.diagonal().array() += delta;
  s.q = next.p;
  s.q.noalias() += next.P * s.d;
  s.m = s.g;
  s.m.noalias() += s.FB.transpose() * s.q;
  s.P = s.M.topLeftCorner(n, n);
  s.p = s.m.head(n);
  if (inputs > 0) {
    const Eigen::LLT<Eigen::MatrixXd> factors(s.M.bottomRightCorner(inputs, inputs));
    if (!is_positive(factors)) return false;
    s.K = -factors.solve(s.M.bottomLeftCorner(inputs, n));
    s.k = -factors.solve(s.m.tail(inputs));
    s.P.noalias() += s.M.topRightCorner(n, inputs) * s.K;
    s.p.noalias() += s.M.topRightCorner(n, inputs) * s.k;
  }
  s.M.topLeftCorner(n, n) = s.P.transpose();
  s.P = 0.5 * (s.P + s.M.topLeftCorner(n, n));
  return s.P.allFinite() && s.p.allFinite();
}

bool LinearStages::sweep(double delta) {
  LinearStage& last = stages.back();
  last.P = last.H;
  last.P.diagonal().array() += delta;
  last.p = last.g;
  for (size_t k = stages.size() - 1; k-- > 0;)
    if (!eliminate(stages[k], stages[k + 1], delta)) return false;
  if (start.cols() == 0) return true;
  const Eigen::LLT<Eigen::MatrixXd> factors(start_information());
  if (!is_positive(factors)) return false;
  w_ = -factors.solve(start.transpose() * stages.front().p);
  return true;
}

void LinearStages::roll() {
  LinearStage& first = stages.front();
  if (start.cols() > 0) first.dz.noalias() = start * w_;
  else first.dz.setZero();
  for (size_t k = 0; k + 1 < stages.size(); ++k) {
    LinearStage& s = stages[k];
    s.du = s.k;
    s.du.noalias() += s.K * s.dz;
    LinearStage& next = stages[k + 1];
    next.dz = s.d;
    next.dz.noalias() += s.F * s.dz;
    next.dz.noalias() += s.B * s.du;
  }
}

void LinearStages::multiplier(int k, Eigen::VectorXd& out) const {
  const LinearStage& s = stages[static_cast<size_t>(k)];
  out = s.p;
  out.noalias() += s.P * s.dz;
}

Eigen::MatrixXd LinearStages::start_information() const {
  return start.transpose() * stages.front().P * start;
}

}  // namespace hamel
