#pragma once
/// Homogeneous spaces made of groups: a matrix group acting on itself, GL(N) acting on matrices, R^N on itself by
/// addition.
///
/// Integrators for homogeneous spaces then serve motions on groups, linear systems Y' = A(t) Y, and classical vector
/// fields.
///
///     const Translations<SO3> space;
///     Matrix<double, 3, 3> g = Matrix<double, 3, 3>::Identity();
///     space.act(Vector<double, 3>(0.1, 0, 0), g);  // exp(u) g
///
/// Nothing throws.

#include <lagroid/groupoids/groups/matrix_group.hpp>

#include <unsupported/Eigen/MatrixFunctions>

#include <string>

namespace lagroid {

/// A matrix group acting on itself from the left, exp(u) g; u_M(g) = hat(u) g.
template <class Group> struct Translations {
  using Point = typename Group::template Arrow<double>;
  using Algebra = Vector<double, Group::dimension>;

  Point zero_point() const { return Point::Zero(); }
  Algebra zero_algebra() const { return Algebra::Zero(); }
  void act(const Algebra& u, Point& g) const { g = (Group::exp(u) * g).eval(); }
  void generator(const Algebra& u, const Point& g, Point& v) const { v = (Group::hat(u) * g).eval(); }
  void bracket(const Algebra& u, const Algebra& v, Algebra& w) const { w = (Group::template ad<double>(u) * v).eval(); }
  void project(Point& g) const { g = Group::project(g); }
  std::string name() const { return Group::name() + " on itself"; }
};

/// GL(N) acting on N x Columns matrices, exp(A) Y: the space of linear systems Y' = A(t) Y.
template <int N, int Columns = 1> struct LinearAction {
  using Point = Matrix<double, N, Columns>;
  using Algebra = Matrix<double, N, N>;

  Point zero_point() const { return Point::Zero(); }
  Algebra zero_algebra() const { return Algebra::Zero(); }
  void act(const Algebra& a, Point& y) const { y = (a.exp() * y).eval(); }
  void generator(const Algebra& a, const Point& y, Point& v) const { v = (a * y).eval(); }
  void bracket(const Algebra& a, const Algebra& b, Algebra& w) const { w = (a * b - b * a).eval(); }
  void project(Point&) const {}
  std::string name() const { return "GL(" + std::to_string(N) + ") on matrices"; }
};

/// R^N acting on itself by addition: methods for homogeneous spaces are then the classical ones.
template <int N> struct EuclideanSpace {
  using Point = Vector<double, N>;
  using Algebra = Vector<double, N>;

  Point zero_point() const { return Point::Zero(); }
  Algebra zero_algebra() const { return Algebra::Zero(); }
  void act(const Algebra& u, Point& z) const { z += u; }
  void generator(const Algebra& u, const Point&, Point& v) const { v = u; }
  void bracket(const Algebra&, const Algebra&, Algebra& w) const { w.setZero(); }
  void project(Point&) const {}
  std::string name() const { return "R^" + std::to_string(N); }
};

}  // namespace lagroid
