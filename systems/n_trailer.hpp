// n_trailer: a car pulling n trailers, each hitched to the axle before it; n is a parameter.
//
//   SE(2) x T^n, xi = (omega, v1, v2, alpha_1', ..., alpha_n'), origin at the axle of the car,
//   alpha_i the heading of trailer i against the car's.
// With alpha_0 = 0, n_i = (cos alpha_i, sin alpha_i), e_i = J n_i, w_i = omega + alpha_i', the
// velocities of the axles in the frame of the car are
//   u_i = u_{i-1} - L_i w_i e_i,   u_0 = (v1, v2);     no slip: e_i . u_i = 0, i = 0..n.
//   l = 1/2 sum_i (m_i |u_i|^2 + J_i w_i^2):
// the masses are at the axles, and the metric depends on alpha.
// With M_j = sum_{i >= j} m_i, P_j = sum_{i >= j} m_i u_i:
//   rows:      row i has e_i on (v1, v2) and -L_j cos(alpha_i - alpha_j) on w_j, 1 <= j <= i,
//   metric:    M_0 on v; -L_j M_j e_j between v and w_j;
//              L_j L_k M_max(j,k) cos(alpha_j - alpha_k) + J_j delta_jk between w_j and w_k,
//   gradient:  dl/dalpha_j = L_j w_j n_j . P_j,
// and w_j = omega + alpha_j' adds the columns of the w_j to that of omega. O(n^2), or O(n) for the
// gradient. Steady motions: the circles R_i^2 = R_{i-1}^2 - L_i^2 about one centre at constant
// speed, where the reactions act along the axles and the hitches carry no force. Source: Laumond
// 1993; Altafini, Some properties of the general n-trailer, Int. J. Control 74 (2001).
#pragma once

#include <array>
#include <functional>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include <hamel/framework/mechanics/mechanics.hpp>
#include <hamel/framework/mechanics/system.hpp>

namespace hamel {

struct NTrailer {
  double trailers = 3;                // n, 1 to 60
  std::vector<double> lengths = {1};  // m, L_i: one for all, or n
  double mass = 2.0;                  // kg, m_0
  double moment = 0.5;                // kg m^2, J_0
  double trailer_mass = 1.0;          // kg, m_i
  double trailer_moment = 0.2;        // kg m^2, J_i

  static std::string name() { return "n_trailer"; }
  static std::string summary() { return "car that pulls n trailers, n a parameter"; }
  static std::string formula() {
    return "SE(2)*T^n, l = 1/2 sum (m_i |u_i|^2 + J_i w_i^2), u_i = u_{i-1} - L_i w_i e_i, "
           "e_i.u_i = 0";
  }
  static std::string known() {
    return "steady circles R_i^2 = R_{i-1}^2 - L_i^2; invariants: energy";
  }
  static std::string source() { return "Laumond 1993; Altafini 2001"; }

  void fields(auto& f) {
    f("trailers", trailers, "1", "number of trailers", between(1, 60));
    f("length", lengths, "m", "axle to axle: one length for all trailers, or one for each",
      positive);
    f("mass", mass, "kg", "mass of the car, at its axle", positive);
    f("inertia", moment, "kg m^2", "moment of the car", non_negative);
    f("trailer_mass", trailer_mass, "kg", "mass of a trailer, at its axle", non_negative);
    f("trailer_inertia", trailer_moment, "kg m^2", "moment of a trailer", non_negative);
  }
  std::string group() const;
  std::vector<std::string> shape() const;  // hitch1, ...
  std::shared_ptr<const Mechanics> mechanics() const;
  /// n, and its lengths, one for each trailer. Throws std::invalid_argument.
  int count() const;
  std::vector<double> each_length() const;

  /// The car at the origin, heading along x, on a circle of this radius to its left, at this speed.
  Start circling(double radius, double speed) const;
  /// Straight on, but for the first trailer, which is turned by 0.4.
  Start start() const;
  /// The positions of the n + 1 axles, and the headings, from the coordinates.
  std::vector<std::array<double, 3>> axles(std::span<const double> coordinates) const;

  template <class Add>
  void invariants(Add& add) const {
    add("energy", energy());
  }
  void draw(Drawing& drawing) const;

 private:
  std::function<double(std::span<const double>, std::span<const double>)> energy() const;
};

}  // namespace hamel
