#pragma once
/// The configuration of a scene, where its points and bodies are at one time, and the loads on them; `Site` and
/// `Attitude` name a point and a rotation. SI units.

#include <lagroid/core/types.hpp>

#include <utility>
#include <vector>

namespace lagroid::multibody {

using Vec = Vector<double, 3>;
using Mat = Matrix<double, 3, 3>;

/// A point of a body or of the ground. In a scene that is being written, its number there; in one that runs, its place
/// in `Configuration::x`.
struct Site {
  int index = -1;
};

/// What turns: a body in space, or the ground (which is the default). In a scene that runs, its place in
/// `Configuration::attitude`.
struct Attitude {
  int index = -1;
};

/// Bodies at one time. `x` holds the places of all point masses and centres of mass, (x, y, angle) of the planar
/// bodies, then the points fixed to bodies and to the ground; `attitude` the rotations A that carry bodies to space,
/// and last the identity, which is the ground's. Lengths in m, time in s.
struct Configuration {
  double time = 0;
  std::vector<Vec> x;
  std::vector<Mat> attitude;
  std::vector<double> arm;  ///< how far each point is from the place that moves it, m

  /// The size of the numbers that a site's place is a sum of, m.
  double size(Site s) const {
    const auto i = std::size_t(s.index);
    return x[i].lpNorm<Eigen::Infinity>() + arm[i];
  }

  const Vec& operator()(Site s) const { return x[std::size_t(s.index)]; }
  const Mat& operator()(Attitude a) const { return attitude[std::size_t(a.index)]; }

  friend void swap(Configuration& a, Configuration& b) noexcept {
    std::swap(a.time, b.time);
    a.x.swap(b.x);
    a.attitude.swap(b.attitude);
    a.arm.swap(b.arm);
  }
};

/// What acts at one time: forces (N) on sites, by their place, and torques (N m) in the body's frame on attitudes. On a
/// planar body's own place: (force, force, torque).
struct Loads {
  std::vector<Vec> on;
  std::vector<Vec> torque;

  Vec& operator()(Site s) { return on[std::size_t(s.index)]; }
  Vec& operator()(Attitude a) { return torque[std::size_t(a.index)]; }

  friend void swap(Loads& a, Loads& b) noexcept {
    a.on.swap(b.on);
    a.torque.swap(b.torque);
  }
};

}  // namespace lagroid::multibody
