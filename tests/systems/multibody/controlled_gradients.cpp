// Exact derivatives of scenes of bodies by controlled steps, whose sizes and times depend on the start and on numbers:
// against extrapolated differences of the motion itself, and forward against backward.
#include "all_that_moves.hpp"
#include "number_names.hpp"

#include <lagroid/solvers/sensitivity/propagate.hpp>
#include <lagroid/solvers/testing/sensitivity_laws.hpp>
#include <lagroid/systems/multibody/effects.hpp>
#include <lagroid/systems/multibody/sensitivity/linearised_controlled_scene.hpp>
#include <lagroid/systems/multibody/sensitivity/linearised_scene.hpp>

#include <gtest/gtest.h>

#include <functional>
#include <memory>
#include <random>
#include <stdexcept>
#include <utility>
#include <vector>

namespace lagroid::multibody::controlled_gradients_tests {
namespace {

template <class S> using Vec3 = Vector<S, 3>;
constexpr double first_step = 0.02;
constexpr long steps = 30;

/// Three bodies that attract each other about a centre, one of them a body that turns. Numbers: masses, the constant,
/// the softening, the centre's strength, an inertia, a place.
struct Stars {
  std::vector<double> numbers{1.0, 0.6, 0.3, 0.8, 0.05, 2.0, 0.4, 0.9};
  template <class S> BasicScene<S> operator()(const std::vector<S>& x) const {
    BasicScene<S> scene;
    const Body a = scene.point_mass(x[0], {x[7], S(0.1), S(0)}, {S(0), S(1.1), S(0.1)});
    const Body b = scene.point_mass(x[1], {S(-0.7), S(0.2), S(0.1)}, {S(0.1), S(-1.3), S(0)});
    const Body c =
        scene.rigid_body(x[2], {x[6], S(0.5), S(0.6)}, {S(0.1), S(-1.2), S(0)}, Vector<S, 4>(S(1), S(0), S(0), S(0)),
                         {S(1.0), S(0.2), S(-0.1)}, {S(0.3), S(1), S(-0.2)});
    auto mutual = std::make_unique<BasicMutualGravity<S>>(x[3], x[4]);
    const Body bodies[] = {a, b, c};
    for (int i = 0; i < 3; ++i) {
      mutual->add(bodies[i].centre, x[std::size_t(i)]);
      scene.add(BasicCentralGravity<S>{{bodies[i].centre}, Vec3<S>::Zero(), x[5] * x[std::size_t(i)]});
    }
    scene.add_effects(std::move(mutual));
    return scene;
  }
};

Stars drawn(std::mt19937_64& random) {
  std::uniform_real_distribution<double> by(0.9, 1.1);
  Stars out;
  for (double& number : out.numbers) number *= by(random);
  return out;
}

/// The time, and all that moves.
VariedNumbers all_of_it(const ObservedScene& node) {
  const VariedNumbers moving = all_that_moves(node);
  VariedNumbers out(1 + moving.size());
  out << node.at.time, moving;
  return out;
}
Eigen::VectorXd all_of_it(const Multibody& motion) {
  const Eigen::VectorXd moving = all_that_moves(motion);
  Eigen::VectorXd out(1 + moving.size());
  out << motion.time(), moving;
  return out;
}

Multibody begun(const Stars& write, const Eigen::VectorXd& displacement = {}) {
  Options options;
  options.controlled = true;
  Multibody motion(write(write.numbers), first_step, options);
  if (displacement.size() > 0) displace(motion, displacement);
  return motion;
}
LinearisedControlledScene linearised(const Stars& write) {
  return {begun(write), names(write.numbers.size()), write.numbers, [write](const auto& x) {
            return WrittenScene{write(x), [](const ObservedScene& node) { return all_of_it(node); }};
          }};
}

/// At the last node, or at a time after a node.
Eigen::VectorXd end_of(const Stars& write, const Eigen::VectorXd& displacement, double time = -1) {
  Multibody motion = begun(write, displacement);
  for (long k = 0; k < steps; ++k) EXPECT_TRUE(motion.advance().converged()) << "step " << k;
  if (time >= 0) {
    EXPECT_TRUE(motion.advance_by(time - motion.time()).converged());
  }
  return all_of_it(motion);
}

/// Along a direction of start and numbers.
Eigen::VectorXd differences(const Stars& write, const Eigen::VectorXd& by,
                            const std::function<Eigen::VectorXd(const Stars&, const Eigen::VectorXd&)>& end) {
  const Eigen::Index of_start = by.size() - Eigen::Index(write.numbers.size());
  return laws::detail::extrapolated_difference(
      [&](double width) {
        Stars other = write;
        for (std::size_t i = 0; i < other.numbers.size(); ++i)
          other.numbers[i] += width * by(of_start + Eigen::Index(i));
        return end(other, Eigen::VectorXd(width * by.head(of_start)));
      },
      1e-3, /*widths=*/4);
}

/// Directions of (v, mu, t, rho, theta) from those of (v, mu, theta).
Eigen::MatrixXd extended(const Eigen::MatrixXd& by, int states) {
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(by.rows() + 2, by.cols());
  out.topRows(states - 2) = by.topRows(states - 2);
  out.bottomRows(by.rows() - states + 2) = by.bottomRows(by.rows() - states + 2);
  return out;
}
Eigen::MatrixXd drawn_directions(std::mt19937_64& random, const LinearisedControlledScene& motion) {
  std::normal_distribution<double> number;
  Eigen::MatrixXd out(motion.states() - 2 + motion.parameters(), 3);
  for (Eigen::Index i = 0; i < out.size(); ++i) out.data()[i] = 0.3 * number(random);
  return out;
}

TEST(ControlledSceneGradients, AreWhatDifferencesTendTo) {
  std::mt19937_64 random(5);
  for (int draw = 0; draw < 4; ++draw) {
    const Stars write = drawn(random);
    LinearisedControlledScene motion = linearised(write);
    const Eigen::MatrixXd by = drawn_directions(random, motion);
    const Propagated end = propagate_forward(motion, steps, extended(by, motion.states()));
    ASSERT_TRUE(end.converged()) << end.message;
    EXPECT_LT((end.values - end_of(write, {})).norm(), 1e-11 * end.values.norm());
    for (Eigen::Index k = 0; k < by.cols(); ++k) {
      const Eigen::VectorXd found =
          differences(write, by.col(k), [](const Stars& other, const Eigen::VectorXd& x) { return end_of(other, x); });
      EXPECT_LT((found - end.derivatives.col(k)).norm(), 1e-8 * found.norm()) << "draw " << draw;
    }
  }
}

/// Between nodes, where a fit asks for them.
TEST(ControlledSceneGradients, AtATimeAreWhatDifferencesTendTo) {
  std::mt19937_64 random(6);
  const Stars write = drawn(random);
  LinearisedControlledScene motion = linearised(write);
  const Eigen::MatrixXd by = drawn_directions(random, motion);
  Eigen::MatrixXd x = extended(by, motion.states());
  for (long k = 0; k < steps; ++k) {
    ASSERT_TRUE(motion.advance().converged() && motion.linearise());
    for (int stage = 0; stage < motion.stages(); ++stage) x = motion.stage(stage).forward(x);
  }
  const double time = motion.time() + 0.4 * motion.motion().step();
  const auto there = motion.observe_later(time);
  ASSERT_TRUE(there.has_value());
  EXPECT_LT((there->values - end_of(write, {}, time)).norm(), 1e-11 * there->values.norm());
  for (Eigen::Index k = 0; k < by.cols(); ++k) {
    const Eigen::VectorXd found = differences(
        write, by.col(k), [time](const Stars& other, const Eigen::VectorXd& d) { return end_of(other, d, time); });
    EXPECT_LT((found - there->derivatives * x.col(k)).norm(), 1e-8 * found.norm());
  }
  // It goes on as if nothing had been looked at.
  LinearisedControlledScene other = linearised(write);
  for (long k = 0; k < steps + 1; ++k) ASSERT_TRUE(other.advance().converged());
  ASSERT_TRUE(motion.advance().converged());
  EXPECT_EQ(motion.time(), other.time());
  EXPECT_EQ(motion.motion().state().at.x[0], other.motion().state().at.x[0]);
}

TEST(ControlledSceneGradients, BackwardAreForward) {
  const Stars write;
  LinearisedControlledScene one = linearised(write);
  const int all = one.states() + one.parameters();
  for (const Observed& observed : {Observed::at_end(), Observed::at_node(0), Observed::at_node(17)}) {
    LinearisedControlledScene again = linearised(write), back = linearised(write);
    const Propagated forward = propagate_forward(again, steps, Eigen::MatrixXd::Identity(all, all), observed);
    const Propagated backward = propagate_backward(back, steps, observed, {3});
    ASSERT_TRUE(forward.converged() && backward.converged());
    EXPECT_LT((forward.derivatives - backward.derivatives).norm(), 1e-12 * forward.derivatives.norm());
  }
  EXPECT_THROW(propagate_forward(one, steps, Eigen::MatrixXd::Identity(all, all), Observed::integral()),
               std::invalid_argument);
}

/// Steps of the same sizes, held fixed: what the derivative would be without that of the controller.
TEST(ControlledSceneGradients, OfSizesHeldFixedMissTheDifferences) {
  std::mt19937_64 random(7);
  const Stars write = drawn(random);
  LinearisedControlledScene motion = linearised(write);
  const Eigen::MatrixXd by = drawn_directions(random, motion);
  const Propagated end = propagate_forward(motion, steps, extended(by, motion.states()));
  std::vector<double> sizes;
  for (Multibody run = begun(write); run.index() < steps;) {
    ASSERT_TRUE(run.advance().converged());
    sizes.push_back(run.step());
  }
  const Eigen::VectorXd held =
      differences(write, by.col(0), [&](const Stars& other, const Eigen::VectorXd& displacement) {
        Multibody run(other(other.numbers), 10 * first_step);
        displace(run, displacement);
        for (const double size : sizes) EXPECT_TRUE(run.advance_by(size).converged());
        return all_of_it(run);
      });
  EXPECT_GT((held - end.derivatives.col(0)).norm(), 1e-2 * held.norm());
}

TEST(ControlledSceneGradients, RefuseOtherMotions) {
  const Stars write;
  const auto varied = [write](const auto& x) { return WrittenScene{write(x)}; };
  EXPECT_THROW(LinearisedControlledScene(Multibody(write(write.numbers), first_step), {}, {}, varied),
               std::invalid_argument);
  EXPECT_THROW(LinearisedScene(begun(write), {}, {}, varied), std::invalid_argument);
  Multibody later = begun(write);
  ASSERT_TRUE(later.advance().converged());
  EXPECT_THROW(LinearisedControlledScene(std::move(later), {}, {}, varied), std::invalid_argument);
}

}  // namespace
}  // namespace lagroid::multibody::controlled_gradients_tests
