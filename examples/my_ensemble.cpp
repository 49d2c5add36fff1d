// Very many trajectories of a system of your own (docs/ensembles.md): a mass on a stiffening spring, 1000 starts at
// once. Exits 0 if all arrived with their energies.
#include <lagroid/core/quantity.hpp>
#include <lagroid/core/system.hpp>
#include <lagroid/groupoids/pair.hpp>
#include <lagroid/run/events/ensemble_events.hpp>
#include <lagroid/solvers/ensemble/ensemble.hpp>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <vector>

using namespace lagroid;

// L(q0, q1) = (q1 - q0)^2 / 2h - h U at the midpoint, U = q^2/2 + q^4/4.
struct Spring : System<Spring, Pair<1>> {
  double h = 0.05;
  template <class S> S lagrangian(const PairArrow<S, 1>& g) const {
    const S q = (g.source(0) + g.target(0)) * 0.5;
    const S v = g.target(0) - g.source(0);
    return v * v * (0.5 / h) - potential(q) * h;
  }
  template <class S> static S potential(const S& q) { return q * q * 0.5 + q * q * q * q * 0.25; }
};

double energy(const State<Pair<1>>& s) { return 0.5 * s.momentum(0) * s.momentum(0) + Spring::potential(s.object(0)); }

int main() {
  std::vector<State<Pair<1>>> initial;
  for (int i = 0; i < 1000; ++i) initial.push_back({Vector<double, 1>(0.002 * i), Vector<double, 1>(1 - 0.001 * i)});

  std::vector<double> worst(initial.size());
  EnsembleOptions<Spring> options;
  options.threads = 0;  // all of this machine
  options.every = 10;   // look at every tenth step
  options.observe = [&](long member, const TrajectoryPoint<Spring>& point) {
    const double start = energy(initial[std::size_t(member)]);
    double& largest = worst[std::size_t(member)];
    largest = std::max(largest, std::abs(energy(point.state) / start - 1));
  };
  Ensemble<Spring> ensemble(Spring{}, initial);

  // Where each passes the middle on its way up.
  EnsembleEvent<Spring> middle("middle", [](const auto& node) { return node.state.object(0); });
  middle.direction = Event::Direction::rising;
  EnsembleWatch<Spring> watch(Spring{}, {middle}, ensemble.size());
  options.visit = watch.visitor();

  ensemble.advance_to(2000, options);

  double shortest = 1e9, longest = 0;
  const auto passages = watch.happened();
  for (std::size_t i = 1; i < passages.size(); ++i) {
    if (passages[i].member != passages[i - 1].member) continue;
    shortest = std::min(shortest, passages[i].time - passages[i - 1].time);
    longest = std::max(longest, passages[i].time - passages[i - 1].time);
  }
  const double error = *std::max_element(worst.begin(), worst.end());
  std::printf("%ld members, %ld failed, energy within %.1e\n", ensemble.size(), ensemble.failures(), error);
  std::printf("periods from %.6f to %.6f\n", shortest, longest);
  return ensemble.failures() == 0 && error < 0.01 ? 0 : 1;
}
