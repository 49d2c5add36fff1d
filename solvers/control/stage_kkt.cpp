#include <lagroid/solvers/control/stage_kkt.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lagroid {

namespace {

/// out += factor * A B, rows one after another: A is rows x inner, B inner x columns.
void add_product(double factor, const double* a, const double* b, int rows, int inner, int columns, double* out) {
  for (int i = 0; i < rows; ++i)
    for (int k = 0; k < inner; ++k) {
      const double x = factor * a[i * inner + k];
      if (x == 0) continue;
      for (int j = 0; j < columns; ++j) out[i * columns + j] += x * b[k * columns + j];
    }
}

/// out += factor * A^T B: A is inner x rows, B inner x columns.
void add_transposed(double factor, const double* a, const double* b, int rows, int inner, int columns, double* out) {
  for (int k = 0; k < inner; ++k)
    for (int i = 0; i < rows; ++i) {
      const double x = factor * a[k * rows + i];
      if (x == 0) continue;
      for (int j = 0; j < columns; ++j) out[i * columns + j] += x * b[k * columns + j];
    }
}

}  // namespace

StageKkt::StageKkt(const Transcription& transcription) : StageKkt(transcription, transcription.sizes()) {}

StageKkt::StageKkt(const Transcription& ends, const TranscriptionSizes& sizes)
    : sizes_(sizes),
      free_end_(ends.free_end()),
      border_index_(std::size_t(sizes_.node), -1),
      duration_is_free_(ends.duration_is_free()) {
  for (int i = 0; i < sizes_.node; ++i)
    if (ends.free_start()[std::size_t(i)]) border_index_[std::size_t(i)] = border_++;
  if (duration_is_free_) ++border_;
  block_ = sizes_.control + sizes_.equality + sizes_.node;
  const long stages = sizes_.stages;
  diagonal_ = StageRows(stages, block_ * block_);
  coupling_ = StageRows(stages, block_ * sizes_.node);
  bordered_ = StageRows(stages, block_ * border_);
  corner_.resize(std::size_t(border_) * std::size_t(border_));
  factors_.assign(std::size_t(stages), SymmetricFactorSized(block_));
  passed_ = StageRows(stages, sizes_.node * sizes_.node);
  border_solved_ = StageRows(stages, block_ * border_);
  corner_factor_ = SymmetricFactorSized(border_);
  right_ = StageRows(stages, block_);
  border_right_.resize(std::size_t(border_));
  corner_work_.resize(corner_.size());
  block_work_.resize(std::size_t(std::max(block_ * block_, sizes_.variables() * sizes_.variables())));
  column_work_.resize(std::size_t(block_) * std::size_t(std::max({sizes_.node, border_, 1})));
  dual_ = StageRows(stages, sizes_.equality);
  left_ = KktVector(sizes_);
  correction_ = KktVector(sizes_);
}

long StageKkt::equalities() const {
  return sizes_.stages * long(sizes_.equality - sizes_.end_equality) + sizes_.end_equality;
}

