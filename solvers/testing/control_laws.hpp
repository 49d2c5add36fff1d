#pragma once
/// Laws of optimal control problems, that their derivatives are those of their values, and of their solutions, by
/// differences of values alone:
///
///     d(l + <lambda, phi> + <z, gamma>) = 0,    phi = 0,    gamma <= 0,    z >= 0,    z gamma = 0.
///
/// A solver judges itself by the derivatives that it was given; these laws do not use them.
///
///     TranscriptionOf<DubinsCar> transcription(task, straight_trajectory(task, 20));
///     const laws::LawReport report = laws::transcription_laws(transcription);
///     std::cout << report;
///
/// Requires a trajectory at which all values are finite. Returns a LawReport; nothing throws.

#include <lagroid/core/testing/law_report.hpp>
#include <lagroid/solvers/control/transcription.hpp>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <random>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::laws {

namespace detail {

inline Law control_law(const std::string& name, double defect, double tolerance, int samples) {
  Law out;
  out.name = name;
  out.samples = samples;
  out.worst = worst({defect});
  out.tolerance = tolerance;
  return out;
}

inline void randomise(StageRows& rows, std::mt19937_64& generator, double low, double high) {
  std::uniform_real_distribution<double> uniform(low, high);
  for (double& x : rows.numbers()) x = uniform(generator);
}

inline TrajectoryDisplacement random_displacement(const Transcription& of, std::mt19937_64& generator) {
  TrajectoryDisplacement out(of.sizes());
  randomise(out.nodes, generator, -1, 1);
  randomise(out.controls, generator, -1, 1);
  const long last = of.sizes().stages;
  for (int i = 0; i < of.sizes().node; ++i) {
    if (!of.free_start()[std::size_t(i)]) out.nodes[0][i] = 0;
    if (!of.free_end()[std::size_t(i)]) out.nodes[last][i] = 0;
  }
  const std::vector<TranscriptionPhase>& phases = of.sizes().phases;
  for (std::size_t p = 0; p < phases.size(); ++p)
    if (phases[p].duration_is_free) out.durations[p] = std::uniform_real_distribution<double>(-1, 1)(generator);
  for (long k = 0; k < last; ++k)
    for (int i = 0; i < of.sizes().control; ++i)
      if (of.sizes().control_is_fixed(k, i)) out.controls[k][i] = 0;
  return out;
}

/// The displacement of a stage's variables.
inline std::vector<double> stage_part(const TranscriptionSizes& sizes, const TrajectoryDisplacement& of, long stage) {
  std::vector<double> x(of.nodes[stage], of.nodes[stage] + sizes.node);
  x.insert(x.end(), of.nodes[stage + 1], of.nodes[stage + 1] + sizes.node);
  x.insert(x.end(), of.controls[stage], of.controls[stage] + sizes.control);
  x.push_back(of.durations[std::size_t(sizes.phase_of(stage))]);
  return x;
}

/// The first and second derivative of f at 0.
struct Differences {
  double first;
  double second;
};

/// How far apart the values stand that differences are of. Where f bends sharply only close ones tell, where it is flat
/// round-off spares far ones.
constexpr std::array<double, 5> rungs{8e-3, 4e-3, 2e-3, 1e-3, 5e-4};

/// Central differences at all rungs extrapolated to none, by Ridders: of the table's entries the one that is nearest to
/// those it was made of. f(i) is the value at rungs[i - 1], f(-i) the one opposite, f(0) that in the middle.
template <class F> Differences differences(const F& f) {
  const auto extrapolated = [](const auto& at) {
    std::array<double, rungs.size()> row{};
    double best = at(0);
    double least = HUGE_VAL;
    for (std::size_t i = 0; i < rungs.size(); ++i) {
      double before = row[0];  // of the row above, in the column before
      row[0] = at(i);
      double power = 1;
      for (std::size_t j = 1; j <= i; ++j) {
        power *= 4;
        const double here = row[j - 1] + (row[j - 1] - before) / (power - 1);
        const double error = std::max(std::abs(here - row[j - 1]), std::abs(here - before));
        before = std::exchange(row[j], here);
        if (error < least) {
          least = error;
          best = here;
        }
      }
    }
    return best;
  };
  const auto rung = [](std::size_t i) { return int(i) + 1; };
  const auto first = [&](std::size_t i) { return (f(rung(i)) - f(-rung(i))) / (2 * rungs[i]); };
  const auto second = [&](std::size_t i) { return (f(rung(i)) - 2 * f(0) + f(-rung(i))) / (rungs[i] * rungs[i]); };
  return {extrapolated(first), extrapolated(second)};
}

/// A trajectory's values along a displacement, at every rung and in the middle.
class ValuesAlong {
 public:
  ValuesAlong(Transcription& subject, const TrajectoryDisplacement& by) {
    for (int i = -last; i <= last; ++i) {
      subject.try_displacement(by, i == 0 ? 0 : std::copysign(rungs[std::size_t(std::abs(i) - 1)], i));
      subject.values(at_.emplace_back(subject.sizes()));
    }
  }
  /// Of a number that `value` takes from the values.
  template <class Value> Differences differences(const Value& value) const {
    return detail::differences([&](int i) { return value(at_[std::size_t(last + i)]); });
  }

