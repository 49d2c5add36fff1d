#include <lagroid/solvers/learning/squared_error.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lagroid::learning {

Eigen::Index block_of(const Trajectories& data) { return std::max<Eigen::Index>(1, 512 / data.ends.rows()); }

void weigh(const Trajectories& data, Eigen::Index first, Eigen::Ref<Eigen::MatrixXd> z) {
  z -= data.ends.middleCols(first, z.cols());
  for (Eigen::Index n = 0; n < z.cols(); ++n)
    for (Eigen::Index j = 0; j < data.weights.rows(); ++j)
      z.col(n).segment(j * data.width(), data.width()) *= std::sqrt(data.weights(j, first + n));
}

double squared_error(const Model& model, const Eigen::VectorXd& theta, const Schedule& schedule,
                     const Trajectories& data, const std::function<bool()>& halted) {
  constexpr double none = std::numeric_limits<double>::infinity();
  const Eigen::Index block = block_of(data);
  Eigen::MatrixXd z;
  double sum = 0;
  for (Eigen::Index first = 0; first < data.count(); first += block) {
    if (halted && halted()) return none;
    z.resize(data.ends.rows(), std::min(block, data.count() - first));
    model.predict(theta, schedule, data.starts.middleCols(first, z.cols()), z);
    weigh(data, first, z);
    sum += z.squaredNorm();
  }
  return std::isfinite(sum) ? sum : none;
}

double mean_squared_error(const Model& model, const Eigen::VectorXd& theta, const Schedule& schedule,
                          const Trajectories& data) {
  return squared_error(model, theta, schedule, data, nullptr) / data.total_weight();
}

}  // namespace lagroid::learning
