// Scenes of bodies that tests of their optimal control share.
#pragma once

#include <lagroid/systems/multibody/control/scene_control.hpp>
#include <lagroid/systems/multibody/effects.hpp>
#include <lagroid/systems/multibody/joints.hpp>

#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace lagroid::controlled_bodies_tests {

using namespace multibody;

template <class S> Vector<S, 3> vec(double x, double y, double z) { return {S(x), S(y), S(z)}; }
template <class S> Vector<S, 4> quat(double w, double x, double y, double z) { return {S(w), S(x), S(y), S(z)}; }

/// A body and a point mass that nothing ties: a torque about an axis of the body, a force on a corner of it, a spring.
struct FreeBodies {
  template <class S> BasicScene<S> operator()() const {
    BasicScene<S> scene;
    const Body box = scene.rigid_body(S(1.3), vec<S>(0.4, 0.5, 0.6), vec<S>(0.2, 0.1, 0.4), quat<S>(0.96, 0, 0.28, 0),
                                      vec<S>(0.1, -0.2, 0.3), vec<S>(0.3, 1.2, -0.4));
    const Body bob = scene.point_mass(S(0.7), vec<S>(1.2, -0.3, 0.5), vec<S>(0, 0.4, 0.1));
    const Site corner = scene.point_of(box, vec<S>(0.1, 0.3, -0.2));
    scene.add(BasicSpring<S>{{corner, bob.centre}, S(5), S(0.6)});
    scene.add(BasicTorsionSpring<S>{{}, {Attitude{}, box.attitude}, vec<S>(0, 0, 1), vec<S>(0.6, 0, 0.8), S(2)});
    scene.begin_switch("torque");
    scene.add(BasicBodyTorque<S>{{}, {box.attitude}, vec<S>(0.1, 0.2, 1)});
    scene.end_switch();
    scene.begin_switch("force", false);
    scene.add(BasicConstantForce<S>{{corner}, vec<S>(0.3, 1, 0.2)});
    scene.end_switch();
    return scene;
  }
  static constexpr Site of_corner{2}, of_bob{1};
  static constexpr Attitude of_box{0};
};

/// A box that hangs from a sliding carriage, and a bob that hangs on it by a rod; motors along the rail and in the
/// joint.
struct Machine {
  Retraction rotation = Retraction::exponential;

  template <class S> BasicScene<S> operator()() const {
    BasicScene<S> scene;
    scene.rotation = rotation;
    const auto zero = vec<S>(0, 0, 0);
    const Body carriage =
        scene.rigid_body(S(2), vec<S>(0.3, 0.4, 0.5), zero, quat<S>(1, 0, 0, 0), vec<S>(0.1, 0, 0), zero);
    const Body box = scene.rigid_body(S(1), vec<S>(0.1, 0.05, 0.12), vec<S>(0.5, 0.2, -0.7), quat<S>(0.96, 0, 0.28, 0),
                                      vec<S>(0.1, 0, 0), zero);
    const Body bob = scene.point_mass(S(0.4), vec<S>(0.5, 0.2, -1.5), vec<S>(0.1, 0.3, 0));
    const Site under = scene.point_of(carriage, vec<S>(0.5, 0.2, -0.3));
    const Mat attitude = SO3::from_quaternion(Quaternion(0.96, 0, 0.28, 0));
    const Vec arm = attitude.transpose() * Vec(0, 0, 0.4);
    scene.add(BasicCoincidence<S>{{under, scene.point_of(box, arm.template cast<S>())}});
    scene.add(BasicRod<S>{{box.centre, bob.centre}, S(0.8)});
    const Site rail = scene.ground(zero);
    scene.add(BasicInPlane<S>{{rail, carriage.centre}, {Attitude{}}, vec<S>(0, 1, 0)});
    scene.add(BasicInPlane<S>{{rail, carriage.centre}, {Attitude{}}, vec<S>(0, 0, 1)});
    scene.add(BasicFixedAngle<S>{{}, {Attitude{}, carriage.attitude}, vec<S>(0, 1, 0), vec<S>(1, 0, 0), S(0)});
    scene.add(BasicFixedAngle<S>{{}, {Attitude{}, carriage.attitude}, vec<S>(0, 0, 1), vec<S>(1, 0, 0), S(0)});
    scene.add(BasicConstantForce<S>{{box.centre}, vec<S>(0, 0, -9.81)});
    scene.add(BasicConstantForce<S>{{bob.centre}, vec<S>(0, 0, -0.4 * 9.81)});
    scene.begin_switch("rail");
    scene.add(BasicConstantForce<S>{{carriage.centre}, vec<S>(1, 0, 0)});
    scene.end_switch();
    scene.begin_switch("joint");
    scene.add(BasicMotor<S>{{}, {carriage.attitude, box.attitude}, vec<S>(0, 1, 0.5)});
    scene.end_switch();
    return scene;
  }
  static constexpr Site of_bob{2}, of_top{4};  ///< the second of the box
  static constexpr Attitude of_box{1};
};