 private:
  static constexpr int last = int(rungs.size());
  std::vector<StageValues> at_;
};

/// l + <lambda, phi> + <z, gamma> of one stage.
inline double stage_lagrangian(const TranscriptionSizes& sizes, const StageValues& at, const StageRows& lambda,
                               const StageRows& z, long stage) {
  double sum = at.cost[stage][0];
  for (int i = 0; i < sizes.equalities_of(stage); ++i) sum += lambda[stage][i] * at.equality[stage][i];
  for (int i = 0; i < sizes.inequality; ++i) sum += z[stage][i] * at.inequality[stage][i];
  return sum;
}

}  // namespace detail

/// Of the derivatives of a problem, at the trajectory where it stands, along random displacements.
inline LawReport transcription_laws(Transcription& subject, int samples = 5, std::uint64_t seed = 1) {
  const TranscriptionSizes sizes = subject.sizes();
  std::mt19937_64 generator(seed);
  StageRows lambda(sizes.stages, sizes.equality);
  StageRows z(sizes.stages, sizes.inequality);
  detail::randomise(lambda, generator, -1, 1);
  detail::randomise(z, generator, 0, 1);
  StageDerivatives derivatives(sizes);
  subject.derivatives(lambda, z, derivatives);
  const int d = sizes.variables();
  double cost = 0;
  double equality = 0;
  double inequality = 0;
  double hessian = 0;
  double symmetry = 0;
  for (int sample = 0; sample < samples; ++sample) {
    const TrajectoryDisplacement by = detail::random_displacement(subject, generator);
    const detail::ValuesAlong along(subject, by);
    for (long k = 0; k < sizes.stages; ++k) {
      const std::vector<double> x = detail::stage_part(sizes, by, k);
      const auto slope = [&](const double* row) {
        double sum = 0;
        for (int q = 0; q < d; ++q) sum += row[q] * x[std::size_t(q)];
        return sum;
      };
      const auto defect = [](double found, double wanted) { return std::abs(found - wanted) / (1 + std::abs(wanted)); };
      cost = std::max(cost, defect(slope(derivatives.gradient[k]),
                                   along.differences([&](const StageValues& at) { return at.cost[k][0]; }).first));
      for (int i = 0; i < sizes.equalities_of(k); ++i)
        equality = std::max(equality,
                            defect(slope(derivatives.equality[k] + i * d),
                                   along.differences([&](const StageValues& at) { return at.equality[k][i]; }).first));
      const auto slope_of_inequality = [&](int i) {
        const ControlBound* bound = sizes.bound_of(k, i);
        return bound ? bound->sign * x[std::size_t(sizes.at_control() + bound->control)]
                     : slope(derivatives.inequality[k] + i * d);
      };
      for (int i = 0; i < sizes.inequality; ++i)
        inequality = std::max(
            inequality, defect(slope_of_inequality(i),
                               along.differences([&](const StageValues& at) { return at.inequality[k][i]; }).first));
      double curvature = 0;
      for (int q = 0; q < d; ++q) {
        curvature += x[std::size_t(q)] * slope(derivatives.hessian[k] + q * d);
        for (int r = 0; r < q; ++r)
          symmetry =
              std::max(symmetry, std::abs(derivatives.hessian[k][q * d + r] - derivatives.hessian[k][r * d + q]));
      }
      const auto lagrangian = [&](const StageValues& at) { return detail::stage_lagrangian(sizes, at, lambda, z, k); };
      hessian = std::max(hessian, defect(curvature, along.differences(lagrangian).second));
    }
  }
  const int tested = samples * int(sizes.stages);
  LawReport report{"optimal control problem", {}};
  report.laws.push_back(detail::control_law("the cost's gradient is that of its values", cost, 1e-9, tested));
  report.laws.push_back(
      detail::control_law("the equalities' derivatives are those of their values", equality, 1e-9, tested));
  if (sizes.inequality > 0)
    report.laws.push_back(
        detail::control_law("the inequalities' derivatives are those of their values", inequality, 1e-9, tested));
  report.laws.push_back(detail::control_law("the Hessian is that of the stage's Lagrangian", hessian, 1e-6, tested));
  report.laws.push_back(detail::control_law("the Hessian is symmetric", symmetry, 1e-10, tested));
  return report;
}

