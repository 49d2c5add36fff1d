// A groupoid and a constrained system of your own, in one file.
//
// The Heisenberg group, and its sub-Riemannian geodesics: the shortest horizontal curves, whose shadows on the plane
// are circles (Dido's problem). Run it: build/release/bin/my_system
#include <lagroid/core/testing/groupoid_laws.hpp>
#include <lagroid/solvers/testing/momentum_laws.hpp>

#include <fmt/format.h>

#include <iostream>

using namespace lagroid;

// R^3 with (a, b, c)(a', b', c') = (a + a', b + b', c + c' + (a b' - b a')/2). In these coordinates exp is the
// identity.
struct Heisenberg : LieGroupoid<Heisenberg, 3> {
  template <class S> using Arrow = Vector<S, 3>;
  template <class S> using Object = Vector<S, 0>;
  template <class S> static Vector<S, 0> source(const Vector<S, 3>&) { return {}; }
  template <class S> static Vector<S, 0> target(const Vector<S, 3>&) { return {}; }
  template <class S> static Vector<S, 3> unit(const Vector<S, 0>&) { return Vector<S, 3>(S(0), S(0), S(0)); }
  template <class S> static Vector<S, 3> inverse(const Vector<S, 3>& g) { return -g; }
  template <class S> static Vector<S, 3> multiply(const Vector<S, 3>& g, const Vector<S, 3>& h) {
    return g + h + Vector<S, 3>(S(0), S(0), (g(0) * h(1) - g(1) * h(0)) * S(0.5));
  }
  template <class S> static Vector<S, 3> tau(const Vector<S, 0>&, const Vector<S, 3>& v) { return v; }
  template <class S> static Vector<S, 3> tau_inverse(const Vector<S, 3>& g) { return g; }
  static std::string name() { return "Heisenberg group"; }
};

// L = (a^2 + b^2) / (2 h) on the horizontal arrows, c = 0.
struct Dido : System<Dido, Heisenberg, /*arrow constraints*/ 1> {
  double h = 0.05;
  template <class S> S lagrangian(const Arrow<S>& g) const { return (g(0) * g(0) + g(1) * g(1)) * (0.5 / h); }
  template <class S> Vector<S, 1> constraint(const Arrow<S>& g) const { return Vector<S, 1>(g(2)); }

  // The momentum seen from the start, Ad*: conserved, because L and the constraint depend on the arrow alone.
  std::vector<Quantity<Dido>> quantities() const {
    return {{"spatial momentum",
             {"P1", "P2", "P3"},
             Promise::conserved,
             false,
             [](const TrajectoryPoint<Dido>& p, double* out) {
               const auto& [g, mu] = std::pair(p.configuration, p.state.momentum);
               out[0] = mu(0) + g(1) * mu(2);
               out[1] = mu(1) - g(0) * mu(2);
               out[2] = mu(2);
             }}};
  }
};

int main() {
  const auto axioms = laws::groupoid_laws<Heisenberg>();
  const auto momenta = laws::momentum_laws(Dido{}, [] {
    State<Heisenberg> s;
    s.momentum = laws::draw_vector<3>(2.0);
    return s;
  });
  std::cout << axioms << momenta;

  // One turn: with momentum (1, 0, 1) the shadow is a circle of radius about one.
  const Dido system;
  State<Heisenberg> start;
  start.momentum << 1, 0, 1;
  Integrator<Dido> walk(system, start, Heisenberg::unit(start.object), std::make_unique<NewtonStep<Dido>>());
  while (walk.point().time < 6.283) {
    const auto report = walk.advance();
    if (!report.converged()) {
      fmt::print("step {}: {}\n", walk.point().index + 1, to_string(report.status));
      return 1;
    }
  }
  fmt::print("after one turn at ({:.3f}, {:.3f}), area enclosed {:.3f} (pi is 3.142)\n", walk.point().configuration(0),
             walk.point().configuration(1), walk.point().configuration(2));
  return axioms.holds() && momenta.holds() ? 0 : 1;
}
