#pragma once
/// Hamiltonians with parameters theta behind one interface for those who train, measure and run them, whatever they
/// are:
///
///     H(q, p; theta) = 1/2 p^T M(q)^{-1} p + V(q; theta)    on (T*S^2)^k,
///     H(q, p; theta)                                        on R^2n, or on T*Q in it,
///
/// with dissipation where a model declares it, p' = ... - P^T R(theta) q'.
///
///     const auto model = learning::polynomial_model(1, 3);  // bodies, degree
///     const Eigen::VectorXd theta = model->start(1);  // seed
///     const double energy = model->energy(theta, Eigen::VectorXd{{0, 0, -1, 0.5, 0, 0}});
///     const auto damped = learning::network_hamiltonian(2, {8}, learning::Dissipation::rayleigh);  // of (q, p) in R^4
///
/// Requires theta of size() numbers and states of `space().size`: on (T*S^2)^k (q_1, p_1, q_2, p_2, ...), elsewhere
/// (q, p). Those that are compiled throw std::invalid_argument for sizes out of range; `follow` returns false where the
/// motion cannot be followed. [H]

#include <lagroid/groupoids/spheres.hpp>
#include <lagroid/solvers/learning/state_space.hpp>
#include <lagroid/solvers/lie_group/method.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <memory>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::learning {

/// Equal steps from t = 0: z is wanted after 1, ..., `intervals` intervals, each made in `substeps` steps.
struct Schedule {
  LieGroupMethod method = lie_group_methods::commutator_free_4;
  double interval = 0;
  int intervals = 1;
  int substeps = 1;
};

/// Whether a model has a term beside Hamilton's equations, -P^T R q' in p', by which its energy falls.
enum class Dissipation {
  none,
  rayleigh,  ///< R constant, symmetric and positive semidefinite, learned with the rest
};

/// Hamilton's equations of a model on spheres with its parameters, to be integrated by any Lie group method.
class ModelField {
 public:
  using Points = CotangentSpheres<Eigen::Dynamic>::Point;

  virtual ~ModelField() = default;
  /// f <- F[H](z).
  virtual void field(const Points& z, Points& f) = 0;
  virtual double energy(const Points& z) = 0;
};

/// The same as a map to the algebra (AlgebraField).
class IntegratedField {
 public:
  explicit IntegratedField(std::unique_ptr<ModelField> equations) : equations_(std::move(equations)) {}
  void operator()(double, const ModelField::Points& z, ModelField::Points& f) { equations_->field(z, f); }

 private:
  std::unique_ptr<ModelField> equations_;
};

/// Exact derivatives of motions of a model on spheres, by the 6 k numbers of a state and by some of its parameters, a
/// column for each.
class ModelDerivatives {
 public:
  using Points = CotangentSpheres<Eigen::Dynamic>::Point;

  virtual ~ModelDerivatives() = default;
  virtual int parameters() const = 0;
  /// end <- where a step of size h from z leads to, by <- its derivatives, a row for each number of it; by
  /// extrapolation of so many rows where there is no method.
  virtual void step(const Points& z, const LieGroupMethod* method, double h, int rows, Points& end,
                    Eigen::MatrixXd& by) = 0;
  /// H, and by <- those of it.
  virtual double energy(const Points& z, Eigen::MatrixXd& by) = 0;
};

/// A Hamiltonian with parameters theta, and where its states are. States on (T*S^2)^k are 6 x k matrices, column i
/// (q_i, p_i), written one after the other in a column of 6k numbers.
class Model {
 public:
  virtual ~Model() = default;
  virtual std::string name() const = 0;
  virtual StateSpace space() const = 0;
  /// k on (T*S^2)^k; zero elsewhere.
  int bodies() const { return space().bodies; }
  virtual Eigen::Index size() const = 0;
  /// Where training may begin: on spheres unit masses up to a factor, and a random potential.
  virtual Eigen::VectorXd start(unsigned seed) const = 0;

