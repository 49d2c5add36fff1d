#include <lagroid/solvers/sensitivity/growth/growth.hpp>
#include <lagroid/solvers/sensitivity/propagate.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <memory>
#include <stdexcept>
#include <utility>
#include <vector>

namespace lagroid {

namespace {

/// binomial(s + r, s), or a number too large to matter.
double binomial(long s, long r) {
  double out = 1;
  for (long i = 1; i <= r && out < 1e18; ++i) out = out * double(s + i) / double(i);
  return std::round(out);
}

/// Of `steps` steps, more than one, those to take before the next state is kept, with `states` states in all, the one
/// at the start among them. With r repeats they reach binomial(s + r, s) = binomial(s + r - 1, s) + binomial(s + r - 1,
/// s - 1) steps: the first term is what is left of them once more, the second what the other states reach.
long first_part(long steps, long states) {
  long repeats = 1;
  while (binomial(states, repeats) < double(steps)) ++repeats;
  double part = binomial(states, repeats - 1);
  // Of two repeats, the shortest p with p (states - p) >= steps does as well, and fewer states are at work at a time.
  const double slack = double(states) * double(states) - 4 * double(steps);
  if (repeats == 2 && slack >= 0) part = std::ceil(0.5 * (double(states) - std::sqrt(slack)));
  return long(std::clamp(part, 1.0, double(steps - 1)));
}

/// The weight of a node in what is observed, over a run of equal steps.
double weight_of(const Observed& observed, long node, long steps, double duration) {
  if (observed.kind == Observed::Kind::integral)
    return duration / double(steps) * (node == 0 || node == steps ? 0.5 : 1.0);
  return node == (observed.node < 0 ? steps : observed.node) ? 1.0 : 0.0;
}

/// Throws std::invalid_argument for a node that the run does not have, and for an integral whose weights vary.
void require_observable(const Observed& observed, const LinearisedMotion& motion, long steps) {
  if (steps < 0) throw std::invalid_argument("a run has zero steps or more");
  if (observed.kind == Observed::Kind::at_node && observed.node > steps)
    throw std::invalid_argument(fmt::format("node {} of a run of {} steps", observed.node, steps));
  if (observed.kind == Observed::Kind::integral && !motion.has_equal_steps())
    throw std::invalid_argument("integrals over steps whose sizes vary have no derivative here: observe a node");
}

std::string failure(const StepReport& report, double time) {
  if (report.status == SolveStatus::no_step)
    return fmt::format(
        "the step at t = {:.6g} has no root: no size near that of the last step solves its equations; take another "
        "first step, or equal ones",
        time);
  const bool is_too_long = report.status == SolveStatus::not_converged || report.status == SolveStatus::stagnated ||
                           report.status == SolveStatus::not_finite;
  return fmt::format("the step at t = {:.6g} failed: {}{}", time, to_string(report.status),
                     is_too_long ? "; use a smaller step" : "");
}

/// Takes down what a step is like that begins at this time; whether it converged.
bool note(const StepReport& report, double time, Propagated& out) {
  ++out.steps_solved;
  if (report.converged()) return true;
  out.status = report.status;
  out.message = failure(report, time);
  return false;
}
/// Goes on by steps until one fails.
bool advance(LinearisedMotion& motion, long steps, Propagated& out) {
  for (long k = 0; k < steps; ++k)
    if (const double time = motion.time(); !note(motion.pass(), time, out)) return false;
  return true;
}
/// One step, linearised.
bool advance_linearised(LinearisedMotion& motion, Propagated& out) {
  if (const double time = motion.time(); !note(motion.advance(), time, out)) return false;
  if (motion.linearise()) return true;
  out.status = SolveStatus::singular;
  out.message = fmt::format("the step before t = {:.6g} has no derivative: its equations are singular", motion.time());
  return false;
}

/// How long the run takes, which the weights of an integral ask for: steps are equal.
double duration_of(LinearisedMotion& motion, long steps, const Observed& observed, Propagated& out) {
  if (observed.kind != Observed::Kind::integral || steps == 0) return 0;
  const std::vector<double> start = motion.save();
  const double begun = motion.time();
  if (!advance(motion, 1, out)) return 0;
  const double step = motion.time() - begun;
  motion.restore(start);
  return double(steps) * step;
}

/// Of the states alone: what a small change of them becomes in the last step. Few columns at a time stay in the cache.
void find_matrix_of_the_step(const LinearisedMotion& motion, Eigen::MatrixXd& out) {
  constexpr Eigen::Index at_once = 8;
  const Eigen::Index states = motion.states();
  out.resize(states, states);
  for (Eigen::Index first = 0; first < states; first += at_once) {
    const Eigen::Index count = std::min(at_once, states - first);
    Eigen::MatrixXd some = Eigen::MatrixXd::Zero(states + motion.parameters(), count);
    some.middleRows(first, count).setIdentity();
    for (int stage = 0; stage < motion.stages(); ++stage) motion.stage(stage).go_forward(some);
    out.middleCols(first, count) = some.topRows(states);
  }
}

/// Columns of directions that are errors of the start alone; of others alone all of them. A parameter may do little at
/// first and much later, as a spring's stiffness from its rest, and this is no growth of errors.
std::vector<Eigen::Index> columns_of_the_start(const Eigen::MatrixXd& directions, Eigen::Index states) {
  std::vector<Eigen::Index> start, all;
  for (Eigen::Index j = 0; j < directions.cols(); ++j) {
    all.push_back(j);
    if (directions.col(j).tail(directions.rows() - states).isZero(0)) start.push_back(j);
  }
  return start.empty() ? all : start;
}

/// The motion in reverse, from nodes kept on the way. Where the present step ends is kept beside them, so that a motion
/// can take gradients back over it without making it again.
class Reversal {
 public:
  Reversal(LinearisedMotion& motion, long steps, const Observed& observed, double duration, Propagated& out)
      : motion_(motion), steps_(steps), observed_(observed), duration_(duration), out_(out) {}

