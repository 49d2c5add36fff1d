#pragma once
/// Functions f(x; theta) that say which numbers theta they read, and how they change with them: what the derivatives of
/// a least value and of its minimiser are made of (minimum_derivatives.hpp).
///
///     struct Pull final : optimisation::ParametricObjective {  // f = -a^T x
///       explicit Pull(Eigen::Vector3d a) : direction(a) {}
///       double evaluate(const optimisation::Point& x, optimisation::Vector& gradient) const override {
///         gradient = -direction;
///         return -direction.dot(x);
///       }
///       std::vector<optimisation::ParameterTable> parameters() const override { return {{"a", 3}}; }
///       double parameter(const optimisation::ParameterEntry& which) const override { return direction(which.row); }
///       double by_parameter(const optimisation::ParameterEntry& which, const optimisation::Point& x,
///                           optimisation::Vector& gradient) const override {
///         gradient = -optimisation::Vector::Unit(3, which.row);
///         return -x(which.row);
///       }
///       std::unique_ptr<optimisation::ParametricObjective> changed(const optimisation::ParameterEntry& which,
///                                                                  double by) const override {
///         auto out = std::make_unique<Pull>(direction);
///         out->direction(which.row) += by;
///         return out;
///       }
///       Eigen::Vector3d direction;
///     };
///
/// laws::parametric_objective_laws asks whether what is written is right. Errors: std::invalid_argument for a name that
/// no number has.

#include <lagroid/solvers/optimisation/objective.hpp>

#include <Eigen/Core>

#include <cstddef>
#include <memory>
#include <string>
#include <vector>

namespace lagroid::optimisation {

/// Numbers that f reads, in rows and columns: weights, or a matrix.
struct ParameterTable {
  std::string name;
  Eigen::Index rows = 1;
  Eigen::Index columns = 1;
  /// Entries (i, j) and (j, i) are one number, which changes both.
  bool is_symmetric = false;

  /// How many numbers there are.
  Eigen::Index count() const { return is_symmetric ? rows * (rows + 1) / 2 : rows * columns; }
};

/// One number: the place of its table in `ParametricObjective::parameters`, and its row and column there.
struct ParameterEntry {
  std::size_t table = 0;
  Eigen::Index row = 0;
  Eigen::Index column = 0;

  friend bool operator==(const ParameterEntry&, const ParameterEntry&) = default;
};

/// f(x; theta). What is written here is differentiated by hand: no derivative by a parameter is a difference.
class ParametricObjective : public Objective {
 public:
  /// All numbers by which f can be differentiated.
  virtual std::vector<ParameterTable> parameters() const = 0;
  /// The value of one.
  virtual double parameter(const ParameterEntry& which) const = 0;
  /// d f(x) / d theta_k, and d D f(x) / d theta_k in E. Requires a point of the manifold. Not a number where there is
  /// none.
  virtual double by_parameter(const ParameterEntry& which, const Point& x, Vector& gradient) const = 0;
  /// f with another theta_k, to compare with. Throws std::invalid_argument where f is defined for none such.
  virtual std::unique_ptr<ParametricObjective> changed(const ParameterEntry& which, double by) const = 0;
};

/// `A.3.4`, `weights.2` where there is one column, `c` of a number alone; places count from zero.
std::string name_of(const ParameterTable& table, Eigen::Index row, Eigen::Index column);
std::string name_of(const std::vector<ParameterTable>& tables, const ParameterEntry& which);

/// What a name chooses: `A` all of a table, `A.3` the numbers of a row, `A.3.4` one, of a symmetric matrix by either
/// name. Throws std::invalid_argument, with the tables that there are, for a name that chooses none.
std::vector<ParameterEntry> entries_named(const std::vector<ParameterTable>& tables, const std::string& name);

}  // namespace lagroid::optimisation
