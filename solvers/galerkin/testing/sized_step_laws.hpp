#pragma once
/// Laws of one-step methods on T*R^n of any size (sized_step.hpp), for your own: a step has its order, is symplectic on
/// the constrained space and goes back the way it came, where it declares that.
///
///     laws::SizedStepSubject subject{.name = "drop", .make = make, .traits = traits, .start = {q, p}, .step = 0.1};
///     EXPECT_TRUE(laws::sized_step_laws(subject).holds());
///
/// Requires RapidCheck and a start beside which the system is smooth; states are drawn there, on the constraints.
/// Returns a LawReport; a law that does not hold is no exception. Steps that do not converge are passed over.
///
/// Source: Marsden and West, Acta Numerica 10 (2001), 2.3, 2.4, 3.5.

#include <lagroid/core/testing/property.hpp>
#include <lagroid/solvers/galerkin/sized_lagrangian.hpp>
#include <lagroid/solvers/step/sized_step.hpp>
#include <lagroid/solvers/testing/order_laws.hpp>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <string>
#include <vector>

namespace lagroid::laws {

/// A start, and by which steps of size h to go on from it.
struct SizedStepSubject {
  std::string name;
  std::function<std::unique_ptr<SizedStep>()> make;
  MethodTraits traits;
  SizedState start;
  double step;
  double time = 0;
  /// C and its derivatives at q, a row each; null where there are no constraints.
  std::function<Eigen::MatrixXd(const Eigen::VectorXd& q)> constraint = nullptr;
  /// q and p so much later than at the start, to round-off; null: no order is asked.
  std::function<Eigen::VectorXd(double later)> exact = nullptr;
  double spread = 0.02;  ///< states are drawn so far from the start, in units of its size
};

namespace detail {

/// The nearest place on the constraints, and the momentum that is tangent there.
inline SizedState on_constraints(const SizedStepSubject& subject, const SizedStep& step, SizedState z) {
  if (subject.constraint) z.position = lagroid::detail::place_on_constraints(subject.constraint, z.position);
  TangentState tangent;
  step.find_velocity(z, subject.time, tangent);
  if (!tangent.found) throw NotSampled("no velocity belongs to a momentum there");
  z.momentum = tangent.momentum;
  z.velocity = tangent.velocity;
  return z;
}
/// What places and momenta are of the size of: at the start, and after eight steps where those converge.
struct PhaseUnits {
  double place = 0;
  double momentum = 0;
};
inline PhaseUnits units_of(const SizedStepSubject& subject, SizedStep& step) {
  SizedState z = subject.start;
  PhaseUnits out{z.position.norm(), z.momentum.norm()};
  for (int k = 0; k < 8; ++k) {
    if (!step.take(z, subject.time + k * subject.step, subject.step).converged()) break;
    out.place = std::max(out.place, z.position.norm());
    out.momentum = std::max(out.momentum, z.momentum.norm());
  }
  if (!(out.place > 0)) out.place = 1;
  if (!(out.momentum > 0)) out.momentum = 1;
  return out;
}
inline SizedState drawn(const SizedStepSubject& subject, const SizedStep& step, const PhaseUnits& units) {
  SizedState z = subject.start;
  for (double& each : z.position) each += subject.spread * units.place * draw_uniform();
  for (double& each : z.momentum) each += subject.spread * units.momentum * draw_uniform();
  return on_constraints(subject, step, z);
}
inline SizedState stepped(const SizedStepSubject& subject, SizedStep& step, SizedState z, double h, double t) {
  if (const StepReport report = step.take(z, t, h); !report.converged())
    throw NotSampled("a step from here ends " + std::string(to_string(report.status)));
  return on_constraints(subject, step, z);
}
/// The derivative at zero of a curve of states, by differences that are extrapolated twice.
template <class Curve> SizedState derivative(const Curve& curve) {
  const auto quotient = [&](double h) {
    const SizedState ahead = curve(h), back = curve(-h);
    return SizedState{(ahead.position - back.position) / (2 * h), (ahead.momentum - back.momentum) / (2 * h)};
  };
  const SizedState a = quotient(4e-3), b = quotient(2e-3), c = quotient(1e-3);
  const auto extrapolated = [](const auto& x, const auto& y, const auto& z) {
    const Eigen::VectorXd first = (4 * y - x) / 3, second = (4 * z - y) / 3;
    return Eigen::VectorXd((16 * second - first) / 15);
  };
  return {extrapolated(a.position, b.position, c.position), extrapolated(a.momentum, b.momentum, c.momentum)};
}

}  // namespace detail

/// "steps return to where they began" (of symmetric ones), "the step is symplectic" (where that is declared), "the
/// error falls as declared".
inline LawReport sized_step_laws(const SizedStepSubject& subject) {
  const Eigen::Index n = subject.start.position.size();
  const std::unique_ptr<SizedStep> step = subject.make();
  LawReport report{subject.name + ", steps by " + subject.traits.name, {}};
  const double h = subject.step, t = subject.time;
  const detail::PhaseUnits units = detail::units_of(subject, *step);

  if (subject.traits.symmetric)
    report.laws.push_back(check_law("steps return to where they began", 1e-10, [&] {
      const SizedState z = detail::drawn(subject, *step, units);
      const SizedState back = detail::stepped(subject, *step, detail::stepped(subject, *step, z, h, t), -h, t + h);
      return (back.position - z.position).norm() / units.place + (back.momentum - z.momentum).norm() / units.momentum;
    }));

  if (subject.traits.symplectic)
    report.laws.push_back(check_law("the step is symplectic", 1e-7, [&] {
      const SizedState z = detail::drawn(subject, *step, units);
      const auto direction = [&] {
        SizedState d{Eigen::VectorXd(n), Eigen::VectorXd(n)};
        for (double& each : d.position) each = units.place * draw_uniform();
        for (double& each : d.momentum) each = units.momentum * draw_uniform();
        return d;
      };
      const SizedState one = direction(), other = direction();
      const auto moved = [&](const SizedState& by, double s) {
        return detail::on_constraints(subject, *step, {z.position + s * by.position, z.momentum + s * by.momentum});
      };
      const auto before = [&](const SizedState& by) {
        return detail::derivative([&](double s) { return moved(by, s); });
      };
      const auto after = [&](const SizedState& by) {
        return detail::derivative([&](double s) { return detail::stepped(subject, *step, moved(by, s), h, t); });
      };
      const auto form = [](const SizedState& a, const SizedState& b) {
        return a.position.dot(b.momentum) - a.momentum.dot(b.position);
      };
      const SizedState a = before(one), b = before(other), c = after(one), d = after(other);
      return std::abs(form(c, d) - form(a, b)) / (units.place * units.momentum + c.position.norm() * d.momentum.norm() +
                                                  c.momentum.norm() * d.position.norm());
    }));

  if (!subject.exact) return report;
  constexpr int steps = 8;
  Law order;
  order.name = "the error falls as declared";
  order.samples = 1;
  order.tolerance = subject.traits.order > 6 ? 0.5 : 0.3;
  // Errors must be above round-off: with steps as long as the scene's, or longer ones, of which those count where the
  // slopes of errors agree best.
  constexpr double agree = 0.5;
  MeasuredOrder measured;
  for (double longer = 1; longer <= 32 && !(measured.spread <= agree); longer *= 2) try {
      const double later = steps * h * longer;
      OrderProblem problem;
      problem.coarsest = steps;
      const auto in_units = [&](Eigen::VectorXd both) {
        both.head(n) /= units.place;
        both.tail(n) /= units.momentum;
        return both;
      };
      problem.exact = in_units(subject.exact(later));
      // What grew has lost its digits by then, and longer steps would lose more.
      if (longer > 1 && !(problem.exact.norm() < 10)) break;
      problem.plateau = 1e-11 * (1 + problem.exact.norm());
      problem.end = [&](int count) {
        const std::unique_ptr<SizedStep> taken = subject.make();
        SizedState z = detail::on_constraints(subject, *taken, subject.start);
        const double part = later / count;
        for (int k = 0; k < count; ++k) z = detail::stepped(subject, *taken, z, part, t + k * part);
        Eigen::VectorXd both(2 * n);
        both << z.position, z.momentum;
        return in_units(both);
      };
      if (const MeasuredOrder found = measure_order(problem); found.spread < measured.spread) measured = found;
    } catch (const NotSampled& none) {
      if (std::isnan(measured.order)) order.skipped_because = none.what();
      break;
    }
  order.unjudged = std::isnan(measured.order);
  if (!order.unjudged) {
    order.worst = std::max(0.0, subject.traits.order - measured.order);  // more is no fault
  } else if (order.skipped_because.empty()) {
    order.skipped_because = "no errors above round-off";
  }
  report.laws.push_back(order);
  return report;
}

/// "derivatives are those of l": first and second ones, against differences of l and of the first.
inline LawReport sized_lagrangian_laws(const SizedLagrangian& l, const SizedStepSubject& subject) {
  const Eigen::Index n = l.sizes().dimension;
  const std::unique_ptr<SizedStep> step = subject.make();
  const detail::PhaseUnits units = detail::units_of(subject, *step);
  LawReport report{subject.name + ", Lagrangian", {}};
  report.laws.push_back(check_law("derivatives are those of l", 1e-7, [&] {
    const SizedState z = detail::drawn(subject, *step, units);
    TangentState tangent;
    step->find_velocity(z, subject.time, tangent);
    Eigen::VectorXd at(2 * n), along(2 * n);
    at << z.position, tangent.velocity;
    const double speed = std::max(tangent.velocity.norm(), units.place / std::abs(subject.step) * 1e-3);
    for (Eigen::Index i = 0; i < 2 * n; ++i) along(i) = (i < n ? units.place : speed) * draw_uniform();
    std::vector<double> numbers(l.lagrangian_numbers());
    const auto first = [&](const Eigen::VectorXd& x) {
      l.lagrangian(subject.time, x.data(), x.data() + n, numbers.data());
      return Eigen::VectorXd(Eigen::Map<const Eigen::VectorXd>(numbers.data(), 1 + 2 * n));
    };
    const SizedState found = detail::derivative([&](double s) {
      return SizedState{first(at + s * along), Eigen::VectorXd(0)};
    });
    const Eigen::VectorXd slope = first(at).tail(2 * n);
    Eigen::MatrixXd second(2 * n, 2 * n);
    for (int i = 0; i < 2 * n; ++i)
      for (int j = 0; j < 2 * n; ++j) second(i, j) = SecondOrder{numbers.data(), int(2 * n)}.second(i, j);
    Eigen::VectorXd declared(1 + 2 * n);
    declared << slope.dot(along), second * along;
    // l, its derivatives by places and those by velocities are of different units.
    const auto relative = [&](Eigen::Index from, Eigen::Index count, double size) {
      const double off = (found.position - declared).segment(from, count).norm();
      const double whole = declared.segment(from, count).norm() + size;
      return off == 0 ? 0 : off / whole;
    };
    return std::max({relative(0, 1, std::abs(numbers[0])), relative(1, n, slope.head(n).norm()),
                     relative(1 + n, n, slope.tail(n).norm())});
  }));
  return report;
}

}  // namespace lagroid::laws
