#pragma once
/// A DiscreteSystem whose type holds its sizes alone, and which stands for any system of these sizes.
///
/// A solver that is a template of systems is then compiled once for all systems of equal sizes.
///
///     const auto sized = by_sizes(system);  // a copy, of type SizedSystemOf<Sys>
///     const double value = sized.lagrangian(g);  // g: the coordinates of an arrow, and zeros up to 16, 32, ...
///
/// Requires a variational system. Derivatives, and whatever else the system supplies, are its own to the bit; errors
/// too.

#include <lagroid/core/any_system/any_system_of.hpp>

#include <algorithm>
#include <bit>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace lagroid {

/// The groupoid of a SizedSystem: arrows and objects are the coordinates of those of another groupoid, followed by
/// zeros up to `Room` of them. It calls an AnySystem, which its owner keeps.
template <int N, int Room> class SizedGroupoid : public LieGroupoid<SizedGroupoid<N, Room>, N> {
 public:
  template <class S> using Arrow = Vector<S, Room>;
  template <class S> using Object = Vector<S, Room>;
  using Coordinates = Vector<double, Room>;
  using Fibre = Vector<double, N>;

  SizedGroupoid() = default;
  explicit SizedGroupoid(const AnySystem& system) : system_(&system) {}

  static std::string name() { return "a groupoid known by its sizes"; }
  Coordinates source(const Coordinates& g) const { return made(&AnySystem::source, g); }
  Coordinates target(const Coordinates& g) const { return made(&AnySystem::target, g); }
  Coordinates unit(const Coordinates& q) const { return made(&AnySystem::unit, q); }
  Coordinates inverse(const Coordinates& g) const { return made(&AnySystem::inverse, g); }
  Coordinates project(const Coordinates& g) const { return made(&AnySystem::project, g); }
  Coordinates multiply(const Coordinates& g, const Coordinates& h) const { return made(&AnySystem::multiply, g, h); }
  Coordinates compose(const Coordinates& g, const Coordinates& h) const { return made(&AnySystem::compose, g, h); }
  Coordinates tau(const Coordinates& q, const Fibre& v) const { return made(&AnySystem::tau, q, v); }
  Coordinates extend(const Coordinates& g, const Fibre& w) const { return made(&AnySystem::extend, g, w); }
  Coordinates arrow_in_chart(const Coordinates& q, const Fibre& v) const {
    return made(&AnySystem::arrow_in_chart, q, v);
  }
  Coordinates left_invariant(const Coordinates& g, const Fibre& x) const {
    return made(&AnySystem::left_invariant, g, x);
  }
  Coordinates anchor(const Coordinates& q, const Fibre& x) const { return made(&AnySystem::anchor, q, x); }
  Fibre tau_inverse(const Coordinates& g) const { return along_fibre(&AnySystem::tau_inverse, g); }
  Fibre chart(const Coordinates& g) const { return along_fibre(&AnySystem::chart, g); }
  Fibre coordinate_scale(const Coordinates& g) const { return along_fibre(&AnySystem::coordinate_scale, g); }
  Fibre correct(Coordinates& g, const Fibre& w) const {
    Fibre left;
    system_->correct(g.data(), w.data(), left.data());
    return left;
  }
  void displace_next(const Coordinates& g, const Fibre& v, Coordinates& back, Coordinates& moved,
                     Coordinates& product) const {
    moved.setZero();
    system_->displace_next(g.data(), v.data(), back.data(), moved.data(), product.data());
  }
  Fibre momentum_change(const Coordinates& g, const Fibre& source_gradient, const Fibre& target_gradient) const {
    Fibre change;
    system_->momentum_change(g.data(), source_gradient.data(), target_gradient.data(), change.data());
    return change;
  }

 private:
  template <class... X> Coordinates made(void (AnySystem::*by)(X...) const, const auto&... from) const {
    Coordinates out = Coordinates::Zero();
    (system_->*by)(from.data()..., out.data());
    return out;
  }
  Fibre along_fibre(void (AnySystem::*by)(const double*, double*) const, const Coordinates& g) const {
    Fibre out;
    (system_->*by)(g.data(), out.data());
    return out;
  }

  const AnySystem* system_ = nullptr;
};

