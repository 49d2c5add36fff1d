// Systems whose optional members do not fit, and headers that were forgotten: none of these may compile.
// tests/CMakeLists.txt compiles the file once for each case, and reads what the compiler says.
#if defined(NO_MARCH_METHODS) || defined(NO_STEP_METHODS) || defined(NO_BOUNDARY_METHODS)
#include <lagroid/solvers/boundary_values.hpp>
#include <lagroid/solvers/march.hpp>
#elif defined(PATH) || defined(FITS)
#include <lagroid/solvers/boundary_newton.hpp>
#include <lagroid/solvers/boundary_values.hpp>
#endif
#include <lagroid/core/noether.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/solvers/integrator.hpp>
#include <lagroid/solvers/newton_step.hpp>

using namespace lagroid;

namespace {

#if defined(CONSTRAINT_WITHOUT_STEP)
constexpr int told = 1;
#else
constexpr int told = 0;
#endif

struct Particle : System<Particle, Pair<1>, told> {
  using G = Pair<1>;
  using Arrow1 = PairArrow<double, 1>;
  using Point = Vector<double, 1>;
#if !defined(STEP_WITHOUT_H)
  double h = 0.1;
  template <class S> S lagrangian(const PairArrow<S, 1>& g) const { return (g.target - g.source).squaredNorm() / h; }
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
  Arrow1 loop(const Point& q, const Point&, const Point&) const { return {q, q}; }
  std::vector<Arrow1> path(const Arrow1& boundary, long steps) const {
    return std::vector<Arrow1>(std::size_t(steps), boundary);
  }
  MethodTraits traits() const { return {"steps", 2, true, true, false}; }
#elif defined(RATES)
  Point rates(const State<G>& z) const { return z.momentum; }
#elif defined(RATES_NOT_CONST)
  Rates<G> rates(const State<G>& z) { return {z.momentum, Point(0)}; }
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
#elif defined(QUANTITIES)
  std::vector<double> quantities() const { return {}; }
#elif defined(LOOP_WITHOUT_LOOPS)
  Arrow1 loop(const Point& q, const Point&, const Point&) const { return {q, q}; }
#elif defined(LOOPS_WITHOUT_LOOP)
  static constexpr int loops = 1;
#elif defined(PATH)
  std::vector<Arrow1> path(const Arrow1& boundary) const { return {boundary}; }
#elif defined(TRAITS)
  int traits() const { return 2; }
#endif
};

}  // namespace

int main() {
  const Particle system;
  const State<Pair<1>> start{Vector<double, 1>(0), Vector<double, 1>(1)};
  const auto unit = system.groupoid.unit(start.object);
#if defined(NO_MARCH_METHODS)
  make_march(system, start, unit, {});
#elif defined(NO_STEP_METHODS)
  make_step_solver(system, StepMethod::newton);
#elif defined(NO_BOUNDARY_METHODS)
  make_boundary_solver<Particle>();
#else
  quantities_of(system);
  Integrator<Particle> integrator(system, start, unit, std::make_unique<NewtonStep<Particle>>());
  integrator.traits();
#if defined(PATH) || defined(FITS)
  solve_boundary(BoundaryNewton<Particle>(), BoundaryProblem<Particle>{system, unit}, 2);
#endif
#endif
}
