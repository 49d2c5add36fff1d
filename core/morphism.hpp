#pragma once
/// Morphisms of Lie groupoids and of discrete constrained Lagrangian systems. [G] 4.1

#include <lagroid/core/system.hpp>

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
/// Deduced are the map of the objects and the morphism of the Lie algebroids.
template <class Derived, class From, class To> struct Morphism {
  using Domain = From;
  using Codomain = To;

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
      const auto e = infinitesimal(Vector<S, From::dimension>(Vector<S, From::dimension>::Unit(i)));
      out.col(i) = derivative_of(to.tau_inverse(self()(from.tau(qd, e))));
    }
    return out;
  }

  /// The state over q that is A*Phi-related to a momentum at Phi_0(q): <mu, v> = <mu', A Phi v>. [G] Def. 4.4
  State<From> related(const ObjectOf<From>& q, const AlgebroidVector<To>& momentum) const {
    return {q, algebroid(q).transpose() * momentum};
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
