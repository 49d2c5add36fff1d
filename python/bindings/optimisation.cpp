/// Minimising on manifolds: scenes, and functions written in Python.

#include "arrays.hpp"
#include "bindings.hpp"
#include "computing.hpp"
#include "scene.hpp"

#include <optimise/methods.hpp>
#include <optimise/optimisation_files.hpp>
#include <optimise/optimisation_scene.hpp>

#include <lagroid/python/numbers.hpp>
#include <lagroid/solvers/optimisation/manifolds/hyperbolic_space.hpp>
#include <lagroid/solvers/optimisation/manifolds/positive_definite.hpp>
#include <lagroid/solvers/optimisation/manifolds/product.hpp>
#include <lagroid/solvers/optimisation/manifolds/sphere.hpp>
#include <lagroid/solvers/optimisation/manifolds/stiefel.hpp>
#include <lagroid/solvers/optimisation/penalised.hpp>
#include <lagroid/systems/optimisation/frechet_mean.hpp>
#include <lagroid/systems/optimisation/instances.hpp>

#include <fmt/format.h>

#include <pybind11/eigen.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <functional>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace lagroid::python {

namespace {

using namespace optimisation;

/// How points are shown: (size,) or, columns first in memory, (rows, columns).
struct Layout {
  Eigen::Index rows = 0;
  Eigen::Index columns = 1;
  bool matrix = false;

  py::array view_of(const double* numbers, py::handle owner) const {
    if (!matrix) return python::view(numbers, {rows * columns}, {1}, owner);
    return python::view(numbers, {rows, columns}, {1, rows}, owner);
  }
  std::vector<py::ssize_t> shape() const {
    if (!matrix) return {rows * columns};
    return {rows, columns};
  }
  py::array copy_of(const Eigen::VectorXd& x) const {
    if (!matrix) return owned(std::vector<double>(x.begin(), x.end()));
    return owned(Eigen::MatrixXd(x.reshaped(rows, columns)));
  }
};

/// A manifold that is made anew for each minimisation, whose buffers it has.
struct ManifoldMaker {
  std::function<std::unique_ptr<Manifold>()> make;
  Layout layout;
};

/// A Frechet mean that is made anew for each minimisation, on the manifold of it.
struct MeanMaker {
  ManifoldMaker manifold;
  std::vector<Point> points;
  Eigen::VectorXd weights;

  FrechetMean on(const Manifold& made) const { return {made, points, weights}; }
};

struct Optimum {
  Result result;
  Layout layout;
  std::string summary;  ///< JSON, of a scene
};

[[noreturn]] void refuse(const char* what, const char* expected, const py::handle& got) {
  PyErr_Clear();
  throw py::type_error(fmt::format("{}: expected {}, got {}", what, expected,
                                   std::string(py::str(py::type::handle_of(got).attr("__name__")))));
}

/// Numbers from Python in the shape of points, by columns.
Eigen::VectorXd flat(const py::object& given, const Layout& layout, const char* what) {
  const auto array = py::array_t<double, py::array::f_style | py::array::forcecast>::ensure(given);
  if (!array) refuse(what, "numbers", given);
  const std::vector<py::ssize_t> shape(array.shape(), array.shape() + array.ndim());
  if (shape != layout.shape()) {
    const auto words = [](const auto& of) { return std::string(py::str(py::tuple(py::cast(of)))); };
    throw py::value_error(fmt::format("{}: expected shape {}, got {}", what, words(layout.shape()), words(shape)));
  }
  return Eigen::Map<const Eigen::VectorXd>(array.data(), array.size());
}

double number(const py::object& given, const char* what) {
  const double x = PyFloat_AsDouble(given.ptr());
  if (x != -1 || PyErr_Occurred() == nullptr) return x;
  if (PyErr_ExceptionMatches(PyExc_TypeError) != 0) refuse(what, "a number", given);
  throw py::error_already_set();
}

/// A function in Python: fun(x) -> (value, gradient), and hessian(x, v), if there is one. Its arguments are copies, so
/// that it may keep them.
class PythonObjective final : public Objective {
 public:
  PythonObjective(py::function fun, std::optional<py::function> hessian, Layout layout)
      : fun_(std::move(fun)), hessian_(std::move(hessian)), layout_(layout) {}

  std::string name() const override { return "a function in Python"; }
  double evaluate(const Point& x, Vector& gradient) const override {
    const py::gil_scoped_acquire locked;
    const py::object out = fun_(layout_.copy_of(x));
    if (!py::isinstance<py::tuple>(out) || py::len(out) != 2)
      throw py::type_error("the function returns the tuple (value, gradient)");
    const auto pair = out.cast<py::tuple>();
    gradient = flat(pair[1], layout_, "gradient");
    return number(pair[0], "value");
  }
  void hessian(const Point& x, const Vector& v, Vector& h) const override {
    if (!hessian_) return Objective::hessian(x, v, h);
    const py::gil_scoped_acquire locked;
    h = flat((*hessian_)(layout_.copy_of(x), layout_.copy_of(v)), layout_, "hessian");
  }

