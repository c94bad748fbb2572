// The cotangent lift of a step: its places, and the momenta at its ends.
//
// With z0 = -s xi, z1 = (1-s) xi, f_i = tau(z_i), base point g = g0 f0^-1, g1 = g f1, the momenta
// carried to the base point, m_i = Ad*_{f_i^-1} mu_i, satisfy (lie/trivialised.hpp)
//   s dR_{z0}^T m0 + (1-s) dR_{z1}^T m1 = p,     m1 - m0 = nu,
// hence m0 = C^-1 (p - (1-s) dR_{z1}^T nu) = dR_{z0}^-T q, C = (s dR_{z0} + (1-s) dR_{z1})^T, m1 =
// m0 + nu, mu_i = Ad_{f_i}^T m_i; at s = 1/2 with a symmetric tau mu0 = dR_{z1}^-T q. Without nu
// the momenta are even +- odd there, in closed form where tau has that (M50).
#pragma once

#include <hamel/framework/lie/trivialised.hpp>
#include <hamel/framework/schemes/problem.hpp>

namespace hamel {

template <class P>
class CotangentLift {
  using Element = typename P::Element;
  using Vector = typename P::Vector;

 public:
  /// impulse: may nu be other than 0?
  CotangentLift(const P& problem, double s, bool impulse)
      : s_(s),
        mirrored_(s == 0.5 && problem.symmetric()),
        split_(kSplits && mirrored_ && !impulse),
        f0_(problem.element()),
        f1_(f0_),
        base_(f0_),
        end_(f0_),
        z_(P::Vector::Zero(problem.dim())),
        q_(z_),
        m_(z_),
        odd_(z_) {}

  /// g and g1 of the step xi from g0.
  void place(const P& problem, const Element& g0, const Vector& xi) {
    z_ = (1 - s_) * xi;
    problem.tau(z_, f1_);
    if (s_ == 0) {
      base_ = g0;
    } else if (mirrored_) {  // f0 = f1^-1, z0 = -z1
      problem.compose(g0, f1_, base_);
    } else {
      z_ = -s_ * xi;
      problem.tau(z_, f0_);
      problem.inverse(f0_, base_);
      problem.compose(g0, base_, base_);
    }
    problem.compose(base_, f1_, end_);
  }
  const Element& base() const { return base_; }
  Element& end() { return end_; }

  /// mu0, behind place().
  void find_start(const P& problem, const Vector& xi, const Vector& p, const Vector& nu,
                  Vector& mu) {
    if constexpr (kSplits) {
      if (split_) {
        problem.end_momenta(xi, p, q_, odd_);
        mu = q_ + odd_;
        return;
      }
    }
    problem.mixed_momentum(s_, xi, p, nu, q_);
    if (mirrored_) {
      problem.dtau_right_inverse_transpose(z_, q_, mu);
    } else if (s_ == 0) {
      m_ = mu = q_;
    } else {
      problem.dtau_right_inverse_transpose(z_, q_, m_);
      problem.Ad_transpose(f0_, m_, mu);
    }
  }
  /// mu1, behind find_start().
  void find_end(const P& problem, const Vector& nu, Vector& mu) {
    if (split_) {
      mu = q_ - odd_;
      return;
    }
    if (mirrored_) {
      z_ = -z_;
      problem.dtau_right_inverse_transpose(z_, q_, m_);
    }
    m_ += nu;
    problem.Ad_transpose(f1_, m_, mu);
  }

 private:
  static constexpr bool kSplits = requires(const P& problem, Vector& x) {
    problem.end_momenta(x, x, x, x);
  };

  double s_;
  bool mirrored_, split_;
  Element f0_, f1_, base_, end_;
  Vector z_, q_, m_, odd_;  // split: q_ is the even part
};

}  // namespace hamel
