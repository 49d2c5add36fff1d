#include <lagroid/systems/multibody/sensitivity/linearised_scene.hpp>

#include <lagroid/solvers/sensitivity/varied_parameters.hpp>

#include <fmt/format.h>
#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <utility>

namespace lagroid::multibody {

LinearisedScene::LinearisedScene(Multibody motion, std::vector<std::string> names, std::vector<double> numbers,
                                 Write write, std::optional<Stages> stages)
    : motion_(std::move(motion)),
      names_(std::move(names)),
      numbers_(std::move(numbers)),
      write_(std::move(write)),
      before_(motion_.state()),
      linear_(stages ? stages->shares.size() : 1),
      stages_(std::move(stages)),
      begin_(0, states(), int(names_.size())) {
  if (names_.size() != numbers_.size()) throw std::invalid_argument("a name for each number");
  if (motion_.index() != 0) throw std::invalid_argument("derivatives are of a motion from its start on");
  if (before_.control)
    throw std::invalid_argument("steps are controlled: their derivatives are those of LinearisedControlledScene");
  if (before_.stages.size() != (stages_ ? stages_->shares.size() : 0))
    throw std::invalid_argument("composed steps are linearised stage by stage: give these");
  if (SceneAdjoint::is_of(motion_)) adjoint_.emplace(numbers_, write_);
  left_out_ = variations().sizes().left_out;
  start_ = variations().start(names_, numbers_);
  begin_.end_by_start.leftCols(states()).setIdentity();
  begin_.end_by_start.rightCols(parameters()) = start_;
}

SceneVariations& LinearisedScene::variations() const {
  std::vector<char> acts = motion_.switches().on;
  const std::vector<char>& left_out = motion_.model().rows.left_out;
  acts.insert(acts.end(), left_out.begin(), left_out.end());
  const auto found = variations_.find(acts);
  if (found != variations_.end()) return found->second;
  return variations_.emplace(std::move(acts), SceneVariations(motion_, numbers_, write_)).first->second;
}

const StepDerivative& LinearisedScene::stage(int k) const {
  if (begins_ && k == 0) return begin_;
  return *linear_[std::size_t(begins_ ? k - 1 : k)];
}

StepReport LinearisedScene::advance() {
  before_ = motion_.state();
  const StepReport report = motion_.advance();
  end_ = motion_.state();
  displacements_ = motion_.displacements();
  return report;
}

bool LinearisedScene::linearise() {
  begins_ = before_.index == 0 && parameters() > 0;
  if (stages_) return linearise_stages(before_, motion_.step(), false, linear_);
  return linearise(solved_step(before_, end_, displacements_), false, linear_.front());
}

/// The stages of a composed step are made again, one by one.
bool LinearisedScene::linearise_stages(const SceneState& before, double size, bool by_times,
                                       std::vector<std::optional<SparseStep>>& out) {
  Multibody& motion = stages_->motion;
  SceneState state = before;
  state.stages.clear();
  if (motion.switches().on != motion_.switches().on) {
    motion.restore(state);
    motion.switch_to(motion_.switches().on);
  }
  bool regular = true;
  for (std::size_t k = 0; k < out.size(); ++k) {
    const double share = stages_->shares[k];
    state.guess = before.stages[k];
    for (auto& multipliers : state.guess.multipliers)
      for (double& lambda : multipliers) lambda /= share;
    for (Vec& turn : state.guess.turns) turn /= share;
    motion.restore(state);
    if (!motion.advance_by(share * size).converged()) return false;
    regular = linearise(solved_step(state, motion.state(), motion.displacements()), by_times, out[k]) && regular;
    state = motion.state();
  }
  return regular;
}

bool LinearisedScene::linearise(const SolvedStep& solved, bool by_times, std::optional<SparseStep>& out) {
  SceneVariations& varied = variations();
  if (!varied.linearise(motion_, solved, by_times, out)) return false;
  if (solved.before.index == 0 && parameters() > 0 && !varied.sizes().left_out.empty())
    varied.require_dependence(solved, *out, start_, names_);
  return true;
}

NodeValues LinearisedScene::observe() const {
  NodeValues out = variations().observe(motion_.state(), /*by_time=*/false);
  if (motion_.index() == 0 && parameters() > 0 && out.values.size() > 0)
    out.derivatives.rightCols(parameters()) += out.derivatives.leftCols(states()) * start_;
  return out;
}

void LinearisedScene::serialize(NumberArchive& archive) { motion_.serialize(archive); }

namespace {

/// As it stands, without the detour through a list of numbers.
struct KeptScene final : KeptNode {
  SceneState state;
};

}  // namespace

void LinearisedScene::keep_node(std::unique_ptr<KeptNode>& node) {
  if (!adjoint_) {
    CuttableMotion::keep_node(node);
    return;
  }
  if (!node) node = std::make_unique<KeptScene>();
  static_cast<KeptScene&>(*node).state = motion_.state();
}

void LinearisedScene::return_to(const KeptNode& node) {
  if (adjoint_) {
    motion_.restore(static_cast<const KeptScene&>(node).state);
  } else {
    CuttableMotion::return_to(node);
  }
}

bool LinearisedScene::takes_back() const { return adjoint_.has_value(); }

bool LinearisedScene::take_back(const KeptNode& before, const KeptNode& after, Eigen::MatrixXd& gradients) {
  if (!adjoint_) return false;
  const SceneState& start = static_cast<const KeptScene&>(before).state;
  if (!adjoint_->take_back(motion_, start, static_cast<const KeptScene&>(after).state, gradients)) return false;
  if (start.index == 0 && parameters() > 0) gradients = begin_.backward(gradients);
  return true;
}

namespace {

/// The holonomic rows that depend on no others.
std::vector<int> holonomic_rows(const Multibody& motion) {
  std::vector<int> rows = sizes_of(motion).rows;
  std::erase_if(rows, [&](int row) { return motion.model().role(row) != Role::holonomic; });
  return rows;
}

/// Their gradients at a node, a column for each number of v.
Eigen::MatrixXd gradients_of(const Multibody& motion, const std::vector<int>& rows) {
  const Model& model = motion.model();
  const SceneState& state = motion.state();
  Eigen::MatrixXd all = Eigen::MatrixXd::Zero(motion.rows(), sizes_of(motion).n());
  const auto put = [&](const Model::Entry& e, std::size_t from) {
    all.row(e.row).segment<3>(Eigen::Index(3 * (from + std::size_t(e.factor)))) +=
        state.gradients[std::size_t(e.gradient)];
  };
  for (const Model::Entry& e : model.rows.linear_entries) put(e, 0);
  for (const Model::Entry& e : model.rows.rotation_entries) put(e, state.momentum.size());
  Eigen::MatrixXd out(Eigen::Index(rows.size()), all.cols());
  for (std::size_t k = 0; k < rows.size(); ++k) out.row(Eigen::Index(k)) = all.row(rows[k]);
  return out;
}

Eigen::VectorXd values_of_rows(const Multibody& motion, const std::vector<int>& rows) {
  const SceneState& state = motion.state();
  const std::vector<Vec> at_rest(std::max(state.momentum.size(), state.spin.size()), Vec::Zero());
  std::vector<double> values(std::size_t(motion.rows()));
  for (const Model::Batch& batch : motion.model().rows.batches)
    if (batch.role == Role::holonomic && motion.model().is_on(batch))
      batch.joints->values({state.at, state.at, at_rest, at_rest, state.step}, batch.first, batch.count,
                           values.data() + batch.row);
  Eigen::VectorXd out(Eigen::Index(rows.size()));
  for (std::size_t k = 0; k < rows.size(); ++k) out(Eigen::Index(k)) = values[std::size_t(rows[k])];
  return out;
}

/// W D^T.
Eigen::MatrixXd reactions_of(const Multibody& motion, const Eigen::MatrixXd& gradients) {
  const Model::Factors& factors = motion.model().factors;
  Eigen::MatrixXd out = gradients.transpose();
  Eigen::Index at = 0;
  for (const auto* inertia : {&factors.inertia, &factors.moments})
    for (const Vec& each : *inertia) {
      out.middleRows<3>(at).array().colwise() /= each.array();
      at += 3;
    }
  return out;
}

void move(Multibody& motion, const Eigen::VectorXd& by) {
  SceneState state = motion.state();
  const std::size_t linear = state.momentum.size();
  const Eigen::Index n = by.size() / 2;
  for (std::size_t f = 0; f < linear; ++f) {
    const auto at = Eigen::Index(3 * f);
    state.at.x[f] += by.segment<3>(at);
    state.momentum[f] += by.segment<3>(n + at);
  }
  for (std::size_t r = 0; r < state.spin.size(); ++r) {
    const auto at = Eigen::Index(3 * (linear + r));
    const RotationIncrement turn{Vec::Zero(), motion.model().factors.rotation};
    state.attitude[r] = product(state.attitude[r], turn.quaternion(by.segment<3>(at))).normalized();
    state.spin[r] += by.segment<3>(n + at);
  }
  motion.restore(state);
  motion.go_on_from(motion);  // what follows from places and attitudes
}

}  // namespace

void displace(Multibody& motion, const Eigen::VectorXd& by) {
  constexpr int most = 30;
  const std::vector<int> rows = holonomic_rows(motion);
  const Eigen::MatrixXd along = reactions_of(motion, gradients_of(motion, rows));
  move(motion, by);
  if (!rows.empty()) {
    double before = std::numeric_limits<double>::infinity();
    for (int k = 0;; ++k) {
      Eigen::VectorXd back = Eigen::VectorXd::Zero(by.size());
      const Eigen::MatrixXd matrix = gradients_of(motion, rows) * along;
      back.head(along.rows()) = -along * matrix.partialPivLu().solve(values_of_rows(motion, rows));
      const double size = back.norm();
      if (!std::isfinite(size) || k == most) throw std::domain_error("the joints are not reached from such a start");
      if (size == 0 || (size < 1e-9 && size > 0.5 * before)) break;  // what is left is rounding
      move(motion, back);
      before = size;
    }
  }
  if (motion.rows() > 0) motion.make_tangent();
}

Eigen::MatrixXd LinearisedScene::allowed_directions() const {
  const int n = states() / 2;
  Eigen::MatrixXd out = Eigen::MatrixXd::Identity(states(), states());
  if (motion_.rows() == 0) return out;
  const std::vector<int> rows = holonomic_rows(motion_);
  const Eigen::MatrixXd gradients = gradients_of(motion_, rows), along = reactions_of(motion_, gradients);
  out.topLeftCorner(n, n) -= along * (gradients * along).partialPivLu().solve(gradients);
  out.bottomRows(n) = variations().tangent_momenta(motion_.state()).derivatives.leftCols(states()) * out;
  return out;
}

}  // namespace lagroid::multibody
