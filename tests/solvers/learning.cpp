// Learning Hamiltonians from trajectories.

#include <lagroid/solvers/learning/compressed.hpp>
#include <lagroid/solvers/learning/measures.hpp>
#include <lagroid/solvers/learning/parametric_model.hpp>
#include <lagroid/solvers/learning/potentials/network_potential.hpp>
#include <lagroid/solvers/learning/potentials/polynomial_potential.hpp>
#include <lagroid/solvers/learning/train.hpp>
#include <lagroid/systems/pendulums/chain_trajectories.hpp>
#include <lagroid/systems/spheres/sphere_hamiltonian.hpp>

#include <gtest/gtest.h>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <functional>
#include <limits>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

using namespace lagroid;
using namespace lagroid::learning;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

using Chain = PendulumChain<Eigen::Dynamic>;

/// The original's: unit masses, lengths and gravity.
Chain unit_chain(int k) { return Chain(VectorXd::Ones(k), VectorXd::Ones(k), 1); }
Trajectories training_data(int k, int count = 500, double noise = 0, unsigned seed = 7) {
  return assemble(draw_trajectories(unit_chain(k), {.count = count, .noise = noise, .seed = seed}), noise);
}
/// The original's: a hundred trajectories of 15 points until t = 1.
Trajectories test_data(int k) {
  return assemble(draw_trajectories(unit_chain(k), {.count = 100, .points = 15, .duration = 1, .seed = 1007}));
}
double test_error(const Model& model, const Trained& trained, int k) {
  return measure(model, trained.parameters, test_data(k)).mse;
}

VectorXd random_vector(Eigen::Index n, unsigned seed) {
  std::mt19937 generator(seed);
  VectorXd out(n);
  for (double& x : out) x = 2 * (double(generator()) / 4294967296.0) - 1;
  return out;
}
VectorXd random_state(int k, unsigned seed) {
  VectorXd z = random_vector(6 * k, seed);
  put_on_spheres(z);
  return z;
}
/// The velocity of z under u in se(3)^k.
VectorXd velocity(const VectorXd& z, const VectorXd& u) {
  const int k = int(z.size() / 6);
  const CotangentSpheres<Eigen::Dynamic> space{k};
  auto v = space.zero_point();
  space.generator(u.reshaped(6, k), z.reshaped(6, k), v);
  return v.reshaped();
}

/// Parameters of the mass matrix m.
VectorXd mass_parameters(const MatrixXd& m) {
  const MatrixXd l = m.llt().matrixL();
  std::vector<double> out;
  for (Eigen::Index i = 0; i < m.rows(); ++i)
    for (Eigen::Index j = 0; j <= i; ++j) out.push_back(j < i ? l(i, j) : std::log(l(i, i)));
  return Eigen::Map<const VectorXd>(out.data(), Eigen::Index(out.size()));
}

TEST(LearnedField, OfTheChainIsItsOwn) {
  const VectorXd mass = Eigen::Vector3d(1, 0.5, 2);
  const VectorXd length = Eigen::Vector3d(1, 0.7, 0.4);
  const Chain chain(mass, length, 9.81);
  MatrixXd m(3, 3);
  for (int i = 0; i < 3; ++i)
    for (int j = 0; j < 3; ++j) m(i, j) = chain.carried(std::max(i, j)) * length(i) * length(j);
  const auto model = polynomial_model(3, 1);
  VectorXd theta = VectorXd::Zero(model->size());
  theta.head(6) = mass_parameters(m);
  const PolynomialPotential monomials(3, 1);
  for (int a = 0; a < monomials.size(); ++a)
    for (int i = 0; i < 3; ++i)
      if (monomials.powers(a)[std::size_t(3 * i + 2)] == 1) theta(6 + a) = 9.81 * chain.carried(i) * length(i);
  EXPECT_LT((model->mass(theta) - m).norm(), 1e-14);
  ChainMomentumField<Eigen::Dynamic> field(chain);
  for (unsigned seed = 1; seed <= 20; ++seed) {
    const VectorXd z = random_state(3, seed);
    auto u = chain.space().zero_algebra();
    field(0, z.reshaped(6, 3), u);
    const VectorXd expected = velocity(z, u.reshaped());
    EXPECT_LT((velocity(z, model->field(theta, z)) - expected).norm(), 1e-13 * (1 + expected.norm()));
    IntegratedField integrated(model->equations(theta));
    integrated(0, z.reshaped(6, 3), u);
    EXPECT_EQ(VectorXd(u.reshaped()), model->field(theta, z));
    const auto state = chain.to_velocities(z.reshaped(6, 3));
    EXPECT_EQ(model->equations(theta)->energy(z.reshaped(6, 3)), model->energy(theta, z));
    EXPECT_NEAR(model->energy(theta, z), chain.energy(state), 1e-12);
  }
}

