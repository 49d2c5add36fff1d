#pragma once
/// Fits a Hamiltonian to trajectories: minimises over theta the mean squared error of what an integrator predicts,
///
///     sum_{n, j} w_nj |z_j(theta; z_n0) - z_nj|^2,    z_j after j intervals from the start of trajectory n.
///
/// The integrator is part of the fit, so that data may be as coarse as its steps allow, and no derivative of the data
/// is needed.
///
///     using namespace learning;
///     const Trajectories data = assemble(std::vector<Observation>{});  // of rows that were observed
///     const Trained trained = train(*polynomial_model(data.bodies, 3), data, {.starts = 4});
///     if (trained.usable()) std::cout << to_string(trained.outcome) << ' ' << trained.mse << '\n';
///
/// Requires data from `assemble`, of the model's space, and options in range (std::invalid_argument).
/// Whatever numbers do is a TrainingStatus with a message that names the remedy. Throws MissingLibrary in a build
/// without Ceres. [H]

#include <lagroid/solvers/learning/model.hpp>
#include <lagroid/solvers/learning/trajectories.hpp>

#include <functional>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

namespace lagroid::learning {

enum class TrainingStatus {
  converged,        ///< the error falls no more
  reached,          ///< the training error is as small as `enough`
  early_stopped,    ///< the error on held-out trajectories rose while the training error fell
  iteration_limit,  ///< as many iterations as were allowed
  time_limit,       ///< as long as was allowed
  interrupted,      ///< by the callback
  too_little_data,  ///< fewer numbers than parameters, or a part without weight
  not_finite,       ///< no start has a finite error and derivative, or further on one has none
};

constexpr std::string_view to_string(TrainingStatus outcome) {
  switch (outcome) {
    case TrainingStatus::converged:
      return "converged";
    case TrainingStatus::reached:
      return "reached";
    case TrainingStatus::early_stopped:
      return "early_stopped";
    case TrainingStatus::iteration_limit:
      return "iteration_limit";
    case TrainingStatus::time_limit:
      return "time_limit";
    case TrainingStatus::interrupted:
      return "interrupted";
    case TrainingStatus::too_little_data:
      return "too_little_data";
    case TrainingStatus::not_finite:
      return "not_finite";
  }
  return "unknown";
}

/// Where a training is, after an iteration.
struct Stage {
  int start = 0;  ///< of `starts`; the last stage, with all data, counts as one more
  int iteration = 0;
  double mse = 0;         ///< on the trajectories it trains on
  double validation = 0;  ///< on those held out; not a number where there are none
  double damping = 0;     ///< one over the radius of the trust region
  double seconds = 0;     ///< of processors, since the beginning
};

/// How to train.
struct Training {
  LieGroupMethod method = lie_group_methods::commutator_free_4;
  int substeps = 2;   ///< in each interval of the data
  unsigned seed = 1;  ///< of the first start; the others are the following ones
  int starts = 4;     ///< how many are tried
  int threads = 0;    ///< starts tried at a time; 0: as many as there are processors
  int trial = 30;     ///< iterations of each, on `share` of the trajectories; the best goes on with all of them
  double share = 0.2;
  int iterations = 100;        ///< with all trajectories; zero where the parameters are to be measured only
  Eigen::VectorXd begin = {};  ///< parameters to go on from, in place of starts; empty: Model::start
  /// Of the trajectories, those that are held out to stop early by; 0: none. Which ones, and which ones starts are
  /// tried on, depends on the seed, so that it does not matter in what order they come.
  double validation = 0;
  int patience = 10;             ///< iterations without a lower error on those
  double enough = 0;             ///< mean squared error at which it stops; 0: none
  double least_progress = 1e-3;  ///< and the relative fall of it over ten iterations below which it does
  /// The floor under the damping of a step, relative to the squared norms of the columns of J: J has no full rank,
  /// because neither the part of V away from the spheres nor symmetries of a network move anything.
  double damping_floor = 1e-14;
  double seconds = std::numeric_limits<double>::infinity();  ///< of processors, at most
  /// Sees every iteration, of starts that are tried at the same time in any order, but never two at once; false
  /// interrupts.
  std::function<bool(const Stage&)> callback = nullptr;
  /// Called after every few trajectories, never twice at once; true interrupts.
  std::function<bool()> stop = nullptr;
};

struct Trained {
  TrainingStatus outcome = TrainingStatus::not_finite;
  std::string message;         ///< one line where it did not converge, with the remedy
  Eigen::VectorXd parameters;  ///< the best met; empty where nothing could be evaluated
  /// Over all trajectories that were not held out; where an interrupt or the time limit ended the trials, over those of
  /// the trials.
  double mse = std::numeric_limits<double>::quiet_NaN();
  double validation = std::numeric_limits<double>::quiet_NaN();
  /// Whether, at the end, a change of the mass matrix's parameters of size one moves the predictions by more than 1e-8,
  /// whatever the potential does to make up for it; true where the model has none.
  bool mass_determined = true;
  /// The same of the entries of R, whatever the rest of the model does to make up for it; and whether two standard
  /// deviations of each combination of them, as the error that is left gives them, are less than a hundredth.
  bool dissipation_determined = true;
  unsigned start = 0;          ///< the seed of the start that was best
  int iterations = 0;          ///< of all stages
  double seconds = 0;          ///< of processors
  std::vector<Stage> history;  ///< start after start

  bool usable() const { return parameters.size() > 0; }
};

/// The weighted mean of (z - z_data)^2 over all numbers of all points but the first: the sum over that of the weights.
/// Infinite where the motion is not finite.
double mean_squared_error(const Model& model, const Eigen::VectorXd& theta, const Schedule& schedule,
                          const Trajectories& data);

/// Minimises the mean squared error of the integrator's trajectories by Ceres' Levenberg-Marquardt method with exact
/// derivatives (ParametricModel), from several starts. Numbers never throw: how it ended is a TrainingStatus. Equal
/// data and options give equal bits, whatever the threads, unless the time limit or the callback ends it.
Trained train(const Model& model, const Trajectories& data, const Training& options);

}  // namespace lagroid::learning
