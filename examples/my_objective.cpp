// A function of one's own, minimised on a manifold: the unit vectors that lie farthest from each other on a sphere
// (Thomson's problem), k of them as one point of a product of spheres. See docs/optimisation.md.

#include <lagroid/solvers/optimisation/manifolds/product.hpp>
#include <lagroid/solvers/optimisation/manifolds/sphere.hpp>
#include <lagroid/solvers/optimisation/methods/conjugate_gradient.hpp>
#include <lagroid/solvers/optimisation/testing/manifold_laws.hpp>
#include <lagroid/systems/optimisation/instances.hpp>

#include <cmath>
#include <iostream>
#include <memory>
#include <vector>

namespace {

using namespace lagroid::optimisation;

// f = sum 1 / |x_i - x_j|: a value, and its gradient in the space around.
class Thomson final : public Objective {
 public:
  std::string name() const override { return "Thomson's problem"; }
  double evaluate(const Point& x, Vector& gradient) const override {
    double energy = 0;
    gradient.setZero();
    for (Eigen::Index i = 0; i < x.size(); i += 3)
      for (Eigen::Index j = 0; j < i; j += 3) {
        const Eigen::Vector3d apart = x.segment<3>(i) - x.segment<3>(j);
        const double distance = apart.norm();
        energy += 1 / distance;
        gradient.segment<3>(i) -= apart / std::pow(distance, 3);
        gradient.segment<3>(j) += apart / std::pow(distance, 3);
      }
    return energy;
  }
};

}  // namespace

int main() {
  std::vector<std::unique_ptr<Manifold>> spheres;
  for (int k = 0; k < 12; ++k) spheres.push_back(std::make_unique<Sphere>(3));
  const ProductManifold manifold(std::move(spheres));
  ConjugateGradient method;
  const Result r = minimise(manifold, Thomson(), random_start(manifold, 1), method, {.relative_gradient = 1e-9});
  std::cout.precision(10);
  std::cout << Thomson().name() << " on " << manifold.name() << ": " << to_string(r.outcome) << " after "
            << r.iterations << " iterations, f = " << r.value << '\n';

  const auto laws = lagroid::laws::objective_laws(manifold, Thomson());
  std::cout << laws;
  return r.converged() && laws.holds() ? 0 : 1;
}
