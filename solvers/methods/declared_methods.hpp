#pragma once
/// The methods by which a system can be integrated, each declared once: name, order, what it needs of a system, source.
/// Scenes, Python, studies, citations and the errors of `make_integrator` take them from here, so that no two of them
/// differ.
///
///     const IntegrationMethod& method = integration_method("fixed", "splitting");  // throws for unknown names
///     const IntegratorOptions options = options_of(method);
///     const Composition* eighth = usual_composition(8);  // null where there is none of the order
///
/// `integration_method` and `choice_of` throw std::invalid_argument for names that are none of a method or a word.

#include <lagroid/solvers/integrators/integrator.hpp>
#include <lagroid/solvers/methods/sources.hpp>

#include <algorithm>
#include <array>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

namespace lagroid {

/// What a system has for methods to use.
struct Capabilities {
  bool variational = false;
  bool has_step = false;  ///< h, which can be changed
  bool timed = false;     ///< a variational system that is known for every step size
  bool time_scale = false;
  bool time_scale_of_arrows = false;
  bool rates = false;
  bool attractive = false;
  std::vector<Composition> splittings = {};  ///< of its flows; empty where it has none
};

/// Something that a method needs of a system.
struct Requirement {
  std::string_view what;    ///< as in "this system has no ..."
  std::string_view member;  ///< by which a system of one's own would have it; empty where no member is missing
  bool (*met)(const Capabilities&);
};

namespace requirements {

inline constexpr Requirement action{"action principle", "", [](const Capabilities& a) { return a.variational; }};
inline constexpr Requirement step{"step that can be changed", "h", [](const Capabilities& a) { return a.has_step; }};
inline constexpr Requirement every_step{"Lagrangian for every step size", "lagrangian(g, step)",
                                        [](const Capabilities& a) { return a.timed; }};
inline constexpr Requirement time_scale{"time scale to control steps by", "time_scale_rate(z)",
                                        [](const Capabilities& a) { return a.time_scale; }};
inline constexpr Requirement time_scale_of_arrows{"time scale of its arrows to prescribe steps by", "time_scale(g)",
                                                  [](const Capabilities& a) { return a.time_scale_of_arrows; }};
inline constexpr Requirement attraction{"attraction whose energy is negative everywhere", "attractive",
                                        [](const Capabilities& a) { return a.attractive; }};
inline constexpr Requirement flows{"explicit splitting", "flow<I>(t, q, mu)",
                                   [](const Capabilities& a) { return !a.splittings.empty(); }};
inline constexpr Requirement rates{"vector field written for it", "rates(z)",
                                   [](const Capabilities& a) { return a.rates; }};

inline constexpr std::array of_adaptive{action, every_step};
inline constexpr std::array of_controlled{action, every_step, time_scale};
inline constexpr std::array of_prescribed{action, every_step, time_scale_of_arrows};
inline constexpr std::array of_transformed{attraction};
inline constexpr std::array of_splitting{flows};
inline constexpr std::array of_runge_kutta{rates};
/// Of variational steps that are composed, and so have an order above two.
inline constexpr std::array of_composed_steps{action, step};

}  // namespace requirements

/// The first that the system does not meet; null where it meets them all.
inline const Requirement* unmet(std::span<const Requirement> requirements, const Capabilities& able) {
  for (const Requirement& each : requirements)
    if (!each.met(able)) return &each;
  return nullptr;
}

/// How a method comes to other orders than its own.
enum class OtherOrders {
  none,
  composed_steps,  ///< of steps of several sizes, by `compositions`
  composed_flows,  ///< of flows of the system's parts, by `compositions` and `splittings`
  preprocessed,    ///< its system is changed beforehand
};

/// What every method declares of itself.
struct DeclaredMethod {
  std::string_view name;  ///< the word for it in scenes, Python and studies
  int order = 2;
  int stages = 1;  ///< steps of order two that cost about as much
  OtherOrders other_orders = OtherOrders::none;
  bool implicit = false;    ///< [solver] solves its steps
  Source source = {};       ///< none where it is [G]'s, or classical
  bool to_compare = false;  ///< there to be compared with, and not chosen for anyone
};

/// One of those that any system can be integrated by which meets its needs.
struct IntegrationMethod : DeclaredMethod {
  TimeMode mode = TimeMode::fixed;
  StepKind fixed = StepKind::variational;
  std::span<const Requirement> needs = {};

