// A discrete Lagrangian of one's own as a Python class: a bead on a wire bent to a parabola, y = a x^2 / 2, under
// gravity. See docs/python.md.

#include <lagroid/groupoids/pair.hpp>
#include <lagroid/python/system.hpp>
#include <lagroid/solvers/integrators/integrator_methods.hpp>

using namespace lagroid;

// L(x0, x1) = m ((x1 - x0)^2 + (y1 - y0)^2) / 2h - h m g (y0 + y1) / 2. Momentum m (1 + a^2 x^2) x'.
struct Bead : System<Bead, Pair<1>> {
  double h = 0.01;
  double mass = 1;
  double bend = 1;
  double gravity = 1;

  static auto parameters() {
    return std::tuple(parameter("mass", &Bead::mass, "kg", "of the bead", positive),
                      parameter("bend", &Bead::bend, "1/m", "of the wire at its lowest point"),
                      parameter("gravity", &Bead::gravity, "m/s^2", "acceleration"));
  }

  template <class S, class T> S lagrangian(const PairArrow<S, 1>& g, const T& step) const {
    const S dx = g.target(0) - g.source(0);
    const S y0 = g.source(0) * g.source(0) * (0.5 * bend);
    const S y1 = g.target(0) * g.target(0) * (0.5 * bend);
    return (dx * dx + (y1 - y0) * (y1 - y0)) * (0.5 * mass / step) - (y0 + y1) * (0.5 * mass * gravity * step);
  }
  template <class S> S lagrangian(const PairArrow<S, 1>& g) const { return lagrangian(g, h); }

  std::vector<Quantity<Bead>> quantities() const {
    return {{"energy", {"H"}, Promise::bounded, false, [b = *this](const TrajectoryPoint<Bead>& at, double* out) {
               const double x = at.state.object(0);
               const double p = at.state.momentum(0);
               *out = p * p / (2 * b.mass * (1 + b.bend * b.bend * x * x)) + b.mass * b.gravity * b.bend * x * x / 2;
             }}};
  }
};

PYBIND11_MODULE(my_system, module) {
  python::bind_system<Bead>(module, "Bead", "A bead on a parabolic wire: object x (1,), m.");
}
