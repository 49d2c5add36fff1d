// An optimal control problem of one's own: Zermelo's boat crosses a river in the least time, the current stronger the
// farther from the bank, and keeps off a rock. See docs/optimal_control.md.

#include <lagroid/groupoids/pair.hpp>
#include <lagroid/solvers/control/control_search.hpp>
#include <lagroid/solvers/testing/control_laws.hpp>
#include <lagroid/systems/control/controlled_flow.hpp>

#include <fmt/format.h>

#include <cmath>
#include <iostream>

using namespace lagroid;

// The control is the course, an angle: q' = (cos u + current, sin u), in the time it takes.
struct Boat : ControlledFlow<Boat, Pair<2>, /*controls*/ 1, /*inequalities*/ 1> {
  double current = 0.5;
  double rock = 0.2;  // its radius, about (0.5, 0.5)

  template <class S> Vector<S, 2> flow(const Vector<S, 2>& q, const Vector<S, 1>& u) const {
    using std::cos;
    using std::sin;
    return {cos(u(0)) + current * q(1), sin(u(0))};
  }
  template <class S> S running_cost(const Vector<S, 2>&, const Vector<S, 1>&) const { return S(1.0); }
  template <class S> Vector<S, 1> inequality(const PairArrow<S, 2>& g, const Vector<S, 1>&, const S&) const {
    const S x = g.target(0) - 0.5;
    const S y = g.target(1) - 0.5;
    return Vector<S, 1>(rock * rock - x * x - y * y);
  }
};

int main() {
  ControlTask<Boat> task{{}, {{0, 0}, {1, 1}}, 1.5, /*duration_is_free*/ true};
  const auto found = search_control(task, 100);
  if (found.minima.empty()) {
    std::cerr << found.best_failure.report.message << '\n';
    return 1;
  }
  for (const auto& each : found.minima) std::cout << fmt::format("across in {:.6f}\n", each.report.cost);

  TranscriptionOf<Boat> transcription(task, control_guess(task, 100, 1));
  const laws::LawReport laws = laws::transcription_laws(transcription, 1);
  std::cout << laws;
  return laws.holds() ? 0 : 1;
}
