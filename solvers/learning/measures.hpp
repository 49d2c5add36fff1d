#pragma once
/// How good a learned Hamiltonian is, on trajectories that it was not trained on: mean squared error, the error as time
/// goes on, and how far energy and vertical momentum drift.
///
///     const auto model = learning::polynomial_model(1, 3);
///     const learning::Measures found = learning::measure(*model, model->start(1), learning::Trajectories{});
///
/// Requires theta of model.size() numbers. Trajectories that cannot be followed are counted (`lost`) and left out.

#include <lagroid/solvers/learning/model.hpp>
#include <lagroid/solvers/learning/trajectories.hpp>

#include <functional>
#include <vector>

namespace lagroid::learning {

/// The learned motion, followed to `tolerance` (Model::follow) from the starts of data that were not trained on.
struct Measures {
  double mse = 0;  ///< weighted mean of (z - z_data)^2 over all numbers of all points but the first
  std::vector<double> times;
  std::vector<double> rms;  ///< at each of these: the root of the mean squared error, over all trajectories
  /// What the learned H varies by along a trajectory of the data, of the true motion therefore: the largest of
  /// |H(z_j) - H(z_0)|, and the root of the mean square. Noise is in it, from the first point on, and what dissipation
  /// takes.
  double energy_largest = 0;
  double energy_rms = 0;
  /// The largest change of e_3 . sum_i q_i x p_i, the momentum about the vertical, along a learned motion: zero where
  /// the learned V has the symmetry; and along the data. Not a number where they are not on spheres.
  double momentum_learned = 0;
  double momentum_data = 0;
  long lost = 0;         ///< trajectories that could not be followed, left out of all
  bool complete = true;  ///< false where it was stopped: then the numbers above mean nothing
};

/// `stop` is called before each trajectory; true ends the measurement.
Measures measure(const Model& model, const Eigen::VectorXd& theta, const Trajectories& data, double tolerance = 1e-12,
                 const std::function<bool()>& stop = nullptr);

/// q'^T R q', of (T*S^2)^k sum_ij R_ij q_i'.q_j': what dissipation takes in a unit of time, dH/dt = -q'^T R q'. Zero
/// where the model declares none.
double dissipated_power(const Model& model, const Eigen::VectorXd& theta, const Eigen::VectorXd& z);

/// e_3 . sum_i q_i x p_i, of a state on (T*S^2)^k.
double vertical_momentum(const Eigen::Ref<const Eigen::VectorXd>& z);

}  // namespace lagroid::learning
