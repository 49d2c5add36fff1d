#include <lagroid/solvers/control/stage_kkt.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lagroid {

namespace {

/// What round-off may leave of a right-hand side, of which more is corrected: little beside any tolerance.
constexpr double round_off_left = 1e-12;
constexpr int most_corrections = 4;

/// A loop, where a call of memmove would take longer.
void copy(const double* from, int count, double* to) {
  for (int i = 0; i < count; ++i) to[i] = from[i];
}

/// out = A x, A symmetric of so many rows, each as long as out.
void multiply(const double* a, const double* x, int rows, int row, double* out) {
  std::fill(out, out + row, 0.0);
  add_combination(out, x, 1, a, rows, row);
}

}  // namespace

StageKkt::StageKkt(const Transcription& transcription) : StageKkt(transcription, transcription.sizes()) {}

StageKkt::StageKkt(const Transcription& ends, const TranscriptionSizes& sizes)
    : sizes_(sizes),
      free_end_(ends.free_end()),
      border_index_(std::size_t(sizes_.node), -1),
      duration_border_(sizes_.phases.size(), -1) {
  for (int i = 0; i < sizes_.node; ++i)
    if (ends.free_start()[std::size_t(i)]) {
      border_index_[std::size_t(i)] = int(beside_.size());
      beside_.push_back({i, -1});
    }
  const long stages = sizes_.stages;
  long stage = 0;
  for (std::size_t p = 0; p < sizes_.phases.size(); ++p) {
    // The node where a phase begins couples to its duration in the stage before.
    for (; stage < sizes_.phases[p].end; ++stage) {
      const bool is_first = stage == (p == 0 ? 0 : sizes_.phases[p - 1].end);
      if (is_first && sizes_.phases[p].duration_is_free) {
        duration_border_[p] = int(beside_.size());
        beside_.push_back({-1, int(p)});
        if (stage > 0) ++columns_.back();
      }
      columns_.push_back(int(beside_.size()));
    }
  }
  border_ = int(beside_.size());
  block_ = sizes_.control + sizes_.equality + sizes_.node;
  row_ = padded(block_);
  diagonal_ = StageRows(stages, block_ * row_);
  coupling_ = StageRows(stages, sizes_.node * row_);
  bordered_ = StageRows(stages, border_ * row_);
  corner_.resize(std::size_t(border_ * border_));
  for (int m = 0; m <= sizes_.equality; ++m) factors_.emplace_back(sizes_.control + m + sizes_.node, row_);
  inverse_ = StageRows(stages, block_ * row_);
  border_solved_ = StageRows(stages, border_ * row_);
  corner_factor_ = SymmetricFactorSized(border_);
  corner_work_.resize(corner_.size());
  corner_inverse_.resize(std::size_t(border_ * padded(border_)));
  right_ = StageRows(stages, row_);
  eliminated_ = StageRows(stages, row_);
  solution_ = StageRows(stages, row_);
  border_right_.resize(std::size_t(border_));
  border_eliminated_.resize(std::size_t(border_));
  border_step_.resize(std::size_t(border_));
  border_solution_.resize(std::size_t(border_));
  hessian_.resize(std::size_t(sizes_.variables() * sizes_.variables()));
  no_hessian_.resize(hessian_.size());
  block_work_.resize(std::size_t(block_ * row_));
  passed_rows_.resize(std::size_t(sizes_.node * row_));
  row_work_.resize(std::size_t(row_));
  weights_.resize(std::size_t(sizes_.node));
  dual_ = StageRows(stages, sizes_.equality);
}

long StageKkt::equalities() const {
  long sum = 0;
  for (long k = 0; k < sizes_.stages; ++k) sum += sizes_.equalities_of(k);
  return sum;
}

/// Of what is fixed: an unknown that stays zero.
void StageKkt::keep_zero(long stage, int at) {
  double* here = diagonal_[stage];
  for (int q = 0; q < block_of(stage); ++q) here[at * row_ + q] = here[q * row_ + at] = 0;
  for (int q = 0; q < sizes_.node; ++q) coupling_[stage][q * row_ + at] = 0;
  for (int q = 0; q < columns_[std::size_t(stage)]; ++q) bordered_[stage][q * row_ + at] = 0;
  here[at * row_ + at] = 1;
}

void StageKkt::assemble(const StageDerivatives& derivatives, const StageRows& sigma, HessianPart hessian_part) {
  derivatives_ = &derivatives;
  sigma_ = &sigma;
  hessian_part_ = hessian_part;
}

