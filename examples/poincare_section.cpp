// A Poincare section in thirty lines: Henon and Heiles' star (Astronomical Journal 69, 1964, 73), at the energy 1/12,
// where it crosses q1 = 0 upwards. See docs/events.md.
//
//     ./lagroid run examples/poincare_section.cpp --out out/section
#include <lagroid/run/run.hpp>
#include <lagroid/systems/mechanical.hpp>

#include <cmath>
#include <iostream>

namespace {

using namespace lagroid;

struct HenonHeiles : MechanicalSystem<HenonHeiles, 2> {
  static double mass() { return 1; }
  template <class S> S potential(const Vector<S, 2>& q) const {
    return q.squaredNorm() * 0.5 + q(0) * q(0) * q(1) - q(1) * q(1) * q(1) / 3.0;
  }
};

}  // namespace

int main(int argc, char** argv) {
  HenonHeiles star;
  star.h = 0.05;
  const Vector<double, 2> q(0, 0.1);
  const Vector<double, 2> momentum(std::sqrt(2 * (1.0 / 12 - star.potential(q))), 0);
  Event section{"section", "q1"};
  section.direction = Event::Direction::rising;
  section.plot = {"q2", "mu2"};
  const RunResult crossings =
      run(star, {q, momentum},
          {.steps = 40000, .name = "Henon-Heiles", .folder = argc > 1 ? argv[1] : "", .every = 4, .events = {section}});
  std::cout << text_report(crossings);
  return crossings.converged() && crossings.events.watched[0].count > 300 ? 0 : 1;
}
