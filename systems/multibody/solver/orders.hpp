#pragma once
/// What belongs together, and in which order: what `assemble` sorts factors, points and joints by.

#include <algorithm>
#include <cstddef>
#include <numeric>
#include <vector>

namespace lagroid::multibody {

/// Sets of factors that joints tie together.
class Groups {
 public:
  explicit Groups(int size) : parent_(std::size_t(size)) { std::iota(parent_.begin(), parent_.end(), 0); }
  int of(int i) {
    while (parent_[std::size_t(i)] != i) {
      parent_[std::size_t(i)] = parent_[std::size_t(parent_[std::size_t(i)])];
      i = parent_[std::size_t(i)];
    }
    return i;
  }
  void join(int i, int j) { parent_[std::size_t(of(i))] = of(j); }

 private:
  std::vector<int> parent_;
};

/// The order that sorts by key; equal ones stay as they are.
inline std::vector<int> sorted_by(const std::vector<int>& key) {
  std::vector<int> order(key.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return key[std::size_t(i)] < key[std::size_t(j)]; });
  return order;
}

inline std::vector<int> inverse(const std::vector<int>& order) {
  std::vector<int> place(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) place[std::size_t(order[k])] = int(k);
  return place;
}

template <class T> std::vector<T> in_order(const std::vector<T>& all, const std::vector<int>& order) {
  std::vector<T> out;
  out.reserve(all.size());
  for (const int i : order) out.push_back(all[std::size_t(i)]);
  return out;
}

}  // namespace lagroid::multibody
