#pragma once
/// What systems written as text have in common: coordinates of R^n, parameters, constraints of places and symmetries.
///
/// A motion asks it what it shows and keeps.
///
///     const Eigen::MatrixXd c = system.constraint_rows(q);  // C and C', a row each
///     system.fields(q.data(), xi.data());                   // of all symmetries
///
/// Errors: FormulaError, which says what was read and what is wrong in it.

#include <lagroid/run/expressions/formula_graph.hpp>
#include <lagroid/solvers/step/sized_step.hpp>

#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

namespace lagroid {

/// A mistake in a text; `key` says in which, as scenes call it: "coordinates", "l", "constraints", ...; of fields,
/// `which` says of which symmetry.
class FormulaError : public std::invalid_argument {
 public:
  FormulaError(std::string key, const std::string& problem, std::size_t which = 0)
      : std::invalid_argument(problem), key_(std::move(key)), which_(which) {}
  const std::string& key() const { return key_; }
  std::size_t which() const { return which_; }

 private:
  std::string key_;
  std::size_t which_;
};

/// A vector field xi(q) along which nothing changes; J = <p, xi(q)> is its momentum.
struct FormulaSymmetry {
  std::string name;
  std::vector<std::string> field;
};
/// The same as it was read.
struct ReadSymmetry {
  std::string name;
  bool affine;  ///< in q: curves of polynomials are carried to such, and steps along them keep J
};

/// By how much of its size the worst constraint is off, and which it is, from one on; zero up to rounding where all
/// hold.
struct OffConstraint {
  double share = 0;
  std::size_t which = 0;
};

/// The texts that all of them have.
struct FormulaTexts {
  std::vector<std::string> coordinates = {};
  std::vector<std::string> constraints = {};
  std::vector<FormulaSymmetry> symmetries = {};
  std::vector<std::pair<std::string, double>> parameters = {};
};

class FormulaSystem {
 public:
  virtual ~FormulaSystem() = default;

  const std::vector<std::string>& coordinates() const { return coordinates_; }
  /// Their velocities and momenta, as columns and formulas call them.
  const std::vector<std::string>& velocities() const { return velocities_; }
  const std::vector<std::string>& momenta() const { return momenta_; }
  std::size_t constraint_count() const { return constraint_count_; }
  const std::vector<ReadSymmetry>& symmetries() const { return symmetries_; }
  /// Whether nothing but l or H decides of the energy: no force, no time.
  virtual bool keeps_energy() const = 0;
  /// What the energy is, in words.
  virtual const char* energy_is() const = 0;

  /// The names of its parameters, and their values.
  const std::vector<std::pair<std::string, double>>& parameters() const { return parameters_; }
  /// Gives one of these another value, and all that is evaluated with it; others are left alone.
  void set_parameter(const std::string& name, double value);
  virtual std::unique_ptr<FormulaSystem> clone() const = 0;
  /// The derivatives of the energy by q, p and the parameters, at a momentum of which v is the velocity.
  virtual void energy_slope(double t, const double* q, const double* p, const double* v, double* out) const = 0;
  /// The derivatives of the velocity v of a momentum by q, p and the parameters, a row for each component.
  virtual Eigen::MatrixXd velocity_slope(double t, const double* q, const double* p, const double* v) const = 0;
  /// Of each symmetry the derivatives of <p, xi> by q, p and the parameters.
  void momentum_slopes(const double* q, const double* p, double* out) const;

  /// C, its n derivatives and its n (n + 1) / 2 second ones, all of the first component, then of the next.
  void constraint(const double* q, double* out) const;
  std::size_t constraint_numbers() const { return constraint_.count(); }
  /// C and its n derivatives, a row for each component.
  Eigen::MatrixXd constraint_rows(const Eigen::VectorXd& q) const;
  /// |C| over |C'| times `size`, that of places; and |C' v| over |C'| |v|.
  OffConstraint off_constraints(const Eigen::VectorXd& q, double size) const;
  OffConstraint leaving_constraints(const Eigen::VectorXd& q, const Eigen::VectorXd& v) const;
  /// The fields xi of all symmetries, one after another.
  void fields(const double* q, double* out) const;
  /// How much the system changes along symmetry i at (q, w), w the velocity of a Lagrangian or the momentum of a
  /// Hamiltonian: the largest of l or H, C and the work of the force, relative to their terms. Zero up to rounding
  /// where it is one.
  double symmetry_defect(std::size_t i, double t, const double* q, const double* w) const;
  bool by_velocity() const { return by_velocity_; }

 protected:
  using Node = FormulaGraph::Node;
  /// After the coordinates formulas have their velocities, or the momenta, p_x of x where none are named.
  FormulaSystem(const FormulaTexts& texts, std::vector<std::string> momenta, bool by_velocity);

  Node read(const std::string& key, const std::string& text, std::size_t which = 0);
  bool depends(Node f, std::size_t variable) { return !graph_.is_zero(graph_.derivative(f, variable)); }
  /// f, its derivatives by the first `count` variables, and the upper triangle of its second ones.
  std::vector<Node> with_derivatives(Node f, std::size_t count);
  /// Reads constraints, and symmetries, along which neither `function` nor the work of the force changes. To be called
  /// once.
  void read_constraints_and_symmetries(const FormulaTexts& texts, Node function, const std::vector<Node>& force);
  /// Of variables that q, w, t and the parameters have.
  const double* at(double t, const double* q, const double* w) const;
  /// Refuses parameters that no formula reads: those of `programs`, constraints and fields.
  void require_parameters_read(const FormulaTexts& texts, const std::vector<const FormulaProgram*>& programs) const;

  std::size_t size() const { return coordinates_.size(); }
  std::size_t time() const { return 2 * coordinates_.size(); }  ///< the variable t
  std::size_t variable_of_parameter(std::size_t i) const { return time() + 1 + i; }

  FormulaGraph graph_;
  std::vector<std::string> names_;  ///< of the variables
  // Where operations are made: each motion has a system of its own.
  mutable std::vector<double> variables_, scratch_;

 private:
  /// Refuses a formula, of that key, of anything but coordinates and parameters.
  void require_of_places(Node f, const std::string& key, const std::string& text, std::size_t which = 0);
  std::vector<Node> read_constraints(const FormulaTexts& texts);
  /// Of a field what changes along it, with the sum of its terms' sizes: the function, each constraint, the work.
  std::vector<Node> changes_along(const std::vector<Node>& field, Node function, const std::vector<Node>& constraints,
                                  const std::vector<Node>& force);

  std::vector<std::string> coordinates_, velocities_, momenta_;
  std::vector<std::pair<std::string, double>> parameters_;
  bool by_velocity_;
  std::size_t constraint_count_ = 0;
  std::vector<ReadSymmetry> symmetries_;
  FormulaProgram constraint_, fields_, field_slopes_, changes_;
  mutable std::vector<double> changed_;
};

}  // namespace lagroid
