// The leanest loops for one system, one retraction and s = 0, as a numerical analyst writes them:
// cubic extrapolation, Newton with the analytic Jacobian until the correction is below 1e-9 of the
// solution (the next one is below round-off), no renormalisation, no tolerance on the residual, no
// statistics.
#pragma once

namespace hamel::benchmarks {

/// The guess of cubic extrapolation; the oldest solution is the first to go.
struct Cubic {
  double a[4], b[4];
  Cubic(double x, double y) : a{x, x, x, x}, b{y, y, y, y} {}
  double next_a() const { return 4 * (a[0] + a[2]) - 6 * a[1] - a[3]; }
  double next_b() const { return 4 * (b[0] + b[2]) - 6 * b[1] - b[3]; }
  void push(double x, double y) {
    for (int i = 3; i > 0; --i) {
      a[i] = a[i - 1];
      b[i] = b[i - 1];
    }
    a[0] = x;
    b[0] = y;
  }
};

/// Suslov with full inertia, forbidden axis e3, Cayley.
struct LeanSuslov {
  double i11 = 2, i12 = 0.3, i13 = 0.5, i22 = 3, i23 = 0.4, h = 0.01;
  double r[3][3] = {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}};
  double mu1, mu2;
  Cubic guess;

  LeanSuslov(double a, double b) : mu1(i11 * a + i12 * b), mu2(i12 * a + i22 * b), guess(a, b) {}

  bool step_cayley() {
    double a = guess.next_a(), b = guess.next_b(), x, y, p1, p2, p3, d;
    for (int k = 0;; ++k) {  // p + x cross p/2 + x (x.p)/4 = mu on rows 1, 2
      if (k == 20) return false;
      x = h * a;
      y = h * b;
      p1 = i11 * a + i12 * b;
      p2 = i12 * a + i22 * b;
      p3 = i13 * a + i23 * b;
      d = x * p1 + y * p2;
      const double f1 = p1 + y * p3 / 2 + x * d / 4 - mu1, f2 = p2 - x * p3 / 2 + y * d / 4 - mu2;
      const double da = 2 * h * p1, db = 2 * h * p2;
      const double j11 = i11 + y * i13 / 2 + (h * d + x * da) / 4,
                   j12 = i12 + (h * p3 + y * i23) / 2 + x * db / 4,
                   j21 = i12 - (h * p3 + x * i13) / 2 + y * da / 4,
                   j22 = i22 - x * i23 / 2 + (h * d + y * db) / 4;
      const double det = 1 / (j11 * j22 - j12 * j21);
      const double u = det * (j22 * f1 - j12 * f2), v = det * (j11 * f2 - j21 * f1);
      a -= u;
      b -= v;
      if (u * u + v * v < 1e-18 * (a * a + b * b)) break;
    }
    guess.push(a, b);
    x = h * a;
    y = h * b;
    p1 = i11 * a + i12 * b;
    p2 = i12 * a + i22 * b;
    p3 = i13 * a + i23 * b;
    d = x * p1 + y * p2;
    mu1 = p1 - y * p3 / 2 + x * d / 4;
    mu2 = p2 + x * p3 / 2 + y * d / 4;
    const double k = 1 / (1 + (x * x + y * y) / 4);
    const double f[3][3] = {{1 - k * y * y / 2, k * x * y / 2, k * y},
                            {k * x * y / 2, 1 - k * x * x / 2, -k * x},
                            {-k * y, k * x, 1 - k * (x * x + y * y) / 2}};
    for (auto& row : r) {
      const double r0 = row[0], r1 = row[1], r2 = row[2];
      for (int j = 0; j < 3; ++j) row[j] = r0 * f[0][j] + r1 * f[1][j] + r2 * f[2][j];
    }
    return true;
  }
};

}  // namespace hamel::benchmarks
