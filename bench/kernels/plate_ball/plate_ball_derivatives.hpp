#pragma once
/// The plate-ball system in the trace form, its derivatives written by hand.

#include <lagroid/systems/control/plate_ball.hpp>

namespace kernels {

/// With d = (x1 - x0, y1 - y0), w = vee(g), nu = (r l1, -r l2, -l3) and f = L + <lambda, phi> the rotation enters as
/// nu.w, and
///
///     dw along tau(v)^{-1} g = -(tr(g) I - g) / 2,    dw along g tau(w) = (tr(g) I - g^T) / 2,
///     d2(nu.w) / dv dw = nu w^T + hat(g^T nu) / 2.
///
/// `rotation` must be RotationForm::trace.
struct HandPlateBall : lagroid::PlateBall {
  lagroid::GradientsOf<lagroid::PlateBall> gradients(const Arrow<double>& arrow, const Multipliers& lambda) const {
    return gradients(arrow, lambda, terms(arrow, lambda));
  }

  lagroid::TwoSidedOf<lagroid::PlateBall> two_sided(const Arrow<double>& arrow, const Multipliers& lambda) const {
    const auto& g = std::get<1>(arrow);
    const Terms t = terms(arrow, lambda);
    const auto& [w, nu, back, trace, rate, half] = t;
    lagroid::TwoSidedOf<lagroid::PlateBall> out{gradients(arrow, lambda, t), {}, {}, {}};
    out.mixed << -rate, 0, 0, 0, 0,                                                      //
        0, -rate, 0, 0, 0,                                                               //
        0, 0, nu(0) * w(0), nu(0) * w(1) - 0.5 * back(2), nu(0) * w(2) + 0.5 * back(1),  //
        0, 0, nu(1) * w(0) + 0.5 * back(2), nu(1) * w(1), nu(1) * w(2) - 0.5 * back(0),  //
        0, 0, nu(2) * w(0) - 0.5 * back(1), nu(2) * w(1) + 0.5 * back(0), nu(2) * w(2);
    const Eigen::Matrix3d at_source = 0.5 * (g - trace * Eigen::Matrix3d::Identity());
    const Eigen::Vector3d sign(radius, -radius, -1);
    out.constraint_source.topRows<2>() << -half, -1, 0, -1, half, 0;
    out.constraint_source.bottomRows<3>() = at_source.transpose() * sign.asDiagonal();
    out.constraint_target.leftCols<2>() << -half, 1, 1, half, 0, 0;
    out.constraint_target.rightCols<3>() = (-sign).asDiagonal() * at_source.transpose();
    return out;
  }

  lagroid::Step<HandPlateBall> first_guess(const lagroid::State<GroupoidType>& s) const {
    const auto guess = PlateBall::first_guess(s);
    return {guess.arrow, guess.multipliers};
  }

 private:
  /// What gradients and second derivatives share.
  struct Terms {
    Eigen::Vector3d w;
    Eigen::Vector3d nu;
    Eigen::Vector3d back;  // g^T nu
    double trace;
    double rate;
    double half;
  };
  Terms terms(const Arrow<double>& arrow, const Multipliers& lambda) const {
    const auto& g = std::get<1>(arrow);
    const Eigen::Vector3d nu(radius * lambda(0), -radius * lambda(1), -lambda(2));
    return {lagroid::SO3::vee(g), nu, {g.col(0).dot(nu), g.col(1).dot(nu), g.col(2).dot(nu)}, g.trace(), 1 / h,
            0.5 * h * plate_rate};
  }

  lagroid::GradientsOf<lagroid::PlateBall> gradients(const Arrow<double>& arrow, const Multipliers& lambda,
                                                     const Terms& t) const {
    const auto& [move, g] = arrow;
    const auto& [w, nu, back, trace, rate, half] = t;
    const Eigen::Vector2d d = move.target - move.source;
    const Eigen::Vector2d sum = move.source + move.target;
    const Eigen::Vector2d common(half * lambda(0), -half * lambda(1));
    const Eigen::Vector2d opposite(rate * d(0) + lambda(1), rate * d(1) + lambda(0));

    lagroid::GradientsOf<lagroid::PlateBall> out;
    out.constraint << d(1) + radius * w(0) - half * sum(0), d(0) - radius * w(1) + half * sum(1), h * spin - w(2);
    out.value = 0.5 * rate * d.squaredNorm() + lambda.dot(out.constraint);
    out.source_gradient << -common - opposite, 0.5 * (back - trace * nu);
    out.target_gradient << opposite - common, 0.5 * (trace * nu - g * nu);
    return out;
  }
};

}  // namespace kernels
