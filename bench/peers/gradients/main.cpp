// lagroid_peers_gradients: derivatives of one run by the library, by differences and by ADOL-C: how long and how exact.
#include "methods.hpp"
#include "step.hpp"

#include <lagroid/solvers/sensitivity/sensitivities.hpp>
#include <lagroid/systems/kepler.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cstdio>
#include <ctime>
#include <functional>
#include <stdexcept>
#include <string>
#include <vector>

namespace peers {

namespace {

/// x with five derivatives, in long double: the reference.
struct Exact {
  long double value = 0;
  Eigen::Matrix<long double, 1, 5> by = Eigen::Matrix<long double, 1, 5>::Zero();
  Exact() = default;
  Exact(double x) : value(x) {}  // NOLINT(google-explicit-constructor)
  Exact(long double x, const Eigen::Matrix<long double, 1, 5>& d) : value(x), by(d) {}
  friend Exact operator+(const Exact& a, const Exact& b) { return {a.value + b.value, a.by + b.by}; }
  friend Exact operator-(const Exact& a, const Exact& b) { return {a.value - b.value, a.by - b.by}; }
  friend Exact operator-(const Exact& a) { return {-a.value, -a.by}; }
  friend Exact operator*(const Exact& a, const Exact& b) {
    return {a.value * b.value, a.value * b.by + b.value * a.by};
  }
  friend Exact operator/(const Exact& a, const Exact& b) {
    const long double q = a.value / b.value;
    return {q, (a.by - q * b.by) / b.value};
  }
  friend Exact sqrt(const Exact& a) {
    const long double root = std::sqrt(a.value);
    return {root, a.by / (2 * root)};
  }
};

Matrix reference(const Start& start, long steps, double h) {
  KeplerRun<Exact> run;
  Exact* const inputs[] = {&run.q[0], &run.q[1], &run.p[0], &run.p[1], &run.k};
  for (int j = 0; j < 5; ++j) {
    *inputs[j] = Exact(start.x[std::size_t(j)]);
    inputs[j]->by(j) = 1;
  }
  run.go(steps, h);
  Matrix out;
  for (int i = 0; i < 4; ++i) out.row(i) = inputs[i]->by.cast<double>();
  return out;
}

lagroid::Kepler kepler_of(const Start& start, double h) {
  lagroid::Kepler kepler;
  kepler.strength = start.x[4];
  kepler.quadrature = lagroid::Quadrature::midpoint;
  kepler.h = h;
  return kepler;
}
lagroid::State<lagroid::Pair<2>> state_of(const Start& start) {
  return {{start.x[0], start.x[1]}, {start.x[2], start.x[3]}};
}

Matrix ours(const Start& start, long steps, double h) {
  const lagroid::Sensitivities end =
      lagroid::sensitivities(kepler_of(start, h), state_of(start), {.steps = steps, .parameters = {"strength"}});
  if (!end.converged()) throw std::runtime_error(end.message);
  Matrix out;
  out << end.by_start, end.by_parameters;
  return out;
}
Row our_gradient(const Start& start, long steps, double h) {
  const lagroid::RunGradient found =
      lagroid::gradient(kepler_of(start, h), state_of(start), [](const auto& node) { return node.object(0); },
                        {.steps = steps, .parameters = {"strength"}});
  if (!found.converged()) throw std::runtime_error(found.message);
  Row out;
  out << found.by_start, found.by_parameters;
  return out;
}

/// Of the hand-written run, which is the fastest to be had.
Eigen::Vector4d end_of(const Start& start, long steps, double h) {
  KeplerRun<double> run{{start.x[0], start.x[1]}, {start.x[2], start.x[3]}, start.x[4]};
  run.go(steps, h);
  return {run.q[0], run.q[1], run.p[0], run.p[1]};
}
Matrix differences(const Start& start, long steps, double h, int levels) {
  Matrix out;
  for (int j = 0; j < 5; ++j) {
    std::vector<Eigen::Vector4d> row;
    double width = levels == 1 ? 6e-6 : 2e-4;
    for (int level = 0; level < levels; ++level, width /= 2) {
      Start above = start, below = start;
      above.x[std::size_t(j)] += width;
      below.x[std::size_t(j)] -= width;
      Eigen::Vector4d next = (end_of(above, steps, h) - end_of(below, steps, h)) / (2 * width);
      double power = 4;
      for (Eigen::Vector4d& each : row) {
        const Eigen::Vector4d better = next + (next - each) / (power - 1);
        each = next;
        next = better;
        power *= 4;
      }
      row.push_back(next);
    }
    out.col(j) = row.back();
  }
  return out;
}

double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return double(now.tv_sec) + 1e-9 * double(now.tv_nsec);
}
/// The median of some repetitions.
double seconds_of(const std::function<void()>& work) {
  std::vector<double> all;
  for (int i = 0; i < 7; ++i) {
    const double begun = processor_seconds();
    work();
    all.push_back(processor_seconds() - begun);
  }
  std::sort(all.begin(), all.end());
  return all[all.size() / 2];
}

}  // namespace

}  // namespace peers

int main() try {
  using namespace peers;
  const Start start{{1, 0, 0, 1.2, 1}};
  constexpr double h = 0.02;
  volatile double kept = 0;
  fmt::print("| | steps | by | time | in runs | off |\n|---|---|---|---|---|---|\n");
  for (const long steps : {1000L, 10000L}) {
    const Matrix exact = reference(start, steps, h);
    const double one = seconds_of([&] { kept = end_of(start, steps, h)(0); });
    const auto line = [&](const char* what, const char* by, const std::function<Eigen::MatrixXd()>& find) {
      Eigen::MatrixXd found;
      const double seconds = seconds_of([&] { found = find(); });
      const double off = (found - exact.topRows(found.rows())).norm() / exact.topRows(found.rows()).norm();
      fmt::print("| {} | {} | {} | {:.3g} ms | {:.1f} | {:.1e} |\n", what, steps, by, 1e3 * seconds, seconds / one,
                 off);
    };
    const char* const all = "end by start and strength";
    line(all, "lagroid, forward", [&] { return ours(start, steps, h); });
    line(all, "central differences", [&] { return differences(start, steps, h, 1); });
    line(all, "extrapolated differences", [&] { return differences(start, steps, h, 3); });
#ifdef LAGROID_PEER_ADOLC
    line(all, "ADOL-C", [&] { return adolc_matrix(start, steps, h); });
#endif
    const char* const one_of_them = "x at the end by start and strength";
    line(one_of_them, "lagroid, backward", [&] { return our_gradient(start, steps, h); });
#ifdef LAGROID_PEER_ADOLC
    line(one_of_them, "ADOL-C", [&] { return adolc_gradient(start, steps, h); });
#endif
  }
  return 0;
} catch (const std::exception& error) {
  fmt::print(stderr, "lagroid_peers_gradients: {}\n", error.what());
  return 1;
}
