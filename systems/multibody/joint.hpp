#pragma once
/// What ties the bodies of a scene together.

#include <lagroid/systems/multibody/effect.hpp>

#include <algorithm>
#include <vector>

namespace lagroid::multibody {

/// What a row's round-off is relative to.
struct RowSize {
  double terms = 0;  ///< size of the terms that it is a sum of
  double slope = 0;  ///< of its gradient: a sum of norms
};

/// All joints of one kind: holonomic constraints C(q) = 0, rows of one step's equations.
///
/// `first` and `count` choose some of them. Of each joint the gradients stand one after another: for every row one
/// vector a site (dC/dx) and one an attitude (the derivative along turns of the body about its axes).
class Joints {
 public:
  virtual ~Joints() = default;
  virtual int rows() const = 0;
  virtual std::vector<Site> sites(int joint) const = 0;
  virtual std::vector<Attitude> attitudes(int joint) const = 0;
  virtual int count() const = 0;
  virtual void values(const Configuration& at, int first, int count, double* c) const = 0;
  virtual void gradients(const Configuration& at, int first, int count, Vec* g, RowSize* size) const = 0;
  virtual void place(const Places& places) = 0;
  /// Puts them into this order.
  virtual void reorder(const std::vector<int>& order) = 0;
};

/// A joint is a small struct with `rows`, the `sites` and, if it needs them, the `attitudes` it touches, and
///     void value(const Configuration& at, double* c) const;
///     void gradient(const Configuration& at, Vec* g, RowSize* size) const;
template <class J> class JointsOf final : public Joints {
 public:
  static constexpr int width = J::rows * (site_count<J>() + attitude_count<J>());

  void add(const J& joint) { all_.push_back(joint); }
  int rows() const override { return J::rows; }
  int count() const override { return int(all_.size()); }
  std::vector<Site> sites(int joint) const override {
    const auto& s = all_[std::size_t(joint)].sites;
    return {s.begin(), s.end()};
  }
  std::vector<Attitude> attitudes(int joint) const override {
    if constexpr (attitude_count<J>() > 0) {
      const auto& a = all_[std::size_t(joint)].attitudes;
      return {a.begin(), a.end()};
    } else {
      return {};
    }
  }
  void values(const Configuration& at, int first, int count, double* c) const override {
    const J* joint = all_.data() + first;
    for (int i = 0; i < count; ++i) joint[i].value(at, c + i * J::rows);
  }
  void gradients(const Configuration& at, int first, int count, Vec* g, RowSize* size) const override {
    const J* joint = all_.data() + first;
    for (int i = 0; i < count; ++i) joint[i].gradient(at, g + i * width, size + i * J::rows);
  }
  void place(const Places& places) override {
    for (J& joint : all_) place_kernel(joint, places);
  }
  void reorder(const std::vector<int>& order) override {
    std::vector<J> sorted;
    for (const int i : order) sorted.push_back(all_[std::size_t(i)]);
    all_ = std::move(sorted);
  }

 private:
  std::vector<J> all_;
};

}  // namespace lagroid::multibody
