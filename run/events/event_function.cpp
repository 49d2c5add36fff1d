#include <lagroid/run/events/event_function.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>
#include <boost/algorithm/string/trim.hpp>

#include <algorithm>
#include <span>
#include <stdexcept>

namespace lagroid {

namespace {

/// For a message: of scenes with hundreds of columns, the first.
std::string listed(const std::vector<std::string>& names) {
  constexpr std::size_t most = 40;
  const std::span<const std::string> first(names.data(), std::min(names.size(), most));
  return fmt::format("{}{}", fmt::join(first, ", "), names.size() > most ? ", ..." : "");
}

}  // namespace

std::vector<std::size_t> fields_within(const Observables& node) {
  std::vector<std::size_t> all;
  for (std::size_t i = 0; i < node.fields().size(); ++i)
    if (!node.fields()[i].columns.on_arrows && !node.fields()[i].drift_of) all.push_back(i);
  return all;
}

std::vector<std::string> columns_within(const Observables& node) {
  std::vector<std::string> labels;
  for (const std::size_t i : fields_within(node)) {
    const std::vector<std::string>& each = node.fields()[i].columns.components;
    labels.insert(labels.end(), each.begin(), each.end());
  }
  return labels;
}

std::vector<double> values_within(const Observables& node) {
  std::vector<double> values;
  for (const std::size_t i : fields_within(node)) {
    const std::size_t at = values.size();
    values.resize(at + node.fields()[i].columns.width());
    node.read(i, values.data() + at);
  }
  return values;
}

std::optional<std::pair<std::string, std::string>> event_setting(const std::string& text) {
  const std::size_t sign = text.find('=');
  if (sign == std::string::npos) return std::nullopt;
  std::pair<std::string, std::string> out{boost::trim_copy(text.substr(0, sign)),
                                          boost::trim_copy(text.substr(sign + 1))};
  if (out.first.empty() || out.second.empty()) return std::nullopt;
  return out;
}

EventFunction::EventFunction(const Event& event, const Observables& node) : function_(event.function) {
  if (function_) return;
  std::vector<std::string> names{"t"};
  std::vector<Read> fields, quantities;
  for (const std::size_t i : fields_within(node)) {
    fields.push_back({i, names.size()});
    const std::vector<std::string>& labels = node.fields()[i].columns.components;
    names.insert(names.end(), labels.begin(), labels.end());
  }
  for (std::size_t i = 0; i < node.quantities().size(); ++i) {
    const Watched& quantity = node.quantities()[i];
    if (quantity.on_arrows || quantity.adds_up) continue;
    quantities.push_back({i, names.size()});
    if (quantity.components.size() == 1) {
      names.push_back(quantity.name);
    } else {
      names.insert(names.end(), quantity.components.begin(), quantity.components.end());
    }
  }
  values_.resize(names.size());
  try {
    expression_ = parse_expression(event.when, names, values_.data());
  } catch (const std::invalid_argument& error) {
    throw std::invalid_argument(fmt::format("\"{}\": {}; there are {}", event.when, error.what(), listed(names)));
  }
  const std::vector<std::size_t> used = expression_->used();
  const auto keep_needed = [&](const std::vector<Read>& all, std::vector<Read>& needed, auto width) {
    for (const Read& read : all)
      if (std::any_of(used.begin(), used.end(),
                      [&](std::size_t i) { return read.at <= i && i < read.at + width(read.which); }))
        needed.push_back(read);
  };
  keep_needed(fields, fields_, [&](std::size_t i) { return node.fields()[i].columns.width(); });
  keep_needed(quantities, quantities_, [&](std::size_t i) { return node.quantities()[i].components.size(); });
}

}  // namespace lagroid
