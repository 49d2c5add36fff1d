#include <lagroid/solvers/newton/crouch_grossman.hpp>

#include <numbers>

namespace lagroid {

CrouchGrossman CrouchGrossman::implicit_euler() {
  return {"implicit Euler", 1, false, Eigen::MatrixXd{{1}}, Eigen::VectorXd{{1}}};
}

CrouchGrossman CrouchGrossman::implicit_midpoint() {
  return {"implicit midpoint", 2, true, Eigen::MatrixXd{{0.5}}, Eigen::VectorXd{{1}}};
}

CrouchGrossman CrouchGrossman::dirk2() {
  const double g = 1 - 0.5 * std::numbers::sqrt2;
  return {"DIRK of order 2", 2, false, Eigen::MatrixXd{{g, 0}, {1 - g, g}}, Eigen::VectorXd{{1 - g, g}}};
}

CrouchGrossman CrouchGrossman::dirk3() {
  // c_2 is where the weights of the quadrature with the nodes c satisfy the condition of the bracket; a_32 then follows
  // from b^T a c = 1/6.
  const double g = 0.4358665215084589994160;
  const double a32 = 0.5771502755978950235597;
  const Eigen::VectorXd b{{-0.1380176424757298907068, 0.5397062364249985615239, 0.5983114060507313291830}};
  return {"DIRK of order 3", 3, false,
          Eigen::MatrixXd{{g, 0, 0}, {0.2064525248637371753766 - g, g, 0}, {0.75 - g - a32, a32, g}}, b};
}

}  // namespace lagroid
