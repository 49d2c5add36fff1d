#pragma once
/// A Lagrangian on R^n whose n is known when it runs: l(t, q, v), constraints C(q) = 0 and forces F(t, q, v), with
/// their derivatives, behind virtual functions.
///
/// Lagrangians that a scene writes are none of a type, and what steps them is compiled once (curve_step.hpp).
///
///     class Drop final : public SizedLagrangian {
///      public:
///       Drop() : SizedLagrangian({1, 0, false}) {}
///       void lagrangian(double, const double* q, const double* v, double* out) const override {
///         const double all[] = {v[0] * v[0] / 2 - q[0], -1, v[0], 0, 0, 1};  // l; l_q, l_v; by (q, q), (q, v), (v, v)
///         std::copy_n(all, 6, out);
///       }
///     };
///
/// Results are written to the last argument. Nothing throws.

#include <lagroid/core/derivatives/second_order.hpp>

#include <cstddef>

namespace lagroid {

class SizedLagrangian {
 public:
  struct Sizes {
    int dimension = 1;    ///< n
    int constraints = 0;  ///< k
    bool forced = false;
    int parameters = 0;  ///< by which there are derivatives
  };
  explicit SizedLagrangian(const Sizes& sizes) : sizes_(sizes) {}
  virtual ~SizedLagrangian() = default;
  const Sizes& sizes() const { return sizes_; }

  /// l with its derivatives by q and v, as SecondOrder has them (second_order.hpp).
  virtual void lagrangian(double t, const double* q, const double* v, double* out) const = 0;
  /// C with its derivatives by q: all of the first component, then of the next.
  virtual void constraint(const double* /*q*/, double* /*out*/) const {}
  /// F and its 2 n derivatives by q and v: all of the first component, then of the next.
  virtual void force(double /*t*/, const double* /*q*/, const double* /*v*/, double* /*out*/) const {}

  /// Of each parameter in turn the derivatives by it: of l, of its 2 n derivatives, and of the n components of F where
  /// there is a force.
  virtual void by_parameters(double /*t*/, const double* /*q*/, const double* /*v*/, double* /*out*/) const {}

  std::size_t lagrangian_numbers() const { return SecondOrder::count(2 * sizes_.dimension); }
  std::size_t constraint_numbers() const {
    return std::size_t(sizes_.constraints) * SecondOrder::count(sizes_.dimension);
  }
  std::size_t force_numbers() const {
    const std::size_t n = std::size_t(sizes_.dimension);
    return sizes_.forced ? n * (1 + 2 * n) : 0;
  }
  std::size_t parameter_numbers() const {
    const std::size_t n = std::size_t(sizes_.dimension);
    return std::size_t(sizes_.parameters) * (1 + 2 * n + (sizes_.forced ? n : 0));
  }

 private:
  Sizes sizes_;
};

}  // namespace lagroid
