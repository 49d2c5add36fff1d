#include <lagroid/run/formula/formula_hamiltonian.hpp>

#include <lagroid/core/scalars/series.hpp>

#include <fmt/format.h>

#include <map>

namespace lagroid {

namespace {

using Node = FormulaGraph::Node;
constexpr int most_terms = 6;

/// A formula as a number, so that power series can have formulas for coefficients.
struct Formula {
  static thread_local FormulaGraph* graph;
  Node node;

  Formula() : Formula(0.0) {}
  Formula(double x) : node(graph->constant(x)) {}  // NOLINT(google-explicit-constructor)
  explicit Formula(Node at, std::nullptr_t) : node(at) {}
  static Formula of(Node at) { return Formula(at, nullptr); }
  static Formula made(FormulaOperation kind, Formula a, Formula b) { return of(graph->apply(kind, a.node, b.node)); }
  static Formula made(FormulaOperation kind, Formula a) { return of(graph->apply(kind, a.node)); }

  friend Formula operator+(Formula a, Formula b) { return made(FormulaOperation::add, a, b); }
  friend Formula operator-(Formula a, Formula b) { return made(FormulaOperation::subtract, a, b); }
  friend Formula operator*(Formula a, Formula b) { return made(FormulaOperation::multiply, a, b); }
  friend Formula operator/(Formula a, Formula b) { return made(FormulaOperation::divide, a, b); }
  friend Formula operator-(Formula a) { return made(FormulaOperation::negate, a); }
  Formula& operator+=(Formula b) { return *this = *this + b; }
  Formula& operator-=(Formula b) { return *this = *this - b; }
};
thread_local FormulaGraph* Formula::graph = nullptr;

Formula sin(Formula a) { return Formula::made(FormulaOperation::sin, a); }
Formula cos(Formula a) { return Formula::made(FormulaOperation::cos, a); }
Formula tan(Formula a) { return Formula::made(FormulaOperation::tan, a); }
Formula asin(Formula a) { return Formula::made(FormulaOperation::asin, a); }
Formula acos(Formula a) { return Formula::made(FormulaOperation::acos, a); }
Formula atan(Formula a) { return Formula::made(FormulaOperation::atan, a); }
Formula sinh(Formula a) { return Formula::made(FormulaOperation::sinh, a); }
Formula cosh(Formula a) { return Formula::made(FormulaOperation::cosh, a); }
Formula tanh(Formula a) { return Formula::made(FormulaOperation::tanh, a); }
Formula asinh(Formula a) { return Formula::made(FormulaOperation::asinh, a); }
Formula acosh(Formula a) { return Formula::made(FormulaOperation::acosh, a); }
Formula atanh(Formula a) { return Formula::made(FormulaOperation::atanh, a); }
Formula exp(Formula a) { return Formula::made(FormulaOperation::exp, a); }
Formula log(Formula a) { return Formula::made(FormulaOperation::log, a); }
Formula sqrt(Formula a) { return Formula::made(FormulaOperation::sqrt, a); }
Formula abs(Formula a) { return Formula::made(FormulaOperation::abs, a); }
Formula pow(Formula a, double b) { return Formula::made(FormulaOperation::power, a, b); }
Formula atan2(Formula a, Formula b) { return Formula::made(FormulaOperation::atan2, a, b); }

using Row = Series<Formula, most_terms>;

Row asinh(const Row& x) { return detail::integral(asinh(x[0]), detail::derivative(x) / sqrt(x * x + 1.0)); }
Row acosh(const Row& x) { return detail::integral(acosh(x[0]), detail::derivative(x) / sqrt((x - 1.0) * (x + 1.0))); }
Row atanh(const Row& x) { return detail::integral(atanh(x[0]), detail::derivative(x) / ((1.0 - x) * (1.0 + x))); }
Row abs(const Row& x) { return x * Row(x[0] / abs(x[0])); }

/// A formula at other arguments, over numbers that are power series or formulas themselves.
template <class S> class FormulaAt {
 public:
  FormulaAt(FormulaGraph& graph, const std::vector<S>& variables) : graph_(graph), variables_(variables) {}

  S operator()(Node f) {
    if (const auto known = values_.find(f); known != values_.end()) return known->second;
    const S value = computed(f);
    values_.emplace(f, value);
    return value;
  }

 private:
  S computed(Node f) {
    const FormulaGraph::Operation of = graph_.operation(f);
    switch (of.kind) {
      case FormulaOperation::constant:
        return S(of.value);
      case FormulaOperation::variable:
        return variables_[of.a];
      case FormulaOperation::add:
        return (*this)(of.a) + (*this)(of.b);
      case FormulaOperation::subtract:
        return (*this)(of.a) - (*this)(of.b);
      case FormulaOperation::multiply:
        return (*this)(of.a) * (*this)(of.b);
      case FormulaOperation::divide:
        return (*this)(of.a) / (*this)(of.b);
      case FormulaOperation::power:
        if (graph_.is_constant(of.b)) return pow((*this)(of.a), graph_.operation(of.b).value);
        if (graph_.is_constant(of.a)) return exp((*this)(of.b) * log((*this)(of.a)));
        throw std::invalid_argument(
            "an exponent is a number that is written there, or stands on one: powers are taken as power series");
      case FormulaOperation::negate:
        return -(*this)(of.a);
      case FormulaOperation::sin:
        return sin((*this)(of.a));
      case FormulaOperation::cos:
        return cos((*this)(of.a));
      case FormulaOperation::tan:
        return tan((*this)(of.a));
      case FormulaOperation::asin:
        return asin((*this)(of.a));
      case FormulaOperation::acos:
        return acos((*this)(of.a));
      case FormulaOperation::atan:
        return atan((*this)(of.a));
      case FormulaOperation::sinh:
        return sinh((*this)(of.a));
      case FormulaOperation::cosh:
        return cosh((*this)(of.a));
      case FormulaOperation::tanh:
        return tanh((*this)(of.a));
      case FormulaOperation::asinh:
        return asinh((*this)(of.a));
      case FormulaOperation::acosh:
        return acosh((*this)(of.a));
      case FormulaOperation::atanh:
        return atanh((*this)(of.a));
      case FormulaOperation::exp:
        return exp((*this)(of.a));
      case FormulaOperation::log:
        return log((*this)(of.a));
      case FormulaOperation::sqrt:
        return sqrt((*this)(of.a));
      case FormulaOperation::abs:
        return abs((*this)(of.a));
      case FormulaOperation::atan2:
        return atan2((*this)(of.a), (*this)(of.b));
    }
    return S(0.0);
  }

  FormulaGraph& graph_;
  const std::vector<S>& variables_;
  std::map<Node, S> values_;
};

}  // namespace

FormulaHamiltonian::FormulaHamiltonian(const FormulaTexts& texts, const std::vector<std::string>& momenta,
                                       const std::string& hamiltonian, const TaylorChoice& taylor)
    : SizedHamiltonian(int(texts.coordinates.size()), int(texts.constraints.size()), int(texts.parameters.size())),
      FormulaSystem(texts, momenta, false) {
  const std::size_t n = size();
  const Node energy = read("H", hamiltonian);
  depends_on_time_ = depends(energy, time());
  if (taylor.order < 0 || taylor.order + 2 > most_terms) throw std::invalid_argument("Taylor's order is 0 to 4");
  hamiltonian_ = FormulaProgram(graph_, with_derivatives(energy, 2 * n));
  read_constraints_and_symmetries(texts, energy, {});
  require_parameters_read(texts, {&hamiltonian_});

  try {
    read_generating_function(texts, energy, taylor);
  } catch (const std::invalid_argument& error) {
    throw FormulaError("H", fmt::format("\"{}\": {}", hamiltonian, error.what()));
  }
}

void FormulaHamiltonian::read_generating_function(const FormulaTexts& texts, Node energy, const TaylorChoice& taylor) {
  const std::size_t n = size();
  Formula::graph = &graph_;
  std::vector<Node> rate;  // (H_p, -H_q)
  for (std::size_t i = 0; i < n; ++i) rate.push_back(graph_.derivative(energy, n + i));
  for (std::size_t i = 0; i < n; ++i)
    rate.push_back(graph_.apply(FormulaOperation::negate, graph_.derivative(energy, i)));
  // The Taylor coefficients of the flow from (q, p~), by Picard's iteration.
  std::vector<Row> flow;
  for (std::size_t i = 0; i < names_.size(); ++i) flow.emplace_back(Formula::of(graph_.variable(i)));
  flow[time()][1] = Formula(1.0);
  for (int k = 1; k < taylor.order + 2; ++k) {
    FormulaAt<Row> along(graph_, flow);
    std::vector<Formula> next;
    for (std::size_t i = 0; i < 2 * n; ++i) next.push_back(along(rate[i])[k - 1] / double(k));
    for (std::size_t i = 0; i < 2 * n; ++i) flow[i][k] = next[i];
  }
  const std::size_t after = names_.size();  // sigma, p1, h
  const auto sigma = [&](std::size_t i) { return Formula::of(graph_.variable(after + i)); };
  const auto far = [&](std::size_t i) { return Formula::of(graph_.variable(after + n + i)); };
  const Formula h = Formula::of(graph_.variable(after + 2 * n));
  std::vector<Node> far_q, far_p;
  Formula w(0.0);
  for (std::size_t i = 0; i < n; ++i) {
    const Formula q = flow[i].at(h, taylor.order + 2), p = flow[n + i].at(h, taylor.order + 1);
    far_q.push_back(q.node);
    far_p.push_back(p.node);
    w += far(i) * (q - sigma(i)) + sigma(i) * p;
  }
  for (std::size_t i = 0; i < taylor.quadrature.nodes.size(); ++i) {
    const Formula since = h * Formula(taylor.quadrature.nodes[i]);
    std::vector<Formula> there;
    for (const Row& each : flow) there.push_back(each.at(since, taylor.order + 1));
    FormulaAt<Formula> evaluate(graph_, there);
    Formula legendre = -evaluate(energy);
    for (std::size_t j = 0; j < n; ++j) legendre += there[n + j] * evaluate(rate[j]);
    w -= legendre * (h * Formula(taylor.quadrature.weights[i]));
  }
  std::vector<Node> wanted = with_derivatives(w.node, 2 * n);
  for (const std::vector<Node>* each : {&far_p, &far_q}) {
    wanted.insert(wanted.end(), each->begin(), each->end());
    for (const Node f : *each)
      for (std::size_t i = 0; i < 2 * n; ++i) wanted.push_back(graph_.derivative(f, i));
  }
  generating_ = FormulaProgram(graph_, wanted);
  std::vector<Node> energy_slopes, velocity_slopes;
  std::vector<Node> slopes(wanted.begin() + 1, wanted.begin() + 1 + long(2 * n));
  wanted.clear();
  for (std::size_t a = 0; a < texts.parameters.size(); ++a) {
    energy_slopes.push_back(graph_.derivative(energy, variable_of_parameter(a)));
    for (std::size_t i = 0; i < n; ++i)
      velocity_slopes.push_back(graph_.derivative(graph_.derivative(energy, n + i), variable_of_parameter(a)));
    for (std::vector<Node>* each : {&slopes, &far_p, &far_q})
      for (const Node f : *each) wanted.push_back(graph_.derivative(f, variable_of_parameter(a)));
  }
  energy_by_parameters_ = FormulaProgram(graph_, energy_slopes);
  velocity_by_parameters_ = FormulaProgram(graph_, velocity_slopes);
  by_parameters_ = FormulaProgram(graph_, wanted);
  arguments_.resize(after + 2 * n + 1);
}

void FormulaHamiltonian::hamiltonian(double t, const double* q, const double* p, double* out) const {
  hamiltonian_.evaluate(at(t, q, p), out, scratch_);
}
const double* FormulaHamiltonian::generating_arguments(double t, const double* q, const double* p, const double* sigma,
                                                       const double* far, double h) const {
  auto to = std::copy_n(at(t, q, p), names_.size(), arguments_.begin());
  to = std::copy_n(sigma, size(), to);
  to = std::copy_n(far, size(), to);
  *to = h;
  return arguments_.data();
}
void FormulaHamiltonian::generating(double t, const double* q, const double* p, const double* sigma, const double* far,
                                    double h, double* out) const {
  generating_.evaluate(generating_arguments(t, q, p, sigma, far, h), out, scratch_);
}
void FormulaHamiltonian::by_parameters(double t, const double* q, const double* p, const double* sigma,
                                       const double* far, double h, double* out) const {
  by_parameters_.evaluate(generating_arguments(t, q, p, sigma, far, h), out, scratch_);
}

void FormulaHamiltonian::energy_slope(double t, const double* q, const double* p, const double*, double* out) const {
  const std::size_t n = size();
  std::vector<double> numbers(SecondOrder::count(int(2 * n)));
  hamiltonian(t, q, p, numbers.data());
  std::copy_n(numbers.begin() + 1, 2 * n, out);
  energy_by_parameters_.evaluate(at(t, q, p), out + 2 * n, scratch_);
}

// v = H_p.
Eigen::MatrixXd FormulaHamiltonian::velocity_slope(double t, const double* q, const double* p, const double*) const {
  const int n = int(size()), parameters = int(FormulaSystem::parameters().size());
  std::vector<double> numbers(SecondOrder::count(2 * n));
  hamiltonian(t, q, p, numbers.data());
  const SecondOrder energy{numbers.data(), 2 * n};
  Eigen::MatrixXd by_parameters(n, parameters), out(n, 2 * n + parameters);
  velocity_by_parameters_.evaluate(at(t, q, p), by_parameters.data(), scratch_);
  for (int i = 0; i < n; ++i)
    for (int j = 0; j < 2 * n; ++j) out(i, j) = energy.second(n + i, j);
  out.rightCols(parameters) = by_parameters;
  return out;
}

}  // namespace lagroid
