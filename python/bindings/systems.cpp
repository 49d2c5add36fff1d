/// Systems of the library as classes.

#include "arrays.hpp"
#include "bindings.hpp"
#include "numbers.hpp"

#include <lagroid/python/system.hpp>
#include <lagroid/systems/heavy_top.hpp>
#include <lagroid/systems/kepler.hpp>
#include <lagroid/systems/pendulum.hpp>
#include <lagroid/systems/plate_ball.hpp>
#include <lagroid/systems/rigid_body.hpp>
#include <lagroid/systems/spherical_pendulum.hpp>

namespace lagroid::python {

namespace {

/// A property that is a finite number which the rule holds of.
template <class Sys, class Base>
void bind_number(py::class_<Sys>& made, const char* name, double Base::*member, const char* doc,
                 const app::NumberRule& rule = app::any_number) {
  made.def_property(
      name, [member](const Sys& self) { return self.*member; },
      [name, member, rule](Sys& self, double x) { self.*member = finite(name, x, rule); }, doc);
}

/// A property that is three of them; `meaning` names them in messages. It is read as an array of its own.
template <class Sys>
void bind_numbers(py::class_<Sys>& made, const char* name, Vector<double, 3> Sys::*member, const char* meaning,
                  const char* doc, const app::NumberRule& rule = app::any_number) {
  made.def_property(
      name,
      [member](const Sys& self) {
        py::array out = owned(std::vector<double>((self.*member).begin(), (self.*member).end()));
        out.attr("flags").attr("writeable") = false;
        return out;
      },
      [name, member, meaning, rule](Sys& self, const Array& given) {
        const auto v = detail::vector_of<Vector<double, 3>>(given, name);
        for (const double x : v)
          if (!rule.holds(x))
            throw py::value_error(fmt::format("{}: {} must be {}, got {}", name, meaning, rule.words, x));
        self.*member = v;
      },
      doc);
}

/// A property that is one of some words, the values of an enumeration in order.
template <class Sys, class Base, class Enum, std::size_t N>
void bind_choice(py::class_<Sys>& made, const char* name, Enum Base::*member,
                 const std::array<std::string_view, N>& words, const char* doc) {
  made.def_property(
      name, [member, words](const Sys& self) { return std::string(words[std::size_t(self.*member)]); },
      [name, member, words](Sys& self, const std::string& word) {
        self.*member = Enum(detail::choice(name, word, words));
      },
      doc);
}

constexpr std::array<std::string_view, 2> quadratures{"midpoint", "trapezoid"};
constexpr const char* quadrature_doc = "Of the potential over a step: midpoint or trapezoid (Stormer-Verlet).";
constexpr std::array<std::string_view, 2> rotations{"exp", "cayley"};
constexpr const char* rotation_doc = "How a rotation becomes an angular velocity: exp or cayley.";
static_assert(int(Quadrature::midpoint) == 0 && int(Retraction::exponential) == 0 &&
              int(RotationForm::exponential) == 1);

template <class Sys> void bind_rod_and_bob(py::class_<Sys>& made) {
  bind_number(made, "mass", &Sys::bob_mass, "Of the bob, kg.", app::positive);
  bind_number(made, "length", &Sys::length, "Of the rod, m.", app::positive);
  bind_number(made, "gravity", &Sys::gravity, "m/s^2.");
  bind_choice(made, "quadrature", &Sys::quadrature, quadratures, quadrature_doc);
}

template <class V> py::array_t<double> array_of(const V& v) { return py::array_t<double>(v.size(), v.data()); }

using Attitude = Matrix<double, 3, 3>;

}  // namespace

void bind_systems(py::module_& module) {
  auto kepler =
      bind_system<Kepler>(module, "Kepler", "The planar Kepler problem: object q (2,), m; momentum p = q' (2,), m/s.");
  bind_number(kepler, "strength", &Kepler::strength, "Of the attraction, m^3/s^2.");
  bind_choice(kepler, "quadrature", &Kepler::quadrature, quadratures, quadrature_doc);
  bind_boundary(kepler);

  auto pendulum = bind_system<Pendulum>(
      module, "Pendulum",
      "The planar pendulum: object the angle from the downward vertical (1,), rad; momentum m l^2 q' (1,).");
  bind_rod_and_bob(pendulum);
  bind_boundary(pendulum);

  auto spherical = bind_system<SphericalPendulum>(
      module, "SphericalPendulum",
      "A bob on a rod in space: object q on the sphere |q| = length (3,), m; momentum m q' (3,), kg m/s.");
  bind_rod_and_bob(spherical);
  bind_boundary(spherical);

  auto body = bind_system<RigidBody>(
      module, "RigidBody",
      "The free rigid body: no object; momentum the body angular momentum M (3,), kg m^2/s; configuration the\n"
      "attitude A (3, 3), which carries body to space.");
  bind_numbers(body, "inertia", &RigidBody::inertia, "principal moments", "Principal moments (3,), kg m^2.",
               app::positive);
  bind_choice(body, "rotation", &RigidBody::rotation, rotations, rotation_doc);
  bind_boundary(body);

  auto top = bind_system<HeavyTop>(
      module, "HeavyTop",
      "A body with a fixed point under gravity: object the upward vertical seen from the body, v = A^T e3 (3,);\n"
      "momentum M (3,), kg m^2/s; configuration the attitude by columns, then e3 (12,).");
  bind_numbers(top, "inertia", &HeavyTop::inertia, "principal moments", "Principal moments (3,), kg m^2.",
               app::positive);
  bind_numbers(top, "weight", &HeavyTop::weight, "weight", "Weight times the vector to the centre of mass (3,), N m.");
  bind_choice(top, "rotation", &HeavyTop::rotation, rotations, rotation_doc);
  top.def_static(
      "arrow",
      [](const Attitude& attitude) {
        const HeavyTop::GroupoidType groupoid;
        return array_of(groupoid.coordinates_of_arrow(ActionArrow<Attitude, Vector<double, 3>>{attitude, {0, 0, 1}}));
      },
      py::arg("attitude"), "The configuration of this attitude (3, 3): the arrow from e3 to A^T e3, (12,).");
  bind_boundary(top);

  auto ball = bind_system<PlateBall>(
      module, "PlateBall",
      "Optimal control of a ball that rolls on a turning plate: object the contact point (2,), m; momentum\n"
      "px, py, M1, M2, M3 (5,); arrows two points and a rotation by columns (13,).");
  bind_number(ball, "radius", &PlateBall::radius, "Of the ball, m.", app::positive);
  bind_number(ball, "plate_rate", &PlateBall::plate_rate, "Angular velocity of the plate, rad/s.");
  bind_number(ball, "spin", &PlateBall::spin, "Prescribed rate about the vertical, rad/s.");
  bind_choice(ball, "rotation", &PlateBall::rotation, std::array<std::string_view, 3>{"trace", "exp", "cayley"},
              "Form of the constraints: trace, exp or cayley.");
  ball.def_static(
      "arrow",
      [](const Vector<double, 2>& start, const Vector<double, 2>& end, const Attitude& turn) {
        const PlateBall::GroupoidType groupoid;
        return array_of(
            groupoid.coordinates_of_arrow(ArrowOf<PlateBall::GroupoidType>{PairArrow<double, 2>{start, end}, turn}));
      },
      py::arg("start"), py::arg("end"), py::arg("turn"),
      "The arrow from one contact point to another that turns the attitude by `turn` (3, 3), (13,).");
  bind_boundary(ball);
}

}  // namespace lagroid::python
