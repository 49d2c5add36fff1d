#pragma once
/// Noise on Poisson manifolds, measured on Euler's top: orders, the size of the momentum, the measure of a thermostat.

#include <functional>
#include <string>
#include <vector>

namespace lagroid::app {

/// A number that theory knows, and what is found, with its standard error; zero where it is a bound.
struct NoiseRow {
  std::string what;
  double promised = 0;
  double found = 0;
  double error = 0;
};

/// Orders from 20 batches of so many paths, the rest from as much work. `report(done, all)` is called on the way.
std::vector<NoiseRow> run_noise_study(int paths, const std::function<void(long, long)>& report);

}  // namespace lagroid::app
