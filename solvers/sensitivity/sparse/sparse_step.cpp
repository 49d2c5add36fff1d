#include <lagroid/solvers/sensitivity/sparse/sparse_step.hpp>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace lagroid {

namespace {

/// So many right sides at a time stay in the cache.
constexpr Eigen::Index at_once = 16;

/// Of each of so many, the smallest that it is coupled to.
std::vector<int> groups_of(int count, const StepPattern& pattern) {
  std::vector<int> root(std::size_t(count), 0);
  std::iota(root.begin(), root.end(), 0);
  const auto find = [&](int i) {
    while (root[std::size_t(i)] != i) i = root[std::size_t(i)] = root[std::size_t(root[std::size_t(i)])];
    return i;
  };
  for (int j = 0; j < count; ++j)
    for (const int i : pattern.column(j)) {
      if (i >= count) break;
      const int a = find(i), b = find(j);
      root[std::size_t(std::max(a, b))] = std::min(a, b);
    }
  for (int i = 0; i < count; ++i) root[std::size_t(i)] = find(i);
  return root;
}

int place_of(const std::vector<int>& sorted, int x) {
  return int(std::lower_bound(sorted.begin(), sorted.end(), x) - sorted.begin());
}
void make_sorted_set(std::vector<int>& x) {
  std::sort(x.begin(), x.end());
  x.erase(std::unique(x.begin(), x.end()), x.end());
}

template <class T> std::span<const T> between(const std::vector<T>& all, int first, int last) {
  return {all.data() + first, std::size_t(last - first)};
}

/// y += a x.
void add(double a, const double* x, double* y, int sides) {
  if (sides == 1) {
    *y += a * *x;
    return;
  }
  for (int k = 0; k < sides; ++k) y[k] += a * x[k];
}

}  // namespace

SparseStep::SparseStep(std::shared_ptr<const StepPattern> pattern)
    : values(pattern->rows.size(), 0.0), pattern_(std::move(pattern)) {
  struct Parts {
    std::vector<int> unknowns, rows, columns;
    std::vector<Entry> own, right, below;
  };
  const int leading = pattern_->leading, equations = pattern_->equations;
  std::vector<Parts> parts;
  std::vector<int> part(std::size_t(leading), -1);
  const std::vector<int> roots = groups_of(leading, *pattern_);
  for (int i = 0; i < leading; ++i) {
    int& of = part[std::size_t(roots[std::size_t(i)])];
    if (of < 0) {
      of = int(parts.size());
      parts.emplace_back();
    }
    part[std::size_t(i)] = of;
    parts[std::size_t(of)].unknowns.push_back(i);
  }
  const auto part_of = [&](int unknown) -> Parts& { return parts[std::size_t(part[std::size_t(unknown)])]; };
  const auto each_entry = [&](const auto& visit) {
    for (int j = 0; j < equations; ++j)
      for (int k = pattern_->begins[std::size_t(j)]; k < pattern_->begins[std::size_t(j) + 1]; ++k)
        if (const int i = pattern_->rows[std::size_t(k)]; i < equations) visit(i, j, k);
  };
  std::vector<std::pair<int, int>> pairs;
  each_entry([&](int i, int j, int k) {
    if (i < leading && j >= leading) {
      part_of(i).columns.push_back(j - leading);
      couplings_.push_back({i, j, k});
    }
    if (i >= leading && j < leading) {
      part_of(j).rows.push_back(i - leading);
      reactions_.push_back({i, j, k});
    }
    if (i >= leading && j >= leading && i != j) pairs.emplace_back(i - leading, j - leading);
  });
  for (Parts& each : parts) {
    make_sorted_set(each.rows);
    make_sorted_set(each.columns);
    for (const int i : each.rows)
      for (const int j : each.columns)
        if (i != j) pairs.emplace_back(i, j);
  }
  schur_ = Elimination(equations - leading, pairs);
  each_entry([&](int i, int j, int k) {
    if (i >= leading && j >= leading) {
      multipliers_.push_back({schur_.index(i - leading, j - leading), k});
      return;
    }
    Parts& mine = part_of(std::min(i, j));
    if (i < leading && j < leading)
      mine.own.push_back({place_of(mine.unknowns, i), place_of(mine.unknowns, j), k});
    else if (i < leading)
      mine.right.push_back({place_of(mine.unknowns, i), place_of(mine.columns, j - leading), k});
    else
      mine.below.push_back({place_of(mine.rows, i - leading), place_of(mine.unknowns, j), k});
  });
  std::size_t inverses = 0;
  const auto begin_group = [&](std::size_t columns) {
    groups_.push_back({int(unknowns_.size()), int(inverses), int(own_.size()), int(right_.size()), int(below_.size()),
                       int(products_.size()), int(columns)});
  };
  const auto append = [](auto& to, const auto& from) { to.insert(to.end(), from.begin(), from.end()); };
  for (const Parts& each : parts) {
    begin_group(each.columns.size());
    append(unknowns_, each.unknowns);
    append(own_, each.own);
    append(right_, each.right);
    append(below_, each.below);
    for (const int i : each.rows)
      for (const int j : each.columns) products_.push_back(schur_.index(i, j));
    inverses += each.unknowns.size() * each.unknowns.size();
  }
  begin_group(0);
  inverses_.resize(inverses);
}

