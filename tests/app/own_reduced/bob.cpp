// A bob on a spring in the plane, by which a user's own reductions are tried (tests/own_program.sh).
#include <lagroid/app/own_program.hpp>
#include <lagroid/core/capabilities/reductions.hpp>
#include <lagroid/groupoids/connections.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/groupoids/polar.hpp>

using namespace lagroid;

struct Bob : System<Bob, Pair<2>> {
  double h = 0.05;
  double stiffness = 1;  // N/m
  double wind = 0;       // N along x, where rotations are no symmetry

  static auto parameters() {
    return std::tuple(parameter("stiffness", &Bob::stiffness, "N/m", "of the spring", positive),
                      parameter("wind", &Bob::wind, "N", "along x"));
  }

  template <class S, class T> S lagrangian(const Arrow<S>& g, const T& step) const {
    const S twice_kinetic = (g.target - g.source).squaredNorm() / (step * step);
    const S squares = g.source.squaredNorm() + g.target.squaredNorm();
    const S along = g.source(0) + g.target(0);
    return (twice_kinetic - squares * (0.5 * stiffness) + along * wind) * (0.5 * step);
  }
  template <class S> S lagrangian(const Arrow<S>& g) const { return lagrangian(g, h); }

  std::vector<Symmetry<Bob>> symmetries() const {
    return {{"angular momentum", [](const Vector<double, 2>& q) { return Vector<double, 2>(-q(1), q(0)); }}};
  }
  static auto reductions() {
    using ByTheAngle = FactorConnection<Factors<1>, Pair<1>, SO2>;
    return std::tuple(reduction("rotations", PolarQuotient{}, "rotations about the rest"),
                      fixed_momentum("angular-momentum", PolarQuotient{}, ByTheAngle{}, "the distance alone moves"));
  }
};

int main(int argc, char** argv) { return lagroid::program(argc, argv, {module<Bob>("bob")}); }
