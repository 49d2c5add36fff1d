#pragma once
/// Whether a system descends along a morphism: what is invariant, what is not, and where.
///
///     L(g) = L(g'),  phi(g) = 0 <=> phi(g') = 0,  (A Phi)^{-T} f(g) = (A Phi)^{-T} f(g'),  ...  where Phi(g) = Phi(g')
///
/// A reduced system computes with one arrow g' for each image (ReducedSystem). Were the system not invariant, it would
/// be that of another problem, without a word; so the claim is examined at sampled arrows before it is used.
///
///     const auto reduced = reduce(LeftQuotient<SO3>{}, body, arrows_about(body.groupoid, attitude));
///
/// or, to see what was found, `examine_descent(ReducedSystem(body, phi), arrows).sentence()`.
///
/// Required: arrows that are many and generic, for a system that passes at them is believed. They need not satisfy
/// constraints: of those the zeros alone need to be invariant, and near each sample one is looked for. Errors: none;
/// what is not finite does not descend, nor a constraint near whose samples there is no zero.

#include <lagroid/core/derivatives/annihilator.hpp>
#include <lagroid/core/matrices/decompositions.hpp>
#include <lagroid/core/reduction/reduced_system.hpp>

#include <cmath>
#include <cstddef>
#include <limits>
#include <random>
#include <span>
#include <stdexcept>
#include <string>
#include <vector>

namespace lagroid {

/// What a reduction rests on; a Routhian in closed form is compared with the solved one (examine_routhian.hpp).
enum class Ingredient { morphism, lagrangian, constraint, object_constraint, forces, distribution, routhian };

/// One ingredient: the largest difference between an arrow and the one that stands for its image, relative
/// to the ingredient's largest value at the samples; and the sample where it was met, in coordinates.
struct DescentFinding {
  Ingredient ingredient = Ingredient::lagrangian;
  double defect = 0;
  std::vector<double> sample;
};

struct DescentReport {
  std::vector<DescentFinding> findings;
  double tolerance = 1e-10;

  bool descends() const { return worst() == nullptr; }
  /// The ingredient that misses invariance by most, or null. The morphism before all others, which rest on it.
  const DescentFinding* worst() const;
  /// What does not descend, by how much, and at which arrow; empty where all does.
  std::string sentence() const;
};

/// Thrown by `reduce`. `report` has all findings.
struct DoesNotDescend : std::invalid_argument {
  DescentReport report;
  DoesNotDescend(const std::string& along, DescentReport found)
      : std::invalid_argument(along + ": " + found.sentence()), report(std::move(found)) {}
};

namespace detail {

/// Collects one ingredient over the samples.
class DescentTally {
 public:
  explicit DescentTally(Ingredient ingredient) : finding_{ingredient, 0, {}} {}

  /// A value at a sample and what it should be, as it is at the arrow that stands for its image.
  template <class V, class X> void add(const V& there, const V& here, const X& sample) {
    add(there.data(), here.data(), int(there.size()), {sample.data(), std::size_t(sample.size())});
  }
  DescentFinding finding() {
    finding_.defect = finding_.sample.empty() ? std::numeric_limits<double>::infinity()
                      : largest_ > 0          ? largest_ / size_
                                              : 0;
    if (std::isnan(finding_.defect)) finding_.defect = std::numeric_limits<double>::infinity();
    return finding_;
  }

 private:
  void add(const double* there, const double* here, int count, std::span<const double> sample);

