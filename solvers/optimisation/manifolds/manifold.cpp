#include <lagroid/solvers/optimisation/manifolds/manifold.hpp>

#include <cmath>

namespace lagroid::optimisation {

std::string_view to_string(ManifoldRetraction retraction) {
  switch (retraction) {
    case ManifoldRetraction::exponential:
      return "exponential";
    case ManifoldRetraction::qr:
      return "qr";
    case ManifoldRetraction::polar:
      return "polar";
    case ManifoldRetraction::orthographic:
      return "orthographic";
    case ManifoldRetraction::cayley:
      return "cayley";
  }
  return "unknown";
}

double zeta(double least_curvature, double diameter) {
  if (least_curvature >= 0) return 1;
  const double x = std::sqrt(-least_curvature) * diameter;
  // x coth x = 1 + x^2 / 3 - ...
  constexpr double small = 1e-4;
  return x < small ? 1 + x * x / 3 : x / std::tanh(x);
}

}  // namespace lagroid::optimisation