/// Of the stage's Lagrangian + sum_i sigma_i dgamma_i^T dgamma_i, but for bounds of controls: as it stands where no
/// inequality adds to it.
const double* StageKkt::stage_hessian(long stage) {
  const int d = sizes_.variables();
  const double* out = hessian_part_ == HessianPart::exact ? derivatives_->hessian[stage] : no_hessian_.data();
  for (int i = 0; i < sizes_.general_inequality(); ++i) {
    const double* row = derivatives_->inequality[stage] + i * d;
    for (int r = 0; r < d; ++r) {
      const double x = (*sigma_)[stage][i] * row[r];
      if (x == 0) continue;
      if (out != hessian_.data()) copy(out, d * d, hessian_.data());
      out = hessian_.data();
      for (int q = 0; q < d; ++q) hessian_[std::size_t(r * d + q)] += x * row[q];
    }
  }
  return out;
}

void StageKkt::assemble_stage(long k) {
  const int n = sizes_.node;
  const int c = sizes_.control;
  const int d = sizes_.variables();
  const double* h = stage_hessian(k);
  const double* equality = derivatives_->equality[k];
  const int v = target_of(k);
  const int m = v - c;
  // Controls and the node that the stage leads to, from a row over the stage's variables.
  const auto place = [&](const double* from, double* row) {
    copy(from + 2 * n, c, row);
    copy(from + n, n, row + v);
  };
  // The same and multipliers: what a variable of elsewhere couples to.
  const auto column = [&](int variable, double* row) {
    place(h + variable * d, row);
    for (int i = 0; i < m; ++i) row[c + i] = equality[i * d + variable];
  };
  double* here = diagonal_[k];
  for (int r = 0; r < c; ++r) column(2 * n + r, here + r * row_);
  for (int r = 0; r < n; ++r) column(n + r, here + (v + r) * row_);
  for (int i = 0; i < m; ++i) {
    double* row = here + (c + i) * row_;
    for (int q = c; q < v; ++q) row[q] = 0;
    place(equality + i * d, row);
  }
  std::fill(bordered_[k], bordered_[k] + border_ * row_, 0.0);
  if (k > 0) {
    double* before = diagonal_[k - 1] + target_of(k - 1) * (row_ + 1);
    for (int r = 0; r < n; ++r)
      for (int q = 0; q < n; ++q) before[r * row_ + q] += h[r * d + q];
    for (int q = 0; q < n; ++q) column(q, coupling_[k] + q * row_);
  } else {
    for (int q = 0; q < n; ++q) {
      const int border = border_of_start(q);
      if (border < 0) continue;
      column(q, bordered_[k] + border * row_);
      for (int r = 0; r < n; ++r)
        if (border_of_start(r) >= 0) corner_[std::size_t(border * border_ + border_of_start(r))] += h[q * d + r];
    }
  }
  const auto phase = std::size_t(sizes_.phase_of(k));
  const std::vector<ControlBound>& bounds = sizes_.phases[phase].bounds;
  const double* sigma = (*sigma_)[k] + sizes_.general_inequality();
  for (std::size_t i = 0; i < bounds.size(); ++i)
    here[bounds[i].control * (row_ + 1)] += sigma[i] * bounds[i].sign * bounds[i].sign;
  if (const int last = duration_border_[phase]; last >= 0) {
    const double* along = h + sizes_.at_duration() * d;
    column(sizes_.at_duration(), bordered_[k] + last * row_);
    corner_[std::size_t(last * border_ + last)] += along[sizes_.at_duration()];
    for (int q = 0; q < n; ++q) {
      if (k > 0) {
        bordered_[k - 1][last * row_ + target_of(k - 1) + q] += along[q];
      } else if (border_of_start(q) >= 0) {
        const int border = border_of_start(q);
        corner_[std::size_t(border * border_ + last)] += along[q];
        corner_[std::size_t(last * border_ + border)] += along[q];
      }
    }
  }
  const std::vector<bool>& is_fixed = sizes_.phases[phase].control_is_fixed;
  for (std::size_t i = 0; i < is_fixed.size(); ++i)
    if (is_fixed[i]) keep_zero(k, int(i));
  if (k + 1 == sizes_.stages)
    for (int i = 0; i < n; ++i)
      if (!free_end_[std::size_t(i)]) keep_zero(k, v + i);
}

