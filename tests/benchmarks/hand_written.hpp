// Loops written by hand for one system, one retraction and s = 0: plain doubles, the zeros of the
// problem used, the same Newton policy, guess, tolerance and re-normalisation as the library's.
//
// Unknown: the two admissible velocities (a, b); equation E^T (dR_xi)^-T I xi/h = mu on those two
// rows.
#pragma once

#include <array>
#include <cmath>

namespace hamel::benchmarks {

struct Pair {
  double a = 0, b = 0;
};

/// Two equations with their Jacobian [[j11, j12], [j21, j22]].
struct Equations {
  double f1, f2, j11, j12, j21, j22;
};

/// Cubic extrapolation of the last four solutions (lower at the start).
struct Guess {
  std::array<Pair, 4> x;
  int count = 0;
  void push(Pair latest) {
    x[3] = x[2];
    x[2] = x[1];
    x[1] = x[0];
    x[0] = latest;
    if (count < 4) ++count;
  }
  Pair next() const {
    const auto mix = [&](double c0, double c1, double c2, double c3) {
      return Pair{c0 * x[0].a + c1 * x[1].a + c2 * x[2].a + c3 * x[3].a,
                  c0 * x[0].b + c1 * x[1].b + c2 * x[2].b + c3 * x[3].b};
    };
    switch (count) {
      case 1: return x[0];
      case 2: return mix(2, -1, 0, 0);
      case 3: return mix(3, -3, 1, 0);
      default: return mix(4, -6, 4, -1);
    }
  }
};

/// Newton, at least one correction, Jacobian kept while it contracts. equations(x, with_jacobian).
template <class F>
bool newton(const F& equations, double scale, double tolerance, Pair& x) {
  for (int fresh = 0; fresh < 20; ++fresh) {
    const Equations e = equations(x, true);
    double residual = std::sqrt(e.f1 * e.f1 + e.f2 * e.f2) / scale;
    if (fresh > 0 && residual <= tolerance) return true;
    if (residual <= 2.3e-16) return true;
    const double det = 1 / (e.j11 * e.j22 - e.j12 * e.j21);
    double f1 = e.f1, f2 = e.f2;
    for (int chord = 0; chord < 20; ++chord) {
      const Pair trial = {x.a - det * (e.j22 * f1 - e.j12 * f2),
                          x.b - det * (e.j11 * f2 - e.j21 * f1)};
      const Equations at = equations(trial, false);
      const double next = std::sqrt(at.f1 * at.f1 + at.f2 * at.f2) / scale;
      if (!(next < residual)) return residual <= 1e-14;
      const bool contracts = next <= 0.1 * residual;
      x = trial;
      f1 = at.f1;
      f2 = at.f2;
      residual = next;
      if (residual <= tolerance) return true;
      if (!contracts) break;
    }
  }
  return false;
}

/// Suslov with full inertia, forbidden axis e3.
struct HandSuslov {
  double i11 = 2, i12 = 0.3, i13 = 0.5, i22 = 3, i23 = 0.4, h = 0.01;
  double r[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  double mu1, mu2;
  Guess guess;

  HandSuslov(double a, double b) : mu1(i11 * a + i12 * b), mu2(i12 * a + i22 * b) {
    guess.push({a, b});
  }

  // r <- r f, then one Newton step of the polar factor, r (3 I - r^T r)/2.
  void turn(const double (&f)[3][3]) {
    double p[3][3], c[3][3];
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        p[i][j] = r[i][0] * f[0][j] + r[i][1] * f[1][j] + r[i][2] * f[2][j];
    for (int i = 0; i < 3; ++i)
      for (int j = i; j < 3; ++j)
        c[i][j] = c[j][i] = (i == j ? 1.5 : 0.0) -
                            0.5 * (p[0][i] * p[0][j] + p[1][i] * p[1][j] + p[2][i] * p[2][j]);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j)
        r[i][j] = p[i][0] * c[0][j] + p[i][1] * c[1][j] + p[i][2] * c[2][j];
  }

