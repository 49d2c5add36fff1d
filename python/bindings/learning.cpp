/// Hamiltonians on (T*S^2)^k and in R^2n from trajectories.

#include "arrays.hpp"
#include "bindings.hpp"
#include "computing.hpp"

#include <learn/learn_files.hpp>
#include <learn/trajectory_files.hpp>
#include <spheres/learned/model_file.hpp>

#include <lagroid/run/files/output_folder.hpp>
#include <lagroid/solvers/learning/measures.hpp>
#include <lagroid/solvers/learning/train.hpp>
#include <lagroid/systems/pendulums/chain_trajectories.hpp>

#include <fmt/format.h>

#include <pybind11/eigen.h>
#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

namespace lagroid::python {

namespace {

namespace fs = std::filesystem;
using app::LearnedHamiltonian;
using learning::Observation, learning::Trained, learning::Trajectories;
using States = py::array_t<double, py::array::c_style | py::array::forcecast>;

/// Trajectories of M points (N, M, 6k) at these times (M,), or (N, M, 2n) off spheres.
Trajectories assembled(const States& states, const States& time, double noise, bool spheres) {
  if (states.ndim() != 3 || states.shape(2) == 0 || time.ndim() != 1 || time.shape(0) != states.shape(1))
    throw py::value_error(
        "states: expected (trajectories, points, 6k), or with spheres=False (trajectories, points, 2n), and the time "
        "of "
        "each point (points,)");
  if (spheres && states.shape(2) % 6 != 0)
    throw py::value_error(
        "states: expected (trajectories, points, 6k); for (trajectories, points, 2n) give spheres=False");
  if (!spheres && states.shape(2) % 2 != 0)
    throw py::value_error("states: expected (trajectories, points, 2n), as many momenta as coordinates");
  std::vector<Observation> rows;
  for (py::ssize_t i = 0; i < states.shape(0); ++i)
    for (py::ssize_t j = 0; j < states.shape(1); ++j)
      rows.push_back({long(rows.size()), long(i), time.at(j),
                      Eigen::Map<const Eigen::VectorXd>(states.data(i, j, 0), states.shape(2)), 1});
  if (spheres) return learning::assemble(rows, noise);
  return learning::assemble(rows, learning::phase_space(int(states.shape(2) / 2)), noise);
}

/// Its states (N, M, 6k), or (N, M, 2n).
py::array states_of(const Trajectories& data) {
  const Eigen::Index width = data.width();
  auto* kept = new Eigen::MatrixXd(width * data.points, data.count());
  kept->topRows(width) = data.starts;
  kept->bottomRows(width * (data.points - 1)) = data.ends;
  const py::capsule owner(kept, [](void* p) { delete static_cast<Eigen::MatrixXd*>(p); });
  return view(kept->data(), {data.count(), data.points, width}, {width * data.points, width, 1}, owner);
}

Trajectories draw(const Eigen::VectorXd& masses, const Eigen::VectorXd& lengths, double gravity, int count, int points,
                  double duration, double noise, unsigned seed) {
  return computing([&] {
    const PendulumChain<Eigen::Dynamic> chain(masses, lengths, gravity);
    return learning::assemble(
        draw_trajectories(chain,
                          {.count = count, .points = points, .duration = duration, .noise = noise, .seed = seed}),
        noise);
  });
}

/// A model with what its training came to.
struct Learned {
  LearnedHamiltonian hamiltonian;
  Trained trained;

