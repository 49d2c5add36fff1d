#include <lagroid/solvers/elimination.hpp>

#include <Eigen/OrderingMethods>
#include <Eigen/SparseCore>

#include <algorithm>
#include <cmath>
#include <set>

namespace lagroid {

namespace {

/// Place of each unknown in the order of elimination.
std::vector<int> minimum_degree(int size, const std::vector<std::pair<int, int>>& pairs) {
  std::vector<Eigen::Triplet<double>> entries;
  for (int i = 0; i < size; ++i) entries.emplace_back(i, i, 1.0);
  for (const auto& [i, j] : pairs) {
    entries.emplace_back(i, j, 1.0);
    entries.emplace_back(j, i, 1.0);
  }
  Eigen::SparseMatrix<double> pattern(size, size);
  pattern.setFromTriplets(entries.begin(), entries.end());
  Eigen::AMDOrdering<int>::PermutationType permutation;
  Eigen::AMDOrdering<int>()(pattern, permutation);
  std::vector<int> place(std::size_t(size), 0);
  for (int k = 0; k < size; ++k) place[std::size_t(permutation.indices()(k))] = k;
  return place;
}

}  // namespace

Elimination::Elimination(int size, const std::vector<std::pair<int, int>>& pairs)
    : order_(minimum_degree(size, pairs)) {
  std::vector<int> unknown(std::size_t(size), 0);
  for (int i = 0; i < size; ++i) unknown[std::size_t(order_[std::size_t(i)])] = i;
  // Of each pivot the places after it that it is coupled to; eliminating it couples these.
  std::vector<std::set<int>> later(std::size_t(size), std::set<int>{});
  for (const auto& [i, j] : pairs) {
    const int a = order_[std::size_t(i)];
    const int b = order_[std::size_t(j)];
    if (a != b) later[std::size_t(std::min(a, b))].insert(std::max(a, b));
  }
  for (int k = 0; k < size; ++k) {
    auto& mine = later[std::size_t(k)];
    const int count = int(mine.size());
    pivots_.push_back({unknown[std::size_t(k)], int(values_.size()), count, int(others_.size())});
    values_.resize(values_.size() + 1 + 2 * std::size_t(count));
    for (const int place : mine) others_.push_back(unknown[std::size_t(place)]);
    for (auto a = mine.begin(); a != mine.end(); ++a)
      for (auto b = std::next(a); b != mine.end(); ++b) later[std::size_t(*a)].insert(*b);
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

}  // namespace lagroid
