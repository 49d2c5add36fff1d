#pragma once
/// What a scene asks of a node in the numbers of its state: that some of them are given, and that formulas of them
/// vanish, as "x^2 + y^2 - 4".
///
///     const auto on = std::make_shared<const StateFormulas>(texts, names);
///     task.end_condition = std::make_shared<const StateCondition<SE2>>(start, end, given, on);
///
/// Derivatives are exact: those of the formulas as further formulas, those of the numbers by the node's displacement by
/// jets. Errors: std::invalid_argument for a text that is no formula of the names, with what is wrong in it.

#include <lagroid/run/expressions/formula_graph.hpp>
#include <lagroid/solvers/control/node_condition.hpp>
#include <lagroid/systems/control/flows/flow_states.hpp>

#include <array>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::app {

/// Formulas of a state's numbers, with their first and second derivatives.
class StateFormulas {
 public:
  StateFormulas(const std::vector<std::string>& texts, const std::vector<std::string>& names);

  int size() const { return int(texts_.size()); }
  const std::vector<std::string>& texts() const { return texts_; }
  void values(const double* state, double* out) const;
  /// Of each formula n first derivatives, then n x n second ones.
  void derivatives(const double* state, double* out) const;

 private:
  std::vector<std::string> texts_;
  FormulaProgram values_;
  FormulaProgram derivatives_;
  mutable std::vector<double> scratch_;
};

template <class G> class StateCondition final : public NodeCondition<G> {
  using typename NodeCondition<G>::J;

 public:
  using Base = NodeCondition<G>;
  using States = FlowStates<G>;
  using State = typename States::State;
  static constexpr int size_of_state = States::size;
  using Given = std::array<bool, std::size_t(size_of_state)>;

  /// Of a motion that begins at `start`: the numbers that are `given` are those of `at`. Without formulas `on` is null.
  StateCondition(const State& start, const State& at, const Given& given, std::shared_ptr<const StateFormulas> on)
      : start_(start), at_(at), on_(std::move(on)) {
    for (int i = 0; i < size_of_state; ++i)
      if (given[std::size_t(i)]) given_.push_back(i);
    if (on_) of_formulas_.resize(std::size_t(on_->size() * (size_of_state + size_of_state * size_of_state)));
  }

  int size() const override { return int(given_.size()) + (on_ ? on_->size() : 0); }
  /// What each row says: a number of the state that is given, or a formula.
  template <class Names> std::vector<std::string> words(const Names& states) const {
    std::vector<std::string> out;
    for (const int i : given_) out.push_back(std::string(states[std::size_t(i)]) + " as given");
    if (on_)
      for (const std::string& text : on_->texts()) out.push_back('"' + text + '"');
    return out;
  }

  void values(const G&, const ArrowOf<G>& node, double* out) const override {
    const State off = States::offset(start_, node, at_);
    for (const int i : given_) *out++ = off(i);
    if (on_) on_->values(State(States::reached(start_, node)).data(), out);
  }

  void derivatives(const G& groupoid, const ArrowOf<G>& node, const double* lambda, double* rows,
                   double* hessian) const override {
    const ArrowOf<G, J> near = Base::near(groupoid, node);
    int row = 0;
    if (!given_.empty()) {
      const Vector<J, size_of_state> off = States::offset(start_, near, at_);
      for (const int i : given_) {
        Base::place(off(i), row, lambda[row], rows, hessian);
        ++row;
      }
    }
    if (!on_) return;
    const Vector<J, size_of_state> state = States::reached(start_, near);
    State values;
    for (int i = 0; i < size_of_state; ++i) values(i) = state(i).value;
    on_->derivatives(values.data(), of_formulas_.data());
    const double* first = of_formulas_.data();
    for (int k = 0; k < on_->size(); ++k, ++row) {
      const double* second = first + size_of_state;
      // The formula's second-order expansion, evaluated at that of the state.
      J psi(0.0);
      for (int i = 0; i < size_of_state; ++i) {
        if (first[i] != 0) psi = psi + state(i) * first[i];
        for (int j = 0; j < size_of_state; ++j)
          if (const double x = second[i * size_of_state + j]; x != 0)
            psi = psi + (state(i) - values(i)) * (state(j) - values(j)) * (0.5 * x);
      }
      Base::place(psi, row, lambda[row], rows, hessian);
      first = second + size_of_state * size_of_state;
    }
  }

 private:
  State start_;
  State at_;
  std::vector<int> given_;
  std::shared_ptr<const StateFormulas> on_;
  mutable std::vector<double> of_formulas_;
};

}  // namespace lagroid::app
