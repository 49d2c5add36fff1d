#pragma once
/// An optimal control problem of a scene of bodies: effects whose strengths are controls, where the bodies are to end,
/// what they are to keep out of, where they may point, and how fast they may be,
///
///     minimise  integral of (sum_j w_j u_j^2 + w) dt,    lower_j <= u_j <= upper_j.
///
///     const auto write = []<class S>() {
///       BasicScene<S> scene;
///       const Vector<S, 3> zero = Vector<S, 3>::Zero();
///       const Body wheel =
///           scene.pivoted_body({S(1), S(1), S(2)}, zero, Vector<S, 4>(S(1), S(0), S(0), S(0)), zero);
///       scene.begin_switch("motor");
///       scene.add(BasicMotor<S>{{}, {Attitude{}, wheel.attitude}, {S(0), S(0), S(1)}});  // 1 N m, times the control
///       scene.end_switch();
///       return scene;
///     };
///     SceneControl task = control_of_scene(write);
///     task.actuators = {{.effect = "motor", .lower = -2, .upper = 2}};
///     task.end.turns = {{Attitude{0}, {0, 0, 0, 1}}};  // half a turn of the first body that turns
///     const SceneSearch found = search_scene(task);    // scene_search.hpp
///
/// A control is the factor of all effects that are switched by its name (Scene::begin_switch); whether they are on at
/// the start does not matter. The start is the scene's. Of the end, what is not given is free. SI units.

#include <lagroid/systems/multibody/control/second_number.hpp>
#include <lagroid/systems/multibody/scene.hpp>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace lagroid::multibody {

/// Effects whose strength is a control u.
struct Actuator {
  std::string effect;  ///< by which they are switched
  double lower = -HUGE_VAL;
  double upper = HUGE_VAL;
  double weight = 1;  ///< w of the cost w u^2
};

/// By how much a start may be beyond what its limits allow.
inline constexpr double limit_rounding = 1e-12;

/// What a point of a body keeps out of at every node: value(x) <= 0 where x is outside.
struct KeepOut {
  enum class Kind {
    sphere,  ///< 1 - |x - centre|^2 / radius^2
    disk,    ///< the same without the third axis: a cylinder along it
    plane    ///< normal . (centre - x): the half space that the normal leads out of
  };
  Site site;
  Kind kind = Kind::sphere;
  Vector<double, 3> centre = Vector<double, 3>::Zero();  ///< of a plane: a point of it
  double radius = 1;
  Vector<double, 3> normal = Vector<double, 3>::UnitZ();  ///< of length one
  std::string name = {};                                  ///< in messages; empty: its number

  template <class S> S value(const Vector<S, 3>& x) const {
    const S a = x(0) - centre(0);
    const S b = x(1) - centre(1);
    const S c = x(2) - centre(2);
    if (kind == Kind::plane) return -(a * normal(0) + b * normal(1) + c * normal(2));
    const S square = kind == Kind::disk ? S(a * a + b * b) : S(a * a + b * b + c * c);
    return 1.0 - square * (1 / (radius * radius));
  }
};

/// How far a direction of a body is to be from one of the ground at every node, at least (the body keeps it outside of
/// a cone, as a star tracker off the sun) or at most (inside): value(A) <= 0 where it is.
struct DirectionCone {
  enum class Side {
    outside,  ///< a.A d - cos(angle)
    inside    ///< cos(angle) - a.A d
  };
  Attitude attitude;
  Vector<double, 3> direction = Vector<double, 3>::UnitZ();  ///< d, in the body, of length one
  Vector<double, 3> axis = Vector<double, 3>::UnitZ();       ///< a, of the ground, of length one
  double angle = 1;                                          ///< rad, between zero and pi
  Side side = Side::outside;
  std::string name = {};  ///< in messages; empty: its number

  template <class S> S value(const Matrix<S, 3, 3>& attitude_of_body) const {
    S cosine = S(0);
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) cosine += attitude_of_body(i, j) * (axis(i) * direction(j));
    return side == Side::outside ? cosine - std::cos(angle) : std::cos(angle) - cosine;
  }
};

/// How fast a body may be at every node: sum_i v_i^2 / most^2 <= 1, of the velocity of its centre, of its angular
/// velocity in the body, as an end has them (SceneEnd), or of the velocity of a point of it, along these axes.
struct SpeedLimit {
  int linear = -1;                    ///< Scene::linear_of; -1: the limit is on the turning of
  Attitude attitude = {};             ///< this one, or, where that is none,
  Site site = {};                     ///< on this point
  std::vector<int> axes = {0, 1, 2};  ///< of a planar body 0 and 1, and 2 of its turning
  double most = 1;                    ///< m/s or rad/s
  std::string name = {};              ///< in messages; empty: its number
};

/// What is given of the end.
struct SceneEnd {
  struct Place {
    Site site;  ///< of a planar body's own place (Scene::planar_place) the third number is its angle
    int axis;
    double value;
  };
  struct Turn {
    Attitude attitude;
    Vector<double, 4> value;  ///< a unit quaternion
  };
  struct Velocity {
    int linear;  ///< Scene::linear_of
    int axis;
    double value;
  };
  struct Turning {
    Attitude attitude;
    int axis;  ///< of the body
    double value;
  };
  std::vector<Place> places;
  std::vector<Turn> turns;
  std::vector<Velocity> velocities;
  std::vector<Turning> turnings;
};

struct SceneControl {
  std::function<Scene()> scene;
  std::function<BasicScene<SecondNumber>()> second;  ///< the same over numbers with second derivatives
  std::vector<Actuator> actuators;
  std::vector<KeepOut> keep_outs;
  std::vector<DirectionCone> cones;
  std::vector<SpeedLimit> speed_limits;
  SceneEnd end;
  double duration = 1;  ///< T; the first guess of it where it is free
  bool duration_is_free = false;
  double duration_weight = 0;  ///< w of the cost w T
  long stages = 100;
};

/// Of a scene that is written once, write.operator()<S>() over any scalar.
template <class Write> SceneControl control_of_scene(const Write& write) {
  SceneControl out;
  out.scene = [write] { return write.template operator()<double>(); };
  out.second = [write] { return write.template operator()<SecondNumber>(); };
  return out;
}

}  // namespace lagroid::multibody
