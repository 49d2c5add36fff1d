#pragma once
/// Any typed system as an AnySystem.
///
///     const AnySystemOf<Sys> any(system);  // holds a copy
///     const double value = any.lagrangian(g.data());
///
/// Every function calls that of the system or its groupoid, so that what they supply in place of a default is used.
/// Errors are theirs.

#include <lagroid/core/any_system/any_system_sized.hpp>
#include <lagroid/core/capabilities/loops.hpp>
#include <lagroid/core/derivatives/displaced_arrow.hpp>
#include <lagroid/core/derivatives/gradient_derivative.hpp>

#include <utility>

namespace lagroid {

/// `Sys` as an AnySystem.
template <DiscreteSystem Sys>
class AnySystemOf final : public AnySystemSized<Sys::dimension, Sys::arrow_constraints, Sys::object_constraints> {
 public:
  using Sized = AnySystemSized<Sys::dimension, Sys::arrow_constraints, Sys::object_constraints>;
  using G = typename Sys::GroupoidType;
  using Arrow = ArrowOf<G>;
  using Object = ObjectOf<G>;
  using Fibre = AlgebroidVector<G>;
  using Multipliers = typename Sys::Multipliers;
  static constexpr int n = Sys::dimension;
  static constexpr int m = Sys::constraints;
  static constexpr int arrow_coordinates = G::arrow_coordinate_count();
  static constexpr int object_coordinates = G::object_coordinate_count();

  explicit AnySystemOf(Sys system)
      : Sized(arrow_coordinates, object_coordinates, detail::windings<Sys>), system_(std::move(system)) {}

  const Sys& system() const { return system_; }

  std::unique_ptr<Sized> clone_sized() const override { return std::make_unique<AnySystemOf>(system_); }

  // ---- numbers as arrows and objects, and back

  static Arrow arrow(const Sys& system, const double* x) {
    return system.groupoid.template arrow_at<double>(vector<arrow_coordinates>(x));
  }
  static void put_arrow(const Sys& system, const Arrow& g, double* x) {
    put<arrow_coordinates>(system.groupoid.coordinates_of_arrow(g), x);
  }

  // ---- the groupoid

  std::string groupoid_name() const override { return G::name(); }
  void source(const double* g, double* q) const override { put_object(groupoid().source(arrow(g)), q); }
  void target(const double* g, double* q) const override { put_object(groupoid().target(arrow(g)), q); }
  void unit(const double* q, double* g) const override { put_arrow(groupoid().unit(object(q)), g); }
  void inverse(const double* g, double* out) const override { put_arrow(groupoid().inverse(arrow(g)), out); }
  void multiply(const double* g, const double* h, double* out) const override {
    put_arrow(groupoid().multiply(arrow(g), arrow(h)), out);
  }
  void compose(const double* g, const double* h, double* out) const override {
    put_arrow(groupoid().compose(arrow(g), arrow(h)), out);
  }
  void tau(const double* q, const double* v, double* g) const override {
    put_arrow(groupoid().tau(object(q), fibre(v)), g);
  }
  void tau_inverse(const double* g, double* v) const override { put<n>(groupoid().tau_inverse(arrow(g)), v); }
  void project(const double* g, double* out) const override { put_arrow(groupoid().project(arrow(g)), out); }
  void extend(const double* g, const double* w, double* out) const override {
    put_arrow(groupoid().extend(arrow(g), fibre(w)), out);
  }
  void correct(double* g, const double* w, double* left) const override {
    Arrow moved = arrow(g);
    put<n>(groupoid().correct(moved, fibre(w)), left);
    put_arrow(moved, g);
  }
  void momentum_change(const double* g, const double* source_gradient, const double* target_gradient,
                       double* change) const override {
    put<n>(groupoid().momentum_change(arrow(g), fibre(source_gradient), fibre(target_gradient)), change);
  }
  void chart(const double* g, double* v) const override { put<n>(groupoid().chart(arrow(g)), v); }
  void arrow_in_chart(const double* q, const double* v, double* g) const override {
    put_arrow(groupoid().arrow_in_chart(object(q), fibre(v)), g);
  }
  void coordinate_scale(const double* g, double* scale) const override {
    put<n>(groupoid().coordinate_scale(arrow(g)), scale);
  }
  void left_invariant(const double* g, const double* x, double* tangent) const override {
    put<arrow_coordinates>(groupoid().left_invariant(arrow(g), fibre(x)), tangent);
  }
  void anchor(const double* q, const double* x, double* tangent) const override {
    if constexpr (object_coordinates > 0) put<object_coordinates>(groupoid().anchor(object(q), fibre(x)), tangent);
  }
  void displace_next(const double* g, const double* v, double* back, double* moved, double* product) const override {
    Arrow before = arrow(back);
    Arrow reached = arrow(product);
    Arrow there;
    lagroid::displace_next(groupoid(), arrow(g), fibre(v), before, there, reached);
    put_arrow(before, back);
    put_arrow(there, moved);
    put_arrow(reached, product);
  }

