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
/// kept where gradients depend on each other says levels.hpp. Requires and throws as poisson_integrator.hpp; also
/// std::invalid_argument for a step or a tolerance that is not positive. Status as ExtrapolationIntegrator
/// (solvers/extrapolation/extrapolation_integrator.hpp).
///
/// Source: as there, and levels.hpp.

#include <lagroid/solvers/extrapolation/extrapolation_integrator.hpp>
#include <lagroid/solvers/poisson/levels.hpp>
#include <lagroid/solvers/poisson/poisson_integrator.hpp>
#include <lagroid/solvers/poisson/poisson_methods.hpp>

#include <algorithm>
#include <limits>
#include <memory>
#include <stdexcept>
#include <string>
#include <type_traits>
#include <vector>

namespace lagroid {

/// Its formulas hold over numbers side by side.
template <class Sys>
concept InLanes = requires {
  requires Sys::in_lanes;
};

namespace detail {

/// R^N as a homogeneous space of itself, whose points are taken back to the levels of a motion.
template <class Sys> struct LevelSpace {
  static constexpr int n = Sys::dimension;
  using S = std::conditional_t<InLanes<Sys>, RowBatch, double>;
  using Point = Vector<S, n>;
  using Algebra = Point;
  const Sys* system;
  const Levels<Sys, true>* levels;

  void act(const Algebra& u, Point& z) const {
    for (int i = 0; i < n; ++i) z(i) += u(i);
  }
  /// By 2 h u; where a row begins, by half of that.
  void leap(const S& h, const Algebra& u, Point& z) const {
    for (int i = 0; i < n; ++i) z(i) += u(i) * (h * 2.0);
  }
  void leap(const S& h, const S& halved, const Algebra& u, Point& z) const {
    for (int i = 0; i < n; ++i) z(i) += u(i) * (h * (2.0 - halved));
  }
  void generator(const Algebra& u, const Point&, Point& v) const { v = u; }
  void bracket(const Algebra&, const Algebra&, Algebra& w) const { w = zero_algebra(); }
  void project(Point& z) const {
    Vector<double, n> x;
    for (int i = 0; i < n; ++i) x(i) = RowRegister<S>::get(z(i), 0);
    if (!levels->project(*system, x)) x.setConstant(std::numeric_limits<double>::quiet_NaN());
    for (int i = 0; i < n; ++i) z(i) = S(x(i));
  }
  Point zero_point() const { return Point::Constant(S(0.0)); }
  Algebra zero_algebra() const { return zero_point(); }
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
  Eigen::MatrixXd slope(const std::vector<std::string>&) const override {
    throw std::invalid_argument("steps of extrapolation have no derivative here");
  }
  double poisson_defect() const override { return std::numeric_limits<double>::quiet_NaN(); }
  void serialize(NumberArchive& archive) override {
    motion_.serialize(archive);
    levels_.serialize(archive);
    archive(index_);
  }

 private:
  /// pi dH, over the numbers of rows.
  struct Field {
    const Sys* system;
    template <class Z> void operator()(const auto&, const Z& z, Z& u) const { u = system->velocity(z); }
  };
  using Motion = ExtrapolationIntegrator<LevelSpace<Sys>, Field>;
  Motion begun(const X& start, double time) const {
    LieGroupControl control{.tolerance = options_.tolerance};
    control.stop = options_.stop;
    control.first_step = std::min(control.first_step, options_.step > 0 ? options_.step : 1);
    return Motion(LevelSpace<Sys>{system_.get(), &levels_}, Field{system_.get()}, start, control, time);
  }

  std::unique_ptr<const Sys> system_;
  Levels<Sys, true> levels_;
  PoissonOptions options_;
  Motion motion_;
  typename Motion::Place before_ = motion_.place();
  long index_ = 0;
};

}  // namespace detail

}  // namespace lagroid