/// The machine with drag on carriage and bob, a magnetic field, and dampers in the joint and from the ground to the
/// bob.
struct DampedMachine {
  Retraction rotation = Retraction::exponential;
  double damping = 0.7;

  template <class S> BasicScene<S> operator()() const {
    BasicScene<S> scene = Machine{rotation}.operator()<S>();
    const Body carriage{{0}, {0}}, bob{Machine::of_bob, {}};
    scene.damp(carriage, S(0.4), S(0.2));
    scene.damp(bob, S(0.3), S(0));
    scene.gyroscopic_force(bob, vec<S>(0.1, -0.2, 0.5));
    BasicRelativeTurn<S> turn;
    turn.attitudes = {carriage.attitude, Machine::of_box};
    scene.add(Damper<BasicRelativeTurn<S>, S>{turn, S(damping)});
    scene.add(Damper<BasicLength<S>, S>{BasicLength<S>{{scene.ground(vec<S>(2, 1, 0)), bob.centre}}, S(0.9)});
    return scene;
  }
};

/// A bar in the plane that hangs by a hinge at the origin along the first axis, and its motor: of inertia one about the
/// hinge and weight one over its arm, the pendulum of mass, length and gravity one.
struct HingedBar {
  double weight = 2;
  double inertia = 0.75;  ///< about its centre

  template <class S> BasicScene<S> operator()() const {
    BasicScene<S> scene;
    const Body bar = scene.planar_body(S(1), S(inertia), vec<S>(0.5, 0, 0), vec<S>(0, 0, 0));
    scene.add(BasicCoincidence<S>{{scene.ground(vec<S>(0, 0, 0)), scene.point_of(bar, vec<S>(-0.5, 0, 0))}});
    scene.add(BasicConstantForce<S>{{bar.centre}, vec<S>(weight, 0, 0)});
    scene.begin_switch("motor");
    scene.add(BasicConstantForce<S>{{scene.planar_place(bar)}, vec<S>(0, 0, 1)});
    scene.end_switch();
    return scene;
  }
  static constexpr Site of_bar{0};
};

/// Two uniform links of mass and length one, stretched from the origin at the angles a and a + b, with motors in
/// shoulder and elbow.
struct Arm {
  double a = 0, b = 0.3;

