#pragma once
/// Geometric phases: how much of a motion along the fibres is due to the path of the base alone.
///
///     total = dynamic + geometric,    dynamic = sum_k theta(b_k) - theta_0(b_k)
///
/// theta(b_k) the angle of the motion over the arrow b_k and theta_0(b_k) that of the horizontal arrow over it;
/// geometric is the angle of the product of the horizontal arrows, their holonomy when the path is closed. Two choices
/// of horizontal are common: the arrows of zero momentum (the discrete mechanical connection: what is left of the
/// motion had it no momentum) and those of the connection itself (for a free rigid body it is that of Montgomery's
/// formula, Am. J. Phys. 59 (1991) 394: dynamic 2 E T / |mu|, geometric minus a solid angle).
///
///     PhaseTally phase(level, HorizontalArrows::zero_momentum);
///     while (run.advance().converged()) phase.add(run.point().step.arrow);
///     const Vector<double, 1> geometric = phase.geometric(), dynamic = phase.dynamic();
///
/// Required: arrows that compose, in their order. Nothing is thrown.

#include <lagroid/core/number_archive.hpp>
#include <lagroid/core/reduction/momentum_level.hpp>
#include <lagroid/core/scalars/compensation.hpp>

#include <cmath>
#include <numbers>
#include <optional>

namespace lagroid {

enum class HorizontalArrows { zero_momentum, of_the_connection };

/// Adds up the phases of a run of `Level`, a MomentumLevel. Angles are not wound back: they count revolutions.
template <class Level> class PhaseTally {
 public:
  static constexpr int k = Level::angles;
  using Angles = Vector<double, k>;

  PhaseTally(const Level& level, HorizontalArrows horizontal) : level_(level), horizontal_(horizontal) {}

  void add(const ArrowOf<typename Level::GroupoidType>& b) {
    const Angles moved = level_.angle_of(b, level_.level);
    Angles at_rest = Angles::Zero();
    if (horizontal_ == HorizontalArrows::zero_momentum) at_rest = level_.angle_of(b, Angles::Zero());
    dynamic_rest_.add(dynamic_, moved - at_rest);
    fibre_rest_.add(fibre_, at_rest);
    if constexpr (!Level::ConnectionType::flat) {
      const auto lifted = level_.horizontal(b);
      lifted_ = lifted_ ? level_.full.groupoid.multiply(*lifted_, lifted) : lifted;
      const Angles now = level_.connection.angle(*lifted_);
      for (int i = 0; i < k; ++i) holonomy_(i) += std::remainder(now(i) - holonomy_(i), 2 * std::numbers::pi);
    }
  }

  /// Of a step of that size, where not all have one.
  void add(const ArrowOf<typename Level::GroupoidType>& b, double size) {
    set_time_step(level_, size);
    add(b);
  }

  Angles dynamic() const { return dynamic_; }
  Angles geometric() const { return fibre_ + holonomy_; }
  Angles total() const { return dynamic() + geometric(); }

  /// Visits all that the next arrow is added to.
  void serialize(NumberArchive& archive) {
    archive(dynamic_, dynamic_rest_.lost, fibre_, fibre_rest_.lost, holonomy_);
    bool any = lifted_.has_value();
    archive(any);
    if (!any) {
      lifted_.reset();
      return;
    }
    if (!lifted_) lifted_.emplace();
    archive.arrow(level_.full.groupoid, *lifted_);
  }

 private:
  Level level_;
  HorizontalArrows horizontal_;
  Angles dynamic_ = Angles::Zero();
  Angles fibre_ = Angles::Zero();     ///< of the horizontal arrows, against those of the connection
  Angles holonomy_ = Angles::Zero();  ///< of the connection's
  Compensation<Angles> dynamic_rest_{Angles::Zero()};
  Compensation<Angles> fibre_rest_{Angles::Zero()};
  std::optional<ArrowOf<typename Level::G>> lifted_;
};

/// The product of the horizontal lifts of a path of the base, horizontal(b_1) horizontal(b_2) ..., in any groupoid: for
/// a closed path its holonomy, for a group that is not Abelian as well. Requires at least one arrow.
template <Groupoid G, class Lift, class Path>
auto holonomy(const G& groupoid, const Lift& horizontal, const Path& path) {
  auto b = std::begin(path);
  ArrowOf<G> product = horizontal(*b);
  for (++b; b != std::end(path); ++b) product = groupoid.project(groupoid.compose(product, horizontal(*b)));
  return product;
}

}  // namespace lagroid
