#pragma once
/// Diagonally implicit Crouch-Grossman methods for y' = y g(y):
///
///     Y_i = y tau(h a_i1 K_1) ... tau(h a_ii K_i),    K_i = g(Y_i),    y+ = y tau(h b_1 K_1) ... tau(h b_s K_s).
///
/// Implicit methods of order one to three on a group, whose stages are solved for any h (arclength.hpp).
///
///     const GroupoidFibre<SO3> fibre(SO3::exp(Vector<double, 3>(0.4, -0.2, 0.9)));
///     const AutomaticField field(fibre, [](const auto& y) { return y.diagonal().eval(); });  // lie_differentials.hpp
///     LieIntegrator integrator(CrouchGrossman::dirk3(), fibre, field);
///     const LieStepReport report = integrator.advance(0.1);
///
/// Requires a lower triangular a (std::invalid_argument otherwise). `advance` returns the status of the stage that
/// failed, or `not_finite`, and then stays where it was. [N] section 6

#include <lagroid/solvers/step/arclength.hpp>

#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lagroid {

/// The coefficients of
///
///     Z_i = y tau(h a_i1 K_1) ... tau(h a_i,i-1 K_i-1),   Y_i = Z_i tau(h a_ii K_i),   K_i = g(Y_i)
///     y+  = y tau(h b_1 K_1) ... tau(h b_s K_s)
///
/// a is lower triangular; stages with a_ii = 0 are explicit. `order` is that on any group for tau = exp (up to order
/// two for any tau with tau(v)^{-1} = tau(-v)): the conditions on a and b are the classical ones and, for order three,
/// sum_{i<j} b_i b_j (c_j - c_i) = 1/6, which the bracket of K_i and K_j requires (Crouch and Grossman 1993, Owren and
/// Marthinsen 1999).
struct CrouchGrossman {
  std::string name;
  int order;
  bool symmetric;  ///< a step by h, then one by -h lead back
  Eigen::MatrixXd a;
  Eigen::VectorXd b;

  /// [N] (1.1).
  static CrouchGrossman implicit_euler();
  static CrouchGrossman implicit_midpoint();
  /// Two stages, L-stable on linear problems: a_ii = 1 - 1/sqrt(2).
  static CrouchGrossman dirk2();
  /// Three stages, L-stable on linear problems: a_ii = 0.4358665..., the root of x^3 - 3 x^2 + 3 x / 2 - 1/6; c_3 =
  /// 3/4, for which every other coefficient is below 0.6 in size. (Ours: no two stages satisfy the five conditions.)
  static CrouchGrossman dirk3();
  static std::vector<CrouchGrossman> all() { return {implicit_euler(), implicit_midpoint(), dirk2(), dirk3()}; }
};

/// How a step went. Where it did not converge, nothing advanced.
struct LieStepReport {
  SolveStatus status = SolveStatus::converged;
  long factorisations = 0;  ///< over the stages
  bool converged() const { return status == SolveStatus::converged; }
};

/// Integrates y' = y g(y), that is d/dt y = d/ds y tau(s g(y)) at s = 0, on a source fibre. On a Lie group that is the
/// group; on the fibre of an action groupoid, with g(y) = xi(target(y)), the targets solve m' = rho(xi(m)) on the
/// homogeneous space. `Field` is that of ImplicitStep.
template <SourceFibre F, class Field> class LieIntegrator {
 public:
  using Point = typename F::Point;
  using Vector = typename F::Vector;

  /// The centre of the fibre is where the integrator begins. Throws std::invalid_argument for a method whose matrix is
  /// not square, lower triangular and of as many rows as b.
  LieIntegrator(CrouchGrossman method, F fibre, Field field, ArclengthOptions options = {})
      : method_(std::move(method)), fibre_(std::move(fibre)), field_(std::move(field)), options_(options) {
    const auto stages = method_.b.size();
    if (method_.a.rows() != stages || method_.a.cols() != stages || !method_.a.isLowerTriangular(0))
      throw std::invalid_argument("LieIntegrator: a is no lower triangular matrix with a row for each entry of b");
  }

  const Point& y() const { return fibre_.centre(); }

  LieStepReport advance(double h) {
    LieStepReport report;
    std::vector<Vector> k;
    for (Eigen::Index i = 0; i < method_.b.size(); ++i) {
      Point y = moved(h * method_.a.row(i).head(i).transpose(), k);
      if (method_.a(i, i) != 0) {
        const auto stage =
            solve_implicit_step(ImplicitStep<F, Field>(fibre_.around(y), field_, h * method_.a(i, i)), options_);
        report.factorisations += stage.factorisations;
        report.status = stage.status;
        if (!report.converged()) return report;
        y = stage.y;
      }
      k.push_back(field_.g(y));
      if (!(h * k.back()).allFinite()) {
        report.status = SolveStatus::not_finite;
        return report;
      }
    }
    fibre_ = fibre_.around(moved(h * method_.b, k));
    return report;
  }

 private:
  /// y tau(c_1 K_1) tau(c_2 K_2) ...
  Point moved(const Eigen::VectorXd& c, const std::vector<Vector>& k) const {
    Point y = fibre_.centre();
    for (Eigen::Index j = 0; j < c.size(); ++j) y = fibre_.moved(y, typename Vector::Scalar(c(j)) * k[std::size_t(j)]);
    return y;
  }

  CrouchGrossman method_;
  F fibre_;
  Field field_;
  ArclengthOptions options_;
};

}  // namespace lagroid
