#pragma once
/// The vector space R^n, a manifold without constraint: R_x(v) = x + v.

#include <lagroid/solvers/optimisation/manifolds/manifold.hpp>

#include <limits>
#include <string>

namespace lagroid::optimisation {

/// R^n, on which methods are those of a vector space ([V] Remark 5.1).
class FlatSpace final : public Manifold {
 public:
  explicit FlatSpace(Eigen::Index n) : n_(n) {}

  std::string name() const override { return "R^" + std::to_string(n_); }
  Eigen::Index size() const override { return n_; }
  Eigen::Index dimension() const override { return n_; }
  double residual(const Point&) const override { return 0; }
  double penalty(const Point&, double, Vector&) const override { return 0; }
  bool nearest(Point& x) const override { return x.allFinite(); }
  void project(const Point&, Vector&) const override {}
  bool offers(ManifoldRetraction) const override { return true; }
  bool retract(ManifoldRetraction, const Point& x, const Vector& v, Point& to) const override {
    to = x + v;
    return true;
  }
  bool orthographic(const Point& x, const Vector& z, Point& to, Vector& moved) const override {
    moved = z;
    to = x + z;
    return true;
  }
  double reach(const Vector&) const override { return 0; }
  bool logarithm(const Point& x, const Point& y, Vector& v) const override {
    v = y - x;
    return true;
  }
  bool parallel_transport(const Point&, const Point&, Vector&) const override { return true; }
  bool logarithm_by_end(const Point&, const Point&, Vector&) const override { return true; }
  bool logarithm_by_start(const Point&, const Point&, Vector& v) const override {
    v = -v;
    return true;
  }
  void hessian(const Point&, const Vector&, const Vector&, Vector&) const override {}
  double least_curvature() const override { return 0; }
  double diameter() const override { return std::numeric_limits<double>::infinity(); }
  bool is_hadamard() const override { return true; }

 private:
  Eigen::Index n_;
};

}  // namespace lagroid::optimisation
