#pragma once
/// From trajectory points to ledger, series and endpoints.

#include <lagroid/core/noether.hpp>
#include <lagroid/core/quantity.hpp>
#include <lagroid/core/stepped.hpp>
#include <lagroid/core/two_sided.hpp>
#include <lagroid/run/archive.hpp>
#include <lagroid/run/ledger.hpp>
#include <lagroid/run/run_result.hpp>
#include <lagroid/run/stepped_run.hpp>

#include <algorithm>
#include <array>
#include <functional>
#include <limits>
#include <map>
#include <numeric>
#include <span>
#include <string>
#include <utility>
#include <vector>

namespace lagroid {

/// A recorded function of trajectory points beyond those every system has.
template <class Sys> struct ExtraColumns {
  Columns series;  ///< without values
  std::function<void(const TrajectoryPoint<Sys>&, double*)> evaluate;
};

/// How reports speak of a system: the mathematics is in systems/, the words and units are here.
template <class Sys> struct Presentation {
  std::string name;
  std::vector<std::string> position;  ///< labels; may be empty (a group has one object)
  std::string position_unit;
  bool has_attitude = false;
  bool body_is_transposed = false;  ///< reports show the attitude A^T too
  std::vector<std::string> momentum;
  std::string momentum_unit;
  std::vector<std::string> multipliers;
  std::function<std::vector<double>(const TrajectoryPoint<Sys>&)> position_of;
  std::function<std::array<double, 4>(const TrajectoryPoint<Sys>&)> attitude_of;
  std::vector<ExtraColumns<Sys>> extras;
  std::vector<Panel> panels;
  std::vector<Shape> shapes;
  std::map<std::string, std::string> conventions;
};

/// Observes the points of one trajectory in order.
template <DiscreteSystem Sys> class Recorder {
 public:
  using G = typename Sys::GroupoidType;

  /// `every` = 0 records nothing but the ledger and the endpoints.
  Recorder(const Sys& system, const Presentation<Sys>& presentation, long every, Observer<Sys> observer = nullptr)
      : Recorder(system, presentation, quantities_of(system), every, std::move(observer)) {}
  /// With other quantities than `quantities_of` the system.
  Recorder(const Sys& system, const Presentation<Sys>& presentation, std::vector<Quantity<Sys>> quantities, long every,
           Observer<Sys> observer = nullptr)
      : system_(system),
        presentation_(presentation),
        quantities_(std::move(quantities)),
        every_(every),
        observer_(std::move(observer)) {
    for (const auto& q : quantities_) {
      watches_.emplace_back(q.name, q.promise, q.components.size(), q.size ? SizeOf::terms : SizeOf::value);
      first_.emplace_back(q.components.size());
      now_.emplace_back(q.components.size());
    }
    if (every_ > 0) declare_series();
  }

  /// `noise`: what the evaluation of the momentum at this point lost, relative to its size, where it was not carried
  /// along from the point before.
  void observe(const TrajectoryPoint<Sys>& point, double noise = 0) {
    if (observer_) observer_(point);
    if constexpr (G::object_coordinate_count() > 0) {
      Vector<double, G::object_coordinate_count()> position;
      positions_.observe([&] {
        position = system_.groupoid.coordinates_of_object(point.state.object);
        return std::span<const double>(position.data(), std::size_t(position.size()));
      });
    }
    const bool has_step = point.index > 0;
    for (std::size_t i = 0; i < quantities_.size(); ++i) {
      const auto& q = quantities_[i];
      if (q.needs_step && !has_step) continue;
      q.evaluate(point, now_[i].data());
      if (point.index == (q.needs_step ? 1 : 0)) first_[i] = now_[i];
      const double size = q.size ? q.size(point) : norm_of(now_[i]);
      watches_[i].observe(now_[i].data(), size, noise * size);
    }
    const double residual = has_step ? watch_constraint(point.step, point.time - point.step_size, point.step_size) : 0;
    if (point.index == 0) initial_ = endpoint(point);
    if (point.index == 1) first_multipliers_ = list(point.step.multipliers);
    last_point_ = point;
    last_residual_ = residual;
    pending_ = every_ > 0 && point.index % every_ != 0;
    if (every_ > 0 && !pending_) record(point, residual);
  }

  /// The constraint residual of an arrow that starts at `start` and lasts `over`, for the ledger.
  double watch_constraint(const Step<Sys>& step, double start, double over) {
    if constexpr (Sys::constraints == 0) {
      return 0;
    } else {
      if constexpr (HasTimeStep<Sys>) system_.h = over;
      set_time(system_, start);
      const auto c = constraint_values(system_, step.arrow);
      const double residual = c.allFinite() ? c.cwiseAbs().maxCoeff() : std::numeric_limits<double>::quiet_NaN();
      // The size of the constraints' terms changes slowly: looked at where a residual stands out.
      if (!(residual <= largest_residual_) || constraint_size_ == 0) {
        const auto d = two_sided(system_, step.arrow, step.multipliers);
        constraint_size_ =
            std::max(constraint_size_,
                     (d.constraint_target.cwiseAbs() * system_.groupoid.coordinate_scale(step.arrow)).maxCoeff());
        largest_residual_ = worse(largest_residual_, residual);
      }
      return residual;
    }
  }

  Trajectory& trajectory() { return trajectory_; }

  /// Visits what it has seen, but for the rows and the first point.
  void persist(Archive& archive) {
    for (std::size_t i = 0; i < watches_.size(); ++i) archive("watch " + std::to_string(i), watches_[i]);
    for (std::size_t i = 0; i < first_.size(); ++i) archive.list("first " + std::to_string(i), first_[i]);
    for (std::size_t i = 0; i < now_.size(); ++i) archive.list("now " + std::to_string(i), now_[i]);
    archive("positions", positions_);
    archive("largest residual", largest_residual_);
    archive("constraint size", constraint_size_);
    archive("last residual", last_residual_);
    archive("pending", pending_);
    archive("first multipliers", first_multipliers_);
    archive.tape("point and quantities", [&](Tape& tape) {
      last_point_.persist(system_.groupoid, tape);
      for (auto& quantity : quantities_)
        if (quantity.persist) quantity.persist(tape);
    });
  }

  /// Moves what was observed into the result.
  void finish(RunResult& result) {
    if (pending_) record(last_point_, last_residual_);
    result.system = presentation_.name;
    result.initial = initial_;
    result.final = endpoint(last_point_);
    result.first_multipliers = first_multipliers_;
    if (last_point_.index > 0) result.last_multipliers = list(last_point_.step.multipliers);
    if constexpr (Sys::constraints > 0)
      result.ledger.entries.push_back(constraint_entry(largest_residual_, constraint_size_));
    for (const auto& watch : watches_) result.ledger.entries.push_back(watch.entry());
    positions_.withhold_verdicts(result.ledger);
    result.trajectory = std::move(trajectory_);
    result.trajectory.conventions = presentation_.conventions;
    result.panels = presentation_.panels;
    result.shapes = presentation_.shapes;
  }

 private:
  template <class V> static std::vector<double> list(const V& v) { return {v.data(), v.data() + v.size()}; }

  Endpoint endpoint(const TrajectoryPoint<Sys>& point) const {
    Endpoint e;
    e.time = point.time;
    e.position = presentation_.position_of(point);
    e.momentum = list(point.state.momentum);
    if (presentation_.has_attitude) {
      e.attitude = presentation_.attitude_of(point);
      if (presentation_.body_is_transposed) {
        e.body_attitude = e.attitude;
        for (int i = 1; i < 4; ++i) (*e.body_attitude)[i] = -(*e.attitude)[i];
      }
    }
    return e;
  }

  void declare_series() {
    auto& s = trajectory_.series;
    const auto& p = presentation_;
    if (!p.position.empty()) s.push_back({"position", p.position, p.position_unit, "object q", false, {}});
    if (p.has_attitude)
      s.push_back({"attitude", {"A_w", "A_x", "A_y", "A_z"}, "1", "attitude A, unit quaternion w, x, y, z", false, {}});
    s.push_back({"momentum", p.momentum, p.momentum_unit, "momentum mu in A*G, basis of the retraction", false, {}});
    if constexpr (Sys::constraints > 0) {
      s.push_back({"multipliers",
                   p.multipliers,
                   "action / unit of the constraint",
                   Nonholonomic<Sys> ? "impulses lambda of the reaction <lambda, omega>"
                                     : "multipliers lambda of L + <lambda, phi>",
                   true,
                   {}});
      s.push_back(
          {"constraint_residual", {"residual"}, "unit of the constraint", "largest |phi| on the arrow", true, {}});
    }
    for (const auto& extra : p.extras) s.push_back(extra.series);
    for (const auto& q : quantities_)
      s.push_back({"drift of " + q.name,
                   {"drift " + q.name},
                   "unit of the quantity",
                   "norm of the deviation from the first value",
                   q.needs_step,
                   {}});
  }

  /// Of the two unit quaternions of a rotation, the one nearer to the last row, so that curves have no jumps.
  static std::array<double, 4> beside(std::array<double, 4> q, const std::vector<double>& rows) {
    if (rows.size() < q.size()) return q;
    if (std::inner_product(q.begin(), q.end(), rows.end() - 4, 0.0) < 0)
      for (double& component : q) component = -component;
    return q;
  }

  void record(const TrajectoryPoint<Sys>& point, double residual) {
    trajectory_.time.push_back(point.time);
    std::size_t at = 0;
    const auto put = [&](const auto& values) {
      auto& target = trajectory_.series[at++].values;
      target.insert(target.end(), values.begin(), values.end());
    };
    const bool has_step = point.index > 0;
    if (!presentation_.position.empty()) put(presentation_.position_of(point));
    if (presentation_.has_attitude) put(beside(presentation_.attitude_of(point), trajectory_.series[at].values));
    put(point.state.momentum);
    if constexpr (Sys::constraints > 0) {
      if (has_step) {
        put(point.step.multipliers);
        put(std::vector{residual});
      } else {
        at += 2;
      }
    }
    for (const auto& extra : presentation_.extras) {
      if (extra.series.on_arrows && !has_step) {
        ++at;
        continue;
      }
      std::vector<double> values(extra.series.width());
      extra.evaluate(point, values.data());
      put(values);
    }
    for (std::size_t i = 0; i < quantities_.size(); ++i) {
      if (quantities_[i].needs_step && !has_step) {
        ++at;
        continue;
      }
      std::vector<double> deviation = now_[i];
      for (std::size_t j = 0; j < deviation.size(); ++j) deviation[j] -= first_[i][j];
      put(std::vector{norm_of(deviation)});
    }
  }

  Sys system_;
  const Presentation<Sys>& presentation_;
  std::vector<Quantity<Sys>> quantities_;
  std::vector<QuantityWatch> watches_;
  PositionWatch positions_;
  std::vector<std::vector<double>> first_;
  std::vector<std::vector<double>> now_;
  long every_;
  Observer<Sys> observer_;
  double largest_residual_ = 0;
  double constraint_size_ = 0;
  TrajectoryPoint<Sys> last_point_;
  double last_residual_ = 0;
  bool pending_ = false;
  Endpoint initial_;
  std::vector<double> first_multipliers_;
  Trajectory trajectory_;
};

}  // namespace lagroid
