/// The extension module lagroid._lagroid.

#include "bindings.hpp"

#include <archive.hpp>
#include <learn/model_file.hpp>
#include <listing.hpp>
#include <optimise/matrices.hpp>
#include <output_folder.hpp>
#include <scene_reader.hpp>
#include <study/methods.hpp>

#include <glog/logging.h>

#include <exception>

namespace lagroid::python {

namespace {

namespace py = pybind11;

void raise(const char* name, const char* what) {
  const py::object type = py::module_::import("lagroid.errors").attr(name);
  PyErr_SetString(type.ptr(), what);
}

/// The program's mistakes as the classes of lagroid/errors.py, with their one-line messages.
void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const app::SceneError& error) {
    raise("SceneError", error.what());
  } catch (const app::OutputError& error) {
    raise("OutputError", error.what());
  } catch (const app::RunError& error) {
    raise("OutputError", error.what());
  } catch (const app::DataError& error) {
    raise("DataError", error.what());
  } catch (const app::ModelError& error) {
    raise("DataError", error.what());
  } catch (const app::UnknownMethod& error) {
    raise("SceneError", error.what());
  }
}

}  // namespace

PYBIND11_MODULE(_lagroid, module) {
  module.doc() = "Discrete mechanics on Lie groupoids: what is compiled. Use the package lagroid.";
  // What Ceres would say on standard error stands in its summary too, and is judged anew from the residual.
  FLAGS_minloglevel = google::GLOG_FATAL;
  py::register_exception_translator(translate);
  module.attr("__version__") = LAGROID_VERSION;
  module.def("listing", app::json_listing, "The systems a scene can name, as JSON.");
  bind_scenes(module);
  bind_marches(module);
  bind_systems(module);
  bind_studies(module);
  bind_optimisation(module);
  bind_learning(module);
}

}  // namespace lagroid::python
