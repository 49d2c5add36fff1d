#pragma once
/// What is compared: an initial-value problem, those who solve it, and what a run of theirs comes to.
///
/// A problem is written once, as a class P over any real number S, in plain arrays, so that no peer pays for ours:
///
///     static constexpr int unknowns, compared, invariants
///     std::array<double, unknowns> start() const
///     void operator()(const std::array<S, unknowns>& y, std::array<S, unknowns>& dy) const    y' = f(y)
///     std::array<S, compared> coordinates(const std::array<S, unknowns>& y) const             what all can tell of y
///     S distance(const std::array<S, compared>& a, const std::array<S, compared>& b) const    the error of a
///     std::array<S, invariants> kept(const std::array<S, compared>& c) const                  constants over their
///     sizes double unit() const                                                                     the longest step
///     to try
///
/// and, where y is bound to a submanifold, `void project(std::array<S, unknowns>& y) const`.

#include "../../../solvers/processor_time.hpp"

#include <array>
#include <cmath>
#include <functional>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace peers {

/// What a run came to.
struct Outcome {
  std::vector<double> state;  ///< the coordinates that are compared
  double drift = 0;           ///< the largest error of an invariant seen, at the end and at every 64th step
  long steps = 0;
  std::string failure = {};  ///< empty where it reached the end
};

/// A run that is ready to start. It is timed, and runs once.
using Task = std::function<Outcome()>;

/// One who solves a problem with a step or a tolerance.
struct Method {
  std::string library;
  std::string name;
  bool tolerance;   ///< whether what is set is a tolerance, not a step
  double coarsest;  ///< the first setting to try
  double ratio;     ///< of a setting to the next, finer one
  std::function<Task(double end, double setting)> begin;
  bool beyond = false;  ///< what a library has besides the methods that our goals name (docs/peers.md)
};

inline constexpr const char* ours = "Lagroid";

struct Reference {
  std::vector<double> state;
  double uncertainty = 0;
};

/// A problem and all who solve it.
struct Problem {
  std::string name;   ///< on the command line
  std::string title;  ///< on the page
  std::vector<double> ends;
  std::vector<Method> methods;
  std::function<Reference(double end)> reference;
  std::function<double(const std::vector<double>&, const std::vector<double>&)> distance;
  std::string remarks = {};
};

Problem rigid_body();
Problem kepler();
Problem pendulum();
Problem spherical_pendulum();
Problem top();
Problem chain();

/// |a - b| over the coordinates from `first` to before `last`.
template <class S, std::size_t N>
S distance_over(const std::array<S, N>& a, const std::array<S, N>& b, int first, int last) {
  using std::sqrt;
  S sum = 0;
  for (auto i = std::size_t(first); i < std::size_t(last); ++i) sum += (a[i] - b[i]) * (a[i] - b[i]);
  return sqrt(sum);
}

/// The ratio of steps by which a method of this order gains a digit, at least one and a third and at most two.
inline double ladder(double order) { return std::fmin(2, std::fmax(4.0 / 3, std::pow(10, 1 / order))); }

using lagroid::processor_time;

inline constexpr double longest_run = 5;  ///< s; one that takes longer is given up
inline constexpr const char* took_too_long = "took too long";

/// Follows the invariants along a run.
template <class P> class Watch {
 public:
  using Coordinates = std::array<double, P::compared>;

  explicit Watch(const P& problem) : problem_(problem), first_(problem.kept(problem.coordinates(problem.start()))) {}

  /// After a step; `coordinates` tells where it led. Throws std::runtime_error where the run takes too long.
  template <class F> void step(const F& coordinates) {
    if ((++steps_ & 63) != 0) return;
    look(coordinates());
    if ((steps_ & 4095) == 0 && processor_time() - begun_ > longest_run) throw std::runtime_error(took_too_long);
  }
  Outcome finish(const Coordinates& end) {
    look(end);
    Outcome out{{end.begin(), end.end()}, drift_, steps_};
    for (const double x : end)
      if (!std::isfinite(x)) out.failure = "not finite";
    return out;
  }
  Outcome fail(const Coordinates& last, std::string why) {
    Outcome out = finish(last);
    out.failure = std::move(why);
    return out;
  }

 private:
  void look(const Coordinates& at) {
    const auto now = problem_.kept(at);
    for (std::size_t i = 0; i < now.size(); ++i) drift_ = std::fmax(drift_, std::fabs(now[i] - first_[i]));
  }

  P problem_;
  std::array<double, P::invariants> first_;
  double drift_ = 0;
  double begun_ = processor_time();
  long steps_ = 0;
};

/// Equal steps of an engine. `begin(h)` prepares a run and returns a pair: what takes a step, and may throw
/// std::runtime_error, and what tells the coordinates reached.
template <class P, class Begin>
Method engine_steps(const P& problem, std::string library, std::string name, double order, double coarsest,
                    const Begin& begin) {
  return {std::move(library), std::move(name), false, coarsest, ladder(order), [=](double end, double setting) -> Task {
            const long steps = std::lround(end / setting);
            return [=, run = begin(end / double(steps))] {
              const auto& [step, coordinates] = run;
              Watch<P> watch(problem);
              for (long i = 0; i < steps; ++i) {
                step();
                watch.step(coordinates);
              }
              return watch.finish(coordinates());
            };
          }};
}

}  // namespace peers
