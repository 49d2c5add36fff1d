// Chains of spherical pendula: by hand, by the framework with the number of links known to the compiler and not, and
// how the time of a step grows with it.
#include <lagroid/solvers/lie_group/integrator.hpp>
#include <lagroid/systems/pendulums/chain_rattle.hpp>
#include <lagroid/systems/spheres/sphere_integrator.hpp>

#include "../cases/pendulum_case.hpp"
#include "../report/comparison.hpp"

#include <fmt/format.h>

#include <memory>

namespace bench {

using namespace lagroid;

namespace {

constexpr int any = Eigen::Dynamic;
constexpr const char* by_hand = "by hand";
constexpr const char* fixed = "framework, links known to the compiler";
constexpr const char* at_run_time = "framework, links and method chosen at run time";

std::string cf4_group(int links) { return fmt::format("pendulum chain, {} links, commutator-free order 4", links); }
std::string rattle_group(int links) { return fmt::format("pendulum chain, {} links, RATTLE", links); }
constexpr const char* growing = "pendulum chains, commutator-free order 4";
constexpr const char* growing_rattle = "pendulum chains, RATTLE";
std::string of(int links) { return fmt::format("{} links", links); }

template <class Kernel> Subject kernel(std::string group, Kernel start) {
  auto hand = std::make_shared<Kernel>(std::move(start));
  return {std::move(group), by_hand,
          [hand](benchmark::State& state) {
            timed(state, [&](long steps) {
              for (long k = 0; k < steps; ++k) hand->step();
            });
          },
          /*reference=*/true};
}

template <class Integrator> Subject steps(std::string group, std::string name, std::shared_ptr<Integrator> integrator) {
  return {std::move(group), std::move(name), [integrator](benchmark::State& state) {
            bool good = true;
            timed(state, [&](long count) {
              for (long k = 0; k < count && good; ++k) good = integrator->advance().converged();
            });
            if (!good) state.SkipWithError("a step failed");
          }};
}

template <int K> auto cf4() {
  const auto chain = pendulum_chain<K>(K);
  return std::make_shared<LieGroupIntegrator<CotangentSpheres<K>, ChainMomentumField<K>>>(
      chain.space(), ChainMomentumField<K>(chain), lie_group_methods::commutator_free_4,
      chain.to_momenta(pendulum_start<K>(K)), pendulum_step(K));
}
template <int K> auto rattle() {
  return std::make_shared<ChainRattle<K>>(pendulum_chain<K>(K), pendulum_start<K>(K), pendulum_step(K));
}
std::shared_ptr<SphereIntegrator> integrator(const std::string& method, int links) {
  const auto chain = pendulum_chain<any>(links);
  const bool variational = method == "rattle";
  const auto start = pendulum_start<any>(links);
  return make_chain_integrator(chain, variational ? start : chain.to_momenta(start),
                               {.method = method,
                                .form = variational ? SphereForm::velocities : SphereForm::momenta,
                                .step = pendulum_step(links)});
}
const std::string cf4_name{lie_group_methods::commutator_free_4.name};

template <int K> void compare(std::vector<Subject>& out) {
  out.push_back(kernel(cf4_group(K), pendulum_cf4<K>()));
  out.push_back(steps(cf4_group(K), fixed, cf4<K>()));
  out.push_back(steps(cf4_group(K), at_run_time, integrator(cf4_name, K)));
  out.push_back(kernel(rattle_group(K), pendulum_rattle<K>()));
  out.push_back(steps(rattle_group(K), fixed, rattle<K>()));
  out.push_back(steps(rattle_group(K), at_run_time, integrator("rattle", K)));
}

}  // namespace

std::vector<Subject> pendulum_chain_subjects() {
  std::vector<Subject> out;
  compare<1>(out);
  compare<10>(out);
  for (const int links : {10, 100, 1000}) {
    Subject subject = steps(growing, of(links), integrator(cf4_name, links));
    subject.reference = links == 10;
    out.push_back(subject);
  }
  for (const int links : {10, 100, 1000}) {
    Subject subject = steps(growing_rattle, of(links), integrator("rattle", links));
    subject.reference = links == 10;
    out.push_back(subject);
  }
  return out;
}

std::vector<Goal> pendulum_chain_goals() {
  std::vector<Goal> out;
  for (const int links : {1, 10})
    for (const auto& group : {cf4_group(links), rattle_group(links)}) {
      out.push_back({group, at_run_time, by_hand, 1.5});
    }
  for (const char* group : {growing, growing_rattle}) out.push_back({group, of(1000), of(100), 11});
  return out;
}

}  // namespace bench
