// What the gradient of a chain's end by all its masses and lengths costs, in runs.
#include "../cases/chain_case.hpp"
#include "../report/comparison.hpp"

#include <lagroid/solvers/sensitivity/propagate.hpp>
#include <lagroid/systems/multibody/effects.hpp>
#include <lagroid/systems/multibody/joints.hpp>
#include <lagroid/systems/multibody/sensitivity/linearised_scene.hpp>

#include <fmt/format.h>

#include <memory>
#include <string>
#include <vector>

namespace bench {

using namespace lagroid;
using namespace lagroid::multibody;

namespace {

/// The chain of `wound_chain`, the numbers being its masses and then its lengths.
struct Numbered {
  int links;
  template <class S> BasicScene<S> operator()(const std::vector<S>& x) const {
    BasicScene<S> scene;
    Vector<S, 3> place = Vector<S, 3>::Zero();
    Vec before = Vec::Zero();
    Site last = scene.ground(place);
    const std::vector<Vec> places = wound_chain(links);
    for (int i = 0; i < links; ++i) {
      const S &mass = x[std::size_t(i)], &length = x[std::size_t(links + i)];
      const Vec along = (places[std::size_t(i)] - before) * links;
      before = places[std::size_t(i)];
      for (int k = 0; k < 3; ++k) place(k) += length * along(k);
      const Body bob = scene.point_mass(mass, place, Vector<S, 3>::Zero());
      scene.add(BasicRod<S>{{last, bob.centre}, length});
      scene.add(BasicConstantForce<S>{{bob.centre}, Vector<S, 3>(S(0), S(0), mass * -gravity)});
      last = bob.centre;
    }
    return scene;
  }
};

constexpr long steps = 10'000;

std::vector<double> numbers_of(int links) { return std::vector<double>(std::size_t(2 * links), 1.0 / links); }
Multibody chain_of(int links) { return {Numbered{links}(numbers_of(links)), 2e-2 / links}; }

LinearisedScene linearised_chain(int links) {
  std::vector<std::string> names;
  for (int k = 0; k < 2 * links; ++k) names.push_back(std::to_string(k));
  const auto height = [](const ObservedScene& node) {
    VariedNumbers out(1);
    out(0) = node.at.x[node.momentum.size() - 1](2);
    return out;
  };
  return {chain_of(links), names, numbers_of(links), [links, height](const auto& x) {
            return WrittenScene{Numbered{links}(x), height};
          }};
}

/// So many steps from the start, each time.
template <class Motion, class Go>
Subject from_start(std::string group, std::string name, Motion begun, const Go& go, bool reference = false) {
  return {std::move(group), std::move(name),
          [go, motion = std::make_shared<Motion>(std::move(begun))](benchmark::State& state) {
            bool good = true;
            timed(
                state, [&](long count) { good = good && go(*motion, count); }, /*at_once=*/steps);
            if (!good) state.SkipWithError("a step failed");
          },
          reference};
}

void add_chain(int links, std::vector<Subject>& out) {
  const std::string group = fmt::format("chain of {} links, {} steps", links, steps);
  const auto run = [start = chain_of(links).state()](Multibody& motion, long count) {
    motion.restore(start);
    bool good = true;
    for (long k = 0; k < count && good; ++k) good = motion.advance().converged();
    return good;
  };
  out.push_back(from_start(group, "a run", chain_of(links), run, /*reference=*/true));
  const auto gradient = [start = linearised_chain(links).save()](StateBudget budget) {
    return [start, budget](LinearisedScene& motion, long count) {
      motion.restore(start);
      return propagate_backward(motion, count, Observed::at_end(), budget).converged();
    };
  };
  out.push_back(
      from_start(group, fmt::format("gradient by {} numbers", 2 * links), linearised_chain(links), gradient({})));
  out.push_back(from_start(group, "the same, states of the order of log N", linearised_chain(links),
                           gradient(StateBudget::logarithmic(steps))));
}

}  // namespace

std::vector<Subject> scene_gradient_subjects() {
  std::vector<Subject> out;
  for (const int links : {10, 50, 200}) add_chain(links, out);
  return out;
}

}  // namespace bench
