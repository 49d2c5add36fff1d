/// The extension module lagroid._lagroid.

#include "arrays.hpp"
#include "bindings.hpp"

#include <lagroid/run/study/methods.hpp>
#include <listing.hpp>
#include <optimise/matrices.hpp>
#include <reading/scene_reader.hpp>
#include <spheres/learned/model_file.hpp>
#include <whole_program.hpp>

#include <lagroid/core/version.hpp>
#include <lagroid/run/files/output_folder.hpp>
#include <lagroid/run/reports/text.hpp>

#include <pybind11/stl/filesystem.h>

#include <exception>
#include <filesystem>
#include <string>
#include <utility>

namespace lagroid::python {

namespace {

void raise(const char* name, const char* what) {
  const py::object type = py::module_::import("lagroid.errors").attr(name);
  PyErr_SetString(type.ptr(), lagroid::visible(what).c_str());
}

/// The program's mistakes as the classes of lagroid/errors.py, with their one-line messages.
void translate(std::exception_ptr thrown) {
  try {
    if (thrown) std::rethrow_exception(thrown);
  } catch (const app::SceneError& error) {
    raise("SceneError", error.what());
  } catch (const lagroid::OutputError& error) {
    raise("OutputError", error.what());
  } catch (const lagroid::RunError& error) {
    raise("OutputError", error.what());
  } catch (const app::DataError& error) {
    raise("DataError", error.what());
  } catch (const app::ModelError& error) {
    raise("DataError", error.what());
  } catch (const lagroid::UnknownMethod& error) {
    raise("SceneError", error.what());
  }
}

}  // namespace

PYBIND11_MODULE(_lagroid, module) {
  module.doc() = "Discrete mechanics on Lie groupoids: what is compiled. Use the package lagroid.";
  py::register_exception_translator(translate);
  app::ProgramParts parts = app::whole_program();
  app::use_families(std::move(parts.families));
  app::use_systems(std::move(parts.systems));
  module.attr("__version__") = LAGROID_VERSION;
  module.def(
      "listing", [] { return app::json_listing(); }, "The systems a scene can name, as JSON.");
  module.def(
      "read_hdf5",
      [](const std::filesystem::path& file, const std::string& dataset) {
        return owned(app::read_hdf5(file, dataset));
      },
      py::arg("file"), py::arg("dataset"), "A data set of one or two dimensions, (rows, columns). Raises DataError.");
  bind_scenes(module);
  bind_integrators(module);
  bind_systems(module);
  bind_studies(module);
  bind_optimisation(module);
  bind_control(module);
  bind_learning(module);
}

}  // namespace lagroid::python
