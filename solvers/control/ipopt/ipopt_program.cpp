#include <lagroid/solvers/control/ipopt/ipopt_program.hpp>

#include <algorithm>
#include <cmath>
#include <random>
#include <utility>

namespace lagroid {

namespace {

constexpr double round_off = 1e-12;  // of an entry that is left out

void scale(StageRows& rows, double factor) {
  for (double& x : rows.numbers()) x *= factor;
}

}  // namespace

ControlProgram::ControlProgram(TrajectoryChart& chart, Blocks blocks, std::function<bool()> keep_going)
    : chart_(chart),
      keep_going_(std::move(keep_going)),
      sizes_(chart.transcription().sizes()),
      before_bounds_(chart.inequalities_before_bounds()),
      at_(sizes_),
      values_(sizes_),
      derivatives_(sizes_),
      first_(sizes_.stages + 1, sizes_.node * sizes_.node),
      second_(sizes_.stages + 1, sizes_.node * sizes_.node * sizes_.node),
      costates_(sizes_.stages, sizes_.equality),
      multipliers_(sizes_.stages, sizes_.inequality) {
  const long stages = sizes_.stages;
  const auto d = std::size_t(sizes_.variables());
  rows_.resize(std::size_t(sizes_.equality + before_bounds_ + 1) * d);
  block_.resize(d * d);
  half_.resize(d * d);
  for (long k = 0; k <= stages; ++k) {
    if (k > 0)
      for (int i = 0; i < sizes_.control; ++i)
        control_place_.push_back(sizes_.control_is_fixed(k - 1, i) ? -1 : unknowns_++);
    for (int i = 0; i < sizes_.node; ++i) {
      const bool is_free = (k > 0 || transcription().free_start()[std::size_t(i)]) &&
                           (k < stages || transcription().free_end()[std::size_t(i)]);
      node_place_.push_back(is_free ? unknowns_++ : -1);
    }
  }
  for (const TranscriptionPhase& each : sizes_.phases)
    duration_place_.push_back(each.duration_is_free ? unknowns_++ : -1);
  first_row_.push_back(0);
  for (long k = 0; k < stages; ++k) first_row_.push_back(first_row_.back() + sizes_.equalities_of(k) + before_bounds_);
  int bound = before_bounds_;
  for (int i = 0; i < sizes_.control; ++i)
    for (const bool is_upper : {true, false}) {
      const auto is_bounded = [&](const TranscriptionPhase& phase) {
        const TrajectoryChart::Range range = chart_.control_range(phase.end - 1, i);
        return std::isfinite(is_upper ? range.most : range.least) && range.least < range.most;
      };
      const bool any = std::any_of(sizes_.phases.begin(), sizes_.phases.end(), is_bounded);
      bound_row_.push_back(any ? bound++ : -1);
    }
  is_in_rows_.assign(std::size_t(sizes_.equality + before_bounds_) * d, blocks == Blocks::whole);
  is_in_hessian_.assign(d * d, blocks == Blocks::whole);
  if (blocks == Blocks::sparse) find_entries();
  for (std::size_t at = 0; at < is_in_rows_.size(); ++at)
    if (is_in_rows_[at] != 0) in_rows_.emplace_back(int(at / d), int(at % d));
  for (std::size_t at = 0; at < is_in_hessian_.size(); ++at)
    if (is_in_hessian_[at] != 0 && at % d <= at / d) in_hessian_.emplace_back(int(at / d), int(at % d));
}

ControlProgram::Index ControlProgram::place(long stage, int variable) const {
  const int n = sizes_.node;
  if (variable < 2 * n) return node_place_[std::size_t(stage * n + variable)];
  if (variable < sizes_.at_duration())
    return control_place_[std::size_t(stage * sizes_.control + variable - sizes_.at_control())];
  return duration_place_[std::size_t(sizes_.phase_of(stage))];
}

/// Marks what is not zero at a trajectory bent at random, of multipliers at random.
void ControlProgram::find_entries() {
  std::mt19937_64 generator(1);
  std::uniform_real_distribution<double> uniform(0.5, 1.5);
  std::vector<Number> x(std::size_t(unknowns_), 0);
  for (Number& each : x) each = 0.1 * (uniform(generator) - 1);
  std::vector<Number> multipliers(std::size_t(first_row(sizes_.stages)));
  for (Number& each : multipliers) each = uniform(generator);
  move_to(x.data(), true);
  evaluate_hessians(1, multipliers.data());
  const int d = sizes_.variables();
  for (long k = 0; k < sizes_.stages; ++k) {
    pull_back_rows(k);
    pull_back_hessian(k, 1);
    for (std::size_t at = 0; at < is_in_rows_.size(); ++at)
      if (rows_[at] != 0) is_in_rows_[at] = 1;
    for (int r = 0; r < d; ++r)
      for (int q = 0; q <= r; ++q)
        if (block_[std::size_t(r * d + q)] != 0) is_in_hessian_[std::size_t(r * d + q)] = 1;
  }
  stands_ = false;
}

// ---- where it stands

void ControlProgram::move_to(const Number* x, bool is_new) {
  if (stands_ && !is_new) return;
  stands_ = true;
  has_values_ = has_derivatives_ = false;
  for (std::size_t i = 0; i < node_place_.size(); ++i)
    at_.nodes.numbers()[i] = node_place_[i] < 0 ? 0 : x[node_place_[i]];
  for (std::size_t i = 0; i < control_place_.size(); ++i)
    at_.controls.numbers()[i] = control_place_[i] < 0 ? 0 : x[control_place_[i]];
  for (std::size_t p = 0; p < duration_place_.size(); ++p)
    at_.durations[p] = duration_place_[p] < 0 ? 0 : x[duration_place_[p]];
  chart_.stand_at(at_);
}

void ControlProgram::evaluate_values() {
  if (!has_values_) transcription().values(values_);
  has_values_ = true;
}

/// Of costs and constraints, and of the retractions; of no multipliers.
void ControlProgram::evaluate_derivatives() {
  if (has_derivatives_) return;
  set_all(costates_, 0);
  set_all(multipliers_, 0);
  transcription().derivatives(costates_, multipliers_, derivatives_);
  for (long k = 0; k <= sizes_.stages; ++k) chart_.retraction(k, at_.nodes[k], {first_[k], second_[k]});
  has_derivatives_ = true;
}

/// The stages' Hessians of factor l + <lambda, phi> + <z, gamma>.
void ControlProgram::evaluate_hessians(double factor, const Number* multipliers) {
  evaluate_derivatives();
  take(multipliers);
  if (factor != 0) {
    scale(costates_, 1 / factor);
    scale(multipliers_, 1 / factor);
    transcription().derivatives(costates_, multipliers_, derivatives_);
    scale(derivatives_.hessian, factor);
    take(multipliers);
    return;
  }
  transcription().derivatives(costates_, multipliers_, derivatives_);
  without_ = derivatives_.hessian;
  set_all(costates_, 0);
  set_all(multipliers_, 0);
  transcription().derivatives(costates_, multipliers_, derivatives_);
  std::swap(without_, derivatives_.hessian);
  add(derivatives_.hessian, -1, without_);
  take(multipliers);
}

void ControlProgram::take(const Number* multipliers) {
  for (long k = 0; k < sizes_.stages; ++k) {
    const Number* here = multipliers + first_row(k);
    const int equalities = sizes_.equalities_of(k);
    std::copy(here, here + equalities, costates_[k]);
    std::copy(here + equalities, here + equalities + before_bounds_, multipliers_[k]);
  }
}

// ---- from displacements to x

/// A row of derivatives of a stage, times D.
void ControlProgram::pull_back(long stage, const double* row, double* out) const {
  const int n = sizes_.node;
  for (int end = 0; end < 2; ++end) {
    const double* d = first_[stage + end];
    double* part = out + end * n;
    std::fill(part, part + n, 0.0);
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j) part[j] += row[end * n + i] * d[i * n + j];
  }
  std::copy(row + 2 * n, row + sizes_.variables(), out + 2 * n);
}

