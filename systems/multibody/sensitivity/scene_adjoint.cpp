#include <lagroid/systems/multibody/sensitivity/scene_adjoint.hpp>

#include <lagroid/solvers/sensitivity/sparse/colouring.hpp>
#include <lagroid/systems/multibody/sensitivity/scene_variations.hpp>
#include <lagroid/systems/multibody/solver/assembly.hpp>

#include <algorithm>
#include <numeric>
#include <random>
#include <utility>

namespace lagroid::multibody {

namespace {

/// In the first evaluation, the direction that varies everything; the first is that of a covector.
constexpr int everything = varied_at_once - 1;

/// An evaluation and a direction of it.
struct Direction {
  int evaluation;
  int number;
};
Direction direction_of(int colour) {
  constexpr int beside = everything - 1;
  if (colour < beside) return {0, 1 + colour};
  return {1 + (colour - beside) / varied_at_once, (colour - beside) % varied_at_once};
}

/// The coordinates of all factors, one after another.
template <class X> X* coordinates_of(std::vector<Vector<X, 3>>& all) { return all.empty() ? nullptr : all[0].data(); }
template <class X> const X* coordinates_of(const std::vector<Vector<X, 3>>& all) {
  return all.empty() ? nullptr : all[0].data();
}

Vec tangents_of(const VariedVec& x, int direction) {
  return {x(0).tangent(direction), x(1).tangent(direction), x(2).tangent(direction)};
}

}  // namespace

SceneAdjoint::SceneAdjoint(std::vector<double> numbers, WriteScene write)
    : numbers_(std::move(numbers)), write_(std::move(write)), columns_(numbers_.size()) {}

bool SceneAdjoint::is_of(const Multibody& motion) {
  const Model& model = motion.model();
  const SceneState& state = motion.state();
  return model.factors.moments.empty() && model.factors.dragged.empty() && model.switches.names.size() == 1 &&
         state.stages.empty() && !state.control && motion.dependent_rows() == 0 &&
         std::all_of(model.rows.roles.begin(), model.rows.roles.end(),
                     [](Role role) { return role == Role::holonomic; });
}

bool SceneAdjoint::Balance::holds() const {
  constexpr double noticed = 1e-12;
  return std::abs(sum) <= noticed * size;
}

bool SceneAdjoint::take_back(const Multibody& motion, const SceneState& before, const SceneState& after,
                             Eigen::MatrixXd& gradients) {
  constexpr Eigen::Index most_functions = 8;
  if (!has_answers_ || gradients.cols() > most_functions) return false;
  const Step step{motion, before, after};
  if (evaluations_.empty()) {
    begin(motion);
    see(step);
    arrange(motion.step());
  }
  if (!factorise(step)) return false;
  if (!take_all_back(step, gradients)) {
    const bool is_new = see(step);
    if (is_new) arrange(motion.step());
    if (!is_new || !take_all_back(step, gradients)) return has_answers_ = false;
  }
  gradients.swap(taken_);
  return true;
}

void SceneAdjoint::begin(const Multibody& motion) {
  const Model& model = motion.model();
  const std::size_t factors = model.factors.inertia.size();
  std::mt19937 random;
  std::uniform_real_distribution<double> amount(0.5, 1.5);
  for (std::size_t f = 0; f < factors; ++f) {
    const double a = amount(random), b = amount(random), c = amount(random);
    place_amounts_.emplace_back(a, b, c);
    mobility_.push_back(motion.step() * model.factors.inertia[f].cwiseInverse());
  }
  for (const double number : numbers_) amounts_.push_back(amount(random) * (number != 0 ? std::abs(number) : 1));
  momentum_ = left_ = moved_ = along_ = velocity_ = back_ = place_amounts_;
  responses_.resize(model.rows.linear_entries.size());
  multipliers_.resize(model.rows.roles.size());
  rows_.resize(multipliers_.size());
  const std::vector<VariedNumber> constant = varied_from(numbers_, int(numbers_.size()));
  matrices_ = assemble(write_(constant).scene, motion.step()).matrices;
}

bool SceneAdjoint::see(const Step& step) {
  const auto count = int(numbers_.size()), coordinates = int(3 * momentum_.size());
  const std::vector<std::vector<int>> known = columns_;
  inertia_.clear();
  for (int first = 0; first < count; first += varied_at_once) {
    VariedNode node(write_(varied_from(numbers_, first)).scene, step.motion.step());
    const auto each = [&](const VariedNumber& x, const auto& visit) {
      for (int k = first; k < std::min(count, first + varied_at_once); ++k)
        if (const double change = x.tangent(k - first); change != 0) visit(k, change);
    };
    const auto each_coordinate = [&](const std::vector<VariedVec>& all, const auto& visit) {
      for (int i = 0; i < coordinates; ++i)
        each(all[std::size_t(i / 3)](i % 3), [&](int number, double change) { visit(number, i, change); });
    };
    const auto look = [&](const std::vector<VariedVec>& impulses) {
      each_coordinate(impulses, [&](int number, int i, double) { columns_[std::size_t(number)].push_back(i); });
    };
    each_coordinate(node.inertia(), [&](int number, int i, double change) { inertia_.push_back({number, i, change}); });
    node.place(step.after);
    look(node.push());
    const std::vector<VariedNumber>& values = node.values();
    for (std::size_t row = 0; row < values.size(); ++row)
      each(values[row], [&](int number, double) { columns_[std::size_t(number)].push_back(coordinates + int(row)); });
    node.place(step.before);
    node.push();
    look(node.react(step.after.guess.multipliers[0]));
  }
  for (std::vector<int>& column : columns_) {
    std::sort(column.begin(), column.end());
    column.erase(std::unique(column.begin(), column.end()), column.end());
  }
  return columns_ != known;
}

void SceneAdjoint::arrange(double h) {
  const auto count = int(numbers_.size()), coordinates = int(3 * momentum_.size());
  std::vector<int> order(columns_.size());
  std::iota(order.begin(), order.end(), 0);
  const std::vector<int> colours = coloured(columns_, order, coordinates + int(rows_.size()));
  const int most = colours.empty() ? 0 : *std::max_element(colours.begin(), colours.end());
  evaluations_.clear();
  pushed_.at.clear();
  for (int which = 0; which <= direction_of(most).evaluation; ++which) {
    std::vector<VariedNumber> numbers;
    std::vector<Entry> of_impulses, of_rows;
    for (int k = 0; k < count; ++k) {
      const auto i = std::size_t(k);
      const Direction direction = direction_of(colours[i]);
      VariedTangent tangent{};
      if (which == 0) tangent = amounts_[i] * VariedTangent::unit(everything);
      if (direction.evaluation == which) {
        tangent = tangent + VariedTangent::unit(direction.number);
        for (const int at : columns_[i])
          (at < coordinates ? of_impulses : of_rows)
              .push_back({k, at < coordinates ? at : at - coordinates, direction.number});
      }
      numbers.emplace_back(numbers_[i], tangent);
    }
    evaluations_.push_back({VariedNode(write_(numbers).scene, h), std::move(of_impulses), std::move(of_rows)});
  }
}

bool SceneAdjoint::factorise(const Step& step) {
  const Model& model = step.motion.model();
  const std::vector<Model::Entry>& entries = model.rows.linear_entries;
  for (std::size_t i = 0; i < entries.size(); ++i)
    responses_[i] =
        mobility_[std::size_t(entries[i].factor)].cwiseProduct(step.before.gradients[std::size_t(entries[i].gradient)]);
  bool regular = true;
  for (std::size_t i = 0; i < matrices_.size(); ++i) {
    Elimination& matrix = matrices_[i];
    matrix.clear();
    for (const Model::Product& p : model.islands[i].linear_products.of(model.rows.linear_products))
      matrix.value(p.value) += step.after.gradients[std::size_t(p.gradient)].dot(responses_[std::size_t(p.entry)]);
    const Model::Range& rows = model.islands[i].rows;
    for (int row = 0; row < rows.size(); ++row)  // those that move nothing
      if (model.rows.left_out[std::size_t(rows.first + row)]) matrix.value(matrix.index(row, row)) = 1;
    regular = matrix.factorise() && regular;
  }
  return regular;
}

bool SceneAdjoint::take_all_back(const Step& step, const Eigen::MatrixXd& gradients) {
  taken_ = gradients;
  bool all = true;
  for (Eigen::Index k = 0; k < taken_.cols() && all; ++k) all = take_back(step, taken_.col(k));
  return all;
}

bool SceneAdjoint::take_back(const Step& step, Column gradient) {
  const Model& model = step.motion.model();
  const std::size_t factors = momentum_.size();
  const double per_step = 1 / step.motion.step();
  const auto entries_of = [&rows = model.rows](std::size_t f) {
    return Model::Range{rows.factor_entries[f], rows.factor_entries[f + 1]}.of(rows.linear_entries);
  };
  const auto place = [&](std::size_t f) { return gradient.segment<3>(Eigen::Index(3 * f)); };
  const auto momentum = [&](std::size_t f) { return gradient.segment<3>(Eigen::Index(3 * (factors + f))); };
  Column by_numbers = gradient.tail(Eigen::Index(numbers_.size()));

  for (std::size_t f = 0; f < factors; ++f) momentum_[f] = momentum(f);
  Balance pushed, reacted;
  if (!pushed_.stands(step.after, momentum_)) push_back(step.after, momentum_, &pushed);
  if (!pushed.holds()) return false;
  left_ = pushed_.back;
  by_numbers += pushed_.by_numbers;
  std::fill(multipliers_.begin(), multipliers_.end(), 0.0);
  for (std::size_t f = 0; f < factors; ++f) {
    left_[f] += place(f);
    const Vec along = momentum_[f] + mobility_[f].cwiseProduct(left_[f]);
    for (const Model::Entry& e : entries_of(f))
      multipliers_[std::size_t(e.row)] += step.before.gradients[std::size_t(e.gradient)].dot(along);
  }
  for (std::size_t i = 0; i < matrices_.size(); ++i)
    matrices_[i].solve_transposed(multipliers_.data() + model.islands[i].rows.first, 1);
  if (!take_rows(step, by_numbers)) return false;
  for (std::size_t f = 0; f < factors; ++f) {
    Vec left = left_[f];
    for (const Model::Entry& e : entries_of(f))
      left -= multipliers_[std::size_t(e.row)] * step.after.gradients[std::size_t(e.gradient)];
    left_[f] = left;
    moved_[f] = mobility_[f].cwiseProduct(left);
    along_[f] = momentum_[f] + moved_[f];
    // The velocity, from what sums of displacements left over.
    velocity_[f] = per_step * ((step.after.at.x[f] - step.before.at.x[f]) +
                               (step.after.place_compensation[f] - step.before.place_compensation[f]));
  }
  const double *const moved = coordinates_of(moved_), *const velocity = coordinates_of(velocity_);
  for (const InertiaEntry& e : inertia_) by_numbers(e.number) -= e.change * velocity[e.at] * moved[e.at];
  push_back(step.before, along_, nullptr);
  react_back(step.after.guess.multipliers[0], along_, back_, by_numbers, reacted);
  if (!reacted.holds()) return false;
  for (std::size_t f = 0; f < factors; ++f) {
    place(f) = left_[f] + back_[f];
    momentum(f) = along_[f];
  }
  return true;
}

void SceneAdjoint::give_back(const Evaluation& each, const std::vector<VariedVec>& given, const std::vector<Vec>& s,
                             std::vector<Vec>& back, Column by_numbers, Balance* balance) const {
  if (&each == &evaluations_.front())
    for (std::size_t f = 0; f < s.size(); ++f) {
      back[f] = tangents_of(given[f], 0);
      if (balance == nullptr) continue;
      balance->add(s[f], tangents_of(given[f], everything));
      balance->take(place_amounts_[f], back[f]);
    }
  const double* const along = coordinates_of(s);
  const VariedNumber* const changes = coordinates_of(given);
  for (const Entry& e : each.of_impulses) {
    const double change = along[e.at] * changes[e.at].tangent(e.direction);
    by_numbers(e.number) += change;
    if (balance != nullptr) balance->take(amounts_[std::size_t(e.number)] * change);
  }
}

void SceneAdjoint::push_back(const SceneState& node, const std::vector<Vec>& s, Balance* balance) {
  pushed_.time = node.at.time;
  pushed_.at = node.at.x;
  pushed_.along = s;
  pushed_.back.resize(s.size());
  pushed_.by_numbers.setZero(Eigen::Index(numbers_.size()));
  for (Evaluation& each : evaluations_) {
    if (&each == &evaluations_.front()) {
      each.node.place(node, s, place_amounts_);
    } else {
      each.node.place(node);
    }
    give_back(each, each.node.push(), s, pushed_.back, pushed_.by_numbers, balance);
  }
}

void SceneAdjoint::react_back(const std::vector<double>& multipliers, const std::vector<Vec>& s, std::vector<Vec>& back,
                              Column by_numbers, Balance& balance) {
  for (Evaluation& each : evaluations_) give_back(each, each.node.react(multipliers), s, back, by_numbers, &balance);
}

bool SceneAdjoint::take_rows(const Step& step, Column by_numbers) {
  std::fill(rows_.begin(), rows_.end(), Balance{});
  for (const Model::Entry& e : step.motion.model().rows.linear_entries)
    rows_[std::size_t(e.row)].take(place_amounts_[std::size_t(e.factor)],
                                   step.after.gradients[std::size_t(e.gradient)]);
  for (Evaluation& each : evaluations_) {
    const std::vector<VariedNumber>& values = each.node.values();
    if (&each == &evaluations_.front())
      for (std::size_t row = 0; row < rows_.size(); ++row) rows_[row].add(values[row].tangent(everything));
    for (const Entry& e : each.of_rows) {
      const auto row = std::size_t(e.at);
      const double change = values[row].tangent(e.direction);
      by_numbers(e.number) -= multipliers_[row] * change;
      rows_[row].take(amounts_[std::size_t(e.number)] * change);
    }
  }
  return std::all_of(rows_.begin(), rows_.end(), [](const Balance& each) { return each.holds(); });
}

}  // namespace lagroid::multibody
