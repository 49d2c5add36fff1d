#include "../gradient/system_gradients.hpp"
#include "../reading/kinds.hpp"
#include "formula_scene.hpp"

#include <algorithm>
#include <utility>

namespace lagroid::app {

namespace {

/// A motion whose steps are linearised: states are coordinates and momenta.
class LinearisedFormula final : public LinearisedMotion {
 public:
  LinearisedFormula(std::shared_ptr<const FormulaSystem> system, FormulaMethod method, SizedState start, double step,
                    double begin, std::vector<std::size_t> parameters)
      : system_(std::move(system)),
        method_(std::move(method)),
        state_(std::move(start)),
        before_(state_),
        step_(step),
        begin_(begin),
        parameters_(std::move(parameters)) {}

  int states() const override { return int(2 * state_.position.size()); }
  int parameters() const override { return int(parameters_.size()); }
  double time() const override { return begin_ + double(index_) * step_; }

  StepReport advance() override {
    before_ = state_;
    const StepReport report = method_.step->take(state_, time(), step_);
    if (report.converged()) ++index_;
    return report;
  }
  bool linearise() override {
    std::vector<SizedSlopes> slopes;
    SizedState z = before_;
    stages_.clear();
    if (!method_.step->linearise(z, time() - step_, step_, slopes)) return false;
    for (SizedSlopes& each : slopes) {
      LinearStep stage(int(each.equations_by_unknowns.rows()), states(), parameters());
      stage.equations_by_unknowns = std::move(each.equations_by_unknowns);
      stage.equations_by_start = asked_columns(each.equations_by_start);
      stage.end_by_unknowns = std::move(each.end_by_unknowns);
      stage.end_by_start = asked_columns(each.end_by_start);
      if (!stage.factor()) return false;
      stages_.push_back(std::move(stage));
    }
    return true;
  }
  int stages() const override { return int(stages_.size()); }
  const LinearStep& stage(int k) const override { return stages_[std::size_t(k)]; }

  NodeValues observe() const override {
    const Eigen::Index n = state_.position.size(), all = 2 * n + Eigen::Index(system_->parameters().size());
    const Eigen::Index energy = 3 * n, rows = energy + 1 + Eigen::Index(system_->symmetries().size());
    TangentState tangent;
    method_.step->find_velocity(state_, time(), tangent);
    Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor> by(rows, all);
    by.setZero();
    by.topLeftCorner(2 * n, 2 * n).setIdentity();
    const double* q = state_.position.data();
    const double* p = state_.momentum.data();
    by.middleRows(2 * n, n) = system_->velocity_slope(time(), q, p, tangent.velocity.data());
    system_->energy_slope(time(), q, p, tangent.velocity.data(), by.row(energy).data());
    NodeValues out{Eigen::VectorXd(rows), {}};
    out.values << state_.position, state_.momentum, tangent.velocity,
        Eigen::VectorXd::Constant(rows - energy, tangent.energy);
    if (rows > energy + 1) {
      system_->momentum_slopes(q, p, by.row(energy + 1).data());
      // The derivatives of <p, xi> by p are xi.
      for (Eigen::Index s = energy + 1; s < rows; ++s) out.values(s) = by.row(s).segment(n, n).dot(state_.momentum);
    }
    out.derivatives = asked_columns(by);
    return out;
  }

  void serialize(NumberArchive& archive) override {
    for (Eigen::VectorXd* each : {&state_.position, &state_.momentum, &state_.velocity})
      for (double& x : *each) archive(x);
    archive(index_);
  }

 private:
  /// The columns of the state, then of those parameters that were asked for.
  Eigen::MatrixXd asked_columns(const Eigen::MatrixXd& all) const {
    Eigen::MatrixXd out(all.rows(), states() + parameters());
    out.leftCols(states()) = all.leftCols(states());
    for (std::size_t a = 0; a < parameters_.size(); ++a)
      out.col(states() + Eigen::Index(a)) = all.col(states() + Eigen::Index(parameters_[a]));
    return out;
  }

  std::shared_ptr<const FormulaSystem> system_;
  FormulaMethod method_;
  SizedState state_, before_;
  double step_, begin_;
  long index_ = 0;
  std::vector<std::size_t> parameters_;  ///< their places among the system's
  std::vector<LinearStep> stages_;
};

/// A start by position and velocity, or by position and momentum, of a system whose parameters may differ.
struct FormulaStart {
  std::shared_ptr<const FormulaSystem> original;
  SizedState state;
  double time;
  bool by_velocity;

