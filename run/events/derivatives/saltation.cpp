// How the derivatives of a motion pass through its events: the saltation matrices of the discrete motion.
#include <lagroid/run/events/derivatives/motion_through_events.hpp>

#include <lagroid/solvers/sensitivity/growth/growth.hpp>

#include <fmt/format.h>
#include <Eigen/QR>

#include <algorithm>
#include <cmath>
#include <stdexcept>
#include <utility>

namespace lagroid {

namespace {

using event_limits::grazing;
using event_limits::shortest;

std::string at_node(const std::string& event, double time) {
  return fmt::format(
      "{} happens at the time of a node, where what follows has no derivative: t = {:.6g}; take another step", event,
      time);
}

/// One row as a combination of all.
std::shared_ptr<const StepDerivative> replaced(Eigen::Index row, const Eigen::RowVectorXd& by) {
  return std::make_shared<ReplacedRows>(int(row), by);
}

}  // namespace

NodeValues MotionThroughEvents::along(const NodeValues& seen,
                                      const std::function<VariedVector(const VariedVector&)>& f) const {
  const Eigen::Index count = time_row() + 1, numbers = seen.values.size();
  NodeValues out;
  VariedVector all(numbers + 1);
  for (Eigen::Index first = 0; first < count; first += varied_at_once) {
    const int width = int(std::min<Eigen::Index>(varied_at_once, count - first));
    const auto varied = [&](double value, const auto& derivative) {
      VariedNumber::Tangent tangent{};
      for (int k = 0; k < width; ++k) tangent.set(k, derivative(first + k));
      return VariedNumber(value, tangent);
    };
    all(0) = varied(time(), [&](Eigen::Index k) { return k == time_row() ? 1.0 : 0.0; });
    for (Eigen::Index i = 0; i < numbers; ++i)
      all(i + 1) = varied(seen.values(i), [&](Eigen::Index k) { return seen.derivatives(i, k); });
    const VariedVector here = f(all);
    if (first == 0) {
      out.values.resize(here.size());
      out.derivatives.resize(here.size(), count);
    }
    for (Eigen::Index i = 0; i < here.size(); ++i) {
      out.values(i) = here(i).value;
      for (int k = 0; k < width; ++k) out.derivatives(i, first + k) = here(i).tangent(k);
    }
  }
  return out;
}

NodeValues MotionThroughEvents::function_by(std::size_t event, const NodeValues& seen) const {
  return along(seen, [&](const VariedVector& all) -> VariedVector {
    return VariedVector::Constant(1, events_[event].function(all));
  });
}

Eigen::MatrixXd MotionThroughEvents::changes_at_start(const Eigen::MatrixXd& directions) const {
  constexpr double rounding = 1e-12;
  NodeValues seen = motion_->observe();
  seen.derivatives.conservativeResize(Eigen::NoChange, time_row() + 1);
  seen.derivatives.col(time_row()).setZero();
  Eigen::MatrixXd out(Eigen::Index(events_.size()), directions.cols());
  for (std::size_t i = 0; i < events_.size(); ++i) {
    const Eigen::RowVectorXd by = function_by(i, seen).derivatives.row(0).head(time_row());
    const Eigen::RowVectorXd terms = by.cwiseAbs() * directions.cwiseAbs(), along = by * directions;
    out.row(Eigen::Index(i)) = (along.array().abs() <= rounding * terms.array()).select(0.0, along.array());
  }
  return out;
}

void MotionThroughEvents::begin_along(const Eigen::MatrixXd& directions) { at_start_ = changes_at_start(directions); }
bool MotionThroughEvents::stays_at_start(std::size_t event) const {
  return at_start_.rows() > 0 && at_start_.row(Eigen::Index(event)).isZero(0);
}

std::vector<std::string> MotionThroughEvents::why_none_along(const Eigen::MatrixXd& directions) {
  const Eigen::MatrixXd changes = changes_at_start(directions);
  std::vector<std::string> out(std::size_t(directions.cols()));
  advance();
  for (std::size_t i = 0; i < events_.size(); ++i)
    for (std::size_t k = 0; k < out.size() && begins_[i] != 0 && events_[i].decides(); ++k)
      if (changes(Eigen::Index(i), Eigen::Index(k)) != 0) out[k] = why_none_at_start(i);
  return out;
}

bool MotionThroughEvents::lead_to(const Piece& piece, Derivatives& to) {
  if (piece.duration == 0) throw EventWithoutDerivative(at_node(named(piece), begun_at_));
  if (!motion_->go(piece.duration).converged()) return false;
  const Derivatives part = motion_->part();
  if (part.empty()) return false;
  if (!piece.conflict.empty()) throw EventWithoutDerivative(piece.conflict);
  const NodeValues g = function_by(piece.events.front(), motion_->observe_in_part());
  if (!g.derivatives.allFinite())
    throw EventWithoutDerivative(
        fmt::format("the function of {} has no derivative at t = {:.6g}", named(piece), time()));
  // By what the part begins with, and by its duration, with which the time passes.
  Eigen::VectorXd by_end(time_row() + 2);
  by_end << g.derivatives.row(0).transpose(), g.derivatives(0, time_row());
  Eigen::RowVectorXd by = backward(part, by_end).transpose();
  const double rate = by(duration_row());
  const Eigen::VectorXd moves =
      forward(part, Eigen::VectorXd::Unit(time_row() + 2, duration_row())).col(0).head(states());
  const double terms = by_end.head(states()).cwiseAbs().dot(moves.cwiseAbs()) + std::abs(g.derivatives(0, time_row()));
  if (piece.touches || std::abs(rate) <= grazing * terms)
    throw EventWithoutDerivative(
        fmt::format("{} only grazes zero, where its time has no derivative: t = {:.6g}", named(piece), time()));
  function_ = g.derivatives.row(0);
  by /= -rate;
  by(duration_row()) = 0;
  moves_ = !by.head(time_row()).isZero(0);
  if (moves_ && piece.duration < shortest * size_) throw EventWithoutDerivative(at_node(named(piece), time()));
  to.push_back(replaced(duration_row(), by));
  to.insert(to.end(), part.begin(), part.end());
  Eigen::RowVectorXd later = Eigen::RowVectorXd::Zero(time_row() + 2);
  later(time_row()) = later(duration_row()) = 1;
  to.push_back(replaced(time_row(), later));
  return true;
}

Eigen::MatrixXd MotionThroughEvents::changed_by(const Piece& piece) const {
  const bool sets =
      std::any_of(piece.events.begin(), piece.events.end(), [&](std::size_t i) { return !events_[i].set.empty(); });
  const Eigen::Index n = motion_->momenta(), rows = sets ? time_row() - n : n;
  Eigen::MatrixXd out = Eigen::MatrixXd::Zero(rows, time_row() + 2);
  out.middleCols(n, rows).setIdentity();
  const NodeValues seen = motion_->observe_in_part();
  const auto there = [&](const auto& f, const std::string& what) {
    const NodeValues by = along(seen, f);
    if (!by.derivatives.allFinite())
      throw EventWithoutDerivative(fmt::format("{} has no derivative at t = {:.6g}", what, time()));
    return by.derivatives;
  };
  for (const std::size_t i : piece.events) {
    const ObservedEvent& event = events_[i];
    if (event.kick)
      out.topLeftCorner(n, time_row() + 1) += there(event.kick, fmt::format("the kick of event \"{}\"", event.name));
    for (const ObservedEvent::Setting& each : event.set) {
      const auto number = [&](const VariedVector& all) -> VariedVector {
        return VariedVector::Constant(1, each.number(all));
      };
      auto row = out.row(number_row(each.name) - n);
      row.setZero();
      row.head(time_row() + 1) = there(number, fmt::format("what event \"{}\" sets ({})", event.name, each.name));
    }
  }
  return out;
}

void MotionThroughEvents::follow_switch(const Piece& piece, const Switching& what, Derivatives& step) {
  constexpr double noticed = 1e-6;
  const CuttableMotion::Switched switched = motion_->switch_to(what, /*linearised=*/true);
  step.insert(step.end(), switched.momentum.begin(), switched.momentum.end());
  // Its own function stays zero, and so does what was held.
  Eigen::MatrixXd zero(time_row() + 1, 1 + switched.held.rows());
  zero.col(0) = function_.transpose();
  if (switched.held.rows() > 0) zero.rightCols(switched.held.rows()) = switched.held.transpose();
  const Eigen::ColPivHouseholderQR<Eigen::MatrixXd> span(zero);
  for (Eigen::Index row = 0; row < switched.holds.rows(); ++row) {
    const Eigen::VectorXd by = switched.holds.row(row).transpose();
    if ((by - zero * span.solve(by)).norm() > noticed * by.norm())
      throw EventWithoutDerivative(fmt::format(
          "what {} switches on would not hold there from another start, or with another number: its function is to be "
          "zero where that holds",
          named(piece)));
  }
}

bool MotionThroughEvents::follow_rest(const std::string& after, bool moves, Derivatives& step) {
  if (moves && rest_ < shortest * size_) throw EventWithoutDerivative(at_node(after, begun_at_ + size_));
  if (rest_ == 0) return true;
  motion_->keep();
  if (!motion_->go(rest_).converged()) return false;
  const Derivatives part = motion_->part();
  if (part.empty()) return false;
  // It ends where the step does: what its start is late it is shorter.
  Eigen::RowVectorXd shorter = Eigen::RowVectorXd::Zero(time_row() + 2);
  shorter(time_row()) = -1;
  step.push_back(replaced(duration_row(), shorter));
  step.insert(step.end(), part.begin(), part.end());
  return true;
}

bool MotionThroughEvents::follow(Derivatives& step, const AtPiece* tell) {
  if (!conflict_.empty()) throw EventWithoutDerivative(conflict_);
  const std::vector<double> end = motion_->save();
  motion_->restore(begun_);
  motion_->keep();
  bool regular = true, moves = false;
  const Piece* last = nullptr;
  for (std::size_t k = 0; k < pieces_.size() && regular; ++k) {
    const Piece& piece = pieces_[k];
    if (tell == nullptr && !piece.changes && !piece.ends && !grazes(piece)) continue;
    Derivatives to = step;
    regular = lead_to(piece, to);
    if (!regular) break;
    if (tell != nullptr) (*tell)(piece, to);
    if (!piece.changes && !piece.ends) continue;
    step = std::move(to);
    last = &piece;
    moves = moves_;
    if (piece.changes) {
      change(piece, &step);
      motion_->keep();
    }
  }
  if (regular && last != nullptr && !is_over_) regular = follow_rest(named(*last), moves, step);
  motion_->restore(end);
  return regular;
}

/// Whether what would change the motion only touches zero there.
bool MotionThroughEvents::grazes(const Piece& piece) const {
  return piece.touches && std::any_of(piece.events.begin(), piece.events.end(),
                                      [&](std::size_t i) { return events_[i].changes_motion(); });
}

bool MotionThroughEvents::linearise() {
  chain_.reset();
  const bool changes =
      std::any_of(pieces_.begin(), pieces_.end(), [&](const Piece& p) { return p.changes || grazes(p); });
  if (is_over_) throw std::invalid_argument("the run is ended by an event: no step follows it");
  if (!changes && conflict_.empty()) return motion_->linearise();
  Derivatives step;
  if (!follow(step, nullptr)) return false;
  chain_ = std::make_shared<DerivativeChain>(2, std::move(step));
  return true;
}

EventSensitivities MotionThroughEvents::run(long steps, const Eigen::MatrixXd& directions, long node, int asked) {
  EventSensitivities out;
  const Eigen::Index own = states(), numbers = asked < 0 ? parameters() : asked;
  const bool linearised = directions.cols() > 0;
  Eigen::MatrixXd x = directions;
  Growth growth(linearised ? Eigen::MatrixXd(directions.topRows(own)) : Eigen::MatrixXd::Zero(own, 1).eval());
  const auto split = [&](const Eigen::MatrixXd& all, auto& by_start, auto& by_parameters) {
    const Eigen::Index of_start = std::max<Eigen::Index>(0, all.cols() - numbers);
    by_start = all.leftCols(of_start);
    by_parameters = all.rightCols(all.cols() - of_start);
  };
  const auto see = [&](const NodeValues& seen, const Eigen::MatrixXd& by, auto& into) {
    into.observed = seen.values;
    split(seen.derivatives * by.topRows(seen.derivatives.cols()), into.observed_by_start, into.observed_by_parameters);
  };
  // Nodes stay at their times.
  const auto see_node = [&] {
    if (linearised) return see(motion_->observe(), x, out);
    out.observed = motion_->seen();
    out.observed_by_start = out.observed_by_parameters = Eigen::MatrixXd(out.observed.size(), 0);
  };
  // With rows of a time and a duration.
  const auto through = [&](const Derivatives& step) {
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(x.rows() + 2, x.cols());
    all.topRows(x.rows()) = x;
    return forward(step, std::move(all));
  };
  const auto fail = [&](SolveStatus status, std::string why) {
    out.status = status;
    out.message = std::move(why);
  };
  const AtPiece happens = [&](const Piece& piece, const Derivatives& to) {
    const Eigen::MatrixXd here = through(to);
    for (const std::size_t i : piece.events) {
      EventSensitivities::Happened& last = out.happened.emplace_back();
      last.event = i;
      last.time = time();
      split(here.row(time_row()), last.by_start, last.by_parameters);
      see(motion_->observe_in_part(), here, last);
    }
  };
  const auto finish = [&](const Eigen::MatrixXd& end) {
    out.growth = linearised ? growth.largest() : 1;
    out.time = time();
    out.is_stopped = is_over_;
    split(end.topRows(own), out.by_start, out.by_parameters);
    if (node >= 0) return;
    if (is_over_) return see(motion_->observe_in_part(), end, out);
    see_node();
  };
  try {
    begin_along(directions);
    if (node == 0) see_node();
    for (long k = 1; k <= steps && !is_over_; ++k) {
      const double begun = time();
      if (const StepReport report = advance(); !report.converged()) {
        fail(report.status, reason_.empty()
                                ? fmt::format("the step at t = {:.6g}, or a part of it, did not converge", begun)
                                : fmt::format("in the step at t = {:.6g}: {}", begun, reason_));
        break;
      }
      Derivatives step;
      bool regular = (pieces_.empty() && conflict_.empty()) || follow(step, &happens);
      if (regular && step.empty() && linearised) regular = motion_->linearise();
      if (!regular) {
        fail(SolveStatus::singular, fmt::format("the step at t = {:.6g} has no derivative", begun));
        break;
      }
      if (is_over_) {
        finish(through(step));
        break;
      }
      out.steps = k;
      if (!step.empty()) {
        x = through(step).topRows(x.rows());
      } else {
        for (int stage = 0; linearised && stage < motion_->stages(); ++stage) x = motion_->stage(stage).forward(x);
      }
      if (linearised) {
        growth.after_a_step(x.topRows(own));
        if (x.cols() - numbers == own && growth.wants_matrix()) growth.see(x.topLeftCorner(own, own));
      }
      if (k == node) see_node();
    }
    if (out.converged() && !is_over_) finish(x);
  } catch (const EventWithoutDerivative& none) {
    fail(SolveStatus::singular, none.what());
  }
  for (std::size_t i = 0; i < events_.size(); ++i) {
    if (begins_[i] == 0) continue;
    EventSensitivities::Begun& each = out.begun.emplace_back();
    each.event = i;
    split(at_start_.row(Eigen::Index(i)), each.by_start, each.by_parameters);
  }
  for (std::size_t i = 0; i < events_.size(); ++i)
    for (const std::string& note : watches_[i].notes(touched_[i]))
      out.notes.push_back(fmt::format("event \"{}\": {}", events_[i].name, note));
  return out;
}

}  // namespace lagroid
