#include <lagroid/solvers/optimisation/objective.hpp>

#include <algorithm>
#include <cmath>

namespace lagroid::optimisation {

double Objective::value(const Point& x) const {
  before_.resize(x.size());
  return evaluate(x, before_);
}

void Objective::hessian(const Point& x, const Vector& v, Vector& h) const {
  const double length = v.norm();
  h.resize(x.size());
  if (!(length > 0)) {
    h.setZero();
    return;
  }
  // Truncation and rounding balance at the cube root of the precision.
  const double step = 6e-6 * std::max(1.0, x.norm() / std::sqrt(double(x.size()))) / length;
  before_.resize(x.size());
  moved_ = x + step * v;
  evaluate(moved_, h);
  moved_ = x - step * v;
  evaluate(moved_, before_);
  h = (h - before_) / (2 * step);
}

}  // namespace lagroid::optimisation
