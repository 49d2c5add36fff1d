#pragma once
/// Laws of models to learn, for your own: energy falls by what the declared dissipation takes and by nothing else,
/// motions stay where states are, and the derivatives that training uses are those of what is predicted.
///
///     const auto model = learning::polynomial_hamiltonian(2, 3);
///     const laws::LawReport report = laws::model_laws(*model, [&] { return model->start(1); },
///                                                     [] { return Eigen::VectorXd(laws::draw_vector<4>(1)); });
///     std::cout << report;  // report.holds(): all of them
///
/// Requires RapidCheck, parameters whose motions are smooth for a time of 0.2, and states of the model's size; they are
/// brought onto its space.

#include <lagroid/core/testing/property.hpp>
#include <lagroid/solvers/learning/measures.hpp>

#include <Eigen/Eigenvalues>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lagroid::laws {

/// `draw_parameters()` and `draw_state()` return random ones.
template <class DrawParameters, class DrawState>
LawReport model_laws(const learning::Model& model, const DrawParameters& draw_parameters, const DrawState& draw_state) {
  using Eigen::MatrixXd, Eigen::VectorXd;
  const learning::StateSpace space = model.space();
  const learning::Schedule schedule{lie_group_methods::commutator_free_4, 0.1, 2, 4};
  const auto on_space = [&](VectorXd z) {
    if (space.project) space.project(z);
    return z;
  };
  const auto defect = [](const MatrixXd& x, const MatrixXd& y) {
    if (!x.allFinite() || !y.allFinite()) return std::numeric_limits<double>::infinity();
    return (x - y).cwiseAbs().maxCoeff() / (1 + y.cwiseAbs().maxCoeff());
  };
  const auto predicted = [&](const VectorXd& theta, const VectorXd& start) {
    MatrixXd z(space.size * schedule.intervals, 1);
    model.predict(theta, schedule, start, z);
    return z;
  };
  // d/dt f(t) at 0, to the fourth order.
  const auto slope = [](const auto& f) {
    constexpr double t = 1e-3;
    using Value = decltype(f(t));
    return Value((8 * (f(t) - f(-t)) - (f(2 * t) - f(-2 * t))) / (12 * t));
  };

  LawReport report{model.name(), {}};
  const auto law = [&](const char* name, double tolerance, const auto& of_sample) {
    report.laws.push_back(check_law(name, tolerance, of_sample));
  };
  law("dH/dt = -q'^T R q'", 1e-10, [&] {
    const VectorXd theta = draw_parameters();
    const VectorXd z = on_space(draw_state());
    const VectorXd rates = model.rates(theta, z);
    const double fast = 1 + rates.norm();
    const double change = fast * slope([&](double t) { return model.energy(theta, z + t / fast * rates); });
    return std::abs(change + dissipated_power(model, theta, z)) / (fast * fast);
  });
  law("R is symmetric and positive semidefinite", 1e-14, [&] {
    const MatrixXd r = model.dissipation(draw_parameters());
    if (r.size() == 0) return 0.0;
    const double least = Eigen::SelfAdjointEigenSolver<MatrixXd>(r).eigenvalues().minCoeff();
    return worst({defect(r, r.transpose()), std::max(0.0, -least) / (1 + r.norm())});
  });
  law("motions stay where states are", 1e-12, [&] {
    const MatrixXd z = predicted(draw_parameters(), on_space(draw_state()));
    const VectorXd last = z.bottomRows(space.size);
    return defect(last, on_space(last));
  });
  law("derivatives are those of the predictions", 1e-8, [&] {
    const VectorXd theta = draw_parameters();
    const VectorXd start = on_space(draw_state());
    MatrixXd z(space.size * schedule.intervals, 1);
    MatrixXd derivative(z.size(), theta.size());
    model.differentiate(theta, schedule, start, z, derivative);
    double off = defect(z, predicted(theta, start));
    for (Eigen::Index i = 0; i < theta.size(); ++i) {
      const VectorXd axis = VectorXd::Unit(theta.size(), i);
      const MatrixXd difference = slope([&](double t) { return predicted(theta + t * axis, start); });
      off = worst({off, defect(derivative.col(i), difference)});
    }
    return off;
  });
  return report;
}

}  // namespace lagroid::laws
