#include "given_directions.hpp"

#include <algorithm>
#include <memory>
#include <utility>

namespace lagroid::app {

namespace {

std::string number_of(const GivenDirection& direction, Eigen::Index i) {
  return direction.name + "." + std::to_string(i);
}
/// Which of its numbers has this name; -1 for none.
Eigen::Index place_in(const GivenDirection& direction, const std::string& name) {
  for (Eigen::Index i = 0; i < direction.numbers.size(); ++i)
    if (name == number_of(direction, i)) return i;
  return -1;
}

/// The numbers of a scene that differs by nudges, and what they are of the system.
class NudgedNumbers {
 public:
  NudgedNumbers(const std::vector<GivenDirection>& given, const std::vector<Nudge>& nudges) : directions_(given) {
    for (const Nudge& nudge : nudges)
      if (GivenDirection* direction = direction_of(nudge.parameter); direction != nullptr) {
        direction->numbers(place_in(*direction, nudge.parameter)) += nudge.by;
      } else {
        of_system_.push_back(nudge);
      }
    for (std::size_t d = 0; d < given.size(); ++d) {
      const Eigen::VectorXd by = directions_[d].numbers.normalized() - given[d].numbers.normalized();
      for (Eigen::Index i = 0; i < by.size(); ++i)
        if (by(i) != 0) of_system_.push_back({.parameter = number_of(given[d], i), .by = by(i)});
    }
  }
  const std::vector<Nudge>& of_system() const { return of_system_; }

  /// The parameters of the system that depend on these of the scene: of a direction all of its numbers.
  std::vector<std::string> reached(const std::vector<std::string>& parameters) const {
    std::vector<std::string> out;
    const auto add = [&](const std::string& name) {
      if (std::find(out.begin(), out.end(), name) == out.end()) out.push_back(name);
    };
    for (const std::string& name : parameters)
      if (const GivenDirection* direction = direction_of(name); direction != nullptr) {
        for (Eigen::Index i = 0; i < direction->numbers.size(); ++i) add(number_of(*direction, i));
      } else {
        add(name);
      }
    return out;
  }
  /// Their derivatives by those of the scene.
  Eigen::MatrixXd slope(const std::vector<std::string>& parameters) const {
    const std::vector<std::string> all = reached(parameters);
    Eigen::MatrixXd out(all.size(), parameters.size());
    for (std::size_t i = 0; i < all.size(); ++i)
      for (std::size_t j = 0; j < parameters.size(); ++j)
        out(Eigen::Index(i), Eigen::Index(j)) = slope(all[i], parameters[j]);
    return out;
  }

 private:
  double slope(const std::string& of_system, const std::string& of_scene) const {
    const double same = of_system == of_scene ? 1 : 0;
    const GivenDirection* direction = direction_of(of_scene);
    if (direction == nullptr) return same;
    const Eigen::Index i = place_in(*direction, of_system), k = place_in(*direction, of_scene);
    if (i < 0) return 0;
    const Eigen::VectorXd n = direction->numbers.normalized();
    return (same - n(i) * n(k)) / direction->numbers.norm();
  }
  const GivenDirection* direction_of(const std::string& name) const {
    const auto found = std::find_if(directions_.begin(), directions_.end(),
                                    [&](const GivenDirection& each) { return place_in(each, name) >= 0; });
    return found == directions_.end() ? nullptr : &*found;
  }
  GivenDirection* direction_of(const std::string& name) {
    return const_cast<GivenDirection*>(std::as_const(*this).direction_of(name));
  }

  std::vector<GivenDirection> directions_;
  std::vector<Nudge> of_system_;
};

/// Of columns by states and parameters of the system, those by states and numbers of the scene.
Eigen::MatrixXd by_numbers(const Eigen::MatrixXd& columns, const Eigen::MatrixXd& slope) {
  const Eigen::Index states = columns.cols() - slope.rows();
  Eigen::MatrixXd out(columns.rows(), states + slope.cols());
  out << columns.leftCols(states), columns.rightCols(slope.rows()) * slope;
  return out;
}

/// A step by numbers of the scene.
class StepByNumbers final : public StepDerivative {
 public:
  StepByNumbers(const StepDerivative& of_system, const Eigen::MatrixXd& slope) : of_system_(of_system), slope_(slope) {}

  Eigen::MatrixXd forward(const Eigen::MatrixXd& directions) const override {
    const Eigen::Index states = directions.rows() - slope_.cols();
    Eigen::MatrixXd all(states + slope_.rows(), directions.cols());
    all << directions.topRows(states), slope_ * directions.bottomRows(slope_.cols());
    Eigen::MatrixXd out = directions;
    out.topRows(states) = of_system_.forward(all).topRows(states);
    return out;
  }
  Eigen::MatrixXd backward(const Eigen::MatrixXd& gradients) const override {
    const Eigen::Index states = gradients.rows() - slope_.cols();
    Eigen::MatrixXd all = Eigen::MatrixXd::Zero(states + slope_.rows(), gradients.cols());
    all.topRows(states) = gradients.topRows(states);
    const Eigen::MatrixXd before = of_system_.backward(all);
    Eigen::MatrixXd out = gradients;
    out.topRows(states) = before.topRows(states);
    out.bottomRows(slope_.cols()) += slope_.transpose() * before.bottomRows(slope_.rows());
    return out;
  }