  /// The steps from `from` to `to`; `start` is the node at `from`, and as many more may be kept.
  bool reverse(long from, long to, const KeptNode& start, long more) {
    while (to - from > 1) {
      if (more == 0) {
        for (; to - from > 1; --to) {
          if (!go(from, to - 1, start)) return false;
          if (!motion_.takes_back()) {
            if (!step(to - 1, start)) return false;  // it stands there
            continue;
          }
          motion_.keep_node(last_);
          if (!step(to - 1, *last_)) return false;
          std::swap(last_, end_);
        }
        break;
      }
      const long middle = from + first_part(to - from, more + 1);
      if (!go(from, middle, start)) return false;
      std::unique_ptr<KeptNode> kept = spare();
      motion_.keep_node(kept);
      out_.states_kept = std::max(out_.states_kept, ++kept_);
      if (!reverse(middle, to, *kept, more - 1)) return false;
      --kept_;
      std::swap(kept, end_);
      if (kept) spare_.push_back(std::move(kept));
      to = middle;
    }
    return step(from, start);
  }

  /// What is observed at the present node is added.
  void observe(long node) {
    const double weight = weight_of(observed_, node, steps_, duration_);
    if (weight == 0) return;
    const NodeValues here = motion_.observe();
    if (gradients_.size() == 0) {
      gradients_ = Eigen::MatrixXd::Zero(here.derivatives.cols(), here.derivatives.rows());
      out_.values = Eigen::VectorXd::Zero(here.values.size());
    }
    out_.values += weight * here.values;
    gradients_ += weight * here.derivatives.transpose();
    const Eigen::MatrixXd states = gradients_.topRows(motion_.states()).cwiseAbs();
    first_ = first_.size() == 0 ? states : first_.cwiseMax(states).eval();
    if (peak_.size() == 0) peak_ = first_;
  }
  const Eigen::MatrixXd& gradients() const { return gradients_; }
  /// By which factor, in units of the motion's own: gradients are measured in their inverses.
  double growth() const { return largest_ratio(first_, peak_, units_.of(first_.rows())); }