/// An energy for HamiltonianField.
template <class P, int K> struct Energy {
  P potential;
  VectorXd theta;
  template <class S> S energy(const Eigen::Matrix<S, 6, K>& z) const {
    ParametricField<P, K, S> field(potential, K);
    std::vector<S> constants;
    for (const double x : theta) constants.push_back(S(x));
    field.set(constants.data());
    return field.energy(z);
  }
};

template <class P, int K> double distance_to_hamiltons(const P& potential, unsigned seed) {
  ParametricField<P, K> field(potential, K);
  const VectorXd theta = random_vector(field.size(), seed);
  field.set(theta.data());
  HamiltonianField<Energy<P, K>, K> hamiltons(Energy<P, K>{potential, theta});
  double worst = 0;
  for (unsigned n = 0; n < 10; ++n) {
    const VectorXd z = random_state(K, seed + n);
    auto u = field.space().zero_algebra();
    auto w = u;
    field(0, z.reshaped(6, K), u);
    hamiltons(0, z.reshaped(6, K), w);
    worst = std::max(worst, (velocity(z, u.reshaped()) - velocity(z, w.reshaped())).norm());
  }
  return worst;
}

TEST(LearnedField, IsHamiltonsForItsEnergy) {
  EXPECT_LT((distance_to_hamiltons<NetworkPotential, 1>(NetworkPotential(1, {5}), 1)), 1e-12);
  EXPECT_LT((distance_to_hamiltons<NetworkPotential, 2>(NetworkPotential(2, {5, 4}), 2)), 1e-12);
  EXPECT_LT((distance_to_hamiltons<PolynomialPotential, 2>(PolynomialPotential(2, 3), 3)), 1e-12);
}

TEST(Polynomials, HaveEveryMonomialOnce) {
  const PolynomialPotential v(1, 3);
  EXPECT_EQ(v.size(), 19);
  std::vector<std::vector<int>> all;
  for (int a = 0; a < v.size(); ++a) all.push_back(v.powers(a));
  for (std::size_t a = 0; a < all.size(); ++a)
    for (std::size_t b = 0; b < a; ++b) EXPECT_NE(all[a], all[b]);
  const VectorXd theta = random_vector(v.size(), 1);
  const Eigen::Vector3d q = random_vector(3, 2);
  std::vector<double> scratch(std::size_t(v.scratch()));
  Places<double, 1> g;
  double sum = 0;
  for (int a = 0; a < v.size(); ++a)
    sum += theta(a) * std::pow(q(0), all[std::size_t(a)][0]) * std::pow(q(1), all[std::size_t(a)][1]) *
           std::pow(q(2), all[std::size_t(a)][2]);
  EXPECT_NEAR((v.gradient<double, 1>(q, theta.data(), scratch.data(), g)), sum, 1e-15);
  EXPECT_THROW(PolynomialPotential(20, 4), std::invalid_argument);
  EXPECT_THROW(PolynomialPotential(1, 0), std::invalid_argument);
  EXPECT_THROW(NetworkPotential(1, {}), std::invalid_argument);
  EXPECT_THROW(NetworkPotential(1, {8, 0}), std::invalid_argument);
}