void StageKkt::assemble(const StageDerivatives& derivatives, const StageRows& sigma, HessianPart hessian_part) {
  const int n = sizes_.node;
  const int c = sizes_.control;
  const int m = sizes_.equality;
  const int d = sizes_.variables();
  const int v = c + m;  // where v_{k+1} begins in a block
  std::fill(diagonal_.numbers().begin(), diagonal_.numbers().end(), 0.0);
  std::fill(coupling_.numbers().begin(), coupling_.numbers().end(), 0.0);
  std::fill(bordered_.numbers().begin(), bordered_.numbers().end(), 0.0);
  std::fill(corner_.begin(), corner_.end(), 0.0);
  std::vector<double>& h = block_work_;  // the stage's Hessian
  for (long k = 0; k < sizes_.stages; ++k) {
    if (hessian_part == HessianPart::exact) {
      std::copy(derivatives.hessian[k], derivatives.hessian[k] + d * d, h.begin());
    } else {
      std::fill(h.begin(), h.begin() + d * d, 0.0);
    }
    for (int i = 0; i < sizes_.inequality; ++i) {
      const double* row = derivatives.inequality[k] + i * d;
      for (int r = 0; r < d; ++r) {
        const double x = sigma[k][i] * row[r];
        if (x == 0) continue;
        for (int q = 0; q < d; ++q) h[std::size_t(r * d + q)] += x * row[q];
      }
    }
    const auto hessian = [&](int r, int q) { return h[std::size_t(r * d + q)]; };
    const auto equality = [&](int row, int q) { return derivatives.equality[k][row * d + q]; };
    // The place of a variable of the stage in its block: of the control and of the node it leads to.
    const auto place = [&](int variable) { return variable < 2 * n ? v + variable - n : variable - 2 * n; };
    double* here = diagonal_[k];
    const auto add_border = [&](int border, int variable) {
      double* column = bordered_[k] + border;
      for (int q = n; q < 2 * n + c; ++q) column[place(q) * border_] += hessian(q, variable);
      for (int row = 0; row < sizes_.equalities_of(k); ++row) column[(c + row) * border_] += equality(row, variable);
    };
    for (int r = n; r < 2 * n + c; ++r)
      for (int q = n; q < 2 * n + c; ++q) here[place(r) * block_ + place(q)] += hessian(r, q);
    for (int row = 0; row < m; ++row) {
      if (row >= sizes_.equalities_of(k)) {
        here[(c + row) * block_ + c + row] = 1;  // not there: an unknown that stays zero
        continue;
      }
      for (int q = n; q < 2 * n + c; ++q)
        here[(c + row) * block_ + place(q)] = here[place(q) * block_ + c + row] = equality(row, q);
    }
    if (k > 0) {
      double* before = diagonal_[k - 1];
      for (int r = 0; r < n; ++r)
        for (int q = 0; q < n; ++q) before[(v + r) * block_ + v + q] += hessian(r, q);
      double* column = coupling_[k];
      for (int q = 0; q < n; ++q) {
        for (int r = n; r < 2 * n + c; ++r) column[place(r) * n + q] = hessian(r, q);
        for (int row = 0; row < sizes_.equalities_of(k); ++row) column[(c + row) * n + q] = equality(row, q);
      }
    } else {
      for (int q = 0; q < n; ++q) {
        const int border = border_of_start(q);
        if (border < 0) continue;
        add_border(border, q);
        for (int r = 0; r < n; ++r)
          if (border_of_start(r) >= 0) corner_[std::size_t(border * border_ + border_of_start(r))] += hessian(q, r);
      }
    }
    if (duration_is_free_) {
      const int last = border_ - 1;
      const int duration = sizes_.at_duration();
      add_border(last, duration);
      corner_[std::size_t(last * border_ + last)] += hessian(duration, duration);
      for (int q = 0; q < n; ++q) {
        if (k > 0) {
          bordered_[k - 1][(v + q) * border_ + last] += hessian(q, duration);
        } else if (border_of_start(q) >= 0) {
          const int border = border_of_start(q);
          corner_[std::size_t(border * border_ + last)] += hessian(q, duration);
          corner_[std::size_t(last * border_ + border)] += hessian(duration, q);
        }
      }
    }
  }
  // What is fixed of the last node: unknowns that stay zero.
  const long last = sizes_.stages - 1;
  for (int i = 0; i < n; ++i) {
    if (free_end_[std::size_t(i)]) continue;
    const int at = v + i;
    for (int q = 0; q < block_; ++q) diagonal_[last][at * block_ + q] = diagonal_[last][q * block_ + at] = 0;
    for (int q = 0; q < n; ++q) coupling_[last][at * n + q] = 0;
    for (int q = 0; q < border_; ++q) bordered_[last][at * border_ + q] = 0;
    diagonal_[last][at * block_ + at] = 1;
  }
}

