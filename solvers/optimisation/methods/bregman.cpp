#include <lagroid/solvers/optimisation/methods/bregman.hpp>

#include <cmath>
#include <stdexcept>

namespace lagroid::optimisation {

void check(const Bregman& b) {
  if (!(b.p > 0) || !(b.c > 0) || !(b.po > 0) || !std::isfinite(b.p * b.c * b.po))
    throw std::invalid_argument("p, p-ring and C of a Bregman Hamiltonian are positive");
  if (b.lambda && (!(*b.lambda >= 1) || !std::isfinite(*b.lambda)))
    throw std::invalid_argument("lambda = zeta / alpha is at least 1");
}

Coefficients coefficients(const Bregman& b, double t, double h) {
  const double lambda = b.lambda.value_or(1);
  if (b.kind == Bregman::Kind::direct)
    return {h * b.p / std::pow(t, lambda * b.p + 1), h * b.c * b.p * std::pow(t, (lambda + 1) * b.p - 1), t + h};
  const double share = b.po / b.p;
  return {h * b.p / share / std::pow(t, lambda * b.p + share),
          h * b.c * b.p / share * std::pow(t, (lambda + 1) * b.p - share), t + h / share * std::pow(t, 1 - share)};
}

}  // namespace lagroid::optimisation
