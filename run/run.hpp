#pragma once
/// From a system and a state to a trajectory, its ledger and its files: z_{k+1} = F(z_k), recorded, judged and, where a
/// folder is named, written.
///
/// One call gives a system of one's own what `lagroid run` gives a scene.
///
///     RunResult result = run(Dido{}, {{0, 0}, {1, 0, 1}}, {.steps = 126, .folder = "out/dido"});
///     std::cout << text_report(result);
///     return result.converged() ? 0 : 1;
///
/// Requires a system that is a DiscreteSystem, and a start with finite numbers; it links lagroid::run. Returns a
/// RunResult, also of a run that ended early: RunResult::status has the reason, and RunResult::output_error why files
/// could not be written.
///
/// Errors: std::invalid_argument, FolderRefused and RunError, as listed at `run`.

#include <lagroid/run/files/output.hpp>
#include <lagroid/run/files/program_scene.hpp>
#include <lagroid/run/motion/drive.hpp>
#include <lagroid/run/motion/system_marks.hpp>
#include <lagroid/run/motion/system_motion.hpp>
#include <lagroid/run/reports/report.hpp>
#include <lagroid/solvers/integrators/fixed_step_integrator.hpp>
#include <lagroid/solvers/integrators/integrator_of.hpp>
#include <lagroid/solvers/step/newton_step.hpp>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

