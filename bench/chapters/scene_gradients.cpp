// What derivatives of a run cost, in runs: a chain's end by all its masses and lengths, and matrices of small systems
// and of chains.
#include "../cases/chain_case.hpp"
#include "../report/comparison.hpp"

#include <lagroid/solvers/sensitivity/propagate.hpp>
#include <lagroid/solvers/sensitivity/sensitivities.hpp>
#include <lagroid/systems/kepler.hpp>
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

/// By all its numbers, or by none.
LinearisedScene linearised_chain(int links, bool by_numbers = true) {
  std::vector<std::string> names;
  for (int k = 0; by_numbers && k < 2 * links; ++k) names.push_back(std::to_string(k));
  const auto height = [](const ObservedScene& node) {
    VariedNumbers out(1);
    out(0) = node.at.x[node.momentum.size() - 1](2);
    return out;
  };
  const std::vector<double> all = numbers_of(links);
  return {
      chain_of(links), names, by_numbers ? all : std::vector<double>(), [links, height, all](const auto& x) {
        return WrittenScene{Numbered{links}(x.empty() ? std::vector<VariedNumber>(all.begin(), all.end()) : x), height};
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

template <class Motion> bool goes(Motion& motion, long count) {
  bool good = true;
  for (long k = 0; k < count && good; ++k) good = motion.advance().converged();
  return good;
}
/// The derivatives of the end along these directions.
template <class Motion> bool goes_forward(Motion& motion, long count, const Eigen::MatrixXd& directions) {
  return propagate_forward(motion, count, directions).converged();
}

void add_chain(int links, std::vector<Subject>& out) {
  const std::string group = fmt::format("chain of {} links, {} steps", links, steps);
  const auto run = [start = chain_of(links).state()](Multibody& motion, long count) {
    motion.restore(start);
    return goes(motion, count);
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

void add_matrix_of_chain(int links, std::vector<Subject>& out) {
  const std::string group = fmt::format("transition matrix, chain of {} links, {} steps", links, steps);
  const auto run = [start = chain_of(links).state()](Multibody& motion, long count) {
    motion.restore(start);
    return goes(motion, count);
  };
  out.push_back(from_start(group, "a run", chain_of(links), run, /*reference=*/true));
  const auto matrix = [start = linearised_chain(links, false).save()](LinearisedScene& motion, long count) {
    motion.restore(start);
    return goes_forward(motion, count, Eigen::MatrixXd::Identity(motion.states(), motion.states()));
  };
  out.push_back(from_start(group, fmt::format("{} directions", 6 * links), linearised_chain(links, false), matrix));
}

/// Of Kepler's problem, by its start and the strength of the attraction.
void add_matrix_of_kepler(std::vector<Subject>& out) {
  const std::string group = fmt::format("transition matrix, Kepler, {} steps", steps);
  Kepler kepler;
  kepler.h = 0.02;
  const State<Kepler::GroupoidType> start = {{1, 0}, {0, 1.2}};
  const auto linearised = [kepler, start] {
    return std::make_shared<LinearisedMotionOf<Kepler>>(
        kepler, lagroid::detail::newton_integrator(kepler, start, {}), std::vector<std::string>{"strength"},
        [](const ObservedNode<Kepler>& node) { return VariedVector(node.momentum); });
  };
  using Motion = std::shared_ptr<LinearisedMotionOf<Kepler>>;
  const std::vector<double> begun = linearised()->save();
  const auto run = [begun](const Motion& motion, long count) {
    motion->restore(begun);
    return goes(*motion, count);
  };
  out.push_back(from_start(group, "a run", linearised(), run, /*reference=*/true));
  const auto matrix = [begun](const Motion& motion, long count) {
    motion->restore(begun);
    const int all = motion->states() + motion->parameters();
    return goes_forward(*motion, count, Eigen::MatrixXd::Identity(all, all));
  };
  out.push_back(from_start(group, "5 directions", linearised(), matrix));
}

}  // namespace

std::vector<Subject> scene_gradient_subjects() {
  std::vector<Subject> out;
  for (const int links : {10, 50, 200}) add_chain(links, out);
  add_matrix_of_kepler(out);
  for (const int links : {10, 50}) add_matrix_of_chain(links, out);
  return out;
}

}  // namespace bench
