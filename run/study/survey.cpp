#include <lagroid/run/study/survey.hpp>

#include <lagroid/run/reports/clock.hpp>
#include <lagroid/solvers/ensemble/tasks.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <iterator>
#include <limits>
#include <optional>
#include <string>
#include <utility>

namespace lagroid {

namespace {

constexpr double looking_ends = 2.0 / 3;  // of the budget; the rest is for timing
constexpr double hopeless = 10;           // so many times as dear as another method with no larger error
constexpr double near_front = 4;          // times the least cost
constexpr double meaningful = 0.1;        // errors above it follow no order

bool has_error(const Measurement& m) { return m.converged() && std::isfinite(m.trajectory); }

/// A method on its way to smaller steps.
class Descent {
 public:
  Descent(const Experiment& experiment, const Method& method, const Steps& steps, const Reference& reference)
      : experiment_(experiment),
        method_(method),
        steps_(steps),
        compared_in_(method.equal_steps ? 0 : reference.seconds_elsewhere) {}

  const Method& method() const { return method_; }
  bool done() const { return done_; }
  void stop() { done_ = true; }
  double next_step() const {
    if (!steps_.sizes.empty())
      return experiment_.end / std::max(1.0, std::round(experiment_.end / steps_.sizes[std::size_t(level_)]));
    const double coarse = std::min(16 * experiment_.step * std::sqrt(double(method_.stages)), experiment_.end / 4);
    return experiment_.end / std::ceil(experiment_.end / (coarse * std::pow(0.5, level_)) - 1e-9);
  }

  /// What the next run takes, by the last one: wall time with all that is looked at, and with the reference's where the
  /// run will not end at the end.
  double next_takes() const {
    return compared_in_ + (runs.empty() ? 0 : std::max(0.0, took_ - compared_in_) * runs.back().step / next_step());
  }
  /// Its processor time alone, and the error that the order promises; none where the last run says nothing of it.
  struct Expected {
    double seconds, error;
  };
  std::optional<Expected> expected() const {
    if (runs.empty() || !has_error(runs.back()) || runs.back().trajectory > meaningful) return std::nullopt;
    const Measurement& last = runs.back();
    const double finer = last.step / next_step();
    return Expected{last.median() * finer, last.trajectory / std::pow(finer, method_.order)};
  }

  /// Makes the next run, which is forgotten where it takes longer than runs may, or than the budget has, or is
  /// interrupted.
  void run(const Reference& reference, const Budget& budget) {
    const double began = budget.spent();
    // Looks may cost much more than the steps between them.
    constexpr double looks = 8;
    const double most = budget.left() / looks;
    const double longest = steps_.sizes.empty() ? std::min(steps_.longest, most) : most;
    Measurement m = measure_once(experiment_, method_, next_step(), &reference, longest);
    if (m.status == "interrupted") return;
    if (m.status == "too slow") {
      done_ = true;
      out_of_time_ = !steps_.sizes.empty() || longest < steps_.longest;
      return;
    }
    const double looked = m.seconds.empty() ? 0 : m.seconds.front();
    if (m.converged()) {
      const double alone = time_once(experiment_, method_, m.step);
      if (alone >= 0) m.seconds = {alone};
    }
    took_ = budget.spent() - began;
    ++level_;
    runs.push_back(std::move(m));
    done_ = steps_.sizes.empty() ? is_at_its_end(reference, looked) : level_ == int(steps_.sizes.size());
  }
  /// Whether it ended because a run took more time than there was.
  bool out_of_time() const { return out_of_time_; }

  std::vector<Measurement> runs;

 private:
  /// Whether smaller steps gain nothing, take too long, or none gets through.
  bool is_at_its_end(const Reference& reference, double looked) {
    const Measurement& last = runs.back();
    if (level_ == 20) return true;
    if (!last.converged()) {
      if (last.status != astray_status) ++failed_;
      return failed_ == 6;
    }
    failed_ = 0;
    if (last.trajectory < 2 * std::max(reference.uncertainty, 1e-15)) return true;
    not_better_ = last.trajectory > 0.7 * least_ ? not_better_ + 1 : 0;
    if (not_better_ >= 2 && least_ < 1e-8) return true;
    least_ = std::min(least_, last.trajectory);
    return looked > steps_.longest / 2;
  }

