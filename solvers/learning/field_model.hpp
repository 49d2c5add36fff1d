#pragma once
/// The model of any field with parameters: a field that is written for any scalar becomes a Model, with trajectories
/// through an integrator and their exact derivatives in theta.
///
///     const learning::ParametricModel<learning::PolynomialPotential, 1> on_spheres("quadratic", {1, 2});
///     const learning::HamiltonianModel<learning::Polynomial, 1> in_the_plane("quartic", {2, 4});
///     const learning::Model& any = in_the_plane;
///
/// Derivatives with respect to the parameters are those of jets, a few directions at a time, through whatever the
/// integrator does.

#include <lagroid/core/scalars/jet.hpp>
#include <lagroid/solvers/learning/model.hpp>
#include <lagroid/solvers/lie_group/integrator.hpp>

#include <algorithm>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::learning {

/// How many directions of parameters a jet carries: eight where the number of bodies or coordinates is a type's. Eigen
/// aligns arrays of run-time size to 16 bytes: two doubles.
template <int Size> constexpr int lanes_of = Size == Eigen::Dynamic ? 2 : 8;

/// Compiles a family of fields, one for each scalar, into a Model. Required of F:
///
///     template <class S> using Field         has Z, a state; space(), a HomogeneousSpace; set(const S* theta);
///                                            operator()(t, z, f); energy(z); dissipation()
///     static constexpr int lanes             how many directions of parameters a jet carries
///     static constexpr bool projected        whether each step is brought back onto the space
///     template <class S> Field<S> field() const
///     int size() const                       how many parameters
template <class F> class FieldModel : public Model {
  using Direction = Jet<double, F::lanes>;
  template <class S> using Field = typename F::template Field<S>;
  template <class S> using Z = typename Field<S>::Z;

 public:
  FieldModel(std::string name, F fields) : name_(std::move(name)), fields_(std::move(fields)) {}

  std::string name() const override { return name_; }
  Eigen::Index size() const override { return fields_.size(); }

  double energy(const Eigen::VectorXd& theta, const Eigen::VectorXd& z) const override {
    Field<double> f = at(theta);
    return f.energy(state(f, z));
  }
  Eigen::VectorXd field(const Eigen::VectorXd& theta, const Eigen::VectorXd& z) const override {
    Field<double> f = at(theta);
    auto u = f.space().zero_algebra();
    f(0, state(f, z), u);
    return u.reshaped();
  }
  Eigen::VectorXd rates(const Eigen::VectorXd& theta, const Eigen::VectorXd& z) const override {
    Field<double> f = at(theta);
    const Z<double> from = state(f, z);
    auto u = f.space().zero_algebra();
    Z<double> v = f.space().zero_point();
    f(0, from, u);
    f.space().generator(u, from, v);
    return v.reshaped();
  }
  Eigen::MatrixXd dissipation(const Eigen::VectorXd& theta) const override { return at(theta).dissipation(); }

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
    constexpr int lanes = F::lanes;
    Field<Direction> field = fields_.template field<Direction>();
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
    const Z<double> from = state(field, start);
    ControlledLieGroupIntegrator integrator(space, std::move(field), lie_group_methods::munthe_kaas_54, from,
                                            LieGroupControl{.tolerance = tolerance, .most_steps = 100'000});
    for (std::size_t i = 0; i < times.size(); ++i) {
      if (!integrator.advance_to(times[i]).converged()) return false;
      z.col(Eigen::Index(i)) = integrator.point().reshaped();
    }
    return true;
  }

 protected:
  const F& fields() const { return fields_; }
  Field<double> at(const Eigen::VectorXd& theta) const {
    Field<double> field = fields_.template field<double>();
    field.set(theta.data());
    return field;
  }
  static Z<double> state(const Field<double>& field, const Eigen::VectorXd& z) {
    Z<double> out = field.space().zero_point();
    std::copy(z.begin(), z.end(), out.data());
    return out;
  }

 private:
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
        for (int s = 0; s < schedule.substeps; ++s) {
          step.advance(field, 0, h, point);
          if constexpr (F::projected) step.space().project(point);
        }
        use(column, interval * point.size(), point);
      }
    }
  }

  std::string name_;
  F fields_;
};

}  // namespace lagroid::learning
