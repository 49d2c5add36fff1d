// A groupoid and a constrained system of your own, in one file; docs/tutorial.md goes through it.
//
// Dido's problem: the shortest shore that encloses a given area. Run it: build/release/bin/my_system [FOLDER]
#include <lagroid/run/ledger/check_of.hpp>
#include <lagroid/run/run.hpp>

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <iostream>
#include <memory>
#include <numbers>
#include <vector>

using namespace lagroid;

// A stretch of shore g = (p, q, a): where it starts, where it ends, and the area between it and its chord, positive to
// the left. Two stretches make one, and the triangle of their ends is added: (p, q, a)(q, r, b) = (p, r, a + b + pqr).
struct Shores : LieGroupoid<Shores, 3> {
  template <class S> using Arrow = Vector<S, 5>;
  template <class S> using Object = Vector<S, 2>;
  template <class S> static Vector<S, 2> source(const Vector<S, 5>& g) { return {g(0), g(1)}; }
  template <class S> static Vector<S, 2> target(const Vector<S, 5>& g) { return {g(2), g(3)}; }
  template <class S> static Vector<S, 5> unit(const Vector<S, 2>& q) { return {q(0), q(1), q(0), q(1), S(0)}; }
  template <class S> static Vector<S, 5> inverse(const Vector<S, 5>& g) { return {g(2), g(3), g(0), g(1), -g(4)}; }
  template <class S> static Vector<S, 5> multiply(const Vector<S, 5>& g, const Vector<S, 5>& h) {
    const Vector<S, 2> u = chord(g);
    const Vector<S, 2> v = chord(h);
    return {g(0), g(1), h(2), h(3), g(4) + h(4) + (u(0) * v(1) - u(1) * v(0)) * 0.5};
  }
  template <class S> static Vector<S, 5> tau(const Vector<S, 2>& q, const Vector<S, 3>& v) {
    return {q(0), q(1), q(0) + v(0), q(1) + v(1), v(2)};
  }
  template <class S> static Vector<S, 3> tau_inverse(const Vector<S, 5>& g) { return {g(2) - g(0), g(3) - g(1), g(4)}; }
  static std::string name() { return "stretches of shore"; }

  template <class S> static Vector<S, 2> chord(const Vector<S, 5>& g) { return target(g) - source(g); }
};

// L = |q - p|^2 / 2h on the straight stretches, a = 0.
struct Dido : System<Dido, Shores, /*arrow constraints*/ 1> {
  double h = 0.05;
  template <class S> S lagrangian(const Arrow<S>& g) const { return Shores::chord(g).squaredNorm() * (0.5 / h); }
  template <class S> Vector<S, 1> constraint(const Arrow<S>& g) const { return Vector<S, 1>(g(4)); }

  // What leaves L and the constraint alone: enclosing more, and moving the whole shore east, north or round the origin.
  std::vector<Symmetry<Dido>> symmetries() const {
    using Point = Vector<double, 2>;
    using Fibre = Vector<double, 3>;
    return {{"area", [](const Point&) { return Fibre(0, 0, 1); }},
            {"east", [](const Point& q) { return Fibre(1, 0, q(1)); }},
            {"north", [](const Point& q) { return Fibre(0, 1, -q(0)); }},
            {"round", [](const Point& q) { return Fibre(-q(1), q(0), -0.5 * q.squaredNorm()); }}};
  }
};

int main(int argc, char** argv) {
  const laws::LawReport axioms = laws::groupoid_laws<Shores>();
  std::cout << axioms;

  const Dido system;
  std::vector<Step<Dido>> samples;
  for (int k = 0; k < 20; ++k)
    samples.push_back(laws::step_from(system, {{0.1 * k, 1 - 0.2 * k}, {std::cos(k), std::sin(k), 0.3 * k - 2}}));
  const Symmetry<Dido> naive("east without area", [](const auto&) { return Vector<double, 3>(1, 0, 0); });
  for (const auto& candidate : {system.symmetries()[1], naive})
    fmt::print("{}: {}\n", candidate.name, to_string(examine<Dido>(system, candidate, samples).kind));

  const std::function<State<Shores>()> draw = [] {
    const double speed = 1.5 + laws::draw_uniform();
    return State<Shores>{laws::draw_vector<2>(1.0), {speed, laws::draw_uniform(), 2 * laws::draw_uniform()}};
  };
  const laws::LawReport momenta = laws::momentum_laws(system, draw);
  std::cout << momenta;

  FixedStepIntegrator<Dido> integrator(system, {{0, 0}, {1, 0, 1}}, Shores::unit(Vector<double, 2>(0, 0)),
                                       std::make_unique<NewtonStep<Dido>>());
  while (integrator.point().time < 2 * std::numbers::pi) {
    const StepReport report = integrator.advance();
    if (!report.converged()) {
      fmt::print("step {}: {}\n", integrator.point().index + 1, to_string(report.status));
      return 1;
    }
  }
  const Vector<double, 5> shore = integrator.point().configuration;
  fmt::print("once round: at ({:.2f}, {:.2f}), area {:.2f}\n", shore(2), shore(3), shore(4));

  const Certificate certificate = check(system, draw, {.name = "Dido"});
  for (const auto& report : certificate.suites)
    fmt::print("{}: {}\n", report.subject, report.holds() ? "holds" : "BROKEN");
  bool all_hold = certificate.holds();

  const RunResult once_round =
      run(system, {{0, 0}, {1, 0, 1}}, {.steps = 126, .name = "Dido", .folder = argc > 1 ? argv[1] : ""});
  std::cout << text_report(once_round);
  for (const LedgerEntry& entry : once_round.ledger.entries) all_hold = all_hold && !entry.broken();
  return all_hold && once_round.converged() ? 0 : 1;
}