/// A user's potential, its energy alone: springs of one stiffness from each mass to a point. With no stiffness the
/// point does not matter, so that training cannot begin at zero.
struct Springs {
  int size() const { return 4; }
  VectorXd start(unsigned seed) const { return VectorXd::Ones(4) + 0.5 * random_vector(4, seed); }
  template <class S, class T, int K> S energy(const Eigen::Matrix<S, 3, K>& q, const T* theta) const {
    S sum(0.0);
    for (int i = 0; i < q.cols(); ++i)
      for (int c = 0; c < 3; ++c) {
        const S stretch = q(c, i) - S(theta[1 + c]);
        sum += S(theta[0]) * stretch * stretch * 0.5;
      }
    return sum;
  }
};

TEST(Derivatives, AreThoseOfThePredictions) {
  std::vector<std::unique_ptr<Model>> models;
  models.push_back(polynomial_model(1, 2));
  models.push_back(network_model(2, {4, 3}));
  models.push_back(polynomial_model(3, 1));
  models.push_back(std::make_unique<ParametricModel<Springs, 2>>("springs", Springs{}));
  for (const auto& model : models) {
    const VectorXd theta = 0.3 * random_vector(model->size(), 3);
    const int k = model->bodies();
    MatrixXd starts(6 * k, 2);
    starts << random_state(k, 4), random_state(k, 5);
    for (const LieGroupMethod& method : lie_group_methods::all) {
      const Schedule schedule{method, 0.1, 3, 2};
      MatrixXd z(18 * k, 2);
      MatrixXd again = z;
      MatrixXd derivative(z.size(), theta.size());
      model->predict(theta, schedule, starts, z);
      model->differentiate(theta, schedule, starts, again, derivative);
      EXPECT_LT((z - again).norm(), 1e-14) << method.name;
      for (Eigen::Index i = 0; i < theta.size(); ++i) {
        constexpr double d = 1e-4;
        MatrixXd ahead = z;
        MatrixXd behind = z;
        MatrixXd far_ahead = z;
        MatrixXd far_behind = z;
        const VectorXd along = VectorXd::Unit(theta.size(), i) * d;
        model->predict(theta + along, schedule, starts, ahead);
        model->predict(theta - along, schedule, starts, behind);
        model->predict(theta + 2 * along, schedule, starts, far_ahead);
        model->predict(theta - 2 * along, schedule, starts, far_behind);
        const MatrixXd difference = (8 * (ahead - behind) - (far_ahead - far_behind)) / (12 * d);
        EXPECT_LT((difference.reshaped() - derivative.col(i)).norm(), 1e-10) << model->name() << method.name << i;
      }
    }
  }
}

TEST(Derivatives, ArePredictedWithManyBodies) {
  // The same model with K known and with K of run time.
  const ParametricModel<NetworkPotential, Eigen::Dynamic> dynamic("dynamic", NetworkPotential(2, {4}), 2);
  const auto fixed = network_model(2, {4});
  const VectorXd theta = fixed->start(3);
  const MatrixXd starts = random_state(2, 4);
  const Schedule schedule{lie_group_methods::munthe_kaas_4, 0.1, 3, 2};
  MatrixXd z(36, 1);
  MatrixXd w(36, 1);
  MatrixXd a(36, theta.size());
  MatrixXd b(36, theta.size());
  fixed->differentiate(theta, schedule, starts, z, a);
  dynamic.differentiate(theta, schedule, starts, w, b);
  EXPECT_LT((z - w).norm(), 1e-14);
  EXPECT_LT((a - b).norm(), 1e-13);
}

TEST(Compressed, KeepsWhatLeastSquaresNeeds) {
  const Eigen::Index n = 7;
  Compressed compressed(n);
  MatrixXd all(0, n + 1);
  for (const Eigen::Index rows : {3, 5, 900, 40}) {
    const MatrixXd block = random_vector(rows * (n + 1), unsigned(rows)).reshaped(rows, n + 1);
    compressed.add(block);
    all.conservativeResize(all.rows() + rows, Eigen::NoChange);
    all.bottomRows(rows) = block;
    const MatrixXd& triangle = compressed.triangle();
    EXPECT_LT((triangle.transpose() * triangle - all.transpose() * all).norm(), 1e-13 * all.squaredNorm());
    EXPECT_NEAR(triangle.col(n).norm(), all.col(n).norm(), 1e-13 * all.norm());
  }
  // A nearly dependent column, which J^T J would lose.
  compressed.clear();
  all.col(1) = all.col(0) + 1e-10 * all.col(2);
  compressed.add(all);
  EXPECT_NEAR(std::abs(compressed.triangle()(1, 1)) / (1e-10 * all.col(2).norm()), 1, 1e-1);
}