 private:
  /// The motion stands at `from`, or returns there, and goes on to `to`.
  bool go(long from, long to, const KeptNode& start) {
    if (at_ != from) motion_.return_to(start);
    at_ = to;
    return advance(motion_, to - from, out_);
  }
  /// The step after `from` is made again, to be linearised.
  bool make(long from, const KeptNode& start) {
    if (at_ != from) motion_.return_to(start);
    at_ = from + 1;
    return advance_linearised(motion_, out_);
  }
  /// The gradients go back over the step after `from`.
  bool step(long from, const KeptNode& start) {
    const bool is_observed = weight_of(observed_, from + 1, steps_, duration_) != 0;
    const bool nothing_yet = !is_observed && gradients_.size() == 0;
    const bool wants_matrix = !nothing_yet && units_.wants_matrix();
    if (nothing_yet || is_observed || wants_matrix || !end_ || !motion_.take_back(start, *end_, gradients_)) {
      if (!make(from, start)) return false;
      observe(from + 1);
      if (gradients_.size() == 0) return true;
      for (int k = motion_.stages(); k-- > 0;) motion_.stage(k).go_back(gradients_);
      if (wants_matrix) {
        find_matrix_of_the_step(motion_, matrix_);
        units_.see(matrix_);
      }
    }
    peak_ = peak_.cwiseMax(gradients_.topRows(motion_.states()).cwiseAbs());
    return true;
  }
  /// A node's memory that is not in use, if there is any.
  std::unique_ptr<KeptNode> spare() {
    if (spare_.empty()) return nullptr;
    std::unique_ptr<KeptNode> out = std::move(spare_.back());
    spare_.pop_back();
    return out;
  }

  LinearisedMotion& motion_;
  long steps_;
  Observed observed_;
  double duration_;
  Propagated& out_;
  long kept_ = 1;
  long at_ = 0;                     ///< the node where the motion stands
  std::unique_ptr<KeptNode> end_;   ///< where the present step ends; none of the last step of all
  std::unique_ptr<KeptNode> last_;  ///< where it begins, between nodes kept on the way
  std::vector<std::unique_ptr<KeptNode>> spare_;
  Eigen::MatrixXd gradients_;
  Eigen::MatrixXd first_;  ///< the largest that they were where something was observed, entry by entry
  Eigen::MatrixXd peak_;   ///< and anywhere
  OwnUnits units_;
  Eigen::MatrixXd matrix_;
};

}  // namespace

StateBudget StateBudget::logarithmic(long steps) {
  return {std::max(2L, long(std::ceil(2 * std::log2(double(std::max(steps, 2L))))))};
}

double Propagated::digits_left() const {
  return std::max(0.0, -std::log10(std::numeric_limits<double>::epsilon() * std::max(growth, 1.0)));
}

Propagated propagate_forward(LinearisedMotion& motion, long steps, const Eigen::MatrixXd& directions,
                             const Observed& observed) {
  require_observable(observed, motion, steps);
  Propagated out;
  out.states_kept = 1;
  out.end = directions;
  const Eigen::Index states = motion.states();
  Growth growth(directions, states, columns_of_the_start(directions, states));
  Eigen::MatrixXd matrix;
  const double duration = duration_of(motion, steps, observed, out);
  const auto observe = [&](long node) {
    const double weight = weight_of(observed, node, steps, duration);
    if (weight == 0) return;
    const NodeValues here = motion.observe();
    if (out.values.size() == 0) {
      out.values = Eigen::VectorXd::Zero(here.values.size());
      out.derivatives = Eigen::MatrixXd::Zero(here.values.size(), directions.cols());
    }
    out.values += weight * here.values;
    out.derivatives += weight * (here.derivatives * out.end);
  };
  if (!out.converged()) return out;
  observe(0);
  for (long k = 0; k < steps; ++k) {
    if (directions.cols() == 0) {
      if (!advance(motion, 1, out)) break;
      observe(k + 1);
      continue;
    }
    if (!advance_linearised(motion, out)) break;
    for (int stage = 0; stage < motion.stages(); ++stage) motion.stage(stage).go_forward(out.end);
    growth.after_a_step(out.end);
    if (growth.wants_matrix()) {
      find_matrix_of_the_step(motion, matrix);
      growth.see(matrix);
    }
    observe(k + 1);
  }
  out.growth = growth.largest();
  return out;
}

Propagated propagate_backward(LinearisedMotion& motion, long steps, const Observed& observed, StateBudget budget) {
  require_observable(observed, motion, steps);
  Propagated out;
  out.states_kept = 1;
  if (budget.states == 0) budget.states = long(std::ceil(2 * std::sqrt(double(steps))));
  std::unique_ptr<KeptNode> start;
  motion.keep_node(start);
  const double duration = duration_of(motion, steps, observed, out);
  if (!out.converged()) return out;
  Reversal reversal(motion, steps, observed, duration, out);
  if (steps > 0 && !reversal.reverse(0, steps, *start, std::max(0L, budget.states - 1))) return out;
  motion.return_to(*start);
  reversal.observe(0);
  out.growth = reversal.growth();
  out.derivatives = reversal.gradients().transpose();
  return out;
}

}  // namespace lagroid
