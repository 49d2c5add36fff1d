#pragma once
/// What can be observed of a motion at a node: fields to be recorded, quantities with their promises, residuals of
/// constraints.
///
///     for (std::size_t i = 0; i < node.quantities().size(); ++i) {
///       std::vector<double> values(node.quantities()[i].components.size());
///       const double size = node.measure(i, values.data());
///     }
///
/// Fields and quantities are the same at every node, in the same order.

#include <lagroid/core/quantity.hpp>
#include <lagroid/run/run_result.hpp>

#include <cstddef>
#include <optional>
#include <span>
#include <string>
#include <vector>

namespace lagroid {

/// Something that is recorded: a row of numbers at every node, or on every arrow.
struct Field {
  Columns columns{};                      ///< without values
  std::vector<std::size_t> shape{};       ///< of a matrix, whose columns come one after another; empty: a vector
  bool is_unit_quaternion = false;        ///< of a rotation that both signs mean: recorded without jumps
  std::optional<std::size_t> drift_of{};  ///< how far that quantity is from its first value, by the judge
};

/// What a watched quantity's sizes are: of the terms that it is made of, or, where these are not known, its own norm,
/// which may be smaller.
enum class SizeOf { terms, value };

/// A quantity that the ledger watches.
struct Watched {
  std::string name;
  std::vector<std::string> components;  ///< one label per component
  Promise promise = Promise::bounded;
  bool on_arrows = false;  ///< evaluated on the arrow that led to a node: the first node has none
  SizeOf size_of = SizeOf::terms;
  bool is_promised = true;  ///< by the method; else the ledger has how far the quantity went
  bool adds_up = false;     ///< from node to node: it is known there alone
};

/// How far a watched quantity, of that place, unit and name, is from its first value.
inline Field drift_field(std::size_t quantity, const std::string& name, const std::string& label,
                         const std::string& unit = "1") {
  return {.columns = {"drift of " + name, {"drift " + label}, unit, "deviation from the first value", false, {}},
          .drift_of = quantity};
}

/// What the ledger holds of constraints.
enum class Constrained {
  no,
  promised,  ///< the method keeps them to round-off
  watched    ///< it does not: how far off they were
};

/// The numbers at one node.
class Observables {
 public:
  virtual ~Observables() = default;

  virtual long index() const = 0;
  virtual double time() const = 0;  ///< s
  virtual Endpoint endpoint() const = 0;
  /// Whether its numbers are finite, as far as the motion needs them to go on.
  virtual bool finite() const { return true; }

  virtual const std::vector<Field>& fields() const = 0;
  /// Writes a field's row; of none that is the drift of a quantity.
  virtual void read(std::size_t field, double* row) const = 0;

  virtual const std::vector<Watched>& quantities() const = 0;
  /// Evaluates a quantity. Returns the size of the terms it is made of, where that is known.
  virtual double measure(std::size_t quantity, double* values) const = 0;
  /// What an evaluation loses beyond round-off in the terms, relative to these.
  virtual double noise() const { return 0; }

  virtual Constrained constrained() const = 0;
  /// The largest residual of constraints since the node before; none where nothing was to be kept yet.
  virtual std::optional<double> residual() const = 0;
  /// The size of the constraints' terms, to which their round-off is relative.
  virtual double residual_size() const { return 1; }
  /// Coordinates that lose their digits far from their origin (PositionWatch).
  virtual std::span<const double> positions() const { return {}; }
};

}  // namespace lagroid