  constexpr bool equal_steps() const { return mode == TimeMode::fixed; }
  /// Whether `tolerance` is an option of it.
  constexpr bool by_tolerance() const { return fixed == StepKind::extrapolation; }
  /// Whether `composition` and `order` are options of it.
  constexpr bool composed() const {
    return other_orders == OtherOrders::composed_steps || other_orders == OtherOrders::composed_flows;
  }
};

/// Of orders 4 to 16, whichever costs least. It goes by a tolerance, from node to node.
inline constexpr DeclaredMethod extrapolation_method{.name = "extrapolation",
                                                     .order = 16,
                                                     .stages = 8,
                                                     .source = {"deuflhard1983", "orders and steps of extrapolation"}};

/// In the order in which studies list them. The first is what there is by default.
inline constexpr std::array<IntegrationMethod, 8> declared_methods{{
    {{.name = "variational", .other_orders = OtherOrders::composed_steps, .implicit = true}},
    {{.name = "splitting", .other_orders = OtherOrders::composed_flows},
     TimeMode::fixed,
     StepKind::splitting,
     requirements::of_splitting},
    {extrapolation_method, TimeMode::fixed, StepKind::extrapolation, requirements::of_splitting},
    {{.name = "runge-kutta", .order = 4, .stages = 4, .to_compare = true},
     TimeMode::fixed,
     StepKind::runge_kutta,
     requirements::of_runge_kutta},
    {{.name = "adaptive", .implicit = true, .source = {"kane1999", "steps whose size keeps the discrete energy"}},
     TimeMode::adaptive,
     StepKind::variational,
     requirements::of_adaptive},
    {{.name = "controlled", .implicit = true, .source = {"hairer2005", "reversibly controlled steps"}},
     TimeMode::controlled,
     StepKind::variational,
     requirements::of_controlled},
    {{.name = "prescribed", .implicit = true},
     TimeMode::prescribed,
     StepKind::variational,
     requirements::of_prescribed},
    {{.name = "transformed",
      .other_orders = OtherOrders::composed_steps,
      .source = {"mikkola1999", "explicit steps of a transformed time"}},
     TimeMode::transformed,
     StepKind::variational,
     requirements::of_transformed},
}};

/// The word of [time] mode, and of Python's, for equal steps; `method` then names one.
inline constexpr std::string_view mode_of_equal_steps = "fixed";

/// The words of `mode`: equal steps, and the names of all other methods. The first is the default.
std::vector<std::string> mode_words();
/// The words of `method`: the names of all methods of equal steps. The first is the default.
std::vector<std::string> method_words();
/// The method that the words name. `method` is a word of equal steps; other modes have none. Throws
/// std::invalid_argument where there is none of these names.
const IntegrationMethod& integration_method(std::string_view mode, std::string_view method);
/// That of the options.
const IntegrationMethod& integration_method(const IntegratorOptions& options);
/// The options of a method: the defaults of everything else.
IntegratorOptions options_of(const IntegrationMethod& method);

/// A word and what it chooses.
template <class T> struct Word {
  std::string_view word;
  T choice;
};
/// `without_root` of adaptive steps; the first is the default.
inline constexpr std::array<Word<WithoutRoot>, 3> without_root_words{
    {{"stop", WithoutRoot::stop}, {"constant", WithoutRoot::constant}, {"controlled", WithoutRoot::controlled}}};
/// [solver] method of implicit steps; the first is the default.
inline constexpr std::array<Word<StepMethod>, 2> solver_words{
    {{"newton", StepMethod::newton}, {"ceres", StepMethod::ceres}}};
/// As many iterations as one may ask for.
inline constexpr int most_iterations = 100000;

template <class T, std::size_t N> std::vector<std::string> words_of(const std::array<Word<T>, N>& words) {
  std::vector<std::string> out;
  for (const auto& each : words) out.emplace_back(each.word);
  return out;
}
/// What the word, which is one of these, chooses.
template <class T, std::size_t N> T choice_of(const std::array<Word<T>, N>& words, std::string_view word) {
  for (const auto& each : words)
    if (each.word == word) return each.choice;
  throw std::invalid_argument("\"" + std::string(word) + "\" is no word for it");
}

/// The composition that stands for each order where no name is given.
inline constexpr std::array<Composition, 4> usual_compositions{compositions::single, compositions::suzuki,
                                                               compositions::kahan_li_6, compositions::kahan_li_8};
/// Null where there is none of the order.
const Composition* usual_composition(long order);
/// The orders that there are, as "2, 4, 6 or 8".
std::string usual_orders();
/// All compositions that some system has for a method.
std::vector<Composition> compositions_of(OtherOrders orders);
/// The one of these that has the name; null where there is none.
const Composition* composition_named(std::span<const Composition> offered, std::string_view name);

/// Why a system with these abilities cannot be integrated with these options: one sentence; empty where it can.
std::string why_not(const IntegratorOptions& options, const Capabilities& able);

/// A method of a system by its name, as studies and `lagroid study --list` know it.
struct NamedMethod {
  std::string name;
  int order = 2;
  int stages = 1;  ///< steps of order two that it is made of
  bool equal_steps = true;
  IntegratorOptions options{};
  bool to_compare = false;  ///< there to be compared with, and not chosen for anyone
};

/// The tolerances of a method that goes by one, as studies name them.
inline constexpr std::array<Word<double>, 3> studied_tolerances{{{"1e-6", 1e-6}, {"1e-9", 1e-9}, {"1e-12", 1e-12}}};

/// All that `make_integrator` takes of a system with these abilities, with Newton's iteration where there is one.
std::vector<NamedMethod> named_methods(const Capabilities& able);

/// The compositions of a step of order 2; the step alone where it cannot be taken back.
inline std::span<const Composition> steps_composed(bool composable) {
  return std::span(compositions::all).first(composable ? compositions::all.size() : 1);
}

/// The step's name, and that of the composition where there is more than one stage: "splitting/suzuki-4".
std::string composed_name(std::string_view step, const Composition& composition);

/// Numbers in a sentence: "2, 4, 6 or 8".
std::string any_of_these(std::span<const int> numbers);

}  // namespace lagroid
