#pragma once
/// Constrained mechanics and optimal control on a matrix group: a Lagrangian or cost l(xi) and constraints psi(xi) = 0
/// on the body velocity xi, A' = A hat(xi), discretised as
///
///     L(g) = h l(xi),    phi(g) = h psi(xi),    xi = tau^{-1}(g) / h,    tau = exp or cay.
///
/// A problem is two formulas on the Lie algebra; energy, first guess and reference follow from a third.
///
///     struct Sled : GroupControl<Sled, SE2, 1> {
///       template <class S> S l(const Vector<S, 3>& xi) const { return xi.squaredNorm() * 0.5; }
///       template <class S> Vector<S, 1> psi(const Vector<S, 3>& xi) const { return Vector<S, 1>(xi(2)); }
///     };
///
/// Requires l and, if there are constraints, psi over any scalar. `energy` and `reference` require `control`, the
/// inverse of the Legendre transform. [G] 6.1

#include <lagroid/core/capabilities/observed_numbers.hpp>
#include <lagroid/core/parameter.hpp>
#include <lagroid/core/quantity.hpp>
#include <lagroid/core/scalars/varied.hpp>
#include <lagroid/groupoids/groups/matrix_group.hpp>
#include <lagroid/systems/reference.hpp>

#include <concepts>
#include <string>
#include <vector>

