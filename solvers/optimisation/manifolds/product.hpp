#pragma once
/// Products of manifolds, Q_1 x ... x Q_k, with the sum of their metrics.
///
///     std::vector<std::unique_ptr<optimisation::Manifold>> spheres;
///     for (int i = 0; i < 12; ++i) spheres.push_back(std::make_unique<optimisation::Sphere>(3));
///     const optimisation::ProductManifold points(std::move(spheres));
///
/// No factors throw std::invalid_argument.

#include <lagroid/solvers/optimisation/manifolds/manifold.hpp>

#include <memory>
#include <vector>

namespace lagroid::optimisation {

/// Q_1 x ... x Q_k: points one after another; the metric is the sum.
class ProductManifold final : public Manifold {
 public:
  /// Throws std::invalid_argument for no factors.
  explicit ProductManifold(std::vector<std::unique_ptr<Manifold>> factors);

  std::size_t factors() const { return factors_.size(); }
  const Manifold& factor(std::size_t i) const { return *factors_[i]; }
  /// The numbers of the i-th factor within a point.
  Eigen::Index first(std::size_t i) const { return first_[i]; }

  std::string name() const override;
  Eigen::Index size() const override { return first_.back(); }
  Eigen::Index dimension() const override;
  double residual(const Point& x) const override;
  double penalty(const Point& x, double weight, Vector& gradient) const override;
  bool nearest(Point& x) const override;
  void project(const Point& x, Vector& v) const override;
  /// Where a factor has one.
  bool has_own_metric() const override { return has_own_metric_; }
  double inner(const Point& x, const Vector& u, const Vector& v) const override;
  void gradient(const Point& x, Vector& differential) const override;
  void differential(const Point& x, Vector& gradient) const override;
  void transport(const Point& from, const Point& to, Vector& v) const override;
  /// Those that all factors offer.
  bool offers(ManifoldRetraction retraction) const override;
  bool retract(ManifoldRetraction retraction, const Point& x, const Vector& v, Point& to) const override;
  bool orthographic(const Point& x, const Vector& z, Point& to, Vector& moved) const override;
  double reach(const Vector& v) const override;
  bool logarithm(const Point& x, const Point& y, Vector& v) const override;
  bool parallel_transport(const Point& from, const Point& to, Vector& v) const override;
  bool logarithm_by_end(const Point& x, const Point& y, Vector& v) const override;
  bool logarithm_by_start(const Point& x, const Point& y, Vector& v) const override;
  void hessian(const Point& x, const Vector& gradient, const Vector& v, Vector& h) const override;
  double least_curvature() const override;
  double diameter() const override;
  /// Where all factors are.
  bool is_hadamard() const override;

 private:
  template <class F> bool each(const F& f) const;
  /// v between two points, factor by factor, as change(factor, from, to, v) makes it of the parts.
  template <class Change>
  bool change_between(const Point& from, const Point& to, Vector& v, const Change& change) const;

  std::vector<std::unique_ptr<Manifold>> factors_;
  std::vector<Eigen::Index> first_;
  bool has_own_metric_ = false;
  struct Buffers {
    Vector x, y, z, w;
  };
  mutable std::vector<Buffers> buffers_;
};

}  // namespace lagroid::optimisation
