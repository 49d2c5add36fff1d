#include "formula_scene.hpp"

#include "../reading/kinds.hpp"
#include "../scenes/scene_keys.hpp"
#include "../scenes/simulation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <Eigen/LU>
#include <Eigen/QR>

#include <cmath>
#include <filesystem>
#include <random>
#include <utility>

namespace lagroid::app {

namespace {

const KeyOf<Texts> coordinates_key{"coordinates", {}, "", "names; that of x has the velocity x'"};
const KeyOf<Text> lagrangian_key{
    "l", {}, "", "l(t, x, x'), of coordinates, velocities, t and the names of [parameters]"};
const KeyOf<Texts> momenta_key{"momenta", {}, "", "names", {}, "p_x of each coordinate x"};
const KeyOf<Text> hamiltonian_key{
    "H", {}, "", "H(t, x, p_x), of coordinates, momenta, t and the names of [parameters]"};
const KeyOf<Texts> constraints_key{"constraints", {}, "", "functions of coordinates that are zero", {}, "none"};
const KeyOf<Texts> force_key{"force", {}, "", "its components, functions as l is", {}, "none"};
const KeyOf<Text> symmetry_name_key{"name", {}, "", "of its momentum"};
const KeyOf<Texts> field_key{"field", {}, "", "how the coordinates move, functions of them"};
const KeyOf<Tables> symmetry_key{
    "symmetry", {{{symmetry_name_key, field_key}}}, "", "whose momentum <p, field> is watched", {}, "none"};
const KeyOf<NumberList> position_key{"position", {}, "", "the coordinates"};
const KeyOf<NumberList> velocity_key{"velocity", {}, "", "theirs", {}, "`momentum` is given"};
const KeyOf<NumberList> momentum_or_velocity_key{"momentum", {}, "", "dl/dx' of each", {}, "`velocity` is given"};
const KeyOf<NumberList> momentum_key{"momentum", {}, "", "of each coordinate"};

bool of_lagrangian(const Section& scene) {
  return scene.choice(keys::system, {std::string(keys::lagrangian), std::string(keys::hamiltonian)}) ==
         keys::lagrangian;
}
Section table_of(const Section& scene) {
  return of_lagrangian(scene) ? scene.section(keys::lagrangian, "coordinates and l")
                              : scene.section(keys::hamiltonian, "coordinates and H");
}

/// The numbers of [parameters], by whatever names.
std::vector<std::pair<std::string, double>> read_numbers(const Section& scene) {
  std::vector<std::pair<std::string, double>> all;
  const Section section = scene.section_or_empty("parameters");
  for (const std::string& each : section.as_overrides()) {
    const std::string name = each.substr(0, each.find('='));
    if (const std::size_t table = name.find('.'); table != std::string::npos)
      section.fail(name.substr(0, table), "expected a number, got a table");
    all.emplace_back(name, section.number(name));
  }
  return all;
}

FormulaTexts read_texts(const Section& scene) {
  const Section table = table_of(scene);
  FormulaTexts texts{
      read_key(table, coordinates_key), read_key_or(table, constraints_key, {}), {}, read_numbers(scene)};
  for (const Section& each : table.tables(symmetry_key.name))
    texts.symmetries.push_back({read_key(each, symmetry_name_key), read_key(each, field_key)});
  return texts;
}

/// What `make` makes, of texts whose mistakes are told at their keys.
template <class Make> auto at_its_key(const Section& scene, const Make& make) {
  try {
    return make();
  } catch (const FormulaError& error) {
    if (error.key() == "parameters") scene.fail("parameters", error.what());
    const Section table = table_of(scene);
    if (error.key() == field_key.name || error.key() == symmetry_name_key.name)
      table.tables(symmetry_key.name)[error.which()].fail(error.key(), error.what());
    table.fail(error.key(), error.what());
  }
}

Eigen::VectorXd numbers_of(const Section& section, const KeyOf<NumberList>& key, std::size_t count) {
  const std::vector<double> numbers = read_key(section, key);
  if (numbers.size() != count)
    section.fail(key.name, fmt::format("has {} numbers, and there are {} coordinates", numbers.size(), count));
  return Eigen::Map<const Eigen::VectorXd>(numbers.data(), Eigen::Index(count));
}

constexpr double on_it = 1e-8;

/// Position and momentum, and the velocity where a Lagrangian scene gives it.
SizedState read_start(const Section& initial, const FormulaSystem& system, const FormulaLagrangian* l, double t) {
  const std::size_t n = system.coordinates().size();
  SizedState start;
  start.position = numbers_of(initial, position_key, n);
  if (const OffConstraint off = system.off_constraints(start.position, start.position.norm()); !(off.share <= on_it))
    initial.fail(position_key.name,
                 fmt::format("is off constraint {}, by {:.3g} of its distance from the origin", off.which, off.share));
  if (!l || !initial.has(velocity_key.name)) {
    if (l && !initial.has(momentum_key.name)) initial.fail(velocity_key.name, "or momentum is to be given");
    start.momentum = numbers_of(initial, momentum_key, n);
    return start;
  }
  if (initial.has(momentum_key.name)) initial.fail(momentum_key.name, "is that of the velocity: leave one of them out");
  start.velocity = numbers_of(initial, velocity_key, n);
  if (const OffConstraint off = system.leaving_constraints(start.position, start.velocity); !(off.share <= on_it))
    initial.fail(velocity_key.name, fmt::format("leaves constraint {}, by {:.3g} of its size", off.which, off.share));
  std::vector<double> numbers(l->lagrangian_numbers());
  l->lagrangian(t, start.position.data(), start.velocity.data(), numbers.data());
  start.momentum = Eigen::Map<const Eigen::VectorXd>(numbers.data() + 1 + n, Eigen::Index(n));
  return start;
}

/// Completes the start by its velocity. Refuses one where there is none, or that leaves the constraints.
void require_regular(const Section& scene, const FormulaSystem& system, const SizedStep& step, SizedState& start,
                     double t) {
  const Section initial = scene.section("initial", "");
  const Section table = table_of(scene);
  if (system.constraint_count() > 0) {
    Eigen::MatrixXd slopes = system.constraint_rows(start.position).rightCols(start.position.size());
    for (Eigen::Index a = 0; a < slopes.rows(); ++a) slopes.row(a) /= slopes.row(a).norm();
    if (!slopes.allFinite() || slopes.colPivHouseholderQr().rank() < slopes.rows())
      table.fail(constraints_key.name, "depend on each other at the start, or one has no slope there");
  }
  TangentState tangent;
  step.find_velocity(start, t, tangent);
  if (!std::isfinite(tangent.momentum.sum()) || !std::isfinite(tangent.energy))
    initial.fail(position_key.name, "is where a formula or its slope is no finite number");
  if (!tangent.found)
    table.fail(of_lagrangian(scene) ? lagrangian_key.name : hamiltonian_key.name,
               "is degenerate at the start: momenta there do not determine the velocities");
  if (start.velocity.size() > 0 && !((tangent.velocity - start.velocity).norm() <= on_it * start.velocity.norm()))
    initial.fail(velocity_key.name, "is where l is degenerate: the momentum does not determine it");
  if (!((tangent.momentum - start.momentum).norm() <= on_it * start.momentum.norm()))
    initial.fail(momentum_key.name, fmt::format("leaves the constraints; the part that does not is [{:.10g}]",
                                                fmt::join(tangent.momentum, ", ")));
  start.velocity = tangent.velocity;
}

/// The nearest place on the constraints, and v without what leaves them there.
void bring_to_constraints(const FormulaSystem& system, Eigen::VectorXd& q, Eigen::VectorXd& v) {
  q = detail::place_on_constraints([&](const Eigen::VectorXd& at) { return system.constraint_rows(at); }, q);
  const Eigen::MatrixXd slope = system.constraint_rows(q).rightCols(q.size());
  v -= slope.transpose() * (slope * slope.transpose()).partialPivLu().solve(slope * v);
}

/// Refuses what is declared a symmetry and is none, near the start and at times of the run.
void require_symmetries(const Section& scene, const FormulaSystem& system, const SizedState& start, bool by_velocity,
                        double begin, double duration) {
  constexpr double rounding = 1e-9;
  constexpr int samples = 12;
  const std::vector<Section> declared = table_of(scene).tables(symmetry_key.name);
  std::mt19937_64 bits(1);
  const auto draw = [&] { return std::uniform_real_distribution<double>(-1, 1)(bits); };
  const Eigen::VectorXd& along = by_velocity ? start.velocity : start.momentum;
  const double place = 0.1 * (start.position.norm() > 0 ? start.position.norm() : 1);
  const double size = along.norm() > 0 ? along.norm() : 1;
  for (std::size_t i = 0; i < system.symmetries().size(); ++i) {
    int finite = 0;
    for (int sample = 0; sample < samples; ++sample) {
      Eigen::VectorXd q = start.position, w = along;
      for (Eigen::Index j = 0; j < q.size(); ++j) {
        q(j) += sample > 0 ? place * draw() : 0;
        w(j) += sample > 0 ? size * draw() : 0;
      }
      if (system.constraint_count() > 0) bring_to_constraints(system, q, w);
      const double t = begin + duration * 0.5 * (1 + draw());
      const double defect = system.symmetry_defect(i, t, q.data(), w.data());
      if (!std::isfinite(defect)) continue;
      ++finite;
      if (defect > rounding)
        declared[i].fail(
            field_key.name,
            fmt::format("is no symmetry: {} changes along it, by {:.2g} of its terms at t = {:.4g}, position "
                        "[{:.4g}], {} [{:.4g}]",
                        by_velocity ? "l, a constraint or the work of the force" : "H or a constraint", defect, t,
                        fmt::join(q, ", "), by_velocity ? "velocity" : "momentum", fmt::join(w, ", ")));
    }
    if (finite == 0)
      declared[i].fail(field_key.name, "cannot be examined: l or its slope is no finite number near the start");
  }
}

/// What both kinds of scenes have read.
struct FormulaRead {
  std::function<FormulaMethod(const FormulaSystem&)> begun;
  std::function<FormulaMethod()> precise;
  std::shared_ptr<const FormulaSystem> system;
  SizedState start;
  std::vector<Method> methods;
};

FormulaRead read_lagrangian(const Section& scene, const Section& time, double begin) {
  const FormulaTexts texts = read_texts(scene);
  const Section table = table_of(scene);
  const auto lagrangian = at_its_key(scene, [&] {
    return std::make_shared<const FormulaLagrangian>(texts, read_key(table, lagrangian_key),
                                                     read_key_or(table, force_key, {}));
  });
  const bool constrained = lagrangian->constraint_count() > 0;
  const CurveMethod method = read_curve_method(time, constrained);
  FormulaRead out{
      [=](const FormulaSystem& it) { return method.begun(dynamic_cast<const FormulaLagrangian&>(it)); },
      [=] {
        CurveMethod precise = method;
        precise.curve = {constrained ? CurveQuadrature::lobatto_pair : CurveQuadrature::gauss, 5};
        precise.composition = compositions::single;
        return precise.begun(*lagrangian);
      },
      lagrangian,
      read_start(scene.section("initial", "position, and velocity or momentum"), *lagrangian, lagrangian.get(), begin),
      curve_methods(constrained)};
  require_regular(scene, *lagrangian, *out.begun(*out.system).step, out.start, begin);
  const TimeGrid grid = read_time(scene);
  require_symmetries(scene, *lagrangian, out.start, true, begin, grid.step * double(grid.steps));
  return out;
}

FormulaRead read_hamiltonian(const Section& scene, const Section& time, double begin) {
  const FormulaTexts texts = read_texts(scene);
  const Section table = table_of(scene);
  const GeneratingMethod method = read_generating_method(time, !texts.constraints.empty());
  const auto made = [texts, momenta = read_key_or(table, momenta_key, {}),
                     text = read_key(table, hamiltonian_key)](const TaylorChoice& taylor) {
    return std::make_shared<const FormulaHamiltonian>(texts, momenta, text, taylor);
  };
  const auto hamiltonian = at_its_key(scene, [&] { return made(method.taylor); });
  const bool constrained = hamiltonian->constraint_count() > 0;
  GeneratingMethod precise = method;
  precise.types = GeneratingMethod::Types::both;
  precise.taylor = {1, quadrature_rules::trapezoid};
  precise.composition = compositions::kahan_li_8;
  // Made where it is asked for first: its formulas take as long to derive as the scene's.
  const auto as_precise = [=, kept = std::shared_ptr<const FormulaHamiltonian>()]() mutable {
    if (!kept) kept = made(precise.taylor);
    return precise.begun(*kept);
  };
  FormulaRead out{[=](const FormulaSystem& it) { return method.begun(dynamic_cast<const FormulaHamiltonian&>(it)); },
                  as_precise, hamiltonian,
                  read_start(scene.section("initial", "position and momentum"), *hamiltonian, nullptr, begin),
                  generating_methods(constrained)};
  require_regular(scene, *hamiltonian, *out.begun(*out.system).step, out.start, begin);
  const TimeGrid grid = read_time(scene);
  require_symmetries(scene, *hamiltonian, out.start, false, begin, grid.step * double(grid.steps));
  return out;
}

}  // namespace

bool is_formula_word(std::string_view word) { return word == keys::lagrangian || word == keys::hamiltonian; }

Table formula_table(std::string_view word) {
  if (word == keys::lagrangian) return {{coordinates_key, lagrangian_key, constraints_key, force_key, symmetry_key}};
  return {{coordinates_key, momenta_key, hamiltonian_key, constraints_key, symmetry_key}};
}

Table formula_start_table(std::string_view word) {
  if (word == keys::lagrangian) return {{position_key, velocity_key, momentum_or_velocity_key}};
  return {{position_key, momentum_key}};
}

Table formula_time_table(std::string_view word) {
  Table table{grid_keys()};
  for (const Key& key : word == keys::lagrangian ? curve_method_keys() : generating_method_keys())
    table.keys.push_back(key);
  return table;
}

std::vector<Use> uses_of_formula(const Section& scene) {
  std::vector<Use> uses;
  const Section time = scene.section_or_empty("time");
  const bool constrained = !read_key_or(table_of(scene), constraints_key, {}).empty();
  if (of_lagrangian(scene)) {
    const CurveMethod method = read_curve_method(time, constrained);
    add_use(method.source, uses);
    add_use(source_of(method.composition), uses);
  } else {
    add_use(generating_source, uses);
    add_use(source_of(read_generating_method(time, constrained).composition), uses);
  }
  return uses;
}

FormulaScene read_formula(const Section& scene, const RunContext& context) {
  const Section time = scene.section("time", "step and steps, or duration and steps");
  refuse_accuracy(scene);
  const bool lagrangian = of_lagrangian(scene);
  const double begin = read_key(time, time_keys::start);
  FormulaRead read = lagrangian ? read_lagrangian(scene, time, begin) : read_hamiltonian(scene, time, begin);
  FormulaScene out;
  out.to_check = {std::filesystem::path(scene.file()).stem().string(),
                  read.system,
                  read.begun,
                  read.precise,
                  read.start,
                  read_time(scene).step,
                  begin};
  out.extent = read_extent(scene, context);
  scene.finish();
  out.methods = std::move(read.methods);
  std::unique_ptr<FormulaSystem> own = read.system->clone();
  FormulaMethod method = read.begun(*own);
  out.motion = std::make_unique<FormulaMotion>(out.to_check.name, std::move(own), std::move(method), read.start,
                                               out.to_check.step, begin);
  return out;
}

}  // namespace lagroid::app