bool SparseStep::factor() {
  dense_.reset();
  if (!std::all_of(values.begin(), values.end(), [](double x) { return std::isfinite(x); })) return false;
  return eliminate() || factor_densely();
}

bool SparseStep::eliminate() {
  constexpr double regular = 1e-13;
  schur_.clear();
  for (const Own& each : multipliers_) schur_.value(each.place) += values[std::size_t(each.value)];
  Eigen::MatrixXd own, right;
  for (std::size_t g = 0; g + 1 < groups_.size(); ++g) {
    const Group &each = groups_[g], &next = groups_[g + 1];
    const int size = next.unknown - each.unknown;
    Eigen::Map<Eigen::MatrixXd> inverse(inverses_.data() + each.inverse, size, size);
    if (size == 1 && next.own - each.own == 1) {
      const double pivot = values[std::size_t(own_[std::size_t(each.own)].value)];
      if (pivot == 0) return false;
      inverse(0) = 1 / pivot;
    } else {
      own.setZero(size, size);
      for (const Entry& e : between(own_, each.own, next.own)) own(e.row, e.column) = values[std::size_t(e.value)];
      inverse = own.partialPivLu().inverse();
      if (!(own.lpNorm<1>() * inverse.lpNorm<1>() < 1 / regular)) return false;
    }
    right.setZero(size, each.columns);
    for (const Entry& e : between(right_, each.right, next.right))
      for (int i = 0; i < size; ++i) right(i, e.column) += values[std::size_t(e.value)] * inverse(i, e.row);
    for (const Entry& e : between(below_, each.below, next.below)) {
      const int* const product = products_.data() + each.product + e.row * each.columns;
      for (int c = 0; c < each.columns; ++c)
        schur_.value(product[c]) -= values[std::size_t(e.value)] * right(e.column, c);
    }
  }
  return schur_.factorise();
}

bool SparseStep::factor_densely() {
  const int equations = pattern_->equations, states = pattern_->states;
  dense_.emplace(equations, states, pattern_->columns() - equations - states);
  for (int j = 0; j < pattern_->columns(); ++j)
    for (int k = pattern_->begins[std::size_t(j)]; k < pattern_->begins[std::size_t(j) + 1]; ++k) {
      const int i = pattern_->rows[std::size_t(k)];
      auto& of = j < equations ? (i < equations ? dense_->equations_by_unknowns : dense_->end_by_unknowns)
                               : (i < equations ? dense_->equations_by_start : dense_->end_by_start);
      of(i < equations ? i : i - equations, j < equations ? j : j - equations) = values[std::size_t(k)];
    }
  return dense_->factor();
}

void SparseStep::add_product(int first, double sign, const Rows& x, Rows& out) const {
  const int sides = int(x.cols());
  for (int j = 0; j < int(x.rows()); ++j) {
    if (x.row(j).isZero(0)) continue;  // directions of single numbers are zero elsewhere
    for (int k = pattern_->begins[std::size_t(first + j)]; k < pattern_->begins[std::size_t(first + j) + 1]; ++k)
      add(sign * values[std::size_t(k)], x.data() + j * sides, out.data() + pattern_->rows[std::size_t(k)] * sides,
          sides);
  }
}

SparseStep::Rows SparseStep::transposed_product(int first, int count, const Rows& y) const {
  const int sides = int(y.cols());
  Rows out = Rows::Zero(count, sides);
  const int* const rows = pattern_->rows.data();
  for (int j = 0; j < count; ++j) {
    const int begin = pattern_->begins[std::size_t(first + j)], end = pattern_->begins[std::size_t(first + j) + 1];
    if (sides == 1) {
      double sum = 0;
      for (int k = begin; k < end; ++k) sum += values[std::size_t(k)] * y(rows[k], 0);
      out(j, 0) = sum;
      continue;
    }
    for (int k = begin; k < end; ++k)
      add(values[std::size_t(k)], y.data() + rows[k] * sides, out.data() + j * sides, sides);
  }
  return out;
}

