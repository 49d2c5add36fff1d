// Learned fields, the derivatives of their predictions, and the functions that they are made of.
#include "chains.hpp"

#include <lagroid/solvers/learning/compressed.hpp>
#include <lagroid/solvers/learning/functions/network.hpp>
#include <lagroid/solvers/learning/functions/polynomial.hpp>
#include <lagroid/solvers/learning/parametric_model.hpp>
#include <lagroid/solvers/learning/potentials/network_potential.hpp>
#include <lagroid/solvers/learning/potentials/polynomial_potential.hpp>
#include <lagroid/systems/spheres/linearised_sphere_motion.hpp>
#include <lagroid/systems/spheres/sphere_hamiltonian.hpp>

#include <gtest/gtest.h>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace lagroid::learning_tests::fields_tests {
namespace {

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
  Positions<double, 1> g;
  double sum = 0;
  for (int a = 0; a < v.size(); ++a)
    sum += theta(a) * std::pow(q(0), all[std::size_t(a)][0]) * std::pow(q(1), all[std::size_t(a)][1]) *
           std::pow(q(2), all[std::size_t(a)][2]);
  EXPECT_NEAR(v.gradient(q, theta.data(), scratch.data(), g), sum, 1e-15);
  EXPECT_THROW(PolynomialPotential(20, 4), std::invalid_argument);
  EXPECT_THROW(PolynomialPotential(1, 0), std::invalid_argument);
  EXPECT_THROW(NetworkPotential(1, {}), std::invalid_argument);
  EXPECT_THROW(NetworkPotential(1, {8, 0}), std::invalid_argument);
}

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

TEST(LearnedDerivatives, OfStepsAndEnergiesAreThoseByTheStateToo) {
  std::vector<std::unique_ptr<Model>> models;
  models.push_back(polynomial_model(1, 2));
  models.push_back(network_model(2, {4, 3}, Dissipation::rayleigh));
  models.push_back(polynomial_model(3, 1));
  for (const auto& model : models) {
    const int k = model->bodies();
    const VectorXd theta = 0.3 * random_vector(model->size(), 3);
    const std::vector<Eigen::Index> places{0, model->size() - 1};
    const CotangentSpheres<Eigen::Dynamic>::Point start = random_state(k, 4).reshaped(6, k);
    auto moved = start;
    MatrixXd along = MatrixXd::Zero(6 * k + 2, 4 * k + 2);
    along.topLeftCorner(6 * k, 4 * k) = tangent_directions(start, VectorXd::Zero(4 * k), moved);
    along.bottomRightCorner(2, 2).setIdentity();
    const auto derivatives = model->derivatives(theta, places);
    for (const LieGroupMethod& method : lie_group_methods::all) {
      // Where a step leads to, and the energy at its start.
      const auto at = [&](Eigen::Index column, double by) {
        VectorXd numbers = theta;
        VectorXd coordinates = VectorXd::Zero(4 * k);
        (column < 4 * k ? coordinates(column) : numbers(places[std::size_t(column - 4 * k)])) += by;
        tangent_directions(start, coordinates, moved);
        MatrixXd z(6 * k, 1);
        model->predict(numbers, {method, 0.1}, moved.reshaped(), z);
        VectorXd out(6 * k + 1);
        out << z, model->energy(numbers, moved.reshaped());
        return out;
      };
      MatrixXd step, energy, all(6 * k + 1, 4 * k + 2);
      CotangentSpheres<Eigen::Dynamic>::Point end;
      derivatives->step(start, &method, 0.1, 0, end, step);
      EXPECT_LT((end.reshaped() - at(0, 0).head(6 * k)).norm(), 1e-13) << method.name;
      EXPECT_NEAR(derivatives->energy(start, energy), model->energy(theta, start.reshaped()), 1e-14);
      all << step * along, energy * along;
      for (Eigen::Index column = 0; column < all.cols(); ++column) {
        constexpr double d = 1e-3;
        const VectorXd difference =
            (8 * (at(column, d) - at(column, -d)) - (at(column, 2 * d) - at(column, -2 * d))) / (12 * d);
        EXPECT_LT((all.col(column) - difference).norm(), 1e-9 * (1 + difference.norm()))
            << model->name() << method.name << column;
      }
    }
  }
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

TEST(Formulas, AreTheHamiltonians) {
  const Polynomial polynomial(2, 2);
  const std::vector<std::string> names{"q", "p"};
  const std::string quadratic = "(1)*q + (2)*p + (3)*q*q + (-4.5)*q*p + (5)*p*p";
  const VectorXd coefficients{{1, 2, 3, -4.5, 5}};
  EXPECT_EQ(polynomial.formula(coefficients, names, quadratic.size()), quadratic);
  EXPECT_EQ(polynomial.formula(coefficients, names, quadratic.size() - 1), "");
  const Network network(2, {2});
  const std::string units = "(7)*tanh((1)*q + (2)*p + (3)) + (8)*tanh((4)*q + (5)*p + (6))";
  const VectorXd weights{{1, 2, 3, 4, 5, 6, 7, 8}};
  EXPECT_EQ(network.formula(weights, names, units.size()), units);
  EXPECT_EQ(network.formula(weights, names, units.size() - 1), "");
  // Written out it would have more characters than any memory.
  const Network deep(2, std::vector<int>(20, 10));
  EXPECT_EQ(deep.formula(deep.start(1), names, 4096), "");
}

TEST(Starts, OfAPolynomialDifferBySeed) {
  const auto model = polynomial_hamiltonian(2, 3);
  EXPECT_EQ(model->start(0), VectorXd::Zero(model->size()));
  EXPECT_NE(model->start(1), model->start(2));
  EXPECT_EQ(model->start(1), model->start(1));
  const Polynomial h(4, 3);
  for (int a = 0; a < h.size(); ++a) {
    int degree = 0;
    for (const int power : h.powers(a)) degree += power;
    EXPECT_EQ(model->start(1)(a) != 0, degree == 2) << a;
  }
}

}  // namespace
}  // namespace lagroid::learning_tests::fields_tests
