#pragma once
/// Point masses tied by rods under gravity: as scenes, and the naive way.

#include <lagroid/systems/multibody/effects.hpp>
#include <lagroid/systems/multibody/joints.hpp>
#include <lagroid/systems/multibody/multibody.hpp>

#include "hard_case.hpp"

#include <Eigen/LU>

#include <cmath>
#include <vector>

namespace lagroid::hard {

using multibody::Body;
using multibody::Multibody;
using multibody::Scene;
using multibody::Site;
using multibody::Vec;

constexpr double weight = 9.81;

/// Masses, and rods between two of them, or (first = -1) between the ground at `anchor` and one.
struct Rods {
  struct Link {
    int first;
    int second;
    Vec anchor = Vec::Zero();
  };
  std::vector<double> masses;
  std::vector<Vec> places;
  std::vector<Vec> rates;
  std::vector<Link> links;
  std::vector<double> lengths;

  void hang(double mass, const Vec& place, const Vec& rate = Vec::Zero()) {
    masses.push_back(mass);
    places.push_back(place);
    rates.push_back(rate);
  }
  void tie(int first, int second, const Vec& anchor = Vec::Zero()) {
    links.push_back({first, second, anchor});
    lengths.push_back((places[std::size_t(second)] - from(links.back(), places)).norm());
  }
  static Vec from(const Link& link, const std::vector<Vec>& x) {
    return link.first < 0 ? link.anchor : x[std::size_t(link.first)];
  }

  Scene scene() const {
    Scene out;
    std::vector<Body> bodies;
    for (std::size_t i = 0; i < masses.size(); ++i) {
      bodies.push_back(out.point_mass(masses[i], places[i], rates[i]));
      out.add(multibody::ConstantForce{{bodies.back().centre}, {0, 0, -masses[i] * weight}});
    }
    for (std::size_t k = 0; k < links.size(); ++k) {
      const Link& link = links[k];
      const Site first = link.first < 0 ? out.ground(link.anchor) : bodies[std::size_t(link.first)].centre;
      out.add(multibody::Rod{{first, bodies[std::size_t(link.second)].centre}, lengths[k]});
    }
    return out;
  }

  double energy(const std::vector<Vec>& x, const std::vector<Vec>& v) const {
    double sum = 0;
    for (std::size_t i = 0; i < masses.size(); ++i) sum += masses[i] * (0.5 * v[i].squaredNorm() + weight * x[i](2));
    return sum;
  }
  /// The largest relative error of a rod's length.
  double stretch(const std::vector<Vec>& x) const {
    double worst = 0;
    for (std::size_t k = 0; k < links.size(); ++k)
      worst = worse(worst, std::abs((x[std::size_t(links[k].second)] - from(links[k], x)).norm() / lengths[k] - 1));
    return worst;
  }
  /// What energies are relative to: the weight times the length of all links.
  double scale() const {
    double mass = 0;
    double length = 0;
    for (const double m : masses) mass += m;
    for (const double l : lengths) length += l;
    return mass * weight * length;
  }

  /// Accelerations under tensions that keep the second derivatives of the lengths zero, by one dense solve.
  std::vector<Vec> accelerations(const std::vector<Vec>& x, const std::vector<Vec>& v) const {
    const auto rows = Eigen::Index(links.size());
    const auto masses_count = Eigen::Index(masses.size());
    Eigen::MatrixXd gradient = Eigen::MatrixXd::Zero(rows, 3 * masses_count);
    Eigen::MatrixXd response = gradient;
    Eigen::VectorXd right(rows);
    for (Eigen::Index k = 0; k < rows; ++k) {
      const Link& link = links[std::size_t(k)];
      const Vec d = x[std::size_t(link.second)] - from(link, x);
      Vec rate = v[std::size_t(link.second)];
      if (link.first >= 0) rate -= v[std::size_t(link.first)];
      gradient.block<1, 3>(k, 3 * link.second) = d.transpose();
      if (link.first >= 0) gradient.block<1, 3>(k, 3 * link.first) = -d.transpose();
      right(k) = -rate.squaredNorm() + (link.first < 0 ? weight * d(2) : 0.0);
    }
    for (Eigen::Index i = 0; i < 3 * masses_count; ++i) response.col(i) = gradient.col(i) / masses[std::size_t(i / 3)];
    const Eigen::VectorXd tension = (response * gradient.transpose()).partialPivLu().solve(right);
    const Eigen::VectorXd pull = response.transpose() * tension;
    std::vector<Vec> out(masses.size());
    for (std::size_t i = 0; i < masses.size(); ++i) out[i] = pull.segment<3>(3 * Eigen::Index(i)) - Vec(0, 0, weight);
    return out;
  }
};

/// What a run does to energy (over Rods::scale) and rods, and where it ends.
struct RodRun {
  double energy = 0;
  double stretch = 0;
  std::vector<Vec> end;
};

/// By steps of the library.
inline RodRun run_rods(const Rods& rods, double h, long steps) {
  Multibody motion(rods.scene(), h);
  const double first = rods.energy(rods.places, rods.rates);
  RodRun out;
  for (long k = 0; k < steps; ++k) {
    if (!motion.advance().converged()) return {not_a_number, not_a_number, rods.places};
    const auto m = motion.momenta();
    const double energy = motion.kinetic_energy(m) + motion.potential_energy();
    out.energy = worse(out.energy, std::abs(energy - first) / rods.scale());
    out.stretch = worse(out.stretch, motion.constraint_residual());
  }
  for (std::size_t i = 0; i < rods.masses.size(); ++i)
    out.end.push_back(motion.configuration().x[std::size_t(motion.linear_place(int(i)))]);
  return out;
}
/// The naive way: accelerations from a dense solve, v += h a, x += h v, and no correction of the rods.
inline RodRun run_rods_naively(const Rods& rods, double h, long steps) {
  RodRun out;
  out.end = rods.places;
  std::vector<Vec> v = rods.rates;
  const double first = rods.energy(out.end, v);
  for (long k = 0; k < steps; ++k) {
    const auto a = rods.accelerations(out.end, v);
    for (std::size_t i = 0; i < v.size(); ++i) {
      v[i] += h * a[i];
      out.end[i] += h * v[i];
    }
    out.energy = worse(out.energy, std::abs(rods.energy(out.end, v) - first) / rods.scale());
    out.stretch = worse(out.stretch, rods.stretch(out.end));
  }
  return out;
}

}  // namespace lagroid::hard
