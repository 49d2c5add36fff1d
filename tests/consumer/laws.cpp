// The law suites of the component laws: the user's groupoid and system keep them, a broken groupoid does not.
#include "spring.hpp"

#include <lagroid/core/testing/groupoid_laws.hpp>
#include <lagroid/solvers/testing/momentum_laws.hpp>

#include <functional>
#include <iostream>

using namespace lagroid;

/// Its inverse forgets to exchange the ends.
struct Broken : PolarPairs {
  static std::string name() { return "polar pairs with a broken inverse"; }
  template <class S> static Arrow<S> inverse(const lagroid::Vector<S, 4>& g) { return g; }
};

int main() {
  const std::function<State<PolarPairs>()> draw = [] {
    return State<PolarPairs>{{1 + 0.3 * laws::draw_uniform(), laws::draw_uniform()}, laws::draw_vector<2>(0.5)};
  };
  const laws::LawReport axioms = laws::groupoid_laws<PolarPairs>();
  const laws::LawReport momenta = laws::momentum_laws(Spring{}, draw);
  const laws::LawReport report = laws::groupoid_laws<Broken>();
  const laws::Law& broken = report.law("inverses");
  std::cout << axioms << momenta << report;
  return axioms.holds() && momenta.holds() && broken.worst > broken.tolerance ? 0 : 1;
}
