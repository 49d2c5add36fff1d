#pragma once
/// Puts an integrator of a known type behind the interface `Integrator`, at the cost of one virtual call a step.

#include <lagroid/solvers/integrators/integrator.hpp>

#include <utility>

namespace lagroid {

namespace detail {

/// Any integrator, behind the interface.
template <DiscreteSystem Sys, class Integrating> class IntegratorOf final : public Integrator<Sys> {
 public:
  template <class... As> explicit IntegratorOf(As&&... arguments) : integrator_(std::forward<As>(arguments)...) {}

  StepReport advance() override { return integrator_.advance(); }
  const TrajectoryPoint<Sys>& point() const override { return integrator_.point(); }
  MethodTraits traits() const override { return integrator_.traits(); }
  void for_each_inner_stage(const typename Integrator<Sys>::Visit& visit) const override {
    if constexpr (requires { integrator_.for_each_inner_stage(visit); }) integrator_.for_each_inner_stage(visit);
  }
  long without_root() const override {
    if constexpr (requires { integrator_.without_root(); }) {
      return integrator_.without_root();
    } else {
      return 0;
    }
  }

  void serialize(NumberArchive& archive) override { integrator_.serialize(archive); }

 private:
  Integrating integrator_;
};

}  // namespace detail

}  // namespace lagroid
