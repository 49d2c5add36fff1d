// Derivatives of runs by extrapolated splitting steps, which hold the inner steps that the tolerance asked for.

#include "../differences.hpp"

#include <lagroid/solvers/sensitivity/explicit/linearised_extrapolation.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulums/spherical_pendulum.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <memory>
#include <span>
#include <vector>

namespace lagroid::sensitivity_extrapolated_tests {
namespace {

constexpr long nodes = 4;
constexpr double coarse = 1e-3;  ///< inner steps that a run may well feel

RunFrom<Kepler> orbit() {
  RunFrom<Kepler> out{Kepler(), {{0.6, 0.1}, {0.1, 1.4}}, {}, {"strength"}};
  out.system.h = 2;
  out.configuration = Pair<2>::unit(out.start.object);
  return out;
}
RunFrom<RigidBody> body() {
  RunFrom<RigidBody> out{RigidBody(), {{}, {0.4, 1.5, 0.4}}, {}, {}};
  out.system.h = 6;
  out.configuration = SO3::exp(Vector<double, 3>(0.2, 0.4, 0.1));
  return out;
}
RunFrom<SphericalPendulum> bob() {
  RunFrom<SphericalPendulum> out{SphericalPendulum(), {{0.6, 0, -0.8}, {0.4, 0.7, 0.3}}, {}, {}};
  out.system.h = 3;
  out.configuration = Pair<3>::unit(out.start.object);
  return out;
}

auto to(double tolerance) {
  return [tolerance]<class Sys>(const RunFrom<Sys>& from) {
    return std::make_unique<LinearisedExtrapolation<Sys>>(from.system, from.start, from.configuration, tolerance,
                                                          from.names, EndOfRun());
  };
}

/// By the inner steps of a run, node after node, wherever it begins.
template <SplitSystem Sys> class GivenSteps {
 public:
  using G = typename Sys::GroupoidType;
  using Chart = GroupoidChart<Sys>;

  GivenSteps(const RunFrom<Sys>& like, const RunFrom<Sys>& from, double tolerance) : system_(from.system) {
    ExtrapolatedSplitting<Sys> run(like.system, like.start, like.configuration, tolerance);
    std::size_t made = 0;
    for (auto& node : inner_) {
      EXPECT_TRUE(run.advance([&](const InnerStep& i) { node.push_back(i); }).converged());
      made += node.size();
    }
    EXPECT_GT(made, inner_.size()) << "of one size each";
    point_.state = from.start;
    point_.configuration = from.configuration;
  }
  const TrajectoryPoint<Sys>& point() const { return point_; }
  StepReport advance() {
    const NodeOver<G, double> from{point_.state.object, point_.state.momentum, point_.configuration};
    const auto end = follow_inner_steps(system_, from, std::span<const InnerStep>(inner_[std::size_t(point_.index)]));
    point_.state = {end.object, end.momentum};
    point_.configuration = end.configuration;
    ++point_.index;
    return {SolveStatus::converged};
  }
  template <class S> NodeOver<G, S> step(const Sys& system, const NodeOver<G, S>& from) const {
    return follow_inner_steps(system, from, std::span<const InnerStep>(inner_[std::size_t(point_.index - 1)]));
  }
  void serialize(NumberArchive& archive) { point_.serialize(system_.groupoid, archive); }

 private:
  Sys system_;
  TrajectoryPoint<Sys> point_;
  std::array<std::vector<InnerStep>, std::size_t(nodes)> inner_;
};
template <class Sys> auto by_steps_of(const RunFrom<Sys>& like, double tolerance) {
  return [like, tolerance](const RunFrom<Sys>& from) {
    return std::make_unique<LinearisedExplicit<Sys, GivenSteps<Sys>>>(
        from.system, GivenSteps<Sys>(like, from, tolerance), from.names, EndOfRun());
  };
}

template <class Sys> void expect_derivatives_by_held_steps(const RunFrom<Sys>& from) {
  expect_exact_derivatives(from, by_steps_of(from, coarse), nodes);
  EXPECT_LT(missed_differences(from, to(coarse), by_steps_of(from, coarse), nodes), 1e-8);
}

TEST(ExtrapolationSensitivities, AreWhatDifferencesByTheSameInnerStepsTendTo) {
  expect_derivatives_by_held_steps(orbit());
  expect_derivatives_by_held_steps(body());
  expect_derivatives_by_held_steps(bob());
}

TEST(ExtrapolationSensitivities, AreTakenBackAsForward) {
  const auto forwards = to(1e-9)(orbit()), backwards = to(1e-9)(orbit());
  const Propagated forward = propagate_forward(*forwards, nodes, directions_of_start(*forwards, 4));
  const Propagated backward = propagate_backward(*backwards, nodes, Observed::at_end(), {2});
  ASSERT_TRUE(forward.converged());
  EXPECT_LT((backward.derivatives - forward.derivatives).norm(), 1e-12 * forward.derivatives.norm());
}

/// Inner steps of runs from elsewhere are others, which a loose tolerance lets be seen, and a tight one hides.
TEST(ExtrapolationSensitivities, MissDifferencesOfRunsByTheirOwnInnerStepsByTheTolerance) {
  EXPECT_GT(missed_differences(orbit(), to(coarse), to(coarse), nodes), 1e-8);
  EXPECT_LT(missed_differences(orbit(), to(1e-13), to(1e-13), nodes), 1e-8);
}

}  // namespace
}  // namespace lagroid::sensitivity_extrapolated_tests
