#pragma once
/// Noether symmetries of a discrete constrained Lagrangian system: sections X of AG, with functions f on Q, for which
/// <mu, X(q)> + f(q) is a constant of the motion.
///
/// Where a system names no quantities of its own, the ledger watches the constants of its declared symmetries,
/// conserved up to round-off; `examine` tests by samples whether a candidate is a symmetry.
///
///     const Symmetry<Sys> shift("momentum", [](const auto&) { return Vector<double, 2>(1, 0); });
///     const SymmetryVerdict verdict = examine<Sys>(system, shift, samples);
///     const bool kept = verdict.kind == SymmetryKind::symmetric;
///
/// Requires samples on Sigma_L, steps that satisfy the constraints: many and generic, because a candidate that passes
/// at all of them is accepted. Returns the kind and the worst defect, relative to the size of the terms; infinite where
/// a term is not a number. Nothing throws.
///
/// Source: [G] 4.2, Def. 4.8, Theorem 4.9.

#include <lagroid/core/derivatives/two_sided.hpp>
#include <lagroid/core/member_name.hpp>
#include <lagroid/core/quantity.hpp>

#include <algorithm>
#include <cmath>
#include <concepts>
#include <functional>
#include <limits>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lagroid {

/// A candidate: a section X of AG and a function f on Q. It is a Noether symmetry ([G] Def. 4.8) when, on Sigma_L,
///
///     <F-(g, lambda), X(alpha(g))> + f(alpha(g)) = <F+(g, lambda), X(beta(g))> + f(beta(g)).
///
/// With f = 0 the system is invariant under X, else quasi-invariant; either way <mu, X(q)> + f(q) is a constant of the
/// motion (Theorem 4.9).
template <class Sys> struct Symmetry {
  using G = typename Sys::GroupoidType;
  using Section = std::function<AlgebroidVector<G>(const ObjectOf<G>&)>;
  using Function = std::function<double(const ObjectOf<G>&)>;

  Symmetry(std::string name_, Section section_, Function boundary_term_ = nullptr)
      : name(std::move(name_)), section(std::move(section_)), boundary_term(std::move(boundary_term_)) {}

  std::string name;
  Section section;         ///< X(q), in the basis of A_qG
  Function boundary_term;  ///< f; zero where null

  double f(const ObjectOf<G>& q) const { return boundary_term ? boundary_term(q) : 0.0; }
  /// <mu, X(q)> + f(q).
  double momentum(const State<G>& z) const { return z.momentum.dot(section(z.object)) + f(z.object); }
  /// |mu| |X(q)| + |f(q)|, to which the round-off of the momentum is relative: components of mu are rounded together.
  double size(const State<G>& z) const { return z.momentum.norm() * section(z.object).norm() + std::abs(f(z.object)); }
  /// The constant of the motion, for the ledger; `size_of_terms` where its round-off is relative to more than size().
  Quantity<Sys> quantity(typename Quantity<Sys>::Size size_of_terms = nullptr) const {
    if (!size_of_terms) size_of_terms = [s = *this](const TrajectoryPoint<Sys>& p) { return s.size(p.state); };
    return {name,
            {name},
            Promise::conserved,
            false,
            [s = *this](const TrajectoryPoint<Sys>& p, double* out) { *out = s.momentum(p.state); },
            std::move(size_of_terms)};
  }
};

/// A system that declares what a ledger is to watch, `std::vector<Quantity<Sys>> quantities() const`.
template <class Sys>
concept HasQuantities = requires(const Sys& system) {
  { system.quantities() } -> std::convertible_to<std::vector<Quantity<Sys>>>;
};
/// A system that declares its symmetries, `std::vector<Symmetry<Sys>> symmetries() const`.
template <class Sys>
concept HasSymmetries = requires(const Sys& system) {
  { system.symmetries() } -> std::convertible_to<std::vector<Symmetry<Sys>>>;
};
namespace detail {
LAGROID_MEMBER_NAME(NamesQuantities, quantities);
LAGROID_MEMBER_NAME(NamesSymmetries, symmetries);
}  // namespace detail
/// Whether members of these names, where there are any, have these forms.
template <class Sys> inline constexpr bool quantities_fit = HasQuantities<Sys> || !detail::NamesQuantities<Sys>;
template <class Sys> inline constexpr bool symmetries_fit = HasSymmetries<Sys> || !detail::NamesSymmetries<Sys>;

