#pragma once
/// What a scene is while it moves, the same from its first node to its last: factors of the groupoid, points, rows of
/// joints, and islands, in arrays sorted by island. A detail of Multibody, made by `assemble`.

#include <lagroid/solvers/linear_algebra/elimination.hpp>
#include <lagroid/systems/multibody/joint.hpp>
#include <lagroid/systems/multibody/rotation_increment.hpp>

#include <cmath>
#include <cstddef>
#include <functional>
#include <memory>
#include <span>
#include <vector>

namespace lagroid::multibody {

/// What a scene is while it moves, the same from its first node to its last but for what is switched: the factors of
/// its groupoid, the points that joints and effects know, the rows of the joints, and the islands, what joints tie
/// together. Factors and what
/// belongs to them are sorted by island.
template <class S = double> struct BasicModel {
  struct Range {
    int first = 0;
    int last = 0;
    int size() const { return last - first; }
    /// These of all.
    template <class T> std::span<const T> of(const std::vector<T>& all) const {
      return {all.data() + first, std::size_t(size())};
    }
  };

  /// A linear factor on which the force -drag v acts.
  struct Dragged {
    int factor;
    Matrix<S, 3, 3> drag;
  };
  /// Linear factors (point masses, centres of mass, planar bodies) and rotations; those of no island first.
  struct Factors {
    std::vector<Vector<S, 3>> inertia;
    std::vector<char> planar;
    std::vector<Dragged> dragged;
    std::vector<Vector<S, 3>> moments;
    Retraction rotation = Retraction::exponential;
    std::vector<Vector<S, 3>> turn_damping;
    std::vector<int> damped_turns;  ///< the rotations of which it is not zero
  };

  /// A point fixed in a body.
  struct Arm {
    int site;
    int base;
    int rotation;
    Vector<S, 3> arm;
  };
  /// A point of the ground that moves.
  struct MovingGround {
    int site;
    Vector<S, 3> place, amplitude;
    S rate;
    Vector<S, 3> at(const S& time) const {
      using std::cos;
      return place + (1 - cos(rate * time)) * amplitude;
    }
    Vector<S, 3> velocity(const S& time) const {
      using std::sin;
      return rate * sin(rate * time) * amplitude;
    }
  };
  /// Points fixed in bodies, those of no island last, those that effects act on once more; moving points of the ground.
  struct Points {
    std::vector<Arm> arms, planar_arms, pushed_arms, pushed_planar_arms;
    std::vector<MovingGround> moving;
  };

  /// Joints of one kind in one island.
  struct Batch {
    const BasicJoints<S>* joints;
    Role role;
    int first;
    int count;
    int row;
    int gradient;
    int switched_by;
  };
  /// A gradient of a row that moves a factor.
  struct Entry {
    int gradient;
    int factor;
    int row;
    Role role;
    bool along_arrow;  ///< Joints::along_arrows
  };
  /// S(row a, row b) += (gradient of a) . (response to b).
  struct Product {
    int gradient;  ///< of a; of rotations, whose gradients are turned first, its entry
    int row;       ///< of a
    int entry;
    int value;
  };
  /// A gradient along a point of a body, which turns that body.
  struct Lever {
    int from;
    int to;
    int rotation;
    Vector<S, 3> arm;
  };
  struct PlanarLever {
    int from;
    int to;
    int site;
    int body;
  };
  /// A gradient of a row along a point of the ground that moves.
  struct MovingEntry {
    int gradient;
    int row;
    int ground;
  };
  /// The equations of the joints, and which gradient of which moves what.
  struct Rows {
    std::vector<Role> roles;
    std::vector<char> left_out;  ///< rows that depend on others
    std::vector<S> compliance;   ///< of damping rows: 2 / c; empty where there are none
    std::vector<Batch> batches;
    std::vector<Entry> linear_entries, rotation_entries;
    std::vector<int> factor_entries;  ///< of each linear factor, where its entries begin
    std::vector<Product> linear_products, rotation_products;
    std::vector<Lever> levers;
    std::vector<PlanarLever> planar_levers;
    std::vector<MovingEntry> moving_entries;
    int gradients = 0;
    int dependent = 0;       ///< of those left out, the ones that move something
    bool on_arrows = false;  ///< some are nonholonomic or vakonomic
    bool vakonomic = false;  ///< some are
  };

  struct Island {
    Range linear, dragged, rotations, arms, planar_arms, rows, batches, linear_entries, rotation_entries,
        linear_products, rotation_products, levers, planar_levers;
    bool vakonomic = false;
    bool moved = false;  ///< by the ground
  };

  /// Effects of one kind.
  struct Acting {
    std::unique_ptr<BasicEffects<S>> effects;
    int switched_by;
  };

  std::vector<std::unique_ptr<BasicJoints<S>>> joints;
  std::vector<Acting> effects;
  Switches switches;
  Places places;
  std::vector<int> linear_places;
  Factors factors;
  Points points;
  Rows rows;
  Island free;  ///< the factors of no island
  std::vector<Island> islands;

  Role role(int row) const { return rows.roles[std::size_t(row)]; }
  /// Whether a Batch or an Acting does. Rows that are switched off have the value zero and no gradients, as those of a
  /// joint between what rests.
  template <class T> bool is_on(const T& each) const { return switches.on[std::size_t(each.switched_by)] != 0; }

  /// Puts points fixed in bodies where these are.
  void place_arms(BasicConfiguration<S>& at, const Range& arms, const Range& planar_arms) const;
  /// What the effects put on factors.
  void act(const BasicConfiguration<S>& at, BasicLoads<S>& loads) const;
  /// Covectors along which the rows of an island react at a node, and what their round-off is relative to.
  void react(const BasicConfiguration<S>& at, const Island& island, std::vector<Vector<S, 3>>& gradients,
             std::vector<RowSize>& sizes) const;
  /// Gradients of the rows of an island at the target of an arrow.
  void find_gradients(const BasicSceneArrow<S>& motion, const Island& island,
                      std::vector<Vector<S, 3>>& gradients) const;

  using Counts = std::function<bool(Role)>;
  /// The matrix D W D^T, where D has the gradients of the rows whose role `counts`, and W is diagonal and has the
  /// weights of the factors. Of the other rows the diagonal is one and the rest zero, so that they do not make it
  /// singular.
  void gather(const Island& island, const std::vector<Vec>& gradients, const std::vector<Vec>& linear_weights,
              const std::vector<Vec>& rotation_weights, const Counts& counts, Elimination& matrix) const;

  /// Of its arrays, B.
  std::size_t memory() const;

 private:
  /// Gradients along points fixed in bodies become those along their motions.
  void pull_back(const BasicConfiguration<S>& at, const Island& island, std::vector<Vector<S, 3>>& gradients) const;
};
using Model = BasicModel<>;

}  // namespace lagroid::multibody
