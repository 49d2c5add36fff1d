#pragma once
/// Reduction downward: the system on H that a system on G, invariant under a morphism Phi : G -> H, becomes there.
///
///     L'(h) = L(g)  for any arrow g with Phi(g) = h            [G] Def. 4.2 and Corollary 4.6, read from L to L'
///
/// Trajectories of L go to trajectories of L', and the momenta are related by A*Phi, so that one computes in fewer
/// variables and has the full motion back from them (reconstruct.hpp).
///
///     const auto reduced = reduce(LeftQuotient<SO3>{}, body, samples);  // throws DoesNotDescend: the worst sample
///     const auto start = reduced.state_below(full_state);               // where an integrator begins, run
///     const auto full = full_point(reduced, run.point());               // reconstruct.hpp
///
/// Required: Phi says which arrow of G stands for h (`representative` or `over`, core/morphism.hpp), and L, the
/// constraints, forces and distributions descend; `examine_descent` (descent.hpp) samples whether they do.

#include <lagroid/core/capabilities/rates.hpp>
#include <lagroid/core/capabilities/routhian.hpp>
#include <lagroid/core/morphism.hpp>
#include <lagroid/core/reduction/full_system.hpp>
#include <lagroid/core/reduction/not_free.hpp>

#include <string>
#include <utility>