 private:
  py::function fun_;
  std::optional<py::function> hessian_;
  Layout layout_;
};

/// Ctrl-C ends it; so does what Python raises.
Callback watch() {
  return [](const Iterate&, const Point&) { return !lagroid::InterruptGuard::interrupted(); };
}

MeanMaker mean_python(const ManifoldMaker& maker, const std::vector<py::object>& points,
                      const std::optional<Eigen::VectorXd>& weights) {
  MeanMaker out{maker, {}, weights.value_or(Eigen::VectorXd())};
  for (const auto& point : points) out.points.push_back(flat(point, maker.layout, "points"));
  out.on(*maker.make());
  return out;
}

std::shared_ptr<Optimum> minimise_python(const ManifoldMaker& maker, const py::function& fun,
                                         const std::optional<py::object>& start, const std::string& method,
                                         const std::optional<py::function>& hessian, unsigned seed, double gradient,
                                         double relative_gradient, long iterations, double seconds, bool history) {
  const auto manifold = maker.make();
  const auto* mean = py::isinstance<MeanMaker>(fun) ? fun.cast<const MeanMaker*>() : nullptr;
  if (mean && hessian) throw py::value_error("hessian: a FrechetMean has its own");
  std::unique_ptr<Objective> objective;
  if (mean)
    objective = std::make_unique<FrechetMean>(mean->on(*manifold));
  else
    objective = std::make_unique<PythonObjective>(fun, hessian, maker.layout);
  const app::Section keys = app::parse_scene(method, "method", {});
  const auto by = app::read_optimiser(keys);
  keys.finish();
  const Point from = start  ? flat(*start, maker.layout, "start")
                     : mean ? mean->points.front()
                            : random_start(*manifold, seed);
  Stopping stopping;
  stopping.gradient = finite("gradient", gradient, nonnegative);
  stopping.relative_gradient =
      finite("relative_gradient", relative_gradient, {"from 0 to below 1", [](double x) { return x >= 0 && x < 1; }});
  if (iterations < 1) throw py::value_error(fmt::format("iterations: must be at least 1, got {}", iterations));
  stopping.iterations = iterations;
  stopping.seconds = held("seconds", seconds, positive);
  return std::make_shared<Optimum>(
      Optimum{computing([&] {
                return optimisation::minimise(*manifold, *objective, from, *by, stopping, {history, watch()});
              }),
              maker.layout,
              {}});
}

std::shared_ptr<Optimum> minimise_scene(const Scene& scene, bool history,
                                        const std::optional<std::filesystem::path>& folder) {
  const app::Section file = scene.read();
  const app::OptimisationScene read = app::read_optimisation(file, scene.file.value_or(""));
  std::optional<lagroid::OutputFolder> held;
  if (folder) held.emplace(app::folder_for_optimisation(*folder, file));
  const Instance& instance = read.instance;
  auto out = std::make_shared<Optimum>();
  out->layout = {instance.rows, instance.columns, instance.columns > 1};
  computing([&] {
    const Recording recording{history || folder, watch()};
    out->result = read.penalty ? minimise_penalised(*instance.manifold, *instance.objective, *read.penalty, read.start,
                                                    *read.method, read.stopping, recording)
                               : optimisation::minimise(*instance.manifold, *instance.objective, read.start,
                                                        *read.method, read.stopping, recording);
    std::string note;
    if (folder) app::write_optimisation(read, out->result, *folder, note);
    return 0;
  });
  out->summary = app::optimisation_json(read, out->result).dump(2);
  return out;
}

/// A column of the history.
template <class F> py::array column(const Optimum& optimum, const F& of) {
  std::vector<double> out;
  for (const Iterate& each : optimum.result.history) out.push_back(double(of(each)));
  return owned(std::move(out));
}

}  // namespace

