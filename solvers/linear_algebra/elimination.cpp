#include <lagroid/solvers/linear_algebra/elimination.hpp>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <set>

namespace lagroid {

Elimination::Elimination(int size, const std::vector<std::pair<int, int>>& pairs) : order_(std::size_t(size), -1) {
  // The unknowns that each is coupled to. The next to go is always one coupled to the fewest; the others it is coupled
  // to are coupled to each other then. (Approximate degrees, as of AMD, are cheaper to find, but fill trees in.)
  std::vector<std::set<int>> coupled(std::size_t(size), std::set<int>{});
  for (const auto& [i, j] : pairs) {
    if (i == j) continue;
    coupled[std::size_t(i)].insert(j);
    coupled[std::size_t(j)].insert(i);
  }
  std::set<std::pair<std::size_t, int>> fewest;
  for (int i = 0; i < size; ++i) fewest.emplace(coupled[std::size_t(i)].size(), i);
  const auto change = [&](int i, const auto& edit) {
    auto& mine = coupled[std::size_t(i)];
    fewest.erase({mine.size(), i});
    edit(mine);
    fewest.emplace(mine.size(), i);
  };
  std::vector<std::vector<int>> later;
  while (!fewest.empty()) {
    const int next = fewest.begin()->second;
    fewest.erase(fewest.begin());
    order_[std::size_t(next)] = int(later.size());
    later.emplace_back(coupled[std::size_t(next)].begin(), coupled[std::size_t(next)].end());
    const auto& others = later.back();
    for (const int i : others)
      change(i, [&](std::set<int>& mine) {
        mine.erase(next);
        for (const int j : others)
          if (i != j) mine.insert(j);
      });
  }
  pivots_.resize(std::size_t(size));
  for (int i = 0; i < size; ++i) pivots_[std::size_t(order_[std::size_t(i)])].unknown = i;
  for (std::size_t k = 0; k < pivots_.size(); ++k) {
    auto& mine = later[k];
    std::sort(mine.begin(), mine.end(), [&](int i, int j) { return order_[std::size_t(i)] < order_[std::size_t(j)]; });
    pivots_[k].values = int(values_.size());
    pivots_[k].count = int(mine.size());
    pivots_[k].others = int(others_.size());
    values_.resize(values_.size() + 1 + 2 * mine.size());
    others_.insert(others_.end(), mine.begin(), mine.end());
  }
  for (const auto& pivot : pivots_)
    for (int a = 0; a < pivot.count; ++a)
      for (int b = 0; b < pivot.count; ++b)
        products_.push_back(index(others_[std::size_t(pivot.others + a)], others_[std::size_t(pivot.others + b)]));
  first_.resize(pivots_.size());
}

int Elimination::index(int i, int j) const {
  const int a = order_[std::size_t(i)];
  const int b = order_[std::size_t(j)];
  const Pivot& pivot = pivots_[std::size_t(std::min(a, b))];
  if (a == b) return pivot.values;
  const auto first = others_.begin() + pivot.others;
  const auto found = std::lower_bound(first, first + pivot.count, std::max(a, b),
                                      [&](int other, int place) { return order_[std::size_t(other)] < place; });
  const int at = int(found - first);
  return pivot.values + 1 + at + (a > b ? 0 : pivot.count);
}

void Elimination::clear() { std::fill(values_.begin(), values_.end(), 0.0); }

template <bool LeaveOut> bool Elimination::eliminate(double least, std::vector<int>* dependent) {
  double* const v = values_.data();
  for (std::size_t k = 0; k < pivots_.size(); ++k) first_[k] = v[pivots_[k].values];
  const int* product = products_.data();
  for (std::size_t k = 0; k < pivots_.size(); ++k) {
    Pivot& pivot = pivots_[k];
    double* const diagonal = v + pivot.values;
    double* const column = diagonal + 1;
    double* const row = column + pivot.count;
    const bool regular = std::abs(*diagonal) > least * std::abs(first_[k]);
    if (!regular || pivot.left_out) {
      if constexpr (LeaveOut) {
        if (!pivot.left_out) dependent->push_back(pivot.unknown);
        pivot.left_out = true;
      }
      if (!pivot.left_out) return false;
      *diagonal = 0;
      std::fill(column, row, 0.0);
      product += pivot.count * pivot.count;
      continue;
    }
    const double inverse = 1 / *diagonal;
    *diagonal = inverse;
    for (int a = 0; a < pivot.count; ++a) column[a] *= inverse;
    for (int a = 0; a < pivot.count; ++a)
      for (int b = 0; b < pivot.count; ++b) v[*product++] -= column[a] * row[b];
  }
  return true;
}

bool Elimination::factorise() { return eliminate<false>(1e-13, nullptr); }

std::vector<int> Elimination::leave_out_dependent() {
  std::vector<int> dependent;
  for (Pivot& pivot : pivots_) pivot.left_out = false;
  eliminate<true>(1e-9, &dependent);
  return dependent;
}

void Elimination::solve(double* b) const {
  const double* const v = values_.data();
  for (const Pivot& pivot : pivots_) {
    const double* const column = v + pivot.values + 1;
    const int* const others = others_.data() + pivot.others;
    const double known = b[pivot.unknown];
    for (int a = 0; a < pivot.count; ++a) b[others[a]] -= column[a] * known;
  }
  for (auto pivot = pivots_.rbegin(); pivot != pivots_.rend(); ++pivot) {
    const double* const row = v + pivot->values + 1 + pivot->count;
    const int* const others = others_.data() + pivot->others;
    double sum = b[pivot->unknown];
    for (int a = 0; a < pivot->count; ++a) sum -= row[a] * b[others[a]];
    b[pivot->unknown] = sum * v[pivot->values];
  }
}

namespace {

/// y -= a x.
void subtract(double a, const double* x, double* y, int sides) {
  if (sides == 1) {
    *y -= a * *x;
    return;
  }
  for (int k = 0; k < sides; ++k) y[k] -= a * x[k];
}

}  // namespace

void Elimination::solve(double* b, int sides) const {
  const double* const v = values_.data();
  const auto of = [&](int unknown) { return b + std::ptrdiff_t(unknown) * sides; };
  for (const Pivot& pivot : pivots_) {
    const double* const column = v + pivot.values + 1;
    const int* const others = others_.data() + pivot.others;
    for (int a = 0; a < pivot.count; ++a) subtract(column[a], of(pivot.unknown), of(others[a]), sides);
  }
  for (auto pivot = pivots_.rbegin(); pivot != pivots_.rend(); ++pivot) {
    const double* const row = v + pivot->values + 1 + pivot->count;
    const int* const others = others_.data() + pivot->others;
    double* const mine = of(pivot->unknown);
    for (int a = 0; a < pivot->count; ++a) subtract(row[a], of(others[a]), mine, sides);
    for (int k = 0; k < sides; ++k) mine[k] *= v[pivot->values];
  }
}

void Elimination::solve_transposed(double* b, int sides) const {
  const double* const v = values_.data();
  const auto of = [&](int unknown) { return b + std::ptrdiff_t(unknown) * sides; };
  for (const Pivot& pivot : pivots_) {
    const double* const row = v + pivot.values + 1 + pivot.count;
    const int* const others = others_.data() + pivot.others;
    double* const mine = of(pivot.unknown);
    for (int k = 0; k < sides; ++k) mine[k] *= v[pivot.values];
    for (int a = 0; a < pivot.count; ++a) subtract(row[a], mine, of(others[a]), sides);
  }
  for (auto pivot = pivots_.rbegin(); pivot != pivots_.rend(); ++pivot) {
    const double* const column = v + pivot->values + 1;
    const int* const others = others_.data() + pivot->others;
    for (int a = 0; a < pivot->count; ++a) subtract(column[a], of(others[a]), of(pivot->unknown), sides);
  }
}

}  // namespace lagroid
