#pragma once
/// A rigid body with a rotor on each principal axis, a satellite with reaction wheels, on SO(3) x SO(2)^3:
///
///     l(w, t) = (w.I w + sum_i J_i (w_i + t_i)^2) / 2,    M = I w + j,  j_i = J_i (w_i + t_i),    M' = M x w,  j' = 0.
///
///     Gyrostat satellite;
///     Vector<double, 6> momentum;
///     momentum << 0.1, 1, 0.1, 0, 0, 0.5;  // (M, j)
///
/// Requires positive moments. (Marsden and Ratiu, Introduction to Mechanics and Symmetry, 15.11.)

#include <lagroid/core/capabilities/observed_numbers.hpp>
#include <lagroid/core/capabilities/rates_over.hpp>
#include <lagroid/core/capabilities/reductions.hpp>
#include <lagroid/core/derivatives/implicit.hpp>
#include <lagroid/core/noether.hpp>
#include <lagroid/groupoids/connections.hpp>
#include <lagroid/groupoids/groups/so2.hpp>
#include <lagroid/groupoids/product.hpp>
#include <lagroid/systems/control/rotation_map.hpp>
#include <lagroid/systems/instances.hpp>
#include <lagroid/systems/reference.hpp>

#include <cmath>
#include <numbers>
#include <type_traits>
#include <vector>

namespace lagroid {

/// Free motion about a fixed point of a body that carries a balanced rotor on each principal axis (a satellite with
/// reaction wheels; Marsden & Ratiu, Introduction to Mechanics and Symmetry, 15.11): with w the angular velocity of the
/// body, t_i the rate of rotor i against it, I the principal moments of the body with its rotors held fast to their
/// axes but free to turn, and J_i those of the rotors about their axes,
///
///     l(w, t) = (w.I w + sum_i J_i (w_i + t_i)^2) / 2,    L(g) = h l(tau^{-1}(g) / h)
///
/// on SO(3) x SO(2)^3, whose arrows are the turn of the body and those of the rotors against it. Momentum (M, j):
///
///     M = I w + j,    j_i = J_i (w_i + t_i);    M' = M x w,    j' = 0.
///
/// The rotors' momenta j and the spatial momentum A M are conserved, the energy by the continuous motion.
struct Gyrostat : System<Gyrostat, Product<SO3, SO2, SO2, SO2>> {
  using GroupoidType = Product<SO3, SO2, SO2, SO2>;

  double h = 0.01;
  Vector<double, 3> inertia{3, 2, 1};       ///< I, kg m^2
  Vector<double, 3> rotors{0.4, 0.3, 0.2};  ///< J, kg m^2
  RotationMap rotation = RotationMap::exponential;

  static auto parameters() {
    return std::tuple(inertia_parameter(&Gyrostat::inertia),
                      required(parameter("rotors", &Gyrostat::rotors, "kg m^2",
                                         "moments of the three rotors about their axes", positive)),
                      rotation_parameter(&Gyrostat::rotation));
  }

  template <class S, class T> S lagrangian(const Arrow<S>& g, const T& step) const {
    const auto& [turn, rotor1, rotor2, rotor3] = g;
    const Vector<S, 3> w = SO3::retract_inverse(rotation, turn);
    const Vector<S, 3> t(SO2::log(rotor1)(0), SO2::log(rotor2)(0), SO2::log(rotor3)(0));
    const auto& body = varied<S>(inertia);
    const auto& turning = varied<S>(rotors);
    S twice = w(0) * w(0) * body(0);
    for (int i = 1; i < 3; ++i) twice += w(i) * w(i) * body(i);
    for (int i = 0; i < 3; ++i) twice += (w(i) + t(i)) * (w(i) + t(i)) * turning(i);
    return twice * (0.5 / step);
  }
  template <class S> S lagrangian(const Arrow<S>& g) const { return lagrangian(g, h); }

  /// (w, t) of a momentum.
  template <class S = double> Vector<S, 6> velocity(const std::type_identity_t<Vector<S, 6>>& mu) const {
    const Vector<S, 3> j = mu.template tail<3>();
    const Vector<S, 3> w = (mu.template head<3>() - j).cwiseQuotient(varied<S>(inertia));
    const Vector<S, 3> t = j.cwiseQuotient(varied<S>(rotors)) - w;
    Vector<S, 6> v;
    v << w, t;
    return v;
  }

  /// ((M - j).I^{-1} (M - j) + j.J^{-1} j) / 2 = <(M, j), (w, t)> / 2.
  double energy(const State<GroupoidType>& s) const { return 0.5 * s.momentum.dot(velocity(s.momentum)); }

  template <class S = double> RatesOver<GroupoidType, S> rates(const State<GroupoidType, S>& s) const {
    const Vector<S, 6> v = velocity<S>(s.momentum);
    const Vector<S, 3> mu = s.momentum.template head<3>();
    const Vector<S, 3> w = v.template head<3>();
    Vector<S, 6> change = Vector<S, 6>::Constant(S(0.0));
    change.template head<3>() = mu.cross(w);
    return {v, change};
  }

