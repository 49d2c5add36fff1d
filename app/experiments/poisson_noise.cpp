#include "poisson_noise.hpp"

#include <lagroid/systems/poisson/noise_study.hpp>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace lagroid::app {

namespace {

using X3 = Vector<double, 3>;
const X3 start_of_top{0.8, 0.6, 1.1};

NoiseRow row(std::string what, double promised, const Estimate& found) {
  return {std::move(what), promised, found.value, found.error};
}

/// How far |M| goes from where it was, over so many steps.
double drift_of_size(double temperature, long steps) {
  const auto motion = make_poisson_integrator(
      EulerTop{}, start_of_top,
      {.step = 0.05, .noise = {.strength = {0.5, 0.5, 0.5}, .seed = 1, .temperature = temperature}});
  double largest = 0;
  for (long k = 0; k < steps; ++k) {
    if (!motion->advance().converged()) throw std::runtime_error("a step with noise did not converge");
    const std::vector<double> m = motion->point();
    largest = std::max(largest, std::abs(X3(m[0], m[1], m[2]).norm() - start_of_top.norm()));
  }
  return largest;
}

/// The means of several functions in the measure that the thermostat has at h -> 0, from the same motions of two step
/// sizes.
std::vector<Estimate> thermostat_means(double temperature, int paths,
                                       const std::vector<std::function<double(const std::vector<double>&)>>& asked) {
  const auto at = [&](double h, std::uint64_t seed) {
    const long steps = std::lround(5000 / h);
    std::vector<std::vector<double>> means(asked.size());
    for (int path = 0; path < paths; ++path) {
      const auto motion = make_poisson_integrator(
          EulerTop{}, start_of_top,
          {.step = h,
           .noise = {.strength = {1, 1, 1}, .seed = seed, .path = std::uint32_t(path), .temperature = temperature}});
      std::vector<double> sums(asked.size(), 0);
      for (long k = -steps / 10; k < steps; ++k) {
        if (!motion->advance().converged()) throw std::runtime_error("a step with noise did not converge");
        if (k < 0) continue;
        const std::vector<double> m = motion->point();
        for (std::size_t i = 0; i < asked.size(); ++i) sums[i] += asked[i](m);
      }
      for (std::size_t i = 0; i < asked.size(); ++i) means[i].push_back(sums[i] / double(steps));
    }
    std::vector<Estimate> out;
    for (const std::vector<double>& each : means) out.push_back(estimate(each));
    return out;
  };
  const auto coarse = at(0.4, 5), fine = at(0.2, 6);
  std::vector<Estimate> out;
  for (std::size_t i = 0; i < asked.size(); ++i)
    out.push_back({2 * fine[i].value - coarse[i].value, std::hypot(2 * fine[i].error, coarse[i].error)});
  return out;
}

}  // namespace

std::vector<NoiseRow> run_noise_study(int paths, const std::function<void(long, long)>& report) {
  constexpr long parts = 3;
  std::vector<NoiseRow> rows;
  const NoiseOrders orders = noise_orders(paths, 1);
  rows.push_back(row("strong order, the noise is the energy's", 1, orders.commuting));
  rows.push_back(row("strong order, one noise", 1, orders.one));
  rows.push_back(row("strong order, three noises that do not commute", 0.5, orders.several));
  rows.push_back(row("weak order, three noises", 1, orders.weak));
  report(1, parts);
  constexpr long steps = 100'000;
  for (const double temperature : {0.0, 0.5})
    rows.push_back({temperature > 0 ? "change of the size of M over 1e5 steps, with friction"
                                    : "change of the size of M over 1e5 steps",
                    0, drift_of_size(temperature, steps), 0});
  report(2, parts);
  const EulerTop top;
  const double temperature = 0.5;
  const auto energy = [&](const auto& m) { return top.hamiltonian(X3(m[0], m[1], m[2])); };
  const auto third = [](const auto& m) { return m[2] * m[2]; };
  const auto means = thermostat_means(temperature, std::max(10, paths / 2), {energy, third});
  rows.push_back(
      row("mean energy of the thermostat", gibbs_mean(top, start_of_top.norm(), temperature, energy), means[0]));
  rows.push_back(
      row("mean M3^2 of the thermostat", gibbs_mean(top, start_of_top.norm(), temperature, third), means[1]));
  report(3, parts);
  return rows;
}

}  // namespace lagroid::app
