#include <lagroid/solvers/optimisation/manifolds/sphere.hpp>

#include <fmt/format.h>

#include <cmath>
#include <numbers>
#include <stdexcept>

namespace lagroid::optimisation {

Sphere::Sphere(Eigen::Index n) : n_(n), moved_(n) {
  if (n < 2) throw std::invalid_argument("a sphere lies in two dimensions or more");
}

std::string Sphere::name() const { return fmt::format("sphere S^{}", n_ - 1); }
double Sphere::diameter() const { return std::numbers::pi; }

double Sphere::residual(const Point& x) const { return 0.5 * std::abs(x.squaredNorm() - 1); }

double Sphere::penalty(const Point& x, double weight, Vector& gradient) const {
  const double c = 0.5 * (x.squaredNorm() - 1);
  gradient += weight * c * x;
  return 0.5 * weight * c * c;
}

bool Sphere::nearest(Point& x) const {
  const double length = x.norm();
  if (!(length > 0) || !std::isfinite(length)) return false;
  x /= length;
  return true;
}

void Sphere::project(const Point& x, Vector& v) const {
  const double normal = x.dot(v);
  v -= normal * x;
}

bool Sphere::retract(ManifoldRetraction retraction, const Point& x, const Vector& v, Point& to) const {
  const double length = v.norm();
  switch (retraction) {
    case ManifoldRetraction::exponential:
    case ManifoldRetraction::cayley: {
      const double angle = retraction == ManifoldRetraction::cayley ? 2 * std::atan(0.5 * length) : length;
      const double share = length > 0 ? std::sin(angle) / length : 1;
      to = std::cos(angle) * x + share * v;
      return nearest(to);
    }
    case ManifoldRetraction::qr:
    case ManifoldRetraction::polar:
      to = x + v;
      return nearest(to);
    case ManifoldRetraction::orthographic:
      return orthographic(x, v, to, moved_);
  }
  return false;
}

bool Sphere::orthographic(const Point& x, const Vector& z, Point& to, Vector& moved) const {
  moved = z;
  project(x, moved);
  const double square = moved.squaredNorm();
  if (!(square < 1)) return false;
  // sqrt(1 - s) - 1 without cancellation.
  moved -= square / (1 + std::sqrt(1 - square)) * x;
  to = x + moved;
  return nearest(to);
}

bool Sphere::logarithm(const Point& x, const Point& y, Vector& v) const {
  v = y - x;
  project(x, v);
  const double sine = v.norm();
  const double cosine = x.dot(y);
  const double angle = std::atan2(sine, cosine);
  // y = -x is met by geodesics in every direction.
  constexpr double opposite = 1e-8;
  if (std::numbers::pi - angle < opposite) return false;
  if (sine > 0) v *= angle / sine;
  return true;
}

bool Sphere::parallel_transport(const Point& from, const Point& to, Vector& v) const {
  // As for the logarithm, which is not unique where 1 + cos = sin^2 / 2 is below.
  constexpr double opposite = 0.5e-16;
  moved_ = from + to;
  const double sum = 0.5 * moved_.squaredNorm();
  if (!(sum > opposite)) return false;
  v -= to.dot(v) / sum * moved_;
  return true;
}

bool Sphere::logarithm_by_end(const Point& x, const Point& y, Vector& v) const {
  if (!logarithm(x, y, log_) || !parallel_transport(y, x, v)) return false;
  const double angle = log_.norm();
  stretch_across(*this, x, log_, angle > 0 ? angle / std::sin(angle) : 1, v);
  return v.allFinite();
}

bool Sphere::logarithm_by_start(const Point& x, const Point& y, Vector& v) const {
  if (!logarithm(x, y, log_)) return false;
  const double angle = log_.norm();
  stretch_across(*this, x, log_, angle > 0 ? angle / std::tan(angle) : 1, v);
  v = -v;
  return v.allFinite();
}

void Sphere::hessian(const Point& x, const Vector& gradient, const Vector& v, Vector& h) const {
  project(x, h);
  h -= x.dot(gradient) * v;
}

}  // namespace lagroid::optimisation
