#pragma once
/// What can be observed at the points of a system's trajectories: position, momentum, multipliers, residuals and
/// quantities.
///
///     SystemNode<Sys> node(system, presentation, quantities_of(system));
///     node.see(point);
///     const Endpoint end = node.endpoint();
///
/// Requires points in order, and a presentation that outlives it. Momenta are reported tangent to the object
/// constraints.

#include <lagroid/core/capabilities/stepped.hpp>
#include <lagroid/core/derivatives/two_sided.hpp>
#include <lagroid/core/noether.hpp>
#include <lagroid/core/quantity.hpp>
#include <lagroid/run/motion/observables.hpp>
#include <lagroid/run/motion/presentation.hpp>
#include <lagroid/solvers/generating/constrained_momentum.hpp>

#include <algorithm>
#include <functional>
#include <limits>
#include <optional>
#include <span>
#include <utility>
#include <vector>

namespace lagroid {

/// Sees every point of a run, in order; may be null.
template <class Sys> using Observer = std::function<void(const TrajectoryPoint<Sys>&)>;

/// A recorded function of trajectory points.
template <class Sys> struct FieldOf {
  Field field;
  std::function<void(const TrajectoryPoint<Sys>&, double*)> evaluate;
};

/// Makes it the system of an arrow that starts at that time and lasts so long.
template <DiscreteSystem Sys> void set_arrow(Sys& system, double start, double size) {
  if constexpr (HasTimeStep<Sys>) system.h = size;
  set_time(system, start);
}
/// The largest |phi| of the arrow; NaN where one is no finite number.
template <DiscreteSystem Sys> double constraint_residual(const Sys& system, const Step<Sys>& step) {
  const auto c = constraint_values(system, step.arrow);
  return c.allFinite() ? c.cwiseAbs().maxCoeff() : std::numeric_limits<double>::quiet_NaN();
}

/// A point of a system's trajectory, as it is reported: with its momentum made tangent to the object constraints.
template <DiscreteSystem Sys> class SystemNode final : public Observables {
 public:
  using G = typename Sys::GroupoidType;
  using Point = TrajectoryPoint<Sys>;

  /// With the fields that the presentation names: it must outlive this.
  SystemNode(const Sys& system, const Presentation<Sys>& presentation, std::vector<Quantity<Sys>> quantities)
      : SystemNode(system, std::vector<FieldOf<Sys>>{}, std::move(quantities)) {
    presentation_ = &presentation;
    declare(presentation);
  }
  /// With fields of one's own, and without endpoints.
  SystemNode(const Sys& system, std::vector<FieldOf<Sys>> fields, std::vector<Quantity<Sys>> quantities)
      : system_(system), quantities_(std::move(quantities)) {
    for (const auto& q : quantities_)
      watched_.push_back({q.name, q.components, q.promise, q.needs_step, q.size ? SizeOf::terms : SizeOf::value, true,
                          q.serialize != nullptr});
    for (auto& f : fields) add(std::move(f.field), std::move(f.evaluate));
  }
  SystemNode(const SystemNode&) = delete;
  SystemNode& operator=(const SystemNode&) = delete;

  /// Goes on to the next point. `noise`: what the evaluation of its momentum lost, relative to its size, where that was
  /// not updated from the point before.
  void see(const Point& point, double noise = 0) {
    point_ = point;
    point_.state.momentum = tangent_momentum(system_, point.state);
    noise_ = noise;
    if constexpr (Sys::constraints > 0)
      if (point_.index > 0) {
        residual_ = residual_of(point_.step, point_.time - point_.step_size, point_.step_size);
        worst_ = {residual_, point_.step, point_.time - point_.step_size, point_.step_size};
      }
  }
  /// An arrow before the last of the step that led there, which starts at `start` and lasts `over`.
  void see_inner(const Step<Sys>& step, double start, double over) {
    if constexpr (Sys::constraints > 0) {
      const double residual = residual_of(step, start, over);
      if (!(residual <= worst_.residual)) worst_ = {residual, step, start, over};
    }
  }

  /// The system has become another, and its quantities with it; what is summed up over steps stays as it was. Of a
  /// quantity that it has no more, as its symmetry is gone, nothing is promised from there.
  template <class Change> void change(const Change& how, const std::vector<Quantity<Sys>>& quantities) {
    how(system_);
    how(arrow_system_);
    for (std::size_t i = 0; i < quantities_.size(); ++i) {
      if (watched_[i].adds_up) continue;
      const auto changed = std::find_if(quantities.begin(), quantities.end(),
                                        [&](const Quantity<Sys>& q) { return q.name == quantities_[i].name; });
      if (changed != quantities.end())
        quantities_[i] = *changed;
      else
        watched_[i].is_promised = false;
    }
  }

  const Point& point() const { return point_; }

  long index() const override { return point_.index; }
  double time() const override { return point_.time; }
  const std::vector<Field>& fields() const override { return fields_; }
  void read(std::size_t field, double* row) const override { read_[field](point_, row); }
  const std::vector<Watched>& quantities() const override { return watched_; }
  double measure(std::size_t i, double* values) const override {
    quantities_[i].evaluate(point_, values);
    return quantities_[i].size ? quantities_[i].size(point_) : 0;
  }
  double noise() const override { return noise_; }

  Constrained constrained() const override { return Sys::constraints > 0 ? Constrained::promised : Constrained::no; }
  std::optional<double> residual() const override {
    if (Sys::constraints == 0 || point_.index == 0) return std::nullopt;
    return worst_.residual;
  }
  double residual_size() const override {
    if constexpr (Sys::constraints == 0) {
      return 0;
    } else {
      set_arrow(arrow_system_, worst_.start, worst_.size);
      const auto d = two_sided(arrow_system_, worst_.step.arrow, worst_.step.multipliers);
      return (d.constraint_target.cwiseAbs() * system_.groupoid.coordinate_scale(worst_.step.arrow)).maxCoeff();
    }
  }

  std::span<const double> positions() const override {
    if constexpr (G::object_coordinate_count() > 0) {
      position_ = system_.groupoid.coordinates_of_object(point_.state.object);
      return {position_.data(), std::size_t(position_.size())};
    }
    return {};
  }

  Endpoint endpoint() const override {
    Endpoint e;
    e.time = point_.time;
    if (presentation_ == nullptr) return e;
    e.position = presentation_->position_of(point_);
    e.momentum = {point_.state.momentum.begin(), point_.state.momentum.end()};
    if (presentation_->has_attitude) {
      e.attitude = presentation_->attitude_of(point_);
      if (presentation_->body_is_transposed) {
        e.body_attitude = e.attitude;
        for (int i = 1; i < 4; ++i) (*e.body_attitude)[i] = -(*e.attitude)[i];
      }
    }
    return e;
  }

  /// Visits what quantities keep from point to point.
  void serialize(NumberArchive& archive) {
    for (auto& quantity : quantities_)
      if (quantity.serialize) quantity.serialize(archive);
  }

 private:
  using Evaluate = std::function<void(const Point&, double*)>;

  /// One of the arrows of a step.
  struct Arrow {
    double residual = 0;
    Step<Sys> step{};
    double start = 0;
    double size = 0;  ///< s
  };

  double residual_of(const Step<Sys>& step, double start, double size) const {
    set_arrow(arrow_system_, start, size);
    return constraint_residual(arrow_system_, step);
  }

  void add(Field field, Evaluate evaluate) {
    fields_.push_back(std::move(field));
    read_.push_back(std::move(evaluate));
  }
  void declare(const Presentation<Sys>& p) {
    if (!p.position.empty())
      add({{"position", p.position, p.position_unit, "object q", false, {}}}, [&p](const Point& point, double* out) {
        const auto q = p.position_of(point);
        std::copy(q.begin(), q.end(), out);
      });
    if (p.has_attitude)
      add({.columns = {"attitude", attitude_columns, "1", "attitude A, unit quaternion w, x, y, z", false, {}},
           .is_unit_quaternion = true},
          [&p](const Point& point, double* out) {
            const auto q = p.attitude_of(point);
            std::copy(q.begin(), q.end(), out);
          });
    add({{"momentum", p.momentum, p.momentum_unit, "momentum mu in A*G, basis of the retraction", false, {}}},
        [](const Point& point, double* out) {
          std::copy(point.state.momentum.begin(), point.state.momentum.end(), out);
        });
    if constexpr (Sys::constraints > 0) {
      add({{"multipliers",
            p.multipliers,
            "action / unit of the constraint",
            Nonholonomic<Sys> ? "impulses lambda of the reaction <lambda, omega>"
                              : "multipliers lambda of L + <lambda, phi>",
            true,
            {}}},
          [](const Point& point, double* out) {
            std::copy(point.step.multipliers.begin(), point.step.multipliers.end(), out);
          });
      add({{"constraint_residual", {"residual"}, "unit of the constraint", "largest |phi| on the arrow", true, {}}},
          [this](const Point&, double* out) { *out = residual_; });
    }
    for (const auto& extra : p.extras) add({extra.series}, extra.evaluate);
    for (std::size_t i = 0; i < quantities_.size(); ++i)
      add({.columns = {"drift of " + quantities_[i].name,
                       {"drift " + quantities_[i].name},
                       "unit of the quantity",
                       "norm of the deviation from the first value",
                       quantities_[i].needs_step,
                       {}},
           .drift_of = i},
          nullptr);
  }

  Sys system_;
  mutable Sys arrow_system_ = system_;  ///< with the step and the time of the arrow that is looked at
  const Presentation<Sys>* presentation_ = nullptr;
  std::vector<Quantity<Sys>> quantities_;
  std::vector<Watched> watched_;
  std::vector<Field> fields_;
  std::vector<Evaluate> read_;
  Point point_;
  double noise_ = 0;
  double residual_ = 0;  ///< of the last arrow
  Arrow worst_;
  mutable Vector<double, G::object_coordinate_count()> position_;
};

}  // namespace lagroid