StageKkt::Inertia StageKkt::factor(double primal, const StageRows& dual) {
  primal_ = primal;
  dual_ = dual;
  const int n = sizes_.node;
  const int c = sizes_.control;
  const int v = c + sizes_.equality;
  Inertia inertia{0, std::numeric_limits<double>::infinity()};
  std::vector<double>& block = block_work_;
  std::vector<double>& corner = corner_work_;
  std::copy(corner_.begin(), corner_.end(), corner.begin());
  for (int i = 0; i < border_; ++i) corner[std::size_t(i * border_ + i)] += primal;
  for (long k = 0; k < sizes_.stages; ++k) {
    std::copy(diagonal_[k], diagonal_[k] + block_ * block_, block.begin());
    for (int i = 0; i < block_; ++i) {
      const bool is_multiplier = i >= c && i < v;
      if (is_multiplier && i - c >= sizes_.equalities_of(k)) continue;
      block[std::size_t(i * block_ + i)] += is_multiplier ? -dual[k][i - c] : primal;
    }
    // border_solved_ is on its way: the border here less what passes from the stages before.
    std::copy(bordered_[k], bordered_[k] + block_ * border_, border_solved_[k]);
    if (k > 0) {
      std::fill(column_work_.begin(), column_work_.begin() + block_ * n, 0.0);
      add_product(1, coupling_[k], passed_[k - 1], block_, n, n, column_work_.data());
      for (int i = 0; i < block_; ++i)
        for (int j = 0; j < block_; ++j) {
          double sum = 0;
          for (int q = 0; q < n; ++q) sum += column_work_[std::size_t(i * n + q)] * coupling_[k][j * n + q];
          block[std::size_t(i * block_ + j)] -= sum;
        }
      add_product(-1, coupling_[k], border_solved_[k - 1] + v * border_, block_, n, border_, border_solved_[k]);
    }
    SymmetricFactorSized& factor = factors_[std::size_t(k)];
    factor.compute(block.data());
    inertia.negative += factor.negative();
    inertia.smallest = std::min(inertia.smallest, factor.smallest());
    std::fill(column_work_.begin(), column_work_.begin() + block_ * n, 0.0);
    for (int q = 0; q < n; ++q) column_work_[std::size_t((v + q) * n + q)] = 1;
    factor.solve_in_place(column_work_.data(), n);
    for (int r = 0; r < n; ++r)
      for (int q = 0; q < n; ++q)
        passed_[k][r * n + q] =
            0.5 * (column_work_[std::size_t((v + r) * n + q)] + column_work_[std::size_t((v + q) * n + r)]);
    if (border_ > 0) {
      std::copy(border_solved_[k], border_solved_[k] + block_ * border_, column_work_.begin());
      factor.solve_in_place(border_solved_[k], border_);
      add_transposed(-1, column_work_.data(), border_solved_[k], border_, block_, border_, corner.data());
    }
  }
  if (border_ > 0) {
    for (int i = 0; i < border_; ++i)
      for (int j = 0; j < i; ++j) {
        const double mean = 0.5 * (corner[std::size_t(i * border_ + j)] + corner[std::size_t(j * border_ + i)]);
        corner[std::size_t(i * border_ + j)] = corner[std::size_t(j * border_ + i)] = mean;
      }
    corner_factor_.compute(corner.data());
    inertia.negative += corner_factor_.negative();
    inertia.smallest = std::min(inertia.smallest, corner_factor_.smallest());
  }
  return inertia;
}

void StageKkt::eliminate(const KktVector& right, KktVector& out) {
  const int n = sizes_.node;
  const int c = sizes_.control;
  const int m = sizes_.equality;
  const int v = c + m;
  for (int i = 0; i < n; ++i)
    if (border_of_start(i) >= 0) border_right_[std::size_t(border_of_start(i))] = right.primal.nodes[0][i];
  if (duration_is_free_) border_right_.back() = right.primal.duration;
  for (long k = 0; k < sizes_.stages; ++k) {
    double* here = right_[k];
    std::copy(right.primal.controls[k], right.primal.controls[k] + c, here);
    std::copy(right.multipliers[k], right.multipliers[k] + m, here + c);
    std::copy(right.primal.nodes[k + 1], right.primal.nodes[k + 1] + n, here + v);
    for (int row = sizes_.equalities_of(k); row < m; ++row) here[c + row] = 0;
    if (k + 1 == sizes_.stages)
      for (int i = 0; i < n; ++i)
        if (!free_end_[std::size_t(i)]) here[v + i] = 0;
    if (k > 0) add_product(-1, coupling_[k], right_[k - 1] + v, block_, n, 1, here);
    for (int q = 0; q < border_; ++q)
      for (int i = 0; i < block_; ++i) border_right_[std::size_t(q)] -= border_solved_[k][i * border_ + q] * here[i];
    factors_[std::size_t(k)].solve_in_place(here, 1);
  }
  if (border_ > 0) corner_factor_.solve_in_place(border_right_.data(), 1);
  double* column = column_work_.data();
  for (long k = sizes_.stages; k-- > 0;) {
    double* here = right_[k];
    add_product(-1, border_solved_[k], border_right_.data(), block_, border_, 1, here);
    if (k + 1 < sizes_.stages) {
      // The pivot block's inverse times what the next stage's unknowns couple to v.
      std::fill(column, column + block_, 0.0);
      add_transposed(1, coupling_[k + 1], right_[k + 1], n, block_, 1, column + v);
      factors_[std::size_t(k)].solve_in_place(column, 1);
      for (int i = 0; i < block_; ++i) here[i] -= column[i];
    }
  }
  std::fill(out.primal.nodes[0], out.primal.nodes[0] + n, 0.0);
  for (int i = 0; i < n; ++i)
    if (border_of_start(i) >= 0) out.primal.nodes[0][i] = border_right_[std::size_t(border_of_start(i))];
  out.primal.duration = duration_is_free_ ? border_right_.back() : 0;
  for (long k = 0; k < sizes_.stages; ++k) {
    const double* here = right_[k];
    std::copy(here, here + c, out.primal.controls[k]);
    std::copy(here + c, here + v, out.multipliers[k]);
    std::copy(here + v, here + v + n, out.primal.nodes[k + 1]);
  }
}