  std::shared_ptr<FormulaSystem> system(const std::vector<Nudge>& nudges) const {
    const std::shared_ptr<FormulaSystem> out = original->clone();
    for (const auto& [name, value] : original->parameters()) {
      double by = 0;
      for (const Nudge& nudge : nudges) by += nudge.parameter == name ? nudge.by : 0;
      if (by != 0) out->set_parameter(name, value + by);
    }
    return out;
  }
  SizedState nudged(const FormulaSystem& of, const std::vector<Nudge>& nudges) const {
    SizedState out = state;
    const int n = int(out.position.size());
    for (const Nudge& nudge : nudges) {
      if (!nudge.parameter.empty()) continue;
      if (nudge.index < n) {
        out.position(nudge.index) += nudge.by;
      } else {
        (by_velocity ? out.velocity : out.momentum)(nudge.index - n) += nudge.by;
      }
    }
    if (!by_velocity) return out;
    const auto& l = dynamic_cast<const FormulaLagrangian&>(of);
    std::vector<double> numbers(l.lagrangian_numbers());
    l.lagrangian(time, out.position.data(), out.velocity.data(), numbers.data());
    out.momentum = Eigen::Map<const Eigen::VectorXd>(numbers.data() + 1 + n, n);
    return out;
  }
  /// Of (q, p) by (q, v) and all parameters.
  Eigen::MatrixXd slope(const FormulaSystem& of, const SizedState& from) const {
    const Eigen::Index n = from.position.size();
    const Eigen::MatrixXd momentum =
        dynamic_cast<const FormulaLagrangian&>(of).momentum_slope(time, from.position.data(), from.velocity.data());
    Eigen::MatrixXd out = Eigen::MatrixXd::Zero(2 * n, momentum.cols());
    out.topLeftCorner(n, n).setIdentity();
    out.bottomRows(n) = momentum;
    return out;
  }
};

/// Throws std::invalid_argument for a name that is none.
std::vector<std::size_t> places_among(const FormulaSystem& system, const std::vector<std::string>& parameters) {
  std::vector<std::size_t> places;
  const auto& all = system.parameters();
  for (const std::string& name : parameters) {
    const auto found = std::find_if(all.begin(), all.end(), [&](const auto& each) { return each.first == name; });
    if (found == all.end()) throw std::invalid_argument("there is no parameter \"" + name + "\"");
    places.push_back(std::size_t(found - all.begin()));
  }
  return places;
}

}  // namespace

std::optional<GradientSubject> formula_gradient(const Section& scene) {
  if (!scene.has(keys::system) || !is_formula_word(scene.text(keys::system, "the name of a system")))
    return std::nullopt;
  const FormulaScene read = read_formula(scene, {});
  const FormulaToCheck& asked = read.to_check;
  if (!read.extent.events.empty())
    scene.fail("event", "of formulas there are no derivatives through events; leave the events out");
  if (asked.system->constraint_count() > 0)
    scene.fail("system", "there are no derivatives of formulas with constraints: take coordinates without them");
  const FormulaStart start{asked.system, asked.start, asked.begin, scene.section("initial", "").has("velocity")};
  GradientSubject out;
  out.system = asked.name;
  out.steps = read.extent.steps;
  for (const std::string& label : asked.system->coordinates()) out.start.push_back({"position", label});
  out.observed = out.start;
  for (const std::string& label : asked.system->momenta()) out.observed.push_back({"momentum", label});
  for (const std::string& label : asked.system->velocities()) out.observed.push_back({"velocity", label});
  for (std::size_t i = 0; i < asked.system->coordinates().size(); ++i)
    out.start.push_back(start.by_velocity ? GradientName{"velocity", asked.system->velocities()[i]}
                                          : GradientName{"momentum", asked.system->momenta()[i]});
  out.observed.push_back({"energy", "energy"});
  for (const ReadSymmetry& each : asked.system->symmetries()) out.observed.push_back({"momenta", "J " + each.name});
  for (const Eigen::VectorXd* each :
       {&asked.start.position, start.by_velocity ? &asked.start.velocity : &asked.start.momentum})
    out.sizes.insert(out.sizes.end(), each->begin(), each->end());
  for (const auto& [name, value] : asked.system->parameters()) {
    out.parameters.push_back({"parameters", name});
    out.sizes.push_back(value);
  }
  out.begin = [asked, start](const std::vector<std::string>& parameters,
                             const std::vector<Nudge>& nudges) -> std::unique_ptr<LinearisedMotion> {
    const auto system = start.system(nudges);
    return std::make_unique<LinearisedFormula>(system, asked.begun(*system), start.nudged(*system, nudges), asked.step,
                                               asked.begin, places_among(*system, parameters));
  };
  if (start.by_velocity)
    out.begun_by = [start](const std::vector<std::string>& parameters, const std::vector<Nudge>& nudges) {
      const auto system = start.system(nudges);
      const Eigen::MatrixXd all = start.slope(*system, start.nudged(*system, nudges));
      const std::vector<std::size_t> places = places_among(*system, parameters);
      Eigen::MatrixXd chosen = all.leftCols(all.rows() + Eigen::Index(places.size()));
      for (std::size_t a = 0; a < places.size(); ++a)
        chosen.col(all.rows() + Eigen::Index(a)) = all.col(all.rows() + Eigen::Index(places[a]));
      return chosen;
    };
  return out;
}

}  // namespace lagroid::app
