#include <lagroid/solvers/learning/measures.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lagroid::learning {

double vertical_momentum(const Eigen::Ref<const Eigen::VectorXd>& z) {
  double sum = 0;
  for (Eigen::Index i = 0; i < z.size(); i += 6) sum += z(i) * z(i + 4) - z(i + 1) * z(i + 3);
  return sum;
}

double dissipated_power(const Model& model, const Eigen::VectorXd& theta, const Eigen::VectorXd& z) {
  const Eigen::MatrixXd r = model.dissipation(theta);
  if (r.size() == 0) return 0;
  const Eigen::VectorXd rates = model.rates(theta, z);
  // The velocities, one a row.
  Eigen::MatrixXd v = rates.head(r.rows());
  if (model.bodies() > 0) v = rates.reshaped(6, r.rows()).topRows<3>().transpose();
  return (v.transpose() * r * v).trace();
}

Measures measure(const Model& model, const Eigen::VectorXd& theta, const Trajectories& data, double tolerance,
                 const std::function<bool()>& stop) {
  Measures out;
  const Eigen::Index later = data.points - 1;
  const Eigen::Index width = data.width();
  const bool on_spheres = model.bodies() > 0;
  if (!on_spheres) out.momentum_learned = out.momentum_data = std::numeric_limits<double>::quiet_NaN();
  for (Eigen::Index j = 0; j < later; ++j) out.times.push_back(double(j + 1) * data.interval);
  Eigen::VectorXd squares = Eigen::VectorXd::Zero(later);
  double weighted = 0;
  double total = 0;
  double energies = 0;
  Eigen::MatrixXd z;
  for (Eigen::Index n = 0; n < data.count(); ++n) {
    if (stop && stop()) {
      out.complete = false;
      return out;
    }
    const Eigen::VectorXd start = data.starts.col(n);
    if (!model.follow(theta, start, out.times, tolerance, z)) {
      ++out.lost;
      continue;
    }
    const double energy = model.energy(theta, start);
    const double momentum = on_spheres ? vertical_momentum(start) : 0;
    for (Eigen::Index j = 0; j < later; ++j) {
      const Eigen::VectorXd truth = data.ends.col(n).segment(j * width, width);
      const double square = (z.col(j) - truth).squaredNorm();
      squares(j) += square;
      weighted += data.weights(j, n) * square;
      total += data.weights(j, n);
      const double change = std::abs(model.energy(theta, truth) - energy);
      out.energy_largest = std::max(out.energy_largest, change);
      energies += change * change;
      if (!on_spheres) continue;
      out.momentum_learned = std::max(out.momentum_learned, std::abs(vertical_momentum(z.col(j)) - momentum));
      out.momentum_data = std::max(out.momentum_data, std::abs(vertical_momentum(truth) - momentum));
    }
  }
  const auto followed = double(data.count() - out.lost);
  for (Eigen::Index j = 0; j < later; ++j) out.rms.push_back(std::sqrt(squares(j) / (followed * double(width))));
  out.mse = weighted / (total * double(width));
  out.energy_rms = std::sqrt(energies / (followed * double(later)));
  return out;
}

}  // namespace lagroid::learning
