#include "sphere_time.hpp"

#include "../scenes/scene_keys.hpp"
#include "../scenes/simulation.hpp"

#include <lagroid/run/interrupt.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <utility>

namespace lagroid::app {

namespace {

const char* word(SphereForm form) { return form == SphereForm::velocities ? "velocities" : "momenta"; }

KeyOf<OneOf> form_key(const std::vector<SphereForm>& forms) {
  KeyOf<OneOf> key{"form", {}, "", "of states: (q, w) in (TS^2)^k, or (q, p) in (T*S^2)^k", word(forms.front())};
  for (const SphereForm form : forms) key.value.words.emplace_back(word(form));
  return key;
}

/// Whether the method has steps that a tolerance controls.
bool estimates_error(std::string_view name) {
  const LieGroupMethod* method = lie_group_methods::named(name);
  return name == extrapolation_method.name || (method != nullptr && method->embedded());
}

std::string usual_method(const SphereEntry& entry) {
  return std::string(entry.own_methods.empty() ? lie_group_methods::commutator_free_4.name
                                               : entry.own_methods.front().name);
}

}  // namespace

const DeclaredMethod* own_method(const SphereEntry& entry, std::string_view name) {
  for (const DeclaredMethod& own : entry.own_methods)
    if (own.name == name) return &own;
  return nullptr;
}

namespace {

KeyOf<OneOf> method_key(const SphereEntry& entry) {
  std::vector<std::string> names;
  for (const DeclaredMethod& own : entry.own_methods) names.emplace_back(own.name);
  for (const LieGroupMethod& method : lie_group_methods::all) names.emplace_back(method.name);
  names.emplace_back(extrapolation_method.name);
  KeyOf<OneOf> key = time_keys::method(std::move(names));
  key.fallback = usual_method(entry);
  return key;
}

}  // namespace

Table sphere_time_table(const SphereEntry& entry) {
  Table table{grid_keys()};
  table.keys.insert(table.keys.end(), {method_key(entry), form_key(entry.forms), time_keys::tolerance});
  if (!entry.own_methods.empty())
    table.keys.insert(table.keys.end(), {time_keys::order(), time_keys::composition(compositions::all)});
  return table;
}

std::string read_sphere_method(const Section& time, const SphereEntry& entry) {
  return read_key(time, method_key(entry));
}

SphereIntegratorOptions read_sphere_time(const Section& scene, const SphereEntry& entry, const SphereSystem& system) {
  const Section time = scene.section("time", "step and steps, or duration and steps");
  SphereIntegratorOptions options;
  options.step = read_time(scene).step;
  refuse_accuracy(scene);
  options.method = read_sphere_method(time, entry);
  const auto forms = system.forms();
  const std::string chosen = read_key(time, form_key(forms));
  for (const SphereForm form : forms)
    if (word(form) == chosen) options.form = form;
  if (own_method(entry, options.method) != nullptr) {
    options.composition = read_composition(time, compositions::all);
  } else {
    for (const char* key : {"order", "composition"})
      if (time.has(key)) time.fail(key, fmt::format("is of the steps of {}", usual_method(entry)));
  }
  if (!time.has("tolerance")) {
    if (options.method == extrapolation_method.name)
      time.fail("method", "takes its order and its steps from a tolerance: add tolerance = 1e-9");
    return options;
  }
  if (!estimates_error(options.method))
    time.fail("tolerance", fmt::format("goes with a method that estimates its error: method = \"{}\" or \"{}\"",
                                       extrapolation_method.name, lie_group_methods::munthe_kaas_54.name));
  options.stop = InterruptGuard::interrupted;
  options.tolerance = read_key(time, time_keys::tolerance);
  return options;
}

std::vector<Method> sphere_methods(const SphereEntry& entry, const SphereSystem& system) {
  const auto forms = system.forms();
  const auto settings = [](std::string_view method, SphereForm form) -> std::vector<std::string> {
    return {fmt::format("time.method={}", method), fmt::format("time.form={}", word(form))};
  };
  std::vector<Method> all;
  for (const DeclaredMethod& own : entry.own_methods)
    for (Method& method : composed_methods(own.name, compositions_of(own.other_orders))) {
      method.settings.push_back(fmt::format("time.form={}", word(forms.front())));
      all.push_back(std::move(method));
    }
  for (const SphereForm form : forms) {
    for (const LieGroupMethod& method : lie_group_methods::all) {
      Method each{form == forms.front() ? std::string(method.name) : fmt::format("{}/{}", method.name, word(form)),
                  method.order, method.stages, true, settings(method.name, form)};
      each.to_compare = method.scheme == LieGroupScheme::classical;
      all.push_back(std::move(each));
    }
  }
  constexpr std::array tolerances{"1e-6", "1e-9", "1e-12"};
  const auto add_controlled = [&](std::string_view name, int order, int stages) {
    for (const char* tolerance : tolerances) {
      Method each{fmt::format("{}/{}", name, tolerance), order, stages, false, settings(name, forms.front())};
      each.settings.push_back(fmt::format("time.tolerance={}", tolerance));
      all.push_back(std::move(each));
    }
  };
  for (const LieGroupMethod& method : lie_group_methods::all)
    if (method.embedded()) add_controlled(method.name, method.order, method.stages);
  add_controlled(extrapolation_method.name, extrapolation_method.order, extrapolation_method.stages);
  return all;
}

bool keeps_spheres(const SphereIntegratorOptions& options) {
  const LieGroupMethod* method = lie_group_methods::named(options.method);
  return method == nullptr || method->scheme != LieGroupScheme::classical;
}

}  // namespace lagroid::app
