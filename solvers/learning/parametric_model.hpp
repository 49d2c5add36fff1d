#pragma once
/// The model of any potential: a class that writes V(q; theta) becomes a Model, with trajectories and their exact
/// derivatives in theta.
///
///     struct Weight {
///       int size() const { return 1; }
///       template <class S, class T> S energy(const learning::Positions<S, 1>& q, const T* theta) const {
///         return S(theta[0]) * q(2);
///       }
///     };
///     inline const learning::ParametricModel<Weight, 1> model("weight", Weight{});
///
/// Requires a Potential (potentials/potential.hpp).

#include <lagroid/solvers/learning/field_model.hpp>
#include <lagroid/solvers/learning/parametric_field.hpp>

#include <memory>
#include <random>
#include <string>
#include <utility>

namespace lagroid::learning {

/// ParametricField of one potential, for each scalar.
template <class P, int K> struct PotentialFields {
  template <class S> using Field = ParametricField<P, K, S>;
  static constexpr int lanes = lanes_of<K>;
  static constexpr bool projected = false;  // methods for spheres stay there, and classical ones are compared with them

  P potential;
  int bodies;
  Dissipation dissipation;

  RayleighDissipation<K> rayleigh() const { return {bodies, dissipation}; }
  int size() const { return mass_size(bodies) + potential.size() + rayleigh().size(); }
  template <class S> Field<S> field() const { return Field<S>(potential, bodies, dissipation); }
};

/// Compiles a potential (Potential) into a Model. K is k, or Eigen::Dynamic.
///
/// `start` takes the potential's own start(seed) where it has one; else its parameters begin at zero.
template <class P, int K> class ParametricModel : public FieldModel<PotentialFields<P, K>> {
  using Base = FieldModel<PotentialFields<P, K>>;

 public:
  ParametricModel(std::string name, P potential, int bodies = K, Dissipation dissipation = Dissipation::none)
      : Base(std::move(name), {std::move(potential), bodies, dissipation}) {}

  const P& potential() const { return this->fields().potential; }
  StateSpace space() const override { return cotangent_spheres(this->fields().bodies); }

  Eigen::VectorXd start(unsigned seed) const override {
    const P& potential = this->potential();
    const int masses = mass_size(this->fields().bodies);
    Eigen::VectorXd theta = Eigen::VectorXd::Zero(this->size());
    if (seed != 0) {
      std::mt19937 generator(seed);
      for (int i = 0; i < masses; ++i) theta(i) = 0.5 * (double(generator()) / 4294967296.0) - 0.25;
    }
    if constexpr (requires { potential.start(seed); }) theta.segment(masses, potential.size()) = potential.start(seed);
    const Eigen::VectorXd damping = this->fields().rayleigh().start(seed);
    theta.tail(damping.size()) = damping;
    return theta;
  }

  Eigen::MatrixXd mass(const Eigen::VectorXd& theta) const override { return this->at(theta).mass(); }
  std::unique_ptr<ModelField> equations(const Eigen::VectorXd& theta) const override {
    return std::make_unique<EquationsAt>(this->at(theta));
  }

 private:
  using Field = ParametricField<P, K>;

  class EquationsAt final : public ModelField {
   public:
    explicit EquationsAt(Field field)
        : field_(std::move(field)), z_(field_.space().zero_point()), f_(field_.space().zero_algebra()) {}
    void field(const Points& z, Points& f) override {
      z_ = z;
      field_(0, z_, f_);
      f = f_;
    }
    double energy(const Points& z) override {
      z_ = z;
      return field_.energy(z_);
    }

   private:
    Field field_;
    typename Field::Z z_, f_;
  };
};

}  // namespace lagroid::learning
