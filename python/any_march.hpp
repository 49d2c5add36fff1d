#pragma once
/// A march of any system, as the Python module sees it: numbers with shapes.

#include <lagroid/core/quantity.hpp>
#include <lagroid/core/tape.hpp>
#include <lagroid/solvers/march.hpp>
#include <lagroid/solvers/method.hpp>
#include <lagroid/solvers/step_solver.hpp>

#include <cstddef>
#include <functional>
#include <numeric>
#include <string>
#include <utility>
#include <vector>

namespace lagroid::python {

/// One of the things that are seen at a node, as a vector or, columns first in memory, a matrix.
struct Field {
  std::string name;
  std::vector<std::size_t> shape;
  bool on_arrows = false;  ///< of the arrow that led to the node: the first node has none

  std::size_t width() const { return std::accumulate(shape.begin(), shape.end(), std::size_t(1), std::multiplies<>()); }
};

/// A quantity that the ledger watches.
struct Watched {
  std::string name;
  std::vector<std::string> components;
  Promise promise = Promise::bounded;
  bool on_arrows = false;
  bool sized = false;  ///< whether the size of its terms is known; else its own norm stands for it
};

/// Virtual, because users bring systems in modules of their own: a call for every step and every number asked for.
class AnyMarch {
 public:
  virtual ~AnyMarch() = default;
  /// One step. Where it does not converge everything is as it was.
  virtual StepReport advance() = 0;
  virtual long index() const = 0;
  virtual double time() const = 0;
  virtual MethodTraits traits() const = 0;
  virtual TimeMode mode() const = 0;
  virtual const std::vector<Field>& fields() const = 0;
  /// Writes the numbers of a field at the node that was reached.
  virtual void read(std::size_t field, double* out) const = 0;
  virtual const std::vector<Watched>& watched() const = 0;
  /// Evaluates a quantity there. Returns the size of the terms it is made of.
  virtual double watch(std::size_t quantity, double* out) const = 0;
  virtual bool constrained() const = 0;
  /// The largest |phi| on the arrows of the last step, and the size of its terms there.
  virtual double residual() const = 0;
  virtual double residual_size() const = 0;
  /// Visits all that the next step goes on from; see March::persist.
  virtual void persist(Tape& tape) = 0;
};

/// Rows of numbers of one field, for nodes or arrows. There are as many where a row has no numbers.
struct Rows {
  explicit Rows(Field of) : field(std::move(of)) {}

  Field field;
  std::size_t count = 0;
  std::vector<double> values;

  /// Room for one more.
  double* add() {
    const std::size_t at = values.size();
    values.resize(at + field.width());
    ++count;
    return values.data() + at;
  }
};

/// A stationary path between two ends.
struct BoundaryPath {
  double cost = 0;  ///< sum of the Lagrangian over the arrows
  int starts = 0;   ///< that led to it
  bool is_minimum = false;
  bool isolated = true;
  bool normal = true;
  long negative_directions = 0;
  std::vector<Rows> rows;  ///< objects and momenta at the nodes, arrows and multipliers
};

}  // namespace lagroid::python
