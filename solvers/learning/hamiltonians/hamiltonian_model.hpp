#pragma once
/// The model of any Hamiltonian on R^2n or on T*Q: a class that writes H(q, p; theta), separable or not, and a
/// constraint if Q is not R^n, becomes a Model, with trajectories and their exact derivatives in theta.
///
///     struct Rotor {  // H = theta_0 p^2 + theta_1 p^2 cos q
///       int size() const { return 2; }
///       template <class S, class T>
///       S hamiltonian(const Vector<S, 1>& q, const Vector<S, 1>& p, const T* theta) const {
///         using std::cos;
///         return p(0) * p(0) * (S(theta[0]) + S(theta[1]) * cos(q(0)));
///       }
///     };
///     inline const learning::HamiltonianModel<Rotor, 1> model("rotor", Rotor{});
///     inline const learning::HamiltonianModel<Rotor, 1> damped("rotor", Rotor{}, 1, learning::Dissipation::rayleigh);
///
/// Requires a ParametricHamiltonian, as Polynomial and Network are, or what inherits one and adds a constraint.

#include <lagroid/solvers/learning/field_model.hpp>
#include <lagroid/solvers/learning/hamiltonians/hamiltonian_equations.hpp>

#include <cstddef>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

namespace lagroid::learning {

/// HamiltonianEquations of one Hamiltonian, for each scalar.
template <class H, int N> struct HamiltonianFields {
  template <class S> using Field = HamiltonianEquations<H, N, S>;
  static constexpr int lanes = lanes_of<N>;
  static constexpr bool projected = constraints_of<H, N>() > 0;

  H hamiltonian;
  int coordinates;
  Dissipation dissipation;

  RayleighDissipation<N> rayleigh() const { return {coordinates, dissipation}; }
  int size() const { return hamiltonian.size() + rayleigh().size(); }
  template <class S> Field<S> field() const { return Field<S>(hamiltonian, coordinates, dissipation); }
};

/// Compiles a ParametricHamiltonian into a Model. N is n, or Eigen::Dynamic. With constraints, each step ends on T*Q
/// (CotangentBundle).
///
/// `start` takes the Hamiltonian's own start(seed) where it has one; else its parameters begin at zero. Throws
/// std::invalid_argument for a number of coordinates that is none or does not fit.
template <class H, int N> class HamiltonianModel : public FieldModel<HamiltonianFields<H, N>> {
  static_assert(ParametricHamiltonian<H, N>,
                "the Hamiltonian has int size() const and a const template hamiltonian(q, p, theta), or gradient and "
                "scratch in its place and not both; see ParametricHamiltonian");
  using Base = FieldModel<HamiltonianFields<H, N>>;

 public:
  HamiltonianModel(std::string name, H hamiltonian, int coordinates = N, Dissipation dissipation = Dissipation::none)
      : Base(std::move(name), {std::move(hamiltonian), coordinates, dissipation}) {
    bool fits = coordinates >= 1 && (N == Eigen::Dynamic || coordinates == N);
    if constexpr (requires { this->hamiltonian().inputs(); }) fits &= this->hamiltonian().inputs() == 2 * coordinates;
    if (!fits)
      throw std::invalid_argument(
          "a model of a Hamiltonian has coordinates, as many as its type says, and a function of twice as many "
          "numbers");
  }

  const H& hamiltonian() const { return this->fields().hamiltonian; }

  StateSpace space() const override {
    const auto& [hamiltonian, coordinates, dissipation] = this->fields();
    StateSpace out = phase_space(coordinates);
    if constexpr (HamiltonianFields<H, N>::projected) {
      using Bundle = CotangentBundle<H, N>;
      out.dimension -= 2 * Bundle::constraints;
      out.project = [bundle = Bundle(hamiltonian)](Eigen::Ref<Eigen::VectorXd> z) {
        typename Bundle::Point at = z;
        // What is off by its noise takes Newton's method some steps; on T*Q they move nothing.
        for (int time = 0; time < 10; ++time) bundle.project(at);
        z = at;
      };
    }
    return out;
  }

  std::string formula(const Eigen::VectorXd& theta, std::span<const std::string> names,
                      std::size_t longest) const override {
    if constexpr (requires { hamiltonian().formula(theta, names, longest); }) {
      return hamiltonian().formula(theta, names, longest);
    } else {
      return {};
    }
  }

  Eigen::VectorXd start(unsigned seed) const override {
    const H& hamiltonian = this->hamiltonian();
    Eigen::VectorXd theta = Eigen::VectorXd::Zero(this->size());
    if constexpr (requires { hamiltonian.start(seed); }) theta.head(hamiltonian.size()) = hamiltonian.start(seed);
    const Eigen::VectorXd damping = this->fields().rayleigh().start(seed);
    theta.tail(damping.size()) = damping;
    return theta;
  }
};

}  // namespace lagroid::learning