void ControlProgram::pull_back_rows(long stage) {
  const int d = sizes_.variables();
  for (int row = 0; row < sizes_.equality; ++row)
    if (row < sizes_.equalities_of(stage))
      pull_back(stage, derivatives_.equality[stage] + row * d, &rows_[std::size_t(row * d)]);
    else
      std::fill_n(&rows_[std::size_t(row * d)], d, 0.0);
  for (int row = 0; row < before_bounds_; ++row)
    pull_back(stage, derivatives_.inequality[stage] + row * d, &rows_[std::size_t((sizes_.equality + row) * d)]);
}

/// D^T H D, and the Lagrangian's gradient times Q.
void ControlProgram::pull_back_hessian(long stage, double of_cost) {
  const int n = sizes_.node;
  const int d = sizes_.variables();
  for (int r = 0; r < d; ++r) pull_back(stage, derivatives_.hessian[stage] + r * d, &half_[std::size_t(r * d)]);
  for (int r = 0; r < d; ++r)
    for (int q = 0; q < r; ++q) std::swap(half_[std::size_t(r * d + q)], half_[std::size_t(q * d + r)]);
  for (int r = 0; r < d; ++r) pull_back(stage, &half_[std::size_t(r * d)], &block_[std::size_t(r * d)]);
  for (int end = 0; end < 2; ++end)
    for (int i = 0; i < n; ++i) {
      const int variable = end * n + i;
      double slope = of_cost * derivatives_.gradient[stage][variable];
      for (int row = 0; row < sizes_.equalities_of(stage); ++row)
        slope += costates_[stage][row] * derivatives_.equality[stage][row * d + variable];
      for (int row = 0; row < before_bounds_; ++row)
        slope += multipliers_[stage][row] * derivatives_.inequality[stage][row * d + variable];
      const double* second = second_[stage + end] + i * n * n;
      for (int j = 0; j < n; ++j)
        for (int l = 0; l < n; ++l) block_[std::size_t((end * n + j) * d + end * n + l)] += slope * second[j * n + l];
    }
}

