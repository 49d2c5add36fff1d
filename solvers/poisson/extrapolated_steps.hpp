#pragma once
/// Explicit steps of order 4 to 16 on Poisson manifolds by a tolerance: Gragg's midpoint rule on R^N, extrapolated, and
/// after each step the nearest point of the energy's and the Casimirs' old values, along their gradients.
///
/// They are no Poisson maps but to the tolerance. Energy and Casimirs are kept to round-off: where these fix the orbit,
/// on leaves of dimension two, errors grow as time does, and not as its square.
///
///     const auto motion = make_poisson_integrator(LotkaVolterra{}, {2, 0.5},
///                                                 {.method = "extrapolation", .step = 10, .tolerance = 1e-10});
///
/// `step` is the distance of the nodes, above zero; between them steps are as long as the tolerance allows. A system
/// with `in_lanes` has formulas over Batch (core/scalars/batch.hpp), in which four rows go on side by side. What is
/// kept where gradients depend on each other says levels.hpp. Derivatives of a step hold the inner steps that the
/// tolerance asked for (held_steps.hpp). Requires and throws as poisson_integrator.hpp; also
/// std::invalid_argument for a step or a tolerance that is not positive. Status as ExtrapolationIntegrator
/// (solvers/extrapolation/extrapolation_integrator.hpp).
///
/// Source: as there, and levels.hpp.

#include <lagroid/solvers/extrapolation/extrapolation_integrator.hpp>
#include <lagroid/solvers/poisson/held_steps.hpp>
#include <lagroid/solvers/poisson/levels.hpp>
#include <lagroid/solvers/poisson/poisson_integrator.hpp>
#include <lagroid/solvers/poisson/poisson_methods.hpp>
#include <lagroid/solvers/poisson/step_slopes.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <utility>
#include <vector>

namespace lagroid {

/// Its formulas hold over numbers side by side.
template <class Sys>
concept InLanes = requires {
  requires Sys::in_lanes;
};

namespace detail {

template <class Sys> using RowSpace = FlatSpace<std::conditional_t<InLanes<Sys>, RowBatch, double>, Sys::dimension>;

/// R^N, the points of which are taken back to the levels of a motion.
template <class Sys> struct LevelSpace : RowSpace<Sys> {
  static constexpr int n = Sys::dimension;
  using typename RowSpace<Sys>::S;
  using typename RowSpace<Sys>::Point;
  const Sys* system;
  const Levels<Sys, true>* levels;

  LevelSpace(const Sys* of, const Levels<Sys, true>* onto) : system(of), levels(onto) {}
  void project(Point& z) const {
    Vector<double, n> x;
    for (int i = 0; i < n; ++i) x(i) = RowRegister<S>::get(z(i), 0);
    if (!levels->project(*system, x)) x.setConstant(std::numeric_limits<double>::quiet_NaN());
    for (int i = 0; i < n; ++i) z(i) = S(x(i));
  }
};

template <class Sys> class ExtrapolatedPoissonSteps final : public PoissonIntegrator {
 public:
  static constexpr int n = Sys::dimension;
  using X = Vector<double, n>;

  /// Throws std::invalid_argument for a step or a tolerance that is not positive.
  ExtrapolatedPoissonSteps(const Sys& system, const X& start, const PoissonOptions& options)
      : system_(std::make_unique<Sys>(system)), levels_(*system_, start), options_(options), motion_(begun(start, 0)) {
    if (!(options.step > 0)) throw std::invalid_argument("steps by a tolerance go forward: their nodes are apart");
  }

  ExtrapolatedPoissonSteps(const ExtrapolatedPoissonSteps&) = delete;  // its steps know its levels by their place
  ExtrapolatedPoissonSteps& operator=(const ExtrapolatedPoissonSteps&) = delete;

  StepReport advance() override {
    motion_.keep(before_);
    const long evaluated = motion_.evaluations();
    StepReport report = motion_.advance_to(double(index_ + 1) * options_.step);
    report.iterations = int(motion_.evaluations() - evaluated);
    if (report.converged()) {
      ++index_;
    } else {
      motion_.go_back_to(before_);
    }
    return report;
  }
  std::vector<double> point() const override { return {motion_.point().data(), motion_.point().data() + n}; }
  void go_on_from(const std::vector<double>& point) override {
    const X x = Eigen::Map<const X>(point.data());
    levels_ = Levels<Sys, true>(*system_, x);
    motion_.keep(before_);
    before_.point = x;
    motion_.go_back_to(before_);
  }
  double time() const override { return double(index_) * options_.step; }
  MethodTraits traits() const override {
    const DeclaredMethod& method = poisson_methods::extrapolation;
    return {std::string(method.name), method.order, false, false, true, 0};
  }
  KeptStructure kept() const override {
    return {.bracket = KeptStructure::to_the_tolerance, .casimirs = 0, .energy = true};
  }
  Eigen::MatrixXd slope(const std::vector<std::string>& parameters) const override {
    const std::vector<typename HeldPoissonSteps<Sys>::Inner> inner = next_inner_steps();
    return slope_by_parameters(
        *system_, parameters, [&](const Sys& system) { return HeldPoissonSteps<Sys>(system, motion_.point(), inner); },
        [](const HeldPoissonSteps<Sys>& held) { return held.end(); },
        [](const HeldPoissonSteps<Sys>& held, const auto& members) { return held.slope(members); }, checked_);
  }
  /// None is measured: it is what the tolerance lets it be.
  double poisson_defect() const override { return std::numeric_limits<double>::quiet_NaN(); }
  void serialize(NumberArchive& archive) override {
    motion_.serialize(archive);
    levels_.serialize(archive);
    archive(index_);
  }

  /// The inner steps of the next step; none where it does not converge. Another motion makes them,
  /// so that a run keeps no record.
  std::vector<typename HeldPoissonSteps<Sys>::Inner> next_inner_steps() const {
    std::vector<typename HeldPoissonSteps<Sys>::Inner> made;
    // k rows evaluate the field k (k + 1) times.
    Motion next = begun(motion_.point(), motion_.time(), [&](double h, int evaluations) {
      made.push_back({h, int(std::sqrt(evaluations))});
    });
    next.go_back_to(motion_.place());
    if (!next.advance_to(double(index_ + 1) * options_.step).converged()) made.clear();
    return made;
  }

 private:
  using Motion = ExtrapolationIntegrator<LevelSpace<Sys>, PoissonField<Sys>>;
  Motion begun(const X& start, double time, decltype(LieGroupControl::accepted) accepted = nullptr) const {
    LieGroupControl control{.tolerance = options_.tolerance};
    control.stop = options_.stop;
    control.accepted = std::move(accepted);
    control.first_step = std::min(control.first_step, options_.step > 0 ? options_.step : 1);
    return Motion(LevelSpace<Sys>(system_.get(), &levels_), PoissonField<Sys>{system_.get()}, start, control, time);
  }

  std::unique_ptr<const Sys> system_;
  Levels<Sys, true> levels_;
  PoissonOptions options_;
  Motion motion_;
  typename Motion::Place before_ = motion_.place();
  long index_ = 0;
  mutable std::vector<std::string> checked_;  ///< parameters whose slopes were compared
};

}  // namespace detail

}  // namespace lagroid
