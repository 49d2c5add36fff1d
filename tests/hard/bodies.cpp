// Scenes of bodies: light and heavy ones, chains that drop and snap, stiff springs, hard drag.
#include "support/rods.hpp"

#include <algorithm>
#include <array>

namespace lagroid::hard {
namespace {

/// A chain of equal links from the origin, at rest along a direction.
Rods chain(const std::vector<double>& masses, double length, const Vec& along) {
  Rods out;
  for (std::size_t i = 0; i < masses.size(); ++i) {
    out.hang(masses[i], double(i + 1) * length * along);
    out.tie(int(i) - 1, int(i));
  }
  return out;
}
const Vec slanting = Vec(0.6, 0.3, -0.4).normalized();

Rods heavy_end() {
  std::vector<double> masses(10, 1e-6);
  masses.back() = 1;
  return chain(masses, 0.1, slanting);
}
Rods light_between() {
  std::vector<double> masses(10, 1);
  for (std::size_t i = 1; i < 10; i += 2) masses[i] = 1e-6;
  return chain(masses, 0.1, slanting);
}
Rods light_tip() {
  std::vector<double> masses(4, 1);
  masses.back() = 1e-6;
  return chain(masses, 0.25, slanting);
}

/// hard_k2_mass1e6_lighttip of shared/cases/spherical-pendulum-chain.json: 1 kg and 1e-6 kg, 2 s; 20 digits.
Rods light_second() {
  Rods out;
  const Vec q1(0.9092974268256817, 0.0, -0.4161468365471424);
  const Vec q2(0.5357987837357605, 0.8344571646507748, -0.12884449429552464);
  const Vec w1(0.07247576267903523, 0.3, 0.15836243057397342);
  const Vec w2(-0.09374154255814433, 0.09826542503338954, 0.2465893761476878);
  out.hang(1, q1, w1.cross(q1));
  out.hang(1e-6, q1 + q2, w1.cross(q1) + w2.cross(q2));
  out.tie(-1, 0);
  out.tie(0, 1);
  return out;
}
double light_second_error(const RodRun& run) {
  const Vec q1(0.8598470048016735, 0.09732211036127701, -0.5011901187856942);
  const Vec q2(-0.7109640125858409, -0.50162806665473, 0.4928483088660019);
  return worse((run.end[0] - q1).norm(), (run.end[1] - q1 - q2).norm());
}

/// hard_k20_drop of the same file: 20 links of 0.05 m and 0.05 kg, level, each turned by 0.01 rad against the last.
Rods drop() {
  Rods out;
  Vec at = Vec::Zero();
  for (int i = 0; i < 20; ++i) {
    at += 0.05 * Vec(std::cos(0.01 * i), std::sin(0.01 * i), 0);
    out.hang(0.05, at);
    out.tie(i - 1, i);
  }
  return out;
}
/// Its tip after 0.3 s, from the directions of the links there.
Vec dropped_tip() {
  constexpr std::array<std::array<double, 3>, 20> links{
      {{0.4982922664207636, 0.04996352283210824, -0.8655682893980488},
       {0.517140570326143, 0.0515124271779787, -0.8543489336149399},
       {0.5318745838695419, 0.05221871698900271, -0.845211590449175},
       {0.5591621987160577, 0.05353586050071922, -0.8273279562346915},
       {0.5711645255332085, 0.053352859483166565, -0.8190998456582654},
       {0.6142751401022061, 0.05398227990352021, -0.7872432697132654},
       {0.6230293034277189, 0.05337385528731534, -0.7803753703456691},
       {0.6775764719353686, 0.05163846093724132, -0.7336372359904121},
       {0.722968632642148, 0.051836835370706026, -0.6889334501345491},
       {0.7373482366133274, 0.04800307517010597, -0.6738050777023201},
       {0.8421710610236903, 0.04173653602030875, -0.5375927506349552},
       {0.9565762553275237, 0.03856713714389625, -0.2889194414990037},
       {0.9941619476036176, 0.041012572557996556, -0.09979975365278668},
       {0.9985668050169482, 0.04831098294646955, -0.023030085648779012},
       {0.9983264017986703, 0.05771437898592809, -0.0036668692352862567},
       {0.9977105034011435, 0.06762829078906964, -0.000407047891412989},
       {0.9969838056800823, 0.07760985909975932, -3.133967757444538e-05},
       {0.9961571159930892, 0.08758424660664418, -1.6362996755540156e-06},
       {0.9952313779950083, 0.09754232032381627, -5.5131171316974675e-08},
       {0.9942069766738426, 0.10748249872913006, -1.0787275143968967e-09}}};
  Vec tip = Vec::Zero();
  for (const auto& link : links) tip += 0.05 * Vec(link[0], link[1], link[2]);
  return tip;
}

/// A mass on a spring of 1e8 N/m, at rest a millimetre away from where it wants to be; w = 1e4 rad/s.
constexpr double stiffness = 1e8;
Scene stiff() {
  Scene out;
  const Body mass = out.point_mass(1, {1.001, 0, 0}, Vec::Zero());
  out.add(multibody::Spring{{out.ground(Vec::Zero()), mass.centre}, stiffness, 1});
  return out;
}
double stiff_energy(double h, int steps) {
  Multibody motion(stiff(), h);
  const double first = motion.potential_energy();
  double worst = 0;
  for (int k = 0; k < steps; ++k) {
    if (!motion.advance().converged()) return not_a_number;
    worst = worse(worst, std::abs((motion.kinetic_energy(motion.momenta()) + motion.potential_energy()) / first - 1));
  }
  return worst;
}
double stiff_energy_by_euler(double h, int steps) {
  double x = 0.001;
  double v = 0;
  double worst = 0;
  for (int k = 0; k < steps; ++k) {
    const double a = -stiffness * x;
    x += h * v;
    v += h * a;
    worst = worse(worst, std::abs((0.5 * v * v + 0.5 * stiffness * x * x) / (0.5 * stiffness * 1e-6) - 1));
  }
  return worst;
}
/// 0 where steps that do not resolve the spring end in a typed status, all finite before and after.
double unresolved(double h) {
  Multibody motion(stiff(), h);
  for (int k = 0; k < 10'000; ++k) {
    const auto before = motion.state();
    const StepReport report = motion.advance();
    const auto after = motion.state();
    if (!after.at.x[0].allFinite() || !after.momentum[0].allFinite()) return 1;
    if (!report.converged())
      return before.index == after.index && before.at.x[0] == after.at.x[0] && before.momentum[0] == after.momentum[0]
                 ? 0
                 : 1;
  }
  return 1;
}

/// Drag of 1e6 kg/s on a kilogram in steps of a hundredth of a second: speeds, over the first.
double dragged(bool naive) {
  constexpr double h = 0.01;
  constexpr double drag = 1e6;
  double worst = 0;
  double v = 1;
  Scene scene;
  const Body mass = scene.point_mass(1, Vec::Zero(), {1, 0, 0});
  scene.damp(mass, drag, 0);
  Multibody motion(std::move(scene), h);
  for (int k = 0; k < 1000; ++k) {
    if (naive) {
      v -= h * drag * v;
    } else {
      if (!motion.advance().converged()) return not_a_number;
      v = motion.momenta().linear[0](0);
    }
    worst = worse(worst, std::abs(v));
  }
  return worst;
}
/// Energy and what the drag took add up, over the first energy.
double drag_balance() {
  Scene scene;
  const Body mass = scene.point_mass(1, Vec::Zero(), {1, 0, 0});
  scene.damp(mass, 1e6, 0);
  Multibody motion(std::move(scene), 0.01);
  double worst = 0;
  for (int k = 0; k < 1000; ++k) {
    if (!motion.advance().converged()) return not_a_number;
    worst = worse(worst, std::abs(motion.kinetic_energy(motion.momenta()) + motion.dissipated() - 0.5) / 0.5);
  }
  return worst;
}

/// Masses of 1e8, 1 and 1e-8 kg in a triangle of rods that flies and turns: the errors of the momenta, relative.
Rods triangle() {
  Rods out;
  const Vec w(0.3, 0.2, 1);
  const std::array<double, 3> masses{1e8, 1, 1e-8};
  const std::array<Vec, 3> places{Vec(0, 0, 0), Vec(1, 0, 0), Vec(0.3, 0.8, 0)};
  for (int i = 0; i < 3; ++i) out.hang(masses[std::size_t(i)], places[std::size_t(i)], w.cross(places[std::size_t(i)]));
  out.tie(0, 1);
  out.tie(1, 2);
  out.tie(0, 2);
  return out;
}

/// Two that attract each other and meet after one step.
double collision() {
  Scene scene;
  const Body a = scene.point_mass(1, {-1, 0, 0}, {1, 0, 0});
  const Body b = scene.point_mass(1, {1, 0, 0}, {-1, 0, 0});
  scene.add(multibody::InverseSquare{{a.centre, b.centre}, 0});
  Multibody motion(std::move(scene), 1);
  const auto before = motion.state();
  const SolveStatus status = motion.advance().status;
  const auto after = motion.state();
  return status == SolveStatus::not_finite && after.index == 0 && after.at.x[0] == before.at.x[0] &&
                 after.momentum[1] == before.momentum[1]
             ? 0
             : 1;
}

/// A rod that would have to turn by a hundred radians in a step.
double rod_step_too_large() {
  Scene scene;
  const Body a = scene.point_mass(1, {1, 0, 0}, {0, 1000, 0});
  scene.add(multibody::Rod{{scene.ground(Vec::Zero()), a.centre}, 1});
  Multibody motion(std::move(scene), 0.1);
  const auto before = motion.state();
  const bool refused = !motion.advance().converged();
  const auto after = motion.state();
  return refused && after.index == 0 && after.at.x[0] == before.at.x[0] && after.momentum[0] == before.momentum[0] ? 0
                                                                                                                   : 1;
}

/// The chain with the heavy end in steps that do not resolve its light links: 0 where that ends in a typed status, rods
/// kept and all finite.
double heavy_end_unresolved() {
  const Rods rods = heavy_end();
  Multibody motion(rods.scene(), 1e-3);
  for (int k = 0; k < 10'000; ++k) {
    const auto before = motion.state();
    if (motion.advance().converged()) continue;
    const auto after = motion.state();
    for (std::size_t i = 0; i < after.momentum.size(); ++i)
      if (!after.at.x[i].allFinite() || after.at.x[i] != before.at.x[i] || after.momentum[i] != before.momentum[i])
        return 1;
    return motion.constraint_residual() <= 1e-14 ? 0 : 1;
  }
  return 1;
}

}  // namespace

std::vector<HardCase> bodies() {
  const char* const dense = "accelerations by a dense solve, semi-implicit Euler, no correction";
  return {
      {"HeavyEndRods",
       "chain of 10 links, end mass 1e6 times the others, h = 2e-5 (which resolves the links' swing), 1 s",
       "largest residual of a rod", dense, 1e-14, [] { return run_rods(heavy_end(), 2e-5, 50'000).stretch; },
       [] { return run_rods_naively(heavy_end(), 2e-5, 50'000).stretch; }},
      {"HeavyEndEnergy", "the same", "error of the energy, over weight times length", dense, 1e-6,
       [] { return run_rods(heavy_end(), 2e-5, 50'000).energy; },
       [] { return run_rods_naively(heavy_end(), 2e-5, 50'000).energy; }},
      {"HeavyEndUnresolved", "the same with h = 1e-3",
       "not supported: a typed status, rods kept, and nothing moves (0: so)",
       "accelerations by a dense solve, semi-implicit Euler: stretch of a rod", 0, heavy_end_unresolved,
       [] { return run_rods_naively(heavy_end(), 1e-3, 1000).stretch; }},
      {"LightLinksRods",
       "chain of 10 links, every second mass 1e-6 of the others, h = 5e-6 (which resolves their swing), 0.25 s",
       "largest residual of a rod", dense, 1e-14, [] { return run_rods(light_between(), 5e-6, 50'000).stretch; },
       [] { return run_rods_naively(light_between(), 5e-6, 50'000).stretch; }},
      {"LightLinksEnergy", "the same", "error of the energy, over weight times length", dense, 1e-7,
       [] { return run_rods(light_between(), 5e-6, 50'000).energy; },
       [] { return run_rods_naively(light_between(), 5e-6, 50'000).energy; }},
      {"LightTipRods", "chain of 4 links, the last mass 1e-6 of the others, h = 1e-3, 5 s", "largest residual of a rod",
       dense, 1e-14, [] { return run_rods(light_tip(), 1e-3, 5000).stretch; },
       [] { return run_rods_naively(light_tip(), 1e-3, 5000).stretch; }},
      {"LightTipEnd", "double pendulum of 1 and 1e-6 kg, 2 s, h = 5e-4", "error of the ends, m, against 20 digits",
       dense, 1e-4, [] { return light_second_error(run_rods(light_second(), 5e-4, 4000)); },
       [] { return light_second_error(run_rods_naively(light_second(), 5e-4, 4000)); }},
      {"DropEnd", "20 links dropped from level, 0.3 s, h = 1e-4", "error of the tip, m, against 20 digits", dense, 1e-6,
       [] { return (run_rods(drop(), 1e-4, 3000).end.back() - dropped_tip()).norm(); },
       [] { return (run_rods_naively(drop(), 1e-4, 3000).end.back() - dropped_tip()).norm(); }},
      {"DropRods", "20 links dropped from level, 1 s through the snap of the tip at 0.459 s, h = 1e-4",
       "largest residual of a rod", dense, 1e-14, [] { return run_rods(drop(), 1e-4, 10'000).stretch; },
       [] { return run_rods_naively(drop(), 1e-4, 10'000).stretch; }},
      {"DropEnergy", "the same", "error of the energy, over weight times length", dense, 1e-5,
       [] { return run_rods(drop(), 1e-4, 10'000).energy; },
       [] { return run_rods_naively(drop(), 1e-4, 10'000).energy; }},
      {"LightAndHeavyTogether", "rods between 1e8, 1 and 1e-8 kg, free flight, 1e4 steps of 1e-2",
       "largest residual of a rod", dense, 1e-14, [] { return run_rods(triangle(), 1e-2, 10'000).stretch; },
       [] { return run_rods_naively(triangle(), 1e-2, 10'000).stretch; }},
      {"StiffSpringResolved", "spring of 1e8 N/m, 1 kg, h = 1e-5 (w h = 0.1), 1e5 steps",
       "relative error of the energy", "explicit Euler in the same steps", 1e-2,
       [] { return stiff_energy(1e-5, 100'000); }, [] { return stiff_energy_by_euler(1e-5, 100'000); }},
      {"StiffSpringUnresolved", "the same with h = 1e-3 (w h = 10)",
       "not supported (it needs w h < 2): the motion grows, then a typed status; never NaN (0: so)",
       "explicit Euler: relative error of the energy", 0, [] { return unresolved(1e-3); },
       [] { return stiff_energy_by_euler(1e-3, 1000); }},
      {"HardDrag", "drag 1e6 kg/s on 1 kg, h = 1e-2", "largest speed over the first",
       "explicit Euler in the same steps", 1, [] { return dragged(false); }, [] { return dragged(true); }},
      {"HardDragBalance", "the same", "error of energy and dissipation together, relative",
       "explicit Euler: its energy", 1e-10, drag_balance, [] { return 0.5 * dragged(true) * dragged(true); }},
      {"Collision", "two masses that attract each other and meet exactly",
       "not supported: `not_finite`, and nothing "
       "moves (0: so)",
       "the force of inverse squares there", 0, collision,
       [] {
         const Vec d = Vec::Zero();
         return (d / std::pow(d.norm(), 3)).norm();
       }},
      {"RodStepTooLarge", "rod that would turn by 100 rad in a step",
       "not supported: a typed status, and nothing moves "
       "(0: so)",
       "explicit Euler: stretch of the rod", 0, rod_step_too_large, [] { return Vec(1, 100, 0).norm() - 1; }},
  };
}

}  // namespace lagroid::hard
