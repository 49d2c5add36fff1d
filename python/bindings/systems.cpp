/// Systems of the library as classes: each from the one declaration of its parameters
/// (bindings/templates/system.cpp.in).

#include "bindings.hpp"
#include "library_systems.hpp"

#include <lagroid/python/system.hpp>
#include <lagroid/systems/control/plate_ball.hpp>
#include <lagroid/systems/rotations/heavy_top.hpp>

namespace lagroid::python {

namespace {

template <class V> py::array_t<double> array_of(const V& v) { return py::array_t<double>(v.size(), v.data()); }

using Attitude = Matrix<double, 3, 3>;

/// A static method of a class, after the class was made.
template <class F, class... Extra>
void add_static(const py::object& made, const char* name, F f, const Extra&... extra) {
  made.attr(name) = py::staticmethod(py::cpp_function(f, py::name(name), py::scope(made), extra...));
}

}  // namespace

void bind_systems(py::module_& module) {
  // What `from lagroid._lagroid import *` takes.
  module.attr("__all__") = bind_library_systems(module);
  add_static(
      module.attr("HeavyTop"), "arrow",
      [](const Attitude& attitude) {
        const HeavyTop::GroupoidType groupoid;
        return array_of(groupoid.coordinates_of_arrow(ActionArrow<Attitude, Vector<double, 3>>{attitude, {0, 0, 1}}));
      },
      py::arg("attitude"), "The configuration of this attitude (3, 3): the arrow from e3 to A^T e3, (12,).");
  add_static(
      module.attr("PlateBall"), "arrow",
      [](const Vector<double, 2>& start, const Vector<double, 2>& end, const Attitude& turn) {
        const PlateBall::GroupoidType groupoid;
        return array_of(
            groupoid.coordinates_of_arrow(ArrowOf<PlateBall::GroupoidType>{PairArrow<double, 2>{start, end}, turn}));
      },
      py::arg("start"), py::arg("end"), py::arg("turn"),
      "The arrow from one contact point to another that turns the attitude by `turn` (3, 3), (13,).");
}

}  // namespace lagroid::python
