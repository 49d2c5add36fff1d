#include <lagroid/run/study/measure.hpp>

#include <lagroid/solvers/processor_time.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <random>
#include <stdexcept>
#include <utility>

namespace lagroid {

namespace {

/// Two states no larger than the motion are not farther apart, relative to its size.
constexpr double farthest_apart = 2;

constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

double seconds_since(std::chrono::steady_clock::time_point start) {
  return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

double norm(const std::vector<double>& v) {
  double square = 0;
  for (const double x : v) square += x * x;
  return std::sqrt(square);
}

double difference(const std::vector<double>& a, const std::vector<double>& b) {
  double square = 0;
  for (std::size_t i = 0; i < a.size(); ++i) square += (a[i] - b[i]) * (a[i] - b[i]);
  return std::sqrt(square);
}

/// The largest of two, NaN if either is.
double larger(double a, double b) { return std::isnan(a) || std::isnan(b) ? unknown : std::max(a, b); }

/// The least number of equal steps no longer than h.
long steps_within(double end, double h) { return std::max(1L, long(std::ceil(end / h - 1e-9))); }

const Method& of_highest_order(const Experiment& experiment) {
  const Method* best = nullptr;
  for (const Method& method : experiment.methods)
    if (method.equal_steps && !method.to_compare && (best == nullptr || method.order >= best->order)) best = &method;
  return *best;
}

/// Of scenes that refuse the step, nothing is known before it is halved: true, as most are.
bool is_symmetric(const Experiment& experiment, const Method& method, double h) {
  try {
    return experiment.begin(method, h)->traits().symmetric;
  } catch (const MethodRefused&) {
    return true;
  }
}

/// Romberg's table of states after steps h, h/2, h/4, ..., of which `rows` are computed. The error of a symmetric
/// method has even powers of the step alone.
class Extrapolated final : public Reference {
 public:
  Extrapolated(const Experiment& experiment, double budget)
      : experiment_(experiment), method_(of_highest_order(experiment)) {
    const auto start = std::chrono::steady_clock::now();
    first_step_ = experiment.step * std::sqrt(double(method_.stages));
    powers_apart_ = is_symmetric(experiment, method_, first_step_) ? 2 : 1;
    std::vector<std::vector<NamedVector>> table;
    double least = std::numeric_limits<double>::infinity();
    double most_after = 0;  // what rows beyond the best one changed
    int since_least = 0;
    double last_took = 0;
    for (int row = 0; row < 22; ++row) {
      if (row > 0 && seconds_since(start) + 2 * last_took > (row >= 3 ? budget : 2 * budget)) break;
      const auto began = std::chrono::steady_clock::now();
      const auto before = table.empty() ? std::vector<NamedVector>() : table.back();
      if (experiment.stopped()) break;
      if (!add_row(table, row, experiment.end)) continue;
      last_took = seconds_since(began);
      if (before.empty()) continue;
      const double changed = distance(table.back(), before);
      if (changed < least) {
        least = changed;
        most_after = 0;
        rows_ = row + 1;
        best_ = table.back();
        since_least = 0;
      } else {
        most_after = std::max(most_after, changed);
        if (++since_least >= 2 && least < 1e-6) break;
      }
    }
    if (best_.empty())
      throw std::domain_error(
          "no reference: the method of highest order did not reach the end with two steps within the time it has; give "
          "a larger budget, or a shorter scene");
    // The least of several changes is small by chance; one that no later row confirms is doubled.
    uncertainty = std::max(since_least > 0 ? most_after : 2 * least, 1e-15);
    seconds_elsewhere = 2 * last_took;  // the last rows anew
    description = fmt::format("{} with {} halved steps from {:.4g}, extrapolated", method_.name, rows_, first_step_);
  }

  std::vector<NamedVector> at(double time) const override {
    if (time == experiment_.end) return best_;
    std::vector<std::vector<NamedVector>> table;
    for (int row = std::max(0, rows_ - 3); row < rows_; ++row) add_row(table, row, time);
    return table.empty() ? std::vector<NamedVector>() : table.back();
  }

 private:
  /// Replaces the last row of the table by the next. The table holds one row: extrapolations of growing order.
  bool add_row(std::vector<std::vector<NamedVector>>& row, int level, double end) const {
    const auto reached = reach(experiment_, method_, end, steps_within(end, first_step_ * std::pow(0.5, level)));
    if (!reached) return false;
    std::vector<std::vector<NamedVector>> next{reached->state};
    constexpr std::size_t most = 3;  // extrapolating further multiplies round-off
    for (std::size_t k = 0; k < row.size() && k < most; ++k) {
      const double factor = std::pow(2.0, method_.order + powers_apart_ * int(k)) - 1;
      auto better = next[k];
      for (std::size_t b = 0; b < better.size(); ++b)
        for (std::size_t i = 0; i < better[b].values.size(); ++i)
          better[b].values[i] += (next[k][b].values[i] - row[k][b].values[i]) / factor;
      next.push_back(std::move(better));
    }
    row = std::move(next);
    return true;
  }

  const Experiment& experiment_;
  Method method_;
  double first_step_ = 0;
  int powers_apart_ = 2;
  int rows_ = 0;
  std::vector<NamedVector> best_;
};

class ByMethod final : public Reference {
 public:
  ByMethod(const Experiment& experiment, const Method& method, double h)
      : experiment_(experiment), method_(method), h_(h) {
    end_ = at(experiment.end);
    const auto half = reach(experiment, method, experiment.end, 2 * steps_within(experiment.end, h));
    if (!half || end_.empty())
      throw std::domain_error(fmt::format("no reference: {} with step {:g} does not reach the end", method.name, h));
    uncertainty = distance(end_, half->state);
    description = fmt::format("{} with steps of {:.6g}", method.name, h);
  }

  std::vector<NamedVector> at(double time) const override {
    if (time == experiment_.end && !end_.empty()) return end_;
    auto reached = reach(experiment_, method_, time, steps_within(time, h_));
    return reached ? std::move(reached->state) : std::vector<NamedVector>();
  }

 private:
  const Experiment& experiment_;
  Method method_;
  double h_;
  std::vector<NamedVector> end_;
};

class Known final : public Reference {
 public:
  Known(const Experiment& experiment, std::vector<NamedVector> state)
      : end_(experiment.end), state_(std::move(state)) {}
  std::vector<NamedVector> at(double time) const override { return time == end_ ? state_ : std::vector<NamedVector>(); }

 private:
  double end_;
  std::vector<NamedVector> state_;
};

/// The slope of what is watched along a run, through the means of its parts.
class Trend {
 public:
  Trend(double end, double first) : end_(end), first_(first) {}
  void see(double time, double value) {
    const auto part = std::size_t(std::clamp(time / end_ * parts, 0.0, parts - 1.0));
    sums_[part] += value - first_;
    ++counts_[part];
  }
  /// Times `end`, and its standard error.
  std::pair<double, double> slope() const {
    double mean = 0;
    for (std::size_t i = 0; i < sums_.size(); ++i) {
      if (counts_[i] == 0) return {unknown, unknown};
      mean += at(i) / parts;
    }
    double xy = 0;
    double xx = 0;
    for (std::size_t i = 0; i < sums_.size(); ++i) {
      xy += place(i) * (at(i) - mean);
      xx += place(i) * place(i);
    }
    const double slope = xy / xx;
    double rest = 0;
    for (std::size_t i = 0; i < sums_.size(); ++i) {
      const double off = at(i) - mean - slope * place(i);
      rest += off * off;
    }
    return {slope, std::sqrt(rest / (parts - 2) / xx)};
  }

 private:
  static constexpr double parts = 20;
  double at(std::size_t i) const { return sums_[i] / double(counts_[i]); }
  static double place(std::size_t i) { return (double(i) + 0.5) / parts - 0.5; }

  double end_;
  double first_;
  std::array<double, 20> sums_{};
  std::array<long, 20> counts_{};
};

/// Watches a run's invariants and constraints.
class Watch {
 public:
  Watch(double end, Measurement& out) : end_(end), out_(out) {}

  void see(const NodeObservation& now, double time) {
    if (looked_++ == 0) {
      if (now.constraint) out_.constraint = 0;
      if (!now.invariants.empty()) out_.invariants = 0;
    }
    if (now.constraint) out_.constraint = larger(out_.constraint, *now.constraint);
    for (const NamedVector& block : now.invariants) {
      auto [found, is_new] = first_.try_emplace(block.name, block);
      const NamedVector& first = found->second;
      const double of_its_own = std::max(norm(first.values), norm(block.values));
      const double size = std::max(block.size, of_its_own);
      out_.invariants = larger(out_.invariants, difference(block.values, first.values) / (size > 0 ? size : 1));
      if (block.name.starts_with("energy") && block.values.size() == 1) {
        if (is_new) trend_.emplace(end_, block.values[0]);
        energy_size_ = std::max(energy_size_, size);
        trend_->see(time, block.values[0]);
      }
    }
  }
  void finish() {
    if (!trend_) return;
    const auto [slope, error] = trend_->slope();
    out_.drift = slope / energy_size_;
    out_.drift_error = error / energy_size_;
  }

 private:
  double end_;
  Measurement& out_;
  long looked_ = 0;
  std::map<std::string, NamedVector> first_;
  std::optional<Trend> trend_;
  double energy_size_ = 0;
};

/// Which nodes of a long run are looked at: about `most` of all, at random distances, so that no motion keeps their
/// pace.
class Looks {
 public:
  explicit Looks(double steps) : distance_(1, std::max(1.0, 2 * steps / most - 1)) {}
  bool at(long step) {
    if (step < next_) return false;
    next_ = step + std::max(1L, std::lround(distance_(draw_)));
    return true;
  }

 private:
  static constexpr double most = 1e5;
  std::uniform_real_distribution<double> distance_;
  long next_ = 0;
  std::minstd_rand draw_{1};
};

}  // namespace

std::optional<Reached> reach(const Experiment& experiment, const Method& method, double end, long steps) {
  Experiment until = experiment;
  until.end = end;
  Reached out;
  try {
    const auto motion = until.begin(method, end / double(steps));
    const double begin = motion->time();
    std::vector<double> sizes;
    const auto look = [&](const std::vector<NamedVector>& state) {
      sizes.resize(state.size());
      for (std::size_t i = 0; i < state.size(); ++i) sizes[i] = std::max(sizes[i], norm(state[i].values));
    };
    look(motion->state());
    IntegrationCost work;
    const long looks = std::min(steps, 64L);
    for (long k = 1; k <= looks; ++k) {
      const double start = processor_time();
      const StepReport report = integrate_to(*motion, begin + end * double(k) / double(looks), work);
      out.seconds += processor_time() - start;
      if (!report.converged() || experiment.stopped()) return std::nullopt;
      out.state = motion->state();
      look(out.state);
    }
    for (std::size_t i = 0; i < sizes.size(); ++i) out.state[i].size = sizes[i];
  } catch (const MethodRefused&) {
    return std::nullopt;
  }
  return out;
}

double distance(const std::vector<NamedVector>& state, const std::vector<NamedVector>& truth) {
  if (state.size() != truth.size() || state.empty()) return unknown;
  double most = 0;
  for (std::size_t i = 0; i < state.size(); ++i) {
    if (state[i].values.size() != truth[i].values.size()) return unknown;
    const double scale = truth[i].size > 0 ? truth[i].size : norm(truth[i].values);
    most = larger(most, difference(state[i].values, truth[i].values) / (scale > 0 ? scale : 1));
  }
  return most;
}

double Measurement::median() const {
  if (seconds.empty()) return unknown;
  auto sorted = seconds;
  std::sort(sorted.begin(), sorted.end());
  const std::size_t middle = sorted.size() / 2;
  return sorted.size() % 2 == 1 ? sorted[middle] : 0.5 * (sorted[middle - 1] + sorted[middle]);
}

double Measurement::spread() const {
  if (seconds.size() < 4) return unknown;
  auto sorted = seconds;
  std::sort(sorted.begin(), sorted.end());
  return (sorted[3 * sorted.size() / 4] - sorted[sorted.size() / 4]) / median();
}

std::unique_ptr<Reference> extrapolated_reference(const Experiment& experiment, double budget) {
  return std::make_unique<Extrapolated>(experiment, budget);
}

std::unique_ptr<Reference> method_reference(const Experiment& experiment, const Method& method, double h) {
  return std::make_unique<ByMethod>(experiment, method, h);
}

std::unique_ptr<Reference> known_reference(const Experiment& experiment, std::vector<NamedVector> state,
                                           double uncertainty, std::string description) {
  auto known = std::make_unique<Known>(experiment, std::move(state));
  known->uncertainty = uncertainty;
  known->description = std::move(description);
  return known;
}

Measurement measure_once(const Experiment& experiment, const Method& method, double h, const Reference* reference,
                         double longest) {
  Measurement out;
  out.method = method.name;
  out.order = method.order;
  out.step = h;
  try {
    const auto motion = experiment.begin(method, h);
    const auto elapsed = [&motion, begin = motion->time()] { return motion->time() - begin; };
    Watch watch(experiment.end, out);
    watch.see(observation_of(*motion), 0);
    StepReport report;
    report.status = SolveStatus::converged;
    const double start = processor_time();
    // Varying steps are first ones: the last node may lie anywhere within half a step of the end.
    double last_step = h;
    Looks looks(experiment.end / h);
    while (experiment.end - elapsed() > 0.5 * last_step) {
      const double before = elapsed();
      report = advance(*motion, out.work);
      if (!report.converged()) break;
      last_step = elapsed() - before;
      if (looks.at(out.work.steps)) watch.see(observation_of(*motion), elapsed());
      if (out.work.steps % 64 != 0) continue;
      if (processor_time() - start > 8 * longest || experiment.stopped()) {
        out.status = experiment.stopped() ? "interrupted" : "too slow";
        return out;
      }
    }
    out.seconds = {processor_time() - start};
    out.reached = elapsed();
    watch.finish();
    if (!report.converged()) {
      out.status = std::string(to_string(report.status));
      out.message = fmt::format("step {} of {}", out.work.steps + 1, std::lround(experiment.end / h));
      return out;
    }
    const bool at_end = method.equal_steps || std::abs(out.reached - experiment.end) <= 1e-12 * experiment.end;
    if (reference != nullptr)
      out.trajectory = distance(motion->state(), reference->at(at_end ? experiment.end : out.reached));
    if (reference != nullptr && method.equal_steps && !std::isfinite(out.trajectory)) {
      out.status = std::string(to_string(SolveStatus::not_finite));
      out.message = "the state at the end is not finite";
    } else if (out.trajectory > farthest_apart) {
      out.status = astray_status;
      out.message = fmt::format("its error is {:.2g} times the size of the motion", out.trajectory);
    }
  } catch (const MethodRefused& error) {
    out.status = "refused";
    out.message = error.what();
  }
  return out;
}

double time_once(const Experiment& experiment, const Method& method, double h) {
  // A clock takes about a microsecond to read; short runs are repeated until their sum is long against that.
  constexpr double long_enough = 1e-3;
  double total = 0;
  long runs = 0;
  do {
    const auto motion = experiment.begin(method, h);
    IntegrationCost work;
    const double start = processor_time();
    if (!integrate_to(*motion, motion->time() + experiment.end, work).converged()) return -1;
    total += processor_time() - start;
    ++runs;
  } while (total < long_enough && runs < 20);
  return total / double(runs);
}

}  // namespace lagroid
