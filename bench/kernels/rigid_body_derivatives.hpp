#pragma once
/// The free rigid body with the Cayley map, its derivatives written by hand.

#include <lagroid/systems/rotations/rigid_body.hpp>

namespace kernels {

/// With x = cay^{-1}(g), p = I x and L = x.p / (2 h):
///
///     h F- = p + x x p / 2 + (x.p) x / 4,     h F+ = p - x x p / 2 + (x.p) x / 4,
///     h dF-/dx = diag(I) + (hat(x) diag(I) - hat(p)) / 2 + (x.p) / 4 + x p^T / 2,
///     d/dw cay^{-1}(g tau(w)) = I + hat(x) / 2 + x x^T / 4.
///
/// `rotation` must be RotationMap::cayley.
struct HandRigidBody : lagroid::RigidBody {
  lagroid::GradientsOf<lagroid::RigidBody> gradients(const Eigen::Matrix3d& g, const Multipliers&) const {
    const double rate = 1 / h;
    const Eigen::Vector3d x = lagroid::SO3::cayley_inverse(g);
    const Eigen::Vector3d p = inertia.cwiseProduct(x);
    const double product = x.dot(p);
    const Eigen::Vector3d even = p + (0.25 * product) * x;
    const Eigen::Vector3d odd = 0.5 * x.cross(p);
    return {0.5 * rate * product, -rate * (even + odd), rate * (even - odd), {}};
  }

  lagroid::TwoSidedOf<lagroid::RigidBody> two_sided(const Eigen::Matrix3d& g, const Multipliers& lambda) const {
    using lagroid::SO3;
    const double rate = 1 / h;
    const Eigen::Vector3d x = SO3::cayley_inverse(g);
    const Eigen::Vector3d p = inertia.cwiseProduct(x);
    const double product = x.dot(p);
    const Eigen::Matrix3d half = 0.5 * SO3::hat(x);
    Eigen::Matrix3d newton = half * inertia.asDiagonal() - 0.5 * SO3::hat(p) + (0.5 * x) * p.transpose();
    newton.diagonal() += inertia + Eigen::Vector3d::Constant(0.25 * product);
    const Eigen::Matrix3d moved = Eigen::Matrix3d::Identity() + half + (0.25 * x) * x.transpose();
    lagroid::TwoSidedOf<lagroid::RigidBody> out{gradients(g, lambda), {}, {}, {}};
    out.mixed.noalias() = -rate * (newton * moved);
    return out;
  }

  lagroid::Step<HandRigidBody> first_guess(const lagroid::State<lagroid::SO3>& s) const {
    return {RigidBody::first_guess(s).arrow, {}};
  }
};

}  // namespace kernels