 private:
  const StepDerivative& of_system_;
  const Eigen::MatrixXd& slope_;
};

class MotionByNumbers final : public LinearisedMotion {
 public:
  MotionByNumbers(std::unique_ptr<LinearisedMotion> of_system, Eigen::MatrixXd slope)
      : of_system_(std::move(of_system)), slope_(std::move(slope)) {}

  int states() const override { return of_system_->states(); }
  int parameters() const override { return int(slope_.cols()); }
  double time() const override { return of_system_->time(); }
  bool has_equal_steps() const override { return of_system_->has_equal_steps(); }
  StepReport advance() override { return of_system_->advance(); }
  bool linearise() override {
    if (!of_system_->linearise()) return false;
    stages_.clear();
    for (int k = 0; k < of_system_->stages(); ++k) stages_.emplace_back(of_system_->stage(k), slope_);
    return true;
  }
  int stages() const override { return int(stages_.size()); }
  const StepDerivative& stage(int k) const override { return stages_[std::size_t(k)]; }
  NodeValues observe() const override { return by_scene(of_system_->observe()); }
  Eigen::VectorXd seen() const override { return of_system_->seen(); }
  std::optional<NodeValues> observe_later(double time) override {
    const auto seen = of_system_->observe_later(time);
    if (!seen) return std::nullopt;
    return by_scene(*seen);
  }
  StepReport pass() override { return of_system_->pass(); }
  void keep_node(std::unique_ptr<KeptNode>& node) override { of_system_->keep_node(node); }
  void return_to(const KeptNode& node) override { of_system_->return_to(node); }
  void serialize(NumberArchive& archive) override { of_system_->serialize(archive); }

  LinearisedMotion& of_system() { return *of_system_; }
  /// Of directions of (v, mu, numbers of the scene) those of the system.
  Eigen::MatrixXd of_system(const Eigen::MatrixXd& directions) const {
    Eigen::MatrixXd out(states() + slope_.rows(), directions.cols());
    out << directions.topRows(states()), slope_ * directions.bottomRows(slope_.cols());
    return out;
  }

 private:
  NodeValues by_scene(const NodeValues& seen) const { return {seen.values, by_numbers(seen.derivatives, slope_)}; }

  std::unique_ptr<LinearisedMotion> of_system_;
  Eigen::MatrixXd slope_;
  std::vector<StepByNumbers> stages_;
};

/// Also of what is observed where events happen.
EventSensitivities by_numbers(EventSensitivities run, const Eigen::MatrixXd& slope) {
  const auto change = [&](auto& columns) {
    if (columns.cols() == slope.rows()) columns = (columns * slope).eval();
  };
  change(run.by_parameters);
  change(run.observed_by_parameters);
  for (auto& each : run.begun) change(each.by_parameters);
  for (auto& each : run.happened) {
    change(each.by_parameters);
    change(each.observed_by_parameters);
  }
  return run;
}

}  // namespace

GradientSubject in_numbers_of_the_scene(const GradientSubject& subject, const std::vector<GivenDirection>& given) {
  if (given.empty()) return subject;
  GradientSubject out = subject;
  for (std::size_t i = 0; i < subject.parameters.size(); ++i)
    for (const GivenDirection& each : given)
      if (const Eigen::Index k = place_in(each, subject.parameters[i].name); k >= 0)
        out.sizes[subject.start.size() + i] = each.numbers(k);
  using Names = std::vector<std::string>;
  if (subject.begin)
    out.begin = [=, begin = subject.begin](const Names& parameters, const std::vector<Nudge>& nudges) {
      const NudgedNumbers numbers(given, nudges);
      return std::make_unique<MotionByNumbers>(begin(numbers.reached(parameters), numbers.of_system()),
                                               numbers.slope(parameters));
    };
  if (subject.begin_along)
    out.begin_along = [begin_along = subject.begin_along](LinearisedMotion& begun, const Eigen::MatrixXd& directions) {
      auto& by_numbers = dynamic_cast<MotionByNumbers&>(begun);
      begin_along(by_numbers.of_system(), by_numbers.of_system(directions));
    };
  if (subject.refusal)
    out.refusal = [given, refusal = subject.refusal](const std::vector<Nudge>& nudges) {
      return refusal(NudgedNumbers(given, nudges).of_system());
    };
  if (subject.begun_by)
    out.begun_by = [=, begun_by = subject.begun_by](const Names& parameters, const std::vector<Nudge>& nudges) {
      const NudgedNumbers numbers(given, nudges);
      return by_numbers(begun_by(numbers.reached(parameters), numbers.of_system()), numbers.slope(parameters));
    };
  if (subject.through_events)
    out.through_events = [=, through = subject.through_events](
                             const Names& parameters, const std::vector<Nudge>& nudges, long node, ThroughEvents by) {
      const NudgedNumbers numbers(given, nudges);
      return by_numbers(through(numbers.reached(parameters), numbers.of_system(), node, by), numbers.slope(parameters));
    };
  if (subject.cost)
    out.cost = [=, cost = subject.cost](const Names& parameters) {
      const NudgedNumbers numbers(given, {});
      BoundaryCost found = cost(numbers.reached(parameters));
      if (!found.failure.empty()) return found;
      found.by_parameters = (found.by_parameters * numbers.slope(parameters)).eval();
      if (found.again)
        found.again = [given, again = found.again](const std::vector<Nudge>& nudges) {
          return again(NudgedNumbers(given, nudges).of_system());
        };
      return found;
    };
  return out;
}

}  // namespace lagroid::app
