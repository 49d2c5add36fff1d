#include <lagroid/solvers/methods/declared_methods.hpp>

namespace lagroid {

namespace {

std::vector<std::string> names(bool of_equal_steps) {
  std::vector<std::string> out;
  for (const IntegrationMethod& method : declared_methods)
    if (method.equal_steps() == of_equal_steps) out.emplace_back(method.name);
  return out;
}

template <class Condition> const IntegrationMethod& the_one(const Condition& is_it) {
  const auto found = std::find_if(declared_methods.begin(), declared_methods.end(), is_it);
  if (found == declared_methods.end()) throw std::invalid_argument("there is no such method");
  return *found;
}

}  // namespace

std::vector<std::string> mode_words() {
  std::vector<std::string> out = names(false);
  out.insert(out.begin(), std::string(mode_of_equal_steps));
  return out;
}

std::vector<std::string> method_words() { return names(true); }

const IntegrationMethod& integration_method(std::string_view mode, std::string_view method) {
  const bool equal = mode == mode_of_equal_steps;
  return the_one(
      [&](const IntegrationMethod& m) { return m.equal_steps() == equal && m.name == (equal ? method : mode); });
}

const IntegrationMethod& integration_method(const IntegratorOptions& options) {
  return the_one([&](const IntegrationMethod& m) {
    return m.mode == options.mode && (!m.equal_steps() || m.fixed == options.fixed);
  });
}

IntegratorOptions options_of(const IntegrationMethod& method) { return {.mode = method.mode, .fixed = method.fixed}; }

const Composition* usual_composition(long order) {
  for (const Composition& each : usual_compositions)
    if (each.order == order) return &each;
  return nullptr;
}

std::string usual_orders() {
  std::vector<int> orders;
  for (const Composition& each : usual_compositions) orders.push_back(each.order);
  return any_of_these(orders);
}

std::vector<Composition> compositions_of(OtherOrders orders) {
  std::vector<Composition> out;
  if (orders == OtherOrders::composed_steps || orders == OtherOrders::composed_flows)
    out.assign(compositions::all.begin(), compositions::all.end());
  if (orders == OtherOrders::composed_flows) out.insert(out.end(), splittings::all.begin(), splittings::all.end());
  return out;
}

const Composition* composition_named(std::span<const Composition> offered, std::string_view name) {
  for (const Composition& each : offered)
    if (each.name == name) return &each;
  return nullptr;
}

std::string why_not(const IntegratorOptions& options, const Capabilities& able) {
  const IntegrationMethod& method = integration_method(options);
  const auto lacks = [](std::string_view subject, const Requirement& what) {
    std::string out = std::string(subject) + ": this system has no " + std::string(what.what);
    if (!what.member.empty()) out += ", " + std::string(what.member);
    return out;
  };
  if (const Requirement* what = unmet(method.needs, able)) return lacks(method.name, *what);
  if (method.equal_steps() && method.other_orders == OtherOrders::composed_steps && options.composition.stages() > 1)
    if (const Requirement* what = unmet(requirements::of_composed_steps, able)) return lacks("orders above two", *what);
  if (method.by_tolerance() && !(options.tolerance > 0))
    return std::string(method.name) + " takes its order and its steps from a tolerance, which has to be positive";
  if (options.mode == TimeMode::adaptive && options.without_root == WithoutRoot::controlled)
    if (const Requirement* what = unmet(requirements::of_controlled, able))
      return lacks("controlled steps without a root", *what);
  return {};
}

std::string composed_name(std::string_view step, const Composition& composition) {
  std::string out(step);
  if (composition.stages() > 1) out += "/" + std::string(composition.name);
  return out;
}

std::vector<NamedMethod> named_methods(const Capabilities& able) {
  std::vector<NamedMethod> all;
  for (const IntegrationMethod& method : declared_methods) {
    if (unmet(method.needs, able)) continue;
    if (method.by_tolerance()) {
      for (const auto& [word, tolerance] : studied_tolerances) {
        IntegratorOptions options = options_of(method);
        options.tolerance = tolerance;
        all.push_back(
            {std::string(method.name) + "/" + std::string(word), method.order, method.stages, false, options});
      }
      continue;
    }
    if (!method.composed()) {
      all.push_back({std::string(method.name), method.order, method.stages, method.equal_steps(), options_of(method),
                     method.to_compare});
      continue;
    }
    const bool composable = !unmet(requirements::of_composed_steps, able);
    for (const Composition& composition : method.other_orders == OtherOrders::composed_flows
                                              ? std::span<const Composition>(able.splittings)
                                              : steps_composed(composable)) {
      IntegratorOptions options = options_of(method);
      options.composition = composition;
      all.push_back({composed_name(method.name, composition), composition.order, composition.stages(),
                     method.equal_steps(), options, method.to_compare});
    }
  }
  return all;
}

std::string any_of_these(std::span<const int> numbers) {
  std::string out;
  for (std::size_t i = 0; i < numbers.size(); ++i)
    out += (i == 0 ? "" : i + 1 == numbers.size() ? " or " : ", ") + std::to_string(numbers[i]);
  return out;
}

}  // namespace lagroid
