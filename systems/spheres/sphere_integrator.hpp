#pragma once
/// Integrators on (TS^2)^k and (T*S^2)^k by a method chosen at run time: equal nodes, each reached by one step or by
/// inner steps that an error estimate controls.
///
///     const PendulumChain<Eigen::Dynamic> chain(Eigen::VectorXd::Ones(1), Eigen::VectorXd::Ones(1));
///     SphereIntegrator::Points start(6, 1);
///     start << 1, 0, 0, 0, 0, 0;
///     const auto motion = make_chain_integrator(chain, start, {.method = "munthe-kaas-54", .tolerance = 1e-10});
///
/// (The chain is in pendulums/pendulum_chain.hpp.) Requires a start on the bundle, of a column for each factor. Throws
/// std::invalid_argument for unknown methods, a tolerance that is negative or that the method has no estimate for, none
/// where it takes its order from one, steps of zero, and compositions of methods that have none. `advance` reports a
/// status; unless it is `converged` everything stays as it was.

#include <lagroid/core/number_archive.hpp>
#include <lagroid/groupoids/spheres.hpp>
#include <lagroid/solvers/extrapolation/extrapolation_integrator.hpp>
#include <lagroid/solvers/integrators/compositions.hpp>
#include <lagroid/solvers/lie_group/integrator.hpp>
#include <lagroid/solvers/methods/method.hpp>
#include <lagroid/solvers/step/step_solver.hpp>

#include <cmath>
#include <functional>
#include <memory>
#include <stdexcept>
#include <string>

namespace lagroid {

/// Of which bundle the points are.
enum class SphereForm {
  velocities,  ///< (q_i, w_i) in (TS^2)^k, q_i' = w_i x q_i
  momenta      ///< (q_i, p_i) in (T*S^2)^k
};

struct SphereIntegratorOptions {
  std::string method;  ///< the name of a LieGroupMethod, "extrapolation", or one of the system's own
  SphereForm form = SphereForm::velocities;
  double step = 0.01;                    ///< from node to node
  double tolerance = 0;                  ///< of inner steps, which an embedded method then controls; 0: one step a node
  long most_inner = most_inner_steps;    ///< of these, from one node to the next
  std::function<bool()> stop = nullptr;  ///< called before each of these; true ends the step, which is then not made
  Composition composition = compositions::single;  ///< of a symmetric method of the system's own
  /// Called after each inner step, with its size and how often it evaluated the field.
  std::function<void(double h, int evaluations)> accepted = nullptr;
};

/// A trajectory in the making, of equally spaced nodes. A step that does not converge leaves everything as it was.
class SphereIntegrator {
 public:
  using Points = CotangentSpheres<Eigen::Dynamic>::Point;

