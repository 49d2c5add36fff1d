#pragma once
/// Laws of effects, joints and scenes, for your own: forces are those of the energy, gradients those of the values;
/// steps are of order two, symplectic and reversible where the scene allows it.
///
///     const auto fall = [] {
///       multibody::Scene scene;
///       scene.point_mass(1, {0, 0, 0}, {1, 0, 0});
///       return scene;
///     };
///     std::cout << laws::scene_laws({"free point", fall, 0.01, 0.5});  // h, horizon
///
/// A law that does not hold is no exception: the report shows it.

#include <lagroid/core/testing/property.hpp>
#include <lagroid/systems/multibody/multibody.hpp>

#include <array>
#include <cmath>
#include <functional>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace lagroid::laws {

namespace detail {

/// A configuration of `sites` points within a box of two metres and `attitudes` turned bodies, at any time.
inline multibody::Configuration draw_configuration(int sites, int attitudes) {
  multibody::Configuration at;
  at.time = 10 * draw_uniform();
  for (int i = 0; i < sites; ++i) at.x.emplace_back(draw_uniform(), draw_uniform(), draw_uniform());
  for (int i = 0; i < attitudes; ++i)
    at.attitude.push_back(SO3::exp(multibody::Vec(2 * draw_uniform(), 2 * draw_uniform(), 2 * draw_uniform())));
  at.attitude.push_back(multibody::Mat::Identity());
  at.arm.assign(at.x.size(), 0.0);
  return at;
}

/// The kernel on the sites 0, 1, ... and the attitudes 0, 1, ...
template <class K> K on_own_places(K kernel) {
  for (std::size_t i = 0; i < kernel.sites.size(); ++i) kernel.sites[i] = {int(i)};
  if constexpr (multibody::attitude_count<K>() > 0)
    for (std::size_t i = 0; i < kernel.attitudes.size(); ++i) kernel.attitudes[i] = {int(i)};
  return kernel;
}

/// The derivative of f along the i-th of the motions of these points and bodies, by differences of order 4.
template <class F> auto derivative_along(const F& f, const multibody::Configuration& at, int sites, int i) {
  using Value = std::decay_t<decltype(f(at))>;
  constexpr double e = 1e-3;
  const auto moved = [&](double by) {
    multibody::Configuration c = at;
    const multibody::Vec along = by * multibody::Vec::Unit(i % 3);
    if (i / 3 < sites) {
      c.x[std::size_t(i / 3)] += along;
    } else {
      auto& a = c.attitude[std::size_t(i / 3 - sites)];
      a = (a * SO3::exp(along)).eval();
    }
    return f(c);
  };
  const Value near = moved(e) - moved(-e);
  const Value far = moved(2 * e) - moved(-2 * e);
  return Value((8 * near - far) / (12 * e));
}

}  // namespace detail

/// "forces are those of the energy": what the effect adds to forces and torques is minus the derivative of its energy,
/// at random places. Not of effects that have no energy.
template <class E> LawReport effect_laws(const E& effect, const std::string& name) {
  LawReport report{name, {}};
  report.laws.push_back(check_law("forces are those of the energy", 1e-7, [&] {
    constexpr int n = multibody::site_count<E>();
    constexpr int m = multibody::attitude_count<E>();
    const auto at = detail::draw_configuration(n, m);
    multibody::EffectsOf<E> effects;
    effects.add(detail::on_own_places(effect));
    multibody::Loads loads{std::vector<multibody::Vec>(n, multibody::Vec::Zero()),
                           std::vector<multibody::Vec>(m + 1, multibody::Vec::Zero())};
    effects.add_loads(at, loads);
    double size = 1;
    double defect = 0;
    for (int i = 0; i < 3 * (n + m); ++i) {
      const double rate = detail::derivative_along([&](const auto& c) { return effects.energy(c); }, at, n, i);
      const double force =
          i / 3 < n ? loads.on[std::size_t(i / 3)](i % 3) : loads.torque[std::size_t(i / 3 - n)](i % 3);
      size = std::max(size, std::abs(rate));
      defect = worst({defect, std::abs(force + rate)});
    }
    // Differences lose where the energy is steep.
    if (size > 100) throw NotSampled("the energy is steep here");
    return defect / size;
  }));
  return report;
}

