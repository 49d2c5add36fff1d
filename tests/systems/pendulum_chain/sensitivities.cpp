// Derivatives of runs of chains: by tangent directions of the start and by parameters, of all methods, in both forms.

#include "chains.hpp"

#include <lagroid/solvers/sensitivity/propagate.hpp>
#include <lagroid/systems/pendulums/chain_derivatives.hpp>
#include <lagroid/systems/pendulums/chain_rattle.hpp>
#include <lagroid/systems/spheres/linearised_sphere_motion.hpp>

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <memory>
#include <random>
#include <string>
#include <vector>

namespace lagroid::pendulum_chain_tests {
namespace {

constexpr long steps = 25;
const std::vector<std::string> parameters{"masses.0", "lengths", "gravity"};

/// A chain and a point of the bundle in the form of the options, both drawn.
struct Drawn {
  Eigen::VectorXd masses, lengths;
  double gravity;
  SphereIntegratorOptions options;
  Points start;

  Chain chain() const { return {masses, lengths, gravity}; }
  /// Another by component `which` of the tangent coordinates and the parameters.
  Drawn moved(int which, double by) const {
    Drawn out = *this;
    const int of_start = 4 * int(start.cols());
    if (which < of_start) {
      const Eigen::VectorXd coordinates = by * Eigen::VectorXd::Unit(of_start, which);
      tangent_directions(start, coordinates, out.start);
    } else if (which == of_start) {
      out.masses(0) += by;
    } else if (which == of_start + 1) {
      out.lengths.array() += by;
    } else {
      out.gravity += by;
    }
    return out;
  }
  std::unique_ptr<SphereIntegrator> integrator() const { return make_chain_integrator(chain(), start, options); }
  /// Derivatives are those of steps of this chain.
  LinearisedSphereMotion motion(const Chain& of) const {
    return {[this](const auto& by) { return make_chain_integrator(chain(), start, by); }, options,
            make_chain_derivatives(of, options, SphereForm::momenta, parameters)};
  }
  LinearisedSphereMotion motion() const { return motion(chain()); }
  int columns() const { return 4 * int(start.cols()) + int(parameters.size()); }
  /// Those of the start, then those of the parameters.
  Eigen::MatrixXd directions() const {
    const Eigen::Index of_start = 4 * start.cols(), states = start.size(), numbers = Eigen::Index(parameters.size());
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(states + numbers, of_start + numbers);
    Points same;
    out.topLeftCorner(states, of_start) = tangent_directions(start, Eigen::VectorXd::Zero(of_start), same);
    out.bottomRightCorner(numbers, numbers).setIdentity();
    return out;
  }
};

Drawn draw(int links, const SphereIntegratorOptions& options, unsigned seed) {
  std::mt19937_64 random(seed);
  std::uniform_real_distribution<double> uniform(-1, 1);
  Drawn out;
  out.options = options;
  out.masses = Eigen::VectorXd::NullaryExpr(links, [&] { return 1 + 0.5 * uniform(random); });
  out.lengths = Eigen::VectorXd::NullaryExpr(links, [&] { return 1 + 0.5 * uniform(random); });
  out.gravity = 9 + uniform(random);
  out.start = Points::NullaryExpr(6, links, [&] { return uniform(random); });
  for (int i = 0; i < links; ++i) out.start.col(i).head<3>().normalize();
  out.chain().space().project(out.start);
  return out;
}

/// What is observed at the end, from the numbers of the program alone.
Eigen::VectorXd end_of(const Drawn& from) {
  const Chain chain = from.chain();
  const auto integrator = from.integrator();
  for (long k = 0; k < steps; ++k) EXPECT_TRUE(integrator->advance().converged());
  const Points z = integrator->point();
  const bool velocities = from.options.form == SphereForm::velocities;
  const Points moving = velocities ? z : chain.to_velocities(z);
  const Points momenta = velocities ? chain.to_momenta(z) : z;
  Eigen::Matrix3Xd bobs = z.topRows<3>() * from.lengths.asDiagonal();
  for (Eigen::Index i = 1; i < bobs.cols(); ++i) bobs.col(i) += bobs.col(i - 1);
  Eigen::VectorXd out(9 * z.cols() + 2);
  out << bobs.reshaped(), z.topRows<3>().reshaped(), momenta.bottomRows<3>().reshaped(), chain.energy(moving),
      chain.vertical_momentum(moving);
  return out;
}

Eigen::VectorXd difference(const Drawn& from, int which) {
  std::vector<Eigen::VectorXd> central;
  for (const double width : {2e-3, 1e-3, 5e-4})
    central.emplace_back((end_of(from.moved(which, width)) - end_of(from.moved(which, -width))) / (2 * width));
  const Eigen::VectorXd coarse = (4 * central[1] - central[0]) / 3;
  const Eigen::VectorXd fine = (4 * central[2] - central[1]) / 3;
  return (16 * fine - coarse) / 15;
}

/// The methods of scenes on spheres that have equal steps.
std::vector<SphereIntegratorOptions> all_methods() {
  std::vector<SphereIntegratorOptions> out;
  for (const Composition& composition : {compositions::single, compositions::suzuki})
    out.push_back({.method = "rattle", .step = 0.02, .composition = composition});
  for (const LieGroupMethod& method : lie_group_methods::all)
    for (const SphereForm form : {SphereForm::velocities, SphereForm::momenta})
      out.push_back({.method = std::string(method.name), .form = form, .step = 0.02});
  return out;
}

double largest_miss(const Drawn& from, const Propagated& end) {
  double most = 0;
  for (int which = 0; which < from.columns(); ++which) {
    const Eigen::VectorXd differences = difference(from, which);
    most = std::max(most, (end.derivatives.col(which) - differences).norm() / std::max(1.0, differences.norm()));
  }
  return most;
}

TEST(ChainSensitivities, AreWhatDifferencesTendTo) {
  for (const SphereIntegratorOptions& options : all_methods())
    for (unsigned seed = 1; seed <= 6; ++seed) {
      const int links = int(seed % 3) + 1;
      const Drawn from = draw(links, options, seed);
      LinearisedSphereMotion motion = from.motion();
      const Propagated end = propagate_forward(motion, steps, from.directions());
      ASSERT_TRUE(end.converged()) << options.method << ": " << end.message;
      EXPECT_LT((end.values - end_of(from)).norm(), 1e-12 * end.values.norm()) << options.method;
      EXPECT_LT(largest_miss(from, end), 1e-8) << options.method << ", " << links;
    }
}

TEST(ChainSensitivities, BackwardIsForward) {
  for (const SphereIntegratorOptions& options : all_methods()) {
    const Drawn from = draw(2, options, 7);
    for (const Observed& observed : {Observed::at_end(), Observed::at_node(9), Observed::integral()}) {
      LinearisedSphereMotion motion = from.motion();
      const Propagated end = propagate_forward(motion, steps, from.directions(), observed);
      LinearisedSphereMotion backwards = from.motion();
      const Propagated back = propagate_backward(backwards, steps, observed, {5});
      ASSERT_TRUE(end.converged() && back.converged()) << end.message << back.message;
      EXPECT_LE(back.states_kept, 5);
      EXPECT_LT((back.derivatives * from.directions() - end.derivatives).norm(), 1e-12 * end.derivatives.norm())
          << options.method;
    }
  }
}

/// dp(a) . dq(b) - dp(b) . dq(a) of all pairs of columns of (dq, dp).
Eigen::MatrixXd symplectic_products(const Eigen::MatrixXd& along) {
  Eigen::MatrixXd q(along.rows() / 2, along.cols()), p = q;
  for (Eigen::Index i = 0; i < q.rows(); i += 3) {
    q.middleRows<3>(i) = along.middleRows<3>(2 * i);
    p.middleRows<3>(i) = along.middleRows<3>(2 * i + 3);
  }
  const Eigen::MatrixXd one_way = p.transpose() * q;
  return one_way - one_way.transpose();
}
/// How far a run is from carrying the form along tangent directions.
double symplectic_defect(const Drawn& from) {
  const auto derivatives = make_chain_derivatives(from.chain(), from.options, SphereForm::momenta, {});
  const auto along_momenta = [&](const Points& z, const Eigen::MatrixXd& directions) {
    return Eigen::MatrixXd(derivatives->in_form(z, from.options.form, SphereForm::momenta) * directions);
  };
  LinearisedSphereMotion motion = from.motion();
  const Eigen::Index states = from.start.size(), of_start = 4 * from.start.cols();
  const Eigen::MatrixXd directions = from.directions(), start = directions.topLeftCorner(states, of_start);
  const Propagated end = propagate_forward(motion, steps, directions.leftCols(of_start));
  const auto integrator = from.integrator();
  for (long k = 0; k < steps; ++k) integrator->advance();
  const Eigen::MatrixXd before = symplectic_products(along_momenta(from.start, start));
  const Eigen::MatrixXd after = symplectic_products(along_momenta(integrator->point(), end.end.topRows(states)));
  return (after - before).norm() / before.norm();
}

TEST(ChainSensitivities, OfRattleAreSymplecticOnTheBundleAndOfLieGroupMethodsAreNot) {
  for (const int links : {1, 3, 8}) {
    SphereIntegratorOptions options{.method = "rattle", .step = 0.02};
    EXPECT_LT(symplectic_defect(draw(links, options, 3)), 1e-12) << links;
    options.composition = compositions::suzuki;
    EXPECT_LT(symplectic_defect(draw(links, options, 4)), 1e-12) << links;
    options = {.method = "lie-euler", .step = 0.02};
    EXPECT_GT(symplectic_defect(draw(links, options, 3)), 1e-3) << links;
  }
}

TEST(ChainSensitivities, OfTangentDirectionsStayTangent) {
  for (const SphereIntegratorOptions& options : all_methods()) {
    const LieGroupMethod* method = lie_group_methods::named(options.method);
    const Drawn from = draw(3, options, 5);
    LinearisedSphereMotion motion = from.motion();
    const Propagated end = propagate_forward(motion, steps, from.directions());
    const auto integrator = from.integrator();
    for (long k = 0; k < steps; ++k) integrator->advance();
    const Points z = integrator->point();
    double off = 0;
    for (Eigen::Index i = 0; i < z.cols(); ++i) {
      const Eigen::MatrixXd dq = end.end.middleRows<3>(6 * i), dw = end.end.middleRows<3>(6 * i + 3);
      const V q = z.col(i).head<3>(), w = z.col(i).tail<3>();
      off = std::max({off, (q.transpose() * dq).norm(), (q.transpose() * dw + w.transpose() * dq).norm()});
    }
    if (method != nullptr && method->scheme == LieGroupScheme::classical) {
      EXPECT_GT(off, 1e-9) << options.method;
    } else {
      EXPECT_LT(off, 1e-11) << options.method;
    }
  }
}

TEST(ChainSensitivities, OfHeldInnerStepsAreThoseOfTheProgramAsFarAsTheToleranceGoes) {
  double loosest = 0;
  for (const SphereIntegratorOptions& options :
       {SphereIntegratorOptions{.method = "munthe-kaas-54", .step = 0.05},
        SphereIntegratorOptions{.method = "munthe-kaas-54", .form = SphereForm::momenta, .step = 0.05},
        SphereIntegratorOptions{.method = "extrapolation", .step = 0.05}})
    for (const double tolerance : {1e-4, 1e-13}) {
      Drawn from = draw(3, options, 6);
      from.options.tolerance = tolerance;
      LinearisedSphereMotion motion = from.motion();
      const Propagated end = propagate_forward(motion, steps, from.directions());
      ASSERT_TRUE(end.converged()) << options.method << ": " << end.message;
      const double miss = largest_miss(from, end);
      EXPECT_LT(miss, tolerance < 1e-8 ? 1e-8 : 1) << options.method;
      LinearisedSphereMotion backwards = from.motion();
      const Propagated back = propagate_backward(backwards, steps, Observed::at_end(), {5});
      ASSERT_TRUE(back.converged()) << back.message;
      EXPECT_LT((back.derivatives * from.directions() - end.derivatives).norm(), 1e-12 * end.derivatives.norm());
      if (tolerance > 1e-8) loosest = std::max(loosest, miss);
    }
  EXPECT_GT(loosest, 1e-8) << "runs beside these have inner steps of other sizes";
}

TEST(ChainSensitivities, OfAnotherChainMissTheDifferences) {
  const Drawn from = draw(2, {.method = "rattle", .step = 0.02}, 2);
  Drawn other = from;
  other.gravity *= 1 + 1e-5;
  LinearisedSphereMotion wrong = from.motion(other.chain());
  EXPECT_GT(largest_miss(from, propagate_forward(wrong, steps, from.directions())), 1e-7);
}

TEST(ChainSensitivities, AreAlongSouthAndEast) {
  // At a pole south and east are those of phi = 0, elsewhere those of the angles.
  EXPECT_LT((tangent_frame({0, 0, 1}) - (Eigen::Matrix<double, 3, 2>() << 1, 0, 0, 1, 0, 0).finished()).norm(), 1e-15);
  EXPECT_LT((tangent_frame({0, 0, -1}) - (Eigen::Matrix<double, 3, 2>() << -1, 0, 0, 1, 0, 0).finished()).norm(),
            1e-15);
  const double theta = 1.1, phi = -2.3;
  const auto q = [](double t, double f) {
    return V(std::sin(t) * std::cos(f), std::sin(t) * std::sin(f), std::cos(t));
  };
  Eigen::Matrix<double, 3, 2> frame;
  frame << (q(theta + 1e-6, phi) - q(theta - 1e-6, phi)) / 2e-6,
      (q(theta, phi + 1e-6) - q(theta, phi - 1e-6)) / (2e-6 * std::sin(theta));
  EXPECT_LT((tangent_frame(q(theta, phi)) - frame).norm(), 1e-9);
}

TEST(ChainSensitivities, RefuseWhatHasNone) {
  const Chain chain = draw(2, {}, 1).chain();
  const auto refused = [&](const SphereIntegratorOptions& options, const std::vector<std::string>& names) {
    EXPECT_THROW(make_chain_derivatives(chain, options, SphereForm::momenta, names), std::invalid_argument);
  };
  refused({.method = "rattle"}, {"colour"});
  refused({.method = "rattle"}, {"masses.2"});
  refused({.method = "leap-frog"}, {});
  refused({.method = "extrapolation", .form = SphereForm::momenta, .tolerance = 1e-8}, {});
}

}  // namespace
}  // namespace lagroid::pendulum_chain_tests
