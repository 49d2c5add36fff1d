// Scenes of bodies: rods that are almost parallel, doubled, or singular; hinges that repeat each other; four-bars.
#include "support/rods.hpp"

#include <algorithm>

namespace lagroid::hard {
namespace {

using multibody::Attitude;
using multibody::Coincidence;
using multibody::ConstantForce;
using multibody::FixedAngle;
using multibody::Quaternion;

const Quaternion upright{1, 0, 0, 0};

/// A mass on two rods from points `gap` apart.
Rods fork(double gap) {
  Rods out;
  out.hang(1, {0, 0.8, -0.6});
  out.tie(-1, 0, {-0.5 * gap, 0, 0});
  out.tie(-1, 0, {0.5 * gap, 0, 0});
  return out;
}

/// A pendulum on one rod, or on the same rod twice.
Rods pendulum(int copies) {
  Rods out;
  out.hang(1, {0.6, 0, -0.8}, {0, 1, 0});
  for (int k = 0; k < copies; ++k) out.tie(-1, 0);
  return out;
}

/// A door on one hinge, or on two on the same axis: its centre after a second.
Vec door(int hinges) {
  Scene scene;
  const Body door = scene.rigid_body(1, {0.3, 0.2, 0.1}, {0.5, 0, 0}, upright, {0, 0, 0}, {0, 0, 0});
  for (int k = 0; k < hinges; ++k) {
    const double height = k == 0 ? -0.4 : 0.4;
    scene.add(Coincidence{{scene.ground({0, 0, height}), scene.point_of(door, {-0.5, 0, height})}});
    scene.add(FixedAngle{{}, {Attitude{}, door.attitude}, {1, 0, 0}, {0, 0, 1}});
    scene.add(FixedAngle{{}, {Attitude{}, door.attitude}, {0, 1, 0}, {0, 0, 1}});
  }
  scene.add(ConstantForce{{door.centre}, {0, 1, 0}});
  Multibody motion(std::move(scene), 0.01);
  for (int k = 0; k < 100; ++k)
    if (!motion.advance().converged() || motion.constraint_residual() > 1e-13) return Vec::Constant(not_a_number);
  return motion.configuration()(motion(door.centre));
}

/// The same door held by four springs of 1e8 N/m in place of its hinges.
Vec door_on_springs() {
  Scene scene;
  const Body door = scene.rigid_body(1, {0.3, 0.2, 0.1}, {0.5, 0, 0}, upright, {0, 0, 0}, {0, 0, 0});
  for (const double height : {-0.4, 0.4})
    scene.add(multibody::Spring{{scene.ground({0, 0, height}), scene.point_of(door, {-0.5, 0, height})}, 1e8, 0});
  scene.add(ConstantForce{{door.centre}, {0, 1, 0}});
  Multibody motion(std::move(scene), 0.01);
  for (int k = 0; k < 100; ++k)
    if (!motion.advance().converged()) return Vec::Constant(not_a_number);
  return motion.configuration()(motion(door.centre));
}

/// A four-bar in the plane y = 0: crank and follower of 1 m, base of 2 m, and a coupler, at that rate of the crank. A
/// coupler of 2 m makes it a parallelogram, whose bars meet in one line.
Rods four_bar(double coupler) {
  constexpr double angle = 1.2;
  constexpr double rate = 8;
  Rods out;
  const Vec p(std::cos(angle), 0, std::sin(angle));
  const Vec base(2, 0, 0);
  // The follower's pin where two circles meet.
  const Vec d = base - p;
  const double along = (d.squaredNorm() + coupler * coupler - 1) / (2 * d.norm());
  const Vec u = d.normalized();
  const Vec q = p + along * u + std::sqrt(coupler * coupler - along * along) * Vec(-u(2), 0, u(0));
  const Vec crank = rate * Vec(-p(2), 0, p(0));
  const Vec side(-(q - base)(2), 0, (q - base)(0));
  out.hang(1, p, crank);
  out.hang(1, q, (q - p).dot(crank) / (q - p).dot(side) * side);
  out.tie(-1, 0);
  out.tie(0, 1);
  out.tie(-1, 1, base);
  return out;
}

/// The largest residual of a rod as long as steps are taken; NaN where what is left is not finite, or moved by a step
/// that was refused.
double rods_or_refusal(const Rods& rods, double h, int steps) {
  Multibody motion(rods.scene(), h);
  double worst = 0;
  for (int k = 0; k < steps; ++k) {
    const auto before = motion.state();
    const bool taken = motion.advance().converged();
    const auto after = motion.state();
    for (std::size_t i = 0; i < after.momentum.size(); ++i) {
      if (!after.at.x[i].allFinite() || !after.momentum[i].allFinite()) return not_a_number;
      if (!taken && (after.at.x[i] != before.at.x[i] || after.momentum[i] != before.momentum[i])) return not_a_number;
    }
    worst = worse(worst, motion.constraint_residual());
    if (!taken) break;
  }
  return worst;
}

/// Three rods in a taut line between two points of the ground: the third depends on the others until gravity acts.
Rods taut() {
  Rods out;
  out.hang(1, {1, 0, 0});
  out.hang(1, {2, 0, 0});
  out.tie(-1, 0);
  out.tie(0, 1);
  out.tie(-1, 1, {3, 0, 0});
  return out;
}
double end_of_dependence(double h) {
  Multibody motion(taut().scene(), h);
  const auto before = motion.state();
  const bool refused = motion.dependent_rows() == 1 && !motion.advance().converged() && motion.dependence_ended();
  const auto after = motion.state();
  return refused && before.at.x[0] == after.at.x[0] && before.momentum[1] == after.momentum[1] ? 0 : 1;
}

template <class F> double over(std::initializer_list<double> values, const F& f) {
  double worst = 0;
  for (const double x : values) worst = worse(worst, f(x));
  return worst;
}

}  // namespace

std::vector<HardCase> joints() {
  const char* const dense = "accelerations by a dense solve, semi-implicit Euler";
  return {
      {"NearlyParallelRods", "a mass on two rods from points 1e-3, 1e-6, 1e-9 apart, 2e4 steps of 1e-3",
       "largest residual of a rod", dense, 1e-11,
       [] {
         return over({1e-3, 1e-6, 1e-9}, [](double gap) { return run_rods(fork(gap), 1e-3, 20'000).stretch; });
       },
       [] {
         return over({1e-3, 1e-6, 1e-9}, [](double gap) { return run_rods_naively(fork(gap), 1e-3, 20'000).stretch; });
       }},
      {"NearlyParallelRodsEnergy", "the same", "error of the energy, over weight times length", dense, 1e-5,
       [] {
         return over({1e-3, 1e-6, 1e-9}, [](double gap) { return run_rods(fork(gap), 1e-3, 20'000).energy; });
       },
       [] {
         return over({1e-3, 1e-6, 1e-9}, [](double gap) { return run_rods_naively(fork(gap), 1e-3, 20'000).energy; });
       }},
      {"DoubledRod", "a pendulum on the same rod twice, 10 s", "distance from the pendulum on one, m", dense, 1e-13,
       [] {
         if (Multibody(pendulum(2).scene(), 1e-2).dependent_rows() != 1) return not_a_number;
         return (run_rods(pendulum(2), 1e-2, 1000).end[0] - run_rods(pendulum(1), 1e-2, 1000).end[0]).norm();
       },
       [] {
         return (run_rods_naively(pendulum(2), 1e-2, 1000).end[0] - run_rods(pendulum(1), 1e-2, 1000).end[0]).norm();
       }},
      {"TwoHingesOnOneAxis", "a door on two hinges, five equations too many", "distance from the door on one, m",
       "stiff springs in place of the hinges, in the same steps", 1e-13, [] { return (door(2) - door(1)).norm(); },
       [] { return (door_on_springs() - door(1)).norm(); }},
      {"FourBar", "four-bars with couplers of 1.5 and 2.5 m, round and round, h = 1e-3",
       "error of the energy, over weight times length", dense, 1e-3,
       [] {
         return over({1.5, 2.5}, [](double coupler) { return run_rods(four_bar(coupler), 1e-3, 10'000).energy; });
       },
       [] {
         return over({1.5, 2.5},
                     [](double coupler) { return run_rods_naively(four_bar(coupler), 1e-3, 10'000).energy; });
       }},
      {"FourBarNearItsLine", "couplers 1e-3 m longer and shorter than a parallelogram's, h = 1e-4",
       "error of the energy, over weight times length", dense, 1e-2,
       [] {
         return over({1.999, 2.001}, [](double coupler) { return run_rods(four_bar(coupler), 1e-4, 100'000).energy; });
       },
       [] {
         return over({1.999, 2.001},
                     [](double coupler) { return run_rods_naively(four_bar(coupler), 1e-4, 100'000).energy; });
       }},
      {"FourBarThroughItsLine", "a parallelogram, and couplers 1e-6 m longer and shorter, h = 1e-3",
       "largest residual of a rod, or a typed refusal; the energy is not promised", dense, 1e-14,
       [] {
         return over({2 - 1e-6, 2, 2 + 1e-6},
                     [](double coupler) { return rods_or_refusal(four_bar(coupler), 1e-3, 10'000); });
       },
       [] {
         return over({2 - 1e-6, 2, 2 + 1e-6},
                     [](double coupler) { return run_rods_naively(four_bar(coupler), 1e-3, 10'000).stretch; });
       }},
      {"DependenceThatEnds", "three rods in a taut line, under gravity, h = 1e-2, 1e-4, 1e-6",
       "not supported: the first step is refused with a status that names it (0: so)",
       "accelerations by a dense solve, semi-implicit Euler: stretch of a rod", 0,
       [] {
         return over({1e-2, 1e-4, 1e-6}, end_of_dependence);
       },
       [] { return run_rods_naively(taut(), 0.01, 10).stretch; }},
  };
}

}  // namespace lagroid::hard
