#pragma once
/// Motions of one Wiener path by steps of several sizes, and orders with their standard errors: the study of noise on
/// Poisson manifolds, which `lagroid reproduce poisson` and the tests make.
///
///     const NoiseOrders found = noise_orders(50);
///     const double strong = found.several.value;  // 1/2, within twice found.several.error
///
/// Requires at least two batches. Errors: std::runtime_error for a step that does not converge.
///
/// Source: Milstein, Repin, Tretyakov, SIAM J. Numer. Anal. 40, 2002 (orders); the error of an order is the
/// jackknife's.

#include <lagroid/solvers/poisson/noisy_steps.hpp>
#include <lagroid/systems/poisson/rotations.hpp>

#include <cmath>
#include <cstdint>
#include <functional>
#include <memory>
#include <numbers>
#include <stdexcept>
#include <string>
#include <vector>

namespace lagroid {

/// A number and its standard error.
struct Estimate {
  double value = 0;
  double error = 0;
};
inline Estimate estimate(const std::vector<double>& samples) {
  const double n = double(samples.size());
  double mean = 0;
  for (const double x : samples) mean += x / n;
  double square = 0;
  for (const double x : samples) square += (x - mean) * (x - mean);
  return {mean, std::sqrt(square / (n * (n - 1)))};
}

/// The slope of log2 of sizes at h, h/2, h/4, ... by least squares.
inline double slope_of(const std::vector<double>& sizes) {
  const double middle = 0.5 * double(sizes.size() - 1);
  double up = 0;
  double down = 0;
  for (std::size_t l = 0; l < sizes.size(); ++l) {
    up -= (double(l) - middle) * std::log2(sizes[l]);
    down += (double(l) - middle) * (double(l) - middle);
  }
  return up / down;
}
/// The order of sizes that are functions of means over paths, with its standard error by leaving out one batch of paths
/// after another. `numbers` of path m are to be averaged; `size` makes of their means the sizes at h, h/2, h/4, ...
inline Estimate measured_order(int batches, int paths, const std::function<std::vector<double>(int m)>& numbers,
                               const std::function<double(double)>& size) {
  std::vector<std::vector<double>> sums;
  for (int b = 0; b < batches; ++b) {
    std::vector<double> sum;
    for (int m = 0; m < paths; ++m) {
      const std::vector<double> of = numbers(b * paths + m);
      sum.resize(of.size());
      for (std::size_t l = 0; l < of.size(); ++l) sum[l] += of[l] / paths;
    }
    sums.push_back(sum);
  }
  const auto slope = [&](int without) {
    std::vector<double> sizes(sums.front().size());
    const int of = without < 0 ? batches : batches - 1;
    for (int b = 0; b < batches; ++b)
      for (std::size_t l = 0; l < sizes.size(); ++l)
        if (b != without) sizes[l] += sums[std::size_t(b)][l] / of;
    for (double& x : sizes) x = size(x);
    return slope_of(sizes);
  };
  const double all = slope(-1);
  double square = 0;
  for (int b = 0; b < batches; ++b) square += (slope(b) - all) * (slope(b) - all);
  return {all, std::sqrt(square * (batches - 1) / batches)};
}
/// Of root mean squares.
inline Estimate strong_order(int batches, int paths, const std::function<std::vector<double>(int m)>& errors) {
  return measured_order(
      batches, paths,
      [&](int m) {
        std::vector<double> squares = errors(m);
        for (double& e : squares) e *= e;
        return squares;
      },
      [](double mean) { return std::sqrt(mean); });
}
/// Of means.
inline Estimate weak_order(int batches, int paths, const std::function<std::vector<double>(int m)>& changes) {
  return measured_order(batches, paths, changes, [](double mean) { return std::abs(mean); });
}

/// The increments of path m over 2^finest equal steps to time T, and their sums over coarser ones.
template <int K> class Refined {
 public:
  Refined(const WienerPath& path, double duration, int finest) : duration_(duration), finest_(finest) {
    const double h = duration / double(1L << finest);
    for (long n = 0; n < 1L << finest; ++n) fine_.push_back(path.increments<K>(n, h));
  }
  /// Of 2^level steps.
  std::vector<Vector<double, K>> of(int level) const {
    std::vector<Vector<double, K>> sums(std::size_t(1) << level, Vector<double, K>(Vector<double, K>::Zero()));
    for (std::size_t n = 0; n < fine_.size(); ++n) sums[n >> (finest_ - level)] += fine_[n];
    return sums;
  }
  double step(int level) const { return duration_ / double(1L << level); }

 private:
  double duration_;
  int finest_;
  std::vector<Vector<double, K>> fine_;
};

/// Where the steps of a level end.
template <class Step, class X, int K> X end_of(Step step, X x, const Refined<K>& path, int level) {
  const double h = path.step(level);
  for (const Vector<double, K>& sum : path.of(level)) {
    Vector<double, K> dw;
    for (int k = 0; k < K; ++k) dw(k) = WienerPath::cut(sum(k), h);
    X end;
    if (!step.take(x, h, dw, end).converged()) throw std::runtime_error("a step with noise did not converge");
    x = end;
  }
  return x;
}
/// What halving changes, from levels first, first + 1, ..., last - 1 to the next: it falls as the errors do, and knows
/// no limit.
template <class Step, class X, int K>
std::vector<X> halving_changes(const Step& step, const X& x, const Refined<K>& path, int first, int last) {
  std::vector<X> changes;
  X coarse = end_of(step, x, path, first);
  for (int level = first + 1; level <= last; ++level) {
    const X fine = end_of(step, x, path, level);
    changes.push_back(fine - coarse);
    coarse = fine;
  }
  return changes;
}
template <class Step, class X, int K>
std::vector<double> sizes_of_changes(const Step& step, const X& x, const Refined<K>& path, int first, int last) {
  std::vector<double> sizes;
  for (const X& each : halving_changes(step, x, path, first, last)) sizes.push_back(each.norm());
  return sizes;
}

/// The step by the symplectic groupoid.
template <class Sys> using GroupoidNoise = NoisyStep<GroupoidFormula<NaturalChart<DrivenSystem<Sys>>>>;
template <class Sys>
GroupoidNoise<Sys> groupoid_noise(const Sys& system, const Vector<double, noise_count<Sys>()>& strength,
                                  double temperature = 0) {
  using Driven = DrivenSystem<Sys>;
  using Chart = NaturalChart<Driven>;
  return {GroupoidFormula<Chart>(Chart(Driven(system))), strength, temperature};
}

/// Rotations whose energy is that of the noise: of one path all is known, where the free motion is at T + s W(T).
struct ShakenTop : EulerTop {
  static constexpr std::array<std::string_view, 1> noise_names{"energy"};
  template <class S> S noise(int, const Vector<S, 3>& m) const { return this->hamiltonian(m); }
};

/// The orders that are promised, from so many paths for each of 20 batches. The more paths, the more of what is left of
/// higher orders is seen: strong ones are measured from steps `finer` times halved.
struct NoiseOrders {
  Estimate commuting, one, several, weak;
};
inline NoiseOrders noise_orders(int paths, int finer = 0) {
  using X = Vector<double, 3>;
  constexpr int batches = 20;
  const X start(0.8, 0.6, 1.1);
  NoiseOrders out;
  const auto shaken = groupoid_noise(ShakenTop{}, Vector<double, 1>(0.5));
  out.commuting = strong_order(batches, paths, [&](int m) {
    const Refined<1> path({.seed = 11, .path = std::uint32_t(m)}, 1, 9 + finer);
    const long exact_steps = 64;
    const double step = (1 + 0.5 * path.of(0)[0](0)) / double(exact_steps);
    const auto free = make_poisson_integrator(EulerTop{}, start, {.method = "hamilton-jacobi-6", .step = step});
    for (long k = 0; k < exact_steps; ++k) free->advance();
    const std::vector<double> end = free->point();
    std::vector<double> errors;
    for (int level = 5 + finer; level <= 9 + finer; ++level)
      errors.push_back((end_of(shaken, start, path, level) - X(end[0], end[1], end[2])).norm());
    return errors;
  });
  const auto order = [&](const X& strength, std::uint64_t seed) {
    const auto step = groupoid_noise(EulerTop{}, strength);
    return strong_order(batches, paths, [&](int m) {
      return sizes_of_changes(step, start, Refined<3>({.seed = seed, .path = std::uint32_t(m)}, 1, 10 + finer),
                              6 + finer, 10 + finer);
    });
  };
  out.one = order({0, 0, 0.5}, 12);
  out.several = order({0.5, 0.5, 0.5}, 13);
  const auto step = groupoid_noise(EulerTop{}, X(0.7, 0.7, 0.7));
  out.weak = weak_order(batches, 40 * paths, [&](int m) {
    std::vector<double> of;
    const Refined<3> path({.seed = 14, .path = std::uint32_t(m)}, 1, 4);
    for (const X& change : halving_changes(step, start, path, 1, 4)) of.push_back(change.dot(start));
    return of;
  });
  return out;
}

/// Means over a sphere |M| = r with density exp(-H / T), by the midpoint rule.
template <class F> double gibbs_mean(const EulerTop& top, double r, double temperature, const F& f) {
  double weight = 0;
  double sum = 0;
  constexpr int n = 400;
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < n; ++j) {
      const double z = (2 * i + 1.0) / n - 1;
      const double angle = 2 * std::numbers::pi * (j + 0.5) / n;
      const double c = std::sqrt(1 - z * z);
      const Vector<double, 3> m(r * c * std::cos(angle), r * c * std::sin(angle), r * z);
      const double w = std::exp(-top.hamiltonian(m) / temperature);
      weight += w;
      sum += w * f(m);
    }
  return sum / weight;
}

/// The mean of f along a motion of so many steps, after a tenth of them, with its error from those of many paths.
template <class F>
Estimate time_mean(const std::function<std::unique_ptr<PoissonIntegrator>(std::uint32_t path)>& begin, int paths,
                   long steps, const F& f) {
  std::vector<double> means;
  for (int m = 0; m < paths; ++m) {
    const auto motion = begin(std::uint32_t(m));
    for (long k = 0; k < steps / 10; ++k) motion->advance();
    double sum = 0;
    for (long k = 0; k < steps; ++k) {
      if (!motion->advance().converged()) throw std::runtime_error("a step with noise did not converge");
      sum += f(motion->point());
    }
    means.push_back(sum / double(steps));
  }
  return estimate(means);
}

}  // namespace lagroid