  /// The turns at constant velocity.
  Step<Gyrostat> first_guess(const State<GroupoidType>& s) const {
    return {groupoid.tau(s.object, Vector<double, 6>(h * velocity(s.momentum))), {}};
  }

  /// The continuous solution after time t. Returns the momentum and updates the attitude; the rotors' angles follow
  /// from t' = J^{-1} j - w.
  State<GroupoidType> reference(const State<GroupoidType>& start, Matrix<double, 3, 3>& attitude, double t) const {
    const Vector<double, 3> j = start.momentum.tail<3>();
    // I w turns as a rigid body's momentum does, but for the rotors': (I w)' = (I w + j) x w.
    const Torque gyroscopic = [&](const auto& w, const auto&) { return Vector<double, 3>(j.cross(w)); };
    State<GroupoidType> end = start;
    const Vector<double, 3> body = start.momentum.head<3>() - j;
    end.momentum.head<3>() = reference_turn(inertia, gyroscopic, body, attitude, t) + j;
    return end;
  }

  /// Turning a rotor against the body.
  std::vector<Symmetry<Gyrostat>> symmetries() const {
    std::vector<Symmetry<Gyrostat>> all;
    for (int i = 0; i < 3; ++i)
      all.push_back({"momentum of rotor " + std::to_string(i + 1),
                     [i](const ObjectOf<GroupoidType>&) { return Vector<double, 6>(Vector<double, 6>::Unit(3 + i)); }});
    return all;
  }
  std::vector<Quantity<Gyrostat>> quantities() const {
    using Point = TrajectoryPoint<Gyrostat>;
    std::vector<Quantity<Gyrostat>> all{
        {"energy",
         {"H"},
         Promise::bounded,
         false,
         [system = *this](const Point& p, double* out) { *out = system.energy(p.state); }},
        {"spatial momentum A M", {"Jx", "Jy", "Jz"}, Promise::conserved, false, [](const Point& p, double* out) {
           Eigen::Map<Vector<double, 3>>(out).noalias() = std::get<0>(p.configuration) * p.state.momentum.head<3>();
         }}};
    for (const auto& symmetry : symmetries()) all.push_back(symmetry.quantity());
    return all;
  }
  static std::vector<ObservedName> observed_names() {
    std::vector<ObservedName> all{{"H", "energy"},
                                  {"spatial momentum A M", "Jx"},
                                  {"spatial momentum A M", "Jy"},
                                  {"spatial momentum A M", "Jz"}};
    for (const char* rotor : {"1", "2", "3"})
      all.push_back({"momenta of the rotors", std::string("momentum of rotor ") + rotor});
    for (const char* rate : {"w1", "w2", "w3", "t1", "t2", "t3"}) all.push_back({"rates", rate});
    return all;
  }
  template <class S> Vector<S, 13> observed(const State<GroupoidType, S>& s, const Arrow<S>& configuration) const {
    const Vector<S, 6> rates = velocity<S>(s.momentum);
    Vector<S, 13> out;
    out << s.momentum.dot(rates) * 0.5, Vector<S, 3>(std::get<0>(configuration) * s.momentum.template head<3>()),
        s.momentum.template tail<3>(), rates;
    return out;
  }
  using ByTheRotors = FactorConnection<Factors<1, 2, 3>, SO3, SO2, SO2, SO2>;
  static auto reductions() {
    return std::tuple(fixed_momentum("rotor-momenta", ByTheRotors{}, "the body alone turns"));
  }
  /// w.I w / (2 h) + j.w - h j.J^{-1} j / 2, where the rotors turn by t = h J^{-1} j - w. Not a number where one turns
  /// half round in a step, for no arrow has that momentum then.
  template <class S, class T>
  S routhian(const ByTheRotors&, const Matrix<S, 3, 3>& turn, const Vector<T, 3>& momenta) const {
    const Vector<S, 3> w = SO3::retract_inverse(rotation, turn);
    const auto& body = varied<S>(inertia);
    const auto& turning = varied<S>(rotors);
    S twice = w(0) * w(0) * body(0);
    for (int i = 1; i < 3; ++i) twice += w(i) * w(i) * body(i);
    S out = twice * (0.5 / h);
    for (int i = 0; i < 3; ++i) {
      const auto steady = momenta(i) * (h / turning(i));
      const bool has_arrow = std::abs(number_of(steady) - number_of(w(i))) < std::numbers::pi;
      out += (w(i) - steady * 0.5) * (has_arrow ? momenta(i) : T(NAN));
    }
    return out;
  }
};

LAGROID_STEPS(extern template, Gyrostat);
LAGROID_SOLVERS(extern template, Gyrostat);

}  // namespace lagroid
