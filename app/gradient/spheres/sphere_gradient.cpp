#include "../../spheres/sphere_node.hpp"
#include "../../spheres/sphere_run.hpp"
#include "../../spheres/sphere_start.hpp"
#include "../../spheres/sphere_time.hpp"
#include "../system_gradients.hpp"
#include "varying_spheres.hpp"

#include <lagroid/systems/spheres/linearised_sphere_motion.hpp>

#include <fmt/format.h>

#include <string>
#include <utility>

namespace lagroid::app {

namespace {

using Points = SphereIntegrator::Points;

/// Where a run begins: the point that the scene gives, by turns along its tangent frames and by what is added along
/// them to its second halves.
struct SphereRun {
  std::shared_ptr<const VaryingSpheres> system;
  SphereIntegratorOptions options;  ///< of the steps, whose states are in their form
  SphereForm shown;
  GivenSphereStart start;

  /// The point that is given, moved, and its derivatives.
  Eigen::MatrixXd directions(const std::vector<Nudge>& nudges, Points& moved) const {
    Eigen::VectorXd coordinates = Eigen::VectorXd::Zero(4 * start.z.cols());
    for (const Nudge& nudge : nudges)
      if (nudge.parameter.empty()) coordinates(nudge.index) += nudge.by;
    return tangent_directions(start.z, coordinates, moved);
  }
  std::unique_ptr<LinearisedMotion> begin(const std::vector<std::string>& parameters,
                                          const std::vector<Nudge>& nudges) const {
    const auto changed = system->changed(nudges);
    Points moved;
    directions(nudges, moved);
    const Points from = changed->in_form(moved, start.form, options.form);
    return std::make_unique<LinearisedSphereMotion>([&](const auto& by) { return changed->begin(from, by); }, options,
                                                    system->derivatives(nudges, options, shown, parameters));
  }
  /// Of the state by the tangent coordinates and the parameters.
  Eigen::MatrixXd begun_by(const std::vector<std::string>& parameters, const std::vector<Nudge>& nudges) const {
    Points moved;
    const Eigen::MatrixXd along = directions(nudges, moved);
    const Eigen::MatrixXd by =
        system->derivatives(nudges, options, shown, parameters)->in_form(moved, start.form, options.form);
    Eigen::MatrixXd out(by.rows(), along.cols() + by.cols() - by.rows());
    out << by.leftCols(by.rows()) * along, by.rightCols(by.cols() - by.rows());
    return out;
  }
};

/// q1.south, q1.east, ..., w1.south, ..., and their sizes: turns from where the scene starts are none.
void name_start(const GivenSphereStart& start, GradientSubject& out) {
  const bool velocities = start.form == SphereForm::velocities;
  const auto name = [&](const char* group, char letter, bool moves) {
    for (Eigen::Index i = 0; i < start.z.cols(); ++i) {
      const Vector<double, 2> along = tangent_frame(start.z.col(i).head<3>()).transpose() * start.z.col(i).tail<3>();
      for (const int axis : {0, 1}) {
        out.start.push_back({group, fmt::format("{}{}.{}", letter, i + 1, axis == 0 ? "south" : "east")});
        out.sizes.push_back(moves ? along(axis) : 0);
      }
    }
  };
  name("direction", 'q', false);
  name(velocities ? "angular_velocity" : "momentum", velocities ? 'w' : 'p', true);
}

}  // namespace

std::optional<GradientSubject> spheres_gradient(const Section& scene) {
  const SphereEntry* entry = sphere_system_of(scene);
  if (entry == nullptr) return std::nullopt;
  const SphereScene read = read_spheres(*entry, scene, {});
  if (!read.extent.events.empty())
    scene.fail("event", "of scenes on spheres there are no derivatives through events; leave the events out");
  const SphereSystem& system = *read.to_check.system;
  SphereRun run{varying_spheres(system, scene), read.to_check.options, read.to_check.options.form,
                read_given_start(scene, system, read.to_check.options.form)};
  // Steps of a method of the system's own, and extrapolated ones, are of its usual form, whatever is shown.
  if (own_method(*entry, run.options.method) != nullptr || run.options.method == extrapolation_method.name)
    run.options.form = system.forms().front();
  GradientSubject out;
  out.system = entry->name;
  out.steps = read.extent.steps;
  const SphereNode node(system, run.shown, {}, keeps_spheres(run.options), 1);
  for (const Field& field : node.fields())
    if (!field.drift_of && field.columns.name != "constraint_residual")
      for (const std::string& label : field.columns.components) out.observed.push_back({field.columns.name, label});
  name_start(run.start, out);
  for (const auto& [name, value] : run.system->numbers()) {
    out.parameters.push_back({"parameters", name});
    out.sizes.push_back(value);
  }
  out.tolerance = run.options.tolerance;
  if (out.tolerance > 0)
    out.notes.emplace_back(
        "derivatives hold the sizes of the inner steps that time.tolerance asks for, and are as exact as "
        "it lets runs be");
  out.begin = [run](const std::vector<std::string>& parameters, const std::vector<Nudge>& nudges) {
    return run.begin(parameters, nudges);
  };
  out.begun_by = [run](const std::vector<std::string>& parameters, const std::vector<Nudge>& nudges) {
    return run.begun_by(parameters, nudges);
  };
  return out;
}

}  // namespace lagroid::app
