#pragma once
/// The implicit Euler step on SO(3) that framework and kernel solve.

#include <lagroid/core/source_fibre.hpp>
#include <lagroid/groupoids/groups/so3.hpp>
#include <lagroid/solvers/newton/lie_newton.hpp>

#include "../kernels/rodrigues_newton.hpp"

#include <random>
#include <vector>

namespace bench {

inline constexpr double lie_newton_step = 0.3;

inline std::vector<Eigen::Matrix3d> lie_newton_starts() {
  std::mt19937 generator(1);
  std::uniform_real_distribution<double> uniform(-2, 2);
  std::vector<Eigen::Matrix3d> out(1000);
  for (auto& z : out)
    z = lagroid::SO3::exp(lagroid::Vector<double, 3>(uniform(generator), uniform(generator), uniform(generator)));
  return out;
}

/// Both take g and dg by hand; exp, log, their differentials and the iteration are each one's own.
struct BesideTheDiagonal {
  static Eigen::Vector3d g(const Eigen::Matrix3d& y) { return kernels::RodriguesNewton::g(y); }
  static Eigen::Matrix3d dg(const Eigen::Matrix3d& y) { return kernels::RodriguesNewton::dg(y); }
};

inline auto lie_newton_on_so3(const Eigen::Matrix3d& z, lagroid::LieIteration iteration) {
  using namespace lagroid;
  LieNewtonOptions options;
  options.iteration = iteration;
  const ImplicitStep<GroupoidFibre<SO3>, BesideTheDiagonal> step{GroupoidFibre<SO3>(z), {}, lie_newton_step};
  return lie_newton(step, Eigen::Vector3d::Zero(), options);
}

}  // namespace bench
