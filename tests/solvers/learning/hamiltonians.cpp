// Hamiltonians of q and p together, on R^2n and on T*Q, and dissipation: laws, recovery, and subjects that break laws.
#include "chains.hpp"

#include <lagroid/core/hamiltonian/projected_hamiltonian.hpp>
#include <lagroid/solvers/learning/functions/network.hpp>
#include <lagroid/solvers/learning/functions/polynomial.hpp>
#include <lagroid/solvers/learning/hamiltonians/hamiltonian_model.hpp>
#include <lagroid/solvers/learning/parametric_model.hpp>
#include <lagroid/solvers/learning/potentials/polynomial_potential.hpp>
#include <lagroid/solvers/learning/testing/model_laws.hpp>

#include <gtest/gtest.h>

#include <cmath>
#include <memory>
#include <string>
#include <vector>

namespace lagroid::learning_tests::hamiltonians_tests {
namespace {

/// A particle on an ellipsoid of revolution.
struct OnEllipsoid {
  template <class S> static Vector<S, 1> constraint(const Vector<S, 3>& q) {
    return Vector<S, 1>(q(0) * q(0) + q(1) * q(1) + q(2) * q(2) * 0.25 - 1.0);
  }
};
/// A bead on a wire in space, where a cylinder meets a wave.
struct OnWire {
  template <class S> static Vector<S, 2> constraint(const Vector<S, 3>& q) {
    using std::sin;
    return Vector<S, 2>(q(0) * q(0) + q(1) * q(1) - 1.0, q(2) - sin(q(0) * 2.0) * 0.5);
  }
};

/// H = theta_0 p^2 / 2 (1 + theta_1 q_3^2) + theta_2 q_3 + theta_3 (q_1 p_2 - q_2 p_1): not separable, symmetric about
/// the third axis.
struct Turning {
  int size() const { return 4; }
  VectorXd start(unsigned seed) const { return VectorXd{{1, 0, 0, 0}} + 0.1 * random_vector(4, seed); }
  template <class S, class T> S hamiltonian(const Vector<S, 3>& q, const Vector<S, 3>& p, const T* theta) const {
    return (p(0) * p(0) + p(1) * p(1) + p(2) * p(2)) * (q(2) * q(2) * S(theta[1]) + 1.0) * S(theta[0]) * 0.5 +
           q(2) * S(theta[2]) + (q(0) * p(1) - q(1) * p(0)) * S(theta[3]);
  }
};
struct TurningOnEllipsoid : Turning, OnEllipsoid {};
struct TurningOnWire : Turning, OnWire {};

/// The same for ProjectedHamiltonian, whose W is that of (wmatr).
template <class C, int M> struct Projected : ProjectedHamiltonian<Projected<C, M>, 3, M> {
  VectorXd theta;
  template <class S> Vector<S, M> constraint(const Vector<S, 3>& q) const { return C::constraint(q); }
  template <class S> S hamiltonian(const Vector<S, 3>& q, const Vector<S, 3>& p) const {
    return Turning().hamiltonian(q, p, theta.data());
  }
};

template <class H, class C, int M> double distance_to_projected(unsigned seed) {
  const HamiltonianModel<H, 3> model("turning", H{});
  Projected<C, M> known;
  known.theta = random_vector(4, seed);
  VectorXd z = random_vector(6, seed + 100);
  z(0) += 2;
  model.space().project(z);
  EXPECT_LT(C::constraint(Vector<double, 3>(z.head(3))).norm(), 1e-14);
  EXPECT_LT((known.constraint_jacobian(z.head<3>()) * z.tail<3>()).norm(), 1e-14);
  const auto rates = known.rates(z.head<3>(), z.tail<3>());
  VectorXd expected(6);
  expected << rates.q, rates.p;
  return (model.rates(known.theta, z) - expected).norm() / (1 + expected.norm());
}

TEST(HamiltonianEquations, AreThoseOfAnyProjectedHamiltonian) {
  for (unsigned seed = 1; seed <= 20; ++seed) {
    EXPECT_LT((distance_to_projected<TurningOnEllipsoid, OnEllipsoid, 1>(seed)), 1e-13) << seed;
    EXPECT_LT((distance_to_projected<TurningOnWire, OnWire, 2>(seed)), 1e-13) << seed;
  }
}

/// Any H of (q, p) on T*S^2.
struct PolynomialOnSphere : Polynomial {
  using Polynomial::Polynomial;
  template <class S> static Vector<S, 1> constraint(const Vector<S, 3>& q) {
    return Vector<S, 1>(q(0) * q(0) + q(1) * q(1) + q(2) * q(2) - 1.0);
  }
};

TEST(HamiltonianEquations, OnASphereAreThoseOfTheModelThere) {
  const auto known = polynomial_model(1, 1, Dissipation::rayleigh);
  const HamiltonianModel<PolynomialOnSphere, 3> model("polynomial", PolynomialOnSphere(6, 2), 3, Dissipation::rayleigh);
  const VectorXd theta{{0.2, 0.5, -0.3, 0.9, 0.4}};  // log of the root of the mass, V, root of R
  VectorXd same = VectorXd::Zero(model.size());
  const PolynomialPotential v(1, 1);
  for (int a = 0; a < model.hamiltonian().size(); ++a) {
    const auto powers = model.hamiltonian().powers(a);
    for (std::size_t i = 0; i < 3; ++i) {
      if (powers[3 + i] == 2) same(a) = 0.5 * std::exp(-0.4);
      for (int b = 0; b < v.size(); ++b)
        if (v.powers(b)[i] == 1 && powers[i] == 1 && a < 6) same(a) = theta(1 + b);
    }
  }
  same.tail(6) << 0.4, 0, 0.4, 0, 0, 0.4;
  for (unsigned seed = 1; seed <= 10; ++seed) {
    VectorXd z = random_vector(6, seed);
    put_on_spheres(z);
    EXPECT_LT((model.rates(same, z) - known->rates(theta, z)).norm(), 1e-14);
    EXPECT_NEAR(model.energy(same, z), known->energy(theta, z), 1e-14);
    EXPECT_NEAR(dissipated_power(model, same, z), dissipated_power(*known, theta, z), 1e-14);
  }
}

/// Ready-made functions of (q, p) with a constraint of the user's.
struct PolynomialOnEllipsoid : Polynomial, OnEllipsoid {
  using Polynomial::Polynomial;
};
struct NetworkOnWire : Network, OnWire {
  using Network::Network;
};

laws::LawReport laws_of(const Model& model) {
  return laws::model_laws(
      model,
      [&] {
        VectorXd theta(model.size());
        for (double& x : theta) x = 0.5 * laws::draw_uniform();
        return theta;
      },
      [&] {
        VectorXd z(model.space().size);
        for (double& x : z) x = laws::draw_uniform();
        if (model.bodies() == 0 && model.space().project) z(0) += 2;  // away from where constraints have no rank
        return z;
      });
}

TEST(Models, HoldTheirLaws) {
  const auto damped = Dissipation::rayleigh;
  std::vector<std::unique_ptr<Model>> models;
  for (const Dissipation dissipation : {Dissipation::none, damped}) {
    models.push_back(polynomial_hamiltonian(1, 4, dissipation));
    models.push_back(network_hamiltonian(2, {4, 3}, dissipation));
    models.push_back(polynomial_hamiltonian(3, 2, dissipation));
    models.push_back(polynomial_model(1, 2, dissipation));
    models.push_back(network_model(2, {4}, dissipation));
    models.push_back(polynomial_model(3, 1, dissipation));
    models.push_back(
        std::make_unique<HamiltonianModel<TurningOnEllipsoid, 3>>("turning", TurningOnEllipsoid{}, 3, dissipation));
    models.push_back(std::make_unique<HamiltonianModel<TurningOnWire, 3>>("bead", TurningOnWire{}, 3, dissipation));
    models.push_back(std::make_unique<HamiltonianModel<PolynomialOnEllipsoid, 3>>(
        "polynomial", PolynomialOnEllipsoid(6, 2), 3, dissipation));
    models.push_back(
        std::make_unique<HamiltonianModel<NetworkOnWire, 3>>("network", NetworkOnWire(6, {4}), 3, dissipation));
  }
  for (const auto& model : models) {
    const auto report = laws_of(*model);
    EXPECT_TRUE(report.holds()) << report;
  }
}

using Quartic = HamiltonianModel<Polynomial, 1>;

/// Damped, and silent about it.
class Silent final : public Quartic {
 public:
  Silent() : Quartic("silent", Polynomial(2, 4), 1, Dissipation::rayleigh) {}
  MatrixXd dissipation(const VectorXd&) const override { return {}; }
};
/// A damping that gives energy.
class Driven final : public Quartic {
 public:
  Driven() : Quartic("driven", Polynomial(2, 4), 1, Dissipation::rayleigh) {}
  MatrixXd dissipation(const VectorXd& theta) const override { return -Quartic::dissipation(theta); }
};
/// A gradient by hand with a slip in it.
struct Slip : Polynomial {
  using Polynomial::Polynomial;
  template <class X>
  typename X::Scalar gradient(const X& x, const typename X::Scalar* theta, typename X::Scalar* scratch, X& g) const {
    const auto value = Polynomial::gradient(x, theta, scratch, g);
    g(1) += 0.01 * x(0);
    return value;
  }
};
/// Said to be on another ellipsoid than the one that it moves on.
class Astray final : public HamiltonianModel<TurningOnEllipsoid, 3> {
 public:
  Astray() : HamiltonianModel("astray", {}) {}
  StateSpace space() const override {
    StateSpace out = phase_space(3);
    out.project = [](Eigen::Ref<VectorXd> z) { z.head<3>().normalize(); };
    return out;
  }
};
/// One derivative is a thousandth too large.
class Inexact final : public Quartic {
 public:
  Inexact() : Quartic("inexact", Polynomial(2, 4)) {}
  void differentiate(const VectorXd& theta, const Schedule& schedule, const Eigen::Ref<const MatrixXd>& starts,
                     Eigen::Ref<MatrixXd> z, Eigen::Ref<MatrixXd> derivative) const override {
    Quartic::differentiate(theta, schedule, starts, z, derivative);
    derivative.col(2) *= 1.001;
  }
};

TEST(BrokenModels, AreFoundOut) {
  const auto broken = [](const Model& model, const char* law) {
    const auto report = laws_of(model);
    EXPECT_FALSE(report.law(law).holds()) << report;
  };
  broken(Silent(), "dH/dt = -q'^T R q'");
  broken(Driven(), "dH/dt = -q'^T R q'");
  broken(Driven(), "R is symmetric and positive semidefinite");
  broken(HamiltonianModel<Slip, 1>("slip", Slip(2, 4)), "dH/dt = -q'^T R q'");
  broken(Astray(), "motions stay where states are");
  broken(Inexact(), "derivatives are those of the predictions");
}

/// Trajectories of the model from these starts, to a tolerance of 1e-13.
Trajectories motions(const Model& model, const VectorXd& theta, const MatrixXd& starts, int points, double interval) {
  std::vector<double> times;
  for (int j = 1; j < points; ++j) times.push_back(j * interval);
  std::vector<Observation> rows;
  MatrixXd z;
  for (Eigen::Index n = 0; n < starts.cols(); ++n) {
    const VectorXd start = starts.col(n);
    EXPECT_TRUE(model.follow(theta, start, times, 1e-13, z));
    rows.push_back({long(rows.size()), long(n), 0, start});
    for (int j = 1; j < points; ++j)
      rows.push_back({long(rows.size()), long(n), times[std::size_t(j) - 1], z.col(j - 1)});
  }
  return assemble(rows, model.space());
}
MatrixXd random_starts(const Model& model, int count, unsigned seed) {
  MatrixXd out = random_vector(model.space().size * count, seed).reshaped(model.space().size, count);
  for (int n = 0; n < count; ++n)
    if (const StateSpace space = model.space(); space.project) space.project(out.col(n));
  return out;
}

/// H = (p^2 + 1) (q^2 + 1) / 2 as a polynomial.
VectorXd product(const Polynomial& h) {
  VectorXd theta = VectorXd::Zero(h.size());
  for (int a = 0; a < h.size(); ++a) {
    const auto powers = h.powers(a);
    const bool even = powers[0] % 2 == 0 && powers[1] % 2 == 0;
    if (even && powers[0] <= 2 && powers[1] <= 2) theta(a) = 0.5;
  }
  return theta;
}

TEST(Recovery, OfAHamiltonianThatIsNotSeparable) {
  const VectorXd truth = product(Polynomial(2, 4));
  const auto model = polynomial_hamiltonian(1, 4);
  const Trajectories data = motions(*model, truth, random_starts(*model, 60, 1), 5, 0.05);
  const Trajectories unseen = motions(*model, truth, random_starts(*model, 20, 2), 11, 0.1);
  const Trained coarse = train(*model, data, {.starts = 1});
  const Trained fine = train(*model, data, {.substeps = 8, .starts = 1});
  for (const Trained* trained : {&coarse, &fine}) {
    EXPECT_EQ(trained->outcome, TrainingStatus::converged) << trained->message;
    EXPECT_TRUE(trained->mass_determined);
  }
  // What is left is the integrator's: a quarter of the step is a 256th of the error, squared.
  EXPECT_LT((coarse.parameters - truth).norm(), 1e-6);
  EXPECT_LT((fine.parameters - truth).norm(), 1e-8);
  EXPECT_LT(fine.mse, 1e-3 * coarse.mse);
  const Measures found = measure(*model, fine.parameters, unseen);
  EXPECT_LT(found.mse, 1e-18);
  EXPECT_LT(found.energy_largest, 1e-8);
  EXPECT_TRUE(std::isnan(found.momentum_learned));
  EXPECT_EQ(found.lost, 0);
}

TEST(Networks, LearnAHamiltonianThatIsNotSeparable) {
  const VectorXd truth = product(Polynomial(2, 4));
  const auto known = polynomial_hamiltonian(1, 4);
  const Trajectories data = motions(*known, truth, random_starts(*known, 60, 1), 5, 0.05);
  const auto model = network_hamiltonian(1, {12});
  const Trained trained = train(*model, data, {});
  EXPECT_LT(trained.mse, 1e-7) << trained.message;
  const Trajectories unseen = motions(*known, truth, 0.8 * random_starts(*known, 20, 2), 6, 0.1);
  EXPECT_LT(measure(*model, trained.parameters, unseen).mse, 1e-5);
}

/// H = theta_0 p^2 / 2 - theta_1 cos q.
struct PlanePendulum {
  int size() const { return 2; }
  VectorXd start(unsigned) const { return VectorXd{{0.5, 0.5}}; }
  template <class S, class T> S hamiltonian(const Vector<S, 1>& q, const Vector<S, 1>& p, const T* theta) const {
    using std::cos;
    return p(0) * p(0) * S(theta[0]) * 0.5 - cos(q(0)) * S(theta[1]);
  }
};

TEST(Recovery, OfADampedPendulum) {
  const HamiltonianModel<PlanePendulum, 1> model("pendulum", PlanePendulum{}, 1, Dissipation::rayleigh);
  const VectorXd truth{{0.8, 1.7, std::sqrt(0.3)}};
  const Trajectories data = motions(model, truth, 2 * random_starts(model, 30, 1), 5, 0.05);
  const Trained trained = train(model, data, {.substeps = 8, .starts = 1});
  EXPECT_EQ(trained.outcome, TrainingStatus::converged) << trained.message;
  EXPECT_NEAR(model.dissipation(trained.parameters)(0, 0), 0.3, 1e-9);
  EXPECT_LT((trained.parameters - truth).head(2).norm(), 1e-9);
  // No conservative Hamiltonian moves like that.
  const HamiltonianModel<PlanePendulum, 1> conservative("pendulum", PlanePendulum{});
  EXPECT_EQ(conservative.dissipation(truth.head(2)).size(), 0);
  EXPECT_GT(train(conservative, data, {.substeps = 8, .starts = 1}).mse, 1e-4);
  // And where nothing is damped, R is found to be none.
  const Trajectories undamped = motions(model, VectorXd{{0.8, 1.7, 0}}, 2 * random_starts(model, 30, 1), 5, 0.05);
  const Trained none = train(model, undamped, {.substeps = 8, .starts = 1});
  EXPECT_LT(model.dissipation(none.parameters)(0, 0), 1e-9);
  EXPECT_TRUE(none.dissipation_determined);
}

TEST(Recovery, OfADampedChain) {
  const auto model = polynomial_model(2, 1, Dissipation::rayleigh);
  VectorXd truth = model->start(5);
  truth.tail(3) << 0.5, 0.2, 0.4;
  const Trajectories data = motions(*model, truth, random_starts(*model, 60, 1), 5, 0.025);
  const Trained trained = train(*model, data, {.substeps = 4});
  MatrixXd r(2, 2);
  r << 0.25, 0.1, 0.1, 0.2;
  EXPECT_LT((model->dissipation(trained.parameters) - r).norm(), 1e-9);
  EXPECT_LT((model->mass(trained.parameters) - model->mass(truth)).norm(), 1e-9);
  EXPECT_TRUE(trained.mass_determined);
  EXPECT_TRUE(trained.dissipation_determined);
}

TEST(Recovery, OnAnEllipsoidWithDamping) {
  const HamiltonianModel<TurningOnEllipsoid, 3> model("turning", {}, 3, Dissipation::rayleigh);
  VectorXd truth(10);
  truth << 1.2, 0.4, 0.9, -0.3, 0.3, 0, 0.3, 0, 0, 0.5;
  const Trajectories data = motions(model, truth, random_starts(model, 40, 1), 5, 0.05);
  EXPECT_EQ(data.free_numbers(), 40 * 4 * 4);
  const Trained trained = train(model, data, {.substeps = 8, .starts = 2});
  EXPECT_LT((trained.parameters - truth).head(4).norm(), 1e-7) << trained.message;
  EXPECT_LT((model.dissipation(trained.parameters) - model.dissipation(truth)).norm(), 1e-6);
}

TEST(Recovery, SaysWhereTheDataDoNotDetermineFriction) {
  // Of an H that can be anything along a curve, one curve that does not cross itself fits any R.
  const auto model = polynomial_hamiltonian(1, 6, Dissipation::rayleigh);
  VectorXd truth = VectorXd::Zero(model->size());
  truth(2) = truth(4) = 0.5;  // q^2 and p^2
  truth(truth.size() - 1) = 0.5;
  const Trajectories curve = motions(*model, truth, VectorXd{{1, 0}}, 41, 0.05);
  const Trajectories pieces = motions(*model, truth, curve.ends.reshaped(2, 40), 3, 0.05);
  const Trained one = train(*model, pieces, {.starts = 1});
  EXPECT_LT(one.mse, 1e-8) << one.message;
  EXPECT_FALSE(one.dissipation_determined);
  const Trained many = train(*model, motions(*model, truth, random_starts(*model, 30, 1), 5, 0.05), {.starts = 1});
  EXPECT_TRUE(many.dissipation_determined) << many.message;
  EXPECT_NEAR(model->dissipation(many.parameters)(0, 0), 0.25, 1e-6);
  // A model that declares none has nothing to say.
  const auto conservative = polynomial_hamiltonian(1, 2);
  EXPECT_TRUE(
      train(*conservative, motions(*conservative, VectorXd::Zero(5), MatrixXd::Ones(2, 5), 3, 0.1), {.starts = 1})
          .dissipation_determined);
}

TEST(LearnedMotions, LoseWhatDissipationTakesAndKeepTheRest) {
  // The momentum about the third axis is the symmetry's; R that is no multiple of the identity takes it away.
  const VectorXd theta{{1.2, 0.4, 0.9, -0.3}};
  VectorXd damped_theta(10);
  damped_theta << theta, 0.3, 0.1, 0.5, 0, 0.2, 0.4;
  const HamiltonianModel<TurningOnEllipsoid, 3> free("turning", {});
  const HamiltonianModel<TurningOnEllipsoid, 3> damped("turning", {}, 3, Dissipation::rayleigh);
  const VectorXd start = random_starts(free, 1, 3).col(0);
  constexpr int nodes = 200;
  std::vector<double> times;
  for (int j = 1; j <= nodes; ++j) times.push_back(0.01 * j);
  const auto momentum = [](const VectorXd& z) { return z(0) * z(4) - z(1) * z(3); };
  MatrixXd z;
  ASSERT_TRUE(free.follow(theta, start, times, 1e-12, z));
  for (const auto& each : z.colwise()) {
    EXPECT_NEAR(free.energy(theta, each), free.energy(theta, start), 1e-9);
    EXPECT_NEAR(momentum(each), momentum(start), 1e-9);
    EXPECT_LT(OnEllipsoid::constraint(Vector<double, 3>(each.head(3))).norm(), 1e-14);
  }
  ASSERT_TRUE(damped.follow(damped_theta, start, times, 1e-12, z));
  // Simpson's rule on q'^T R q'.
  double taken = dissipated_power(damped, damped_theta, start);
  for (int j = 1; j <= nodes; ++j)
    taken += (j == nodes ? 1 : j % 2 == 1 ? 4 : 2) * dissipated_power(damped, damped_theta, z.col(j - 1));
  taken *= 0.01 / 3;
  EXPECT_GT(taken, 0.1);
  EXPECT_NEAR(damped.energy(damped_theta, z.col(nodes - 1)), damped.energy(damped_theta, start) - taken, 1e-8);
  EXPECT_GT(std::abs(momentum(z.col(nodes - 1)) - momentum(start)), 0.01);
}

TEST(LearnedMotions, OnConstraintsKeepTheOrderOfTheMethod) {
  // Brought back after every step, through a method of order four.
  const HamiltonianModel<TurningOnWire, 3> bead("bead", {});
  const VectorXd theta{{1.2, 0.4, 0.9, -0.3}};
  const VectorXd start = random_starts(bead, 1, 3).col(0);
  MatrixXd exact;
  ASSERT_TRUE(bead.follow(theta, start, std::vector{1.0}, 1e-13, exact));
  std::vector<double> errors;
  for (const int substeps : {10, 20, 40}) {
    MatrixXd z(6, 1);
    bead.predict(theta, {lie_group_methods::runge_kutta_4, 1.0, 1, substeps}, start, z);
    EXPECT_LT(OnWire::constraint(Vector<double, 3>(z.col(0).head(3))).norm(), 1e-14);
    errors.push_back((z - exact).norm());
  }
  EXPECT_NEAR(std::log2(errors[1] / errors[2]), 4, 0.5) << errors[0] << ' ' << errors[1] << ' ' << errors[2];
}

TEST(LearnedMotions, InRnAreThoseOfRungeAndKutta) {
  const auto model = polynomial_hamiltonian(1, 4);
  const VectorXd theta = 0.3 * random_vector(model->size(), 3);
  const VectorXd start = random_vector(2, 4);
  const auto by = [&](const LieGroupMethod& method) {
    MatrixXd z(2, 1);
    model->predict(theta, {method, 0.3, 1, 1}, start, z);
    return VectorXd(z);
  };
  EXPECT_LT((by(lie_group_methods::commutator_free_4) - by(lie_group_methods::runge_kutta_4)).norm(), 1e-15);
  EXPECT_LT((by(lie_group_methods::munthe_kaas_4) - by(lie_group_methods::runge_kutta_4)).norm(), 1e-15);
  // By hand.
  const auto f = [&](const VectorXd& z) { return model->rates(theta, z); };
  const VectorXd k1 = f(start);
  const VectorXd k2 = f(start + 0.15 * k1);
  const VectorXd k3 = f(start + 0.15 * k2);
  const VectorXd k4 = f(start + 0.3 * k3);
  EXPECT_LT((by(lie_group_methods::runge_kutta_4) - start - 0.05 * (k1 + 2 * k2 + 2 * k3 + k4)).norm(), 1e-15);
}

// What would be ignored is refused.
struct NotConst : Turning {
  template <class S> Vector<S, 1> constraint(const Vector<S, 3>& q) { return Vector<S, 1>(q(0)); }
};
struct OfTheWrongSize : Turning {
  template <class S> Vector<S, 1> constraint(const Vector<S, 2>& q) const { return Vector<S, 1>(q(0)); }
};
struct OfRunTimeSize : Turning {
  template <class S> Vector<S, Eigen::Dynamic> constraint(const Vector<S, 3>& q) const { return q.head(1); }
};
struct OfANumber : Turning {
  template <class S> S constraint(const Vector<S, 3>& q) const { return q(0); }
};
struct WithTwoHamiltonians : Polynomial {
  using Polynomial::Polynomial;
  template <class S, class T> S hamiltonian(const Vector<S, 3>& q, const Vector<S, 3>&, const T*) const { return q(0); }
};
static_assert(ParametricHamiltonian<Turning, 3> && ParametricHamiltonian<TurningOnWire, 3> &&
              ParametricHamiltonian<NetworkOnWire, 3> && ParametricHamiltonian<Polynomial, Eigen::Dynamic>);
static_assert(!ParametricHamiltonian<Turning, 2> && !ParametricHamiltonian<OnWire, 3>);
static_assert(!ParametricHamiltonian<NotConst, 3> && !ParametricHamiltonian<OfTheWrongSize, 3> &&
              !ParametricHamiltonian<OfRunTimeSize, 3> && !ParametricHamiltonian<OfANumber, 3>);
static_assert(!ParametricHamiltonian<WithTwoHamiltonians, 3>);

std::string refused(const std::vector<Observation>& rows, const StateSpace& space) {
  try {
    assemble(rows, space);
  } catch (const DataRefused& refusal) {
    return refusal.what();
  }
  return "taken";
}

TEST(Data, OnAnySpaceIsRefusedWithTheRowNamed) {
  const HamiltonianModel<TurningOnEllipsoid, 3> model("turning", {});
  std::vector<Observation> rows;
  for (int j = 0; j < 3; ++j) rows.push_back({j + 1, 1, 0.1 * j, random_starts(model, 1, 5).col(0)});
  EXPECT_EQ(refused(rows, model.space()), "taken");
  EXPECT_EQ(refused(rows, phase_space(3)), "taken");
  EXPECT_EQ(refused(rows, phase_space(2)), "row 1: 6 numbers, a state of the space has 4; give it as many");
  auto off = rows;
  off[1].z(0) += 0.01;
  EXPECT_NE(refused(off, model.space()).find("row 2 (trajectory 1, t = 0.1): the state is off the constraints"),
            std::string::npos);
  EXPECT_EQ(refused(off, phase_space(3)), "taken");
  // Momenta that are large make no room for q, and where G is zero there is no way back.
  for (auto& row : off) row.z.tail(3) *= 1e6;
  EXPECT_NE(refused(off, model.space()).find("row 2 (trajectory 1, t = 0.1): the state is off the constraints"),
            std::string::npos);
  off = rows;
  off[1].z.tail(3) += 0.01 * off[1].z.head(3);
  EXPECT_NE(refused(off, model.space()).find("row 2 (trajectory 1, t = 0.1): the momentum is off the tangent space"),
            std::string::npos);
  off[1].z.head(3).setZero();
  EXPECT_NE(refused(off, model.space()).find("row 2 (trajectory 1, t = 0.1): the constraint has no full rank there"),
            std::string::npos);
  off = rows;
  off[2].z(4) = std::nan("");
  EXPECT_NE(refused(off, model.space()).find("row 3 (trajectory 1, t = 0.2): p_2 is nan"), std::string::npos);
  // Of other data than its own a model learns nothing.
  EXPECT_THROW(train(model, assemble(rows, phase_space(3)), {}), std::invalid_argument);
  EXPECT_THROW(train(*polynomial_hamiltonian(2, 2), assemble(rows, phase_space(3)), {}), std::invalid_argument);
  EXPECT_THROW((HamiltonianModel<Polynomial, 1>("of four numbers", {4, 2})), std::invalid_argument);
  EXPECT_THROW((HamiltonianModel<Polynomial, Eigen::Dynamic>("of no size", {4, 2})), std::invalid_argument);
  EXPECT_THROW((HamiltonianModel<PlanePendulum, 1>("of two", {}, 2)), std::invalid_argument);
  EXPECT_EQ(to_string(model.space()), "T*Q in R^6");
  EXPECT_EQ(to_string(phase_space(3)), "R^6");
  EXPECT_EQ(to_string(cotangent_spheres(2)), "(T*S^2)^2");
}

}  // namespace
}  // namespace lagroid::learning_tests::hamiltonians_tests