/// "gradients are those of the values": of a joint's rows, at random places.
template <class J> LawReport joint_laws(const J& joint, const std::string& name) {
  LawReport report{name, {}};
  report.laws.push_back(check_law("gradients are those of the values", 1e-7, [&] {
    constexpr int n = multibody::site_count<J>();
    constexpr int m = multibody::attitude_count<J>();
    const auto at = detail::draw_configuration(n, m);
    const J own = detail::on_own_places(joint);
    std::array<multibody::Vec, std::size_t(J::rows) * (n + m)> g;
    std::array<multibody::RowSize, std::size_t(J::rows)> size;
    own.gradient(at, g.data(), size.data());
    const auto values = [&](const auto& c) {
      Vector<double, J::rows> out;
      own.value(c, out.data());
      return out;
    };
    double defect = 0;
    for (int i = 0; i < 3 * (n + m); ++i) {
      const Vector<double, J::rows> rate = detail::derivative_along(values, at, n, i);
      for (int row = 0; row < J::rows; ++row)
        defect = worst({defect, std::abs(g[std::size_t(row * (n + m) + i / 3)](i % 3) - rate(row))});
    }
    return defect;
  }));
  return report;
}

/// "gradients are those of the values", along the displacement and the turn, the source being held, and, where the
/// joint can be vakonomic, "drifts are those of the values", along the source: of a joint on arrows, at random arrows.
template <class J> LawReport arrow_joint_laws(const J& joint, const std::string& name) {
  constexpr int n = multibody::site_count<J>();
  constexpr int m = multibody::attitude_count<J>();
  constexpr std::size_t gradients = std::size_t(J::rows) * (n + m);
  const J own = detail::on_own_places(joint);
  struct Arrow {
    multibody::Configuration before = detail::draw_configuration(n, m);
    std::vector<multibody::Vec> displacements, turns;
    Arrow() {
      for (int i = 0; i < n; ++i) displacements.emplace_back(draw_uniform(), draw_uniform(), draw_uniform());
      for (int i = 0; i < m; ++i) turns.emplace_back(draw_uniform(), draw_uniform(), draw_uniform());
    }
    multibody::SceneArrow motion() const { return {before, before, displacements, turns, 0.1}; }
  };
  const auto values = [&](const Arrow& arrow) {
    Vector<double, J::rows> out;
    own.value(arrow.motion(), out.data());
    return out;
  };
  const auto defect = [&](const auto& g, const auto& rate_along) {
    double largest = 0;
    for (int i = 0; i < 3 * (n + m); ++i) {
      const Vector<double, J::rows> rate = rate_along(i);
      for (int row = 0; row < J::rows; ++row)
        largest = worst({largest, std::abs(g[std::size_t(row * (n + m) + i / 3)](i % 3) - rate(row))});
    }
    return largest;
  };
  LawReport report{name, {}};
  report.laws.push_back(check_law("gradients are those of the values", 1e-7, [&] {
    const Arrow arrow;
    std::array<multibody::Vec, gradients> g;
    own.gradient(arrow.motion(), g.data());
    return defect(g, [&](int i) {
      const auto at = [&](double by) {
        Arrow moved = arrow;
        (i / 3 < n ? moved.displacements[std::size_t(i / 3)] : moved.turns[std::size_t(i / 3 - n)])(i % 3) += by;
        return values(moved);
      };
      constexpr double e = 1e-3;
      return Vector<double, J::rows>((8 * (at(e) - at(-e)) - (at(2 * e) - at(-2 * e))) / (12 * e));
    });
  }));
  if constexpr (requires(const multibody::SceneArrow& motion, multibody::Vec* g) { own.drift(motion, g); })
    report.laws.push_back(check_law("drifts are those of the values", 1e-7, [&] {
      const Arrow arrow;
      std::array<multibody::Vec, gradients> g;
      own.drift(arrow.motion(), g.data());
      return defect(g, [&](int i) {
        return detail::derivative_along(
            [&](const multibody::Configuration& before) {
              Arrow moved = arrow;
              moved.before = before;
              return values(moved);
            },
            arrow.before, n, i);
      });
    }));
  return report;
}

/// A scene made anew for every question, and its step.
struct SceneSubject {
  std::string name;
  std::function<multibody::Scene()> make;
  double h = 0.01;
  double horizon = 1;      ///< s, over which orders are measured
  bool symplectic = true;  ///< without damping and without forces that have no energy
  bool reversible = true;  ///< where it is symplectic: not where time gives forces or motions
};

