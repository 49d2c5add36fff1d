#include <lagroid/solvers/optimisation/manifolds/hyperbolic_space.hpp>

#include <fmt/format.h>

#include <cmath>
#include <stdexcept>

namespace lagroid::optimisation {

namespace {

auto space(Vector& v) { return v.tail(v.size() - 1); }
auto space(const Vector& v) { return v.tail(v.size() - 1); }

/// v = a at + what is orthogonal to it, which is left; returns a. `square` = |at|^2 > 0. Twice, since far out the
/// radial part is the longer one by far.
template <class At, class V> double take_radial_part(const At& at, double square, V&& v) {
  double a = 0;
  for (int k = 0; k < 2; ++k) {
    const double share = at.dot(v) / square;
    v -= share * at;
    a += share;
  }
  return a;
}

/// sinh^2(d / 2) of the distance d.
double half_distance(const Point& x, const Point& y) {
  const double here = space(x).norm();
  const double there = space(y).norm();
  const double along = std::sinh(0.5 * (std::asinh(here) - std::asinh(there)));
  if (here == 0 || there == 0) return along * along;
  return along * along + 0.25 * here * there * (space(x) / here - space(y) / there).squaredNorm();
}

}  // namespace

HyperbolicSpace::HyperbolicSpace(Eigen::Index n) : n_(n), log_(n + 1) {
  if (n < 1) throw std::invalid_argument("hyperbolic space has one dimension or more");
}

std::string HyperbolicSpace::name() const { return fmt::format("hyperbolic space H^{}", n_); }

double HyperbolicSpace::residual(const Point& x) const {
  if (!(x(0) > 0)) return std::numeric_limits<double>::infinity();
  return 0.5 * std::abs((1 + space(x).squaredNorm()) / (x(0) * x(0)) - 1);
}

double HyperbolicSpace::penalty(const Point& x, double weight, Vector& gradient) const {
  const double inverse_square = 1 / (x(0) * x(0));
  const double ratio = (1 + space(x).squaredNorm()) * inverse_square;
  const double c = 0.5 * (ratio - 1);
  gradient(0) -= weight * c * ratio / x(0);
  space(gradient) += weight * c * inverse_square * space(x);
  return 0.5 * weight * c * c;
}

bool HyperbolicSpace::nearest(Point& x) const {
  x(0) = std::hypot(1.0, space(x).norm());
  return x.allFinite();
}

void HyperbolicSpace::project(const Point& x, Vector& v) const { v(0) = space(x).dot(space(v)) / x(0); }

double HyperbolicSpace::inner(const Point& x, const Vector& u, const Vector& v) const {
  const auto at = space(x);
  const double square = at.squaredNorm();
  if (square == 0) return space(u).dot(space(v));
  const double a = at.dot(space(u)) / square;
  const double b = at.dot(space(v)) / square;
  return a * b * square / (1 + square) + (space(u) - a * at).dot(space(v) - b * at);
}

void HyperbolicSpace::gradient(const Point& x, Vector& differential) const {
  differential(0) = -differential(0);
  const double normal = space(x).dot(space(differential)) - x(0) * differential(0);
  space(differential) += normal * space(x);
  project(x, differential);
}

void HyperbolicSpace::differential(const Point& x, Vector& gradient) const {
  const auto at = space(x);
  const double square = at.squaredNorm();
  gradient(0) = 0;
  if (square == 0) return;
  const double outwards = take_radial_part(at, square, space(gradient));
  space(gradient) += outwards / (1 + square) * at;
}

bool HyperbolicSpace::exponential(const Point& x, const Vector& v, Point& to) const {
  const auto at = space(x);
  const double r = at.norm();
  const double time = std::hypot(1.0, r);
  to = v;
  const double along = r > 0 ? take_radial_part(at, r * r, space(to)) * r / time : 0;
  const double across = space(to).norm();
  const double length = std::hypot(along, across);
  const double share = length > 0 ? std::sinh(length) / length : 1;
  space(to) *= share;
  // r cosh|v| + share along x_0, without cancellation where it leads inwards.
  const double radial = along >= 0
                            ? r * std::cosh(length) + share * along * time
                            : std::sinh(std::asinh(r) - length) + share * time * across * across / (length - along);
  if (r > 0) space(to) += radial / r * at;
  return nearest(to);
}

bool HyperbolicSpace::logarithm(const Point& x, const Point& y, Vector& v) const {
  const double half = half_distance(x, y);
  const double distance = 2 * std::asinh(std::sqrt(half));
  const double share = half > 0 ? distance / (2 * std::sqrt(half) * std::sqrt(1 + half)) : 1;
  v = share * (y - x);
  space(v) -= distance * std::sqrt(half / (1 + half)) * space(x);
  project(x, v);
  return v.allFinite();
}

bool HyperbolicSpace::parallel_transport(const Point& from, const Point& to, Vector& v) const {
  if (!logarithm(from, to, log_)) return false;
  const double half = half_distance(from, to);
  const double share = half > 0 ? std::sqrt(half / (1 + half)) / (2 * std::asinh(std::sqrt(half))) : 0.5;
  space(v) += share * inner(from, log_, v) * (space(from) + space(to));
  project(to, v);
  return true;
}

bool HyperbolicSpace::logarithm_by_end(const Point& x, const Point& y, Vector& v) const {
  if (!logarithm(x, y, along_) || !parallel_transport(y, x, v)) return false;
  const double distance = norm(x, along_);
  stretch_across(*this, x, along_, distance > 0 ? distance / std::sinh(distance) : 1, v);
  project(x, v);
  return v.allFinite();
}

bool HyperbolicSpace::logarithm_by_start(const Point& x, const Point& y, Vector& v) const {
  if (!logarithm(x, y, along_)) return false;
  const double distance = norm(x, along_);
  stretch_across(*this, x, along_, distance > 0 ? distance / std::tanh(distance) : 1, v);
  v = -v;
  project(x, v);
  return v.allFinite();
}

void HyperbolicSpace::hessian(const Point& x, const Vector& gradient, const Vector& v, Vector& h) const {
  this->gradient(x, h);
  h += x.dot(gradient) * v;
}

}  // namespace lagroid::optimisation
