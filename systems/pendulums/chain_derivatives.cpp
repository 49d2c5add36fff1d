#include <lagroid/core/capabilities/parameter_numbers.hpp>
#include <lagroid/core/derivatives/varied_directions.hpp>
#include <lagroid/solvers/extrapolation/extrapolated_step.hpp>
#include <lagroid/solvers/lie_group/step.hpp>
#include <lagroid/systems/pendulums/chain_derivatives.hpp>
#include <lagroid/systems/pendulums/chain_rattle.hpp>

#include <stdexcept>
#include <utility>

namespace lagroid {

namespace {

constexpr int any = Eigen::Dynamic;
using Chain = PendulumChain<any>;
using Space = CotangentSpheres<any, VariedNumber>;
using VariedPoints = Space::Point;

class ChainDerivatives final : public SphereDerivatives {
 public:
  ChainDerivatives(const Chain& chain, const SphereIntegratorOptions& options, SphereForm shown,
                   const std::vector<std::string>& parameters)
      : chain_(chain),
        options_(options),
        shown_(shown),
        method_(lie_group_methods::named(options.method)),
        extrapolates_(options.method == extrapolation_method.name),
        step_(Space{{chain.links()}}, method_ == nullptr ? lie_group_methods::lie_euler : *method_),
        names_(int(parameters.size())) {
    if (method_ == nullptr && !extrapolates_ && options.method != rattle_method.name)
      throw std::invalid_argument("no method of chains is called \"" + options.method + "\"");
    if (extrapolates_ && options.form == SphereForm::momenta)
      throw std::invalid_argument("chains are extrapolated by velocities");
    for (int name = 0; name < names_; ++name) find(parameters[std::size_t(name)], name);
  }
  ChainDerivatives(const ChainDerivatives&) = delete;  // derivatives know members by their places
  ChainDerivatives& operator=(const ChainDerivatives&) = delete;

  int parameters() const override { return names_; }

  bool step(const Points& z, const SphereStep& step, Points& end, Eigen::MatrixXd& by) override {
    bool converged = true;
    end = differentiate(z, by, [&](VariedPoints& at) {
            converged = make_step(step, at) && converged;
            return at.reshaped();
          }).reshaped(z.rows(), z.cols());
    return converged;
  }
  Eigen::MatrixXd in_form(const Points& z, SphereForm from, SphereForm to) const override {
    Eigen::MatrixXd by;
    differentiate(z, by, [&](const VariedPoints& at) { return changed(at, from, to).reshaped().eval(); });
    return by;
  }
  NodeValues observe(const Points& z) const override {
    NodeValues out;
    out.values = differentiate(z, out.derivatives, [&](const VariedPoints& at) {
      const VariedPoints moving = changed(at, options_.form, SphereForm::velocities);
      const Eigen::Index third = 3 * at.cols();
      Vector<VariedNumber, any> seen(3 * third + 2);
      Vector<VariedNumber, 3> bob = Vector<VariedNumber, 3>::Zero();
      for (int i = 0; i < chain_.links(); ++i) {
        bob += Space::first(at, i) * varied<VariedNumber>(chain_.length(i));
        seen.segment<3>(3 * i) = bob;
      }
      seen.segment(third, third) = at.topRows<3>().reshaped();
      seen.segment(2 * third, third) = changed(at, options_.form, shown_).bottomRows<3>().reshaped();
      seen.tail<2>() << chain_.energy(moving), chain_.vertical_momentum(moving);
      return seen;
    });
    return out;
  }

 private:
  /// The numbers of this name vary along parameter `which`.
  void find(const std::string& name, int which) {
    const std::size_t before = places_.size();
    for_each_parameter_number(std::as_const(chain_), [&](const std::string& each, const double& number, const auto&) {
      if (each != name && !each.starts_with(name + ".")) return;
      places_.push_back(&number);
      belongs_to_.push_back(which);
    });
    if (places_.size() == before) throw std::invalid_argument("a chain has no parameter " + name);
  }

  /// The values of f, a function of the point, and its derivatives by the point and the parameters.
  template <class F> Eigen::VectorXd differentiate(const Points& z, Eigen::MatrixXd& by, const F& f) const {
    const int states = int(z.size()), count = states + int(places_.size());
    Eigen::VectorXd values;
    detail::for_directions(count, [&](int first) {
      const VariedMembers varying(places_, states - first);
      VariedPoints at = z.cast<VariedNumber>();
      for (int i = first; i < std::min(states, first + varied_at_once); ++i)
        at.data()[i] = VariedNumber::variable(z.data()[i], i - first);
      const auto y = f(at);
      if (first == 0) {
        values.resize(y.size());
        by.setZero(y.size(), states + names_);
        for (Eigen::Index i = 0; i < y.size(); ++i) values(i) = y(i).value;
      }
      for (int k = first; k < std::min(count, first + varied_at_once); ++k) {
        auto column = by.col(k < states ? k : states + belongs_to_[std::size_t(k - states)]);
        for (Eigen::Index i = 0; i < y.size(); ++i) column(i) += y(i).tangent(k - first);
      }
    });
    return values;
  }

  VariedPoints changed(const VariedPoints& z, SphereForm from, SphereForm to) const {
    if (from == to) return z;
    return to == SphereForm::momenta ? chain_.to_momenta_over(z) : chain_.to_velocities_over(z);
  }

  bool make_step(const SphereStep& step, VariedPoints& z) {
    if (extrapolates_) {
      ChainRotationField<any, VariedNumber> field(chain_);
      extrapolated_step(SpheresAndVectors<any, VariedNumber>{{chain_.links()}}, field, 0, step.size, step.rows, z);
      step_.space().project(z);
      return true;
    }
    if (method_ == nullptr) {
      ChainRattle<any, VariedNumber> rattle(chain_, z, step.size, options_.composition);
      if (!rattle.advance().converged()) return false;
      z = rattle.point();
      return true;
    }
    if (options_.form == SphereForm::momenta) {
      advance(ChainMomentumField<any, VariedNumber>(chain_), step.size, z);
    } else {
      advance(ChainVelocityField<any, VariedNumber>(chain_), step.size, z);
    }
    return true;
  }
  /// As LieGroupIntegrator does.
  template <class F> void advance(F field, double h, VariedPoints& z) {
    step_.forget();
    step_.advance(field, 0, h, z);
    if (method_->scheme != LieGroupScheme::classical) step_.space().project(z);
  }

  Chain chain_;
  SphereIntegratorOptions options_;
  SphereForm shown_;
  const LieGroupMethod* method_;  ///< null: RATTLE, or
  bool extrapolates_;
  LieGroupStep<Space> step_;
  int names_;
  std::vector<const double*> places_;
  std::vector<int> belongs_to_;  ///< which parameter each of these is of
};

}  // namespace

std::unique_ptr<SphereDerivatives> make_chain_derivatives(const Chain& chain, const SphereIntegratorOptions& options,
                                                          SphereForm shown,
                                                          const std::vector<std::string>& parameters) {
  return std::make_unique<ChainDerivatives>(chain, options, shown, parameters);
}

}  // namespace lagroid
