#pragma once
/// Square equations r(g, lambda) = 0 on a source fibre, of sizes known at run time, as a least-squares problem for
/// Ceres. CeresStep solves its steps through it, so that no header of a step includes Ceres and the bridge is compiled
/// once.

#include <memory>

namespace lagroid {

/// Square equations r(g, lambda) = 0 for a point g of a source fibre, in arrow coordinates, and multipliers lambda.
/// Matrices are written by columns. Functions return false where a result is not finite.
class FibreEquations {
 public:
  struct Sizes {
    int ambient;      ///< coordinates of an arrow
    int tangent;      ///< dimension of the fibre
    int multipliers;  ///< as many unknowns beside it; the equations are tangent + multipliers
  };

  virtual ~FibreEquations() = default;
  virtual Sizes sizes() const = 0;
  virtual bool plus(const double* g, const double* w, double* out) const = 0;  ///< g tau(w)
  virtual void frame(const double* g, double* matrix) const = 0;               ///< d plus(g, w) / dw at w = 0
  /// The residual and its derivatives by (w, lambda) at w = 0.
  virtual bool evaluate(const double* g, const double* multipliers, double* residual, double* jacobian) const = 0;
};

/// The equations as a Ceres problem of least squares, which is built once and solved as often as one likes.
class FibreProblem {
 public:
  /// `equations` is kept by whoever owns this.
  FibreProblem(const FibreEquations& equations, int max_iterations);
  ~FibreProblem();
  FibreProblem(const FibreProblem&) = delete;
  FibreProblem& operator=(const FibreProblem&) = delete;

  /// From the point that is given to the best that Ceres comes to, and the iterations it took. Whether that is a
  /// solution is for the caller to find out.
  int solve(double* arrow, double* multipliers);

 private:
  struct Work;
  std::unique_ptr<Work> work_;
};

}  // namespace lagroid