namespace lagroid {

/// The reduction of `Sys`, on Phi::Domain, to Phi::Codomain. What Sys has beside its Lagrangian (constraints on arrows
/// and objects, discrete forces, the distribution of a nonholonomic system, a branch, rates, a first guess, a time
/// scale, its energy) goes down with it; that all of it descends is the caller's claim.
template <class Phi, DiscreteSystem Sys>
struct ReducedSystem
    : detail::FullSystem<Sys>,
      System<ReducedSystem<Phi, Sys>, typename Phi::Codomain, Sys::arrow_constraints, Sys::object_constraints> {
  static_assert(std::is_same_v<typename Sys::GroupoidType, typename Phi::Domain>,
                "a morphism reduces systems on the groupoid that it starts from, its Domain");
  static_assert(
      ActionMorphism<Phi>,
      "a system is reduced by a morphism that lifts arrows, lift(q, h), and has its source fibres of the same "
      "dimension: others forget momenta");
  static_assert(RepresentsArrows<Phi>,
                "a system is reduced by a morphism that says which arrow stands for an arrow below: representative(h), "
                "or over(m), an object over m (core/morphism.hpp)");
  using Full = Sys;
  using Morphism = Phi;
  using MembersVary = void;
  using G = typename Phi::Domain;
  using H = typename Phi::Codomain;
  static constexpr int n = H::dimension;
  static constexpr auto principle = Sys::principle;
  template <class A>
  using ScalarOf = typename decltype(std::declval<H>().coordinates_of_arrow(std::declval<A>()))::Scalar;
  /// Whether the functions of Sys take so many of a start and a step.
  template <std::size_t Count>
  static constexpr bool takes_times = Count == 0 || (Count == 1 && StepDependent<Sys>) ||
                                      (Count == 2 && TimeDependent<Sys>);

  [[no_unique_address]] Phi morphism;

  explicit ReducedSystem(Sys system = {}, Phi phi = {})
      : detail::FullSystem<Sys>{std::move(system)}, morphism(std::move(phi)) {
    morphism.from = this->full.groupoid;
    this->groupoid = morphism.to;
  }

  // A representative may know more than an arrow (its image, say); functions that name the type of their arrow get the
  // arrow.
  template <class A, class... Times>
  auto lagrangian(const A& image, const Times&... times) const requires(takes_times<sizeof...(Times)>) {
    const auto g = representative_of(morphism, image);
    if constexpr (requires { this->full.lagrangian(g, times...); }) {
      return this->full.lagrangian(g, times...);
    } else {
      return this->full.lagrangian(ArrowOf<G, ScalarOf<A>>(g), times...);
    }
  }
  template <class A, class... Times>
  auto constraint(const A& image, const Times&... times) const
      requires(Sys::arrow_constraints > 0 && takes_times<sizeof...(Times)>) {
    const auto g = representative_of(morphism, image);
    if constexpr (requires { this->full.constraint(g, times...); }) {
      return this->full.constraint(g, times...);
    } else {
      return this->full.constraint(ArrowOf<G, ScalarOf<A>>(g), times...);
    }
  }
  template <class Q> auto object_constraint(const Q& m) const requires(Sys::object_constraints > 0) {
    return this->full.object_constraint(object_over(morphism, m));
  }
  template <class A> auto forces(const A& image) const requires Forced<Sys> {
    using S = ScalarOf<A>;
    const ArrowOf<G, S> g = representative_of(morphism, image);
    const Forces<S, n> f = this->full.forces(g);
    return Forces<S, n>{morphism.reduced_momentum(this->full.groupoid.source(g), f.source),
                        morphism.reduced_momentum(this->full.groupoid.target(g), f.target)};
  }
  Matrix<double, n, Sys::arrow_constraints> annihilator(const ObjectOf<H>& m) const requires HasAnnihilator<Sys> {
    const ObjectOf<G> q = object_over(morphism, m);
    Matrix<double, n, Sys::arrow_constraints> omega = this->full.annihilator(q);
    for (int a = 0; a < Sys::arrow_constraints; ++a)
      omega.col(a) = morphism.reduced_momentum(q, Vector<double, n>(omega.col(a)));
    return omega;
  }
  bool admissible(const ArrowOf<H>& image) const requires(HasBranch<Sys> || FreeInPart<Phi>) {
    if constexpr (FreeInPart<Phi>)
      if (!morphism.free_at(this->groupoid.target(image))) return false;
    if constexpr (HasBranch<Sys>) return this->full.admissible(ArrowOf<G>(representative_of(morphism, image)));
    return true;
  }
  Step<ReducedSystem> first_guess(const State<H>& s) const requires HasFirstGuess<Sys> {
    const Step<Sys> guess = this->full.first_guess(state_over(s));
    return {morphism(guess.arrow), guess.multipliers};
  }
  Rates<H> rates(const State<H>& s) const requires HasRates<Sys> {
    const State<G> z = state_over(s);
    const Rates<G> above = this->full.rates(z);
    if constexpr (Phi::keeps_basis) {
      return {above.velocity, above.momentum};
    } else {
      // d/dt of the reduced momentum along q' = rho(X), mu' = that of the full motion.
      const auto q = this->full.groupoid.target(this->full.groupoid.tau(
          this->full.groupoid.template cast_object<Dual<double>>(z.object), infinitesimal(above.velocity)));
      return {(morphism.algebroid(z.object) * above.velocity).eval(),
              derivative_of(morphism.reduced_momentum(q, moved_along(z.momentum, above.momentum)))};
    }
  }
  double time_scale_rate(const State<H>& s) const requires requires(const Sys& f, const State<G>& z) {
    f.time_scale_rate(z);
  }
  { return this->full.time_scale_rate(state_over(s)); }
  double energy(const State<H>& s) const requires requires(const Sys& f, const State<G>& z) { f.energy(z); }
  { return this->full.energy(state_over(s)); }
  /// That of the full system (core/capabilities/routhian.hpp).
  template <class Connection, class B, class Momentum>
  auto routhian(const Connection& connection, const B& b, const Momentum& momentum) const requires
      requires(const Sys& f) {
    f.routhian(connection, b, momentum);
  }
  { return this->full.routhian(connection, b, momentum); }
  bool has_routhian() const requires HasRouthianInPart<Sys> { return this->full.has_routhian(); }
  /// All that `admissible` asks of an arrow's target.
  bool free_at(const ObjectOf<H>& m) const requires(FreeInPart<Phi> && !HasBranch<Sys>) { return morphism.free_at(m); }

  /// A state of the full system that is related to s: over the object that stands for s.object.
  State<G> state_over(const State<H>& s) const { return morphism.related(object_over(morphism, s.object), s.momentum); }
  /// The state that is related to one of the full system. Throws NotFree.
  State<H> state_below(const State<G>& z) const {
    const ObjectOf<H> m = morphism.object(z.object);
    require_free(morphism, m);
    return {m, morphism.reduced_momentum(z.object, z.momentum)};
  }
};

}  // namespace lagroid