/// Of a solution with its multipliers, which `subject` stands at.
inline LawReport optimality_laws(Transcription& subject, const StageRows& lambda, const StageRows& z, int samples = 20,
                                 std::uint64_t seed = 1) {
  const TranscriptionSizes sizes = subject.sizes();
  std::mt19937_64 generator(seed);
  StageValues tried(sizes);
  double stationarity = 0;
  for (int sample = 0; sample < samples; ++sample) {
    const TrajectoryDisplacement by = detail::random_displacement(subject, generator);
    const auto lagrangian = [&](const StageValues& at) {
      double sum = 0;
      for (long k = 0; k < sizes.stages; ++k) sum += detail::stage_lagrangian(sizes, at, lambda, z, k);
      return sum;
    };
    stationarity = std::max(stationarity, std::abs(detail::ValuesAlong(subject, by).differences(lagrangian).first));
  }
  TrajectoryDisplacement none(sizes);
  subject.try_displacement(none, 0);
  subject.values(tried);
  double equality = 0;
  double inequality = 0;
  double sign = 0;
  double complementarity = 0;
  for (long k = 0; k < sizes.stages; ++k) {
    for (int i = 0; i < sizes.equalities_of(k); ++i) equality = std::max(equality, std::abs(tried.equality[k][i]));
    for (int i = 0; i < sizes.inequality; ++i) {
      inequality = std::max(inequality, tried.inequality[k][i]);
      sign = std::max(sign, -z[k][i]);
      complementarity = std::max(complementarity, std::abs(z[k][i] * tried.inequality[k][i]));
    }
  }
  LawReport report{"solution of an optimal control problem", {}};
  report.laws.push_back(detail::control_law("the Lagrangian is stationary", stationarity, 1e-6, samples));
  report.laws.push_back(detail::control_law("equalities hold", equality, 1e-9, int(sizes.stages)));
  if (sizes.inequality > 0) {
    report.laws.push_back(detail::control_law("inequalities hold", inequality, 1e-9, int(sizes.stages)));
    report.laws.push_back(detail::control_law("multipliers have their sign", sign, 0, int(sizes.stages)));
    report.laws.push_back(detail::control_law("complementarity", complementarity, 1e-9, int(sizes.stages)));
  }
  return report;
}

}  // namespace lagroid::laws
