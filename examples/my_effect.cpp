// A body, an effect and a joint of your own in a scene (docs/multibody.md).

#include <lagroid/systems/multibody/effects.hpp>
#include <lagroid/systems/multibody/joints.hpp>
#include <lagroid/systems/multibody/testing/scene_laws.hpp>

#include <fmt/format.h>

#include <cmath>
#include <iostream>

using namespace lagroid;
using namespace lagroid::multibody;

// A rubber band between a point and a wall at x = 0, slack until it is longer than `slack`: only its energy is written.
struct RubberBand {
  std::array<Site, 1> sites;
  double stiffness = 1;  // N/m
  double slack = 0.5;    // m

  template <class S> S energy(const Vector<S, 3>& x) const {
    const S stretch = x(0) - slack;
    return stretch > S(0.0) ? S(0.5 * stiffness * stretch * stretch) : S(0.0);
  }
};

// A bead on a parabola z = x^2 in the plane y = 0.
struct OnParabola {
  static constexpr int rows = 2;
  std::array<Site, 1> sites;

  void value(const Configuration& at, double* c) const {
    const Vec& x = at(sites[0]);
    c[0] = x(2) - x(0) * x(0);
    c[1] = x(1);
  }
  void gradient(const Configuration& at, Vec* g, RowSize* size) const {
    const Vec& x = at(sites[0]);
    g[0] = {-2 * x(0), 0, 1};
    g[1] = {0, 1, 0};
    size[0] = {std::abs(x(2)) + x(0) * x(0), 1 + 2 * std::abs(x(0))};
    size[1] = {std::abs(x(1)), 1};
  }
};

Scene swing() {
  Scene scene;
  const Body bead = scene.point_mass(/*mass=*/1, {1, 0, 1}, /*velocity=*/{0, 0, 0});
  scene.add(OnParabola{{bead.centre}});
  scene.add(ConstantForce{{bead.centre}, {0, 0, -9.81}});
  scene.add(RubberBand{{bead.centre}, 3, 0.5});
  return scene;
}

int main() {
  Multibody motion(swing(), /*h=*/0.001);
  const auto energy = [&] { return motion.kinetic_energy(motion.momenta()) + motion.potential_energy(); };
  const double first = energy();
  for (int k = 0; k < 5000; ++k)
    if (!motion.advance().converged()) return 1;
  const Vec& x = motion.configuration().x[0];
  fmt::print("after {} s: ({:.4f}, {:.4f}), energy {:+.1e} off\n", motion.time(), x(0), x(2), energy() - first);

  const laws::LawReport reports[] = {laws::effect_laws(RubberBand{}, "rubber band"),
                                     laws::joint_laws(OnParabola{}, "bead on a parabola"),
                                     laws::scene_laws({"swing", swing, 0.001, 0.5})};
  bool all_hold = true;
  for (const auto& report : reports) {
    std::cout << report;
    all_hold = all_hold && report.holds();
  }
  return all_hold ? 0 : 1;
}