  bool step_cayley() {
    // p = I Omega, x = h (a, b, 0): (p + x cross p/2 + x (x.p)/4) on rows 1, 2.
    const auto equations = [this](Pair w, bool jacobian) {
      const double p1 = i11 * w.a + i12 * w.b, p2 = i12 * w.a + i22 * w.b,
                   p3 = i13 * w.a + i23 * w.b;
      const double x = h * w.a, y = h * w.b, d = x * p1 + y * p2;
      Equations e{p1 + y * p3 / 2 + x * d / 4 - mu1, p2 - x * p3 / 2 + y * d / 4 - mu2, 0, 0, 0, 0};
      if (jacobian) {
        const double da = 2 * h * p1, db = 2 * h * p2;  // gradient of d, since d = h w^T I w
        e.j11 = i11 + y * i13 / 2 + (h * d + x * da) / 4;
        e.j12 = i12 + (h * p3 + y * i23) / 2 + x * db / 4;
        e.j21 = i12 - (h * p3 + x * i13) / 2 + y * da / 4;
        e.j22 = i22 - x * i23 / 2 + (h * d + y * db) / 4;
      }
      return e;
    };
    Pair w = guess.next();
    if (!newton(equations, 2 * std::sqrt(mu1 * mu1 + mu2 * mu2), 1e-13, w)) return false;
    guess.push(w);
    const double p1 = i11 * w.a + i12 * w.b, p2 = i12 * w.a + i22 * w.b, p3 = i13 * w.a + i23 * w.b;
    const double x = h * w.a, y = h * w.b, d = x * p1 + y * p2;
    mu1 = p1 - y * p3 / 2 + x * d / 4;
    mu2 = p2 + x * p3 / 2 + y * d / 4;
    const double k = 1 / (1 + (x * x + y * y) / 4);  // cay = I + k (x^ + x^ x^/2)
    turn({{1 - k * y * y / 2, k * x * y / 2, k * y},
          {k * x * y / 2, 1 - k * x * x / 2, -k * x},
          {-k * y, k * x, 1 - k * (x * x + y * y) / 2}});
    return true;
  }

  bool step_exp() {
    // (dR^-1)^T p = p + x cross p/2 + c x cross (x cross p), c = (1 - g)/t^2, g = (t/2) cot(t/2), t
    // = |x|.
    const auto equations = [this](Pair w, bool jacobian) {
      const double p1 = i11 * w.a + i12 * w.b, p2 = i12 * w.a + i22 * w.b,
                   p3 = i13 * w.a + i23 * w.b;
      const double x = h * w.a, y = h * w.b, t = x * x + y * y, d = x * p1 + y * p2;
      const double c =
          1. / 12 + t * (1. / 720 + t * (1. / 30240 + t * (1. / 1209600 + t / 47900160)));
      const double u1 = x * d - t * p1, u2 = y * d - t * p2;  // x cross (x cross p) = x (x.p) - t p
      Equations e{p1 + y * p3 / 2 + c * u1 - mu1, p2 - x * p3 / 2 + c * u2 - mu2, 0, 0, 0, 0};
      if (jacobian) {
        const double dc = 1. / 720 + t * (2. / 30240 + t * (3. / 1209600 + t * 4 / 47900160));
        const double da = 2 * h * p1, db = 2 * h * p2, ta = 2 * h * x, tb = 2 * h * y;
        e.j11 = i11 + y * i13 / 2 + dc * ta * u1 + c * (h * d + x * da - ta * p1 - t * i11);
        e.j12 = i12 + (h * p3 + y * i23) / 2 + dc * tb * u1 + c * (x * db - tb * p1 - t * i12);
        e.j21 = i12 - (h * p3 + x * i13) / 2 + dc * ta * u2 + c * (y * da - ta * p2 - t * i12);
        e.j22 = i22 - x * i23 / 2 + dc * tb * u2 + c * (h * d + y * db - tb * p2 - t * i22);
      }
      return e;
    };
    Pair w = guess.next();
    if (!newton(equations, 2 * std::sqrt(mu1 * mu1 + mu2 * mu2), 1e-13, w)) return false;
    guess.push(w);
    const double p1 = i11 * w.a + i12 * w.b, p2 = i12 * w.a + i22 * w.b, p3 = i13 * w.a + i23 * w.b;
    const double x = h * w.a, y = h * w.b, t = x * x + y * y, d = x * p1 + y * p2;
    const double c =
        1. / 12 + t * (1. / 720 + t * (1. / 30240 + t * (1. / 1209600 + t / 47900160)));
    mu1 = p1 - y * p3 / 2 + c * (x * d - t * p1);
    mu2 = p2 + x * p3 / 2 + c * (y * d - t * p2);
    const double s = 1 - t / 6 * (1 - t / 20 * (1 - t / 42 * (1 - t / 72)));
    const double k = 0.5 - t / 24 * (1 - t / 30 * (1 - t / 56 * (1 - t / 90)));
    turn({{1 - k * y * y, k * x * y, s * y},
          {k * x * y, 1 - k * x * x, -s * x},
          {-s * y, s * x, 1 - k * t}});
    return true;
  }
};

/// Chaplygin sleigh, xi = (omega, v, 0).
struct HandSleigh {
  double mass = 1, offset = 0.2, about_blade = 0.1 + 0.04, h = 0.01;
  double cosine = 1, sine = 0, x = 0, y = 0;
  int turns = 0;
  double mu1, mu2;
  Guess guess;

  HandSleigh(double omega, double v) : mu1(about_blade * omega), mu2(mass * v) {
    guess.push({omega, v});
  }

