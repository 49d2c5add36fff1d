#include <lagroid/solvers/optimisation/manifolds/product.hpp>

#include <algorithm>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <utility>

namespace lagroid::optimisation {

ProductManifold::ProductManifold(std::vector<std::unique_ptr<Manifold>> factors) : factors_(std::move(factors)) {
  if (factors_.empty()) throw std::invalid_argument("a product has factors");
  first_.push_back(0);
  for (const auto& factor : factors_) first_.push_back(first_.back() + factor->size());
  for (const auto& factor : factors_) {
    const Vector zero = Vector::Zero(factor->size());
    buffers_.push_back({zero, zero, zero, zero});
    has_own_metric_ = has_own_metric_ || factor->has_own_metric();
  }
}

/// `f` of every factor, with what cuts its part out of a vector; false as soon as one is.
template <class F> bool ProductManifold::each(const F& f) const {
  for (std::size_t i = 0; i < factors_.size(); ++i) {
    const auto part = [&, i](auto& vector) { return vector.segment(first_[i], factors_[i]->size()); };
    if (!f(*factors_[i], buffers_[i], part)) return false;
  }
  return true;
}

std::string ProductManifold::name() const {
  std::string out;
  for (std::size_t i = 0; i < factors_.size();) {
    const std::string name = factors_[i]->name();
    std::size_t end = i + 1;
    while (end < factors_.size() && factors_[end]->name() == name) ++end;
    out += (out.empty() ? "" : " x ") + (end - i > 1 ? std::to_string(end - i) + " times the " : "") + name;
    i = end;
  }
  return out;
}

Eigen::Index ProductManifold::dimension() const {
  Eigen::Index out = 0;
  for (const auto& factor : factors_) out += factor->dimension();
  return out;
}

double ProductManifold::residual(const Point& x) const {
  double largest = 0;
  each([&](const Manifold& factor, Buffers& at, const auto& part) {
    at.x = part(x);
    const double residual = factor.residual(at.x);
    largest = std::isnan(residual) ? residual : std::max(largest, residual);
    return !std::isnan(residual);
  });
  return largest;
}

double ProductManifold::penalty(const Point& x, double weight, Vector& gradient) const {
  double sum = 0;
  each([&](const Manifold& factor, Buffers& at, const auto& part) {
    at.x = part(x);
    at.y = part(gradient);
    sum += factor.penalty(at.x, weight, at.y);
    part(gradient) = at.y;
    return true;
  });
  return sum;
}

bool ProductManifold::nearest(Point& x) const {
  return each([&](const Manifold& factor, Buffers& at, const auto& part) {
    at.x = part(x);
    const bool found = factor.nearest(at.x);
    part(x) = at.x;
    return found;
  });
}

void ProductManifold::project(const Point& x, Vector& v) const {
  each([&](const Manifold& factor, Buffers& at, const auto& part) {
    at.x = part(x);
    at.y = part(v);
    factor.project(at.x, at.y);
    part(v) = at.y;
    return true;
  });
}

double ProductManifold::inner(const Point& x, const Vector& u, const Vector& v) const {
  if (!has_own_metric_) return u.dot(v);
  double sum = 0;
  each([&](const Manifold& factor, Buffers& at, const auto& part) {
    at.x = part(x);
    at.y = part(u);
    at.z = part(v);
    sum += factor.inner(at.x, at.y, at.z);
    return true;
  });
  return sum;
}

void ProductManifold::gradient(const Point& x, Vector& differential) const {
  each([&](const Manifold& factor, Buffers& at, const auto& part) {
    at.x = part(x);
    at.y = part(differential);
    factor.gradient(at.x, at.y);
    part(differential) = at.y;
    return true;
  });
}

void ProductManifold::differential(const Point& x, Vector& gradient) const {
  each([&](const Manifold& factor, Buffers& at, const auto& part) {
    at.x = part(x);
    at.y = part(gradient);
    factor.differential(at.x, at.y);
    part(gradient) = at.y;
    return true;
  });
}

template <class Change>
bool ProductManifold::change_between(const Point& from, const Point& to, Vector& v, const Change& change) const {
  return each([&](const Manifold& factor, Buffers& at, const auto& part) {
    at.x = part(from);
    at.y = part(to);
    at.z = part(v);
    const bool found = change(factor, at.x, at.y, at.z);
    part(v) = at.z;
    return found;
  });
}

void ProductManifold::transport(const Point& from, const Point& to, Vector& v) const {
  change_between(from, to, v, [](const Manifold& factor, const Point& x, const Point& y, Vector& part) {
    factor.transport(x, y, part);
    return true;
  });
}

bool ProductManifold::parallel_transport(const Point& from, const Point& to, Vector& v) const {
  return change_between(from, to, v, std::mem_fn(&Manifold::parallel_transport));
}

bool ProductManifold::logarithm_by_end(const Point& x, const Point& y, Vector& v) const {
  return change_between(x, y, v, std::mem_fn(&Manifold::logarithm_by_end));
}

bool ProductManifold::logarithm_by_start(const Point& x, const Point& y, Vector& v) const {
  return change_between(x, y, v, std::mem_fn(&Manifold::logarithm_by_start));
}

bool ProductManifold::offers(ManifoldRetraction retraction) const {
  return std::all_of(factors_.begin(), factors_.end(), [&](const auto& factor) { return factor->offers(retraction); });
}

bool ProductManifold::retract(ManifoldRetraction retraction, const Point& x, const Vector& v, Point& to) const {
  to.resize(size());
  return each([&](const Manifold& factor, Buffers& at, const auto& part) {
    at.x = part(x);
    at.y = part(v);
    const bool found = factor.retract(retraction, at.x, at.y, at.z);
    part(to) = at.z;
    return found;
  });
}

bool ProductManifold::orthographic(const Point& x, const Vector& z, Point& to, Vector& moved) const {
  to.resize(size());
  moved.resize(size());
  return each([&](const Manifold& factor, Buffers& at, const auto& part) {
    at.x = part(x);
    at.y = part(z);
    const bool found = factor.orthographic(at.x, at.y, at.z, at.w);
    part(to) = at.z;
    part(moved) = at.w;
    return found;
  });
}

double ProductManifold::reach(const Vector& v) const {
  double out = 0;
  each([&](const Manifold& factor, Buffers& at, const auto& part) {
    at.x = part(v);
    out = std::max(out, factor.reach(at.x));
    return true;
  });
  return out;
}

bool ProductManifold::logarithm(const Point& x, const Point& y, Vector& v) const {
  v.resize(size());
  return each([&](const Manifold& factor, Buffers& at, const auto& part) {
    at.x = part(x);
    at.y = part(y);
    const bool found = factor.logarithm(at.x, at.y, at.z);
    if (found) part(v) = at.z;
    return found;
  });
}

void ProductManifold::hessian(const Point& x, const Vector& gradient, const Vector& v, Vector& h) const {
  each([&](const Manifold& factor, Buffers& at, const auto& part) {
    at.x = part(x);
    at.y = part(gradient);
    at.z = part(v);
    at.w = part(h);
    factor.hessian(at.x, at.y, at.z, at.w);
    part(h) = at.w;
    return true;
  });
}

double ProductManifold::least_curvature() const {
  double least = factors_.size() > 1 ? 0 : factors_.front()->least_curvature();  // planes across factors are flat
  for (const auto& factor : factors_) least = std::min(least, factor->least_curvature());
  return least;
}

double ProductManifold::diameter() const {
  double square = 0;
  for (const auto& factor : factors_) square += factor->diameter() * factor->diameter();
  return std::sqrt(square);
}

bool ProductManifold::is_hadamard() const {
  return std::all_of(factors_.begin(), factors_.end(), [](const auto& factor) { return factor->is_hadamard(); });
}

}  // namespace lagroid::optimisation