void bind_optimisation(py::module_& module) {
  py::class_<ManifoldMaker>(module, "Manifold", "A manifold on which functions are minimised.")
      .def_property_readonly(
          "name", [](const ManifoldMaker& m) { return m.make()->name(); }, "In words.")
      .def_property_readonly(
          "size", [](const ManifoldMaker& m) { return m.make()->size(); }, "How many numbers a point has.")
      .def_property_readonly(
          "dimension", [](const ManifoldMaker& m) { return m.make()->dimension(); }, "How many of them are free.")
      .def(
          "random",
          [](const ManifoldMaker& m, unsigned seed) { return m.layout.copy_of(random_start(*m.make(), seed)); },
          py::arg("seed") = 1, "The point nearest to a random matrix.")
      .def("__repr__", [](const ManifoldMaker& m) { return fmt::format("<{}>", m.make()->name()); });
  module.def(
      "Sphere",
      [](Eigen::Index n) {
        Sphere{n};
        return ManifoldMaker{[n] { return std::make_unique<Sphere>(n); }, {n, 1, false}};
      },
      py::arg("n"), "The unit sphere in R^n; points (n,).");
  module.def(
      "Stiefel",
      [](Eigen::Index n, Eigen::Index m) {
        Stiefel{n, m};
        return ManifoldMaker{[n, m] { return std::make_unique<Stiefel>(n, m); }, {n, m, true}};
      },
      py::arg("n"), py::arg("m"), "The n x m matrices with orthonormal columns; points (n, m). O(n) for m = n.");
  module.def(
      "HyperbolicSpace",
      [](Eigen::Index n) {
        HyperbolicSpace{n};
        return ManifoldMaker{[n] { return std::make_unique<HyperbolicSpace>(n); }, {n + 1, 1, false}};
      },
      py::arg("n"), "H^n of curvature -1; points (n + 1,) with -x_0^2 + x_1^2 + ... + x_n^2 = -1, x_0 > 0.");
  module.def(
      "PositiveDefinite",
      [](Eigen::Index n) {
        PositiveDefinite{n};
        return ManifoldMaker{[n] { return std::make_unique<PositiveDefinite>(n); }, {n, n, true}};
      },
      py::arg("n"), "The symmetric positive definite n x n matrices; points (n, n).");
  module.def(
      "ProductManifold",
      [](const std::vector<ManifoldMaker>& factors) {
        const auto make = [factors]() -> std::unique_ptr<Manifold> {
          std::vector<std::unique_ptr<Manifold>> made;
          for (const auto& each : factors) made.push_back(each.make());
          return std::make_unique<ProductManifold>(std::move(made));
        };
        return ManifoldMaker{make, {make()->size(), 1, false}};
      },
      py::arg("factors"), "A product; points one after another, (size,), matrices by columns.");

  py::class_<MeanMaker>(module, "FrechetMean",
                        "f(x) = sum w_i d(x, y_i)^2 / 2, whose minimum is the mean of the points.")
      .def(py::init(&mean_python), py::arg("manifold"), py::arg("points"), py::arg("weights") = py::none())
      .def(
          "__call__",
          [](const MeanMaker& mean, const py::object& x) {
            const auto manifold = mean.manifold.make();
            Vector gradient;
            const double value = mean.on(*manifold).evaluate(flat(x, mean.manifold.layout, "x"), gradient);
            return py::make_tuple(value, mean.manifold.layout.copy_of(gradient));
          },
          py::arg("x"), "Value and gradient, as a function to minimise returns them.");

  py::class_<Optimum, std::shared_ptr<Optimum>>(module, "Optimum", "What a minimisation came to.")
      .def_property_readonly(
          "x",
          [](const py::object& self) {
            const auto& o = self.cast<const Optimum&>();
            if (o.result.x.size() == 0) return view(nullptr, {0}, {1}, self);
            return o.layout.view_of(o.result.x.data(), self);
          },
          "The point: (n,) or (rows, columns).")
      .def_property_readonly(
          "value", [](const Optimum& o) { return o.result.value; }, "Of the function there.")
      .def_property_readonly(
          "gradient", [](const Optimum& o) { return o.result.gradient; }, "The norm of the Riemannian gradient.")
      .def_property_readonly(
          "residual", [](const Optimum& o) { return o.result.residual; }, "Of the constraints.")
      .def_property_readonly(
          "status", [](const Optimum& o) { return std::string(to_string(o.result.outcome)); }, "converged, or why not.")
      .def_property_readonly(
          "message", [](const Optimum& o) { return o.result.message; },
          "Where it did not converge: why, and what to do.")
      .def_property_readonly(
          "converged", [](const Optimum& o) { return o.result.converged(); },
          "Whether it stopped where it was asked to.")
      .def_property_readonly(
          "iterations", [](const Optimum& o) { return o.result.iterations; }, "Made.")
      .def_property_readonly(
          "seconds", [](const Optimum& o) { return o.result.seconds; }, "By the clock.")
      .def_property_readonly(
          "evaluations",
          [](const Optimum& o) {
            const Evaluations& e = o.result.evaluations;
            return py::make_tuple(e.values, e.gradients, e.hessians);
          },
          "Of values alone, of gradients, of Hessians times vectors.")
      .def_property_readonly(
          "values", [](const Optimum& o) { return column(o, [](const Iterate& i) { return i.value; }); },
          "After each iteration, where a history was asked for.")
      .def_property_readonly(
          "gradients", [](const Optimum& o) { return column(o, [](const Iterate& i) { return i.gradient; }); },
          "The norms of the Riemannian gradient after each iteration.")
      .def_readonly("summary", &Optimum::summary, "Of a scene: JSON, as lagroid optimize --json prints it.")
      .def("__repr__", [](const Optimum& o) {
        return fmt::format("<minimum {:.10g}: {} after {} iterations>", o.result.value, to_string(o.result.outcome),
                           o.result.iterations);
      });

  module.def("minimise", minimise_python, py::arg("manifold"), py::arg("fun"), py::arg("start"), py::arg("method"),
             py::arg("hessian"), py::arg("seed"), py::arg("gradient"), py::arg("relative_gradient"),
             py::arg("iterations"), py::arg("seconds"), py::arg("history"));
  module.def("optimise", minimise_scene, py::arg("scene"), py::arg("history"), py::arg("folder"));
}

}  // namespace lagroid::python
