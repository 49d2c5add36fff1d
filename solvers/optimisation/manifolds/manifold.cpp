#include <lagroid/solvers/optimisation/manifolds/manifold.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <stdexcept>

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

bool Manifold::orthographic(const Point&, const Vector&, Point&, Vector&) const {
  refuse(ManifoldRetraction::orthographic);
}

void Manifold::refuse(ManifoldRetraction retraction) const {
  std::string offered;
  for (const ManifoldRetraction each :
       {ManifoldRetraction::exponential, ManifoldRetraction::qr, ManifoldRetraction::polar,
        ManifoldRetraction::orthographic, ManifoldRetraction::cayley})
    if (offers(each)) offered += fmt::format("{}{}", offered.empty() ? "" : ", ", to_string(each));
  throw std::invalid_argument(
      fmt::format("the {} has no retraction {}; take one of: {}", name(), to_string(retraction), offered));
}

ManifoldRetraction chosen_retraction(const Manifold& manifold, std::optional<ManifoldRetraction> asked) {
  if (!asked) return manifold.offers(ManifoldRetraction::qr) ? ManifoldRetraction::qr : ManifoldRetraction::exponential;
  if (!manifold.offers(*asked)) manifold.refuse(*asked);
  return *asked;
}

double zeta(double least_curvature, double diameter) {
  if (least_curvature >= 0) return 1;
  const double x = std::sqrt(-least_curvature) * diameter;
  // x coth x = 1 + x^2 / 3 - ...
  constexpr double small = 1e-4;
  return x < small ? 1 + x * x / 3 : x / std::tanh(x);
}

double zeta(const Manifold& manifold, double domain) {
  const double curvature = manifold.least_curvature();
  if (curvature >= 0) return 1;
  const double diameter = domain > 0 ? std::min(domain, manifold.diameter()) : manifold.diameter();
  if (!std::isfinite(diameter))
    throw std::invalid_argument(
        fmt::format("the {} curves down to {:g} and has no diameter; give that of a domain with the start and the "
                    "minimum in it, or lambda",
                    manifold.name(), curvature));
  return zeta(curvature, diameter);
}

void stretch_across(const Manifold& manifold, const Point& x, const Vector& along, double factor, Vector& v) {
  const double square = manifold.inner(x, along, along);
  const double part = square > 0 ? manifold.inner(x, along, v) / square : 0;
  v = factor * v + (1 - factor) * part * along;
}

}  // namespace lagroid::optimisation
