#pragma once
/// What acts on the bodies of a scene: a potential energy U, or forces and torques. An effect of your own is a small
/// struct; of an energy the forces -dU/dx and torques follow automatically.
///
///     struct RubberBand {
///       std::array<Site, 2> sites;
///       double stiffness = 1;  // N/m
///       template <class S> S energy(const Vector<S, 3>& a, const Vector<S, 3>& b) const {
///         return (b - a).squaredNorm() * (0.5 * stiffness);
///       }
///     };
///
/// It is added by `Scene::add`, and laws::effect_laws compare energy and forces.

#include <lagroid/core/scalars/jet.hpp>
#include <lagroid/systems/multibody/configuration.hpp>

#include <array>
#include <concepts>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::multibody {

/// Places of sites and attitudes when a scene begins to run, by their numbers while it was written.
struct Places {
  std::vector<int> sites;
  std::vector<int> attitudes;

  Site operator()(Site s) const { return {sites[std::size_t(s.index)]}; }
  Attitude operator()(Attitude a) const {
    return {a.index < 0 ? int(attitudes.size()) : attitudes[std::size_t(a.index)]};
  }
};

/// What is switched on and off by a name. The first has none, and is always on.
struct Switches {
  std::vector<std::string> names{""};
  std::vector<char> on{1};
};

/// All effects of one kind: one virtual call for the forces of them all. A scene without them makes none.
template <class S = double> class BasicEffects {
 public:
  virtual ~BasicEffects() = default;
  /// Adds what acts at this configuration.
  virtual void add_loads(const BasicConfiguration<S>& at, BasicLoads<S>& loads) const = 0;
  /// The potential energy, J; zero for what has none.
  virtual S energy(const BasicConfiguration<S>& at) const = 0;
  virtual void place(const Places& places) = 0;
  /// Whether it attracts by inverse squares, so that a time scale follows from its energy.
  virtual bool attracts() const { return false; }
  /// The sites that forces act on.
  virtual std::vector<Site> sites() const = 0;
};
using Effects = BasicEffects<>;

/// An effect is a small struct with the `sites` it acts on and, if it needs them, the `attitudes`; both arrays. It
/// writes either
///     template <class S> S energy(const Vector<S, 3>& x...) const        one argument a site, then Matrix<S, 3, 3>
///                                                                        arguments, one an attitude
/// of which forces and torques are derived automatically, or
///     double energy(const Configuration& at) const;   void add_loads(const Configuration& at, Loads& f) const;
template <class E, class S = double>
concept WritesLoads = requires(const E& e, const BasicConfiguration<S>& at, BasicLoads<S>& f) {
  { e.energy(at) } -> std::convertible_to<S>;
  e.add_loads(at, f);
};

template <class E> constexpr int site_count() { return int(std::tuple_size_v<decltype(E::sites)>); }
template <class E> constexpr int attitude_count() {
  if constexpr (requires { &E::attitudes; }) {
    return int(std::tuple_size_v<decltype(E::attitudes)>);
  } else {
    return 0;
  }
}

/// The sites and attitudes of a kernel, placed.
template <class K> void place_kernel(K& kernel, const Places& places) {
  for (Site& s : kernel.sites) s = places(s);
  if constexpr (attitude_count<K>() > 0)
    for (Attitude& a : kernel.attitudes) a = places(a);
}

namespace detail {

/// Of place or attitude k, the 3 numbers that may carry derivatives are 3k, 3k + 1, 3k + 2.
template <class S, class X, class Variable>
Vector<S, 3> varied(const Vector<X, 3>& x, int k, const Variable& variable) {
  return {variable(x(0), 3 * k), variable(x(1), 3 * k + 1), variable(x(2), 3 * k + 2)};
}

/// A (1 + hat e), e the varied zero.
template <class S, class X, class Variable>
Matrix<S, 3, 3> varied(const Matrix<X, 3, 3>& a, int k, const Variable& variable) {
  const Vector<S, 3> e = varied<S>(Vector<X, 3>(Vector<X, 3>::Constant(X(0))), k, variable);
  Matrix<S, 3, 3> out;
  for (int r = 0; r < 3; ++r) {
    out(r, 0) = e(2) * a(r, 1) - e(1) * a(r, 2) + a(r, 0);
    out(r, 1) = e(0) * a(r, 2) - e(2) * a(r, 0) + a(r, 1);
    out(r, 2) = e(1) * a(r, 0) - e(0) * a(r, 1) + a(r, 2);
  }
  return out;
}

template <class E> Attitude attitude_of(const E& effect, int i) { return effect.attitudes[std::size_t(i)]; }

/// The energy over a scalar S.
template <class S, class E, class X, class Variable>
S energy_over(const E& effect, const BasicConfiguration<X>& at, const Variable& variable) {
  constexpr int n = site_count<E>();
  return [&]<int... I, int... J>(std::integer_sequence<int, I...>, std::integer_sequence<int, J...>) {
    if constexpr (sizeof...(J) == 0) {
      return S(effect.energy(varied<S>(at(effect.sites[std::size_t(I)]), I, variable)...));
    } else {
      return S(effect.energy(varied<S>(at(effect.sites[std::size_t(I)]), I, variable)...,
                             varied<S>(at(attitude_of(effect, J)), n + J, variable)...));
    }
  }
  (std::make_integer_sequence<int, n>{}, std::make_integer_sequence<int, attitude_count<E>()>{});
}

}  // namespace detail

/// All effects of the kind E of a scene.
template <class E, class S = double> class EffectsOf final : public BasicEffects<S> {
 public:
  void add(const E& effect) { all_.push_back(effect); }

  void add_loads(const BasicConfiguration<S>& at, BasicLoads<S>& loads) const override {
    for (const E& effect : all_) {
      if constexpr (WritesLoads<E, S>) {
        effect.add_loads(at, loads);
      } else {
        constexpr int n = site_count<E>();
        constexpr int m = attitude_count<E>();
        using J = Jet<S, 3 * (n + m)>;
        const J u = detail::energy_over<J>(effect, at, [](const S& x, int i) { return J::variable(x, i); });
        const auto du = u.gradient();
        for (int i = 0; i < n; ++i) loads(effect.sites[std::size_t(i)]) -= du.template segment<3>(3 * i);
        if constexpr (m > 0)
          for (int i = 0; i < m; ++i) loads(effect.attitudes[std::size_t(i)]) -= du.template segment<3>(3 * (n + i));
      }
    }
  }

  S energy(const BasicConfiguration<S>& at) const override {
    S sum = 0;
    for (const E& effect : all_) {
      if constexpr (WritesLoads<E, S>) {
        sum += effect.energy(at);
      } else {
        sum += detail::energy_over<S>(effect, at, [](const S& x, int) { return x; });
      }
    }
    return sum;
  }

  void place(const Places& places) override {
    for (E& effect : all_) place_kernel(effect, places);
  }

  bool attracts() const override {
    return requires { E::attracts; };
  }
  std::vector<Site> sites() const override {
    std::vector<Site> out;
    for (const E& effect : all_) out.insert(out.end(), effect.sites.begin(), effect.sites.end());
    return out;
  }

 private:
  std::vector<E> all_;
};

}  // namespace lagroid::multibody
