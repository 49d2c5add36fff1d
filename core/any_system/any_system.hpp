#pragma once
/// A discrete constrained Lagrangian system (G, N, L) behind virtual functions: arrows, objects and derivatives are
/// lists of numbers.
///
/// What is compiled against it is compiled once, and not again for every system.
///
///     const std::unique_ptr<AnySystem> any = std::make_unique<AnySystemOf<Sys>>(system);
///     std::vector<double> g(std::size_t(any->sizes().arrow_coordinates));
///     any->tau(q.data(), v.data(), g.data());
///
/// Requires lists of the lengths that `sizes()` gives. Results are written to the last arguments, to the bit those of
/// the typed system. Errors are those of the system and its groupoid.

#include <lagroid/core/groupoid.hpp>

#include <memory>
#include <vector>

namespace lagroid {

/// The sizes of a system and of its groupoid.
struct SystemSizes {
  int dimension = 0;  ///< of the source fibres: n
  int arrow_constraints = 0;
  int object_constraints = 0;
  int arrow_coordinates = 0;   ///< of an arrow, as `coordinates_of_arrow` orders them
  int object_coordinates = 0;  ///< of an object, as `coordinates_of_object` orders them
  int loops = 0;               ///< in which paths can wind (loops.hpp)

  int constraints() const { return arrow_constraints + object_constraints; }
  bool operator==(const SystemSizes&) const = default;
};

/// Where `Gradients` are to be written: each column by column, without gaps. n = dimension, m = constraints.
struct GradientsTo {
  double* value;            // one
  double* source_gradient;  // n
  double* target_gradient;  // n
  double* constraint;       // m
};
/// Where a `TwoSided` derivative is to be written.
struct TwoSidedTo : GradientsTo {
  double* mixed;              // n x n
  double* constraint_source;  // n x m
  double* constraint_target;  // m x n
};
/// Where `SecondDerivatives` are to be written.
struct SecondDerivativesTo : TwoSidedTo {
  double* source_hessian;  // n x n
  double* target_hessian;  // n x n
};

/// The interface. Any system becomes one by `AnySystemOf` (any_system_of.hpp).
///
/// Arrows are lists of `sizes().arrow_coordinates` numbers, objects of `object_coordinates`, vectors of AG and momenta
/// of `dimension`, multipliers of `constraints()`; each function does what that of the same name does for the typed
/// system, to the bit. A result may be written over an argument. Nothing here allocates but `clone` and `path`, and
/// what is const may be called from several threads at once.
///
/// Derivatives are those with respect to the arrow alone.
class AnySystem {
 public:
  explicit AnySystem(const SystemSizes& sizes) : sizes_(sizes) {}
  virtual ~AnySystem() = default;
  const SystemSizes& sizes() const { return sizes_; }

  /// The same system, with a time step of its own.
  virtual std::unique_ptr<AnySystem> clone() const = 0;

  // ---- the groupoid, as in core/groupoid.hpp

  virtual std::string groupoid_name() const = 0;
  virtual void source(const double* g, double* q) const = 0;
  virtual void target(const double* g, double* q) const = 0;
  virtual void unit(const double* q, double* g) const = 0;
  virtual void inverse(const double* g, double* out) const = 0;
  virtual void multiply(const double* g, const double* h, double* out) const = 0;
  /// The product; in checked builds NotComposable is thrown where there is none.
  virtual void compose(const double* g, const double* h, double* out) const = 0;
  virtual void tau(const double* q, const double* v, double* g) const = 0;
  virtual void tau_inverse(const double* g, double* v) const = 0;
  virtual void project(const double* g, double* out) const = 0;
  virtual void extend(const double* g, const double* w, double* out) const = 0;
  /// g is moved by w; `left` is what of w could not be stored.
  virtual void correct(double* g, const double* w, double* left) const = 0;
  virtual void momentum_change(const double* g, const double* source_gradient, const double* target_gradient,
                               double* change) const = 0;
  virtual void chart(const double* g, double* v) const = 0;
  virtual void arrow_in_chart(const double* q, const double* v, double* g) const = 0;
  virtual void coordinate_scale(const double* g, double* scale) const = 0;
  /// The left-invariant field of x at g, in arrow coordinates.
  virtual void left_invariant(const double* g, const double* x, double* tangent) const = 0;
  /// The anchor of x at q, in object coordinates.
  virtual void anchor(const double* q, const double* x, double* tangent) const = 0;

  /// The next arrow of a path whose nodes are displaced (displaced_arrow.hpp).
  virtual void displace_next(const double* g, const double* v, double* back, double* moved, double* product) const = 0;

  // ---- the system

  virtual double lagrangian(const double* g) const = 0;
  virtual void arrow_constraint(const double* g, double* phi) const = 0;
  virtual void object_constraint(const double* q, double* c) const = 0;
  virtual void gradients(const double* g, const double* multipliers, const GradientsTo& out) const = 0;
  virtual void two_sided(const double* g, const double* multipliers, const TwoSidedTo& out) const = 0;
  /// Of a system that is not variational, those of L and of what its multipliers add to it.
  virtual void second_derivatives(const double* g, const double* multipliers, const SecondDerivativesTo& out) const = 0;
  /// The derivative of the gradient at one end along displacements of that end (gradient_derivative.hpp): n x n.
  virtual void gradient_derivative(const double* g, const double* multipliers, End end, double* out) const = 0;
  /// Whether g is on the discretisation's own branch; always, where the system names none.
  virtual bool admissible(const double* g) const = 0;

  /// Whether there is a time step h, its value (one where there is none), and another.
  virtual bool has_time_step() const = 0;
  virtual double time_step() const = 0;
  virtual void set_time_step(double h) = 0;

  // ---- where solves and searches start

  /// The system's own guess of a step, or the unit arrow without multipliers.
  virtual void first_guess(const double* q, const double* momentum, double* g, double* multipliers) const = 0;
  /// The arrows of the system's own path, one after another; none where it writes none.
  virtual std::vector<double> path(const double* boundary, long steps) const = 0;
  /// The loop over q about `axis` with so many `turns`, `sizes().loops` of them.
  virtual void loop(const double* q, const double* axis, const double* turns, double* g) const = 0;

 private:
  SystemSizes sizes_;
};

}  // namespace lagroid
