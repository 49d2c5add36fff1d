#pragma once
/// Every system of the library as a class.

#include <lagroid/python/system.hpp>

#include <lagroid/core/system.hpp>

#include <string>

namespace lagroid::python {

/// What help(...) says of a system's class.
template <DiscreteSystem Sys> std::string description_of() {
  using G = typename Sys::GroupoidType;
  return fmt::format(
      "A system on {}: object ({},), momentum ({},), configuration ({},) or as a matrix.\nParameters: "
      "docs/scenes.md, `lagroid list`.",
      G::name(), G::object_coordinate_count(), G::dimension, G::arrow_coordinate_count());
}

/// The class of a system that has compiled solvers.
template <DiscreteSystem Sys> void bind_library_system(py::module_& module, const char* name) {
  auto made = bind_system<Sys>(module, name, description_of<Sys>().c_str());
  if constexpr (Variational<Sys> && !TimeDependent<Sys>) bind_boundary(made);
}

/// Binds them all; returns the names of their classes.
py::tuple bind_library_systems(py::module_& module);

}  // namespace lagroid::python
