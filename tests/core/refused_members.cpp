// Systems whose optional members do not fit, and headers that were forgotten: none of these may compile.
// tests/CMakeLists.txt compiles the file once for each case, and reads what the compiler says.
#if defined(NO_MARCH_METHODS) || defined(NO_STEP_METHODS) || defined(NO_BOUNDARY_METHODS)
#include <lagroid/solvers/boundary/boundary_values.hpp>
#include <lagroid/solvers/integrators/integrator.hpp>
#elif defined(PATH) || defined(PATH_OF_OTHERS) || defined(FITS)
#include <lagroid/solvers/boundary/boundary_values.hpp>
#endif
#include <lagroid/core/capabilities/reductions.hpp>
#include <lagroid/core/noether.hpp>
#include <lagroid/core/parameter.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/step/newton_step.hpp>

using namespace lagroid;

namespace {

#if defined(CONSTRAINT_WITHOUT_STEP)
constexpr int told = 1;
#else
constexpr int told = 0;
#endif

#if defined(NUDGE)
struct Line : Pair<1> {
  template <class A, class W> W nudge(A&, const W& w) const { return w; }
};
#else
using Line = Pair<1>;
#endif

struct Particle : System<Particle, Line, told> {
  using G = Line;
  using Arrow1 = PairArrow<double, 1>;
  using Point = Vector<double, 1>;
#if !defined(STEP_WITHOUT_H)
  double h = 0.1;
#if defined(FOR_DOUBLES_ALONE)
  double lagrangian(const Arrow1& g) const { return (g.target - g.source).squaredNorm() / h; }
#else
  template <class S> S lagrangian(const PairArrow<S, 1>& g) const { return (g.target - g.source).squaredNorm() / h; }
#endif
#else
  template <class S> S lagrangian(const PairArrow<S, 1>& g) const { return (g.target - g.source).squaredNorm(); }
#endif

#if defined(FITS)
  static constexpr int parts = 1;
  static constexpr int loops = 1;
  double time = 0;
  Rates<G> rates(const State<G>& z) const { return {z.momentum, Point(0)}; }
  template <int I, class S> FlowOf<G, S> flow(double t, const Vector<S, 1>& q, const Vector<S, 1>& p) const {
    return {{q, Vector<S, 1>(q + p * t)}, Vector<S, 1>(p * 0.0)};
  }
  double time_scale_rate(const State<G>&) const { return 0; }
  template <class S, class T> S lagrangian(const PairArrow<S, 1>& g, const T& step) const {
    return (g.target - g.source).squaredNorm() / step;
  }
  std::vector<Symmetry<Particle>> symmetries() const { return {}; }
  std::vector<Quantity<Particle>> quantities() const { return {}; }
  static auto parameters() { return std::tuple(parameter("h", &Particle::h, "s", "the step")); }
  std::optional<Refusal> refused() const { return {}; }
  Arrow1 loop(const Point& q, const Point&, const Point&) const { return {q, q}; }
  std::vector<Arrow1> path(const Arrow1& boundary, long steps) const {
    return std::vector<Arrow1>(std::size_t(steps), boundary);
  }
  MethodTraits traits() const { return {"steps", 2, true, true, false}; }
#elif defined(VARIES)
  using MembersVary = void;
  template <class Z> Rates<G> rates(const Z& z) const requires(sizeof(Z) > 1000) { return {z.momentum, Point(0)}; }
#elif defined(RATES)
  Point rates(const State<G>& z) const { return z.momentum; }
#elif defined(RATES_NOT_CONST)
  Rates<G> rates(const State<G>& z) { return {z.momentum, Point(0)}; }
#elif defined(RATES_OF_OTHERS)
  template <class T> Rates<G> rates(const T& q, const T& p) const { return {p, q * 0.0}; }
#elif defined(FLOW_OF_OTHERS)
  template <int I, class S> FlowOf<G, S> flow(const Vector<S, 1>& q, const Vector<S, 1>& p) const {
    return {{q, q}, Vector<S, 1>(p * 0.0)};
  }
#elif defined(FORCES_OF_OTHERS)
  template <class S> Forces<S, 1> forces(const Vector<S, 1>& q, double t) const { return {q * t, q * t}; }
#elif defined(FORCES_FOR_DOUBLES_ALONE)
  Forces<double, 1> forces(const Arrow1& g) const { return {g.source, g.target}; }
#elif defined(GUESS_OF_OTHERS)
  template <class Q> Step<Particle> first_guess(const Q& q, const Q& p) const {
    return {{q, Q(q + h * p)}, {}};
  }
#elif defined(FLOW)
  static constexpr int parts = 2;
  template <int I, class S> Vector<S, 1> flow(double t, const Vector<S, 1>&, const Vector<S, 1>& p) const {
    return p * t;
  }
#elif defined(FLOW_WITHOUT_PARTS)
  template <int I, class S> FlowOf<G, S> flow(double t, const Vector<S, 1>& q, const Vector<S, 1>& p) const {
    return {{q, Vector<S, 1>(q + p * t)}, Vector<S, 1>(p * 0.0)};
  }
#elif defined(ATTRACTIVE)
  static constexpr bool attractive = true;
#elif defined(TIME_SCALE)
  double time_scale_rate(const Point& q) const { return q(0); }
#elif defined(STEP_NOT_CONST)
  template <class S, class T> S lagrangian(const PairArrow<S, 1>& g, const T& step) {
    return (g.target - g.source).squaredNorm() / step;
  }
#elif defined(STEP_FOR_DOUBLES_ALONE)
  template <class S> S lagrangian(const PairArrow<S, 1>& g, double step) const {
    return (g.target - g.source).squaredNorm() / step;
  }
#elif defined(STEP_WITHOUT_H)
  template <class S, class T> S lagrangian(const PairArrow<S, 1>& g, const T& step) const {
    return (g.target - g.source).squaredNorm() / step;
  }
#elif defined(CONSTRAINT_WITHOUT_STEP)
  template <class S> Vector<S, 1> constraint(const PairArrow<S, 1>& g) const { return g.target; }
  template <class S, class T> S lagrangian(const PairArrow<S, 1>& g, const T& step) const {
    return (g.target - g.source).squaredNorm() / step;
  }
#elif defined(START_WITHOUT_TIME)
  template <class S, class T> S lagrangian(const PairArrow<S, 1>& g, const T& start, const T& step) const {
    return (g.target - g.source).squaredNorm() / step + start;
  }
#elif defined(SYMMETRIES)
  std::vector<Symmetry<Particle>> symmetries() { return {}; }
#elif defined(SYMMETRIES_PRIVATE)