/// Any system with n = `N`, so many constraints and at most `Room` coordinates of an arrow or an object, as a
/// DiscreteSystem: what a solver makes of it serves all systems of these sizes, whatever they are. Derivatives, and all
/// else that a system may write itself, are those of the system it holds, to the bit.
template <int N, int ArrowConstraints, int ObjectConstraints, int Room>
class SizedSystem : public System<SizedSystem<N, ArrowConstraints, ObjectConstraints, Room>, SizedGroupoid<N, Room>,
                                  ArrowConstraints, ObjectConstraints> {
  using Base = System<SizedSystem, SizedGroupoid<N, Room>, ArrowConstraints, ObjectConstraints>;

 public:
  using Multipliers = typename Base::Multipliers;
  using Coordinates = Vector<double, Room>;
  using Asked = AnySystemSized<N, ArrowConstraints, ObjectConstraints>;

  explicit SizedSystem(std::unique_ptr<Asked> system) : system_(std::move(system)) {
    this->groupoid = SizedGroupoid<N, Room>(*system_);
  }
  SizedSystem(const SizedSystem& other) : SizedSystem(other.system_->clone_sized()) {}
  SizedSystem(SizedSystem&&) noexcept = default;
  SizedSystem& operator=(const SizedSystem& other) { return *this = SizedSystem(other); }
  SizedSystem& operator=(SizedSystem&&) noexcept = default;
  ~SizedSystem() = default;

  /// The system it holds.
  const Asked& asked() const { return *system_; }

  double lagrangian(const Coordinates& g) const { return system_->lagrangian(g.data()); }
  Vector<double, ArrowConstraints> constraint(const Coordinates& g) const requires(ArrowConstraints > 0) {
    Vector<double, ArrowConstraints> phi;
    system_->arrow_constraint(g.data(), phi.data());
    return phi;
  }
  Vector<double, ObjectConstraints> object_constraint(const Coordinates& q) const requires(ObjectConstraints > 0) {
    Vector<double, ObjectConstraints> c;
    system_->object_constraint(q.data(), c.data());
    return c;
  }
  Gradients<N, Base::constraints> gradients(const Coordinates& g, const Multipliers& lambda) const {
    return system_->gradients_at(g.data(), lambda);
  }
  TwoSided<N, Base::constraints> two_sided(const Coordinates& g, const Multipliers& lambda) const {
    return system_->two_sided_at(g.data(), lambda);
  }
  SecondDerivatives<N, Base::constraints> second_derivatives(const Coordinates& g, const Multipliers& lambda) const {
    return system_->second_derivatives_at(g.data(), lambda);
  }
  Matrix<double, N, N> gradient_derivative(const Coordinates& g, const Multipliers& lambda, End end) const {
    Matrix<double, N, N> out;
    system_->gradient_derivative(g.data(), lambda.data(), end, out.data());
    return out;
  }
  bool admissible(const Coordinates& g) const { return system_->admissible(g.data()); }
  bool has_time_step() const { return system_->has_time_step(); }
  double time_step() const { return system_->time_step(); }
  void set_time_step(double h) { system_->set_time_step(h); }

  Step<SizedSystem> first_guess(const State<SizedGroupoid<N, Room>>& state) const {
    Step<SizedSystem> out{Coordinates::Zero(), Multipliers()};
    system_->first_guess(state.object.data(), state.momentum.data(), out.arrow.data(), out.multipliers.data());
    return out;
  }
  std::vector<Coordinates> path(const Coordinates& boundary, long steps) const {
    const auto numbers = system_->path(boundary.data(), steps);
    const auto count = std::size_t(system_->sizes().arrow_coordinates);
    std::vector<Coordinates> out(numbers.size() / count, Coordinates::Zero());
    for (std::size_t k = 0; k < out.size(); ++k) std::copy_n(numbers.begin() + long(k * count), count, out[k].data());
    return out;
  }
  int loop_count() const { return system_->sizes().loops; }
  Coordinates loop(const Coordinates& q, const Vector<double, N>& axis, const Eigen::VectorXd& turns) const {
    Coordinates out = Coordinates::Zero();
    system_->loop(q.data(), axis.data(), turns.data(), out.data());
    return out;
  }

 private:
  std::unique_ptr<Asked> system_;
};

/// Room for the coordinates of a groupoid: 16, 32, 64, ... of them, so that most groupoids need the same.
template <class G>
inline constexpr int coordinate_room =
    int(std::max(16U, std::bit_ceil(unsigned(std::max(G::arrow_coordinate_count(), G::object_coordinate_count())))));

/// What is left of a system when its sizes alone are known.
template <DiscreteSystem Sys>
using SizedSystemOf = SizedSystem<Sys::dimension, Sys::arrow_constraints, Sys::object_constraints,
                                  coordinate_room<typename Sys::GroupoidType>>;

/// A copy of the system, for algorithms that are compiled for its sizes. (It must be variational: forces and reactions
/// would be in its derivatives, but SizedSystem has no functions that return them.)
template <DiscreteSystem Sys>
requires Variational<Sys> SizedSystemOf<Sys> by_sizes(const Sys& system) {
  return SizedSystemOf<Sys>(std::make_unique<AnySystemOf<Sys>>(system));
}

}  // namespace lagroid