/// The laws of a scene's step: "steps go back the way they came", "order two", and, where it is to be, "symplectic":
/// the loop integral of the momenta along a closed curve of initial momenta is carried along.
inline LawReport scene_laws(const SceneSubject& subject) {
  using multibody::Multibody;
  using multibody::Vec;
  LawReport report{subject.name, {}};
  const auto begun = [&](double h) {
    Multibody motion(subject.make(), h);
    motion.make_tangent();
    return motion;
  };
  const auto integrate = [](Multibody& motion, long steps) {
    for (long k = 0; k < steps; ++k)
      if (!motion.advance().converged()) throw std::runtime_error("a step failed");
  };
  const auto places = [](const Multibody& motion) {
    const auto& state = motion.state();
    std::vector<double> all;
    for (std::size_t f = 0; f < state.momentum.size(); ++f) {
      const Vec& x = state.at.x[f];
      all.insert(all.end(), x.data(), x.data() + 3);
    }
    for (const auto& q : state.attitude) all.insert(all.end(), q.data(), q.data() + 4);
    return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(all.data(), Eigen::Index(all.size())));
  };
  const auto ask_law = [&](const char* name, double tolerance, const std::function<double()>& defect) {
    Law law;
    law.name = name;
    law.tolerance = tolerance;
    try {
      law.samples = 1;
      law.worst = worst({defect()});
    } catch (const std::exception& error) {
      law.first_failure = error.what();
    }
    report.laws.push_back(law);
  };
  if (subject.symplectic && subject.reversible)
    ask_law("steps go back the way they came", 1e-9, [&] {
      Multibody motion = begun(subject.h);
      const auto start = places(motion);
      integrate(motion, 20);
      motion.reverse();
      integrate(motion, 20);
      return (places(motion) - start).norm() / (1 + start.norm());
    });
  ask_law("order two", 0.15, [&] {
    const auto end = [&](int steps) {
      Multibody motion = begun(subject.horizon / steps);
      integrate(motion, steps);
      return places(motion);
    };
    const int steps = std::max(10, int(subject.horizon / subject.h));
    const auto coarse = end(steps);
    const auto middle = end(2 * steps);
    const auto fine = end(4 * steps);
    const double difference = (middle - fine).norm();
    if (difference < 1e-12 * (1 + fine.norm())) return 0.0;  // exact, but for round-off
    return std::abs(std::log2((coarse - middle).norm() / difference) - 2);
  });
  if (subject.symplectic)
    ask_law("symplectic", 1e-6, [&] {
      static constexpr int points = 64;
      // Places that have moved under one push, momenta that have had another: the loop encloses an area.
      const auto push = [](Multibody& motion, double phase) {
        auto state = motion.state();
        double largest = 0;
        for (const auto* momenta : {&state.momentum, &state.spin})
          for (const Vec& p : *momenta) largest = std::max(largest, p.norm());
        double along = 0.1;
        for (auto* momenta : {&state.momentum, &state.spin})
          for (Vec& p : *momenta) {
            p += (0.2 * p.norm() + 1e-3 * largest) *
                 Vec(std::cos(phase + along), std::sin(phase), std::sin(2 * phase + along));
            along += 0.7;
          }
        motion.restore(state);
        motion.make_tangent();
      };
      std::vector<Multibody> loop;
      for (int k = 0; k < points; ++k) {
        const double phase = 2 * M_PI * k / points;
        Multibody motion = begun(subject.h);
        integrate(motion, 5);
        push(motion, phase);
        integrate(motion, 10);
        push(motion, phase + 0.5 * M_PI);
        loop.push_back(std::move(motion));
      }
      // Two loop integrals, five steps apart, of p dq by the periodic trapezoid with spectral derivatives.
      double variation = 0;
      const auto integral = [&] {
        double sum = 0;
        const auto add = [&](const auto& p, const auto& rate) {
          sum += p.dot(rate);
          variation += p.norm() * rate.norm() * 2 * M_PI / points;
        };
        const auto weight = [](int d) {
          // Derivative of periodic data at distance d, points even.
          return d == 0 ? 0.0 : 0.5 * (d % 2 == 0 ? 1 : -1) / std::tan(M_PI * d / points);
        };
        for (int k = 0; k < points; ++k) {
          const auto& at = loop[std::size_t(k)].state();
          for (std::size_t f = 0; f < at.momentum.size(); ++f) {
            Vec rate = Vec::Zero();
            for (int j = 0; j < points; ++j)
              if (j != k) rate += weight(k - j) * loop[std::size_t(j)].configuration().x[f];
            add(at.momentum[f], rate);
          }
          for (std::size_t r = 0; r < at.spin.size(); ++r) {
            Vector<double, 4> rate = Vector<double, 4>::Zero();
            for (int j = 0; j < points; ++j)
              if (j != k) rate += weight(k - j) * loop[std::size_t(j)].state().attitude[r];
            // w = 2 conj(q) q'
            const auto& q = at.attitude[r];
            const Vec w = 2 * (q(0) * rate.tail<3>() - rate(0) * q.tail<3>() - q.tail<3>().cross(rate.tail<3>()));
            add(at.spin[r], w);
          }
        }
        return sum * 2 * M_PI / points;
      };
      const double before = integral();
      for (auto& motion : loop) integrate(motion, 5);
      return std::abs(integral() - before) / variation;
    });
  return report;
}

}  // namespace lagroid::laws