  template <class S> BasicScene<S> operator()() const {
    BasicScene<S> scene;
    const Vec elbow(std::cos(a), std::sin(a), 0);
    const Vec along(std::cos(a + b), std::sin(a + b), 0);
    const Vec first = 0.5 * elbow, second = elbow + 0.5 * along;
    const Body upper = scene.planar_body(S(1), S(1.0 / 12), vec<S>(first(0), first(1), a), vec<S>(0, 0, 0));
    const Body fore = scene.planar_body(S(1), S(1.0 / 12), vec<S>(second(0), second(1), a + b), vec<S>(0, 0, 0));
    scene.add(BasicCoincidence<S>{{scene.ground(vec<S>(0, 0, 0)), scene.point_of(upper, vec<S>(-0.5, 0, 0))}});
    scene.add(
        BasicCoincidence<S>{{scene.point_of(upper, vec<S>(0.5, 0, 0)), scene.point_of(fore, vec<S>(-0.5, 0, 0))}});
    const auto turn = [&](const Body& body, double torque) {
      scene.add(BasicConstantForce<S>{{scene.planar_place(body)}, vec<S>(0, 0, torque)});
    };
    scene.begin_switch("shoulder");
    turn(upper, 1);
    scene.end_switch();
    scene.begin_switch("elbow");
    turn(upper, -1);
    turn(fore, 1);
    scene.end_switch();
    for (int i = 0; i < 4; ++i) scene.point_of(fore, vec<S>(i / 3.0 - 0.5, 0, 0));
    return scene;
  }
  static constexpr Site of_upper{0}, of_fore{2};
  static constexpr std::array<int, 4> of_points{8, 9, 10, 11};  ///< elbow to hand
  static constexpr Site of_hand{11};
};

/// The arm with drag on its upper link and a damper from the ground to its hand.
struct DampedArm {
  template <class S> BasicScene<S> operator()() const {
    BasicScene<S> scene = Arm{}.operator()<S>();
    scene.damp(Body{{1}, {}}, S(0.3), S(0.2));
    const Site hand{Arm::of_points[3]};
    scene.add(Damper<BasicLength<S>, S>{BasicLength<S>{{scene.ground(vec<S>(0, -1, 0)), hand}}, S(0.5)});
    return scene;
  }
};

/// A pivoted body, to be turned by torques about its principal axes.
struct Satellite {
  Retraction rotation = Retraction::exponential;

  template <class S> BasicScene<S> operator()() const {
    BasicScene<S> scene;
    scene.rotation = rotation;
    const auto zero = vec<S>(0, 0, 0);
    const Body body = scene.pivoted_body(vec<S>(1, 2, 3), zero, quat<S>(1, 0, 0, 0), zero);
    for (int i = 0; i < 3; ++i) {
      scene.begin_switch("torque" + std::to_string(i + 1));
      scene.add(BasicBodyTorque<S>{{}, {body.attitude}, Vector<S, 3>(Vector<S, 3>::Unit(i))});
      scene.end_switch();
    }
    return scene;
  }
  static constexpr Attitude of_body{0};
};

/// Two halves of a cat, straight along the third axis and joined by a ball joint, in which three motors act; with drag
/// on the halves.
struct Cat {
  double drag_of_front = 0, drag_of_rear = 0;

  template <class S> BasicScene<S> operator()() const {
    BasicScene<S> scene;
    const auto half = [&](double height) {
      return scene.rigid_body(S(1), vec<S>(0.45, 0.35, 0.2), vec<S>(0, 0, height), quat<S>(1, 0, 0, 0), vec<S>(0, 0, 0),
                              vec<S>(0, 0, 0));
    };
    const Body front = half(0.3), rear = half(-0.3);
    if (drag_of_front > 0) scene.damp(front, S(drag_of_front), S(0));
    if (drag_of_rear > 0) scene.damp(rear, S(drag_of_rear), S(0));
    scene.add(
        BasicCoincidence<S>{{scene.point_of(front, vec<S>(0, 0, -0.3)), scene.point_of(rear, vec<S>(0, 0, 0.3))}});
    for (const auto& [name, axis] :
         {std::pair("pitch", Vec(1, 0, 0)), {"roll", Vec(0, 1, 0)}, {"twist", Vec(0, 0, 1)}}) {
      scene.begin_switch(name);
      scene.add(BasicMotor<S>{{}, {front.attitude, rear.attitude}, vec<S>(axis(0), axis(1), axis(2))});
      scene.end_switch();
    }
    return scene;
  }
  static constexpr Attitude of_front{0}, of_rear{1};
};

}  // namespace lagroid::controlled_bodies_tests
