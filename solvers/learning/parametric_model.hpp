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

#include <lagroid/core/scalars/jet.hpp>
#include <lagroid/solvers/learning/model.hpp>
#include <lagroid/solvers/learning/parametric_field.hpp>
#include <lagroid/solvers/lie_group/integrator.hpp>

#include <algorithm>
#include <random>
#include <utility>

namespace lagroid::learning {

/// Compiles a potential (Potential) into a Model. K is k, or Eigen::Dynamic. Derivatives with respect to the parameters
/// are those of jets, a few directions at a time, through whatever the integrator does.
///
/// `start` takes the potential's own start(seed) where it has one; else its parameters begin at zero.
template <class P, int K> class ParametricModel : public Model {
  // Eigen aligns arrays of run-time size to 16 bytes: two doubles.
  static constexpr int lanes = K == Eigen::Dynamic ? 2 : 8;
  using Direction = Jet<double, lanes>;
  template <class S> using Field = ParametricField<P, K, S>;
  template <class S> using Z = typename Field<S>::Z;

 public:
  ParametricModel(std::string name, P potential, int bodies = K)
      : name_(std::move(name)), potential_(std::move(potential)), bodies_(bodies) {}

  const P& potential() const { return potential_; }
  std::string name() const override { return name_; }
  int bodies() const override { return bodies_; }
  Eigen::Index size() const override { return mass_size(bodies_) + potential_.size(); }

  Eigen::VectorXd start(unsigned seed) const override {
    Eigen::VectorXd theta = Eigen::VectorXd::Zero(size());
    if (seed != 0) {
      std::mt19937 generator(seed);
      for (int i = 0; i < mass_size(bodies_); ++i) theta(i) = 0.5 * (double(generator()) / 4294967296.0) - 0.25;
    }
    if constexpr (requires { potential_.start(seed); }) theta.tail(potential_.size()) = potential_.start(seed);
    return theta;
  }

  Eigen::MatrixXd mass(const Eigen::VectorXd& theta) const override { return at(theta).mass(); }
  double energy(const Eigen::VectorXd& theta, const Eigen::VectorXd& z) const override {
    return at(theta).energy(state(z));
  }
  Eigen::VectorXd field(const Eigen::VectorXd& theta, const Eigen::VectorXd& z) const override {
    Field<double> f = at(theta);
    Z<double> u = f.space().zero_algebra();
    f(0, state(z), u);
    return u.reshaped();
  }

  std::unique_ptr<ModelField> equations(const Eigen::VectorXd& theta) const override {
    return std::make_unique<EquationsAt>(at(theta));
  }

  void predict(const Eigen::VectorXd& theta, const Schedule& schedule, const Eigen::Ref<const Eigen::MatrixXd>& starts,
               Eigen::Ref<Eigen::MatrixXd> z) const override {
    Field<double> field = at(theta);
    integrate(field, schedule, starts, [&](Eigen::Index column, Eigen::Index row, const Z<double>& point) {
      z.col(column).segment(row, point.size()) = point.reshaped();
    });
  }

  LAGROID_FLATTEN void differentiate(const Eigen::VectorXd& theta, const Schedule& schedule,
                                     const Eigen::Ref<const Eigen::MatrixXd>& starts, Eigen::Ref<Eigen::MatrixXd> z,
                                     Eigen::Ref<Eigen::MatrixXd> derivative) const override {
    Field<Direction> field(potential_, bodies_);
    std::vector<Direction> seeded(std::size_t(theta.size()));
    for (Eigen::Index first = 0; first < theta.size(); first += lanes) {
      const int here = int(std::min<Eigen::Index>(lanes, theta.size() - first));
      for (Eigen::Index i = 0; i < theta.size(); ++i)
        seeded[std::size_t(i)] =
            i >= first && i < first + here ? Direction::variable(theta(i), int(i - first)) : Direction(theta(i));
      field.set(seeded.data());
      integrate(field, schedule, starts, [&](Eigen::Index column, Eigen::Index row, const Z<Direction>& point) {
        for (Eigen::Index i = 0; i < point.size(); ++i) {
          const Direction& x = point.data()[i];
          z(row + i, column) = x.value;
          for (int d = 0; d < here; ++d) derivative(column * z.rows() + row + i, first + d) = x.gradient(d);
        }
      });
    }
  }

  bool follow(const Eigen::VectorXd& theta, const Eigen::VectorXd& start, std::span<const double> times,
              double tolerance, Eigen::MatrixXd& z) const override {
    z.resize(start.size(), Eigen::Index(times.size()));
    Field<double> field = at(theta);
    const auto space = field.space();
    ControlledLieGroupIntegrator integrator(space, std::move(field), lie_group_methods::munthe_kaas_54, state(start),
                                            LieGroupControl{.tolerance = tolerance, .most_steps = 100'000});
    for (std::size_t i = 0; i < times.size(); ++i) {
      if (!integrator.advance_to(times[i]).converged()) return false;
      z.col(Eigen::Index(i)) = integrator.point().reshaped();
    }
    return true;
  }

 private:
  class EquationsAt final : public ModelField {
   public:
    explicit EquationsAt(Field<double> field)
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
    Field<double> field_;
    Z<double> z_, f_;
  };

  Field<double> at(const Eigen::VectorXd& theta) const {
    Field<double> field(potential_, bodies_);
    field.set(theta.data());
    return field;
  }
  Z<double> state(const Eigen::VectorXd& z) const { return Eigen::Map<const Z<double>>(z.data(), 6, bodies_); }

  template <class S, class Use>
  void integrate(Field<S>& field, const Schedule& schedule, const Eigen::Ref<const Eigen::MatrixXd>& starts,
                 const Use& use) const {
    LieGroupStep step(field.space(), schedule.method);
    Z<S> point = field.space().zero_point();
    const double h = schedule.interval / schedule.substeps;
    for (Eigen::Index column = 0; column < starts.cols(); ++column) {
      step.forget();
      for (Eigen::Index i = 0; i < point.size(); ++i) point.data()[i] = S(starts(i, column));
      for (int interval = 0; interval < schedule.intervals; ++interval) {
        for (int s = 0; s < schedule.substeps; ++s) step.advance(field, 0, h, point);
        use(column, interval * point.size(), point);
      }
    }
  }

  std::string name_;
  P potential_;
  int bodies_;
};

}  // namespace lagroid::learning