 private:
  std::vector<Symmetry<Particle>> symmetries() const { return {}; }
#elif defined(PARAMETERS)
  static std::vector<int> parameters() { return {}; }
#elif defined(PARAMETERS_NOT_STATIC)
  auto parameters() const { return std::tuple(parameter("h", &Particle::h, "s", "the step")); }
#elif defined(REDUCTIONS)
  static std::vector<int> reductions() { return {}; }
#elif defined(REDUCTIONS_NOT_STATIC)
  auto reductions() const { return std::tuple(reduction("none", 0, "a number is no morphism")); }
#elif defined(REFUSED)
  std::string refused() const { return {}; }
#elif defined(QUANTITIES)
  std::vector<double> quantities() const { return {}; }
#elif defined(LOOP_WITHOUT_LOOPS)
  Arrow1 loop(const Point& q, const Point&, const Point&) const { return {q, q}; }
#elif defined(LOOPS_WITHOUT_LOOP)
  static constexpr int loops = 1;
#elif defined(PATH)
  std::vector<Arrow1> path(const Arrow1& boundary) const { return {boundary}; }
#elif defined(PATH_OF_OTHERS)
  template <class T> std::vector<T> path(const T& from, const T& to) const { return {from, to}; }
#elif defined(TRAITS)
  int traits() const { return 2; }
#endif
};

#if defined(NO_BOUNDARY_METHODS)
/// Of sizes for which the library has compiled nothing.
struct Wide : System<Wide, Pair<4>> {
  template <class S> S lagrangian(const PairArrow<S, 4>& g) const { return (g.target - g.source).squaredNorm(); }
};
#endif

}  // namespace

int main() {
  const Particle system;
  const State<Particle::G> start{Vector<double, 1>(0), Vector<double, 1>(1)};
  const auto unit = system.groupoid.unit(start.object);
#if defined(NO_MARCH_METHODS)
  make_integrator(system, start, unit, {});
#elif defined(NO_STEP_METHODS)
  make_step_solver(system, StepMethod::newton);
#elif defined(NO_BOUNDARY_METHODS)
  make_boundary_solver<Wide>();
#else
  quantities_of(system);
  for_each_parameter<Particle>([](const auto&) {});
  for_each_reduction<Particle>([](const auto&) {});
  refusal_of(system);
  FixedStepIntegrator<Particle> integrator(system, start, unit, std::make_unique<NewtonStep<Particle>>());
  integrator.traits();
#if defined(PATH) || defined(PATH_OF_OTHERS) || defined(FITS)
  make_boundary_solver<Particle>();
#endif
#endif
}