void StageKkt::residual(const KktVector& right, const KktVector& out, KktVector& left) const {
  const int n = sizes_.node;
  const int c = sizes_.control;
  const int m = sizes_.equality;
  const int v = c + m;
  const auto border_of = [&](const KktVector& x, int q) {
    if (duration_is_free_ && q + 1 == border_) return x.primal.duration;
    for (int i = 0; i < n; ++i)
      if (border_of_start(i) == q) return x.primal.nodes[0][i];
    return 0.0;
  };
  const auto entry = [&](const KktVector& x, long k, int i) {
    return i < c ? x.primal.controls[k][i] : i < v ? x.multipliers[k][i - c] : x.primal.nodes[k + 1][i - v];
  };
  left = right;
  const auto subtract = [&](long k, int i, double amount) {
    (i < c   ? left.primal.controls[k][i]
     : i < v ? left.multipliers[k][i - c]
             : left.primal.nodes[k + 1][i - v]) -= amount;
  };
  const auto subtract_border = [&](int q, double amount) {
    if (duration_is_free_ && q + 1 == border_) {
      left.primal.duration -= amount;
      return;
    }
    for (int i = 0; i < n; ++i)
      if (border_of_start(i) == q) left.primal.nodes[0][i] -= amount;
  };
  for (int q = 0; q < border_; ++q) {
    double sum = primal_ * border_of(out, q);
    for (int r = 0; r < border_; ++r) sum += corner_[std::size_t(q * border_ + r)] * border_of(out, r);
    subtract_border(q, sum);
  }
  for (long k = 0; k < sizes_.stages; ++k) {
    for (int i = 0; i < block_; ++i) {
      const bool is_multiplier = i >= c && i < v;
      const bool absent = is_multiplier && i - c >= sizes_.equalities_of(k);
      double sum = absent ? 0 : (is_multiplier ? -dual_[k][i - c] : primal_) * entry(out, k, i);
      for (int j = 0; j < block_; ++j) sum += diagonal_[k][i * block_ + j] * entry(out, k, j);
      for (int q = 0; q < border_; ++q) sum += bordered_[k][i * border_ + q] * border_of(out, q);
      if (k > 0)
        for (int q = 0; q < n; ++q) sum += coupling_[k][i * n + q] * out.primal.nodes[k][q];
      subtract(k, i, sum);
    }
    if (k > 0)
      for (int q = 0; q < n; ++q) {
        double sum = 0;
        for (int i = 0; i < block_; ++i) sum += coupling_[k][i * n + q] * entry(out, k, i);
        left.primal.nodes[k][q] -= sum;
      }
    for (int q = 0; q < border_; ++q) {
      double sum = 0;
      for (int i = 0; i < block_; ++i) sum += bordered_[k][i * border_ + q] * entry(out, k, i);
      subtract_border(q, sum);
    }
  }
}

void StageKkt::solve(const KktVector& right, KktVector& out) {
  eliminate(right, out);
  residual(right, out, left_);
  eliminate(left_, correction_);
  add(out.primal, 1, correction_.primal);
  add(out.multipliers, 1, correction_.multipliers);
}

}  // namespace lagroid
