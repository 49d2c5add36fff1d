#include "formula_scene.hpp"

#include "../reading/kinds.hpp"
#include "../scenes/scene_keys.hpp"
#include "../scenes/simulation.hpp"

#include <fmt/format.h>
#include <fmt/ranges.h>

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
const KeyOf<Text> hamiltonian_key{"H", {}, "", "H(x, p_x), of coordinates, momenta and the names of [parameters]"};
const KeyOf<Texts> constraints_key{"constraints", {}, "", "functions of coordinates that are zero", {}, "none"};
const KeyOf<Texts> force_key{"force", {}, "", "of each coordinate, a function as l is", {}, "none"};
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
    if (error.key() == field_key.name) table.tables(symmetry_key.name).front().fail(field_key.name, error.what());
    table.fail(error.key(), error.what());
  }
}

Eigen::VectorXd numbers_of(const Section& section, const KeyOf<NumberList>& key, std::size_t count) {
  const std::vector<double> numbers = read_key(section, key);
  if (numbers.size() != count)
    section.fail(key.name, fmt::format("has {} numbers, and there are {} coordinates", numbers.size(), count));
  return Eigen::Map<const Eigen::VectorXd>(numbers.data(), Eigen::Index(count));
}

/// The constraints, or their change along v, relative to their terms; which is the largest, counted from one.
struct OffBy {
  double value = 0;
  std::size_t which = 0;
};
OffBy off_by(const FormulaSystem& system, const Eigen::VectorXd& q, const Eigen::VectorXd* v) {
  std::vector<double> c(system.constraint_numbers());
  system.constraint(q.data(), c.data());
  const std::size_t n = std::size_t(q.size());
  OffBy worst;
  for (std::size_t a = 0; a < system.constraint_count(); ++a) {
    const double* each = c.data() + a * (c.size() / system.constraint_count());
    double sum = v ? 0 : each[0], size = 1;
    for (std::size_t i = 0; i < n; ++i) {
      const double term = each[1 + i] * (v ? *v : q)(Eigen::Index(i));
      if (v) sum += term;
      size += std::abs(term);
    }
    if (!(std::abs(sum) / size <= worst.value)) worst = {std::abs(sum) / size, a + 1};
  }
  return worst;
}
constexpr double on_it = 1e-8;

/// Position, and the velocity that a Lagrangian scene gives; the momentum is that of the scene where it gives one.
FormulaState read_start(const Section& initial, const FormulaSystem& system, const FormulaLagrangian* l, double t) {
  const std::size_t n = system.coordinates().size();
  FormulaState start;
  start.position = numbers_of(initial, position_key, n);
  if (const OffBy off = off_by(system, start.position, nullptr); !(off.value <= on_it))
    initial.fail(position_key.name, fmt::format("is off constraint {} by {:.3g}", off.which, off.value));
  if (!l || !initial.has(velocity_key.name)) {
    if (l && !initial.has(momentum_key.name)) initial.fail(velocity_key.name, "or momentum is to be given");
    start.momentum = numbers_of(initial, momentum_key, n);
    return start;
  }
  if (initial.has(momentum_key.name)) initial.fail(momentum_key.name, "is that of the velocity: leave one of them out");
  const Eigen::VectorXd v = numbers_of(initial, velocity_key, n);
  if (const OffBy off = off_by(system, start.position, &v); !(off.value <= on_it))
    initial.fail(velocity_key.name, fmt::format("leaves constraint {}: C' v = {:.3g}", off.which, off.value));
  std::vector<double> numbers(l->lagrangian_numbers());
  l->lagrangian(t, start.position.data(), v.data(), numbers.data());
  start.momentum = Eigen::Map<const Eigen::VectorXd>(numbers.data() + 1 + n, Eigen::Index(n));
  return start;
}

/// The velocity at the start. Refuses a start where there is none, and a momentum that leaves the constraints.
TangentState require_regular(const Section& scene, const SizedStep& step, const FormulaState& start, double t) {
  const Section initial = scene.section("initial", "");
  TangentState tangent;
  step.find_velocity(start.position, start.momentum, t, tangent);
  if (!tangent.found) {
    if (!std::isfinite(tangent.momentum.sum()))
      initial.fail(position_key.name, "is where a formula or its slope is no finite number");
    table_of(scene).fail(of_lagrangian(scene) ? lagrangian_key.name : hamiltonian_key.name,
                         "is degenerate at the start: momenta there do not determine the velocities, or the "
                         "constraints depend on each other");
  }
  if (!((tangent.momentum - start.momentum).norm() <= on_it * (1 + start.momentum.norm())))
    initial.fail(momentum_key.name, fmt::format("leaves the constraints; the part that does not is [{:.10g}]",
                                                fmt::join(tangent.momentum, ", ")));
  return tangent;
}