  // ---- the system

  double lagrangian(const double* g) const override { return system_.lagrangian(arrow(g)); }
  void arrow_constraint(const double* g, double* phi) const override {
    if constexpr (Sys::arrow_constraints > 0) put<Sys::arrow_constraints>(system_.constraint(arrow(g)), phi);
  }
  void object_constraint(const double* q, double* c) const override {
    if constexpr (Sys::object_constraints > 0) put<Sys::object_constraints>(system_.object_constraint(object(q)), c);
  }
  GradientsOf<Sys> gradients_at(const double* g, const Multipliers& lambda) const override {
    return lagroid::gradients(system_, arrow(g), lambda);
  }
  TwoSidedOf<Sys> two_sided_at(const double* g, const Multipliers& lambda) const override {
    return lagroid::two_sided(system_, arrow(g), lambda);
  }
  SecondDerivativesOf<Sys> second_derivatives_at(const double* g, const Multipliers& lambda) const override {
    return lagroid::second_derivatives(system_, arrow(g), lambda);
  }
  void gradient_derivative(const double* g, const double* multipliers, End end, double* out) const override {
    put<n, n>(lagroid::gradient_derivative(system_, arrow(g), vector<m>(multipliers), end), out);
  }
  bool admissible(const double* g) const override {
    if constexpr (HasBranch<Sys>) {
      return system_.admissible(arrow(g));
    } else {
      return true;
    }
  }
  bool has_time_step() const override { return lagroid::has_time_step(system_); }
  double time_step() const override { return lagroid::time_step(system_); }
  void set_time_step(double h) override { lagroid::set_time_step(system_, h); }

  // ---- where solves and searches start

  void first_guess(const double* q, const double* momentum, double* g, double* multipliers) const override {
    Step<Sys> guess;
    if constexpr (HasFirstGuess<Sys>) {
      guess = system_.first_guess(State<G>{object(q), fibre(momentum)});
    } else {
      guess = {groupoid().unit(object(q)), Multipliers::Zero()};
    }
    put_arrow(guess.arrow, g);
    put<m>(guess.multipliers, multipliers);
  }
  std::vector<double> path(const double* boundary, long steps) const override {
    std::vector<double> out;
    if constexpr (HasPath<Sys>) {
      const auto arrows = system_.path(arrow(boundary), steps);
      out.resize(arrows.size() * arrow_coordinates);
      for (std::size_t k = 0; k < arrows.size(); ++k) put_arrow(arrows[k], out.data() + k * arrow_coordinates);
    }
    return out;
  }
  void loop(const double* q, const double* axis, const double* turns, double* g) const override {
    if constexpr (constexpr int loops = detail::windings<Sys>; loops > 0)
      put_arrow(detail::winder(system_).loop(object(q), fibre(axis), vector<loops>(turns)), g);
  }

 private:
  template <int Count> static Vector<double, Count> vector(const double* x) {
    return Eigen::Map<const Vector<double, Count>>(x);
  }
  template <int Rows, int Columns = 1, class X> static void put(const X& from, double* to) {
    Eigen::Map<Matrix<double, Rows, Columns>> map(to);
    map = from;
  }
  static Fibre fibre(const double* v) { return vector<n>(v); }

  const G& groupoid() const { return system_.groupoid; }
  Arrow arrow(const double* x) const { return arrow(system_, x); }
  void put_arrow(const Arrow& g, double* x) const { put_arrow(system_, g, x); }
  Object object(const double* x) const { return groupoid().template object_at<double>(vector<object_coordinates>(x)); }
  void put_object(const Object& q, double* x) const { put<object_coordinates>(groupoid().coordinates_of_object(q), x); }

  Sys system_;
};

}  // namespace lagroid
