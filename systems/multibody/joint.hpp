#pragma once
/// What ties the bodies of a scene together: equations C(q) = 0 on places or phi(g) = 0 on the motion of a step, with
/// their reactions. A joint of your own is a small struct with a value and a gradient.
///
///     struct OnPlane {
///       static constexpr int rows = 1;
///       std::array<Site, 1> sites;
///       void value(const Configuration& at, double* c) const { c[0] = at(sites[0])(2); }
///       void gradient(const Configuration& at, Vec* g, RowSize* size) const {
///         g[0] = {0, 0, 1};
///         size[0] = {at.size(sites[0]), 1};
///       }
///     };
///
/// It is added by `Scene::add`, and laws::joint_laws compare gradient and value. Requires what JointsOf lists.

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
template <class S = double> struct BasicSceneArrow {
  const BasicConfiguration<S>& before;
  const BasicConfiguration<S>& after;
  const std::vector<Vector<S, 3>>& displacements;  ///< of point masses and centres of mass, m
  const std::vector<Vector<S, 3>>& turns;          ///< coordinates xi of the attitudes' turns, in the bodies' frames
  S h;

  /// Of a point mass or a centre of mass; of a planar body's own place (Scene::planar_place) with its angle.
  const Vector<S, 3>& displacement(Site s) const { return displacements[std::size_t(s.index)]; }
  /// Zero for the ground.
  Vector<S, 3> turn(Attitude a) const {
    const auto i = std::size_t(a.index);
    return i < turns.size() ? turns[i] : Vector<S, 3>(Vector<S, 3>::Zero());
  }
};
using SceneArrow = BasicSceneArrow<>;

/// How the rows of a joint act.
enum class Role : char {
  holonomic,     ///< C(q') = 0, with reactions along dC
  nonholonomic,  ///< phi(g) = 0, with reactions along covectors omega(q) of its own
  vakonomic,     ///< phi(g) = 0, L + <lambda, phi> being the Lagrangian
  damping        ///< no constraint: discrete forces -c phi(g) omega / 2 at both ends
};

/// All joints of one kind: rows of the equations of a step.
///
/// Functions with `first` and `count` are for the joints first, ..., first + count - 1, and write their results one
/// joint after another. The gradient of a row is a list of vectors: one for each site of the joint, its derivative
/// along displacements of that point, then one for each attitude, its derivative along rotations of that body about the
/// body's axes. Both are displacements of the target of the arrow. Where `along_arrows`, they are instead derivatives
/// along the displacement over the arrow and the coordinates xi of the rotation over it, with the source held fixed.
template <class S = double> class BasicJoints {
 public:
  virtual ~BasicJoints() = default;
  virtual int rows() const = 0;
  virtual Role role() const = 0;
  virtual bool along_arrows() const = 0;
  virtual std::vector<Site> sites(int joint) const = 0;
  virtual std::vector<Attitude> attitudes(int joint) const = 0;
  virtual int count() const = 0;
  virtual void values(const BasicSceneArrow<S>& motion, int first, int count, S* c) const = 0;
  virtual void gradients(const BasicSceneArrow<S>& motion, int first, int count, Vector<S, 3>* g) const = 0;
  /// Of vakonomic rows: the gradients along the source, displacement and xi being held.
  virtual void drifts(const BasicSceneArrow<S>& motion, int first, int count, Vector<S, 3>* g) const = 0;
  /// The covectors of the reactions at an object, and the sizes of the rows there.
  virtual void reactions(const BasicConfiguration<S>& at, int first, int count, Vector<S, 3>* g,
                         RowSize* size) const = 0;
  /// Of damping rows: c.
  virtual S damping(int joint) const = 0;
  /// Of vakonomic rows: lambda at the start.
  virtual S multiplier(int joint, int row) const = 0;
  virtual void place(const Places& places) = 0;
  /// Puts them into this order.
  virtual void reorder(const std::vector<int>& order) = 0;
};
using Joints = BasicJoints<>;

/// A joint is a small struct with `rows`, the `sites` and, if it needs them, the `attitudes` it touches. On objects,
/// C(q) = 0, it writes
///     void value(const Configuration& at, double* c) const;
///     void gradient(const Configuration& at, Vec* g, RowSize* size) const;
/// on arrows, phi(g) = 0 between centres of mass and attitudes,
///     void value(const SceneArrow& motion, double* c) const;
///     void gradient(const SceneArrow& motion, Vec* g) const;
///     void reaction(const Configuration& at, Vec* g, RowSize* size) const;
/// (the gradient along the displacement and xi, or, with a member `along_target`, along turns at the target) and, to be
/// `Vakonomic` too,
///     void drift(const SceneArrow& motion, Vec* g) const;
/// With a member `damping` it is no constraint but a damper, of the rate of C or of phi.
template <class J, class S = double> class JointsOf final : public BasicJoints<S> {
 public:
  static constexpr int width = J::rows * (site_count<J>() + attitude_count<J>());
  static constexpr bool arrows = requires(const J& joint, const BasicSceneArrow<S>& motion, S* c) {
    joint.value(motion, c);
  };
  static constexpr bool damps = requires(const J& joint) { joint.damping; };
  static constexpr bool optimal = requires(const J& joint) { joint.multipliers; };

  void add(const J& joint) { all_.push_back(joint); }
  int rows() const override { return J::rows; }
  Role role() const override {
    return damps ? Role::damping : optimal ? Role::vakonomic : arrows ? Role::nonholonomic : Role::holonomic;
  }
  bool along_arrows() const override {
    return arrows && !requires { J::along_target; };
  }
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
  void values(const BasicSceneArrow<S>& motion, int first, int count, S* c) const override {
    const J* joint = all_.data() + first;
    for (int i = 0; i < count; ++i) {
      if constexpr (arrows) {
        joint[i].value(motion, c + i * J::rows);
      } else {
        joint[i].value(motion.after, c + i * J::rows);
        if constexpr (damps) {
          S before[J::rows];
          joint[i].value(motion.before, before);
          for (int row = 0; row < J::rows; ++row) c[i * J::rows + row] -= before[row];
        }
      }
    }
  }
  void gradients(const BasicSceneArrow<S>& motion, int first, int count, Vector<S, 3>* g) const override {
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
  void drifts(const BasicSceneArrow<S>& motion, int first, int count, Vector<S, 3>* g) const override {
    if constexpr (optimal)
      for (int i = 0; i < count; ++i) all_[std::size_t(first + i)].drift(motion, g + i * width);
  }
  S damping(int joint) const override {
    if constexpr (damps) return all_[std::size_t(joint)].damping;
    return 0;
  }
  S multiplier(int joint, int row) const override {
    if constexpr (optimal) return all_[std::size_t(joint)].multipliers[std::size_t(row)];
    return 0;
  }
  void reactions(const BasicConfiguration<S>& at, int first, int count, Vector<S, 3>* g, RowSize* size) const override {
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
