// Derivatives of long chains: the laws of those of small scenes, from as few evaluations as a chain of ten takes; of
// bodies that an effect brings together on the way only; and gradients that are taken back without the step's matrix.
#include "../../support/allocation_counter.hpp"
#include "number_names.hpp"

#include <lagroid/solvers/sensitivity/propagate.hpp>
#include <lagroid/solvers/testing/sensitivity_laws.hpp>
#include <lagroid/systems/multibody/effects.hpp>
#include <lagroid/systems/multibody/joints.hpp>
#include <lagroid/systems/multibody/sensitivity/linearised_scene.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdlib>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::multibody::chain_gradients_tests {
namespace {

template <class S> using Vec3 = Vector<S, 3>;

/// Bobs on rods, slanting and wound a little; the numbers are their masses, then the lengths.
struct Chain {
  int links;
  std::vector<double> numbers{};
  explicit Chain(int count) : links(count) {
    for (int i = 0; i < links; ++i) numbers.push_back((1 + 0.1 * (i % 3)) / links);
    for (int i = 0; i < links; ++i) numbers.push_back((1 + 0.05 * (i % 4)) / links);
  }
  template <class S> BasicScene<S> operator()(const std::vector<S>& x) const {
    BasicScene<S> scene;
    Vec3<S> place = Vec3<S>::Zero();
    Site last = scene.ground(place);
    for (int i = 0; i < links; ++i) {
      const S &mass = x[std::size_t(i)], &length = x[std::size_t(links + i)];
      const double turn = 0.6 * i / links;
      const Vec along(std::sin(1.2) * std::cos(turn), std::sin(1.2) * std::sin(turn), -std::cos(1.2));
      for (int k = 0; k < 3; ++k) place(k) += length * along(k);
      const Body bob = scene.point_mass(mass, place, Vec3<S>::Zero());
      scene.add(BasicRod<S>{{last, bob.centre}, length});
      scene.add(BasicConstantForce<S>{{bob.centre}, Vec3<S>(S(0), S(0), mass * -9.81)});
      last = bob.centre;
    }
    return scene;
  }
};

/// A spring that is slack below its length: what it does not hold at the start it does later.
template <class S> struct Cable {
  std::array<Site, 2> sites;
  S stiffness, length;
  S energy(const BasicConfiguration<S>& at) const {
    const S stretch = (at(sites[1]) - at(sites[0])).norm() - length;
    return value_of(stretch) > 0 ? 0.5 * stiffness * stretch * stretch : S(0);
  }
  void add_loads(const BasicConfiguration<S>& at, BasicLoads<S>& f) const {
    const Vec3<S> d = at(sites[1]) - at(sites[0]);
    const S size = d.norm(), stretch = size - length;
    if (value_of(stretch) <= 0) return;
    const Vec3<S> pull = (stiffness * stretch / size) * d;
    f(sites[0]) += pull;
    f(sites[1]) -= pull;
  }
};
/// Masses in a row that fly apart; cables between them, one after another, become taut.
struct Cables {
  std::vector<double> numbers{3.0, 1.15, 0.5};
  template <class S> BasicScene<S> operator()(const std::vector<S>& x) const {
    BasicScene<S> scene;
    std::vector<Body> bobs;
    for (int i = 0; i < 5; ++i)
      bobs.push_back(scene.point_mass(x[2] * (1.0 + i), {S(1.0 * i), S(0.02 * i * i), S(0)},
                                      {S(0.4 * i * i), S(0.1), S(0.3 * i)}));
    for (std::size_t i = 0; i + 1 < bobs.size(); ++i)
      scene.add(Cable<S>{{bobs[i].centre, bobs[i + 1].centre}, x[0], x[1]});
    return scene;
  }
};

/// Planar links under a support that moves, and a spring; numbers of masses, inertias, gravity, the spring and the
/// support, more than have a colour beside the others.
struct Linkage {
  std::vector<double> numbers{3.0, 0.4, 1.5, 20.0, 0.5, 9.81, 0.2, 3.0};
  template <class S> BasicScene<S> operator()(const std::vector<S>& x) const {
    BasicScene<S> scene;
    const Vec3<S> zero = Vec3<S>::Zero();
    Site last = scene.moving_ground(zero, {x[6], S(0), S(0)}, x[7]);
    double px = 0, py = 0;
    for (int i = 0; i < 3; ++i) {
      const double angle = -0.4 - 0.5 * i, dx = 0.3 * std::cos(angle), dy = 0.3 * std::sin(angle);
      const S mass = x[i == 0 ? 0 : 2];
      const Body link = scene.planar_body(mass, x[1] * (1.0 + i), {S(px + dx), S(py + dy), S(angle)}, zero);
      scene.add(BasicCoincidence<S>{{last, scene.point_of(link, {S(-0.3), S(0), S(0)})}});
      scene.add(BasicConstantForce<S>{{link.centre}, Vec3<S>(S(0), mass * x[5] * -1.0, S(0))});
      last = scene.point_of(link, {S(0.3), S(0), S(0)});
      px += 2 * dx;
      py += 2 * dy;
    }
    scene.add(BasicSpring<S>{{scene.ground({S(1), S(1), S(0)}), last}, x[3], x[4]});
    return scene;
  }
};

/// A wind round an axis, beyond a height: it has no potential.
template <class S> struct Swirl {
  std::array<Site, 1> sites;
  S strength;
  double above;
  S energy(const BasicConfiguration<S>&) const { return S(0); }
  void add_loads(const BasicConfiguration<S>& at, BasicLoads<S>& f) const {
    const Vec3<S> x = at(sites[0]);
    const S depth = x(2) - above;
    if (value_of(depth) > 0) f(sites[0]) += strength * depth * depth * Vec3<S>(-x(1), x(0), S(0));
  }
};
/// A pendulum that swings up into it.
struct Blown {
  double above;
  std::vector<double> numbers{1.5, 0.8, 4.0};
  template <class S> BasicScene<S> operator()(const std::vector<S>& x) const {
    BasicScene<S> scene;
    const Body bob = scene.point_mass(x[0], {S(0.6), S(0), S(-0.8)}, {S(0.8), S(0.3), S(0.6)});
    scene.add(BasicRod<S>{{scene.ground(Vec3<S>::Zero()), bob.centre}, S(1)});
    scene.add(BasicConstantForce<S>{{bob.centre}, Vec3<S>(S(0), S(0), x[0] * x[1] * -1.0)});
    scene.add(Swirl<S>{{bob.centre}, x[2], above});
    return scene;
  }
};

constexpr long steps = 40;

VariedNumbers places_and_momenta(const ObservedScene& node) {
  const auto count = Eigen::Index(node.momentum.size());
  VariedNumbers out(6 * count);
  for (Eigen::Index f = 0; f < count; ++f) {
    out.segment<3>(6 * f) = node.at.x[std::size_t(f)];
    out.segment<3>(6 * f + 3) = node.momentum[std::size_t(f)];
  }
  return out;
}

/// One function alone: how high the last body is.
VariedNumbers height(const ObservedScene& node) {
  return VariedNumbers::Constant(1, node.at.x[node.momentum.size() - 1](2));
}

template <class Written>
LinearisedScene linearised(const Written& write, double h,
                           VariedNumbers (*observe)(const ObservedScene&) = places_and_momenta) {
  return {Multibody(write(write.numbers), h), names(write.numbers.size()), write.numbers,
          [write, observe](const auto& x) {
            return WrittenScene{write(x), observe};
          }};
}

/// What those of a run tend to along a direction of the numbers.
template <class Written>
Eigen::VectorXd differences(const Written& write, double h, const Eigen::VectorXd& direction, double width) {
  return laws::detail::extrapolated_difference(
      [&](double by) {
        Written other = write;
        for (std::size_t k = 0; k < other.numbers.size(); ++k) other.numbers[k] += by * direction(Eigen::Index(k));
        Multibody motion(other(other.numbers), h);
        for (long k = 0; k < steps; ++k) EXPECT_TRUE(motion.advance().converged()) << "step " << k;
        const Multibody::Momenta m = motion.momenta();
        Eigen::VectorXd out(Eigen::Index(6 * m.linear.size()));
        for (std::size_t f = 0; f < m.linear.size(); ++f) {
          out.segment<3>(Eigen::Index(6 * f)) = motion.configuration().x[f];
          out.segment<3>(Eigen::Index(6 * f + 3)) = m.linear[f];
        }
        return out;
      },
      width, /*widths=*/4);
}

TEST(ChainGradients, BackwardAreForwardAndWhatDifferencesTendTo) {
  const Chain write(50);
  const double h = 4e-4;
  LinearisedScene motion = linearised(write, h), again = linearised(write, h);
  const int states = motion.states(), all = states + motion.parameters();
  const Propagated forward = propagate_forward(again, steps, Eigen::MatrixXd::Identity(all, all));
  const Propagated backward = propagate_backward(motion, steps, Observed::at_end(), {5});
  ASSERT_TRUE(forward.converged() && backward.converged());
  EXPECT_LT((forward.derivatives - backward.derivatives).norm(), 1e-12 * forward.derivatives.norm());
  for (const long kept : {3L, 20L}) {
    LinearisedScene alone = linearised(write, h, height);
    const Propagated of_height = propagate_backward(alone, steps, Observed::at_end(), {kept});
    ASSERT_TRUE(of_height.converged());
    const Eigen::RowVectorXd expected = forward.derivatives.row(6 * 49 + 2);
    EXPECT_LT((of_height.derivatives - expected).norm(), 1e-12 * expected.norm()) << kept;
  }
  for (unsigned k = 0; k < 3; ++k) {
    std::srand(k);
    const Eigen::VectorXd direction = Eigen::Map<const Eigen::VectorXd>(write.numbers.data(), motion.parameters())
                                          .cwiseProduct(Eigen::VectorXd::Random(motion.parameters()));
    const Eigen::VectorXd exact = backward.derivatives.rightCols(motion.parameters()) * direction;
    const Eigen::VectorXd by = differences(write, h, direction, 1e-2);
    EXPECT_LT((by - exact).norm(), 1e-8 * exact.norm());
  }
}

/// Of the steps from the start, how many have gradients taken back between their nodes. Those are, block by block, what
/// the step's matrix makes of them.
template <class Written> int taken_back(const Written& write, double h, long count) {
  LinearisedScene motion = linearised(write, h);
  const int half = motion.states() / 2, numbers = motion.parameters();
  std::unique_ptr<KeptNode> before, after;
  int taken = 0;
  for (long k = 0; k < count; ++k) {
    motion.keep_node(before);
    EXPECT_TRUE(motion.advance().converged() && motion.linearise());
    motion.keep_node(after);
    std::srand(unsigned(k));
    const Eigen::MatrixXd start = Eigen::MatrixXd::Random(2 * half + numbers, 2);
    Eigen::MatrixXd expected = start, found = start;
    for (int stage = motion.stages(); stage-- > 0;) expected = motion.stage(stage).backward(expected);
    if (!motion.take_back(*before, *after, found)) {
      EXPECT_EQ(found, start) << k;
      continue;
    }
    ++taken;
    for (const auto& [first, rows] : {std::pair{0, half}, {half, half}, {2 * half, numbers}})
      EXPECT_LT((found - expected).middleRows(first, rows).norm(), 1e-12 * expected.middleRows(first, rows).norm())
          << "step " << k << ", from " << first;
  }
  return taken;
}

TEST(ChainGradients, AreTakenBackBetweenNodesAsByTheMatrix) {
  EXPECT_EQ(taken_back(Chain(20), 1e-3, 20), 20);
  EXPECT_EQ(taken_back(Linkage{}, 0.01, 20), 20);
  EXPECT_EQ(taken_back(Cables{}, 0.02, steps), steps) << "numbers that begin to act are asked again";
}

TEST(ChainGradients, AreNotTakenBackThroughForcesWithoutPotential) {
  EXPECT_EQ(taken_back(Blown{.above = -2}, 0.02, 20), 0);
  const int calm = taken_back(Blown{.above = -0.7}, 0.02, steps);
  EXPECT_GT(calm, 0);
  EXPECT_LT(calm, steps) << "it is in the wind in the end";
}

TEST(ChainGradients, AreTakenBackWithoutAllocations) {
  LinearisedScene motion = linearised(Chain(10), 1e-3);
  std::unique_ptr<KeptNode> before, after;
  Eigen::MatrixXd gradients = Eigen::MatrixXd::Ones(motion.states() + motion.parameters(), 2);
  const auto goes_back = [&] {
    motion.keep_node(before);
    const bool converged = motion.pass().converged();
    motion.keep_node(after);
    return converged && motion.take_back(*before, *after, gradients);
  };
  EXPECT_TRUE(goes_back() && goes_back());
  const long count = allocation_count();
  if (count < 0) GTEST_SKIP() << "allocations cannot be counted here";
  for (int k = 0; k < 10; ++k) EXPECT_TRUE(goes_back());
  EXPECT_EQ(allocation_count(), count);
}

TEST(ChainGradients, BackwardMakeEachStepTwice) {
  constexpr long many = 400;
  const auto solved = [](auto motion) {
    const Propagated found = propagate_backward(motion, many);
    EXPECT_TRUE(found.converged()) << found.message;
    EXPECT_LE(found.states_kept, 40);
    return found.steps_solved;
  };
  constexpr long for_units = 10;  // some are made again, to be seen as matrices
  EXPECT_LE(solved(linearised(Chain(5), 1e-3, height)), 2 * many + for_units);
  EXPECT_GT(solved(linearised(Blown{.above = -2}, 1e-3, height)), 2.5 * many);
}

TEST(ChainGradients, AreSymplectic) {
  LinearisedScene motion = linearised(Chain(50), 4e-4);
  const int n = motion.states() / 2, all = motion.states() + motion.parameters();
  Eigen::MatrixXd start = Eigen::MatrixXd::Zero(all, 2 * n);
  start.topRows(2 * n) = motion.allowed_directions();
  const auto form = [n](const Eigen::MatrixXd& x) {
    const Eigen::MatrixXd half = x.topRows(n).transpose() * x.middleRows(n, n);
    return Eigen::MatrixXd(half - half.transpose());
  };
  const Eigen::MatrixXd before = form(start);
  const Propagated run = propagate_forward(motion, steps, start);
  ASSERT_TRUE(run.converged()) << run.message;
  EXPECT_LT((form(run.end) - before).norm(), 1e-13 * run.end.topRows(2 * n).squaredNorm());
}

TEST(ChainGradients, CostAsTheChainIsLong) {
  struct Cost {
    int evaluations;
    long entries;
  };
  const auto cost = [](int links) {
    LinearisedScene motion = linearised(Chain(links), 2e-2 / links);
    EXPECT_TRUE(motion.advance().converged() && motion.linearise());
    const auto& step = dynamic_cast<const SparseStep&>(motion.stage(motion.stages() - 1));
    return Cost{motion.evaluations(), long(step.entries())};
  };
  const Cost ten = cost(10), twenty = cost(20), forty = cost(40), eighty = cost(80);
  EXPECT_LE(ten.evaluations, 4);
  EXPECT_EQ(eighty.evaluations, ten.evaluations);
  EXPECT_EQ(forty.entries - twenty.entries, 2 * (twenty.entries - ten.entries));
  EXPECT_EQ(eighty.entries - forty.entries, 4 * (twenty.entries - ten.entries));
}

TEST(ChainGradients, SeeWhatBeginsToActOnTheWay) {
  const Cables write;
  const double h = 0.02;
  LinearisedScene motion = linearised(write, h);
  ASSERT_TRUE(motion.advance().converged() && motion.linearise());
  const int alone = motion.evaluations();
  LinearisedScene again = linearised(write, h);
  const Propagated end = propagate_forward(again, steps, Eigen::MatrixXd::Identity(33, 33));
  ASSERT_TRUE(end.converged()) << end.message;
  LinearisedScene of_height = linearised(write, h, height);
  const Propagated backward = propagate_backward(of_height, steps);
  EXPECT_LT((backward.derivatives - end.derivatives.row(26)).norm(), 1e-12 * end.derivatives.row(26).norm());
  EXPECT_GT(again.evaluations(), alone);  // bodies that are tied cannot be varied in one direction any more
  for (int k = 0; k < 3; ++k) {
    const Eigen::VectorXd by = differences(write, h, Eigen::VectorXd::Unit(3, k), 1e-5);
    EXPECT_LT((by - end.derivatives.col(30 + k)).norm(), 1e-7 * end.derivatives.col(30 + k).norm()) << k;
  }
}

/// A push that rises with time; of size zero.
template <class S> struct Rising {
  std::array<Site, 1> sites;
  S size;
  S energy(const BasicConfiguration<S>& at) const { return -size * at.time * at(sites[0])(0); }
  void add_loads(const BasicConfiguration<S>& at, BasicLoads<S>& f) const { f(sites[0])(0) += size * at.time; }
};
/// A mass that nothing moves, and that the number would push the more the later it is.
struct AtRest {
  template <class S> BasicScene<S> operator()(const std::vector<S>& x) const {
    BasicScene<S> scene;
    const Body bob = scene.point_mass(S(1.0), Vec3<S>::Zero(), Vec3<S>::Zero());
    scene.add(Rising<S>{{bob.centre}, x[0]});
    return scene;
  }
};

// All nodes are one but for their times, and yet what is kept of one is none of another's.
TEST(ChainGradients, TakenBackAreOfTheirOwnNodes) {
  const std::vector<double> numbers{0.0};
  const auto momentum = [](const ObservedScene& node) {
    VariedNumbers out(1);
    out(0) = node.momentum[0](0);
    return out;
  };
  const auto motion = [&] {
    return LinearisedScene(Multibody(AtRest()(numbers), 0.0625), {"size"}, numbers, [momentum](const auto& x) {
      return WrittenScene{AtRest()(x), momentum};
    });
  };
  LinearisedScene forward = motion(), backward = motion();
  const Propagated wanted = propagate_forward(forward, 20, Eigen::MatrixXd::Identity(7, 7));
  ASSERT_TRUE(wanted.converged());
  EXPECT_NEAR(wanted.derivatives(0, 6), 1.25 * 1.25 / 2, 1e-13);
  for (const char* pass : {"first", "second"}) {
    const Propagated found = propagate_backward(backward, 20);
    EXPECT_LT((found.derivatives - wanted.derivatives).norm(), 1e-13 * wanted.derivatives.norm()) << pass;
  }
}

}  // namespace
}  // namespace lagroid::multibody::chain_gradients_tests
