#include <lagroid/systems/spheres/sphere_integrator.hpp>

#include <cmath>

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

}  // namespace lagroid