TEST(Recovery, ByPolynomialsIsAsGoodAsTheIntegrator) {
  for (int degree : {1, 2}) {
    const auto model = polynomial_model(1, degree);
    const Trained trained = train(*model, training_data(1), {});
    EXPECT_EQ(trained.outcome, Outcome::converged) << trained.message;
    EXPECT_LT(trained.mse, 1e-20);
    EXPECT_LT(test_error(*model, trained, 1), 1e-19);
    EXPECT_NEAR(model->mass(trained.parameters)(0, 0), 1, 1e-9);
  }
  const auto two = polynomial_model(2, 2);
  const Trained trained = train(*two, training_data(2), {});
  EXPECT_EQ(trained.outcome, Outcome::converged) << trained.message;
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
    EXPECT_EQ(trained.outcome, Outcome::converged) << method.name << trained.message;
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
  EXPECT_EQ(stopped.outcome, Outcome::early_stopped) << to_string(stopped.outcome);
  EXPECT_LT(stopped.iterations, heard.iterations);
  double least = std::numeric_limits<double>::infinity();
  for (const Stage& stage : stopped.history) least = std::min(least, stage.validation);
  EXPECT_EQ(stopped.validation, least);
  EXPECT_LT(test_error(*model, stopped, 1), test_error(*model, heard, 1));
}

TEST(Training, EndsAsItSays) {
  const Trajectories data = training_data(1, 50);
  const auto network = network_model(1, {8});
  const Trained few = train(*network, data, {.starts = 1, .iterations = 3});
  EXPECT_EQ(few.outcome, Outcome::iteration_limit);
  EXPECT_NE(few.message.find("allow more"), std::string::npos);
  EXPECT_EQ(few.history.size(), 4U);
  EXPECT_NEAR(few.history.back().mse, few.mse, 1e-12 * few.mse);
  const Trained further = train(*network, data, {.iterations = 5, .begin = few.parameters});
  EXPECT_LT(further.mse, few.mse);
  EXPECT_NEAR(further.history.front().mse, few.mse, 1e-12 * few.mse);
  EXPECT_EQ(train(*network, data, {.iterations = 0, .begin = few.parameters}).parameters, few.parameters);
  EXPECT_THROW(train(*network, data, {.begin = VectorXd::Zero(3)}), std::invalid_argument);
  const Trained enough = train(*network, data, {.starts = 1, .enough = 1e-6});
  EXPECT_EQ(enough.outcome, Outcome::reached);
  EXPECT_LE(enough.mse, 1e-6);
  const Trained late = train(*network, data, {.seconds = 0});
  EXPECT_EQ(late.outcome, Outcome::time_limit);
  int seen = 0;
  const Trained stopped = train(*network, data, {.threads = 1, .callback = [&](const Stage&) { return ++seen < 6; }});
  EXPECT_EQ(stopped.outcome, Outcome::interrupted);
  EXPECT_EQ(seen, 6);
  EXPECT_TRUE(stopped.usable());
  EXPECT_LT(stopped.mse, stopped.history.front().mse);
  // Starts that are tried at the same time end where they would alone.
  const Training tried{.starts = 5, .threads = 1, .trial = 4, .iterations = 3};
  Training together = tried;
  together.threads = 3;
  const Trained one = train(*network, data, tried);
  const Trained three = train(*network, data, together);
  EXPECT_EQ(one.parameters, three.parameters);
  EXPECT_EQ(one.start, three.start);
  ASSERT_EQ(one.history.size(), three.history.size());
  for (std::size_t i = 0; i < one.history.size(); ++i) {
    EXPECT_EQ(one.history[i].start, three.history[i].start);
    EXPECT_EQ(one.history[i].mse, three.history[i].mse);
  }
  const Trained small = train(*network, data.part(0, 2), {});
  EXPECT_EQ(small.outcome, Outcome::too_little_data);
  EXPECT_FALSE(small.usable());
  EXPECT_NE(small.message.find("41 parameters"), std::string::npos) << small.message;
  // Steps so long that nothing is finite.
  Trajectories wild = data;
  wild.interval = 1e200;
  EXPECT_EQ(train(*network, wild, {}).outcome, Outcome::not_finite);
  EXPECT_THROW(train(*network, data, {.substeps = 0}), std::invalid_argument);
  EXPECT_THROW(train(*network, training_data(2, 3), {}), std::invalid_argument);
}