namespace lagroid {

/// Options of `run`.
template <DiscreteSystem Sys> struct RunOptions {
  using G = typename Sys::GroupoidType;

  long steps = 1000;
  std::string name = "system";                ///< in reports: one line of text
  std::optional<ArrowOf<G>> configuration{};  ///< an arrow that ends at the start's object, as an attitude; its unit
  std::filesystem::path folder{};             ///< for trajectory, summary and plots; empty: no files
  bool resume = false;                        ///< go on with the run in the folder until it has so many steps
  long every = 1;                             ///< each n-th node is recorded (and the last)
  bool progress = false;                      ///< a bar on the terminal
  std::optional<Presentation<Sys>> presentation{};  ///< labels, panels and shapes of one's own
  std::vector<Event> events{};                      ///< that are watched for
};

/// Columns q1, q2, ... of the object and mu1, mu2, ... of the momentum, g1, g2, ... of the configuration where it
/// does not follow from the objects, and panels of these and of every quantity's drift. Objects of two or three
/// coordinates are drawn as a point that leaves a trail.
template <DiscreteSystem Sys>
Presentation<Sys> plain_presentation(const Sys& system, std::string name, std::span<const Quantity<Sys>> quantities);

namespace detail {

/// head1, head2, ..., or head alone.
std::vector<std::string> numbered(std::string_view head, std::size_t count);

/// Throws std::invalid_argument unless these are the counts of a run.
void require_counts(long steps, long every);

/// `go`, which runs a motion into the result, with files in `folder` where there is one. A disk that is full costs the
/// files only: RunResult::output_error.
void run_with_files(RunResult& result, const std::filesystem::path& folder, bool resume, const std::string& scene,
                    const std::function<void(const RunContext&)>& go);

}  // namespace detail

/// Runs an integrator of the system that was made with the options `how` (`make_integrator`), to be recorded from its
/// present point on. The ledger holds the constraints, the system's quantities or, of one that declares symmetries
/// alone, their momenta; and the discrete energy where the Lagrangian has the step as its argument.
///
/// A step that fails, Ctrl-C or SIGTERM ends the run with what was computed so far, and RunResult::status is the
/// reason. Throws std::invalid_argument for a name that is not one line of text, a start that is not finite, or steps
/// and every that count nothing; FolderRefused where the folder holds something else or is not to be written in;
/// RunError where it holds no run, or one of another system, with other parameters, from another start or by another
/// method, to go on with, and for events that cannot be watched for (EventWatch).
template <DiscreteSystem Sys>
RunResult run(const Sys& system, std::unique_ptr<Integrator<Sys>> integrator, const IntegratorOptions& how,
              const RunOptions<Sys>& options) {
  using G = typename Sys::GroupoidType;
  detail::require_counts(options.steps, options.every);
  auto quantities = watched(system, how);
  Presentation<Sys> presentation =
      with_step_sizes(options.presentation.value_or(plain_presentation<Sys>(system, options.name, quantities)), how);
  const TrajectoryPoint<Sys> start = integrator->point();
  const MethodTraits method = integrator->traits();
  double step = 0;
  if constexpr (HasTimeStep<Sys>) step = system.h;
  const G& groupoid = system.groupoid;
  const auto object = groupoid.coordinates_of_object(start.state.object);
  const auto configuration = groupoid.coordinates_of_arrow(start.configuration);
  const auto flat = [](const auto& v) { return std::span<const double>(v.data(), std::size_t(v.size())); };
  const auto marks = marks_of(system, start.state.object);
  const std::string scene = scene_of_program({presentation.name, description(method), step, options.every, flat(marks),
                                              flat(object), flat(start.state.momentum), flat(configuration)});
  SystemMotion<Sys> motion(system, std::move(presentation), std::move(quantities), std::move(integrator), how);
  RunResult result;
  detail::run_with_files(result, options.folder, options.resume, scene, [&](RunContext context) {
    context.progress = options.progress;
    drive(motion, {options.steps, options.every, 0, scene, options.events}, context, result);
  });
  return result;
}

/// Runs a system from a state by equal steps of its discrete Lagrangian, each solved by Newton's iteration to
/// round-off. For other methods include `run_by.hpp`. `text_report(result)` is the ledger in words.
///
///     RunResult result = run(Dido{}, {{0, 0}, {1, 0, 1}}, {.steps = 126, .folder = "out/dido"});
///     std::cout << text_report(result);
template <DiscreteSystem Sys>
RunResult run(const Sys& system, const State<typename Sys::GroupoidType>& start, const RunOptions<Sys>& options = {}) {
  const auto configuration = options.configuration.value_or(system.groupoid.unit(start.object));
  return run<Sys>(system,
                  std::make_unique<detail::IntegratorOf<Sys, FixedStepIntegrator<Sys>>>(
                      system, start, configuration, std::make_unique<NewtonStep<Sys>>()),
                  IntegratorOptions{}, options);
}

template <DiscreteSystem Sys>
Presentation<Sys> plain_presentation(const Sys& system, std::string name, std::span<const Quantity<Sys>> quantities) {
  using G = typename Sys::GroupoidType;
  constexpr int objects = G::object_coordinate_count();
  constexpr int arrows = G::arrow_coordinate_count();
  const G groupoid = system.groupoid;
  Presentation<Sys> p;
  p.name = std::move(name);
  p.position = detail::numbered("q", objects);
  p.position_unit = "of the object's coordinates";
  p.momentum = detail::numbered("mu", G::dimension);
  p.momentum_unit = "action / unit of the retraction's coordinates";
  p.multipliers = detail::numbered("lambda", Sys::constraints);
  p.position_of = [groupoid](const TrajectoryPoint<Sys>& point) {
    const auto q = groupoid.coordinates_of_object(point.state.object);
    return std::vector<double>(q.data(), q.data() + q.size());
  };
  if (objects > 0) p.panels.push_back({"object", "t", "q", "t", p.position});
  p.panels.push_back({"momentum", "t", "mu", "t", p.momentum});
  if constexpr (arrows != 2 * objects) {
    const auto labels = detail::numbered("g", arrows);
    p.extras.push_back({{"configuration", labels, "of the arrow's coordinates", "g_0 g_1 ... g_k", false, {}},
                        [groupoid](const TrajectoryPoint<Sys>& point, double* out) {
                          const auto g = groupoid.coordinates_of_arrow(point.configuration);
                          std::copy(g.data(), g.data() + g.size(), out);
                        }});
    p.panels.push_back({"configuration", "t", "g", "t", labels});
  }
  for (const auto& q : quantities)
    p.panels.push_back({q.name + " error", "t", "|deviation|", "t", {"drift " + q.name}});
  if (objects == 2 || objects == 3) {
    Shape point{"sphere", {0.03}};
    point.position = {p.position[0], p.position[1], objects == 3 ? Coordinate(p.position[2]) : Coordinate(0.0)};
    point.trail = true;
    p.shapes = {point};
  }
  p.conventions = {{"state", "object q and momentum mu in A*G at the nodes, in the basis of the retraction"}};
  return p;
}

}  // namespace lagroid
