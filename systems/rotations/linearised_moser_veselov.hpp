#pragma once
/// The motion of the rigid body by Moser and Veselov's steps (moser_veselov.hpp), linearised. The end depends on the
/// start in two ways: directly, and by the moments I~, which are made of the momentum at the start and of the inertia
/// and stay from there on,
///
///     I~ = I~(M_0; I),    (v, M, I~) -> (v', M', I~),
///
/// a step being linearised at its solution as all others are.
///
///     LinearisedMoserVeselov motion(body, start, attitude, 10, {"inertia"}, observe);  // to order 10
///     const Propagated end = propagate_forward(motion, 100, directions);  // columns (v, M, I~, theta)
///
/// States are (v, M, I~); a start varies by the first two alone. With moments that are held the matrix of a step is
/// symplectic, and the derivatives are those of the motion to order two; with those that are made of the start they are
/// to the order of the method, and the matrix of the run is symplectic to that order.
///
/// Errors: those of MoserVeselov::preprocessed; std::invalid_argument for a name that is no parameter;
/// WithoutDerivative for the inertia of a body of which the three moments are equal, to within a part in 10^5: which
/// share the middle one has between the others is known by their differences.

#include <lagroid/core/derivatives/varied_directions.hpp>
#include <lagroid/solvers/sensitivity/linearised_motion_of.hpp>
#include <lagroid/systems/rotations/moser_veselov.hpp>
#include <lagroid/systems/rotations/rigid_body.hpp>

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace lagroid {

class LinearisedMoserVeselov final : public LinearisedMotion {
 public:
  using Attitude = Matrix<double, 3, 3>;
  static constexpr int n = RigidBody::dimension;
  static constexpr int moments_place = 2 * n;
  static constexpr int size = 3 * n;

  LinearisedMoserVeselov(const RigidBody& body, const State<SO3>& start, const Attitude& attitude, int order,
                         const std::vector<std::string>& parameters, ObserveNode<RigidBody> observe)
      : body_(body),
        steps_(MoserVeselov::preprocessed(body.inertia, start.momentum, body.h, order)),
        places_(places_of_parameters(body_, parameters)),
        observe_(std::move(observe)),
        integrator_(steps_, start, attitude, std::make_unique<MoserVeselovStep>()),
        making_moments_(0, size, this->parameters()),
        stage_(n, size, this->parameters()) {
    require_shape();
    make_moments(start.momentum);
  }
  LinearisedMoserVeselov(const LinearisedMoserVeselov&) = delete;  // derivatives know members by their places
  LinearisedMoserVeselov& operator=(const LinearisedMoserVeselov&) = delete;

  int states() const override { return size; }
  int parameters() const override { return int(places_.members.size()); }
  const std::vector<std::string>& parameter_names() const { return places_.names; }
  double time() const override { return integrator_.point().time; }
  StepReport advance() override { return integrator_.advance(); }

  bool linearise() override {
    linearise_step(steps_, integrator_.point().step, moments_, stage_);
    for (int i = moments_place; i < size; ++i) stage_.end_by_start(i, i) = 1;
    return stage_.factor();
  }
  /// Before the first step the moments are made.
  int stages() const override { return integrator_.point().index == 1 ? 2 : 1; }
  const LinearStep& stage(int k) const override { return k + 1 < stages() ? making_moments_ : stage_; }

  NodeValues observe() const override {
    const auto& at = integrator_.point();
    const TrajectoryPoint<RigidBody> point{at.index, at.time,          at.step_size,
                                           at.state, at.configuration, {at.step.arrow, {}}};
    const NodeValues seen = detail::values_at(
        body_, places_, point, 0, [&](int, const auto& object, const auto& momentum, const auto& configuration) {
          return observe_({body_, at.time, object, momentum, configuration});
        });
    NodeValues out{seen.values, Eigen::MatrixXd::Zero(seen.values.size(), size + parameters())};
    out.derivatives.leftCols(moments_place) = seen.derivatives.leftCols(moments_place);
    out.derivatives.rightCols(parameters()) = seen.derivatives.rightCols(parameters());
    return out;
  }

  void serialize(NumberArchive& archive) override { integrator_.serialize(archive); }

 private:
  void require_shape() const {
    constexpr double equal = 1e-5;
    const auto& inertia = body_.inertia;
    if (places_.members.empty() || steps_.order == 2 ||
        inertia.maxCoeff() - inertia.minCoeff() > equal * inertia.maxCoeff())
      return;
    throw WithoutDerivative("parameter " + places_.names.front() +
                            " carries no derivative by preprocessed steps where all moments of inertia are equal; take "
                            "order = 2 or another method");
  }
  void make_moments(const Vector<double, 3>& momentum) {
    auto& by_start = making_moments_.end_by_start;
    by_start.setIdentity();
    by_start.middleCols(moments_place, n).setZero();
    detail::for_directions(size + parameters(), [&](int first) {
      const VariedMembers varying(places_.members, size - first);
      const auto made = preprocess(varied<VariedNumber>(body_.inertia), detail::varied_along(momentum, n - first),
                                   steps_.h, steps_.order);
      detail::put_tangents(made, first, by_start.bottomRows(n));
    });
  }

  RigidBody body_;
  MoserVeselov steps_;
  ParameterPlaces places_;  ///< of body_
  std::array<const double*, 3> moments_{&steps_.modified(0), &steps_.modified(1), &steps_.modified(2)};
  ObserveNode<RigidBody> observe_;
  FixedStepIntegrator<MoserVeselov> integrator_;
  LinearStep making_moments_;
  LinearStep stage_;
};

}  // namespace lagroid
