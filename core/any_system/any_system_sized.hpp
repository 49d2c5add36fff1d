#pragma once
/// An AnySystem whose sizes are template arguments: its derivatives are returned as `Gradients`, `TwoSided` and
/// `SecondDerivatives`, without copies of numbers.
///
/// Solvers that are compiled for each size of system, and not for each system, use it.
///
///     const std::unique_ptr<AnySystemSized<2, 0, 0>> any = std::make_unique<AnySystemOf<Sys>>(system);
///     const TwoSided<2, 0> d = any->two_sided_at(g.data(), Vector<double, 0>());

#include <lagroid/core/any_system/any_system.hpp>
#include <lagroid/core/derivatives/second_derivatives.hpp>

namespace lagroid {

/// An AnySystem with n = `N` and so many constraints: its derivatives are returned without copying numbers
/// (which cost a boundary iteration of the plate-ball 4 %).
template <int N, int ArrowConstraints, int ObjectConstraints> class AnySystemSized : public AnySystem {
 public:
  static constexpr int n = N;
  static constexpr int m = ArrowConstraints + ObjectConstraints;
  using Multipliers = Vector<double, m>;

  AnySystemSized(int arrow_coordinates, int object_coordinates, int loops)
      : AnySystem({N, ArrowConstraints, ObjectConstraints, arrow_coordinates, object_coordinates, loops}) {}

  virtual std::unique_ptr<AnySystemSized> clone_sized() const = 0;
  virtual Gradients<N, m> gradients_at(const double* g, const Multipliers& lambda) const = 0;
  virtual TwoSided<N, m> two_sided_at(const double* g, const Multipliers& lambda) const = 0;
  virtual SecondDerivatives<N, m> second_derivatives_at(const double* g, const Multipliers& lambda) const = 0;

  std::unique_ptr<AnySystem> clone() const final { return clone_sized(); }
  void gradients(const double* g, const double* multipliers, const GradientsTo& out) const final {
    put(gradients_at(g, at(multipliers)), out);
  }
  void two_sided(const double* g, const double* multipliers, const TwoSidedTo& out) const final {
    put(two_sided_at(g, at(multipliers)), out);
  }
  void second_derivatives(const double* g, const double* multipliers, const SecondDerivativesTo& out) const final {
    const SecondDerivatives<N, m> d = second_derivatives_at(g, at(multipliers));
    put(static_cast<const TwoSided<N, m>&>(d), out);
    put(d.source_hessian, out.source_hessian);
    put(d.target_hessian, out.target_hessian);
  }

 private:
  static Multipliers at(const double* multipliers) { return Eigen::Map<const Multipliers>(multipliers); }
  template <int Rows, int Columns> static void put(const Matrix<double, Rows, Columns>& from, double* to) {
    Eigen::Map<Matrix<double, Rows, Columns>> map(to);
    map = from;
  }
  static void put(const Gradients<N, m>& d, const GradientsTo& out) {
    *out.value = d.value;
    put(d.source_gradient, out.source_gradient);
    put(d.target_gradient, out.target_gradient);
    put(d.constraint, out.constraint);
  }
  static void put(const TwoSided<N, m>& d, const TwoSidedTo& out) {
    put(static_cast<const Gradients<N, m>&>(d), static_cast<const GradientsTo&>(out));
    put(d.mixed, out.mixed);
    put(d.constraint_source, out.constraint_source);
    put(d.constraint_target, out.constraint_target);
  }
};

}  // namespace lagroid
