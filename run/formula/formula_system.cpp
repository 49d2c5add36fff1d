#include <lagroid/run/formula/formula_system.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <cctype>
#include <cmath>
#include <set>

namespace lagroid {

namespace {

bool is_word(const std::string& name) {
  const auto fits = [](unsigned char c) { return std::isalnum(c) != 0 || c == '_'; };
  return !name.empty() && std::isdigit(static_cast<unsigned char>(name.front())) == 0 &&
         std::all_of(name.begin(), name.end(), fits);
}

}  // namespace

FormulaSystem::FormulaSystem(const FormulaTexts& texts, std::vector<std::string> momenta, bool by_velocity)
    : coordinates_(texts.coordinates),
      momenta_(std::move(momenta)),
      parameters_(texts.parameters),
      by_velocity_(by_velocity) {
  if (coordinates_.empty()) throw FormulaError("coordinates", "names no coordinate");
  for (const std::string& each : coordinates_) velocities_.push_back(each + "'");
  const char* const key_of_momenta = momenta_.empty() ? "coordinates" : "momenta";
  if (momenta_.empty())
    for (const std::string& each : coordinates_) momenta_.push_back("p_" + each);
  if (momenta_.size() != size())
    throw FormulaError("momenta", fmt::format("names {}, and there are {} coordinates", momenta_.size(), size()));
  // Of formulas, and of columns.
  std::set<std::string> known{"t",     "pi",    "energy", "sin",  "cos",  "tan",   "asin",
                              "acos",  "atan",  "sinh",   "cosh", "tanh", "asinh", "acosh",
                              "atanh", "atan2", "exp",    "ln",   "log",  "sqrt",  "abs"};
  const auto add = [&](const std::string& name, const char* key) {
    if (!is_word(name))
      throw FormulaError(key, fmt::format("\"{}\" is no name: letters, digits and _, not a digit first", name));
    if (!known.insert(name).second)
      throw FormulaError(key, fmt::format("\"{}\" is taken: names of coordinates, momenta and parameters differ from "
                                          "each other, and from t, pi, energy and those of functions",
                                          name));
  };
  for (const std::string& each : coordinates_) add(each, "coordinates");
  for (const std::string& each : momenta_) add(each, key_of_momenta);
  names_ = coordinates_;
  const std::vector<std::string>& second = by_velocity ? velocities_ : momenta_;
  names_.insert(names_.end(), second.begin(), second.end());
  names_.emplace_back("t");
  for (const auto& [name, value] : texts.parameters) {
    add(name, "parameters");
    names_.push_back(name);
  }
  variables_.assign(names_.size(), 0);
  for (std::size_t i = 0; i < texts.parameters.size(); ++i)
    variables_[variable_of_parameter(i)] = texts.parameters[i].second;
}

FormulaGraph::Node FormulaSystem::read(const std::string& key, const std::string& text, std::size_t which) {
  try {
    return graph_.read(text, names_);
  } catch (const std::invalid_argument& error) {
    throw FormulaError(key, fmt::format("\"{}\": {}", text, error.what()), which);
  }
}

std::vector<FormulaGraph::Node> FormulaSystem::with_derivatives(Node f, std::size_t count) {
  std::vector<Node> all{f};
  for (std::size_t i = 0; i < count; ++i) all.push_back(graph_.derivative(f, i));
  for (std::size_t i = 0; i < count; ++i)
    for (std::size_t j = i; j < count; ++j) all.push_back(graph_.derivative(all[1 + i], j));
  return all;
}

void FormulaSystem::require_of_places(Node f, const std::string& key, const std::string& text, std::size_t which) {
  for (std::size_t i = size(); i <= time(); ++i)
    if (depends(f, i))
      throw FormulaError(key, fmt::format("\"{}\" depends on {}: it is of places alone", text, names_[i]), which);
}

std::vector<FormulaGraph::Node> FormulaSystem::read_constraints(const FormulaTexts& texts) {
  const std::size_t n = size();
  std::vector<Node> constraints, wanted;
  for (const std::string& text : texts.constraints) {
    constraints.push_back(read("constraints", text));
    require_of_places(constraints.back(), "constraints", text);
    const std::vector<Node> all = with_derivatives(constraints.back(), n);
    wanted.insert(wanted.end(), all.begin(), all.end());
  }
  constraint_count_ = constraints.size();
  if (constraint_count_ >= n)
    throw FormulaError("constraints",
                       fmt::format("{} of {} coordinates leave nothing that moves", constraint_count_, n));
  constraint_ = FormulaProgram(graph_, wanted);
  return constraints;
}

std::vector<FormulaGraph::Node> FormulaSystem::changes_along(const std::vector<Node>& field, Node function,
                                                             const std::vector<Node>& constraints,
                                                             const std::vector<Node>& force) {
  using enum FormulaOperation;
  const std::size_t n = size();
  std::vector<Node> changes, terms;
  const auto times = [&](Node a, Node b) { return graph_.apply(multiply, a, b); };
  const auto add_change = [&] {
    Node sum = graph_.constant(0), sizes = graph_.constant(0);
    for (const Node term : terms) {
      sum = graph_.apply(add, sum, term);
      sizes = graph_.apply(add, sizes, graph_.apply(FormulaOperation::abs, term));
    }
    changes.push_back(sum);
    changes.push_back(sizes);
    terms.clear();
  };
  // Velocities are carried by xi' v, momenta by -xi'^T p.
  for (std::size_t i = 0; i < n; ++i) {
    terms.push_back(times(graph_.derivative(function, i), field[i]));
    for (std::size_t j = 0; j < n; ++j) {
      const Node carried = by_velocity_ ? times(graph_.derivative(field[i], j), graph_.variable(n + j))
                                        : times(graph_.derivative(field[j], i), graph_.variable(n + j));
      const Node term = times(graph_.derivative(function, n + i), carried);
      terms.push_back(by_velocity_ ? term : graph_.apply(negate, term));
    }
  }
  add_change();
  for (const Node c : constraints) {
    for (std::size_t i = 0; i < n; ++i) terms.push_back(times(graph_.derivative(c, i), field[i]));
    add_change();
  }
  for (std::size_t i = 0; i < force.size(); ++i) terms.push_back(times(force[i], field[i]));
  add_change();
  return changes;
}

void FormulaSystem::read_constraints_and_symmetries(const FormulaTexts& texts, Node function,
                                                    const std::vector<Node>& force) {
  const std::size_t n = size();
  const std::vector<Node> constraints = read_constraints(texts);
  std::vector<Node> fields, changes;
  std::set<std::string> known{"energy"};
  for (const FormulaSymmetry& symmetry : texts.symmetries) {
    const std::size_t which = symmetries_.size();
    if (symmetry.name.empty() || !known.insert(symmetry.name).second)
      throw FormulaError("name", "is empty, or that of another quantity", which);
    if (symmetry.field.size() != n)
      throw FormulaError(
          "field", fmt::format("has {} components, and there are {} coordinates", symmetry.field.size(), n), which);
    std::vector<Node> xi;
    bool affine = true;
    for (const std::string& text : symmetry.field) {
      xi.push_back(read("field", text, which));
      require_of_places(xi.back(), "field", text, which);
      for (std::size_t i = 0; i < n; ++i)
        for (std::size_t j = i; j < n; ++j) affine = affine && !depends(graph_.derivative(xi.back(), i), j);
    }
    symmetries_.push_back({symmetry.name, affine});
    fields.insert(fields.end(), xi.begin(), xi.end());
    const std::vector<Node> along = changes_along(xi, function, constraints, force);
    changes.insert(changes.end(), along.begin(), along.end());
  }
  fields_ = FormulaProgram(graph_, fields);
  std::vector<Node> slopes;
  for (const Node component : fields) {
    for (std::size_t i = 0; i < n; ++i) slopes.push_back(graph_.derivative(component, i));
    for (std::size_t i = 0; i < parameters_.size(); ++i)
      slopes.push_back(graph_.derivative(component, variable_of_parameter(i)));
  }
  field_slopes_ = FormulaProgram(graph_, slopes);
  changes_ = FormulaProgram(graph_, changes);
  changed_.resize(changes_.count());
}

void FormulaSystem::require_parameters_read(const FormulaTexts& texts,
                                            const std::vector<const FormulaProgram*>& programs) const {
  for (std::size_t i = 0; i < texts.parameters.size(); ++i) {
    const auto reads = [&](const FormulaProgram* program) { return program->reads(variable_of_parameter(i)); };
    if (!std::any_of(programs.begin(), programs.end(), reads) && !reads(&constraint_) && !reads(&fields_))
      throw FormulaError("parameters", fmt::format("no formula has \"{}\": leave it out", texts.parameters[i].first));
  }
}

const double* FormulaSystem::at(double t, const double* q, const double* w) const {
  std::copy_n(q, size(), variables_.begin());
  if (w) std::copy_n(w, size(), variables_.begin() + long(size()));
  variables_[time()] = t;
  return variables_.data();
}

void FormulaSystem::constraint(const double* q, double* out) const {
  constraint_.evaluate(at(0, q, nullptr), out, scratch_);
}
Eigen::MatrixXd FormulaSystem::constraint_rows(const Eigen::VectorXd& q) const {
  std::vector<double> numbers(constraint_.count());
  constraint(q.data(), numbers.data());
  Eigen::MatrixXd out(Eigen::Index(constraint_count_), 1 + q.size());
  for (std::size_t a = 0; a < constraint_count_; ++a)
    out.row(Eigen::Index(a)) =
        Eigen::Map<const Eigen::RowVectorXd>(numbers.data() + a * (numbers.size() / constraint_count_), 1 + q.size());
  return out;
}
void FormulaSystem::fields(const double* q, double* out) const { fields_.evaluate(at(0, q, nullptr), out, scratch_); }

void FormulaSystem::momentum_slopes(const double* q, const double* p, double* out) const {
  const std::size_t n = size(), each = n + parameters_.size(), columns = n + each;
  std::vector<double> xi(fields_.count()), by(field_slopes_.count());
  fields(q, xi.data());
  field_slopes_.evaluate(at(0, q, nullptr), by.data(), scratch_);
  for (std::size_t s = 0; s < symmetries_.size(); ++s) {
    double* row = out + s * columns;
    std::fill_n(row, columns, 0.0);
    for (std::size_t i = 0; i < n; ++i) {
      const double* slopes = by.data() + (s * n + i) * each;
      row[n + i] = xi[s * n + i];
      for (std::size_t j = 0; j < n; ++j) row[j] += p[i] * slopes[j];
      for (std::size_t j = n; j < each; ++j) row[n + j] += p[i] * slopes[j];
    }
  }
}

namespace {

OffConstraint worst_of(const Eigen::MatrixXd& rows, const Eigen::VectorXd& off, double size) {
  OffConstraint worst;
  for (Eigen::Index a = 0; a < rows.rows(); ++a) {
    const double share = off(a) == 0 ? 0 : std::abs(off(a)) / (rows.row(a).tail(rows.cols() - 1).norm() * size);
    if (!(share <= worst.share)) worst = {share, std::size_t(a + 1)};
  }
  return worst;
}

}  // namespace

OffConstraint FormulaSystem::off_constraints(const Eigen::VectorXd& q, double size) const {
  const Eigen::MatrixXd rows = constraint_rows(q);
  return worst_of(rows, rows.col(0), size);
}
OffConstraint FormulaSystem::leaving_constraints(const Eigen::VectorXd& q, const Eigen::VectorXd& v) const {
  const Eigen::MatrixXd rows = constraint_rows(q);
  return worst_of(rows, rows.rightCols(q.size()) * v, v.norm());
}

void FormulaSystem::set_parameter(const std::string& name, double value) {
  for (std::size_t i = 0; i < parameters_.size(); ++i)
    if (parameters_[i].first == name) variables_[variable_of_parameter(i)] = parameters_[i].second = value;
}

double FormulaSystem::symmetry_defect(std::size_t i, double t, const double* q, const double* w) const {
  changes_.evaluate(at(t, q, w), changed_.data(), scratch_);
  const std::size_t each = changed_.size() / symmetries_.size();
  double worst = 0;
  for (std::size_t k = i * each; k < (i + 1) * each; k += 2) {
    const double relative = changed_[k] == 0 ? 0 : std::abs(changed_[k]) / changed_[k + 1];
    if (std::isnan(relative)) return relative;
    worst = std::max(worst, relative);
  }
  return worst;
}

}  // namespace lagroid