  const Experiment& experiment_;
  const Method& method_;
  const Steps& steps_;
  double compared_in_;
  bool done_ = false;
  bool out_of_time_ = false;
  int level_ = 0;
  int failed_ = 0;
  int not_better_ = 0;
  double least_ = std::numeric_limits<double>::infinity();
  double took_ = 0;
};

/// The cheapest run with no larger an error; null where there is none.
const Measurement* cheapest_below(const std::vector<Descent>& all, double error) {
  const Measurement* best = nullptr;
  for (const Descent& each : all)
    for (const Measurement& m : each.runs)
      if (has_error(m) && m.trajectory <= error && (best == nullptr || m.median() < best->median())) best = &m;
  return best;
}

/// How many times dearer the next run of a method is than what another has reached already; 0: none has, 1: nobody
/// knows.
struct Prospect {
  Descent* descent;
  double times_dearer = 1;
  std::string than{};
  double error = 0;
};

Prospect prospect_of(Descent& each, const std::vector<Descent>& all) {
  const auto expected = each.expected();
  if (!expected) return {&each};
  const Measurement* rival = cheapest_below(all, expected->error);
  if (rival == nullptr) return {&each, 0, {}, expected->error};
  return {&each, expected->seconds / rival->median(), rival->method, expected->error};
}

double seconds_of(const std::vector<Prospect>& round) {
  double sum = 0;
  double most = 0;
  for (const Prospect& p : round) {
    sum += p.descent->next_takes();
    most = std::max(most, p.descent->next_takes());
  }
  return std::max(most, sum / available_threads());
}

/// What is worth its time; the rest is stopped, and said to be left out.
std::vector<Prospect> worth_a_run(std::vector<Descent>& all, bool may_give_up, double time,
                                  std::vector<LeftOut>& left_out) {
  // For each run that does not end at the end the reference is computed anew, which may take as long as all others
  // together: methods of unequal steps have what time the others leave.
  const bool equal_left = std::any_of(all.begin(), all.end(),
                                      [](const Descent& each) { return !each.done() && each.method().equal_steps; });
  std::vector<Prospect> round;
  for (Descent& each : all)
    if (!each.done() && each.method().equal_steps == equal_left) round.push_back(prospect_of(each, all));
  const auto leave_out = [&](const Prospect& p, const std::string& why) {
    left_out.push_back({p.descent->method().name, p.descent->next_step(), why});
    p.descent->stop();
  };
  if (may_give_up && seconds_of(round) > 0.25 * time)
    std::erase_if(round, [&](const Prospect& p) {
      if (p.times_dearer <= hopeless) return false;
      leave_out(p,
                fmt::format("about {:.2g} times as dear as {} at an error of {:.0e}", p.times_dearer, p.than, p.error));
      return true;
    });
  std::stable_sort(round.begin(), round.end(),
                   [](const Prospect& a, const Prospect& b) { return a.times_dearer < b.times_dearer; });
  while (!round.empty() && seconds_of(round) > time) {
    leave_out(round.back(), fmt::format("a run of about {}, for which there was no time",
                                        duration(round.back().descent->next_takes())));
    round.pop_back();
  }
  return round;
}

/// Times each run so many times, interleaved; false where it was told to stop, or time is over.
bool time_runs(const Experiment& experiment, const std::vector<std::pair<Measurement*, const Method*>>& runs,
               int repetitions, const Budget& budget, const std::function<bool(double)>& report) {
  for (int r = 0; r < repetitions; ++r) {
    for (const auto& [m, method] : runs) {
      // One run may be repeated until it is long enough for the clock.
      if (experiment.stopped() || budget.left() < 2 * std::max(m->median(), 1e-3)) continue;
      const double took = time_once(experiment, *method, m->step);
      if (r == 0) m->seconds.clear();  // taken beside others
      if (took >= 0) m->seconds.push_back(took);
    }
    if (!report(budget.spent() / budget.seconds())) return false;
  }
  return true;
}

}  // namespace

Experiment within(Experiment experiment, const Budget& budget) {
  experiment.interrupted = [asked = std::move(experiment.interrupted), &budget] {
    return budget.over() || (asked && asked());
  };
  return experiment;
}

Survey survey(const Experiment& experiment, const std::vector<Method>& methods, const Steps& steps,
              const Reference& reference, int repetitions, const Budget& budget,
              const std::function<bool(double spent)>& report) {
  std::vector<Descent> all;
  for (const Method& method : methods) all.emplace_back(experiment, method, steps, reference);
  Survey out;
  bool go_on = true;
  while (go_on) {
    const double time = looking_ends * budget.seconds() - budget.spent();
    const auto round = worth_a_run(all, steps.sizes.empty(), time, out.left_out);
    if (round.empty()) break;
    for_each_task(
        long(round.size()), 0, [&](long i) { round[std::size_t(i)].descent->run(reference, budget); },
        [&] { return experiment.stopped(); });
    for (const Prospect& p : round)
      if (p.descent->out_of_time())
        out.left_out.push_back({p.descent->method().name, p.descent->next_step(), "a run longer than the budget"});
    go_on = report(budget.spent() / budget.seconds()) && !experiment.stopped();
  }
  for (const Descent& each : all)
    if (!each.done() && budget.over())
      out.left_out.push_back({each.method().name, each.next_step(), "the budget was over"});
  std::vector<std::pair<Measurement*, const Method*>> near, far;
  for (Descent& each : all)
    for (Measurement& m : each.runs) {
      if (!m.converged()) continue;
      const Measurement* best = has_error(m) ? cheapest_below(all, m.trajectory) : nullptr;
      const bool is_near = best == nullptr || m.median() <= near_front * best->median();
      (is_near ? near : far).emplace_back(&m, &each.method());
    }
  if (go_on && time_runs(experiment, near, repetitions, budget, report))
    time_runs(experiment, far, repetitions, budget, report);
  for (Descent& each : all)
    out.runs.insert(out.runs.end(), std::make_move_iterator(each.runs.begin()),
                    std::make_move_iterator(each.runs.end()));
  return out;
}

}  // namespace lagroid
