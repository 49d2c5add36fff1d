#pragma once
/// The weighted squared error of a model's trajectories, as training sums it: a detail of train.hpp.

#include <lagroid/solvers/learning/train.hpp>

#include <functional>

namespace lagroid::learning {

/// How many trajectories are predicted at a time: some hundred numbers.
Eigen::Index block_of(const Trajectories& data);

/// r <- z - z_data times the square root of the weights, for the columns from `first` on.
void weigh(const Trajectories& data, Eigen::Index first, Eigen::Ref<Eigen::MatrixXd> z);

/// The squared errors times their weights, summed; infinite where one is not finite, and where `halted` ends it.
double squared_error(const Model& model, const Eigen::VectorXd& theta, const Schedule& schedule,
                     const Trajectories& data, const std::function<bool()>& halted);

}  // namespace lagroid::learning
