#pragma once
/// The step that everybody differentiates, over any scalar: Kepler's problem of unit mass by the midpoint rule,
///
///     (q1 - q0) / h + h / 2 V'((q0 + q1) / 2) = p0,    p1 = p0 - h V'((q0 + q1) / 2),    V = -k / |q|,
///
/// solved by Newton's iteration to round-off, as one writes it for a library that differentiates programs.
///
///     KeplerRun<double> run{{1, 0}, {0, 1.2}, 1};
///     run.go(1000, 0.01);
///
/// Requires steps short enough that six iterations suffice. Nothing throws.

#include <cmath>

namespace peers {

template <class S> struct KeplerRun {
  S q[2];
  S p[2];
  S k;

  void go(long steps, double h) {
    for (long n = 0; n < steps; ++n) step(h);
  }

 private:
  void step(double h) {
    using std::sqrt;
    constexpr int iterations = 6;
    S to[2] = {q[0] + p[0] * h, q[1] + p[1] * h};
    S force[2];
    for (int i = 0; i <= iterations; ++i) {
      const S x = (q[0] + to[0]) * 0.5, y = (q[1] + to[1]) * 0.5;
      const S square = x * x + y * y, cube = square * sqrt(square);
      const S strength = k / cube;
      force[0] = strength * x;
      force[1] = strength * y;
      if (i == iterations) break;
      const S f0 = (to[0] - q[0]) / h + force[0] * (h / 2) - p[0];
      const S f1 = (to[1] - q[1]) / h + force[1] * (h / 2) - p[1];
      const S bend = strength * 3.0 / square;
      const S a = (strength - bend * x * x) * (h / 4) + 1 / h, b = -bend * x * y * (h / 4);
      const S d = (strength - bend * y * y) * (h / 4) + 1 / h;
      const S inverse = 1.0 / (a * d - b * b);
      to[0] = to[0] - (d * f0 - b * f1) * inverse;
      to[1] = to[1] - (a * f1 - b * f0) * inverse;
    }
    for (int i = 0; i < 2; ++i) {
      p[i] = p[i] - force[i] * h;
      q[i] = to[i];
    }
  }
};

}  // namespace peers
