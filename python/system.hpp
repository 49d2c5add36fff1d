#pragma once
/// A discrete Lagrangian system of one's own as a Python class (docs/python.md).
///
///     PYBIND11_MODULE(mine, module) {
///       lagroid::python::bind_system<MySystem>(module, "MySystem", "What it is.");
///     }
///
/// What it makes is the class Integrator of the package lagroid.

#include <lagroid/core/noether.hpp>
#include <lagroid/core/parameter.hpp>
#include <lagroid/python/numbers.hpp>
#include <lagroid/python/rows.hpp>
#include <lagroid/run/motion/system_motion.hpp>
#include <lagroid/solvers/boundary/boundary_values.hpp>
#include <lagroid/solvers/boundary/boundary_words.hpp>
#include <lagroid/solvers/generating/constrained_momentum.hpp>
#include <lagroid/solvers/integrators/integrator.hpp>
#include <lagroid/solvers/methods/declared_methods.hpp>

#include <pybind11/eigen.h>
#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>
#include <pybind11/stl.h>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <memory>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <type_traits>
#include <utility>
#include <vector>

namespace lagroid::python {

namespace py = pybind11;
using Array = py::array_t<double, py::array::f_style | py::array::forcecast>;

namespace detail {

/// A class of the module that every system works with, imported where it is not yet.
inline py::object class_of_lagroid(const char* name) { return py::module_::import("lagroid._lagroid").attr(name); }

/// The shape in which arrows of the groupoid are shown: that of the matrix, or the number of coordinates.
template <class G> std::vector<std::size_t> arrow_shape() {
  using A = ArrowOf<G>;
  if constexpr (lagroid::detail::EigenValued<A>) {
    if constexpr (A::ColsAtCompileTime > 1) return {A::RowsAtCompileTime, A::ColsAtCompileTime};
  }
  return {std::size_t(G::arrow_coordinate_count())};
}

/// `count` finite numbers of an array of one dimension or, columns first, of the given shape.
inline std::vector<double> numbers(const Array& array, std::size_t count, const std::string& what,
                                   const std::vector<std::size_t>& shape = {}) {
  if (array.ndim() > 1) {
    const std::vector<std::size_t> found(array.shape(), array.shape() + array.ndim());
    if (found != shape) {
      const auto words = [](const auto& of) { return std::string(py::str(py::tuple(py::cast(of)))); };
      throw py::value_error(fmt::format("{}: expected {} numbers{}, got an array of shape {}", what, count,
                                        shape.size() > 1 ? " or shape " + words(shape) : "", words(found)));
    }
  }
  if (std::size_t(array.size()) != count)
    throw py::value_error(fmt::format("{}: expected {} numbers, got {}", what, count, array.size()));
  std::vector<double> out(array.data(), array.data() + count);
  for (const double x : out)
    if (!std::isfinite(x)) throw py::value_error(fmt::format("{}: must be finite, got {}", what, x));
  return out;
}

template <class V> V vector_of(const Array& array, const std::string& what) {
  return Eigen::Map<const V>(numbers(array, V::SizeAtCompileTime, what).data());
}

/// The arrow of these coordinates, if it is one: the equations of G hold, its inverse is one, and it is connected to
/// the units, which a reflection is not. `what` names it in messages.
template <class G> ArrowOf<G> arrow_of(const G& groupoid, const Array& array, const std::string& what) {
  using V = Vector<double, G::arrow_coordinate_count()>;
  const auto read = numbers(array, V::SizeAtCompileTime, what, arrow_shape<G>());
  const ArrowOf<G> arrow = groupoid.template arrow_at<double>(V(Eigen::Map<const V>(read.data())));
  const auto same = [&](const ArrowOf<G>& a, const ArrowOf<G>& b, double tolerance) {
    const V x = groupoid.coordinates_of_arrow(a);
    return (x - groupoid.coordinates_of_arrow(b)).norm() <= tolerance * (1 + x.norm());
  };
  constexpr double on_it = 1e-8;
  if (!same(groupoid.project(arrow), arrow, on_it) ||
      !same(groupoid.unit(groupoid.target(arrow)), groupoid.multiply(groupoid.inverse(arrow), arrow), on_it))
    throw py::value_error(what + ": no arrow of " + G::name());
  // A retraction may miss single arrows, as Cayley's the half turns: it then reaches some of those near them.
  for (int k = 0; k < 8; ++k) {
    AlgebroidVector<G> v;
    for (int i = 0; i < v.size(); ++i) v(i) = std::sin(k * (i + 1.0));
    const ArrowOf<G> near = groupoid.multiply(arrow, groupoid.tau(groupoid.target(arrow), v));
    constexpr double reached = 1e-6;  // what is lost near arrows that it misses
    if (same(groupoid.tau(groupoid.source(near), groupoid.tau_inverse(near)), near, reached)) return arrow;
  }
  throw py::value_error(what + ": no arrow of " + G::name() + " that is connected to its units");
}

/// Refuses a time step that is none.
template <class Sys> void require_step(const Sys& system) {
  if constexpr (HasTimeStep<Sys>) {
    if (!std::isfinite(system.h) || system.h == 0) throw py::value_error("h: the step must be finite and not zero");
  }
}

/// Whether instances of the class have a parameter of this name: a property that can be set.
inline bool is_parameter(const py::handle& type, const py::handle& name) {
  if (!py::hasattr(type, name)) return false;
  const py::object found = type.attr(name);
  return PyObject_TypeCheck(found.ptr(), &PyProperty_Type) != 0 && !found.attr("fset").is_none();
}

/// A system with these parameters, the others as they are by default.
template <class Sys> Sys with_parameters(const py::dict& parameters) {
  Sys system;
  const py::object self = py::cast(&system, py::return_value_policy::reference);
  const py::handle type = py::type::handle_of(self);
  for (const auto& [key, value] : parameters) {
    if (!is_parameter(type, key))
      throw py::type_error(fmt::format("{} has no parameter {}", std::string(py::str(type.attr("__name__"))),
                                       std::string(py::str(key))));
    py::setattr(self, key, value);
  }
  return system;
}

/// The parameters of a system by name.
template <class Sys> py::dict parameters_of(const py::object& self) {
  const py::type type = py::type::of<Sys>();
  py::dict out;
  for (const py::handle name : py::reinterpret_steal<py::list>(PyObject_Dir(type.ptr())))
    if (is_parameter(type, name)) out[name] = type.attr(name).attr("fget")(self);
  return out;
}

/// What a parameter with this value is, in words.
inline std::string kind_of(const py::object& value) {
  if (py::isinstance<py::bool_>(value)) return "True or False";
  if (py::isinstance<py::int_>(value)) return "a whole number";
  if (py::isinstance<py::float_>(value)) return "a number";
  if (py::isinstance<py::str>(value)) return "a word";
  if (py::isinstance<py::array>(value)) return fmt::format("{} numbers", py::cast<py::array>(value).size());
  return py::str(py::type::of(value).attr("__name__"));
}

/// Sets an attribute. A parameter of the wrong type is a TypeError of one line with its name.
inline void set_attribute(const py::object& self, const py::str& name, const py::object& value) {
  if (PyObject_GenericSetAttr(self.ptr(), name.ptr(), value.ptr()) == 0) return;
  const py::error_already_set error;
  const py::type type = py::type::of(self);
  const bool of_its_setter =
      std::string_view(error.what()).find("incompatible function arguments") != std::string::npos;
  if (!error.matches(PyExc_TypeError) || !of_its_setter) throw error;
  throw py::type_error(fmt::format("{}: {}: expected {}, got {}", std::string(py::str(type.attr("__name__"))),
                                   std::string(name), kind_of(self.attr(name)),
                                   std::string(py::str(py::type::of(value).attr("__name__")))));
}

/// A copy, which its giver does not change any more.
inline py::object kept(const std::optional<Array>& array) {
  return array ? py::object(array->attr("copy")()) : py::object(py::none());
}

template <class V> void put(const V& v, double* out) { std::copy(v.data(), v.data() + v.size(), out); }

/// One of the words, by its place.
template <class Words> std::size_t choice(const char* key, const std::string& word, const Words& words) {
  const auto found = std::find(words.begin(), words.end(), word);
  if (found != words.end()) return std::size_t(found - words.begin());
  std::string all;
  for (const auto& each : words) all += (all.empty() ? "" : ", ") + std::string(each);
  throw py::value_error(std::string(key) + ": \"" + word + "\" is none of " + all);
}
/// What a declared word chooses.
template <class T, std::size_t N>
T choice(const char* key, const std::string& word, const std::array<Word<T>, N>& words) {
  return words[choice(key, word, words_of(words))].choice;
}

/// The property of a declared parameter (core/parameter.hpp). A vector is read as an array of its own.
template <class Sys, class Owner, class Member>
void bind_parameter(py::class_<Sys>& made, const Parameter<Owner, Member>& p) {
  const std::string name(p.name);
  const std::string doc = fmt::format("{}{}{}", p.meaning, p.unit.empty() ? "" : ", ", p.unit);
  if constexpr (std::is_arithmetic_v<Member>) {
    made.def_property(
        name.c_str(), [p](const Sys& self) { return self.*p.member; },
        [p](Sys& self, double x) { self.*p.member = Member(finite(p.name, x, p.rule)); }, doc.c_str());
  } else {
    made.def_property(
        name.c_str(),
        [p](const Sys& self) {
          py::array_t<double> out((self.*p.member).size(), (self.*p.member).data());
          out.attr("flags").attr("writeable") = false;
          return out;
        },
        [p](Sys& self, const Array& given) {
          auto v = vector_of<Member>(given, std::string(p.name));
          for (const double x : v) finite(p.name, x, p.rule, fmt::format("{} ", p.meaning));
          if (p.direction) {
            if (v.norm() == 0) throw py::value_error(fmt::format("{}: is no direction: all zero", p.name));
            v.normalize();
          }
          self.*p.member = v;
        },
        doc.c_str());
  }
}
template <class Sys, class Owner, class Enum, std::size_t N>
void bind_parameter(py::class_<Sys>& made, const Choice<Owner, Enum, N>& p) {
  made.def_property(
      std::string(p.name).c_str(), [p](const Sys& self) { return std::string(p.words[std::size_t(self.*p.member)]); },
      [p](Sys& self, const std::string& word) {
        self.*p.member = Enum(choice(std::string(p.name).c_str(), word, p.words));
      },
      std::string(p.meaning).c_str());
}

/// `order` and `composition` of a method.
inline Composition composition_of(const IntegrationMethod& method, std::optional<int> order,
                                  const std::optional<std::string>& name) {
  if (!method.composed()) {
    if (name || order.value_or(method.order) != method.order)
      throw py::value_error(fmt::format("order: of \"{}\" is {}, without a composition", method.name, method.order));
    return compositions::single;
  }
  if (name) {
    const std::vector<Composition> offered = compositions_of(method.other_orders);
    std::vector<std::string> names;
    for (const auto& each : offered) names.emplace_back(each.name);
    const Composition& named = offered[choice("composition", *name, names)];
    if (order && named.order != *order)
      throw py::value_error(fmt::format("composition: \"{}\" is of order {}", *name, named.order));
    return named;
  }
  const Composition* const usual = usual_composition(order.value_or(method.order));
  if (usual == nullptr) throw py::value_error("order: must be " + usual_orders());
  return *usual;
}

/// The keys of [time] and [solver] of a scene.
inline IntegratorOptions integrator_options(const std::string& mode, const std::string& method,
                                            std::optional<int> order, const std::optional<std::string>& composition,
                                            const std::string& without_root, int max_iterations, double tolerance) {
  choice("mode", mode, mode_words());
  choice("method", method, method_words());
  const IntegrationMethod& declared = integration_method(mode, method);
  IntegratorOptions options = options_of(declared);
  options.without_root = choice("without_root", without_root, without_root_words);
  options.composition = composition_of(declared, order, composition);
  if (max_iterations < 0 || max_iterations > most_iterations)
    throw py::value_error(fmt::format("max_iterations: must be from 0 to {}, got {}", most_iterations, max_iterations));
  if (!std::isfinite(tolerance)) throw py::value_error(fmt::format("tolerance: must be finite, got {}", tolerance));
  if (tolerance < 0) throw py::value_error(fmt::format("tolerance: must be zero or positive, got {}", tolerance));
  options.step.max_iterations = max_iterations;
  if (declared.by_tolerance()) {
    if (tolerance == 0)
      throw py::value_error(fmt::format("tolerance: {} takes its order and its steps from one", method));
    options.tolerance = tolerance;
  } else {
    options.step.tolerance = tolerance;
  }
  return options;
}

}  // namespace detail

/// What is seen of a system in Python: `count_of_fields` fields of every system, and then each of its quantities.
template <DiscreteSystem Sys>
std::vector<FieldOf<Sys>> fields_of(const Sys& system, const std::vector<Quantity<Sys>>& quantities) {
  using G = typename Sys::GroupoidType;
  using Point = TrajectoryPoint<Sys>;
  const G groupoid = system.groupoid;
  std::vector<FieldOf<Sys>> all{
      {field_of("object", {std::size_t(G::object_coordinate_count())}),
       [=](const Point& p, double* out) { detail::put(groupoid.coordinates_of_object(p.state.object), out); }},
      {field_of("momentum", {std::size_t(G::dimension)}),
       [](const Point& p, double* out) { detail::put(p.state.momentum, out); }},
      {field_of("configuration", detail::arrow_shape<G>()),
       [=](const Point& p, double* out) { detail::put(groupoid.coordinates_of_arrow(p.configuration), out); }},
      {field_of("arrow", detail::arrow_shape<G>(), true),
       [=](const Point& p, double* out) { detail::put(groupoid.coordinates_of_arrow(p.step.arrow), out); }},
      {field_of("multipliers", {std::size_t(Sys::constraints)}, true),
       [](const Point& p, double* out) { detail::put(p.step.multipliers, out); }},
      {field_of("step_size", {1}, true), [](const Point& p, double* out) { *out = p.step_size; }}};
  for (const auto& q : quantities) all.push_back({field_of(q.name, {q.components.size()}, q.needs_step), q.evaluate});
  return all;
}

/// A motion of the system from a momentum and an object or, where more than the object is to be followed, the arrow
/// that ends there.
template <DiscreteSystem Sys>
std::shared_ptr<Motion> begin_integrator(const Sys& system, const Array& momentum, const std::optional<Array>& object,
                                         const std::optional<Array>& configuration, const IntegratorOptions& options) {
  using G = typename Sys::GroupoidType;
  const G& groupoid = system.groupoid;
  detail::require_step(system);
  if (object && configuration) throw py::value_error("give object or configuration, not both: an arrow has its target");
  if (!object && !configuration && G::object_coordinate_count() > 0)
    throw py::value_error("give object, or configuration, the arrow that ends there");
  State<G> state;
  ArrowOf<G> arrow;
  if (configuration) {
    arrow = detail::arrow_of(groupoid, *configuration, "configuration");
    state.object = groupoid.target(arrow);
  } else {
    using V = Vector<double, G::object_coordinate_count()>;
    const V q = object ? detail::vector_of<V>(*object, "object") : V();
    state.object = groupoid.template object_at<double>(q);
    arrow = groupoid.unit(state.object);
  }
  state.momentum = detail::vector_of<AlgebroidVector<G>>(momentum, "momentum");
  constexpr double on_it = 1e-8;
  if constexpr (Sys::object_constraints > 0) {
    const double off = system.object_constraint(state.object).cwiseAbs().maxCoeff();
    const double size = groupoid.coordinates_of_object(state.object).squaredNorm();
    if (!(off <= on_it * (1 + size)))
      throw py::value_error("object: off the constraint C(q) = 0 by " + std::to_string(off));
  }
  const auto kept = groupoid.coordinates_of_arrow(groupoid.project(arrow));
  if (!((kept - groupoid.coordinates_of_arrow(arrow)).norm() <= on_it * (1 + kept.norm())))
    throw py::value_error("object: no object of " + G::name());
  auto quantities = quantities_of(system);
  auto fields = fields_of(system, quantities);
  return std::make_shared<SystemMotion<Sys>>(system, "system", std::move(fields), std::move(quantities),
                                             make_integrator(system, state, arrow, options), options);
}

/// The stationary paths between the ends of `boundary`, an arrow in coordinates, cheapest first.
template <DiscreteSystem Sys>
std::vector<BoundaryPath> stationary_paths(const Sys& system, const Array& boundary, long steps,
                                           const std::string& method, int starts, std::uint64_t seed,
                                           std::string& failure) {
  using G = typename Sys::GroupoidType;
  const auto kind = detail::choice("method", method, boundary_words);
  detail::require_step(system);
  if (steps < 2) throw py::value_error(fmt::format("steps: must be at least 2, got {}", steps));
  if (starts < 1) throw py::value_error(fmt::format("starts: must be at least 1, got {}", starts));
  const BoundaryProblem<Sys> problem{system, detail::arrow_of(system.groupoid, boundary, "arrow")};
  const auto solver = make_boundary_solver<Sys>(kind);
  MultistartOptions options;
  options.starts = starts;
  options.seed = seed;
  MultistartResult<Sys> found;
  {
    const py::gil_scoped_release unlocked;
    found = solve_boundary(*solver, problem, std::size_t(steps), options);
  }
  if (found.solutions.empty())
    failure = found.best_failure.message.empty() ? "none of " + std::to_string(starts) + " starts converged (" +
                                                       std::string(to_string(found.best_failure.status)) + ")"
                                                 : found.best_failure.message;
  std::vector<BoundaryPath> out;
  for (const auto& solution : found.solutions) {
    BoundaryPath path{solution.cost,
                      solution.starts,
                      solution.kind.is_minimum,
                      solution.kind.isolated,
                      solution.kind.normal,
                      solution.kind.negative_directions,
                      {Rows(field_of("object", {std::size_t(G::object_coordinate_count())})),
                       Rows(field_of("momentum", {std::size_t(G::dimension)})),
                       Rows(field_of("arrow", detail::arrow_shape<G>(), true)),
                       Rows(field_of("multipliers", {std::size_t(Sys::constraints)}, true))}};
    const auto add = [&path](std::size_t row, const auto& v) { detail::put(v, path.rows[row].add()); };
    const auto node = [&](const State<G>& state) {
      add(0, system.groupoid.coordinates_of_object(state.object));
      add(1, tangent_momentum(system, state));
    };
    node(legendre_minus(system, solution.path.front()));
    for (const auto& step : solution.path) {
      node(legendre_plus(system, step));
      add(2, system.groupoid.coordinates_of_arrow(step.arrow));
      add(3, step.multipliers);
    }
    out.push_back(std::move(path));
  }
  return out;
}

/// The class of the system in `module`: parameters as keywords of the constructor (those that it declares, and all that
/// the caller adds with def_readwrite or def_property), which copies and pickles hold; the step `h`, `integrator(...)`.
/// A system of one's own that is not among those of the library includes
/// lagroid/solvers/integrators/integrator_methods.hpp too.
template <DiscreteSystem Sys> py::class_<Sys> bind_system(py::module_& module, const char* name, const char* doc) {
  py::class_<Sys> made(module, name, doc);
  made.def(py::init([](const py::kwargs& parameters) { return detail::with_parameters<Sys>(parameters); }));
  made.def("__setattr__", detail::set_attribute);
  // Pickles and copies: the parameters, and what a class derived in Python has besides.
  made.def(py::pickle(
      [](const py::object& self) {
        const py::dict besides = py::hasattr(self, "__dict__") ? self.attr("__dict__").attr("copy")() : py::dict();
        return py::make_tuple(detail::parameters_of<Sys>(self), besides);
      },
      [](const py::tuple& kept) {
        return std::pair(detail::with_parameters<Sys>(kept[0].cast<py::dict>()), kept[1].cast<py::dict>());
      }));
  if constexpr (HasTimeStep<Sys>) made.def_readwrite("h", &Sys::h, "The time step, or the first one (s).");
  for_each_parameter<Sys>([&](const auto& p) { detail::bind_parameter(made, p); });
  made.def_property_readonly(
      "groupoid", [](const Sys&) { return Sys::GroupoidType::name(); }, "The groupoid of its arrows.");
  made.def(
      "integrator",
      [](const Sys& self, const py::args& by_place, const std::optional<Array>& momentum,
         const std::optional<Array>& object, const std::optional<Array>& configuration, const std::string& mode,
         const std::string& method, std::optional<int> order, const std::optional<std::string>& composition,
         const std::string& without_root, int max_iterations, double tolerance, bool ledger) {
        if (!by_place.empty() || !momentum)
          throw py::type_error(
              "integrator: give momentum, and object or configuration, by name, as in momentum=[0, 1]");
        const IntegratorOptions options =
            detail::integrator_options(mode, method, order, composition, without_root, max_iterations, tolerance);
        const auto motion = begin_integrator(self, *momentum, object, configuration, options);
        // A pickle begins it anew, with the same system and arguments.
        using namespace py::literals;
        const py::dict arguments("momentum"_a = detail::kept(momentum), "object"_a = detail::kept(object),
                                 "configuration"_a = detail::kept(configuration), "mode"_a = mode, "method"_a = method,
                                 "order"_a = order, "composition"_a = composition, "without_root"_a = without_root,
                                 "max_iterations"_a = max_iterations, "tolerance"_a = tolerance, "ledger"_a = ledger);
        const py::object integrator = detail::class_of_lagroid("Integrator");
        return integrator(py::cast(motion), ledger, py::make_tuple(py::cast(Sys(self)), arguments));
      },
      py::arg("momentum") = py::none(), py::arg("object") = py::none(), py::arg("configuration") = py::none(),
      py::arg("mode") = mode_words().front(), py::arg("method") = method_words().front(), py::arg("order") = py::none(),
      py::arg("composition") = py::none(), py::arg("without_root") = words_of(without_root_words).front(),
      py::arg("max_iterations") = 0, py::arg("tolerance") = 0.0, py::arg("ledger") = true,
      "An Integrator at the state (object, momentum), all by name. `configuration` is the arrow that ends at the\n"
      "object, in the coordinates of arrows; it is carried along (an attitude). The keywords are those of [time] and\n"
      "[solver] of scenes (docs/scenes.md). Raises ValueError for what the system does not have.");
  return made;
}

/// Adds `boundary(arrow, steps, ...)` to a class of `bind_system`: a system of one's own includes
/// lagroid/solvers/boundary/boundary_methods.hpp too.
template <DiscreteSystem Sys> void bind_boundary(py::class_<Sys>& made) {
  made.def(
      "boundary",
      [](const Sys& self, const Array& arrow, long steps, const std::string& method, int starts, std::uint64_t seed) {
        detail::class_of_lagroid("BoundarySolution");  // known from here on
        std::string failure;
        auto paths = stationary_paths(self, arrow, steps, method, starts, seed, failure);
        if (paths.empty()) {
          const auto error = py::module_::import("lagroid.errors").attr("SolveError")("boundary value: " + failure);
          PyErr_SetObject(error.get_type().ptr(), error.ptr());
          throw py::error_already_set();
        }
        return paths;
      },
      py::arg("arrow"), py::arg("steps"), py::kw_only(), py::arg("method") = words_of(boundary_words).front(),
      py::arg("starts") = 40, py::arg("seed") = 1,
      "The stationary paths of `steps` arrows whose product is `arrow`, the cheapest of those found first; `starts`\n"
      "of each says how many led to it. Raises SolveError where no start leads to one.");
}

}  // namespace lagroid::python
