#pragma once
/// Hamiltonians with parameters theta on (T*S^2)^k,
///
///     H(q, p; theta) = 1/2 p^T M(q)^{-1} p + V(q; theta),
///
/// behind one interface for those who train, measure and run them, whatever the potential is.
///
///     const auto model = learning::polynomial_model(1, 3);  // bodies, degree
///     const Eigen::VectorXd theta = model->start(1);  // seed
///     const double energy = model->energy(theta, Eigen::VectorXd{{0, 0, -1, 0.5, 0, 0}});
///
/// Requires theta of size() numbers and states of 6k numbers, (q_1, p_1, q_2, p_2, ...). polynomial_model and
/// network_model throw std::invalid_argument for sizes out of range; `follow` returns false where the motion cannot be
/// followed. [H]

#include <lagroid/groupoids/spheres.hpp>
#include <lagroid/solvers/lie_group/method.hpp>

#include <Eigen/Core>

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

/// Hamilton's equations of a model with its parameters, to be integrated by any Lie group method.
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

/// H = 1/2 p^T M(q)^{-1} p + V(q) with parameters theta, the mass matrix's first (ParametricField). States are 6 x k
/// matrices, column i (q_i, p_i), written one after the other in a column of 6k numbers.
class Model {
 public:
  virtual ~Model() = default;
  virtual std::string name() const = 0;
  virtual int bodies() const = 0;
  virtual Eigen::Index size() const = 0;
  /// Where training may begin: unit masses up to a factor, and a random potential.
  virtual Eigen::VectorXd start(unsigned seed) const = 0;

  /// m.
  virtual Eigen::MatrixXd mass(const Eigen::VectorXd& theta) const = 0;
  virtual double energy(const Eigen::VectorXd& theta, const Eigen::VectorXd& z) const = 0;
  /// F[H], 6k numbers (xi_i, eta_i).
  virtual Eigen::VectorXd field(const Eigen::VectorXd& theta, const Eigen::VectorXd& z) const = 0;

  virtual std::unique_ptr<ModelField> equations(const Eigen::VectorXd& theta) const = 0;

  /// z <- the wanted states from each column of `starts`, 6k * intervals numbers a column.
  virtual void predict(const Eigen::VectorXd& theta, const Schedule& schedule,
                       const Eigen::Ref<const Eigen::MatrixXd>& starts, Eigen::Ref<Eigen::MatrixXd> z) const = 0;
  /// The same, and d z / d theta exactly: a row for each number of z, column after column.
  virtual void differentiate(const Eigen::VectorXd& theta, const Schedule& schedule,
                             const Eigen::Ref<const Eigen::MatrixXd>& starts, Eigen::Ref<Eigen::MatrixXd> z,
                             Eigen::Ref<Eigen::MatrixXd> derivative) const = 0;
  /// The states at rising `times` > 0 under control of the error (Munthe-Kaas on Dormand and Prince's pair); false
  /// where the motion cannot be followed, in 100 000 steps from one time to the next, and then nothing is known of z.
  virtual bool follow(const Eigen::VectorXd& theta, const Eigen::VectorXd& start, std::span<const double> times,
                      double tolerance, Eigen::MatrixXd& z) const = 0;
};

/// The models that are compiled: V a polynomial of a degree, or a network with hidden layers. Throw
/// std::invalid_argument as PolynomialPotential and NetworkPotential do.
std::unique_ptr<Model> polynomial_model(int bodies, int degree);
std::unique_ptr<Model> network_model(int bodies, std::vector<int> hidden);

}  // namespace lagroid::learning
