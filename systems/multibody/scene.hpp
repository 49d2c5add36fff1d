#pragma once
/// A scene while it is written: bodies, their points, what ties them and what acts on them.
///
///     G = product of Pair(R^3), SO(3) x SO(3) => SO(3), Pair(R^2) x Pair(S^1),    one or two factors a body.
///
/// It is a list without motion: Multibody makes a motion of it.
///
///     Scene scene;
///     const Body book = scene.rigid_body(1, {3, 2, 1}, {0, 0, 0}, {1, 0, 0, 0}, {0, 0, 0}, {0.01, 1, 0});
///     const Site corner = scene.point_of(book, {0.1, 0.1, 0});
///     scene.add(ConstantForce{{corner}, {0, 0, -1}});  // effects.hpp
///
/// Requires positive masses and principal moments, and unit quaternions; nothing is checked here. SI units, angles in
/// radians.

#include <lagroid/systems/multibody/joint.hpp>
#include <lagroid/systems/multibody/rotation_increment.hpp>

#include <memory>
#include <string>
#include <typeindex>
#include <typeinfo>
#include <utility>
#include <vector>

namespace lagroid::multibody {

/// A body of a scene: its reference point (centre of mass, or the pivot of one that turns about a fixed point) and what
/// turns. A point mass has no attitude; a planar body's turns in the plane and is none either.
struct Body {
  Site centre;
  Attitude attitude;
};

/// The bodies, joints and effects of a scene, each added once. The groupoid of the scene is the product of its bodies'
/// groupoids: Pair(R^3) of a point mass, the action groupoid SO(3) x SO(3) => SO(3) of what turns in space (a rigid
/// body is a product of both), Pair(R^2) x Pair(S^1) of a planar body. Units: kg, m, s, rad.
template <class S = double> class BasicScene {
 public:
  /// What is put in place by adding: a place, or in the plane two coordinates and an angle.
  struct Linear {
    Vector<S, 3> inertia;  ///< kg, kg, and kg or kg m^2
    Vector<S, 3> place;
    Vector<S, 3> rate;
    Matrix<S, 3, 3> drag = Matrix<S, 3, 3>::Zero();  ///< the force -drag v, kg/s (in the plane also a torque, N m s)
    bool planar = false;
  };
  struct Rotating {
    Vector<S, 3> inertia;  ///< principal moments, kg m^2
    Vector<S, 4> attitude;
    Vector<S, 3> rate;                            ///< angular velocity in the body, rad/s
    Vector<S, 3> damping = Vector<S, 3>::Zero();  ///< torque over angular velocity, N m s
  };
  /// A point: the place of `linear` itself; `place` from it in the frame of `rotation` (or of a planar body); or, where
  /// both are -1, of the ground.
  struct Point {
    int linear = -1;
    int rotation = -1;
    int base = -1;  ///< the site that `place` is measured from
    Vector<S, 3> place = Vector<S, 3>::Zero();
    Vector<S, 3> amplitude = Vector<S, 3>::Zero();  ///< of the ground, where it moves
    S rate = 0;
  };

  Body point_mass(const S& mass, const Vector<S, 3>& place, const Vector<S, 3>& velocity);
  /// Requires principal moments of inertia, a unit quaternion, and the angular velocity in the body's frame.
  Body rigid_body(const S& mass, const Vector<S, 3>& inertia, const Vector<S, 3>& place, const Vector<S, 4>& attitude,
                  const Vector<S, 3>& velocity, const Vector<S, 3>& angular_velocity);
  /// One that turns about a fixed point of its own; `inertia` about that point.
  Body pivoted_body(const Vector<S, 3>& inertia, const Vector<S, 3>& pivot, const Vector<S, 4>& attitude,
                    const Vector<S, 3>& angular_velocity);
  /// In the plane of the first two axes: place (x, y, angle) and its rate.
  Body planar_body(const S& mass, const S& inertia, const Vector<S, 3>& place, const Vector<S, 3>& rate);

  /// The point of a body at `arm` from its centre, in its own frame.
  Site point_of(const Body& body, const Vector<S, 3>& arm);
  Site ground(const Vector<S, 3>& place);
  /// A point of the ground that is moved: at place + amplitude (1 - cos(rate t)); rate in rad/s.
  Site moving_ground(const Vector<S, 3>& place, const Vector<S, 3>& amplitude, const S& rate);
  /// (x, y, angle) of a planar body.
  Site planar_place(const Body& body) const { return {sites_[std::size_t(body.centre.index)].base}; }

  /// The number of the body's linear motion among those of the scene; -1 for one that has none.
  int linear_of(const Body& body) const { return sites_[std::size_t(body.centre.index)].linear; }

  /// Linear damping of a body's centre and of its turning (N s/m, N m s).
  void damp(const Body& body, const S& of_motion, const S& of_turning);
  /// A force -w x v at right angles to the velocity v of a body in space, which does no work: in a magnetic field B
  /// w = q B, in a frame that turns w = 2 m Omega.
  void gyroscopic_force(const Body& body, const Vector<S, 3>& w);

  template <class K> void add(const K& kernel) {
    if constexpr (requires { K::rows; }) {
      all_of<K, JointsOf<K, S>>(joints_).add(kernel);
    } else {
      all_of<K, EffectsOf<K, S>>(effects_).add(kernel);
    }
  }
  /// Effects that need a container of their own, such as one over all pairs of many bodies.
  void add_effects(std::unique_ptr<BasicEffects<S>> effects) {
    effects_.push_back({std::move(effects), typeid(void), now_});
  }

  /// Joints and effects that are added from now on, until `end_switch`, are switched on and off together, by this name
  /// (Multibody::switch_to). Vakonomic joints cannot be.
  void begin_switch(std::string name, bool on = true) {
    now_ = int(switches_.names.size());
    switches_.names.push_back(std::move(name));
    switches_.on.push_back(on);
  }
  void end_switch() { now_ = 0; }
  const Switches& switches() const { return switches_; }

  Retraction rotation = Retraction::exponential;  ///< how a turn becomes an angular velocity

 private:
  template <class> friend class Assembly;

  /// All joints or effects of one kind that are switched together.
  template <class Base> struct OfKind {
    std::unique_ptr<Base> all;
    std::type_index kind;
    int switched_by;
  };
  template <class K, class All, class Base> All& all_of(std::vector<OfKind<Base>>& list) {
    for (const OfKind<Base>& each : list)
      if (each.kind == typeid(K) && each.switched_by == now_) return static_cast<All&>(*each.all);
    list.push_back({std::make_unique<All>(), typeid(K), now_});
    return static_cast<All&>(*list.back().all);
  }

  std::vector<Linear> linear_;
  std::vector<Rotating> rotating_;
  std::vector<Point> sites_;
  std::vector<OfKind<BasicJoints<S>>> joints_;
  std::vector<OfKind<BasicEffects<S>>> effects_;
  Switches switches_;
  int now_ = 0;
};
using Scene = BasicScene<>;

}  // namespace lagroid::multibody
