#pragma once
/// The model of any potential: a class that writes V(q; theta) becomes a Model, with trajectories and their exact
/// derivatives in theta, and those of steps in the state too.
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

#include <lagroid/solvers/extrapolation/extrapolated_step.hpp>
#include <lagroid/solvers/learning/field_model.hpp>
#include <lagroid/solvers/learning/parametric_field.hpp>

#include <algorithm>
#include <memory>
#include <random>
#include <string>
#include <utility>
#include <vector>

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
  std::unique_ptr<ModelDerivatives> derivatives(const Eigen::VectorXd& theta,
                                                std::vector<Eigen::Index> places) const override {
    return std::make_unique<DerivativesAt>(this->fields(), theta, std::move(places));
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

  class DerivativesAt final : public ModelDerivatives {
   public:
    DerivativesAt(const PotentialFields<P, K>& fields, Eigen::VectorXd theta, std::vector<Eigen::Index> places)
        : theta_(std::move(theta)),
          places_(std::move(places)),
          field_(fields.template field<Direction>()),
          at_(field_.space().zero_point()),
          seeded_(std::size_t(theta_.size())) {}

    int parameters() const override { return int(places_.size()); }
    void step(const Points& z, const LieGroupMethod* method, double h, int rows, Points& end,
              Eigen::MatrixXd& by) override {
      LieGroupStep step(field_.space(), method == nullptr ? lie_group_methods::lie_euler : *method);
      differentiate(z, z.size(), by, [&] {
        if (method == nullptr) {
          extrapolated_step(step.space(), field_, 0, h, rows, at_);
          return at_.data();
        }
        step.forget();
        step.advance(field_, 0, h, at_);
        if (method->scheme != LieGroupScheme::classical) step.space().project(at_);
        return at_.data();
      });
      end.resize(z.rows(), z.cols());
      for (Eigen::Index i = 0; i < z.size(); ++i) end.data()[i] = at_.data()[i].value;
    }
    double energy(const Points& z, Eigen::MatrixXd& by) override {
      Direction energy(0.0);
      differentiate(z, 1, by, [&] {
        energy = field_.energy(at_);
        return &energy;
      });
      return energy.value;
    }

   private:
    using Direction = Jet<double, lanes_of<K>>;

    /// by <- the derivatives of the numbers that `made` makes of the point and the parameters, a few at a time.
    template <class Made>
    void differentiate(const Points& z, Eigen::Index rows, Eigen::MatrixXd& by, const Made& made) {
      const Eigen::Index states = z.size(), count = states + Eigen::Index(places_.size());
      by.resize(rows, count);
      for (Eigen::Index first = 0; first < count; first += lanes_of<K>) {
        for (Eigen::Index i = 0; i < states; ++i) at_.data()[i] = Direction(z.data()[i]);
        std::copy(theta_.begin(), theta_.end(), seeded_.begin());
        const int here = int(std::min<Eigen::Index>(lanes_of<K>, count - first));
        for (int d = 0; d < here; ++d) {
          const Eigen::Index column = first + d;
          Direction& number =
              column < states ? at_.data()[column] : seeded_[std::size_t(places_[std::size_t(column - states)])];
          number = Direction::variable(number.value, d);
        }
        field_.set(seeded_.data());
        const Direction* out = made();
        for (Eigen::Index i = 0; i < rows; ++i)
          for (int d = 0; d < here; ++d) by(i, first + d) = out[i].gradient(d);
      }
    }

    Eigen::VectorXd theta_;
    std::vector<Eigen::Index> places_;
    ParametricField<P, K, Direction> field_;
    typename ParametricField<P, K, Direction>::Z at_;
    std::vector<Direction> seeded_;
  };
};

}  // namespace lagroid::learning
