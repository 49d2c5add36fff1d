#include "chain.hpp"

#include "../../cases/chain_case.hpp"
#include "../libraries/libraries.hpp"
#include "../ours/ours.hpp"
#include "reference.hpp"

#include <lagroid/systems/pendulums/chain_rattle.hpp>
#include <lagroid/systems/spheres/sphere_integrator.hpp>

#include <fmt/format.h>

#include <array>
#include <memory>
#include <string>
#include <string_view>

namespace peers {

namespace {

using lagroid::multibody::Multibody;

/// The rate at which neighbouring motions part, from two of them whose distance at first is far above round-off and at
/// the end far below the chain's length.
double lyapunov_exponent() {
  using Real = long double;
  const ChainProblem problem;
  constexpr double span = 6;  // s
  constexpr Real apart = 1e-12L;
  std::array<Real, ChainProblem::unknowns> start;
  const auto rounded = problem.start();
  for (std::size_t i = 0; i < start.size(); ++i) start[i] = Real(rounded[i]);
  auto moved = start;
  moved[std::size_t(3 * ChainProblem::links)] += apart;
  const auto a = problem.coordinates(extrapolated(problem, start, span, problem.unit()));
  const auto b = problem.coordinates(extrapolated(problem, moved, span, problem.unit()));
  return double(std::log(problem.distance(a, b) / apart)) / span;
}

/// Places and velocities.
std::array<double, ChainProblem::compared> coordinates(const Multibody& scene) {
  std::array<double, ChainProblem::compared> out;
  const auto momenta = scene.momenta();
  for (std::size_t i = 0; i < ChainProblem::links; ++i)
    for (std::size_t k = 0; k < 3; ++k) {
      out[3 * i + k] = scene.configuration().x[i](Eigen::Index(k));
      out[3 * (ChainProblem::links + i) + k] = momenta.linear[i](Eigen::Index(k)) * ChainProblem::links;
    }
  return out;
}

/// Directions and angular velocities of the rods, which are all of one length.
lagroid::SphereIntegrator::Points on_spheres(const ChainProblem& problem) {
  lagroid::SphereIntegrator::Points z = lagroid::SphereIntegrator::Points::Zero(6, ChainProblem::links);
  const auto rods = problem.start();
  for (int i = 0; i < ChainProblem::links; ++i)
    for (int k = 0; k < 3; ++k) z(k, i) = rods[std::size_t(3 * i + k)] * ChainProblem::links;
  return z;
}

std::array<double, ChainProblem::compared> coordinates(const lagroid::SphereIntegrator& integrator) {
  ChainProblem::Rods<double> rods;
  const auto z = integrator.point();
  for (int i = 0; i < ChainProblem::links; ++i) {
    const auto rate = lagroid::PendulumChain<Eigen::Dynamic>::link_velocity(z, i);
    for (int k = 0; k < 3; ++k) {
      rods[std::size_t(3 * i + k)] = z(k, i) / ChainProblem::links;
      rods[std::size_t(3 * (ChainProblem::links + i) + k)] = rate(k) / ChainProblem::links;
    }
  }
  return ChainProblem::coordinates(rods);
}

std::unique_ptr<lagroid::SphereIntegrator> begin_chain(const ChainProblem& problem,
                                                       const lagroid::SphereIntegratorOptions& options) {
  const Eigen::VectorXd each = Eigen::VectorXd::Constant(ChainProblem::links, 1.0 / ChainProblem::links);
  return lagroid::make_chain_integrator({each, each, ChainProblem::gravity}, on_spheres(problem), options);
}

/// Steps of a pendulum_chain to the end.
Outcome followed(const ChainProblem& problem, lagroid::SphereIntegrator& chain, long steps) {
  Watch<ChainProblem> watch(problem);
  for (long i = 0; i < steps; ++i) {
    const auto report = chain.advance();
    if (!report.converged()) return watch.fail(coordinates(chain), std::string(to_string(report.status)));
    watch.step([&] { return coordinates(chain); });
  }
  return watch.finish(coordinates(chain));
}

Method rattle(const ChainProblem& problem, const lagroid::Composition& composition) {
  const std::string name = composition.stages() > 1 ? fmt::format("RATTLE, {}", composition.name) : "RATTLE";
  const double coarsest = problem.unit() * std::sqrt(double(composition.stages()));
  return {ours, name, false, coarsest, ladder(composition.order), [=](double end, double setting) -> Task {
            const long steps = std::lround(end / setting);
            const std::shared_ptr<lagroid::SphereIntegrator> chain(
                begin_chain(problem, {.method = std::string(lagroid::rattle_method.name),
                                      .step = end / double(steps),
                                      .composition = composition}));
            return [=] { return followed(problem, *chain, steps); };
          }};
}

/// From second to second.
Method controlled(const ChainProblem& problem, std::string_view method, const std::string& name) {
  return {ours, name, true, 1, std::sqrt(10.0), [=](double end, double tolerance) -> Task {
            const long nodes = std::lround(std::ceil(end));
            const std::shared_ptr<lagroid::SphereIntegrator> chain(begin_chain(
                problem, {.method = std::string(method), .step = end / double(nodes), .tolerance = tolerance}));
            return [=] { return followed(problem, *chain, nodes); };
          }};
}

Method scene(const ChainProblem& problem, const lagroid::Composition& composition) {
  const std::string name = composition.stages() > 1 ? fmt::format("scene, {}", composition.name) : "scene";
  const double coarsest = problem.unit() * std::sqrt(double(composition.stages()));
  return {ours, name, false, coarsest, ladder(composition.order), [=](double end, double setting) -> Task {
            const long steps = std::lround(end / setting);
            lagroid::multibody::Options options;
            options.composition = composition;
            const auto chain = bench::hanging_chain(ChainProblem::links, end / double(steps), options);
            return [=] {
              Watch<ChainProblem> watch(problem);
              for (long i = 0; i < steps; ++i) {
                const auto report = chain->advance();
                if (!report.converged()) return watch.fail(coordinates(*chain), std::string(to_string(report.status)));
                watch.step([&] { return coordinates(*chain); });
              }
              return watch.finish(coordinates(*chain));
            };
          }};
}

}  // namespace

Problem chain() {
  const ChainProblem problem;
  const double exponent = lyapunov_exponent();
  // Round-off grows to a thousandth of the chain.
  const double horizon = std::floor(std::log(1e-3 / 1e-15) / exponent);
  Problem out = posed(problem, "chain", "Chain of twenty links", {1, horizon});
  for (const lagroid::Composition& composition : lagroid::compositions::all) {
    out.methods.push_back(scene(problem, composition));
    out.methods.push_back(rattle(problem, composition));
  }
  out.methods.push_back(controlled(problem, lagroid::lie_group_methods::munthe_kaas_54.name, "Munthe-Kaas 54"));
  out.methods.push_back(controlled(problem, lagroid::extrapolation_method.name, "extrapolation"));
  add(out.methods, peer_methods(problem));
  out.remarks = fmt::format(
      "Length and mass 1 m and 1 kg in all, slanting and wound, let go from rest. Neighbouring motions part like "
      "exp({:.2g} t), so that round-off has grown to a thousandth of the chain at about {:g} s. Those who integrate "
      "equations get them with the tensions from a tridiagonal elimination, in O(k). Error: the largest distance of a "
      "mass "
      "from where it ought to be, or of its velocity (m, m/s). Invariants: energy, vertical angular momentum, the "
      "rods' "
      "length.",
      exponent, horizon);
  return out;
}

}  // namespace peers
