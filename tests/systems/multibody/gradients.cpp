// Exact derivatives of runs of scenes of bodies: against extrapolated differences of the motion itself, forward against
// backward, and the symplectic form.
#include "all_that_moves.hpp"
#include "number_names.hpp"

#include <lagroid/solvers/sensitivity/propagate.hpp>
#include <lagroid/solvers/sensitivity/varied_parameters.hpp>
#include <lagroid/solvers/testing/sensitivity_laws.hpp>
#include <lagroid/systems/multibody/effects.hpp>
#include <lagroid/systems/multibody/joints.hpp>
#include <lagroid/systems/multibody/sensitivity/linearised_scene.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <string>
#include <vector>

namespace lagroid::multibody::gradients_tests {
namespace {

template <class S> using Vec3 = Vector<S, 3>;
template <class S> using Quat = Vector<S, 4>;

/// Ties that hold where these bodies are, whatever their numbers.
template <class S> void add_rod(BasicScene<S>& scene, Site a, const Vec3<S>& at_a, Site b, const Vec3<S>& at_b) {
  scene.add(BasicRod<S>{{a, b}, (at_b - at_a).norm()});
}

/// A rigid body and a point mass that nothing ties: gravity of each other, a centre's, a spring with a lever, drag, a
/// periodic force, a body torque and a torsion spring. Numbers: masses, an inertia, stiffness, length, drag, rates.
struct FreeBodies {
  static constexpr bool symplectic = false;
  std::vector<double> numbers{1.3, 0.7, 0.4, 5.0, 0.6, 0.2, 2.0, 0.3, 1.1};
  template <class S> BasicScene<S> operator()(const std::vector<S>& x) const {
    BasicScene<S> scene;
    const Body box = scene.rigid_body(x[0], {x[2], S(0.5), S(0.6)}, {S(0.2), S(0.1), S(0.4)},
                                      Quat<S>(S(0.96), S(0.0), S(0.28), S(0.0)), {S(0.1), S(-0.2), S(0.3)},
                                      {S(0.3), S(1.2), S(-0.4)});
    const Body bob = scene.point_mass(x[1], {S(1.2), S(-0.3), S(0.5)}, {S(0.0), S(0.4), S(0.1)});
    const Site corner = scene.point_of(box, Vec3<S>(S(0.1), x[7], S(-0.2)));
    scene.add(BasicSpring<S>{{corner, bob.centre}, x[3], x[4]});
    scene.add(BasicCentralGravity<S>{{box.centre}, Vec3<S>(S(0.0), S(-1.0), S(-2.0)), x[0] * 3.0});
    scene.add(BasicInverseSquare<S>{{box.centre, bob.centre}, x[0] * x[1], S(0.3)});
    auto mutual = std::make_unique<BasicMutualGravity<S>>(x[8], S(0.2));
    mutual->add(box.centre, x[0]);
    mutual->add(bob.centre, x[1]);
    scene.add_effects(std::move(mutual));
    scene.add(BasicPeriodicForce<S>{{corner}, Vec3<S>(S(0.2), x[8], S(0.1)), x[6], S(0.4)});
    scene.add(BasicBodyTorque<S>{{}, {box.attitude}, Vec3<S>(S(0.1), S(0.2), x[8])});
    scene.add(BasicTorsionSpring<S>{{}, {Attitude{}, box.attitude}, {S(0), S(0), S(1)}, {S(0.6), S(0), S(0.8)}, x[3]});
    scene.add(BasicCentrifugal<S>{{bob.centre}, x[1], Vec3<S>(S(0.1), S(0.2), x[6])});
    scene.damp(box, x[5], x[5] * 0.5);
    scene.gyroscopic_force(bob, Vec3<S>(S(0.1), S(0.2), 2.0 * x[1] * x[6]));
    return scene;
  }
};

/// A machine of joints of every holonomic kind, without damping.
struct Machine {
  static constexpr bool symplectic = true;
  std::vector<double> numbers{2.0, 1.0, 0.4, 0.3, 5.0, 9.81, 0.7};
  template <class S> BasicScene<S> operator()(const std::vector<S>& x) const {
    BasicScene<S> scene;
    const Vec3<S> zero = Vec3<S>::Zero();
    const Quat<S> upright(S(1), S(0), S(0), S(0));
    const Body carriage = scene.rigid_body(x[0], {x[3], S(0.4), S(0.5)}, zero, upright, {S(0.1), S(0), S(0)}, zero);
    const Vec3<S> of_box(S(0.5), S(0.2), -x[6]);
    const Body box = scene.rigid_body(x[1], {S(0.1), S(0.05), S(0.12)}, of_box, Quat<S>(S(0.96), S(0), S(0.28), S(0)),
                                      {S(0.1), S(0), S(0)}, zero);
    const Vec3<S> of_bob(S(0.5), S(0.2), S(-1.5));
    const Body bob = scene.point_mass(x[2], of_bob, {S(0.1), S(0.3), S(0)});
    const Site under = scene.point_of(carriage, {S(0.5), S(0.2), S(-0.3)});
    Matrix<S, 3, 3> attitude = SO3::from_quaternion(Quaternion(0.96, 0, 0.28, 0)).template cast<S>();
    const Vec3<S> arm = attitude.transpose() * Vec3<S>(S(0), S(0), x[6] - 0.3);
    scene.add(BasicCoincidence<S>{{under, scene.point_of(box, arm)}});
    add_rod(scene, box.centre, of_box, bob.centre, of_bob);
    const Site rail = scene.ground(zero);
    scene.add(BasicInPlane<S>{{rail, carriage.centre}, {Attitude{}}, {S(0), S(1), S(0)}});
    scene.add(BasicInPlane<S>{{rail, carriage.centre}, {Attitude{}}, {S(0), S(0), S(1)}});
    scene.add(BasicFixedAngle<S>{{}, {Attitude{}, carriage.attitude}, {S(0), S(1), S(0)}, {S(1), S(0), S(0)}, S(0)});
    scene.add(BasicFixedAngle<S>{{}, {Attitude{}, carriage.attitude}, {S(0), S(0), S(1)}, {S(1), S(0), S(0)}, S(0)});
    const S masses[] = {x[0], x[1], x[2]};
    const Body bodies[] = {carriage, box, bob};
    for (int i = 0; i < 3; ++i)
      scene.add(BasicConstantForce<S>{{bodies[i].centre}, Vec3<S>(S(0), S(0), -masses[i] * x[5])});
    scene.add(
        BasicSpring<S>{{scene.ground({S(1), S(0), S(0)}), scene.point_of(box, {S(0.1), S(0.1), S(0)})}, x[4], S(0.4)});
    return scene;
  }
};

/// Dampers of lengths, turns, hinges and slides, on a pivoted body whose support moves, and drag; planar bodies with a
/// pin, a torsion spring and a motor.
struct Damped {
  static constexpr bool symplectic = false;
  std::vector<double> numbers{0.5, 0.3, 0.2, 0.05, 3.0, 1.5, 0.25};
  template <class S> BasicScene<S> operator()(const std::vector<S>& x) const {
    BasicScene<S> scene;
    scene.rotation = Retraction::cayley;
    const Vec3<S> zero = Vec3<S>::Zero();
    const Quat<S> upright(S(1), S(0), S(0), S(0));
    const Body rod = scene.rigid_body(x[0], {S(0.02), x[3], S(0.03)}, {S(0), S(0), S(0.2)}, upright, zero, zero);
    const Site support = scene.moving_ground(zero, {S(0), S(0), x[6] * 0.1}, x[5] * 4.0);
    scene.add(BasicCoincidence<S>{{support, scene.point_of(rod, {S(0), S(0), S(-0.2)})}});
    scene.add(BasicFixedAngle<S>{{}, {Attitude{}, rod.attitude}, {S(1), S(0), S(0)}, {S(0), S(1), S(0)}, S(0)});
    scene.add(BasicFixedAngle<S>{{}, {Attitude{}, rod.attitude}, {S(0), S(0), S(1)}, {S(0), S(1), S(0)}, S(0)});
    scene.add(Damper<BasicHingeTurn<S>, S>{
        {{}, {Attitude{}, rod.attitude}, {S(0), S(1), S(0)}, {S(0), S(1), S(0)}, S(0)}, x[1]});
    scene.add(Damper<BasicRelativeTurn<S>, S>{{{}, {Attitude{}, rod.attitude}}, x[1] * 0.1});
    scene.add(Damper<BasicLength<S>, S>{
        {{scene.ground({S(0.5), S(0), S(0)}), scene.point_of(rod, {S(0), S(0), S(0.1)})}}, x[2]});
    scene.add(BasicConstantForce<S>{{rod.centre}, Vec3<S>(x[0] * 1.0, S(0), -x[0] * 9.81)});
    const Body link = scene.planar_body(x[4], x[3] * 2.0, {S(0.3), S(1), S(0.4)}, {S(0), S(0), S(0)});
    using std::cos, std::sin;
    const double c = std::cos(0.4), s = std::sin(0.4);
    scene.add(BasicCoincidence<S>{
        {scene.ground({S(0.3 - 0.3 * c), S(1 - 0.3 * s), S(0)}), scene.point_of(link, {S(-0.3), S(0), S(0)})}});
    scene.add(BasicPlanarTorsionSpring<S>{{scene.ground(zero), scene.planar_place(link)}, x[5], S(0.1)});
    scene.add(BasicConstantForce<S>{{link.centre}, Vec3<S>(S(0), -x[4] * 9.81, S(0))});
    scene.damp(link, x[2], x[2] * 0.1);
    scene.damp(rod, x[2], x[2] * 0.01);
    scene.add(BasicMotor<S>{{}, {Attitude{}, rod.attitude}, Vec3<S>(S(0.1), x[6], S(0.2)), x[5], S(0.3)});
    return scene;
  }
};

/// A ball that rolls on a turning plate and a sleigh on its blade, by friction.
struct Rolled {
  static constexpr bool symplectic = false;
  std::vector<double> numbers{1.2, 0.1, 0.5, 0.8, 2.0, 0.3};
  template <class S> BasicScene<S> operator()(const std::vector<S>& x) const {
    BasicScene<S> scene;
    const Quat<S> upright(S(0.96), S(0), S(0.28), S(0));
    const S r = x[2];
    const Vec3<S> place(S(0.4), S(0.1), r);
    const Vec3<S> velocity(S(0.3), S(-0.2), S(0));
    const Vec3<S> slip = velocity - x[3] * Vec3<S>(-place(1), place(0), S(0));
    const Matrix<S, 3, 3> a = SO3::from_quaternion(Quaternion(0.96, 0, 0.28, 0)).template cast<S>();
    const Vec3<S> spin = a.transpose() * Vec3<S>(-slip(1) / r, slip(0) / r, S(0.6));
    const Body ball = scene.rigid_body(x[0], {x[1], S(0.12), S(0.14)}, place, upright, velocity, spin);
    scene.add(BasicRolling<S>{{ball.centre}, {ball.attitude}, r, x[3]});
    scene.add(BasicInPlane<S>{{scene.ground(place), ball.centre}, {Attitude{}}, {S(0), S(0), S(1)}});
    scene.add(BasicConstantForce<S>{{ball.centre}, Vec3<S>(x[0] * 0.5, S(0), S(0))});
    using std::cos, std::sin;
    const S angle = S(0.3), w = S(0.7);
    // Across the blade nothing moves: n.v + arm w = 0.
    const Vec3<S> along(cos(angle), sin(angle), S(0)), across(-sin(angle), cos(angle), S(0));
    const Vec3<S> v = along - across * (x[5] * w);
    const Body sleigh = scene.planar_body(x[4], x[1] * 3.0, {S(0.1), S(0.2), angle}, {v(0), v(1), w});
    scene.add(BasicBlade<S>{{scene.planar_place(sleigh)}, S(0), x[5], S(0)});
    return scene;
  }
};

/// The same by the vakonomic principle, with multipliers at the start, and a spin in space and one in the body.
struct Steered {
  static constexpr bool symplectic = true;
  std::vector<double> numbers{1.2, 0.1, 0.5, 0.2, 2.0};
  template <class S> BasicScene<S> operator()(const std::vector<S>& x) const {
    BasicScene<S> scene;
    const Quat<S> upright(S(0.96), S(0), S(0.28), S(0));
    const S r = x[2];
    const Vec3<S> place(S(0.4), S(0.1), r);
    const Matrix<S, 3, 3> a = SO3::from_quaternion(Quaternion(0.96, 0, 0.28, 0)).template cast<S>();
    const Vec3<S> spin = a.transpose() * Vec3<S>(S(0.2) / r, S(0.3) / r, S(0));
    const Body ball = scene.rigid_body(x[0], {x[1], S(0.12), S(0.14)}, place, upright, {S(0.3), S(-0.2), S(0)}, spin);
    scene.add(Vakonomic<BasicRolling<S>, S>{{{ball.centre}, {ball.attitude}, r, S(0)}, {x[3], x[3] * -0.5}});
    scene.add(BasicInPlane<S>{{scene.ground(place), ball.centre}, {Attitude{}}, {S(0), S(0), S(1)}});
    scene.add(Vakonomic<BasicPrescribedSpin<S>, S>{{{}, {ball.attitude}, {S(0), S(0), S(1)}, S(0)}, {x[3] * 0.3}});
    const Body sleigh =
        scene.planar_body(x[4], x[1] * 3.0, {S(0.1), S(0.2), S(0.3)}, {S(std::cos(0.3)), S(std::sin(0.3)), S(0.7)});
    scene.add(Vakonomic<BasicBlade<S>, S>{{{scene.planar_place(sleigh)}, S(0), S(0), S(0)}, {x[3]}});
    return scene;
  }
};

constexpr double h = 0.02;
constexpr long steps = 12;

template <class Written> LinearisedScene linearised(const Written& write, const Eigen::VectorXd& displacement = {}) {
  Multibody motion(write(write.numbers), h);
  if (displacement.size() > 0) displace(motion, displacement);
  return {std::move(motion), names(write.numbers.size()), write.numbers, [write](const auto& x) {
            return WrittenScene{write(x), [](const ObservedScene& node) { return all_that_moves(node); }};
          }};
}

template <class Written> Eigen::VectorXd end_of(const Written& write, const Eigen::VectorXd& displacement) {
  Multibody motion(write(write.numbers), h);
  if (displacement.size() > 0) displace(motion, displacement);
  for (long k = 0; k < steps; ++k) EXPECT_TRUE(motion.advance().converged()) << "step " << k;
  return all_that_moves(motion);
}

/// How far directions are from what the differences of a run tend to, over their size.
template <class Written>
double off_differences(const Written& write, const Eigen::MatrixXd& derivatives, int states, int k) {
  const Eigen::VectorXd by = laws::detail::extrapolated_difference(
      [&](double width) {
        if (k < states) return end_of(write, Eigen::VectorXd(Eigen::VectorXd::Unit(states, k) * width));
        Written other = write;
        other.numbers[std::size_t(k - states)] += width;
        return end_of(other, {});
      },
      k < states ? 4e-4 : 1e-2 * write.numbers[std::size_t(k - states)], /*widths=*/4);
  return (by - derivatives.col(k)).norm() / std::max(derivatives.col(k).norm(), 1.0);
}

/// The canonical form in (v, mu): v.nu - w.mu, and of rotations pi.(v x w).
Eigen::MatrixXd form(const Multibody& motion) {
  const SceneState& state = motion.state();
  const auto linear = Eigen::Index(state.momentum.size()), rotations = Eigen::Index(state.spin.size());
  const Eigen::Index n = 3 * (linear + rotations);
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(2 * n, 2 * n);
  out.topRightCorner(n, n) = Eigen::MatrixXd::Identity(n, n);
  out.bottomLeftCorner(n, n) = -Eigen::MatrixXd::Identity(n, n);
  for (Eigen::Index r = 0; r < rotations; ++r)
    out.block<3, 3>(3 * (linear + r), 3 * (linear + r)) = -SO3::hat(state.spin[std::size_t(r)]);
  return out;
}
/// Directions (v, mu) along which the joints hold to first order.
Eigen::MatrixXd tangent(const Multibody& motion) {
  const Model& model = motion.model();
  const SceneState& state = motion.state();
  const Eigen::Index linear = Eigen::Index(state.momentum.size()), n = 3 * (linear + Eigen::Index(state.spin.size()));
  Eigen::MatrixXd d = Eigen::MatrixXd::Zero(std::max(motion.rows(), 1), 2 * n);
  const auto put = [&](const Model::Entry& e, Eigen::Index from) {
    if (e.role == Role::holonomic)
      d.row(e.row).segment<3>(3 * (from + e.factor)) += state.gradients[std::size_t(e.gradient)];
  };
  for (const Model::Entry& e : model.rows.linear_entries) put(e, 0);
  for (const Model::Entry& e : model.rows.rotation_entries) put(e, linear);
  return Eigen::FullPivLU<Eigen::MatrixXd>(d).kernel();
}
template <class Written> double symplectic_defect(const Written& write) {
  LinearisedScene motion = linearised(write);
  const Eigen::MatrixXd directions = tangent(motion.motion());
  Eigen::MatrixXd start = Eigen::MatrixXd::Zero(motion.states() + motion.parameters(), directions.cols());
  start.topRows(motion.states()) = directions;
  const Eigen::MatrixXd before = directions.transpose() * form(motion.motion()) * directions;
  const Propagated run = propagate_forward(motion, steps, start);
  EXPECT_TRUE(run.converged()) << run.message;
  const Eigen::MatrixXd end = run.end.topRows(motion.states());
  return (end.transpose() * form(motion.motion()) * end - before).norm() / end.squaredNorm();
}

template <class T> class SceneGradients : public testing::Test {};
using Scenes = testing::Types<FreeBodies, Machine, Damped, Rolled, Steered>;
TYPED_TEST_SUITE(SceneGradients, Scenes);

TYPED_TEST(SceneGradients, AreWhatDifferencesTendTo) {
  const TypeParam write;
  LinearisedScene motion = linearised(write);
  const int states = motion.states(), all = states + motion.parameters();
  Eigen::MatrixXd directions = Eigen::MatrixXd::Identity(all, all);
  directions.topLeftCorner(states, states) = motion.allowed_directions();
  const Propagated end = propagate_forward(motion, steps, directions);
  ASSERT_TRUE(end.converged()) << end.message;
  EXPECT_LT((end.values - end_of(write, {})).norm(), 1e-11 * end.values.norm());
  for (int k = 0; k < all; ++k)
    EXPECT_LT(off_differences(write, end.derivatives, states, k), 1e-8) << "direction " << k << " of " << states;
}

TYPED_TEST(SceneGradients, BackwardAreForward) {
  LinearisedScene motion = linearised(TypeParam());
  const int all = motion.states() + motion.parameters();
  for (const Observed& observed : {Observed::at_end(), Observed::at_node(0), Observed::integral()}) {
    LinearisedScene again = linearised(TypeParam()), back = linearised(TypeParam());
    const Propagated forward = propagate_forward(again, steps, Eigen::MatrixXd::Identity(all, all), observed);
    const Propagated backward = propagate_backward(back, steps, observed, {3});
    ASSERT_TRUE(forward.converged() && backward.converged());
    for (Eigen::Index i = 0; i < forward.values.size(); ++i)
      EXPECT_NEAR(forward.values(i), backward.values(i), 1e-13 * (1 + std::abs(forward.values(i))));
    EXPECT_LT((forward.derivatives - backward.derivatives).norm(), 1e-12 * forward.derivatives.norm());
  }
}

TYPED_TEST(SceneGradients, AreSymplecticWhereTheStepIs) {
  if (TypeParam::symplectic) {
    EXPECT_LT(symplectic_defect(TypeParam()), 1e-13);
  } else {
    EXPECT_GT(symplectic_defect(TypeParam()), 1e-7);  // drag, friction and dampers: what fails the law
  }
}

TEST(SceneGradientsComposed, AreWhatDifferencesTendTo) {
  const Machine write;
  Options options;
  options.composition = compositions::suzuki;
  const auto run = [&](const Machine& other) {
    Multibody motion(other(other.numbers), h, options);
    for (long k = 0; k < steps; ++k) EXPECT_TRUE(motion.advance().converged()) << "step " << k;
    return all_that_moves(motion);
  };
  const auto shares = options.composition.coefficients;
  LinearisedScene motion(
      Multibody(write(write.numbers), h, options), names(write.numbers.size()), write.numbers,
      [write](const auto& x) {
        return WrittenScene{write(x), [](const ObservedScene& node) { return all_that_moves(node); }};
      },
      LinearisedScene::Stages{Multibody(write(write.numbers), h), {shares.begin(), shares.end()}});
  const Propagated end = propagate_backward(motion, steps);
  ASSERT_TRUE(end.converged()) << end.message;
  for (std::size_t k = 0; k < write.numbers.size(); ++k) {
    const Eigen::VectorXd by = laws::detail::extrapolated_difference(
        [&](double width) {
          Machine other = write;
          other.numbers[k] += width;
          return run(other);
        },
        1e-2 * write.numbers[k], /*widths=*/4);
    const Eigen::VectorXd exact = end.derivatives.col(motion.states() + Eigen::Index(k));
    EXPECT_LT((by - exact).norm(), 1e-8 * std::max(exact.norm(), 1.0)) << "number " << k;
  }
}

/// Its force has a derivative that is symmetric and wrong.
template <class S> struct StiffSpring : BasicSpring<S> {
  void add_loads(const BasicConfiguration<S>& at, BasicLoads<S>& f) const {
    const Vec3<S> d = at(this->sites[1]) - at(this->sites[0]);
    const S factor = S(value_of(this->stiffness * (1.0 - this->length / d.norm())));
    f(this->sites[0]) += factor * d;
    f(this->sites[1]) -= factor * d;
  }
};
struct Wrong {
  std::vector<double> numbers{0.7, 5.0, 0.6};
  bool forgets_mass = false;
  template <class S> BasicScene<S> operator()(const std::vector<S>& x) const {
    BasicScene<S> scene;
    const Body bob = scene.point_mass(x[0], {S(1.2), S(-0.3), S(0.5)}, {S(0.0), S(0.4), S(0.1)});
    const S heavy = forgets_mass ? S(value_of(x[0])) : x[0];
    scene.add(BasicConstantForce<S>{{bob.centre}, Vec3<S>(S(0), S(0), heavy * -9.81)});
    if (forgets_mass) {
      scene.add(BasicSpring<S>{{scene.ground(Vec3<S>::Zero()), bob.centre}, x[1], x[2]});
    } else {
      scene.add(StiffSpring<S>{{{scene.ground(Vec3<S>::Zero()), bob.centre}, x[1], x[2]}});
    }
    return scene;
  }
};

TEST(SceneGradientsBroken, WrongSymmetricForcesAreSeenByDifferencesAlone) {
  const Wrong write;
  EXPECT_LT(symplectic_defect(write), 1e-13);
  LinearisedScene motion = linearised(write);
  const int states = motion.states(), all = states + motion.parameters();
  const Propagated end = propagate_forward(motion, steps, Eigen::MatrixXd::Identity(all, all));
  EXPECT_GT(off_differences(write, end.derivatives, states, 0), 1e-4);
}

TEST(SceneGradientsBroken, NumbersReadAsPlainOnesAreSeenByDifferences) {
  Wrong write;
  write.forgets_mass = true;
  LinearisedScene motion = linearised(write);
  const int states = motion.states(), all = states + motion.parameters();
  const Propagated end = propagate_forward(motion, steps, Eigen::MatrixXd::Identity(all, all));
  EXPECT_LT(off_differences(write, end.derivatives, states, states + 1), 1e-8);
  EXPECT_GT(off_differences(write, end.derivatives, states, states), 1e-2);
}

TEST(SceneGradients, RefusesNumbersByWhichJointsWouldNotHold) {
  const auto write = []<class S>(const std::vector<S>& x) {
    BasicScene<S> scene;
    const Body bob = scene.point_mass(S(1), {S(1), S(0), S(0)}, Vec3<S>::Zero());
    scene.add(BasicRod<S>{{scene.ground(Vec3<S>::Zero()), bob.centre}, x[0]});
    return scene;
  };
  const auto begin = [&] {
    return LinearisedScene(Multibody(write(std::vector<double>{1}), h), {"rod.length"}, {1},
                           [&](const auto& x) { return WrittenScene{write(x)}; });
  };
  try {
    begin();
    FAIL() << "the rod would be torn";
  } catch (const WithoutDerivative& refusal) {
    EXPECT_NE(std::string(refusal.what()).find("rod.length"), std::string::npos);
  }
}

}  // namespace
}  // namespace lagroid::multibody::gradients_tests