TEST(Training, GivesTheSameBits) {
  const Trajectories data = training_data(1, 50);
  const auto model = network_model(1, {6});
  const Trained a = train(*model, data, {.iterations = 10});
  const Trained b = train(*model, data, {.iterations = 10});
  const Trained other = train(*model, data, {.seed = 9, .iterations = 10});
  EXPECT_EQ(a.parameters, b.parameters);
  EXPECT_NE(a.parameters, other.parameters);
  EXPECT_EQ(training_data(1, 5).ends, training_data(1, 5).ends);
}

TEST(Training, FollowsWeights) {
  // The second half of the data is another chain's; its weights are zero.
  auto rows = draw_trajectories(unit_chain(1), {.count = 40, .seed = 3});
  auto others = draw_trajectories(Chain(VectorXd::Ones(1), VectorXd::Constant(1, 2), 3), {.count = 40, .seed = 4});
  for (Observation row : others) {
    row.trajectory += 40;
    row.row += long(rows.size());
    row.weight = 0;
    rows.push_back(row);
  }
  const auto model = polynomial_model(1, 1);
  const Trained weighted = train(*model, assemble(rows), {});
  EXPECT_LT(weighted.mse, 1e-20);
  for (Observation& row : rows) row.weight = 1;
  EXPECT_GT(train(*model, assemble(rows), {}).mse, 1e-5);
}

TEST(Training, TellsWhatCannotBeDifferentiated) {
  const Trajectories data = training_data(1, 50);
  const auto model = polynomial_model(1, 1);
  // A potential so steep that no prediction is finite.
  VectorXd theta = VectorXd::Zero(4);
  theta << 0, 1e300, 1e300, 1e300;
  const Trained wild = train(*model, data, {.begin = theta});
  EXPECT_EQ(wild.outcome, Outcome::not_finite) << to_string(wild.outcome);
  EXPECT_NE(wild.message.find("go on from"), std::string::npos) << wild.message;
  EXPECT_FALSE(wild.usable());
  EXPECT_THROW(train(*model, data, {.damping_floor = 11}), std::invalid_argument);
  EXPECT_THROW(NetworkPotential(1, std::vector<int>(23, 10000)), std::invalid_argument);
  EXPECT_THROW(NetworkPotential(1, {5000}), std::invalid_argument);
}

/// A potential whose derivative with respect to its parameter is not finite after a while.
struct Brittle {
  int size() const { return 1; }
  template <class S, class T> S energy(const Places<S, 1>& q, const T* theta) const {
    using std::sqrt;
    return q(2) * sqrt(S(theta[0]) * S(theta[0]));
  }
};

TEST(Training, OfARootOfZeroIsNotFinite) {
  const ParametricModel<Brittle, 1> model("brittle", Brittle{});
  const Trained trained = train(model, training_data(1, 20), {.starts = 1});
  EXPECT_EQ(trained.outcome, Outcome::not_finite) << to_string(trained.outcome);
  EXPECT_FALSE(trained.usable());
}

