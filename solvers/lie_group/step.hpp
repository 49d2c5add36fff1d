#pragma once
/// One step z -> z after time h of an explicit Lie group integrator (method.hpp). It is for integrators of one's own,
/// and takes any scalar, derivatives included; LieGroupIntegrator has the loop.
///
///     auto spin = [](double, const auto&, auto& out) { out.setConstant(1); };  // an element of the algebra
///     Spheres<1>::Point z(0, 0, 1);
///     LieGroupStep<Spheres<1>> step({}, lie_group_methods::commutator_free_4);
///     step.advance(spin, 0, 0.1, z);  // t, h
///
/// Requires a field(t, z, out) that writes an element of the algebra, z of the size of the space's points, and `forget`
/// where a method that reuses its last slope does not go on from where it ended. Whether numbers are finite is for the
/// caller to look at. `error` is that of the embedded method, where there is one.

#include <lagroid/core/hamiltonian/homogeneous_space.hpp>
#include <lagroid/core/number_archive.hpp>
#include <lagroid/core/scalars/numbers_of.hpp>
#include <lagroid/solvers/lie_group/method.hpp>
#include <lagroid/solvers/methods/method.hpp>

#include <array>
#include <cmath>
#include <string>
#include <utility>

namespace lagroid {

/// What a method declares of itself.
inline MethodTraits traits_of(const LieGroupMethod& method) {
  return {std::string(method.name), method.order, false, false, true, method.stages - (method.reuses_last ? 1 : 0)};
}

/// Steps z' = F(t, z)_M(z) by a LieGroupMethod. Holds the workspace, so that a step allocates nothing; for any scalar
/// of M. No step looks at whether its numbers are finite.
template <HomogeneousSpace M> class LieGroupStep {
 public:
  using Point = typename M::Point;
  using Algebra = typename M::Algebra;

  LieGroupStep(M space, const LieGroupMethod& method) : space_(std::move(space)), method_(method) {
    for (auto& k : slope_) k = space_.zero_algebra();
    if (method.scheme == LieGroupScheme::classical)
      for (auto& v : velocity_) v = space_.zero_point();
    for (auto& z : stage_) z = space_.zero_point();
    sum_ = inner_ = outer_ = space_.zero_algebra();
  }

  const M& space() const { return space_; }
  const LieGroupMethod& method() const { return method_; }

  /// z <- z after time h. A method that reuses its last slope expects to go on from where it ended; `forget` otherwise.
  template <AlgebraField<M> F> void advance(F& field, double t, double h, Point& z) {
    switch (method_.scheme) {
      case LieGroupScheme::commutator_free:
        return by_exponentials(field, t, h, z);
      case LieGroupScheme::munthe_kaas:
        return by_algebra(field, t, h, z);
      case LieGroupScheme::classical:
        return in_coordinates(field, t, h, z);
    }
  }
  void forget() { knows_first_ = false; }
  /// The step just made is not gone on from, its first slope holds for the next.
  void reject() {
    if (method_.reuses_last) std::swap(slope_[0], slope_[std::size_t(method_.stages) - 1]);
  }

  /// Of an embedded method, the last step's h sum_j e_j K_j, the difference of both in the algebra; its largest
  /// component.
  double error() const { return error_; }

  /// What the next step goes on from, beside the point.
  struct Memory {
    bool knows_first = false;
    Algebra slope;
  };
  void keep(Memory& at) const {
    at.knows_first = knows_first_;
    if (method_.reuses_last) at.slope = slope_[std::size_t(method_.stages) - 1];
  }
  void go_back_to(const Memory& at) {
    knows_first_ = at.knows_first;
    if (method_.reuses_last) slope_[std::size_t(method_.stages) - 1] = at.slope;
  }
  /// Visits the same.
  void serialize(NumberArchive& archive) {
    if (!method_.reuses_last) return;
    auto slope = numbers_of(slope_[std::size_t(method_.stages) - 1]);
    archive(knows_first_, slope);
  }

 private:
  /// sum <- h sum_j w_j K_j; false where all weights are zero.
  bool combine(const LieGroupMethod::Row& weights, double h, int stages) {
    bool any = false;
    for (int j = 0; j < stages; ++j) {
      const double w = weights[std::size_t(j)];
      if (w == 0) continue;
      if (any) {
        sum_ += slope_[std::size_t(j)] * (h * w);
      } else {
        sum_ = slope_[std::size_t(j)] * (h * w);
      }
      any = true;
    }
    return any;
  }

  template <class F> void by_exponentials(F& field, double t, double h, Point& z) {
    const auto product = [&](int i, Point& to) {
      const auto& p = method_.products[std::size_t(i)];
      if (&to != &z || p.from != 0) to = p.from == 0 ? z : stage_[std::size_t(p.from)];
      for (int r = 0; r < p.factors; ++r)
        if (combine(p.weights[std::size_t(r)], h, i)) space_.act(sum_, to);
    };
    field(t, z, slope_[0]);
    for (int i = 1; i < method_.stages; ++i) {
      product(i, stage_[std::size_t(i)]);
      field(t + method_.node(i) * h, stage_[std::size_t(i)], slope_[std::size_t(i)]);
    }
    product(method_.stages, z);
  }

  template <class F> void by_algebra(F& field, double t, double h, Point& z) {
    const int stages = method_.stages;
    const int last = method_.reuses_last ? stages - 1 : stages;
    if (knows_first_) {
      std::swap(slope_[0], slope_[std::size_t(stages) - 1]);
    } else {
      field(t, z, slope_[0]);
    }
    for (int i = 1; i < last; ++i) {
      combine(method_.a[std::size_t(i)], h, i);
      stage_[0] = z;
      space_.act(sum_, stage_[0]);
      Algebra& k = slope_[std::size_t(i)];
      field(t + method_.node(i) * h, stage_[0], k);
      k = differential_inverse(k);
    }
    combine(method_.b, h, last);
    space_.act(sum_, z);
    if (method_.reuses_last) {
      // The new step's first slope is F there; this step's last is dexp_u^{-1} of it.
      Algebra& k = slope_[std::size_t(last)];
      field(t + h, z, k);
      differential_inverse(k);
      combine(method_.error, h, last);
      sum_ += inner_ * (h * method_.error[std::size_t(last)]);
      error_ = largest(sum_);
      knows_first_ = true;
    }
  }

  /// dexp_u^{-1} k = k - [u, k] / 2 + [u, [u, k]] / 12 - ..., u being the sum.
  const Algebra& differential_inverse(const Algebra& k) {
    space_.bracket(sum_, k, inner_);
    space_.bracket(sum_, inner_, outer_);
    inner_ = k - inner_ * 0.5 + outer_ * (1.0 / 12);
    return inner_;
  }

  template <class F> void in_coordinates(F& field, double t, double h, Point& z) {
    for (int i = 0; i < method_.stages; ++i) {
      Point& at = stage_[0];
      at = z;
      add(method_.a[std::size_t(i)], h, i, at);
      field(t + method_.node(i) * h, at, slope_[0]);
      space_.generator(slope_[0], at, velocity_[std::size_t(i)]);
    }
    add(method_.b, h, method_.stages, z);
  }
  void add(const LieGroupMethod::Row& weights, double h, int stages, Point& z) const {
    for (int j = 0; j < stages; ++j)
      if (const double w = weights[std::size_t(j)]; w != 0) z += velocity_[std::size_t(j)] * (h * w);
  }

  static double largest(const Algebra& u) {
    double most = 0;
    for (Eigen::Index i = 0; i < u.size(); ++i) {
      const double x = std::abs(double(value_of(u.data()[i])));
      if (!(x <= most)) most = x;
    }
    return most;
  }

  M space_;
  LieGroupMethod method_;
  std::array<Algebra, LieGroupMethod::most_stages> slope_;
  std::array<Point, LieGroupMethod::most_stages> velocity_;
  std::array<Point, LieGroupMethod::most_stages> stage_;
  Algebra sum_, inner_, outer_;
  double error_ = 0;
  bool knows_first_ = false;
};

}  // namespace lagroid