  const learning::Model& model() const { return *hamiltonian.model; }
  const Eigen::VectorXd& theta() const { return hamiltonian.parameters; }
};

std::shared_ptr<Learned> learn(const Trajectories& data, const std::string& model,
                               const std::optional<std::shared_ptr<Learned>>& begin, const std::string& integrator,
                               int substeps, double validation, int starts, int iterations, unsigned seed,
                               double enough, double seconds, bool dissipation) {
  const LieGroupMethod* method = lie_group_methods::named(integrator);
  if (method == nullptr) {
    std::string all;
    for (const LieGroupMethod& each : lie_group_methods::all) all += (all.empty() ? "" : ", ") + std::string(each.name);
    throw py::value_error(fmt::format("integrator: \"{}\" is none of {}", integrator, all));
  }
  auto out = std::make_shared<Learned>();
  learning::Training training;
  if (begin) {
    out->hamiltonian = (*begin)->hamiltonian;
    if (dissipation && !out->model().damped())
      throw py::value_error("dissipation: the model of begin declares none; leave it out, or begin anew with it");
    training.begin = out->hamiltonian.parameters;
  } else {
    out->hamiltonian.model = app::named_model(
        model, app::space_of(data), dissipation ? learning::Dissipation::rayleigh : learning::Dissipation::none);
  }
  if (const auto its = to_string(out->model().space()), given = to_string(app::space_of(data)); its != given)
    throw py::value_error(fmt::format("the model is on {}, the data on {}", its, given));
  training.method = *method;
  training.substeps = substeps;
  training.seed = seed;
  training.starts = begin ? 1 : starts;
  training.iterations = iterations;
  training.validation = validation;
  training.enough = enough;
  training.seconds = seconds;
  training.stop = lagroid::InterruptGuard::interrupted;
  out->trained = computing([&] { return learning::train(out->model(), data, training); });
  if (out->trained.usable()) out->hamiltonian.parameters = out->trained.parameters;
  return out;
}

std::shared_ptr<Learned> load(const fs::path& file) {
  auto out = std::make_shared<Learned>();
  out->hamiltonian = app::read_model(file);
  out->trained.message = file.string();
  return out;
}

const Eigen::VectorXd& usable(const Learned& learned, const Eigen::VectorXd& z) {
  if (learned.theta().size() == 0) throw py::value_error("the training left no parameters: " + learned.trained.message);
  if (const Eigen::Index size = learned.model().space().size; z.size() != size)
    throw py::value_error(fmt::format("z: expected {} numbers, got {}", size, z.size()));
  return learned.theta();
}

}  // namespace

void bind_learning(py::module_& module) {
  py::class_<Trajectories>(module, "Trajectories", "Pieces of motions on (T*S^2)^k or in R^2n at equal intervals.")
      .def(
          py::init(&assembled), py::arg("states"), py::arg("time"), py::kw_only(), py::arg("noise") = 0.0,
          py::arg("spheres") = true,
          "From states (trajectories, points, 6k), q_1, p_1, q_2, ... each, and times (points,), s; with "
          "spheres=False\n"
          "from (trajectories, points, 2n), (q, p) each. `noise`: the size of their errors. Raises ValueError, naming\n"
          "the row, for what is off the spheres.")
      .def_static(
          "read",
          [](const fs::path& file, double noise, int points) {
            if (points != 0 && points < 2) throw py::value_error("points: pieces have two or more; 0 cuts none");
            return app::read_trajectories(file, noise, points).trajectories;
          },
          py::arg("file"), py::kw_only(), py::arg("noise") = 0.0, py::arg("points") = 0,
          "Reads a .csv or .h5 file (docs/learning.md), in pieces of so many points unless that is zero; what is left "
          "at\n"
          "the end of a trajectory is left out. Raises DataError.")
      .def_static(
          "chain",
          [](const Eigen::VectorXd& masses, const Eigen::VectorXd& lengths, double gravity, int count, int points,
             double duration, double noise,
             unsigned seed) { return draw(masses, lengths, gravity, count, points, duration, noise, seed); },
          py::arg("masses"), py::arg("lengths"), py::kw_only(), py::arg("gravity") = 1.0, py::arg("count") = 500,
          py::arg("points") = 5, py::arg("duration") = 0.1, py::arg("noise") = 0.0, py::arg("seed") = 0,
          "Random motions of a pendulum chain: masses (k,), kg, lengths (k,), m.")
      .def_readonly("bodies", &Trajectories::bodies, "k; zero in R^2n.")
      .def_readonly("points", &Trajectories::points, "Of each trajectory, the first included.")
      .def_readonly("interval", &Trajectories::interval, "Between points, s.")
      .def_property_readonly("states", states_of, "(trajectories, points, 6k), or (trajectories, points, 2n).")
      .def("__len__", &Trajectories::count);

  py::class_<learning::Measures>(module, "Measures", "How good a learned Hamiltonian is on data.")
      .def_readonly("mse", &learning::Measures::mse, "Mean squared error of all points but the first.")
      .def_readonly("times", &learning::Measures::times, "Of the points, s.")
      .def_readonly("rms", &learning::Measures::rms, "The root of the mean squared error at each of them.")
      .def_readonly("energy_largest", &learning::Measures::energy_largest, "The most that H varies by along the data.")
      .def_readonly("energy_rms", &learning::Measures::energy_rms, "The root of the mean square of that.")
      .def_readonly("momentum_learned", &learning::Measures::momentum_learned,
                    "Largest change of the vertical momentum along learned motions.")
      .def_readonly("momentum_data", &learning::Measures::momentum_data, "The same along the data.")
      .def_readonly("lost", &learning::Measures::lost, "Trajectories that could not be followed.");

  py::class_<Learned, std::shared_ptr<Learned>>(module, "LearnedHamiltonian",
                                                "H = p^T M(q)^{-1} p / 2 + V(q) on (T*S^2)^k, states z are (6k,);\n"
                                                "H(q, p) in R^2n, states (2n,).")
      .def_static("read", load, py::arg("file"), "Reads a model.json. Raises DataError.")
      .def(
          "write",
          [](const Learned& l, const fs::path& file) { lagroid::write_text(app::model_text(l.hamiltonian), file); },
          py::arg("file"), "Writes a model.json, which a scene can run if it is on spheres.")
      .def_property_readonly(
          "name", [](const Learned& l) { return l.model().name(); }, "Of the potential, or of H.")
      .def_property_readonly(
          "bodies", [](const Learned& l) { return l.model().bodies(); }, "k; zero in R^2n.")
      .def_property_readonly(
          "parameters",
          [](const py::object& self) {
            const auto& theta = self.cast<const Learned&>().theta();
            return view(theta.data(), {theta.size()}, {1}, self);
          },
          "theta, the mass matrix's first.")
      .def_property_readonly(
          "mass", [](const Learned& l) { return l.model().mass(l.theta()); }, "m, (k, k); empty in R^2n.")
      .def_property_readonly(
          "dissipation", [](const Learned& l) { return l.model().dissipation(l.theta()); },
          "R, (k, k) or (n, n); empty where none was declared.")
      .def_property_readonly(
          "status", [](const Learned& l) { return std::string(to_string(l.trained.outcome)); },
          "How the training ended.")
      .def_property_readonly(
          "message", [](const Learned& l) { return l.trained.message; }, "Why, and what to do.")
      .def_property_readonly(
          "usable", [](const Learned& l) { return l.theta().size() > 0; }, "Whether there are parameters.")
      .def_property_readonly(
          "mse", [](const Learned& l) { return l.trained.mse; }, "Mean squared error in training.")
      .def_property_readonly(
          "validation", [](const Learned& l) { return l.trained.validation; }, "That on the data held out.")
      .def_property_readonly(
          "mass_determined", [](const Learned& l) { return l.trained.mass_determined; },
          "Whether the data determine the mass matrix.")
      .def_property_readonly(
          "dissipation_determined", [](const Learned& l) { return l.trained.dissipation_determined; },
          "Whether the data determine R.")
      .def_property_readonly(
          "iterations", [](const Learned& l) { return l.trained.iterations; }, "Of all stages.")
      .def_property_readonly(
          "seconds", [](const Learned& l) { return l.trained.seconds; }, "Of the processor.")
      .def_property_readonly(
          "history",
          [](const Learned& l) {
            Eigen::MatrixXd rows(Eigen::Index(l.trained.history.size()), 4);
            for (Eigen::Index i = 0; i < rows.rows(); ++i) {
              const auto& stage = l.trained.history[std::size_t(i)];
              rows.row(i) << stage.start, stage.iteration, stage.mse, stage.validation;
            }
            return owned(std::move(rows));
          },
          "(iterations, 4): start, iteration, mse, validation.")
      .def(
          "energy", [](const Learned& l, const Eigen::VectorXd& z) { return l.model().energy(usable(l, z), z); },
          py::arg("z"), "H(z).")
      .def(
          "field", [](const Learned& l, const Eigen::VectorXd& z) { return l.model().field(usable(l, z), z); },
          py::arg("z"), "The motion as an element of the algebra (xi_i, eta_i), (6k,); in R^2n z'.")
      .def(
          "rates", [](const Learned& l, const Eigen::VectorXd& z) { return l.model().rates(usable(l, z), z); },
          py::arg("z"), "z'.")
      .def(
          "follow",
          [](const Learned& l, const Eigen::VectorXd& start, const std::vector<double>& times, double tolerance) {
            usable(l, start);
            Eigen::MatrixXd z(start.size(), Eigen::Index(times.size()));
            if (!computing([&] { return l.model().follow(l.theta(), start, times, tolerance, z); }))
              throw py::value_error("the motion could not be followed to these times");
            return owned(Eigen::MatrixXd(z.transpose()));
          },
          py::arg("start"), py::arg("times"), py::kw_only(), py::arg("tolerance") = 1e-12,
          "The motion from `start` at rising times > 0, (times, 6k).")
      .def(
          "measure",
          [](const Learned& l, const Trajectories& data, double tolerance) {
            return computing([&] {
              return learning::measure(l.model(), l.theta(), data, tolerance, lagroid::InterruptGuard::interrupted);
            });
          },
          py::arg("data"), py::kw_only(), py::arg("tolerance") = 1e-12, "On data that it was not trained on.")
      .def("__repr__", [](const Learned& l) {
        return fmt::format("<{} on {}: {}, mse {:.3g}>", l.model().name(), to_string(l.model().space()),
                           to_string(l.trained.outcome), l.trained.mse);
      });

  module.def("learn", learn, py::arg("data"), py::arg("model"), py::arg("begin"), py::arg("integrator"),
             py::arg("substeps"), py::arg("validation"), py::arg("starts"), py::arg("iterations"), py::arg("seed"),
             py::arg("enough"), py::arg("seconds"), py::arg("dissipation"));
}

}  // namespace lagroid::python