/// What the stages before leave of a stage's block, in `work`, and of its border.
void StageKkt::pass_on(long k, double* work) {
  const int n = sizes_.node;
  const int v_before = target_of(k - 1);
  const double* coupling = coupling_[k];
  const double* passed = inverse_[k - 1] + v_before * (row_ + 1);
  std::fill(passed_rows_.begin(), passed_rows_.end(), 0.0);
  for (int q = 0; q < n; ++q) {
    for (int r = 0; r < n; ++r) weights_[std::size_t(r)] = 0.5 * (passed[q * row_ + r] + passed[r * row_ + q]);
    add_combination(passed_rows_.data() + q * row_, weights_.data(), 1, coupling, n, row_);
  }
  for (int i = 0; i < block_of(k); ++i)
    subtract_combination(work + i * row_, passed_rows_.data() + i, row_, coupling, n, row_);
  for (int border = 0; border < columns_[std::size_t(k - 1)]; ++border)
    subtract_combination(border_solved_[k] + border * row_, border_solved_[k - 1] + border * row_ + v_before, 1,
                         coupling, n, row_);
}

/// The border of a stage, in `border_solved_`, through the inverse of its block, and what that takes from the corner.
void StageKkt::eliminate_border(long k) {
  for (int i = 0; i < columns_[std::size_t(k)]; ++i) {
    double* border = border_solved_[k] + i * row_;
    multiply(inverse_[k], border, block_of(k), row_, row_work_.data());
    for (int j = i; j < columns_[std::size_t(k)]; ++j)
      corner_work_[std::size_t(j * border_ + i)] -=
          sum_of_products(border_solved_[k] + j * row_, row_work_.data(), row_);
    copy(row_work_.data(), row_, border);
  }
}

StageKkt::Inertia StageKkt::factor(double primal, const StageRows& dual) {
  primal_ = primal;
  dual_ = dual;
  const int c = sizes_.control;
  Inertia inertia{0, std::numeric_limits<double>::infinity()};
  const auto note = [&](const SymmetricFactorSized& factor) {
    inertia.negative += factor.negative();
    inertia.smallest = std::min(inertia.smallest, factor.smallest());
  };
  double* work = block_work_.data();
  std::fill(corner_.begin(), corner_.end(), 0.0);
  std::fill(corner_work_.begin(), corner_work_.end(), 0.0);
  assemble_stage(0);
  for (long k = 0; k < sizes_.stages; ++k) {
    if (k + 1 < sizes_.stages) assemble_stage(k + 1);  // which adds to this one
    const int v = target_of(k);
    const int block = block_of(k);
    copy(diagonal_[k], block * row_, work);
    for (int i = 0; i < block; ++i) work[i * row_ + i] += i >= c && i < v ? -dual[k][i - c] : primal;
    copy(bordered_[k], columns_[std::size_t(k)] * row_, border_solved_[k]);
    if (k > 0) pass_on(k, work);
    SymmetricFactorSized& factor = factors_[std::size_t(v - c)];
    factor.compute(work, row_);
    note(factor);
    factor.invert(inverse_[k]);
    eliminate_border(k);
  }
  if (border_ > 0) {
    double* corner = corner_work_.data();
    for (int i = 0; i < border_; ++i)
      for (int j = 0; j <= i; ++j)
        corner[j * border_ + i] = corner[i * border_ + j] += corner_[std::size_t(i * border_ + j)];
    for (int i = 0; i < border_; ++i) corner[i * (border_ + 1)] += primal;
    corner_factor_.compute(corner, border_);
    note(corner_factor_);
    corner_factor_.invert(corner_inverse_.data());
  }
  return inertia;
}

/// Right-hand sides in the stages' rows; zero for what is fixed.
void StageKkt::take(const KktVector& right) {
  const int n = sizes_.node;
  const int c = sizes_.control;
  for (int q = 0; q < border_; ++q) border_right_[std::size_t(q)] = entry(right.primal, beside_[std::size_t(q)]);
  std::size_t phase = 0;
  for (long k = 0; k < sizes_.stages; ++k) {
    if (k == sizes_.phases[phase].end) ++phase;
    const int v = target_of(k);
    double* here = right_[k];
    copy(right.primal.controls[k], c, here);
    copy(right.multipliers[k], v - c, here + c);
    copy(right.primal.nodes[k + 1], n, here + v);
    const std::vector<bool>& is_fixed = sizes_.phases[phase].control_is_fixed;
    for (std::size_t i = 0; i < is_fixed.size(); ++i)
      if (is_fixed[i]) here[i] = 0;
    if (k + 1 == sizes_.stages)
      for (int i = 0; i < n; ++i)
        if (!free_end_[std::size_t(i)]) here[v + i] = 0;
  }
}

