#pragma once
/// The parts of the extension module lagroid._lagroid, a topic each.

#include <pybind11/pybind11.h>

namespace lagroid::python {

void bind_scenes(pybind11::module_& module);
void bind_integrators(pybind11::module_& module);
void bind_systems(pybind11::module_& module);
void bind_studies(pybind11::module_& module);
void bind_optimisation(pybind11::module_& module);
void bind_control(pybind11::module_& module);
void bind_learning(pybind11::module_& module);

}  // namespace lagroid::python
