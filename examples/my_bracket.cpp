// A Poisson bracket of one's own, from its laws to a long motion. See docs/tutorial_poisson.md.

#include <lagroid/core/poisson/bracket_defects.hpp>
#include <lagroid/solvers/poisson/poisson_integrators.hpp>

#include <cmath>
#include <iostream>

namespace {

using namespace lagroid;

// {f, g} = det(df, dg, dC) on R^3 with C = (x^4 + y^4 + z^4) / 4: motions stay on a rounded cube.
struct RoundedCube : PoissonSystem<RoundedCube, 3> {
  template <class S> Matrix<S, 3, 3> bivector(const Vector<S, 3>& x) const {
    const auto cube = [](const S& a) { return S(a * a * a); };
    return skew<S, 3>({{0, 1, cube(x(2))}, {0, 2, -cube(x(1))}, {1, 2, cube(x(0))}});
  }
  static constexpr int parts = 3;
  template <class S> S part(int i, const S& x) const { return x * x * (0.5 / (1 + i)); }
  template <class S> Vector<S, 1> casimirs(const Vector<S, 3>& x) const {
    S sum(0.0);
    for (int i = 0; i < 3; ++i) sum += x(i) * x(i) * x(i) * x(i);
    return Vector<S, 1>(sum * 0.25);
  }
};

/// How far the Casimir goes in a thousand units of time.
double drift(const char* method) {
  const RoundedCube system;
  const Vector<double, 3> start(0.9, 0.3, 0.6);
  const auto motion = make_poisson_integrator(system, start, {.method = method, .step = 0.1});
  double largest = 0;
  for (int n = 0; n < 10'000 && motion->advance().converged(); ++n) {
    const auto x = motion->point();
    const double casimir = system.casimirs(Vector<double, 3>(x[0], x[1], x[2]))(0);
    largest = std::max(largest, std::abs(casimir - system.casimirs(start)(0)));
  }
  std::cout << method << ": Casimir within " << largest << ", Poisson defect of a step " << motion->poisson_defect()
            << "\n";
  return largest;
}

}  // namespace

int main() {
  const BracketDefect worst = worst_bracket_defect(RoundedCube{}, {0.9, 0.3, 0.6});
  if (worst.relative > 1e-12) std::cout << worst.sentence() << "\n";
  const bool kept = drift("symplectic-groupoid") < 1e-13 && drift("hamilton-jacobi-4") < 1e-13;
  return worst.relative < 1e-12 && kept && drift("runge-kutta") > 1e-8 ? 0 : 1;
}