/// Refuses what is declared a symmetry and is none, near the start.
void require_symmetries(const Section& scene, const FormulaSystem& system, const FormulaState& start,
                        const Eigen::VectorXd& velocity_or_momentum, double t) {
  constexpr double rounding = 1e-10;
  const std::vector<Section> declared = table_of(scene).tables(symmetry_key.name);
  std::mt19937_64 bits(1);
  const auto draw = [&] { return std::uniform_real_distribution<double>(-1, 1)(bits); };
  for (std::size_t i = 0; i < system.symmetries().size(); ++i)
    for (int sample = 0; sample < 8; ++sample) {
      // On constraints where the start is: their change is asked for there alone.
      Eigen::VectorXd q = start.position, w = velocity_or_momentum;
      for (Eigen::Index j = 0; j < q.size(); ++j) {
        if (system.constraint_count() == 0) q(j) += 0.1 * sample * draw() * (1 + std::abs(q(j)));
        w(j) += sample * draw() * (1 + std::abs(w(j)));
      }
      const double defect = system.symmetry_defect(i, t, q.data(), w.data());
      if (std::isfinite(defect) && defect > rounding)
        declared[i].fail(
            field_key.name,
            fmt::format("is no symmetry: {} changes along it, by {:.2g} of its terms at position "
                        "[{:.4g}], {} [{:.4g}]",
                        of_lagrangian(scene) ? "l, a constraint or the work of the force" : "H or a constraint", defect,
                        fmt::join(q, ", "), of_lagrangian(scene) ? "velocity" : "momentum", fmt::join(w, ", ")));
    }
}

/// What both kinds of scenes have read.
struct FormulaRead {
  std::function<FormulaMethod()> begun, precise;
  std::shared_ptr<const FormulaSystem> system;
  FormulaState start;
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
      [=] { return method.begun(*lagrangian); },
      [=] {
        CurveMethod precise = method;
        precise.curve = {constrained ? CurveQuadrature::lobatto_pair : CurveQuadrature::gauss, 5};
        precise.composition = compositions::single;
        return precise.begun(*lagrangian);
      },
      lagrangian,
      read_start(scene.section("initial", "position, and velocity or momentum"), *lagrangian, lagrangian.get(), begin),
      curve_methods(constrained)};
  const TangentState tangent = require_regular(scene, *out.begun().step, out.start, begin);
  require_symmetries(scene, *lagrangian, out.start, tangent.velocity, begin);
  return out;
}

FormulaRead read_hamiltonian(const Section& scene, const Section& time) {
  const FormulaTexts texts = read_texts(scene);
  const Section table = table_of(scene);
  const GeneratingMethod method = read_generating_method(time, !texts.constraints.empty());
  const auto made = [&](const TaylorChoice& taylor) {
    return at_its_key(scene, [&] {
      return std::make_shared<const FormulaHamiltonian>(texts, read_key_or(table, momenta_key, {}),
                                                        read_key(table, hamiltonian_key), taylor);
    });
  };
  const auto hamiltonian = made(method.taylor);
  const bool constrained = hamiltonian->constraint_count() > 0;
  GeneratingMethod precise = method;
  precise.types = GeneratingMethod::Types::both;
  precise.taylor = {1, quadrature_rules::trapezoid};
  precise.composition = compositions::kahan_li_8;
  const auto as_precise = made(precise.taylor);
  FormulaRead out{[=] { return method.begun(*hamiltonian); }, [=] { return precise.begun(*as_precise); }, hamiltonian,
                  read_start(scene.section("initial", "position and momentum"), *hamiltonian, nullptr, 0),
                  generating_methods(constrained)};
  require_regular(scene, *out.begun().step, out.start, 0);
  require_symmetries(scene, *hamiltonian, out.start, out.start.momentum, 0);
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
  const bool constrained = table_of(scene).has(constraints_key.name);
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
  const double begin = lagrangian ? read_key(time, time_keys::start) : 0;
  FormulaRead read = lagrangian ? read_lagrangian(scene, time, begin) : read_hamiltonian(scene, time);
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
  out.motion = std::make_unique<FormulaMotion>(out.to_check.name, read.system, read.begun(), read.start,
                                               out.to_check.step, begin);
  return out;
}

}  // namespace lagroid::app