/// The solution for these right-hand sides; or they are what it left, and it is corrected.
void StageKkt::eliminate(Solution which) {
  const int n = sizes_.node;
  border_eliminated_ = border_right_;
  for (long k = 0; k < sizes_.stages; ++k) {
    double* here = eliminated_[k];
    copy(right_[k], row_, here);
    if (k > 0) {
      const int v_before = target_of(k - 1);
      for (int q = 0; q < n; ++q)
        weights_[std::size_t(q)] = sum_of_products(inverse_[k - 1] + (v_before + q) * row_, eliminated_[k - 1], row_);
      subtract_combination(here, weights_.data(), 1, coupling_[k], n, row_);
    }
    for (int q = 0; q < columns_[std::size_t(k)]; ++q)
      border_eliminated_[std::size_t(q)] -= sum_of_products(border_solved_[k] + q * row_, here, row_);
  }
  for (int q = 0; q < border_; ++q) {
    double sum = 0;
    for (int r = 0; r < border_; ++r)
      sum += corner_inverse_[std::size_t(q * padded(border_) + r)] * border_eliminated_[std::size_t(r)];
    border_step_[std::size_t(q)] = sum;
    border_solution_[std::size_t(q)] = which == Solution::first ? sum : border_solution_[std::size_t(q)] + sum;
  }
  for (long k = sizes_.stages; k-- > 0;) {
    const int v = target_of(k);
    double* here = eliminated_[k];
    if (k + 1 < sizes_.stages)
      for (int q = 0; q < n; ++q) here[v + q] -= sum_of_products(coupling_[k + 1] + q * row_, eliminated_[k + 1], row_);
    double* solved = row_work_.data();
    multiply(inverse_[k], here, v + n, row_, solved);
    subtract_combination(solved, border_step_.data(), 1, border_solved_[k], columns_[std::size_t(k)], row_);
    copy(solved, row_, here);
    if (which == Solution::first) {
      copy(solved, row_, solution_[k]);
    } else {
      add_multiple(solution_[k], 1, solved, row_);
    }
  }
}

void StageKkt::give(KktVector& out) const {
  const int n = sizes_.node;
  const int c = sizes_.control;
  std::fill(out.primal.nodes[0], out.primal.nodes[0] + n, 0.0);
  std::fill(out.primal.durations.begin(), out.primal.durations.end(), 0.0);
  for (int q = 0; q < border_; ++q) entry(out.primal, beside_[std::size_t(q)]) = border_solution_[std::size_t(q)];
  for (long k = 0; k < sizes_.stages; ++k) {
    const double* here = solution_[k];
    const int v = target_of(k);
    copy(here, c, out.primal.controls[k]);
    copy(here + c, v - c, out.multipliers[k]);
    for (int i = v - c; i < sizes_.equality; ++i) out.multipliers[k][i] = 0;
    copy(here + v, n, out.primal.nodes[k + 1]);
  }
}

/// Takes (the matrix) solution from the right-hand sides.
void StageKkt::subtract_product() {
  const int n = sizes_.node;
  const int c = sizes_.control;
  for (int q = 0; q < border_; ++q) {
    double sum = primal_ * border_solution_[std::size_t(q)];
    for (int r = 0; r < border_; ++r) sum += corner_[std::size_t(q * border_ + r)] * border_solution_[std::size_t(r)];
    border_right_[std::size_t(q)] -= sum;
  }
  for (long k = 0; k < sizes_.stages; ++k) {
    const int v = target_of(k);
    const double* at = solution_[k];
    double* left = right_[k];
    subtract_combination(left, at, 1, diagonal_[k], v + n, row_);
    for (int i = 0; i < v + n; ++i) left[i] -= (i >= c && i < v ? -dual_[k][i - c] : primal_) * at[i];
    subtract_combination(left, border_solution_.data(), 1, bordered_[k], columns_[std::size_t(k)], row_);
    for (int q = 0; q < columns_[std::size_t(k)]; ++q)
      border_right_[std::size_t(q)] -= sum_of_products(bordered_[k] + q * row_, at, row_);
    if (k == 0) continue;
    const int v_before = target_of(k - 1);
    subtract_combination(left, solution_[k - 1] + v_before, 1, coupling_[k], n, row_);
    for (int q = 0; q < n; ++q) right_[k - 1][v_before + q] -= sum_of_products(coupling_[k] + q * row_, at, row_);
  }
}

double StageKkt::largest_right() const {
  double most = largest_entry(right_);
  for (const double x : border_right_) most = std::max(most, std::abs(x));
  return most;
}

void StageKkt::solve(const KktVector& right, KktVector& out) {
  take(right);
  double before = largest_right();
  const double enough = round_off_left * std::min(1.0, before);
  eliminate(Solution::first);
  subtract_product();
  double left = largest_right();
  for (int i = 0; i < most_corrections && left > enough; ++i) {
    eliminate(Solution::corrected);
    if (left * (left / before) <= enough) break;  // a correction leaves about the part that the one before has left
    take(right);
    subtract_product();
    before = std::exchange(left, largest_right());
    if (!(left < before)) break;
  }
  give(out);
}

}  // namespace lagroid