// ---- what IPOPT asks

bool ControlProgram::get_nlp_info(Index& variables, Index& rows, Index& in_jacobian, Index& in_hessian,
                                  IndexStyleEnum& style) {
  variables = unknowns_;
  rows = first_row(sizes_.stages);
  in_jacobian = in_hessian = 0;
  for (long k = 0; k < sizes_.stages; ++k) {
    for_each_in_rows(k, [&](Index, Index, int) { ++in_jacobian; });
    for_each_in_hessian(k, [&](Index, Index, int) { ++in_hessian; });
  }
  style = C_STYLE;
  return true;
}

bool ControlProgram::get_bounds_info(Index, Number* least, Number* most, Index, Number* least_row, Number* most_row) {
  constexpr Number none = 2e19;  // what IPOPT takes for infinite
  std::fill(least, least + unknowns_, -none);
  std::fill(most, most + unknowns_, none);
  for (long k = 0; k < sizes_.stages; ++k) {
    for (int i = 0; i < sizes_.control; ++i) {
      const TrajectoryChart::Range range = chart_.control_range(k, i);
      const Index at = control_place_[std::size_t(k * sizes_.control + i)];
      if (at < 0) continue;
      least[at] = std::max(range.least, -none);
      most[at] = std::min(range.most, none);
    }
    const Index first = first_row(k);
    const Index middle = first + sizes_.equalities_of(k);
    std::fill(least_row + first, least_row + middle, 0.0);
    std::fill(least_row + middle, least_row + middle + before_bounds_, -none);
    std::fill(most_row + first, most_row + middle + before_bounds_, 0.0);
  }
  return true;
}

bool ControlProgram::get_starting_point(Index count, bool, Number* x, bool, Number*, Number*, Index, bool, Number*) {
  std::fill(x, x + count, 0.0);
  return true;
}

bool ControlProgram::eval_f(Index, const Number* x, bool is_new, Number& cost) {
  move_to(x, is_new);
  evaluate_values();
  cost = 0;
  for (const double each : values_.cost.numbers()) cost += each;
  return std::isfinite(cost);
}

