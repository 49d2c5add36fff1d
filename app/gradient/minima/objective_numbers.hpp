#pragma once
/// The numbers of a scene of `lagroid optimize` by which its minimum can be differentiated, and what they are to its
/// objective.
///
///     const ObjectiveNumbers numbers("brockett", objective, manifold);
///     for (const ObjectiveNumber& each : numbers.named("data.A.3.4", 100)) print(each.name);
///
/// Errors: GradientRefused, one line, for a name that no number has.

#include <lagroid/solvers/optimisation/manifolds/manifold.hpp>
#include <lagroid/solvers/optimisation/sensitivity/parametric_objective.hpp>

#include <functional>
#include <memory>
#include <string>
#include <vector>

namespace lagroid::app {

/// One number: as it changes, each of these numbers of the objective does by as much.
struct ObjectiveNumber {
  std::string name;  ///< data.A.3.4
  double value = 0;
  double size = 0;  ///< of the value; where that is zero a hundredth of the largest in its row
  std::vector<optimisation::ParameterEntry> entries;
};

class ObjectiveNumbers {
 public:
  /// Refers to the objective; `problem` is what the scene calls it.
  ObjectiveNumbers(const std::string& problem, const optimisation::ParametricObjective& objective,
                   const optimisation::Manifold& manifold);

  /// Those that a word chooses: `parameters`, `data`, a table of these, a row of it, one number.
  std::vector<ObjectiveNumber> named(const std::string& word) const;
  /// Parameters, and data of no more than so many numbers a table; of the others a note says how to ask for them.
  std::vector<ObjectiveNumber> few(Eigen::Index most, std::vector<std::string>& notes) const;

  /// The objective with a number changed by so much. Throws std::invalid_argument, with the reason, where there is none
  /// such.
  static std::unique_ptr<optimisation::ParametricObjective> changed(const optimisation::ParametricObjective& objective,
                                                                    const ObjectiveNumber& number, double by);

 private:
  /// A table of the scene.
  struct Table {
    optimisation::ParameterTable of_scene;
    /// What an entry of it is to the objective; none where another entry stands for it.
    std::function<std::vector<optimisation::ParameterEntry>(Eigen::Index row, Eigen::Index column)> entries;
  };
  std::vector<ObjectiveNumber> of_table(const Table& table) const;
  ObjectiveNumber number(const Table& table, Eigen::Index row, Eigen::Index column) const;
  double largest_in_row(const Table& table, Eigen::Index row) const;

  const optimisation::ParametricObjective& objective_;
  std::vector<Table> tables_;
};

}  // namespace lagroid::app
