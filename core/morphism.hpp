#pragma once
/// Morphisms of Lie groupoids and of discrete constrained Lagrangian systems. [G] 4.1

#include <lagroid/core/derivatives/implicit.hpp>
#include <lagroid/core/matrices/regular_inverse.hpp>
#include <lagroid/core/system.hpp>

#include <concepts>
#include <vector>

namespace lagroid {

/// A morphism Phi : G -> G' ([G] Def. 4.1). The derived class writes, for every scalar,
///
///     Arrow' operator()(const Arrow& g) const        Phi(g h) = Phi(g) Phi(h)
///
/// and, when an arrow of G is determined by its source and its image (Phi is then called an action morphism),
///
///     Arrow lift(const Object& q, const Arrow'& g) const        the arrow with source q and image g
///
/// For reduction downward (core/reduction) it says which object of G stands for one of G', or at once which arrow:
///
///     Object over(const Object'& m) const                an object with Phi_0(q) = m, smooth near each m; it may jump
///     auto representative(const Arrow'& g) const         an arrow with image g; lift(over(source(g)), g) by default
///
/// It may also say
///
///     static constexpr bool keeps_basis = true           A Phi is the identity in the bases of the retractions
///     AlgebroidVector' reduced_momentum(q, mu) const     (A Phi_q)^{-T} mu in closed form
///     bool free_at(const Object'& m) const               whether the symmetry acts freely over m; not there:
///     everywhere
///
/// Deduced are the map of the objects and the morphism of the Lie algebroids.
template <class Derived, class From, class To> struct Morphism {
  using Domain = From;
  using Codomain = To;

  static constexpr bool keeps_basis = false;

  [[no_unique_address]] From from;
  [[no_unique_address]] To to;

  /// Phi_0(q), the source of Phi(unit(q)).
  template <class Q> auto object(const Q& q) const { return to.source(self()(from.unit(q))); }

  /// The matrix of A Phi : A_qG -> A_{Phi_0(q)}G'.
  template <class Q> auto algebroid(const Q& q) const {
    using S = typename decltype(from.coordinates_of_object(q))::Scalar;
    using D = Dual<S>;
    Matrix<S, To::dimension, From::dimension> out;
    const auto qd = from.template cast_object<D>(q);
    for (int i = 0; i < From::dimension; ++i) {
      Vector<D, From::dimension> e;
      for (int j = 0; j < From::dimension; ++j) e(j) = D(S(0.0), S(i == j ? 1.0 : 0.0));
      const Vector<S, To::dimension> column = derivative_of(to.tau_inverse(self()(from.tau(qd, e))));
      for (int j = 0; j < To::dimension; ++j) out(j, i) = column(j);
    }
    return out;
  }

  /// The state over q that is A*Phi-related to a momentum at Phi_0(q): <mu, v> = <mu', A Phi v>. [G] Def. 4.4
  State<From> related(const ObjectOf<From>& q, const AlgebroidVector<To>& momentum) const {
    const auto map = algebroid(q);
    State<From> out{q, {}};
    for (int i = 0; i < From::dimension; ++i) {
      double sum = 0;
      for (int j = 0; j < To::dimension; ++j) sum += map(j, i) * momentum(j);
      out.momentum(i) = sum;
    }
    return out;
  }

  /// The momentum at Phi_0(q) to which mu at q is related: (A Phi_q)^{-T} mu, where fibres have the same dimension.
  /// Over any scalar: the inverse is that of plain numbers, and each infinitesimal takes one correction by it.
  template <class Q, class S>
  Vector<S, To::dimension> reduced_momentum(const Q& q, const Vector<S, From::dimension>& mu) const {
    static_assert(From::dimension == To::dimension, "momenta go down where source fibres have the same dimension");
    if constexpr (Derived::keeps_basis) {
      return mu;
    } else {
      constexpr int n = To::dimension;
      const Matrix<S, n, n> map = algebroid(q);
      Matrix<double, n, n> values;
      for (int i = 0; i < n; ++i)
        for (int j = 0; j < n; ++j) values(i, j) = value_of(map(j, i));
      const Matrix<double, n, n> inverse = regular_inverse(values);
      Vector<S, n> x;
      for (int i = 0; i < n; ++i) x(i) = S(0.0);
      for (int order = 0; order <= nilpotency<S>; ++order) {
        Vector<S, n> defect = mu;
        for (int i = 0; i < n; ++i)
          for (int j = 0; j < n; ++j) defect(i) -= map(j, i) * x(j);
        for (int i = 0; i < n; ++i)
          for (int j = 0; j < n; ++j) x(i) += defect(j) * inverse(i, j);
      }
      return x;
    }
  }

  /// The trajectory from q whose image is the given one.
  std::vector<ArrowOf<From>> reconstruct(ObjectOf<From> q, const std::vector<ArrowOf<To>>& arrows) const {
    std::vector<ArrowOf<From>> out;
    for (const auto& g : arrows) {
      out.push_back(self().lift(q, g));
      q = from.target(out.back());
    }
    return out;
  }

 private:
  const Derived& self() const { return static_cast<const Derived&>(*this); }
};

/// A morphism by which an arrow is determined by its source and its image, between source fibres of one dimension.
template <class Phi>
concept ActionMorphism = Phi::Domain::dimension ==
                         Phi::Codomain::dimension&& requires(const Phi& phi, const ObjectOf<typename Phi::Domain>& q,
                                                             const ArrowOf<typename Phi::Codomain>& g) {
  { phi.lift(q, g) } -> std::convertible_to<ArrowOf<typename Phi::Domain>>;
};

/// One that says which object stands for an object below, or which arrow for an arrow.
template <class Phi>
concept StandsOverObjects = requires(const Phi& phi, const ObjectOf<typename Phi::Codomain>& m) {
  { phi.over(m) } -> std::convertible_to<ObjectOf<typename Phi::Domain>>;
};
template <class Phi>
concept RepresentsArrows = StandsOverObjects<Phi> ||
    requires(const Phi& phi, const ArrowOf<typename Phi::Codomain>& g) {
  { phi.representative(g) } -> std::convertible_to<ArrowOf<typename Phi::Domain>>;
};
/// One of a symmetry that does not act freely everywhere.
template <class Phi>
concept FreeInPart = requires(const Phi& phi, const ObjectOf<typename Phi::Codomain>& m) {
  { phi.free_at(m) } -> std::convertible_to<bool>;
};

/// The arrow that stands for g, over any scalar.
template <class Phi, class A> auto representative_of(const Phi& phi, const A& g) {
  if constexpr (requires { phi.representative(g); }) {
    return phi.representative(g);
  } else {
    return phi.lift(phi.over(phi.to.source(g)), g);
  }
}
/// The object that stands for m.
template <class Phi, class Q> auto object_over(const Phi& phi, const Q& m) {
  if constexpr (requires { phi.over(m); }) {
    return phi.over(m);
  } else {
    return phi.from.source(phi.representative(phi.to.unit(m)));
  }
}

/// The system on G of which `reduced`, on G', is the reduction by Phi: L = L' o Phi, phi = phi' o Phi, so that Phi is a
/// morphism of systems ([G] Def. 4.2, Example 4.3). Arrow constraints only.
template <class Phi, class Reduced>
struct PulledBack : System<PulledBack<Phi, Reduced>, typename Phi::Domain, Reduced::arrow_constraints> {
  static_assert(Reduced::object_constraints == 0 && Variational<Reduced>);
  using MembersVary = void;
  [[no_unique_address]] Phi morphism;
  Reduced reduced;

  explicit PulledBack(const Reduced& r = {}, const Phi& phi = {}) : morphism(phi), reduced(r) {
    this->groupoid = phi.from;
  }
  template <class A> auto lagrangian(const A& g) const { return reduced.lagrangian(morphism(g)); }
  template <class A> auto constraint(const A& g) const requires(Reduced::arrow_constraints > 0) {
    return reduced.constraint(morphism(g));
  }
  bool admissible(const ArrowOf<typename Phi::Domain>& g) const requires HasBranch<Reduced> {
    return reduced.admissible(morphism(g));
  }
};

}  // namespace lagroid
