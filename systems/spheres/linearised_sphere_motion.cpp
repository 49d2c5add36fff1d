#include <lagroid/core/derivatives/varied_directions.hpp>
#include <lagroid/systems/spheres/linearised_sphere_motion.hpp>

#include <cmath>
#include <utility>

namespace lagroid {

LinearisedSphereMotion::LinearisedSphereMotion(const Begin& begin, SphereIntegratorOptions options,
                                               std::unique_ptr<SphereDerivatives> derivatives)
    : derivatives_(std::move(derivatives)), step_(options.step) {
  // Extrapolation by k rows evaluates the field k (k + 1) times.
  options.accepted = [this](double h, int evaluations) { made_.push_back({h, int(std::sqrt(evaluations))}); };
  integrator_ = begin(options);
  before_ = integrator_->point();
}

StepReport LinearisedSphereMotion::advance() {
  before_ = integrator_->point();
  made_.clear();
  const StepReport report = integrator_->advance();
  if (made_.empty()) made_.push_back({step_});
  return report;
}

bool LinearisedSphereMotion::linearise() {
  Points from = before_, to = before_;
  for (std::size_t k = 0; k < made_.size(); ++k) {
    if (k == stages_.size()) stages_.emplace_back(0, states(), parameters());
    if (!derivatives_->step(from, made_[k], to, stages_[k].end_by_start) || !stages_[k].factor()) return false;
    from.swap(to);
  }
  return true;
}

Eigen::Matrix<double, 3, 2> tangent_frame(const Vector<double, 3>& q) {
  const double across = std::hypot(q(0), q(1));
  Vector<double, 3> east(0, 1, 0);
  if (across > 0) east << -q(1) / across, q(0) / across, 0;
  Eigen::Matrix<double, 3, 2> frame;
  frame << cross(east, q), east;
  return frame;
}

Eigen::MatrixXd tangent_directions(const SphereIntegrator::Points& z, const Eigen::VectorXd& coordinates,
                                   SphereIntegrator::Points& moved) {
  using V = VariedNumber;
  using VariedSpheres = CotangentSpheres<Eigen::Dynamic, V>;
  const int k = int(z.cols());
  const VariedSpheres space{{k}};
  Eigen::MatrixXd by(6 * k, 4 * k);
  moved = z;
  detail::for_directions(4 * k, [&](int first) {
    const auto coordinate = [&](int i) {
      const int direction = i - first;
      return 0 <= direction && direction < varied_at_once ? V::variable(coordinates(i), direction) : V(coordinates(i));
    };
    auto turn = space.zero_algebra();
    auto point = space.zero_point();
    for (int i = 0; i < k; ++i) {
      const Vector<double, 3> q = z.col(i).head<3>();
      const Eigen::Matrix<double, 3, 2> frame = tangent_frame(q);
      const auto along = [&](int at) -> Vector<V, 3> {
        return frame.col(0) * coordinate(at) + frame.col(1) * coordinate(at + 1);
      };
      const Vector<V, 3> from = q.cast<V>();
      VariedSpheres::set(turn, i, cross(from, along(2 * i)), Vector<V, 3>::Zero());
      VariedSpheres::set(point, i, from, z.col(i).tail<3>().cast<V>() + along(2 * (k + i)));
    }
    space.act(turn, point);
    const auto at = point.reshaped();
    detail::put_tangents(at, first, by);
    for (int i = 0; i < 6 * k; ++i) moved.data()[i] = at(i).value;
  });
  return by;
}

}  // namespace lagroid