TEST(Training, DoesNotMindTheOrderOfTheData) {
  // Sorted by height, a consecutive part knows one side of the sphere only.
  auto rows = draw_trajectories(unit_chain(1), {.count = 100, .noise = 0.01});
  std::vector<std::size_t> begins;
  for (std::size_t r = 0; r < rows.size(); r += 5) begins.push_back(r);
  std::sort(begins.begin(), begins.end(), [&](auto a, auto b) { return rows[a].z(2) < rows[b].z(2); });
  std::vector<Observation> sorted;
  for (const std::size_t begin : begins)
    for (std::size_t j = 0; j < 5; ++j) sorted.push_back(rows[begin + j]);
  const Trajectories data = assemble(sorted, 0.01);
  const Trajectories part = data.shuffled(1).part(0, 20);
  EXPECT_LT(part.starts.row(2).minCoeff(), -0.5);
  EXPECT_GT(part.starts.row(2).maxCoeff(), 0.5);
  EXPECT_EQ(data.shuffled(1).starts, data.shuffled(1).starts);
  EXPECT_NE(data.shuffled(1).starts, data.shuffled(2).starts);
  const auto model = network_model(1, {4});
  const Trained trained = train(*model, data, {.iterations = 30, .validation = 0.2});
  EXPECT_LT(test_error(*model, trained, 1), 1e-3);
}

TEST(Training, DividesByTheWeightsOfThePart) {
  auto rows = draw_trajectories(unit_chain(1), {.count = 100, .noise = 0.01});
  for (Observation& row : rows) row.weight = row.trajectory % 3 == 0 ? 1e308 : 0;
  const auto model = polynomial_model(1, 1);
  const Trained trained = train(*model, assemble(rows, 0.01), {.validation = 0.3});
  const double variance = 1e-4 / 3;
  EXPECT_NEAR(trained.mse / variance, 1, 0.3);
  EXPECT_NEAR(trained.validation / variance, 1, 0.3);
  // One trajectory of weight is 16 free numbers, whatever stands beside it.
  for (Observation& row : rows) row.weight = row.trajectory == 1 ? 1 : 0;
  const Trained few = train(*polynomial_model(1, 3), assemble(rows, 0.01), {});
  EXPECT_EQ(few.outcome, Outcome::too_little_data);
  EXPECT_NE(few.message.find("are 16 free numbers"), std::string::npos) << few.message;
  const Trained none = train(*model, assemble(rows, 0.01), {.validation = 0.01});
  EXPECT_EQ(none.outcome, Outcome::too_little_data);
  EXPECT_NE(none.message.find("held out are zero"), std::string::npos) << none.message;
}

TEST(Training, IsStoppedWithinAnEvaluation) {
  const Trajectories data = training_data(1, 2000);
  const auto model = network_model(1, {4});
  int asked = 0;
  const Trained early = train(*model, data, {.stop = [&] { return ++asked > 2; }});
  EXPECT_EQ(early.outcome, Outcome::interrupted);
  EXPECT_FALSE(early.usable());
  EXPECT_TRUE(early.history.empty());
  asked = 0;
  const Trained later = train(*model, data, {.starts = 1, .stop = [&] { return ++asked > 300; }});
  EXPECT_EQ(later.outcome, Outcome::interrupted);
  ASSERT_TRUE(later.usable());
  EXPECT_EQ(later.mse, later.history.back().mse);
  EXPECT_EQ(train(*model, data, {.seconds = 0.001}).outcome, Outcome::time_limit);
  EXPECT_FALSE(measure(*model, later.parameters, data, 1e-12, [] { return true; }).complete);
}

