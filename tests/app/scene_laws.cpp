// The laws of effects, joints and scenes hold of ours, and fail on broken subjects.

#include <lagroid/systems/multibody/effects.hpp>
#include <lagroid/systems/multibody/joints.hpp>
#include <lagroid/systems/multibody/testing/scene_laws.hpp>

#include "../support/broken.hpp"

#include <gtest/gtest.h>

#include <cmath>

namespace lagroid::app_scene_laws_tests {
namespace {

using namespace multibody;

TEST(EffectLaws, HoldOfEveryEffect) {
  for (const auto& report :
       {laws::effect_laws(ConstantForce{{}, {0.3, -1, 2}}, "constant force"),
        laws::effect_laws(CentralGravity{{}, {3, 0, 0}, 2}, "central gravity"),
        laws::effect_laws(InverseSquare{{}, -1.5, 0.5}, "inverse square"),
        laws::effect_laws(Spring{{}, 2, 0.1}, "spring"), laws::effect_laws(Spring{{}, 2, 0}, "spring of no length"),
        laws::effect_laws(TorsionSpring{{}, {}, {0, 0.6, 0.8}, {1, 0, 0}, 2}, "torsion spring"),
        laws::effect_laws(Centrifugal{{}, 1.5, {0.3, -0.4, 1.2}}, "centrifugal"),
        laws::effect_laws(PlanarTorsionSpring{{}, 2, 0.3}, "torsion spring of planar bodies")})
    EXPECT_TRUE(report.holds()) << report;
}

TEST(EffectLaws, AttractionOfManyIsThatOfAllPairs) {
  const auto law = laws::check_law("many are all pairs", 1e-13, [] {
    const auto at = laws::detail::draw_configuration(4, 0);
    const std::array<double, 4> masses{1, 0.5, 2, 3};
    MutualGravity many(0.7, 0.3);
    EffectsOf<InverseSquare> pairs;
    for (int i = 0; i < 4; ++i) {
      many.add({i}, masses[std::size_t(i)]);
      for (int j = 0; j < i; ++j)
        pairs.add({{Site{i}, Site{j}}, 0.7 * masses[std::size_t(i)] * masses[std::size_t(j)], 0.3});
    }
    Loads of_many{std::vector<Vec>(4, Vec::Zero()), {}};
    Loads of_pairs = of_many;
    many.add_loads(at, of_many);
    pairs.add_loads(at, of_pairs);
    double defect = std::abs(many.energy(at) / pairs.energy(at) - 1);
    for (std::size_t i = 0; i < 4; ++i)
      defect = laws::worst({defect, (of_many.on[i] - of_pairs.on[i]).norm() / (1 + of_pairs.on[i].norm())});
    return defect;
  });
  EXPECT_TRUE(law.holds()) << law.worst;
}

TEST(JointLaws, HoldOfEveryJoint) {
  for (const auto& report : {laws::joint_laws(Rod{{}, 0.7}, "rod"), laws::joint_laws(Coincidence{}, "coincidence"),
                             laws::joint_laws(FixedAngle{{}, {}, {0.6, 0.8, 0}, {0, 0, 1}, 0.2}, "fixed angle"),
                             laws::joint_laws(InPlane{{}, {}, {0, 0.6, 0.8}}, "in plane")})
    EXPECT_TRUE(report.holds()) << report;
}

TEST(JointLaws, HoldOfEveryJointOnArrows) {
  const Vec axis(0.6, 0, 0.8);
  for (const auto& report : {laws::arrow_joint_laws(Rolling{{}, {}, 0.3, 1.7}, "rolling"),
                             laws::arrow_joint_laws(PrescribedSpin{{}, {}, axis, 0.4}, "prescribed spin"),
                             laws::arrow_joint_laws(Blade{{}, 0.3, -0.7, 0.2}, "blade"),
                             laws::arrow_joint_laws(BodySpin{{}, {}, axis, 0.4}, "body spin"),
                             laws::arrow_joint_laws(RelativeTurn{}, "relative turn")})
    EXPECT_TRUE(report.holds()) << report;
  EXPECT_TRUE(laws::joint_laws(Length{}, "length").holds());
}

/// Of two bodies that are hinged: a driven hinge's gradient is that of its value there, and there alone.
TEST(JointLaws, HoldOfADrivenHingeWhereItIsHinged) {
  HingeTurn hinge{{}, {Attitude{0}, Attitude{1}}, {0.6, 0, 0.8}, {0, 1, 0}, 0.4};
  const Mat meet = SO3::from_quaternion(Quaternion(Eigen::Quaterniond::FromTwoVectors(hinge.v, hinge.u).w(),
                                                   Eigen::Quaterniond::FromTwoVectors(hinge.v, hinge.u).x(),
                                                   Eigen::Quaterniond::FromTwoVectors(hinge.v, hinge.u).y(),
                                                   Eigen::Quaterniond::FromTwoVectors(hinge.v, hinge.u).z()));
  const auto defect_at = [&](double tilt) {
    return [&hinge, &meet, tilt] {
      const auto turned = [&](const Configuration& first, double angle) {
        Configuration out = first;
        out.attitude[1] = out.attitude[0] * meet * SO3::exp(Vec(angle * hinge.v));
        return out;
      };
      const Configuration before = turned(laws::detail::draw_configuration(0, 2), laws::draw_uniform());
      Configuration after = turned(laws::detail::draw_configuration(0, 2), laws::draw_uniform());
      after.attitude[1] = (after.attitude[1] * SO3::exp(Vec(tilt, 0, 0))).eval();
      const std::vector<Vec> none(2, Vec::Zero());
      std::array<Vec, 2> g;
      hinge.gradient({before, after, none, none, 0.1}, g.data());
      double defect = 0;
      for (int i = 0; i < 6; ++i) {
        const double rate = laws::detail::derivative_along(
            [&](const Configuration& at) {
              double value = 0;
              hinge.value({before, at, none, none, 0.1}, &value);
              return value;
            },
            after, 0, i);
        defect = laws::worst({defect, std::abs(g[std::size_t(i / 3)](i % 3) - rate)});
      }
      return defect;
    };
  };
  EXPECT_TRUE(laws::check_law("hinged", 1e-7, defect_at(0)).holds());
  EXPECT_TRUE(laws::seen_broken(laws::check_law("off the hinge", 1e-7, defect_at(0.3))));
}

/// A blade whose angle is taken at the start, but not its derivative.
struct WrongBlade : Blade {
  void drift(const SceneArrow&, Vec* g) const { g[0] = Vec::Zero(); }
  void gradient(const SceneArrow& motion, Vec* g) const {
    Blade::gradient(motion, g);
    g[0](2) = arm;
  }
};

TEST(JointLaws, FailOnWrongGradientsAlongArrows) {
  const auto report = laws::arrow_joint_laws(WrongBlade{{{}, 0.3, -0.7, 0.2}}, "");
  EXPECT_TRUE(laws::seen_broken(report.law("gradients are those of the values")));
  EXPECT_TRUE(laws::seen_broken(report.law("drifts are those of the values")));
}

/// Force and energy of other signs.
struct WrongSpring {
  std::array<Site, 2> sites;
  double energy(const Configuration& at) const { return 0.5 * (at(sites[1]) - at(sites[0])).squaredNorm(); }
  void add_loads(const Configuration& at, Loads& f) const {
    const Vec d = at(sites[1]) - at(sites[0]);
    f(sites[0]) += d;
    f(sites[1]) += d;
  }
};

/// A torque in space where one in the body's frame is to be.
struct WrongTorsion {
  std::array<Site, 0> sites;
  std::array<Attitude, 1> attitudes;
  double energy(const Configuration& at) const { return at(attitudes[0])(2, 2); }
  void add_loads(const Configuration& at, Loads& f) const {
    f(attitudes[0]) -= Vec(Vec::UnitZ()).cross(Vec(at(attitudes[0]).col(2)));
  }
};

/// Half of the gradient.
struct WrongRod : Rod {
  void gradient(const Configuration& at, Vec* g, RowSize* size) const {
    Rod::gradient(at, g, size);
    g[1] *= 0.5;
  }
};

TEST(EffectLaws, FailOnWrongForcesAndTorques) {
  EXPECT_TRUE(laws::seen_broken(laws::effect_laws(WrongSpring{}, "").law("forces are those of the energy")));
  EXPECT_TRUE(laws::seen_broken(laws::effect_laws(WrongTorsion{}, "").law("forces are those of the energy")));
}

TEST(JointLaws, FailOnWrongGradients) {
  EXPECT_TRUE(laws::seen_broken(laws::joint_laws(WrongRod{{{}, 0.7}}, "").law("gradients are those of the values")));
}

/// A body that hangs by a ball joint from one that slides, a bob on a rod below, a spring.
Scene machine() {
  Scene scene;
  const Quaternion upright(1, 0, 0, 0);
  const Body carriage = scene.rigid_body(2, {0.3, 0.4, 0.5}, {0, 0, 0}, upright, {0.1, 0, 0}, {0, 0, 0});
  const Body box = scene.rigid_body(1, {0.1, 0.05, 0.12}, {0.5, 0.2, -0.7}, upright, {0.1, 0, 0}, {0.2, 0, 0.4});
  const Body bob = scene.point_mass(0.4, {0.5, 0.2, -1.5}, {0.1, 0.3, 0});
  const Body top = scene.pivoted_body({0.3, 0.3, 0.1}, {2, 0, 0}, upright, {0.3, 0, 4});
  scene.add(Coincidence{{scene.point_of(carriage, {0.5, 0.2, -0.3}), scene.point_of(box, {0, 0, 0.4})}});
  scene.add(Rod{{box.centre, bob.centre}, 0.8});
  const Site rail = scene.ground(Vec::Zero());
  scene.add(InPlane{{rail, carriage.centre}, {Attitude{}}, {0, 1, 0}});
  scene.add(InPlane{{rail, carriage.centre}, {Attitude{}}, {0, 0, 1}});
  scene.add(FixedAngle{{}, {Attitude{}, carriage.attitude}, {0, 1, 0}, {1, 0, 0}});
  for (const auto& [body, mass] : {std::pair{carriage, 2.0}, {box, 1.0}, {bob, 0.4}})
    scene.add(ConstantForce{{body.centre}, {0, 0, -9.81 * mass}});
  scene.add(ConstantForce{{scene.point_of(top, {0, 0, 0.5})}, {0, 0, -9.81}});
  scene.add(Spring{{scene.point_of(top, {0, 0, 0.5}), scene.point_of(box, {0.1, 0.1, 0})}, 5, 0.4});
  scene.add(TorsionSpring{{}, {box.attitude, top.attitude}, {1, 0, 0}, {1, 0, 0}, 0.3});
  return scene;
}

TEST(SceneLaws, HoldOfAMachineWithEitherMap) {
  for (const auto map : {Retraction::exponential, Retraction::cayley}) {
    const auto make = [map] {
      Scene scene = machine();
      scene.rotation = map;
      return scene;
    };
    const auto report = laws::scene_laws({"machine", make, 0.005, 0.3});
    EXPECT_TRUE(report.holds()) << report;
  }
}

TEST(SceneLaws, HoldOfADampedMachine) {
  const auto make = [] {
    Scene scene;
    const Body a = scene.rigid_body(1, {0.3, 0.4, 0.5}, {1, 0, 0}, {1, 0, 0, 0}, {0, 0, 0}, {0, 0, 0});
    scene.add(Rod{{scene.ground(Vec::Zero()), scene.point_of(a, {-0.5, 0.1, 0})}, std::sqrt(0.26)});
    scene.add(ConstantForce{{a.centre}, {0, 0, -9.81}});
    scene.damp(a, 0.5, 0.2);
    return scene;
  };
  EXPECT_TRUE(laws::scene_laws({"damped", make, 0.005, 0.5, false}).holds());
  const auto broken = laws::scene_laws({"damped, said to be symplectic", make, 0.005, 0.5, true});
  EXPECT_TRUE(laws::seen_broken(broken.law("symplectic"))) << broken;
  EXPECT_TRUE(laws::seen_broken(broken.law("steps go back the way they came"))) << broken;
}

/// Vakonomic steps are symplectic in momenta that hold the multipliers; with another drift they are not.
template <class B> laws::LawReport of_steering() {
  const auto make = [] {
    Scene scene;
    const Body robot = scene.planar_body(1, 0.8, {0.3, 0.1, 0.2}, {std::cos(0.2), std::sin(0.2), 0.5});
    B blade;
    blade.sites = {scene.planar_place(robot)};
    Vakonomic<B> optimal{blade, {0.7}};
    scene.add(optimal);
    return scene;
  };
  return laws::scene_laws({"steering", make, 0.02, 0.5});
}

TEST(SceneLaws, HoldOfVakonomicScenes) {
  const auto steering = of_steering<Blade>();
  EXPECT_TRUE(steering.holds()) << steering;
  const auto plate_and_ball = [] {
    Scene scene;
    const Body ball = scene.rigid_body(1, {0.4, 0.4, 0.4}, {0, 0, 1}, {1, 0, 0, 0}, {0.3, 0.2, 0}, {-0.2, 0.3, 0});
    scene.add(Vakonomic<Rolling>{{{ball.centre}, {ball.attitude}, 1, 0}, {0.3, -0.2}});
    scene.add(Vakonomic<PrescribedSpin>{{{}, {ball.attitude}, {0, 0, 1}, 0}, {0.1}});
    return scene;
  };
  const auto report = laws::scene_laws({"plate and ball", plate_and_ball, 0.02, 0.5});
  EXPECT_TRUE(report.holds()) << report;
}

/// With speeds that are given, too, and on a plate that turns; but there is no way back.
TEST(SceneLaws, HoldOfVakonomicScenesWithRates) {
  const auto make = [] {
    Scene scene;
    const Body robot = scene.planar_body(1, 0.8, {0.3, 0.1, 0.2}, {std::cos(0.2), std::sin(0.2), 0.5});
    const Site place = scene.planar_place(robot);
    scene.add(Vakonomic<Blade>{{{place}, 0, 0, 0}, {0.7}});
    scene.add(Vakonomic<Blade>{{{place}, -M_PI / 2, 0, 1}, {0.4}});
    const Body ball = scene.rigid_body(1, {0.4, 0.4, 0.4}, {0.5, 0, 1}, {1, 0, 0, 0}, {0, 0.4, 0}, {0, 0, 0});
    scene.add(Vakonomic<Rolling>{{{ball.centre}, {ball.attitude}, 1, 0.8}, {0.3, -0.2}});
    return scene;
  };
  const auto report = laws::scene_laws({"rates", make, 0.02, 0.5, true, false});
  EXPECT_TRUE(report.holds()) << report;
  EXPECT_TRUE(laws::seen_broken(
      laws::scene_laws({"rates", make, 0.02, 0.5, true, true}).law("steps go back the way they came")));
}

struct NoDrift : Blade {
  void drift(const SceneArrow&, Vec* g) const { g[0] = Vec::Zero(); }
};

TEST(SceneLaws, FailOnAVakonomicJointThatForgetsItsDrift) {
  const auto report = of_steering<NoDrift>();
  EXPECT_TRUE(laws::seen_broken(report.law("symplectic"))) << report;
}

/// A sleigh, two dampers and a support that moves.
TEST(SceneLaws, HoldOfNonholonomicAndDampedScenes) {
  const auto make = [] {
    Scene scene;
    const Body sleigh = scene.planar_body(1, 1, {1, 0, 0}, {0.3, 0.8, 0.8});
    scene.add(Blade{{scene.planar_place(sleigh)}, 0, -1, 0});
    const Body a = scene.rigid_body(1, {0.3, 0.4, 0.5}, {0, 0, 2}, {1, 0, 0, 0}, {0, 0, 0}, {0.3, 0.2, 1});
    const Body b = scene.rigid_body(1, {0.3, 0.4, 0.5}, {1, 0, 2}, {1, 0, 0, 0}, {0, 0, 0}, {0, 0.2, -1});
    scene.add(Damper<RelativeTurn>{{{}, {a.attitude, b.attitude}}, 0.4});
    scene.add(Damper<Length>{{{scene.point_of(a, {0.2, 0, 0}), scene.point_of(b, {0, 0.2, 0})}}, 0.9});
    const Body bob = scene.point_mass(1, {0, 0, -1}, Vec::Zero());
    scene.add(Rod{{scene.moving_ground(Vec::Zero(), {0.2, 0, 0.1}, 3), bob.centre}, 1});
    scene.add(ConstantForce{{bob.centre}, {0, 0, -9.81}});
    return scene;
  };
  const auto report = laws::scene_laws({"rubbing", make, 0.01, 0.5, false});
  EXPECT_TRUE(report.holds()) << report;
}

/// A wall that pushes with a force that jumps: of order one at best.
struct Wall {
  std::array<Site, 1> sites;
  double energy(const Configuration& at) const { return at(sites[0])(0) > 0.1234 ? 50 : 0; }
  void add_loads(const Configuration& at, Loads& f) const {
    if (at(sites[0])(0) > 0.1234) f(sites[0]) -= Vec(50, 0, 0);
  }
};

TEST(SceneLaws, OrderFailsWhereForcesJump) {
  const auto make = [] {
    Scene scene;
    const Body a = scene.point_mass(1, {0, 0, 0}, {1, 0, 0});
    scene.add(Wall{{a.centre}});
    return scene;
  };
  EXPECT_TRUE(laws::seen_broken(laws::scene_laws({"wall", make, 0.01, 0.4}).law("order two")));
}

}  // namespace
}  // namespace lagroid::app_scene_laws_tests
