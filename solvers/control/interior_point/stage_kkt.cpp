#include <lagroid/solvers/control/stage_kkt.hpp>
#include <lagroid/solvers/linear_algebra/row_sums.hpp>

#include <algorithm>
#include <cmath>
#include <limits>
#include <utility>

namespace lagroid {

namespace {

/// What round-off may leave of a right-hand side, of which more is corrected: little beside any tolerance.
constexpr double round_off_left = 1e-12;
constexpr int most_corrections = 4;

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
  displaced_ = sizes_.node + sizes_.control;
  const int block = displaced_ + sizes_.equality;
  row_ = padded(block);
  coupling_ = StageRows(stages, sizes_.node * row_);
  corner_.resize(std::size_t(border_ * border_));
  for (int m = 0; m <= sizes_.equality; ++m) factors_.emplace_back(displaced_ + m, row_);
  inverse_ = StageRows(stages, block * row_);
  border_solved_ = StageRows(stages, border_ * row_);
  corner_factor_ = SymmetricFactorSized(border_);
  corner_inverse_.resize(std::size_t(border_ * padded(border_)));
  eliminated_ = StageRows(stages, row_);
  border_right_.resize(std::size_t(border_));
  border_eliminated_.resize(std::size_t(border_));
  border_step_.resize(std::size_t(border_));
  for (Product& each : products_) {
    each.primal.resize(std::size_t(sizes_.variables()));
    each.equality.resize(std::size_t(sizes_.equality));
  }
  for (std::vector<double>& each : hessians_) each.resize(std::size_t(sizes_.variables() * sizes_.variables()));
  no_hessian_.resize(hessians_[0].size());
  block_work_.resize(std::size_t(block * row_));
  passed_rows_.resize(std::size_t(sizes_.node * row_));
  row_work_.resize(std::size_t(row_));
  weights_.resize(std::size_t(sizes_.node));
  along_.resize(std::size_t(sizes_.variables()));
}

long StageKkt::equalities() const {
  long sum = 0;
  for (long k = 0; k < sizes_.stages; ++k) sum += sizes_.equalities_of(k);
  return sum;
}

void StageKkt::assemble(const StageDerivatives& derivatives, const StageRows& sigma, HessianPart hessian_part) {
  derivatives_ = &derivatives;
  sigma_ = &sigma;
  hessian_part_ = hessian_part;
}

/// Calls what(i) for the unknowns of y_k that are fixed and stay zero.
template <class What> void StageKkt::for_fixed(long stage, std::size_t phase, const What& what) const {
  const std::vector<bool>& is_fixed = sizes_.phases[phase].control_is_fixed;
  for (std::size_t i = 0; i < is_fixed.size(); ++i)
    if (is_fixed[i]) what(sizes_.node + int(i));
  if (stage + 1 == sizes_.stages)
    for (int i = 0; i < sizes_.node; ++i)
      if (!free_end_[std::size_t(i)]) what(i);
}

/// Of the stage's Lagrangian + sum_i sigma_i dgamma_i^T dgamma_i, but for bounds of controls: as it stands where no
/// inequality adds to it, else in a place that the next but one takes.
const double* StageKkt::stage_hessian(long stage) {
  const int d = sizes_.variables();
  std::vector<double>& changed = hessians_[std::size_t(stage % 2)];
  const double* out = hessian_part_ == HessianPart::exact ? derivatives_->hessian[stage] : no_hessian_.data();
  for (int i = 0; i < sizes_.general_inequality(); ++i) {
    const double* row = derivatives_->inequality[stage] + i * d;
    for (int r = 0; r < d; ++r) {
      const double x = (*sigma_)[stage][i] * row[r];
      if (x == 0) continue;
      if (out != changed.data()) copy_row(out, d * d, changed.data());
      out = changed.data();
      add_rows(changed.data() + r * d, &x, row, 1, d);
    }
  }
  return out;
}

/// The block of stage k, its coupling to v_k and its border, before anything is eliminated, of the Hessian `h` of the
/// stage and that of the next one, if there is one: both know v_{k+1}.
void StageKkt::assemble_stage(long k, std::size_t phase, const double* h, const double* next) {
  const int n = sizes_.node;
  const int d = sizes_.variables();
  const int m = sizes_.equalities_of(k);
  const double* equality = derivatives_->equality[k];
  // What a variable of elsewhere couples to: v_{k+1} and controls, which stand side by side, and multipliers.
  const auto column = [&](int variable, double* row) {
    copy_row(h + variable * d + n, displaced_, row);
    for (int i = 0; i < m; ++i) row[displaced_ + i] = equality[i * d + variable];
  };
  double* here = block_work_.data();
  for (int r = 0; r < displaced_; ++r) {
    column(n + r, here + r * row_);
    here[r * (row_ + 1)] += primal_;
  }
  for (int i = 0; i < m; ++i) {
    double* row = here + (displaced_ + i) * row_;
    copy_row(equality + i * d + n, displaced_, row);
    std::fill(row + displaced_, row + displaced_ + m, 0.0);
    row[displaced_ + i] = -(*dual_)[k][i];
  }
  const TranscriptionPhase& of = sizes_.phases[phase];
  const double* sigma = (*sigma_)[k] + sizes_.general_inequality();
  for (std::size_t i = 0; i < of.bounds.size(); ++i)
    here[(n + of.bounds[i].control) * (row_ + 1)] += sigma[i] * of.bounds[i].sign * of.bounds[i].sign;
  if (next)
    for (int r = 0; r < n; ++r)
      for (int q = 0; q < n; ++q) here[r * row_ + q] += next[r * d + q];
  if (k > 0)
    for (int q = 0; q < n; ++q) column(q, coupling_[k] + q * row_);
  if (border_ > 0) assemble_border(k, phase, h, next, column);
  for_fixed(k, phase, [&](int at) {
    for (int q = 0; q < block_of(k); ++q) here[at * row_ + q] = here[q * row_ + at] = 0;
    for (int q = 0; q < n; ++q) coupling_[k][q * row_ + at] = 0;
    for (int q = 0; q < columns_[std::size_t(k)]; ++q) border_solved_[k][q * row_ + at] = 0;
    here[at * (row_ + 1)] = 1;
  });
}

template <class Column>
void StageKkt::assemble_border(long k, std::size_t phase, const double* h, const double* next, const Column& column) {
  const int n = sizes_.node;
  const int t = sizes_.at_duration();
  const int d = sizes_.variables();
  double* border = border_solved_[k];
  const auto corner = [&](int i, int j) -> double& { return corner_[std::size_t(i * border_ + j)]; };
  std::fill(border, border + columns_[std::size_t(k)] * row_, 0.0);
  const int last = duration_border_[phase];
  if (last >= 0) {
    column(t, border + last * row_);
    corner(last, last) += h[t * d + t];
  }
  if (k == 0)
    for (int q = 0; q < n; ++q) {
      const int at = border_of_start(q);
      if (at < 0) continue;
      column(q, border + at * row_);
      for (int r = 0; r < n; ++r)
        if (border_of_start(r) >= 0) corner(at, border_of_start(r)) += h[q * d + r];
      if (last >= 0) {
        corner(at, last) += h[t * d + q];
        corner(last, at) += h[t * d + q];
      }
    }
  if (!next) return;
  if (const int of_next = duration_border_[k + 1 == sizes_.phases[phase].end ? phase + 1 : phase]; of_next >= 0)
    for (int q = 0; q < n; ++q) border[of_next * row_ + q] += next[t * d + q];
}

/// Takes from a stage's block and border what the stages before leave of it.
void StageKkt::pass_on(long k) {
  const int n = sizes_.node;
  double* work = block_work_.data();
  const double* coupling = coupling_[k];
  const double* passed = inverse_[k - 1];
  std::fill(passed_rows_.begin(), passed_rows_.end(), 0.0);
  for (int q = 0; q < n; ++q) {
    for (int r = 0; r < n; ++r) weights_[std::size_t(r)] = 0.5 * (passed[q * row_ + r] + passed[r * row_ + q]);
    add_combination(passed_rows_.data() + q * row_, weights_.data(), 1, coupling, n, row_);
  }
  for (int i = 0; i < block_of(k); ++i)
    subtract_combination(work + i * row_, passed_rows_.data() + i, row_, coupling, n, row_);
  for (int border = 0; border < columns_[std::size_t(k - 1)]; ++border)
    subtract_combination(border_solved_[k] + border * row_, border_solved_[k - 1] + border * row_, 1, coupling, n,
                         row_);
}

/// The border of a stage, in `border_solved_`, through the inverse of its block, and what that takes from the corner,
/// below its diagonal.
void StageKkt::eliminate_border(long k) {
  for (int i = 0; i < columns_[std::size_t(k)]; ++i) {
    double* border = border_solved_[k] + i * row_;
    multiply(inverse_[k], border, block_of(k), row_, row_work_.data());
    for (int j = i; j < columns_[std::size_t(k)]; ++j)
      corner_[std::size_t(j * border_ + i)] -= sum_of_products(border_solved_[k] + j * row_, row_work_.data(), row_);
    std::copy(row_work_.begin(), row_work_.end(), border);
  }
}

StageKkt::Inertia StageKkt::factor(double primal, const StageRows& dual, const KktVector* right) {
  primal_ = primal;
  dual_ = &dual;
  Inertia inertia{0, std::numeric_limits<double>::infinity()};
  const auto note = [&](const SymmetricFactorSized& factor) {
    inertia.negative += factor.negative();
    inertia.smallest = std::min(inertia.smallest, factor.smallest());
  };
  std::fill(corner_.begin(), corner_.end(), 0.0);
  if (right) begin_elimination(*right, nullptr);
  const double* next = stage_hessian(0);
  long k = 0;
  for (std::size_t phase = 0; phase < sizes_.phases.size(); ++phase)
    for (; k < sizes_.phases[phase].end; ++k) {
      const double* here = std::exchange(next, k + 1 < sizes_.stages ? stage_hessian(k + 1) : nullptr);
      assemble_stage(k, phase, here, next);
      if (k > 0) pass_on(k);
      SymmetricFactorSized& factor = factors_[std::size_t(sizes_.equalities_of(k))];
      factor.compute(block_work_.data(), row_);
      note(factor);
      factor.invert(inverse_[k]);
      eliminate_border(k);
      if (right) eliminate(k, phase, *right, nullptr);
    }
  if (right) end_elimination();
  if (border_ > 0) {
    for (int i = 0; i < border_; ++i) {
      for (int j = 0; j < i; ++j) corner_[std::size_t(j * border_ + i)] = corner_[std::size_t(i * border_ + j)];
      corner_[std::size_t(i * (border_ + 1))] += primal;
    }
    corner_factor_.compute(corner_.data(), border_);
    note(corner_factor_);
    corner_factor_.invert(corner_inverse_.data());
  }
  return inertia;
}

/// What the stage's part of the matrix makes of x: along the stage's variables, and of its equalities.
const StageKkt::Product& StageKkt::product(long k, std::size_t phase, const KktVector& x) {
  const int n = sizes_.node;
  const int d = sizes_.variables();
  Product& out = products_[std::size_t(k % 2)];
  double* along = along_.data();
  copy_row(x.primal.nodes[k], 2 * n, along);  // both ends of the stage
  copy_row(x.primal.controls[k], sizes_.control, along + sizes_.at_control());
  along[sizes_.at_duration()] = x.primal.durations[phase];
  double* primal = out.primal.data();
  for (int q = 0; q < d; ++q) primal[q] = 0;
  for (int q = n; q < n + displaced_; ++q) primal[q] = primal_ * along[q];
  if (hessian_part_ == HessianPart::exact) add_rows(primal, along, derivatives_->hessian[k], d, d);
  const double* sigma = (*sigma_)[k];
  for (int i = 0; i < sizes_.general_inequality(); ++i) {
    const double* row = derivatives_->inequality[k] + i * d;
    const double weight = sigma[i] * row_product(row, along, d);
    add_rows(primal, &weight, row, 1, d);
  }
  const std::vector<ControlBound>& bounds = sizes_.phases[phase].bounds;
  for (std::size_t i = 0; i < bounds.size(); ++i) {
    const int at = sizes_.at_control() + bounds[i].control;
    primal[at] += sigma[sizes_.general_inequality() + int(i)] * bounds[i].sign * bounds[i].sign * along[at];
  }
  const double* equality = derivatives_->equality[k];
  const double* lambda = x.multipliers[k];
  const int m = sizes_.equalities_of(k);
  add_rows(primal, lambda, equality, m, d);
  for (int i = 0; i < m; ++i)
    out.equality[std::size_t(i)] = row_product(equality + i * d, along, d) - (*dual_)[k][i] * lambda[i];
  return out;
}

/// Before the right-hand sides are eliminated along the trajectory, or what `solved` leaves of them.
void StageKkt::begin_elimination(const KktVector& right, const KktVector* solved) {
  largest_ = 0;
  for (int q = 0; q < border_; ++q) {
    const Beside& at = beside_[std::size_t(q)];
    border_right_[std::size_t(q)] = entry(right.primal, at) - (solved ? primal_ * entry(solved->primal, at) : 0);
    border_eliminated_[std::size_t(q)] = 0;
  }
  if (!solved) return;
  const Product& first = product(0, 0, *solved);
  for (int q = 0; q < sizes_.node; ++q)
    if (const int border = border_of_start(q); border >= 0)
      border_right_[std::size_t(border)] -= first.primal[std::size_t(q)];
}

/// Of stage k, after those before.
void StageKkt::eliminate(long k, std::size_t phase, const KktVector& right, const KktVector* solved) {
  const int n = sizes_.node;
  const int m = sizes_.equalities_of(k);
  double* here = row_work_.data();
  copy_row(right.primal.nodes[k + 1], n, here);
  copy_row(right.primal.controls[k], sizes_.control, here + n);
  copy_row(right.multipliers[k], m, here + displaced_);
  std::fill(here + displaced_ + m, here + row_, 0.0);
  if (solved) {
    const Product& of = products_[std::size_t(k % 2)];
    for (int q = 0; q < displaced_; ++q) here[q] -= of.primal[std::size_t(n + q)];
    for (int i = 0; i < m; ++i) here[displaced_ + i] -= of.equality[std::size_t(i)];
    if (const int last = duration_border_[phase]; last >= 0)
      border_right_[std::size_t(last)] -= of.primal[std::size_t(sizes_.at_duration())];
    if (k + 1 < sizes_.stages) {
      const Product& next = product(k + 1, k + 1 == sizes_.phases[phase].end ? phase + 1 : phase, *solved);
      for (int q = 0; q < n; ++q) here[q] -= next.primal[std::size_t(q)];
    }
  }
  for_fixed(k, phase, [&](int at) { here[at] = 0; });
  for (int q = 0; q < displaced_ + m; ++q) largest_ = larger_magnitude(largest_, here[q]);
  if (k > 0) subtract_combination(here, eliminated_[k - 1], 1, coupling_[k], n, row_);
  for (int q = 0; q < columns_[std::size_t(k)]; ++q)
    border_eliminated_[std::size_t(q)] -= sum_of_products(border_solved_[k] + q * row_, here, row_);
  multiply(inverse_[k], here, block_of(k), row_, eliminated_[k]);
}

void StageKkt::end_elimination() {
  for (int q = 0; q < border_; ++q) {
    largest_ = larger_magnitude(largest_, border_right_[std::size_t(q)]);
    border_eliminated_[std::size_t(q)] += border_right_[std::size_t(q)];
  }
}

void StageKkt::eliminate_all(const KktVector& right, const KktVector* solved) {
  begin_elimination(right, solved);
  long k = 0;
  for (std::size_t phase = 0; phase < sizes_.phases.size(); ++phase)
    for (; k < sizes_.phases[phase].end; ++k) eliminate(k, phase, right, solved);
  end_elimination();
}

/// The solution for what is eliminated, which `out` becomes or is corrected by.
void StageKkt::substitute(Solution which, KktVector& out) {
  const int n = sizes_.node;
  const int c = sizes_.control;
  const bool corrects = which == Solution::corrected;
  if (!corrects) {
    std::fill(out.primal.nodes[0], out.primal.nodes[0] + n, 0.0);
    std::fill(out.primal.durations.begin(), out.primal.durations.end(), 0.0);
  }
  const auto put = [corrects](const double* from, int count, double* to) {
    for (int i = 0; i < count; ++i) to[i] = corrects ? to[i] + from[i] : from[i];
  };
  for (int q = 0; q < border_; ++q) {
    double& step = border_step_[std::size_t(q)];
    step = 0;
    for (int r = 0; r < border_; ++r)
      step += corner_inverse_[std::size_t(q * padded(border_) + r)] * border_eliminated_[std::size_t(r)];
    put(&step, 1, &entry(out.primal, beside_[std::size_t(q)]));
  }
  for (long k = sizes_.stages; k-- > 0;) {
    const int m = sizes_.equalities_of(k);
    double* here = eliminated_[k];
    if (k + 1 < sizes_.stages) {
      for (int q = 0; q < n; ++q)
        weights_[std::size_t(q)] = sum_of_products(coupling_[k + 1] + q * row_, eliminated_[k + 1], row_);
      subtract_combination(here, weights_.data(), 1, inverse_[k], n, row_);
    }
    subtract_combination(here, border_step_.data(), 1, border_solved_[k], columns_[std::size_t(k)], row_);
    put(here, n, out.primal.nodes[k + 1]);
    put(here + n, c, out.primal.controls[k]);
    put(here + displaced_, m, out.multipliers[k]);
    std::fill(out.multipliers[k] + m, out.multipliers[k] + sizes_.equality, 0.0);
  }
}

void StageKkt::solve(const KktVector& right, KktVector& out) {
  eliminate_all(right, nullptr);
  solve_eliminated(right, out);
}

void StageKkt::solve_eliminated(const KktVector& right, KktVector& out) {
  double before = largest_;
  const double enough = round_off_left * std::min(1.0, before);
  substitute(Solution::first, out);
  for (int i = 0; i < most_corrections; ++i) {
    eliminate_all(right, &out);
    const double left = largest_;
    if (!(left > enough) || (i > 0 && !(left < before))) break;
    substitute(Solution::corrected, out);
    if (left * (left / before) <= enough) break;  // a correction leaves about the part that the one before has left
    before = left;
  }
}

}  // namespace lagroid