  DescentFinding finding_;
  double largest_ = 0;
  double size_ = 0;
};

/// The orthogonal projection to the span of the columns: the same for every basis of a distribution's annihilator.
template <int N, int K> Matrix<double, N, N> projection_to_span(const Matrix<double, N, K>& columns) {
  const Eigen::MatrixXd basis = orthonormal_span(columns);
  return basis * basis.transpose();
}

/// The arrow of H nearest to `h`, by the displacement of its target, with reduced.constraint = 0: Gauss and Newton. Not
/// a number where there is none near.
template <class Reduced, class A> A on_the_constraint(const Reduced& reduced, A h) {
  using H = typename Reduced::GroupoidType;
  using D = Dual<double>;
  constexpr int n = H::dimension;
  constexpr int m = Reduced::arrow_constraints;
  for (int iteration = 0; iteration < 20; ++iteration) {
    Matrix<double, m, n> slope;
    for (int i = 0; i < n; ++i) {
      const auto w = infinitesimal(Vector<double, n>(Vector<double, n>::Unit(i)));
      slope.col(i) =
          derivative_of(reduced.constraint(reduced.groupoid.extend(reduced.groupoid.template cast<D>(h), w)));
    }
    const Vector<double, m> value = reduced.constraint(h);
    const Vector<double, n> w = least_squares(slope, value);
    h = reduced.groupoid.extend(h, Vector<double, n>(-w));
    if (w.norm() <= 1e-13) return h;
  }
  return reduced.groupoid.extend(h, Vector<double, n>(Vector<double, n>::Constant(std::nan(""))));
}

}  // namespace detail

/// Arrows to examine a system at: `count` generic ones from objects about q, displacements of up to `reach` in each
/// direction; the same every time.
template <class G>
std::vector<ArrowOf<G>> arrows_about(const G& groupoid, const ObjectOf<G>& q, double reach = 0.4, int count = 50) {
  std::mt19937 bits(7);
  std::uniform_real_distribution<double> uniform(-reach, reach);
  const auto displacement = [&] {
    AlgebroidVector<G> v;
    for (auto& x : v) x = uniform(bits);
    return v;
  };
  std::vector<ArrowOf<G>> out;
  for (int i = 0; i < count; ++i) {
    const auto from = groupoid.target(groupoid.tau(q, displacement()));
    out.push_back(groupoid.tau(from, displacement()));
  }
  return out;
}

/// Examines each ingredient at the given arrows of the full system.
template <class Phi, class Sys>
DescentReport examine_descent(const ReducedSystem<Phi, Sys>& reduced,
                              std::span<const ArrowOf<typename Phi::Domain>> arrows, double tolerance = 1e-10) {
  using G = typename Phi::Domain;
  constexpr int n = G::dimension;
  const Phi& phi = reduced.morphism;
  const Sys& system = reduced.full;
  const G& groupoid = system.groupoid;
  const auto& image_groupoid = phi.to;
  const auto image_coordinates = [&](const auto& h) { return image_groupoid.coordinates_of_arrow(h); };
  detail::DescentTally morphism(Ingredient::morphism);
  detail::DescentTally lagrangian(Ingredient::lagrangian);
  detail::DescentTally constraint(Ingredient::constraint);
  detail::DescentTally object_constraint(Ingredient::object_constraint);
  detail::DescentTally forces(Ingredient::forces);
  detail::DescentTally distribution(Ingredient::distribution);
  using Number = Vector<double, 1>;
  for (std::size_t i = 0; i < arrows.size(); ++i) {
    const ArrowOf<G>& g = arrows[i];
    const ArrowOf<G>& other = arrows[(i + 1) % arrows.size()];
    const ArrowOf<G> stands = representative_of(phi, phi(g));
    const auto at = groupoid.coordinates_of_arrow(g);
    const auto next = groupoid.tau(groupoid.target(g), groupoid.tau_inverse(other));
    morphism.add(image_coordinates(phi(groupoid.multiply(g, next))),
                 image_coordinates(image_groupoid.multiply(phi(g), phi(next))), at);
    morphism.add(image_coordinates(phi(stands)), image_coordinates(phi(g)), at);
    morphism.add(groupoid.coordinates_of_arrow(phi.lift(groupoid.source(g), phi(g))), at, at);
    lagrangian.add(Number(system.lagrangian(g)), Number(system.lagrangian(stands)), at);
    if constexpr (Sys::arrow_constraints > 0) {
      // Its size is that of its values at the samples.
      using C = Vector<double, Sys::arrow_constraints>;
      const auto h = detail::on_the_constraint(reduced, ArrowOf<typename Phi::Codomain>(phi(g)));
      const ArrowOf<G> lifted = phi.lift(groupoid.source(g), h);
      // The nearest one may be no image (a radius below zero): such a sample tells nothing.
      const bool no_image = (image_coordinates(phi(lifted)) - image_coordinates(h)).norm() > 1e-8;
      if (!no_image) constraint.add(C(system.constraint(g) + system.constraint(lifted)), C(system.constraint(g)), at);
    }
    const ObjectOf<G> q = groupoid.source(g);
    const ObjectOf<G> over = groupoid.source(stands);
    if constexpr (Sys::object_constraints > 0) {
      using C = Vector<double, Sys::object_constraints>;
      object_constraint.add(C(system.object_constraint(q)), C(system.object_constraint(over)), at);
    }
    if constexpr (Forced<Sys>) {
      const auto below = [&](const ArrowOf<G>& arrow) {
        const Forces<double, n> f = system.forces(arrow);
        Vector<double, 2 * n> both;
        both << phi.reduced_momentum(groupoid.source(arrow), f.source),
            phi.reduced_momentum(groupoid.target(arrow), f.target);
        return both;
      };
      forces.add(below(g), below(stands), at);
    }
    if constexpr (Nonholonomic<Sys>) {
      const auto below = [&](const ObjectOf<G>& object) {
        Matrix<double, n, Sys::arrow_constraints> omega = annihilator(system, object);
        for (int a = 0; a < Sys::arrow_constraints; ++a)
          omega.col(a) = phi.reduced_momentum(object, Vector<double, n>(omega.col(a)));
        return detail::projection_to_span<n, Sys::arrow_constraints>(omega);
      };
      distribution.add(below(q), below(over), at);
    }
  }
  DescentReport report{{morphism.finding(), lagrangian.finding()}, tolerance};
  if constexpr (Sys::arrow_constraints > 0) report.findings.push_back(constraint.finding());
  if constexpr (Sys::object_constraints > 0) report.findings.push_back(object_constraint.finding());
  if constexpr (Forced<Sys>) report.findings.push_back(forces.finding());
  if constexpr (Nonholonomic<Sys>) report.findings.push_back(distribution.finding());
  return report;
}

/// The reduction of `system` by Phi, examined at the given arrows. Throws DoesNotDescend.
template <class Phi, DiscreteSystem Sys>
ReducedSystem<Phi, Sys> reduce(const Phi& phi, const Sys& system, std::span<const ArrowOf<typename Phi::Domain>> arrows,
                               double tolerance = 1e-10) {
  ReducedSystem<Phi, Sys> reduced(system, phi);
  if (auto report = examine_descent(reduced, arrows, tolerance); !report.descends())
    throw DoesNotDescend(Phi::Domain::name() + " -> " + Phi::Codomain::name(), std::move(report));
  return reduced;
}

}  // namespace lagroid
