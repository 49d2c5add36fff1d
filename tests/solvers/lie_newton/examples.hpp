#pragma once
/// Equations of the examples, and how they are solved.

#include <lagroid/groupoids/groups/rotation_fibre.hpp>
#include <lagroid/groupoids/groups/vector_group.hpp>
#include <lagroid/solvers/newton/lie_newton.hpp>
#include <lagroid/systems/newton_examples.hpp>

#include <cmath>
#include <cstdint>
#include <utility>
#include <vector>

namespace lagroid::lie_newton_tests {

using Step = ImplicitStep<RotationFibre<>, ExampleField<>>;

inline Step example(NewtonExample which, Eigen::Index n, std::uint64_t seed, double h) {
  return {RotationFibre(random_orthogonal(n, seed)), ExampleField(which), h};
}

inline Eigen::VectorXd zero(const Step& step) { return Eigen::VectorXd::Zero(step.fibre().dimension()); }

/// An iteration and the norms of f along it.
template <class E> struct Recorded : LieNewtonResult<typename E::Fibre> { std::vector<double> residuals; };

template <class E>
Recorded<E> record(const E& equation, const typename E::Fibre::Vector& start, const LieNewtonOptions& options = {}) {
  std::vector<double> residuals;
  auto result = lie_newton(equation, start, options, [&](double r) { residuals.push_back(r); });
  return {std::move(result), std::move(residuals)};
}

/// A curve and a line in the plane.
struct OnThePlane {
  using Fibre = GroupoidFibre<VectorGroup<2>>;
  Fibre fibre_{Vector<double, 2>(0.3, -0.2)};
  const Fibre& fibre() const { return fibre_; }
  Vector<double, 2> residual(const Vector<double, 2>& y, const Vector<double, 2>&) const {
    return {std::sin(y(0)) + y(1), y(1) - 0.5 * std::exp(y(0))};
  }
  Matrix<double, 2, 2> differential(const Vector<double, 2>& y, const Vector<double, 2>&) const {
    Matrix<double, 2, 2> m;
    m << std::cos(y(0)), 1, -0.5 * std::exp(y(0)), 1;
    return m;
  }
  Matrix<double, 2, 2> chart_differential(const Vector<double, 2>& y, const Vector<double, 2>& v) const {
    return differential(y, v) * fibre_.dtau(v);
  }
  double norm(const Vector<double, 2>& f) const { return f.norm(); }
};

}  // namespace lagroid::lie_newton_tests