  /// m of (mmatrp), whose parameters are the first (ParametricField); of no size where the model has none.
  virtual Eigen::MatrixXd mass(const Eigen::VectorXd&) const { return {}; }
  /// R, k x k on (T*S^2)^k, where it stands for R_ij times the identity, n x n elsewhere; of no size where the model
  /// declares no dissipation. Then energy is conserved, else dH/dt = -q'^T R q'.
  virtual Eigen::MatrixXd dissipation(const Eigen::VectorXd&) const { return {}; }
  /// Whether the model declares dissipation, whatever its parameters.
  bool damped() const { return dissipation(Eigen::VectorXd::Zero(size())).size() > 0; }
  virtual double energy(const Eigen::VectorXd& theta, const Eigen::VectorXd& z) const = 0;
  /// H as a formula of numbers with these names, in the words of scenes; empty where it has none of at most `longest`
  /// characters.
  virtual std::string formula(const Eigen::VectorXd&, std::span<const std::string>, std::size_t /*longest*/) const {
    return {};
  }
  /// The field as an integrator takes it: on (T*S^2)^k F[H], 6k numbers (xi_i, eta_i); elsewhere z' itself.
  virtual Eigen::VectorXd field(const Eigen::VectorXd& theta, const Eigen::VectorXd& z) const = 0;
  /// z', wherever states are.
  virtual Eigen::VectorXd rates(const Eigen::VectorXd& theta, const Eigen::VectorXd& z) const = 0;

  /// For scenes of spheres; null elsewhere.
  virtual std::unique_ptr<ModelField> equations(const Eigen::VectorXd&) const { return nullptr; }
  /// For these too, by the parameters at these places.
  virtual std::unique_ptr<ModelDerivatives> derivatives(const Eigen::VectorXd&, std::vector<Eigen::Index>) const {
    return nullptr;
  }

  /// z <- the wanted states from each column of `starts`, one after the other. On R^2n the methods that stay on spheres
  /// are classical ones: commutator_free_4 is Kutta's, munthe_kaas_54 Dormand and Prince's.
  virtual void predict(const Eigen::VectorXd& theta, const Schedule& schedule,
                       const Eigen::Ref<const Eigen::MatrixXd>& starts, Eigen::Ref<Eigen::MatrixXd> z) const = 0;
  /// The same, and d z / d theta exactly: a row for each number of z, column after column.
  virtual void differentiate(const Eigen::VectorXd& theta, const Schedule& schedule,
                             const Eigen::Ref<const Eigen::MatrixXd>& starts, Eigen::Ref<Eigen::MatrixXd> z,
                             Eigen::Ref<Eigen::MatrixXd> derivative) const = 0;
  /// The states at rising `times` > 0 under control of the error (Munthe-Kaas on Dormand and Prince's pair, on R^2n
  /// that pair itself); false where the motion cannot be followed, in 100 000 steps from one time to the next, and then
  /// nothing is known of z.
  virtual bool follow(const Eigen::VectorXd& theta, const Eigen::VectorXd& start, std::span<const double> times,
                      double tolerance, Eigen::MatrixXd& z) const = 0;
};

/// The models that are compiled. On (T*S^2)^k: V a polynomial of a degree, or a network with hidden layers. Throw
/// std::invalid_argument as PolynomialPotential and NetworkPotential do.
std::unique_ptr<Model> polynomial_model(int bodies, int degree, Dissipation dissipation = Dissipation::none);
std::unique_ptr<Model> network_model(int bodies, std::vector<int> hidden, Dissipation dissipation = Dissipation::none);
/// On R^2n: H itself, of q and p together. Throw std::invalid_argument as Polynomial and Network do.
std::unique_ptr<Model> polynomial_hamiltonian(int coordinates, int degree, Dissipation dissipation = Dissipation::none);
std::unique_ptr<Model> network_hamiltonian(int coordinates, std::vector<int> hidden,
                                           Dissipation dissipation = Dissipation::none);

}  // namespace lagroid::learning
