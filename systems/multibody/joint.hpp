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

/// One arrow of a scene: two configurations, and the motion between them without the rounding of their difference.
struct Motion {
  const Configuration& before;
  const Configuration& after;
  const std::vector<Vec>& displacements;  ///< of point masses and centres of mass, m
  const std::vector<Vec>& turns;          ///< coordinates xi of the attitudes' turns, in the bodies' frames
  double h;

  /// Of a point mass or a centre of mass.
  const Vec& displacement(Site s) const { return displacements[std::size_t(s.index)]; }
  const Vec& turn(Attitude a) const { return turns[std::size_t(a.index)]; }
};

/// All joints of one kind: rows of one step's equations.
///
/// Those on objects are holonomic constraints C(q) = 0, whose reactions are multiples of dC. Those on arrows are
/// nonholonomic: phi(g) = 0, with reactions of their own at the source.
///
/// `first` and `count` choose some of them. Of each joint the gradients stand one after another: for every row one
/// vector a site and one an attitude. On objects dC/dx, and the derivative along turns of the body about its axes; on
/// arrows the derivatives along the displacement and the coordinates xi of the turn.
class Joints {
 public:
  virtual ~Joints() = default;
  virtual int rows() const = 0;
  virtual bool on_arrows() const = 0;
  virtual std::vector<Site> sites(int joint) const = 0;
  virtual std::vector<Attitude> attitudes(int joint) const = 0;
  virtual int count() const = 0;
  virtual void values(const Motion& motion, int first, int count, double* c) const = 0;
  virtual void gradients(const Motion& motion, int first, int count, Vec* g) const = 0;
  /// The covectors of the reactions at an object, and the sizes of the rows there.
  virtual void reactions(const Configuration& at, int first, int count, Vec* g, RowSize* size) const = 0;
  virtual void place(const Places& places) = 0;
  /// Puts them into this order.
  virtual void reorder(const std::vector<int>& order) = 0;
};

/// A joint is a small struct with `rows`, the `sites` and, if it needs them, the `attitudes` it touches. On objects it
/// writes
///     void value(const Configuration& at, double* c) const;
///     void gradient(const Configuration& at, Vec* g, RowSize* size) const;
/// on arrows, between centres of mass and attitudes,
///     void value(const Motion& motion, double* c) const;
///     void gradient(const Motion& motion, Vec* g) const;
///     void reaction(const Configuration& at, Vec* g, RowSize* size) const;
template <class J> class JointsOf final : public Joints {
 public:
  static constexpr int width = J::rows * (site_count<J>() + attitude_count<J>());
  static constexpr bool arrows = requires(const J& joint, const Motion& motion, double* c) { joint.value(motion, c); };

  void add(const J& joint) { all_.push_back(joint); }
  int rows() const override { return J::rows; }
  bool on_arrows() const override { return arrows; }
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
  void values(const Motion& motion, int first, int count, double* c) const override {
    const J* joint = all_.data() + first;
    for (int i = 0; i < count; ++i) {
      if constexpr (arrows) {
        joint[i].value(motion, c + i * J::rows);
      } else {
        joint[i].value(motion.after, c + i * J::rows);
      }
    }
  }
  void gradients(const Motion& motion, int first, int count, Vec* g) const override {
    const J* joint = all_.data() + first;
    for (int i = 0; i < count; ++i) {
      if constexpr (arrows) {
        joint[i].gradient(motion, g + i * width);
      } else {
        RowSize size[J::rows];
        joint[i].gradient(motion.after, g + i * width, size);
      }
    }
  }
  void reactions(const Configuration& at, int first, int count, Vec* g, RowSize* size) const override {
    const J* joint = all_.data() + first;
    for (int i = 0; i < count; ++i) {
      if constexpr (arrows) {
        joint[i].reaction(at, g + i * width, size + i * J::rows);
      } else {
        joint[i].gradient(at, g + i * width, size + i * J::rows);
      }
    }
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