void SparseStep::divide(Rows& x, bool transposed) const {
  const int sides = int(x.cols());
  for (std::size_t g = 0; g + 1 < groups_.size(); ++g) {
    const Group& each = groups_[g];
    const int size = groups_[g + 1].unknown - each.unknown;
    const int* const unknowns = unknowns_.data() + each.unknown;
    if (size == 1) {
      double* const row = x.data() + *unknowns * sides;
      for (int s = 0; s < sides; ++s) row[s] *= inverses_[std::size_t(each.inverse)];
      continue;
    }
    const Eigen::Map<const Eigen::MatrixXd> inverse(inverses_.data() + each.inverse, size, size);
    Rows before(size, sides);
    for (int i = 0; i < size; ++i) before.row(i) = x.row(unknowns[i]);
    for (int i = 0; i < size; ++i) {
      x.row(unknowns[i]).setZero();
      for (int j = 0; j < size; ++j)
        add(transposed ? inverse(j, i) : inverse(i, j), before.data() + j * sides, x.data() + unknowns[i] * sides,
            sides);
    }
  }
}

void SparseStep::solve(Rows& right) const {
  const int sides = int(right.cols());
  Rows leads = right.topRows(pattern_->leading);
  divide(leads, false);
  for (const Entry& e : reactions_)
    add(-values[std::size_t(e.value)], leads.data() + e.column * sides, right.data() + e.row * sides, sides);
  schur_.solve(right.data() + pattern_->leading * sides, sides);
  for (const Entry& e : couplings_)
    add(-values[std::size_t(e.value)], right.data() + e.column * sides, right.data() + e.row * sides, sides);
  divide(right, false);
}

void SparseStep::solve_transposed(Rows& right) const {
  const int sides = int(right.cols());
  Rows leads = right.topRows(pattern_->leading);
  divide(leads, true);
  for (const Entry& e : couplings_)
    add(-values[std::size_t(e.value)], leads.data() + e.row * sides, right.data() + e.column * sides, sides);
  schur_.solve_transposed(right.data() + pattern_->leading * sides, sides);
  for (const Entry& e : reactions_)
    add(-values[std::size_t(e.value)], right.data() + e.row * sides, right.data() + e.column * sides, sides);
  divide(right, true);
}

Eigen::MatrixXd SparseStep::unknowns(const Eigen::MatrixXd& directions) const {
  if (dense_) return -dense_->equations_by_unknowns.fullPivLu().solve(dense_->equations_by_start * directions);
  const int equations = pattern_->equations;
  Rows right = Rows::Zero(equations + pattern_->states, directions.cols());
  add_product(equations, 1, directions, right);
  Rows out = -right.topRows(equations);
  solve(out);
  return out;
}

Eigen::MatrixXd SparseStep::forward(const Eigen::MatrixXd& directions) const {
  if (dense_) return dense_->forward(directions);
  const int equations = pattern_->equations, states = pattern_->states;
  Eigen::MatrixXd out = directions;
  for (Eigen::Index first = 0; first < directions.cols(); first += at_once) {
    const Eigen::Index sides = std::min(at_once, directions.cols() - first);
    const Rows some = directions.middleCols(first, sides);
    Rows left = Rows::Zero(equations + states, sides);
    add_product(equations, 1, some, left);
    Rows unknowns = left.topRows(equations);
    solve(unknowns);
    add_product(0, -1, unknowns, left);
    out.block(0, first, states, sides) = left.bottomRows(states);
  }
  return out;
}

Eigen::MatrixXd SparseStep::backward(const Eigen::MatrixXd& gradients) const {
  if (dense_) return dense_->backward(gradients);
  const int equations = pattern_->equations, states = pattern_->states, start = pattern_->columns() - equations;
  Eigen::MatrixXd out = gradients;
  for (Eigen::Index first = 0; first < gradients.cols(); first += at_once) {
    const Eigen::Index sides = std::min(at_once, gradients.cols() - first);
    Rows rows = Rows::Zero(equations + states, sides);
    rows.bottomRows(states) = gradients.block(0, first, states, sides);
    Rows multipliers = transposed_product(0, equations, rows);
    solve_transposed(multipliers);
    rows.topRows(equations) = -multipliers;
    out.block(0, first, states, sides).setZero();
    out.middleCols(first, sides) += transposed_product(equations, start, rows);
  }
  return out;
}

std::size_t SparseStep::entries() const { return values.size() + inverses_.size() + schur_.entries(); }

}  // namespace lagroid
