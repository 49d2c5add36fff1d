#include <lagroid/systems/spheres/sphere_integrator.hpp>

#include <cmath>
#include <stdexcept>

namespace lagroid {

double off_spheres(const SphereIntegrator::Points& z) {
  double sphere = 0;
  double along = 0;
  double largest = 0;
  const auto raise = [](double& most, double x) {
    if (!(x <= most)) most = x;
  };
  for (Eigen::Index i = 0; i < z.cols(); ++i) {
    const Vector<double, 3> q = z.col(i).head<3>();
    const Vector<double, 3> w = z.col(i).tail<3>();
    raise(sphere, 0.5 * std::abs(q.squaredNorm() - 1));
    raise(along, std::abs(q.dot(w)));
    raise(largest, w.norm());
  }
  if (largest > 0) raise(sphere, along / largest);
  return sphere;
}

void detail::require_extrapolation(const SphereIntegratorOptions& options) {
  if (!(options.tolerance > 0)) throw std::invalid_argument("extrapolation takes its order and steps from a tolerance");
  if (!std::isfinite(options.step) || !(options.step > 0))
    throw std::invalid_argument("extrapolation goes on, from node to node, by a finite step");
  if (options.composition.stages() > 1) throw std::invalid_argument("steps of extrapolation are not composed");
}

}  // namespace lagroid
