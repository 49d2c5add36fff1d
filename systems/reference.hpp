#pragma once
/// Solutions of the continuous equations, to compare discretisations with.

#include <Eigen/Core>

#include <functional>

namespace lagroid {

/// y' = f(y), written as f(y, dy).
using VectorField = std::function<void(const Eigen::VectorXd&, Eigen::VectorXd&)>;

/// y(t) by an adaptive Runge-Kutta-Fehlberg 7(8) method (Boost.odeint) with relative and absolute tolerance 1e-14 a
/// step.
Eigen::VectorXd integrate_reference(const VectorField& field, const Eigen::VectorXd& start, double t);

}  // namespace lagroid
