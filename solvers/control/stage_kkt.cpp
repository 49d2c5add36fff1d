#include <lagroid/solvers/control/stage_kkt.hpp>

#include <algorithm>
#include <cmath>
#include <limits>

namespace lagroid {

namespace {

/// out += factor * A B, rows one after another: A is rows x inner, B inner x columns; the rows of out are `width` long.
void add_product(double factor, const double* a, const double* b, int rows, int inner, int columns, double* out,
                 int width) {
  for (int i = 0; i < rows; ++i)
    for (int k = 0; k < inner; ++k) {
      const double x = factor * a[i * inner + k];
      if (x == 0) continue;
      for (int j = 0; j < columns; ++j) out[i * width + j] += x * b[k * columns + j];
    }
}
void add_product(double factor, const double* a, const double* b, int rows, int inner, int columns, double* out) {
  add_product(factor, a, b, rows, inner, columns, out, columns);
}

/// out += factor * A^T B: A is inner x rows, B inner x columns; the rows of out are `width` long.
void add_transposed(double factor, const double* a, const double* b, int rows, int inner, int columns, double* out,
                    int width) {
  for (int k = 0; k < inner; ++k)
    for (int i = 0; i < rows; ++i) {
      const double x = factor * a[k * rows + i];
      if (x == 0) continue;
      for (int j = 0; j < columns; ++j) out[i * width + j] += x * b[k * columns + j];
    }
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
  diagonal_ = StageRows(stages, block_ * block_);
  coupling_ = StageRows(stages, block_ * sizes_.node);
  bordered_ = StageRows(stages, block_ * border_);
  corner_.resize(std::size_t(border_) * std::size_t(border_));
  for (long k = 0; k < stages; ++k) factors_.emplace_back(block_of(k));
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
  long sum = 0;
  for (long k = 0; k < sizes_.stages; ++k) sum += sizes_.equalities_of(k);
  return sum;
}

/// Of what is fixed: an unknown that stays zero.
void StageKkt::keep_zero(long stage, int at) {
  const int n = sizes_.node;
  const int block = block_of(stage);
  const int columns = columns_[std::size_t(stage)];
  double* here = diagonal_[stage];
  for (int q = 0; q < block; ++q) here[at * block + q] = here[q * block + at] = 0;
  for (int q = 0; q < n; ++q) coupling_[stage][at * n + q] = 0;
  for (int q = 0; q < columns; ++q) bordered_[stage][at * columns + q] = 0;
  here[at * block + at] = 1;
}

void StageKkt::assemble(const StageDerivatives& derivatives, const StageRows& sigma, HessianPart hessian_part) {
  const int n = sizes_.node;
  const int c = sizes_.control;
  const int d = sizes_.variables();
  std::fill(diagonal_.numbers().begin(), diagonal_.numbers().end(), 0.0);
  std::fill(coupling_.numbers().begin(), coupling_.numbers().end(), 0.0);
  std::fill(bordered_.numbers().begin(), bordered_.numbers().end(), 0.0);
  std::fill(corner_.begin(), corner_.end(), 0.0);
  std::vector<double>& h = block_work_;  // the stage's Hessian
  std::size_t phase = 0;
  int v_before = 0;  // where v_k began in the block of the stage before
  for (long k = 0; k < sizes_.stages; ++k) {
    if (k == sizes_.phases[phase].end) ++phase;
    const int m = sizes_.equalities_of(k);
    const int v = c + m;  // where v_{k+1} begins in a block
    const int block = v + n;
    const int columns = columns_[std::size_t(k)];
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
      for (int q = n; q < 2 * n + c; ++q) column[place(q) * columns] += hessian(q, variable);
      for (int row = 0; row < m; ++row) column[(c + row) * columns] += equality(row, variable);
    };
    for (int r = n; r < 2 * n + c; ++r)
      for (int q = n; q < 2 * n + c; ++q) here[place(r) * block + place(q)] += hessian(r, q);
    for (int row = 0; row < m; ++row)
      for (int q = n; q < 2 * n + c; ++q)
        here[(c + row) * block + place(q)] = here[place(q) * block + c + row] = equality(row, q);
    if (k > 0) {
      double* before = diagonal_[k - 1];
      const int block_before = v_before + n;
      for (int r = 0; r < n; ++r)
        for (int q = 0; q < n; ++q) before[(v_before + r) * block_before + v_before + q] += hessian(r, q);
      double* column = coupling_[k];
      for (int q = 0; q < n; ++q) {
        for (int r = n; r < 2 * n + c; ++r) column[place(r) * n + q] = hessian(r, q);
        for (int row = 0; row < m; ++row) column[(c + row) * n + q] = equality(row, q);
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
    if (const int last = duration_border_[phase]; last >= 0) {
      const int duration = sizes_.at_duration();
      add_border(last, duration);
      corner_[std::size_t(last * border_ + last)] += hessian(duration, duration);
      for (int q = 0; q < n; ++q) {
        if (k > 0) {
          bordered_[k - 1][(v_before + q) * columns_[std::size_t(k - 1)] + last] += hessian(q, duration);
        } else if (border_of_start(q) >= 0) {
          const int border = border_of_start(q);
          corner_[std::size_t(border * border_ + last)] += hessian(q, duration);
          corner_[std::size_t(last * border_ + border)] += hessian(duration, q);
        }
      }
    }
    v_before = v;
  }
  long k = 0;
  for (const TranscriptionPhase& each : sizes_.phases)
    for (; k < each.end; ++k)
      for (std::size_t i = 0; i < each.control_is_fixed.size(); ++i)
        if (each.control_is_fixed[i]) keep_zero(k, int(i));
  for (int i = 0; i < n; ++i)
    if (!free_end_[std::size_t(i)]) keep_zero(sizes_.stages - 1, v_before + i);
}

StageKkt::Inertia StageKkt::factor(double primal, const StageRows& dual) {
  primal_ = primal;
  dual_ = dual;
  const int n = sizes_.node;
  const int c = sizes_.control;
  Inertia inertia{0, std::numeric_limits<double>::infinity()};
  std::vector<double>& work = block_work_;
  std::vector<double>& corner = corner_work_;
  std::copy(corner_.begin(), corner_.end(), corner.begin());
  for (int i = 0; i < border_; ++i) corner[std::size_t(i * border_ + i)] += primal;
  int v_before = 0;
  for (long k = 0; k < sizes_.stages; ++k) {
    const int v = c + sizes_.equalities_of(k);
    const int block = v + n;
    const int columns = columns_[std::size_t(k)];
    std::copy(diagonal_[k], diagonal_[k] + block * block, work.begin());
    for (int i = 0; i < block; ++i) {
      const bool is_multiplier = i >= c && i < v;
      work[std::size_t(i * block + i)] += is_multiplier ? -dual[k][i - c] : primal;
    }
    // border_solved_ is on its way: the border here less what passes from the stages before.
    std::copy(bordered_[k], bordered_[k] + block * columns, border_solved_[k]);
    if (k > 0) {
      std::fill(column_work_.begin(), column_work_.begin() + block * n, 0.0);
      add_product(1, coupling_[k], passed_[k - 1], block, n, n, column_work_.data());
      for (int i = 0; i < block; ++i)
        for (int j = 0; j < block; ++j) {
          double sum = 0;
          for (int q = 0; q < n; ++q) sum += column_work_[std::size_t(i * n + q)] * coupling_[k][j * n + q];
          work[std::size_t(i * block + j)] -= sum;
        }
      const int columns_before = columns_[std::size_t(k - 1)];
      add_product(-1, coupling_[k], border_solved_[k - 1] + v_before * columns_before, block, n, columns_before,
                  border_solved_[k], columns);
    }
    SymmetricFactorSized& factor = factors_[std::size_t(k)];
    factor.compute(work.data());
    inertia.negative += factor.negative();
    inertia.smallest = std::min(inertia.smallest, factor.smallest());
    std::fill(column_work_.begin(), column_work_.begin() + block * n, 0.0);
    for (int q = 0; q < n; ++q) column_work_[std::size_t((v + q) * n + q)] = 1;
    factor.solve_in_place(column_work_.data(), n);
    for (int r = 0; r < n; ++r)
      for (int q = 0; q < n; ++q)
        passed_[k][r * n + q] =
            0.5 * (column_work_[std::size_t((v + r) * n + q)] + column_work_[std::size_t((v + q) * n + r)]);
    if (columns > 0) {
      std::copy(border_solved_[k], border_solved_[k] + block * columns, column_work_.begin());
      factor.solve_in_place(border_solved_[k], columns);
      add_transposed(-1, column_work_.data(), border_solved_[k], columns, block, columns, corner.data(), border_);
    }
    v_before = v;
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
  for (int q = 0; q < border_; ++q) border_right_[std::size_t(q)] = entry(right.primal, beside_[std::size_t(q)]);
  std::size_t phase = 0;
  int v_before = 0;
  for (long k = 0; k < sizes_.stages; ++k) {
    if (k == sizes_.phases[phase].end) ++phase;
    const int m = sizes_.equalities_of(k);
    const int v = c + m;
    const int block = v + n;
    const int columns = columns_[std::size_t(k)];
    double* here = right_[k];
    std::copy(right.primal.controls[k], right.primal.controls[k] + c, here);
    std::copy(right.multipliers[k], right.multipliers[k] + m, here + c);
    std::copy(right.primal.nodes[k + 1], right.primal.nodes[k + 1] + n, here + v);
    const std::vector<bool>& is_fixed = sizes_.phases[phase].control_is_fixed;
    for (std::size_t i = 0; i < is_fixed.size(); ++i)
      if (is_fixed[i]) here[i] = 0;
    if (k + 1 == sizes_.stages)
      for (int i = 0; i < n; ++i)
        if (!free_end_[std::size_t(i)]) here[v + i] = 0;
    if (k > 0) add_product(-1, coupling_[k], right_[k - 1] + v_before, block, n, 1, here);
    for (int q = 0; q < columns; ++q)
      for (int i = 0; i < block; ++i) border_right_[std::size_t(q)] -= border_solved_[k][i * columns + q] * here[i];
    factors_[std::size_t(k)].solve_in_place(here, 1);
    v_before = v;
  }
  if (border_ > 0) corner_factor_.solve_in_place(border_right_.data(), 1);
  double* column = column_work_.data();
  for (long k = sizes_.stages; k-- > 0;) {
    const int block = block_of(k);
    double* here = right_[k];
    add_product(-1, border_solved_[k], border_right_.data(), block, columns_[std::size_t(k)], 1, here);
    if (k + 1 < sizes_.stages) {
      // The pivot block's inverse times what the next stage's unknowns couple to v.
      std::fill(column, column + block, 0.0);
      add_transposed(1, coupling_[k + 1], right_[k + 1], n, block_of(k + 1), 1, column + block - n, 1);
      factors_[std::size_t(k)].solve_in_place(column, 1);
      for (int i = 0; i < block; ++i) here[i] -= column[i];
    }
  }
  std::fill(out.primal.nodes[0], out.primal.nodes[0] + n, 0.0);
  std::fill(out.primal.durations.begin(), out.primal.durations.end(), 0.0);
  for (int q = 0; q < border_; ++q) entry(out.primal, beside_[std::size_t(q)]) = border_right_[std::size_t(q)];
  for (long k = 0; k < sizes_.stages; ++k) {
    const double* here = right_[k];
    const int v = c + sizes_.equalities_of(k);
    std::copy(here, here + c, out.primal.controls[k]);
    std::copy(here + c, here + v, out.multipliers[k]);
    std::fill(out.multipliers[k] + (v - c), out.multipliers[k] + sizes_.equality, 0.0);
    std::copy(here + v, here + v + n, out.primal.nodes[k + 1]);
  }
}

void StageKkt::residual(const KktVector& right, const KktVector& out, KktVector& left) const {
  const int n = sizes_.node;
  const int c = sizes_.control;
  left = right;
  const auto beside = [&](int q) { return entry(out.primal, beside_[std::size_t(q)]); };
  const auto subtract_beside = [&](int q, double amount) { entry(left.primal, beside_[std::size_t(q)]) -= amount; };
  for (int q = 0; q < border_; ++q) {
    double sum = primal_ * beside(q);
    for (int r = 0; r < border_; ++r) sum += corner_[std::size_t(q * border_ + r)] * beside(r);
    subtract_beside(q, sum);
  }
  for (long k = 0; k < sizes_.stages; ++k) {
    const int v = c + sizes_.equalities_of(k);
    const int block = v + n;
    const int columns = columns_[std::size_t(k)];
    const auto of_stage = [&](int i) {
      return i < c ? out.primal.controls[k][i] : i < v ? out.multipliers[k][i - c] : out.primal.nodes[k + 1][i - v];
    };
    for (int i = 0; i < block; ++i) {
      const bool is_multiplier = i >= c && i < v;
      double sum = (is_multiplier ? -dual_[k][i - c] : primal_) * of_stage(i);
      for (int j = 0; j < block; ++j) sum += diagonal_[k][i * block + j] * of_stage(j);
      for (int q = 0; q < columns; ++q) sum += bordered_[k][i * columns + q] * beside(q);
      if (k > 0)
        for (int q = 0; q < n; ++q) sum += coupling_[k][i * n + q] * out.primal.nodes[k][q];
      (i < c   ? left.primal.controls[k][i]
       : i < v ? left.multipliers[k][i - c]
               : left.primal.nodes[k + 1][i - v]) -= sum;
    }
    if (k > 0)
      for (int q = 0; q < n; ++q) {
        double sum = 0;
        for (int i = 0; i < block; ++i) sum += coupling_[k][i * n + q] * of_stage(i);
        left.primal.nodes[k][q] -= sum;
      }
    for (int q = 0; q < columns; ++q) {
      double sum = 0;
      for (int i = 0; i < block; ++i) sum += bordered_[k][i * columns + q] * of_stage(i);
      subtract_beside(q, sum);
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