  virtual ~SphereIntegrator() = default;
  /// To the next node. Of inner steps the report counts evaluations.
  virtual StepReport advance() = 0;
  /// In the form of the options.
  virtual Points point() const = 0;
  virtual double time() const = 0;
  virtual MethodTraits traits() const = 0;
  /// Visits all that the next step goes on from: an integrator begun with the same arguments, to which it is restored,
  /// goes on with the same bits.
  virtual void serialize(NumberArchive& archive) = 0;
};

/// How far points are from the bundle: the largest of ||q_i|^2 - 1| / 2 and |q_i.w_i|, the latter over the largest
/// |w_j|.
double off_spheres(const SphereIntegrator::Points& z);

namespace detail {

template <class F> class EqualSphereSteps final : public SphereIntegrator {
 public:
  EqualSphereSteps(F field, const LieGroupMethod& method, const Points& start, double step)
      : integrator_({{int(start.cols())}}, std::move(field), method, start, step) {}

  StepReport advance() override { return integrator_.advance(); }
  Points point() const override { return integrator_.point(); }
  double time() const override { return integrator_.time(); }
  MethodTraits traits() const override { return integrator_.traits(); }
  void serialize(NumberArchive& archive) override { integrator_.serialize(archive); }

 private:
  LieGroupIntegrator<CotangentSpheres<Eigen::Dynamic>, F> integrator_;
};

/// How an integrator between nodes is controlled.
inline LieGroupControl control_of(const SphereIntegratorOptions& options) {
  return {.tolerance = options.tolerance,
          .first_step = options.step,
          .largest_step = options.step,
          .most_steps = options.most_inner,
          .stop = options.stop,
          .accepted = options.accepted};
}

/// From node to node by an integrator with a tolerance.
template <class Controlled> class ControlledSphereSteps : public SphereIntegrator {
 public:
  ControlledSphereSteps(Controlled integrator, double step)
      : integrator_(std::move(integrator)), node_(integrator_.place()), step_(step) {}

  StepReport advance() override {
    const long before = integrator_.evaluations();
    StepReport report = integrator_.advance_to(double(index_ + 1) * step_);
    report.iterations = int(integrator_.evaluations() - before);
    if (!report.converged()) {
      integrator_.go_back_to(node_);
      return report;
    }
    integrator_.keep(node_);
    ++index_;
    return report;
  }
  Points point() const override { return integrator_.point(); }
  double time() const override { return double(index_) * step_; }
  MethodTraits traits() const override {
    MethodTraits traits = integrator_.traits();
    traits.name += ", steps controlled";
    return traits;
  }
  void serialize(NumberArchive& archive) override {
    integrator_.serialize(archive);
    archive(index_);
    if (archive.reading()) integrator_.keep(node_);
  }

 private:
  Controlled integrator_;
  typename Controlled::Place node_;
  double step_;
  long index_ = 0;
};

/// Whether options are such that extrapolation can follow them; throws std::invalid_argument where they are not.
void require_extrapolation(const SphereIntegratorOptions& options);

}  // namespace detail

/// The integrator of z' = F(z)_M(z) by the Lie group method of that name. Throws std::invalid_argument where there is
/// none, where a tolerance is negative or given to one that estimates no error, and for a composition.
template <class F>
std::unique_ptr<SphereIntegrator> integrator_on_spheres(F field, const SphereIntegrator::Points& start,
                                                        const SphereIntegratorOptions& options) {
  const CotangentSpheres<Eigen::Dynamic> space{{int(start.cols())}};
  const auto controlled = [&]<class Controlled>(Controlled integrator) {
    return std::make_unique<detail::ControlledSphereSteps<Controlled>>(std::move(integrator), options.step);
  };
  if (options.method == extrapolation_method.name) {
    detail::require_extrapolation(options);
    return controlled(ExtrapolationIntegrator(space, std::move(field), start, detail::control_of(options)));
  }
  const LieGroupMethod* method = lie_group_methods::named(options.method);
  if (method == nullptr) throw std::invalid_argument("no Lie group method is called \"" + options.method + "\"");
  if (!(options.tolerance >= 0) || !std::isfinite(options.step) || options.step == 0)
    throw std::invalid_argument("an integrator on spheres has a finite step and no negative tolerance");
  if (options.composition.stages() > 1) throw std::invalid_argument("steps of " + options.method + " are not composed");
  if (options.tolerance > 0)
    return controlled(
        ControlledLieGroupIntegrator(space, std::move(field), *method, start, detail::control_of(options)));
  return std::make_unique<detail::EqualSphereSteps<F>>(std::move(field), *method, start, options.step);
}

template <int K> struct PendulumChain;

/// A chain of any length. Its own method is "rattle", the variational one (ChainRattle); "extrapolation" goes by
/// ChainRotationField, four rows side by side. `start` is of the form of the
/// options. Throws std::invalid_argument as `integrator_on_spheres`, and where rattle is to have a tolerance. Compiled.
std::unique_ptr<SphereIntegrator> make_chain_integrator(const PendulumChain<Eigen::Dynamic>& chain,
                                                        const SphereIntegrator::Points& start,
                                                        const SphereIntegratorOptions& options);

}  // namespace lagroid