bool ControlProgram::eval_grad_f(Index count, const Number* x, bool is_new, Number* gradient) {
  move_to(x, is_new);
  evaluate_derivatives();
  std::fill(gradient, gradient + count, 0.0);
  for (long k = 0; k < sizes_.stages; ++k) {
    pull_back(k, derivatives_.gradient[k], rows_.data());
    for (int i = 0; i < sizes_.variables(); ++i)
      if (const Index at = place(k, i); at >= 0) gradient[at] += rows_[std::size_t(i)];
  }
  return true;
}

bool ControlProgram::eval_g(Index, const Number* x, bool is_new, Index, Number* rows) {
  move_to(x, is_new);
  evaluate_values();
  for (long k = 0; k < sizes_.stages; ++k) {
    Number* here = rows + first_row(k);
    here = std::copy(values_.equality[k], values_.equality[k] + sizes_.equalities_of(k), here);
    std::copy(values_.inequality[k], values_.inequality[k] + before_bounds_, here);
  }
  return true;
}

bool ControlProgram::eval_jac_g(Index, const Number* x, bool is_new, Index, Index, Index* row, Index* column,
                                Number* value) {
  if (value != nullptr) {
    move_to(x, is_new);
    evaluate_derivatives();
  }
  Index at = 0;
  for (long k = 0; k < sizes_.stages; ++k) {
    if (value != nullptr) {
      pull_back_rows(k);
      notice_missed(rows_, is_in_rows_);
    }
    for_each_in_rows(k, [&](Index i, Index j, int entry) {
      if (value != nullptr) {
        value[at] = rows_[std::size_t(entry)];
      } else {
        row[at] = i;
        column[at] = j;
      }
      ++at;
    });
  }
  return !missed_;
}

bool ControlProgram::eval_h(Index, const Number* x, bool is_new, Number factor, Index, const Number* multipliers, bool,
                            Index, Index* row, Index* column, Number* value) {
  if (value != nullptr) {
    move_to(x, is_new);
    evaluate_hessians(factor, multipliers);
  }
  Index at = 0;
  for (long k = 0; k < sizes_.stages; ++k) {
    if (value != nullptr) {
      pull_back_hessian(k, factor);
      for (int r = 0; r < sizes_.variables(); ++r)
        for (int q = r + 1; q < sizes_.variables(); ++q) block_[std::size_t(r * sizes_.variables() + q)] = 0;
      notice_missed(block_, is_in_hessian_);
    }
    for_each_in_hessian(k, [&](Index i, Index j, int entry) {
      if (value != nullptr) {
        value[at] = block_[std::size_t(entry)];
      } else {
        row[at] = std::max(i, j);
        column[at] = std::min(i, j);
      }
      ++at;
    });
  }
  return !missed_;
}

void ControlProgram::notice_missed(const std::vector<double>& entries, const std::vector<char>& is_in) {
  for (std::size_t at = 0; at < is_in.size(); ++at)
    if (is_in[at] == 0 && std::abs(entries[at]) > round_off) missed_ = true;
}

void ControlProgram::finalize_solution(Ipopt::SolverReturn, Index, const Number* x, const Number* of_lower,
                                       const Number* of_upper, Index, const Number*, const Number* multipliers, Number,
                                       const Ipopt::IpoptData*, Ipopt::IpoptCalculatedQuantities*) {
  move_to(x, true);
  take(multipliers);
  for (long k = 0; k < sizes_.stages; ++k) {
    for (int i = 0; i < sizes_.control; ++i) {
      const TrajectoryChart::Range range = chart_.control_range(k, i);
      const Index at = control_place_[std::size_t(k * sizes_.control + i)];
      if (at < 0) continue;
      if (std::isfinite(range.most)) multipliers_[k][bound_row_[std::size_t(2 * i)]] = of_upper[at];
      if (std::isfinite(range.least)) multipliers_[k][bound_row_[std::size_t(2 * i + 1)]] = of_lower[at];
    }
  }
}

}  // namespace lagroid