/// What a ledger watches of a system: its own quantities or, of one that declares symmetries alone, their constants of
/// the motion.
template <DiscreteSystem Sys> std::vector<Quantity<Sys>> quantities_of(const Sys& system) {
  static_assert(quantities_fit<Sys>,
                "quantities() is there but does not fit: a const function that returns std::vector<Quantity<Sys>> of "
                "the system itself");
  if constexpr (HasQuantities<Sys>) {
    return system.quantities();
  } else {
    // A system that derives from another and has quantities of its own may leave that one's symmetries alone.
    static_assert(symmetries_fit<Sys>,
                  "symmetries() is there but does not fit: a const function that returns std::vector<Symmetry<Sys>> of "
                  "the system itself");
    std::vector<Quantity<Sys>> out;
    if constexpr (HasSymmetries<Sys>)
      for (const auto& symmetry : system.symmetries()) out.push_back(symmetry.quantity());
    return out;
  }
}

/// The difference of the two sides of Def. 4.8 at a point of Sigma_L, relative to the size of their terms; not a number
/// where these are not.
template <DiscreteSystem Sys>
double noether_defect(const Sys& system, const Step<Sys>& step, const Symmetry<Sys>& symmetry) {
  const auto minus = legendre_minus(system, step);
  const auto plus = legendre_plus(system, step);
  const double size = symmetry.size(minus) + symmetry.size(plus);
  const double difference = std::abs(symmetry.momentum(plus) - symmetry.momentum(minus));
  return difference == 0 ? 0 : difference / size;
}

enum class SymmetryKind { symmetric, quasi_symmetric, none };

constexpr std::string_view to_string(SymmetryKind kind) {
  switch (kind) {
    case SymmetryKind::symmetric:
      return "symmetric";
    case SymmetryKind::quasi_symmetric:
      return "quasi-symmetric";
    case SymmetryKind::none:
      return "not a symmetry";
  }
  return "unknown";
}

/// What a candidate turned out to be, and the worst defect over the samples. For one that is quasi-symmetric
/// `boundary_defect` is the worst defect without f.
struct SymmetryVerdict {
  SymmetryKind kind = SymmetryKind::none;
  double defect = std::numeric_limits<double>::infinity();
  double boundary_defect = 0;
};

/// Compares the two sides of Def. 4.8 at `samples`, which must satisfy the constraints. `none` where there are no
/// samples, or a defect exceeds `tolerance`.
template <DiscreteSystem Sys>
SymmetryVerdict examine(const Sys& system, const Symmetry<Sys>& symmetry, std::span<const Step<Sys>> samples,
                        double tolerance = 1e-10) {
  if (samples.empty()) return {};
  const auto worst_defect = [&](const Symmetry<Sys>& candidate) {
    double largest = 0;
    for (const auto& step : samples) {
      const double defect = noether_defect(system, step, candidate);
      largest = std::isnan(defect) ? std::numeric_limits<double>::infinity() : std::max(largest, defect);
    }
    return largest;
  };
  SymmetryVerdict verdict;
  verdict.defect = worst_defect(symmetry);
  Symmetry<Sys> without = symmetry;
  without.boundary_term = nullptr;
  verdict.boundary_defect = worst_defect(without);
  if (verdict.boundary_defect <= tolerance && verdict.defect <= tolerance) {
    verdict.kind = SymmetryKind::symmetric;
  } else if (verdict.defect <= tolerance) {
    verdict.kind = SymmetryKind::quasi_symmetric;
  }
  return verdict;
}

}  // namespace lagroid
