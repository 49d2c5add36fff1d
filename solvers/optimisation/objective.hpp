#pragma once
/// Functions f on the space around a manifold, of which the restriction is minimised.
///
///     struct Height final : optimisation::Objective {
///       double evaluate(const optimisation::Point& x, optimisation::Vector& gradient) const override {
///         gradient << 0, 0, 1;
///         return x(2);
///       }
///     };
///
/// Requires the value and the gradient in the space around, which comes with its size; the tangent part, and a Hessian
/// where none is written, are deduced.

#include <lagroid/solvers/optimisation/manifolds/manifold.hpp>

#include <optional>
#include <string>

namespace lagroid::optimisation {

/// f on E, of which the restriction to the manifold is minimised. A user writes `evaluate`; the rest is deduced from it
/// or worth writing where it is cheaper so. Whatever n, no operation needs an n x n matrix but those that f itself has.
class Objective {
 public:
  virtual ~Objective() = default;

  virtual std::string name() const { return "objective"; }
  /// f(x), and the gradient D f(x) in E.
  virtual double evaluate(const Point& x, Vector& gradient) const = 0;
  /// f(x) alone, for line searches.
  virtual double value(const Point& x) const;
  /// D^2 f(x) v. By default the central difference of gradients, whose error is about 1e-10 of its size.
  virtual void hessian(const Point& x, const Vector& v, Vector& h) const;
  /// A Lipschitz constant of the Riemannian gradient of the restriction, where one is known.
  virtual std::optional<double> lipschitz() const { return std::nullopt; }
  /// Whether the restriction is geodesically convex on all of the manifold: a point without slope is then a minimum.
  virtual bool convex() const { return false; }

 private:
  mutable Point moved_;
  mutable Vector before_;
};

}  // namespace lagroid::optimisation
