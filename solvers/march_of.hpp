#pragma once
/// An integrator of a known type as a march.

#include <lagroid/solvers/march.hpp>

#include <utility>

namespace lagroid {

namespace detail {

/// Any integrator, behind the interface.
template <DiscreteSystem Sys, class Integrating> class MarchOf final : public March<Sys> {
 public:
  template <class... As> explicit MarchOf(As&&... arguments) : integrator_(std::forward<As>(arguments)...) {}

  StepReport advance() override { return integrator_.advance(); }
  const TrajectoryPoint<Sys>& point() const override { return integrator_.point(); }
  MethodTraits traits() const override { return integrator_.traits(); }
  void for_each_inner_stage(const typename March<Sys>::Visit& visit) const override {
    if constexpr (requires { integrator_.for_each_inner_stage(visit); }) integrator_.for_each_inner_stage(visit);
  }
  long without_root() const override {
    if constexpr (requires { integrator_.without_root(); }) {
      return integrator_.without_root();
    } else {
      return 0;
    }
  }

  void persist(Tape& tape) override { integrator_.persist(tape); }

 private:
  Integrating integrator_;
};

}  // namespace detail

}  // namespace lagroid
