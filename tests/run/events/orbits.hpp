#pragma once
// Motions in which something happens, by steps of order eight.
#include <lagroid/run/files/output_folder.hpp>
#include <lagroid/run/run.hpp>
#include <lagroid/solvers/integrators/splitting.hpp>
#include <lagroid/solvers/integrators/transformed.hpp>
#include <lagroid/systems/mechanical.hpp>

#include <gtest/gtest.h>
#include <unistd.h>

#include <cmath>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace lagroid {

/// A unit mass about a fixed centre.
struct Orbit : MechanicalSystem<Orbit, 2> {
  static constexpr bool attractive = true;
  static double mass() { return 1; }
  template <class S> S potential(const Vector<S, 2>& q) const {
    using std::sqrt;
    return S(-1) / sqrt(q.squaredNorm());
  }
  template <class S> Vector<S, 2> gradient(const Vector<S, 2>& q) const {
    using std::sqrt;
    const S square = q.squaredNorm();
    return q / (square * sqrt(square));
  }
  std::vector<Symmetry<Orbit>> symmetries() const {
    return {{"angular momentum", [](const Vector<double, 2>& q) { return Vector<double, 2>(-q(1), q(0)); }}};
  }
  std::vector<Quantity<Orbit>> quantities() const { return {energy_quantity(), symmetries()[0].quantity()}; }
};

struct HenonHeiles : MechanicalSystem<HenonHeiles, 2> {
  static double mass() { return 1; }
  template <class S> S potential(const Vector<S, 2>& q) const {
    return (q(0) * q(0) + q(1) * q(1)) * 0.5 + q(0) * q(0) * q(1) - q(1) * q(1) * q(1) / 3.0;
  }
};

/// Three points that attract each other, in the plane and in places times the roots of their masses.
struct ThreePoints : MechanicalSystem<ThreePoints, 6> {
  static constexpr bool attractive = true;
  Vector<double, 3> masses{1, 1, 1};
  static double mass() { return 1; }
  template <class S> Vector<S, 2> place(const Vector<S, 6>& q, int i) const {
    return q.template segment<2>(2 * i) / std::sqrt(masses(i));
  }
  template <class S> S potential(const Vector<S, 6>& q) const {
    using std::sqrt;
    S u(0.0);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < i; ++j)
        u -= S(masses(i) * masses(j)) / sqrt(Vector<S, 2>(place(q, i) - place(q, j)).squaredNorm());
    return u;
  }
  template <class S> Vector<S, 6> gradient(const Vector<S, 6>& q) const {
    using std::sqrt;
    Vector<S, 6> out = Vector<S, 6>::Constant(S(0.0));
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < i; ++j) {
        const Vector<S, 2> apart = place(q, i) - place(q, j);
        const S square = apart.squaredNorm();
        const Vector<S, 2> pull = apart * (S(masses(i) * masses(j)) / (square * sqrt(square)));
        out.template segment<2>(2 * i) += pull / std::sqrt(masses(i));
        out.template segment<2>(2 * j) -= pull / std::sqrt(masses(j));
      }
    return out;
  }
};

/// Runs the system by an integrator of this kind.
template <class Integrating, class Sys>
RunResult run_by(const Sys& system, const State<typename Sys::GroupoidType>& start, const Composition& composition,
                 IntegratorOptions how, const RunOptions<Sys>& options) {
  how.composition = composition;
  return run<Sys>(system,
                  std::make_unique<detail::IntegratorOf<Sys, Integrating>>(
                      system, start, Sys::GroupoidType::unit(start.object), composition),
                  how, options);
}
/// By composed splittings.
template <class Sys>
RunResult run_split(const Sys& system, const State<typename Sys::GroupoidType>& start, const Composition& composition,
                    const RunOptions<Sys>& options) {
  return run_by<SplittingIntegrator<Sys>>(system, start, composition, {.fixed = StepKind::splitting}, options);
}
/// In transformed time.
template <class Sys>
RunResult run_transformed(const Sys& system, const State<typename Sys::GroupoidType>& start,
                          const Composition& composition, const RunOptions<Sys>& options) {
  return run_by<TransformedIntegrator<Sys>>(system, start, composition, {.mode = TimeMode::transformed}, options);
}

/// The times at which an event happened.
inline std::vector<double> times_of(const RunResult& result, const std::string& name) {
  std::vector<double> times;
  for (const Happening& row : result.events.rows)
    if (result.events.watched[row.event].name == name) times.push_back(row.time);
  return times;
}

inline Event event_at_zero(std::string name, std::string when, Event::Direction direction = Event::Direction::both) {
  Event event{std::move(name), std::move(when)};
  event.direction = direction;
  return event;
}

/// q = cos t, by steps that are exact.
struct Turning : MechanicalSystem<Turning, 1> {
  static double mass() { return 1; }
  template <class S> S potential(const Vector<S, 1>& q) const { return q(0) * q(0) * 0.5; }
};

inline const State<Pair<2>> ellipse{{1.3, 0}, {0, 0.7}};
inline const State<Pair<1>> unit_turn{Vector<double, 1>(1.0), Vector<double, 1>(0.0)};

/// Of exact turns but for the discretisation, here 1e-13 in t.
inline RunResult turn(long steps, const std::vector<Event>& events, double h = 0.1) {
  Turning system;
  system.h = h;
  return run_split(system, unit_turn, compositions::kahan_li_8, {.steps = steps, .events = events});
}

inline std::string message_of(const std::vector<Event>& events) {
  try {
    turn(1, events);
  } catch (const RunError& error) {
    return error.what();
  }
  return "";
}

inline Event stop(Event event, long count = 1) {
  event.then = Event::Then::stop;
  event.count = count;
  return event;
}

inline std::vector<double> bits_of(const RunResult& result) {
  std::vector<double> bits = result.trajectory.time;
  for (const Columns& series : result.trajectory.series)
    bits.insert(bits.end(), series.values.begin(), series.values.end());
  for (const LedgerEntry& entry : result.ledger.entries)
    if (entry.promise != "counted") bits.push_back(entry.drift);
  return bits;
}

/// A run as a whole, and broken off after so many steps and taken up.
struct WholeAndResumed {
  RunResult whole;
  RunResult resumed;
};
template <class Sys>
WholeAndResumed whole_and_resumed(const Sys& system, const State<typename Sys::GroupoidType>& start,
                                  RunOptions<Sys> options, long broken_off) {
  const long steps = options.steps;
  WholeAndResumed out{run(system, start, options), {}};
  options.folder = std::filesystem::temp_directory_path() / ("lagroid_events_" + std::to_string(getpid()));
  std::filesystem::remove_all(options.folder);
  options.steps = broken_off;
  run(system, start, options);
  options.steps = steps;
  options.resume = true;
  out.resumed = run(system, start, options);
  std::filesystem::remove_all(options.folder);
  return out;
}

}  // namespace lagroid
