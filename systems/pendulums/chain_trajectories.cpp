#include <lagroid/systems/pendulums/chain_trajectories.hpp>

#include <lagroid/solvers/lie_group/integrator.hpp>

#include <fmt/format.h>

#include <cmath>
#include <random>
#include <stdexcept>

namespace lagroid {

namespace {

/// Numbers that are the same on every platform, unlike those of std::uniform_real_distribution.
class Draw {
 public:
  explicit Draw(unsigned seed) : generator_(seed) {}
  /// In [0, 1).
  double uniform() { return double(generator_()) / 4294967296.0; }
  Vector<double, 3> on_sphere() {
    const double z = 2 * uniform() - 1;
    const double angle = 2 * 3.14159265358979323846 * uniform();
    const double r = std::sqrt((1 - z) * (1 + z));
    return {r * std::cos(angle), r * std::sin(angle), z};
  }

 private:
  std::mt19937 generator_;
};

}  // namespace

std::vector<learning::Observation> draw_trajectories(const PendulumChain<Eigen::Dynamic>& chain,
                                                     const ChainTrajectories& which) {
  if (which.count < 1 || which.points < 2 || !(which.duration > 0) || !std::isfinite(which.duration) ||
      !(which.noise >= 0) || !std::isfinite(which.noise))
    throw std::invalid_argument(
        "trajectories to be drawn are one or more, of two or more points, over a positive time, with noise zero or "
        "positive, all finite");
  using Field = ChainMomentumField<Eigen::Dynamic>;
  Draw draw(which.seed);
  const int k = chain.links();
  std::vector<learning::Observation> out;
  for (int n = 0; n < which.count; ++n) {
    auto z = chain.space().zero_point();
    for (int i = 0; i < k; ++i) {
      const Vector<double, 3> q = draw.on_sphere();
      Vector<double, 3> s;
      for (double& x : s) x = draw.uniform();
      CotangentSpheres<Eigen::Dynamic>::set(z, i, q, cross(q, s));
    }
    ControlledLieGroupIntegrator integrator(
        chain.space(), Field(chain), lie_group_methods::munthe_kaas_54, z,
        LieGroupControl{.tolerance = 1e-13, .most_steps = 1'000'000, .stop = which.stop});
    for (int j = 0; j < which.points; ++j) {
      const double time = which.duration * j / (which.points - 1);
      if (j > 0 && !integrator.advance_to(time).converged())
        throw std::runtime_error(
            fmt::format("trajectory {} of the chain cannot be followed to t = {:g}; take a shorter duration, or other "
                        "masses and lengths",
                        n + 1, time));
      learning::Observation row{long(out.size()) + 1, n + 1, time, integrator.point().reshaped(), 1};
      if (j > 0)
        for (double& x : row.z) x += which.noise * (2 * draw.uniform() - 1);
      out.push_back(std::move(row));
    }
  }
  return out;
}

}  // namespace lagroid
