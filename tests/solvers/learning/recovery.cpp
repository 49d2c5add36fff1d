// How well Hamiltonians are learned, from data and from noise.
#include "chains.hpp"

#include <lagroid/solvers/learning/measures.hpp>
#include <lagroid/solvers/learning/parametric_model.hpp>
#include <lagroid/solvers/learning/potentials/polynomial_potential.hpp>
#include <lagroid/solvers/learning/train.hpp>

#include <gtest/gtest.h>
#include <Eigen/QR>

#include <algorithm>
#include <limits>
#include <string>
#include <vector>

namespace lagroid::learning_tests::recovery_tests {
namespace {

TEST(Recovery, ByPolynomialsIsAsGoodAsTheIntegrator) {
  for (int degree : {1, 2}) {
    const auto model = polynomial_model(1, degree);
    const Trained trained = train(*model, training_data(1), {});
    EXPECT_EQ(trained.outcome, TrainingStatus::converged) << trained.message;
    EXPECT_LT(trained.mse, 1e-20);
    EXPECT_LT(test_error(*model, trained, 1), 1e-19);
    EXPECT_NEAR(model->mass(trained.parameters)(0, 0), 1, 1e-9);
  }
  const auto two = polynomial_model(2, 2);
  const Trained trained = train(*two, training_data(2), {});
  EXPECT_EQ(trained.outcome, TrainingStatus::converged) << trained.message;
  EXPECT_LT(test_error(*two, trained, 2), 1e-15);
  MatrixXd mass(2, 2);
  mass << 2, 1, 1, 1;
  EXPECT_LT((two->mass(trained.parameters) - mass).norm(), 1e-7);
  // The substeps are what is left.
  const Trained finer = train(*two, training_data(2), {.substeps = 8});
  EXPECT_LT(test_error(*two, finer, 2), 1e-20);
}

TEST(Recovery, ThroughEveryIntegratorReachesItsOwnError) {
  const auto model = polynomial_model(1, 1);
  const Trajectories data = training_data(1, 100);
  std::vector<double> errors;
  for (const LieGroupMethod& method : lie_group_methods::all) {
    const Trained trained = train(*model, data, {.method = method, .starts = 1});
    EXPECT_EQ(trained.outcome, TrainingStatus::converged) << method.name << trained.message;
    const double error = test_error(*model, trained, 1);
    if (method.order == 1) {
      EXPECT_GT(error, 1e-8) << method.name;
    }
    EXPECT_LT(error, method.order == 1   ? 1e-4
                     : method.order == 2 ? 1e-8
                     : method.order == 3 ? 1e-12
                                         : 1e-15)
        << method.name;
  }
}

TEST(Recovery, OfThreeBodies) {
  const auto model = polynomial_model(3, 1);
  const Trained trained = train(*model, training_data(3, 100), {});
  EXPECT_LT(test_error(*model, trained, 3), 1e-14);
}

TEST(Recovery, OfAUsersPotential) {
  const ParametricModel<Springs, 2> model("springs", Springs{});
  VectorXd truth(7);
  truth << 0.3, 0.5, -0.2, 1.5, 0.4, -0.8, 0.7;
  Trajectories data = training_data(2, 60);
  const Schedule schedule{lie_group_methods::commutator_free_4, data.interval, data.points - 1, 2};
  model.predict(truth, schedule, data.starts, data.ends);
  const Trained trained = train(model, data, {});
  EXPECT_LT(trained.mse, 1e-26) << trained.message;
  EXPECT_LT((model.mass(trained.parameters) - model.mass(truth)).norm(), 1e-10);
  // On spheres stiffness and distance are felt as their product alone.
  const VectorXd found = trained.parameters.tail<3>() * trained.parameters(3);
  EXPECT_LT((found - truth.tail<3>() * truth(3)).norm(), 1e-10);
}

/// Instrumented or unoptimised these take many minutes.
#if defined(__OPTIMIZE__) && !defined(LAGROID_SANITIZED)
constexpr bool fast = true;
#else
constexpr bool fast = false;
#endif

TEST(Networks, LearnOnePendulum) {
  if (!fast) GTEST_SKIP();
  const auto model = network_model(1, {8});
  const Trained trained = train(*model, training_data(1), {});
  EXPECT_LT(test_error(*model, trained, 1), 1e-10);
  RecordProperty("processor_seconds", std::to_string(trained.seconds));
}

TEST(Networks, LearnTwoPendulums) {
  if (!fast) GTEST_SKIP();
  const auto model = network_model(2, {8});
  const Trained trained = train(*model, training_data(2), {});
  EXPECT_LT(test_error(*model, trained, 2), 1e-9);
  RecordProperty("processor_seconds", std::to_string(trained.seconds));
}

TEST(Noise, IsReachedAndNotBeaten) {
  const double noise = 0.01;
  const double variance = noise * noise / 3;
  const Trajectories data = training_data(1, 500, noise);
  for (const auto& model : {polynomial_model(1, 2), network_model(1, {8})}) {
    const Trained trained = train(*model, data, {.validation = 0.2});
    EXPECT_NEAR(trained.mse / variance, 1, 0.05) << model->name();
    EXPECT_NEAR(trained.validation / variance, 1, 0.1) << model->name();
    // The original's median is 6.7e-6.
    EXPECT_LT(test_error(*model, trained, 1), 1e-5) << model->name();
  }
}

TEST(Noise, OfFewDataIsNotLearnedByHeart) {
  const Trajectories data = training_data(1, 40, 0.03);
  const auto model = network_model(1, {12});
  const Trained heard = train(*model, data, {.starts = 1, .iterations = 400, .least_progress = 1e-9});
  const Trained stopped =
      train(*model, data, {.starts = 1, .iterations = 400, .validation = 0.25, .least_progress = 1e-9});
  EXPECT_EQ(stopped.outcome, TrainingStatus::early_stopped) << to_string(stopped.outcome);
  EXPECT_LT(stopped.iterations, heard.iterations);
  double least = std::numeric_limits<double>::infinity();
  for (const Stage& stage : stopped.history) least = std::min(least, stage.validation);
  EXPECT_EQ(stopped.validation, least);
  EXPECT_LT(test_error(*model, stopped, 1), test_error(*model, heard, 1));
}

TEST(Measures, TellTheTruthFromAnother) {
  const auto model = polynomial_model(1, 1);
  const Trajectories data = test_data(1);
  VectorXd theta = VectorXd::Zero(4);
  theta(1 + 2) = 1;
  const PolynomialPotential monomials(1, 1);
  ASSERT_EQ(monomials.powers(2)[2], 1);
  const Measures good = measure(*model, theta, data);
  EXPECT_LT(good.mse, 1e-20);
  EXPECT_LT(good.energy_largest, 1e-11);
  EXPECT_LT(good.momentum_learned, 1e-11);
  EXPECT_EQ(good.lost, 0);
  EXPECT_EQ(good.times.size(), 14U);
  EXPECT_NEAR(good.times.back(), 1, 1e-15);
  theta(1) = 0.1;  // gravity aslant
  const Measures bad = measure(*model, theta, data);
  EXPECT_GT(bad.mse, 1e-4);
  EXPECT_GT(bad.rms.back(), 2 * bad.rms.front());
  EXPECT_GT(bad.energy_largest, 0.01);
  EXPECT_GT(bad.momentum_learned, 0.01);
  EXPECT_LT(bad.momentum_data, 1e-11);
}

}  // namespace
}  // namespace lagroid::learning_tests::recovery_tests