TEST(Training, SaysWhatTheDataDoNotDetermine) {
  // At rest below the point of support.
  std::vector<Observation> rows;
  for (long n = 1; n <= 20; ++n)
    for (int j = 0; j < 3; ++j) rows.push_back({long(rows.size()) + 1, n, 0.1 * j, VectorXd{{0, 0, -1, 0, 0, 0}}, 1});
  const auto model = polynomial_model(1, 1);
  const Trained rest = train(*model, assemble(rows), {});
  EXPECT_EQ(rest.outcome, Outcome::converged) << to_string(rest.outcome);
  EXPECT_FALSE(rest.mass_determined);
  const Trained moving = train(*model, training_data(1, 50), {});
  EXPECT_TRUE(moving.mass_determined);
  EXPECT_TRUE(train(*network_model(2, {6}), training_data(2, 100), {.starts = 1, .iterations = 10}).mass_determined);
  // Measured only, as few data as one likes.
  const Trained measured = train(*model, training_data(1, 1).part(0, 1), {.iterations = 0, .begin = moving.parameters});
  EXPECT_EQ(train(*network_model(1, {8}), training_data(1, 1), {.iterations = 0, .begin = VectorXd::Zero(41)}).outcome,
            Outcome::iteration_limit);
  EXPECT_LT(measured.mse, 1e-15);
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

std::string refusal(const std::vector<Observation>& rows, double noise = 0) {
  try {
    assemble(rows, noise);
  } catch (const DataRefused& refused) {
    return refused.what();
  }
  return "taken";
}

TEST(Data, IsRefusedWithTheRowNamed) {
  const auto good = draw_trajectories(unit_chain(2), {.count = 3, .points = 4, .duration = 0.3});
  EXPECT_EQ(refusal(good), "taken");
  using Change = std::function<void(std::vector<Observation>&)>;
  const std::vector<std::pair<Change, std::string>> cases{
      {[](auto& r) { r[5].z(7) = std::nan(""); }, "row 6 (trajectory 2, t = 0.1): q_2 is nan"},
      {[](auto& r) { r[5].z(3) = INFINITY; }, "row 6 (trajectory 2, t = 0.1): p_1 is inf"},
      {[](auto& r) { r[6].z.template segment<3>(6) *= 1.001; }, "row 7 (trajectory 2, t = 0.2): q_2 is off the unit"},
      {[](auto& r) { r[6].z.template segment<3>(9) += 0.001 * r[6].z.template segment<3>(6); }, "row 7"},
      {[](auto& r) { r.erase(r.begin() + 6); }, "this trajectory has 3 points, the first one 4"},
      {[](auto& r) { r.pop_back(); }, "row 11 (trajectory 3"},
      {[](auto& r) { r.resize(1); }, "row 1 (trajectory 1, t = 0): a trajectory of one point"},
      {[](auto& r) { r.clear(); }, "no rows"},
      {[](auto& r) { r[5].time += 0.01; }, "row 6 (trajectory 2, t = 0.11): equal intervals would have t = 0.1"},
      {[](auto& r) { r[5].time = r[4].time; }, "row 6 (trajectory 2, t = 0): the time is not after"},
      {[](auto& r) { r[7].time += 2e-6 * 0.1; }, "row 8 (trajectory 2, t = 0.3): equal intervals"},
      {[](auto& r) { r[5].z(3) = 1e101; }, "row 6 (trajectory 2, t = 0.1): a number above 1e+100"},
      {[](auto& r) { r[9].time = NAN; }, "row 10: the time is not finite"},
      {[](auto& r) { r[3].weight = -1; }, "row 4 (trajectory 1, t = 0.3): weight -1"},
      {[](auto& r) { r[3].z.conservativeResize(6); }, "row 4: 6 numbers, the first row has 12"},
      {[](auto& r) { r[0].z.conservativeResize(7); }, "row 1: 7 numbers are no state"},
      {[](auto& r) { std::swap(r[4], r[11]); }, "keep its rows together"},
      {[](auto& r) {
         for (auto& row : r) row.weight = 0;
       },
       "all weights are zero"},
      {[](auto& r) {
         for (auto& row : r) row.time = 0;
       },
       "row 4"}};
  for (const auto& [change, words] : cases) {
    auto rows = good;
    change(rows);
    EXPECT_NE(refusal(rows).find(words), std::string::npos) << refusal(rows) << "\n" << words;
  }
}

TEST(Data, WithNoiseIsTakenWhereItIsDeclared) {
  const auto noisy = draw_trajectories(unit_chain(2), {.count = 50, .noise = 0.01});
  EXPECT_NE(refusal(noisy).find("or the size of the noise"), std::string::npos);
  EXPECT_EQ(refusal(noisy, 0.01), "taken");
  EXPECT_NE(refusal(noisy, 1e-4), "taken");
  const Trajectories data = assemble(noisy, 0.01);
  for (Eigen::Index n = 0; n < data.count(); ++n) {
    VectorXd z = data.starts.col(n);
    put_on_spheres(z);
    EXPECT_LT((z - data.starts.col(n)).norm(), 1e-15);
  }
}

}  // namespace