  // g <- g (c, s, dx, dy), the rotation back on the circle by one Newton step.
  void move(double c, double s, double dx, double dy) {
    x += cosine * dx - sine * dy;
    y += sine * dx + cosine * dy;
    const double nc = cosine * c - sine * s, ns = sine * c + cosine * s;
    if (nc < 0 && sine * ns < 0) turns += ns < 0 ? 1 : -1;  // the heading is unwrapped
    const double k = (3 - (nc * nc + ns * ns)) / 2;
    cosine = k * nc;
    sine = k * ns;
  }

  // With w = h omega, v = h v1 and p = I xi/h = (J omega, m v1, m a omega): the two rows of
  // (dR^-1)^T p (sign = +1) or (dL^-1)^T p (sign = -1); e = 1/4 for Cayley, c(w) for exp.
  bool step_cayley() {
    const auto rows = [this](Pair u, double sign) {
      const double w = h * u.a, v = h * u.b, p1 = about_blade * u.a, p2 = mass * u.b,
                   p3 = mass * offset * u.a;
      const double d = (2 * w * p1 + v * p2) / 4;
      // I - sign ad/2 + w xi e_w^T/4, transposed.
      return Pair{p1 + w * p1 / 4 * w + v * p2 / 4 * w + sign * (-v * p3) / 2 + 0 * d,
                  p2 + sign * w * p3 / 2};
    };
    const auto equations = [&](Pair u, bool jacobian) {
      const Pair f = rows(u, 1);
      Equations e{f.a - mu1, f.b - mu2, 0, 0, 0, 0};
      if (jacobian) {
        const double w = h * u.a, v = h * u.b, ma = mass * offset;
        e.j11 = about_blade + 3 * w * w * about_blade / 4 + h * v * mass * u.b / 4 - v * ma / 2;
        e.j12 = w * h * mass * u.b / 2 - h * ma * u.a / 2;
        e.j21 = w * ma;
        e.j22 = mass;
      }
      return e;
    };
    Pair u = guess.next();
    if (!newton(equations, 2 * std::sqrt(mu1 * mu1 + mu2 * mu2), 1e-13, u)) return false;
    guess.push(u);
    const Pair after = rows(u, -1);
    mu1 = after.a;
    mu2 = after.b;
    const double w = h * u.a, v = h * u.b, k = 1 / (1 + w * w / 4);
    move((1 - w * w / 4) * k, w * k, v * k, v * w * k / 2);
    return true;
  }

  bool step_exp() {
    const auto series = [](double t) {
      return 1. / 12 + t * (1. / 720 + t * (1. / 30240 + t * (1. / 1209600 + t / 47900160)));
    };
    // ad^2 = -w^2 on the translations and carries (w v2, -w v1) from omega: with v2 = 0,
    // (ad^2)^T p = (w (v p2), -w^2 p2, -w^2 p3).
    const auto rows = [&](Pair u, double sign) {
      const double w = h * u.a, v = h * u.b, p1 = about_blade * u.a, p2 = mass * u.b,
                   p3 = mass * offset * u.a, c = series(w * w);
      return Pair{p1 - sign * v * p3 / 2 + c * w * v * p2, p2 + sign * w * p3 / 2 - c * w * w * p2};
    };
    const auto equations = [&](Pair u, bool jacobian) {
      const Pair f = rows(u, 1);
      Equations e{f.a - mu1, f.b - mu2, 0, 0, 0, 0};
      if (jacobian) {
        const double w = h * u.a, v = h * u.b, ma = mass * offset, t = w * w, c = series(t);
        const double dc =
            2 * h * w * (1. / 720 + t * (2. / 30240 + t * (3. / 1209600 + t * 4 / 47900160)));
        const double p2 = mass * u.b;
        e.j11 = about_blade - v * ma / 2 + (c * h + dc * w) * v * p2;
        e.j12 = -h * ma * u.a / 2 + c * w * 2 * h * p2;
        e.j21 = w * ma - (2 * c * h * w + dc * t) * p2;
        e.j22 = mass - c * t * mass;
      }
      return e;
    };
    Pair u = guess.next();
    if (!newton(equations, 2 * std::sqrt(mu1 * mu1 + mu2 * mu2), 1e-13, u)) return false;
    guess.push(u);
    const Pair after = rows(u, -1);
    mu1 = after.a;
    mu2 = after.b;
    const double w = h * u.a, v = h * u.b, t = w * w;
    const double s = 1 - t / 6 * (1 - t / 20 * (1 - t / 42 * (1 - t / 72)));
    const double k = 0.5 - t / 24 * (1 - t / 30 * (1 - t / 56 * (1 - t / 90)));
    move(1 - k * t, s * w, s * v, k * w * v);
    return true;
  }
};

}  // namespace hamel::benchmarks