namespace lagroid {

/// A velocity xi in the Lie algebra with the multipliers of its constraints.
template <int Dimension, int Constraints> struct Control {
  Vector<double, Dimension> velocity;
  Vector<double, Constraints> multipliers;
};

/// Whether a system writes `control` (see GroupControl).
template <class Sys>
concept HasControl = requires(const Sys& system, const Vector<double, Sys::dimension>& mu) {
  { system.control(mu) } -> std::same_as<Control<Sys::dimension, Sys::constraints>>;
};

/// Base of systems on a matrix group G with a Lagrangian, or cost, l(xi) and constraints psi(xi) = 0 on the body
/// velocity xi, A' = A hat(xi). Their discretisation, with tau = exp or cay, is
///
///     L(g) = h l(xi),    phi(g) = h psi(xi),    xi = tau^{-1}(g) / h.
///
/// The factor h makes lambda the multiplier of the continuous problem, mu = dl(xi) + <lambda, dpsi(xi)> as h -> 0.
///
/// The derived class writes, as templates on the scalar S,
///
///     S l(const Vector<S, n>& xi) const
///     Vector<S, Constraints> psi(const Vector<S, n>& xi) const            if there are any
///
/// and may write the inverse of the Legendre transform, which `energy` and `reference` need:
///
///     Control<n, Constraints> control(const Vector<double, n>& mu) const
///         (xi, lambda) with dl(xi) + <lambda, dpsi(xi)> = mu, psi(xi) = 0
template <class Derived, class G, int Constraints = 0> class GroupControl : public System<Derived, G, Constraints> {
 public:
  static constexpr int dimension = G::dimension;
  template <class S> using Algebra = Vector<S, dimension>;
  template <class S> using Element = Matrix<S, G::matrix_size, G::matrix_size>;

  double h = 0.01;
  Retraction map = Retraction::exponential;  ///< tau

  static constexpr auto map_parameter(std::string_view name = "map",
                                      std::string_view meaning = "how a motion becomes a velocity") {
    return choice(name, &GroupControl::map, retraction_words, meaning);
  }

  /// xi = tau^{-1}(g) / h.
  template <class S, class T> Algebra<S> velocity(const Element<S>& g, const T& step) const {
    const Algebra<S> v = G::retract_inverse(map, g);
    return v * (1 / step);
  }
  template <class S> Algebra<S> velocity(const Element<S>& g) const { return velocity(g, h); }
  /// tau(h xi).
  Element<double> arrow(const Algebra<double>& xi) const { return G::retract(map, Algebra<double>(h * xi)); }

  template <class S, class T> S lagrangian(const Element<S>& g, const T& step) const {
    return self().l(velocity(g, step)) * step;
  }
  template <class S> S lagrangian(const Element<S>& g) const { return lagrangian(g, h); }
  template <class S, class T>
  Vector<S, Constraints> constraint(const Element<S>& g, const T& step) const requires(Constraints > 0) {
    return self().psi(velocity(g, step)) * step;
  }
  template <class S> Vector<S, Constraints> constraint(const Element<S>& g) const requires(Constraints > 0) {
    return constraint(g, h);
  }

  /// <mu, xi> - l(xi) at xi = xi(mu): the Hamiltonian of the continuous problem (Pontryagin).
  double energy(const State<G>& s) const {
    const Algebra<double> xi = self().control(s.momentum).velocity;
    return s.momentum.dot(xi) - self().l(xi);
  }

  /// tau(h xi(mu)), exact to second order in h; the unit arrow where there is no `control`.
  Step<Derived> first_guess(const State<G>& s) const {
    if constexpr (HasControl<Derived>) {
      const auto [xi, lambda] = self().control(s.momentum);
      return {arrow(xi), lambda};
    } else {
      return {G::unit(s.object), Vector<double, Constraints>::Zero()};
    }
  }

  /// The continuous solution after time t: mu' = ad_xi^T mu, A' = A hat(xi) at xi = xi(mu). Returns mu and updates
  /// `configuration`.
  State<G> reference(const State<G>& start, Element<double>& configuration, double t) const {
    constexpr int n = dimension;
    constexpr int size = G::matrix_size;
    Eigen::VectorXd y(n + size * size);
    y << start.momentum, configuration.reshaped();
    y = integrate_reference(
        [this](const Eigen::VectorXd& at, Eigen::VectorXd& out) {
          const Algebra<double> mu = at.head<n>();
          const Algebra<double> xi = self().control(mu).velocity;
          out.head<n>() = G::template ad<double>(xi).transpose() * mu;
          out.tail<size * size>() = (at.tail<size * size>().reshaped(size, size) * G::hat(xi)).reshaped();
        },
        y, t);
    configuration = G::project(Element<double>(y.tail<size * size>().reshaped(size, size)));
    return {{}, y.head<n>()};
  }

  /// Ad*_{A^{-1}} mu, conserved because L and phi depend on the arrow alone; and the energy, where there is a
  /// `control`.
  std::vector<Quantity<Derived>> quantities() const {
    using Point = TrajectoryPoint<Derived>;
    const auto to_space = [](const Point& p) -> Matrix<double, dimension, dimension> {
      return G::adjoint(G::inverse(p.configuration)).transpose();
    };
    std::vector<std::string> labels;
    for (int i = 1; i <= dimension; ++i) labels.push_back(std::string("J").append(std::to_string(i)));
    std::vector<Quantity<Derived>> all;
    if constexpr (HasControl<Derived>)
      all.push_back({"energy", {"H"}, Promise::bounded, false, [system = self()](const Point& p, double* out) {
                       *out = system.energy(p.state);
                     }});
    all.push_back(
        {"spatial momentum", labels, Promise::conserved, false,
         [to_space](const Point& p, double* out) {
           Eigen::Map<Algebra<double>>(out).noalias() = to_space(p) * p.state.momentum;
         },
         [to_space](const Point& p) { return (to_space(p).cwiseAbs() * p.state.momentum.cwiseAbs()).norm(); }});
    return all;
  }

  static std::vector<ObservedName> observed_names() {
    std::vector<ObservedName> all;
    if constexpr (HasControl<Derived>) all.push_back({"H", "energy"});
    for (int i = 1; i <= dimension; ++i) all.push_back({"spatial momentum", "J" + std::to_string(i)});
    return all;
  }
  /// The energy is the extremal value of <mu, xi> - l(xi) - <lambda, psi(xi)>: with xi and lambda at hand its first
  /// derivatives are those of this expression where they stay (envelope theorem).
  template <class S> Vector<S, Eigen::Dynamic> observed(const State<G, S>& s, const Element<S>& configuration) const {
    constexpr int energies = HasControl<Derived> ? 1 : 0;
    Vector<S, Eigen::Dynamic> out(energies + dimension);
    if constexpr (HasControl<Derived>) {
      Algebra<double> mu;
      for (int i = 0; i < dimension; ++i) mu(i) = value_of(s.momentum(i));
      const auto [velocity, multipliers] = self().control(mu);
      const auto xi = with_entries_of<Algebra<S>>(velocity);
      out(0) = s.momentum.dot(xi) - self().l(xi);
      if constexpr (Constraints > 0) {
        const Vector<S, Constraints> psi = self().psi(xi);
        for (int i = 0; i < Constraints; ++i) out(0) -= psi(i) * multipliers(i);
      }
    }
    const Matrix<S, dimension, dimension> to_body = G::adjoint(G::inverse(configuration));
    out.template tail<dimension>() = to_body.transpose() * s.momentum;
    return out;
  }

 private:
  const Derived& self() const { return static_cast<const Derived&>(*this); }
};

}  // namespace lagroid
