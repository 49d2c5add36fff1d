#include <lagroid/systems/multibody/sensitivity/scene_derivatives.hpp>

#include <lagroid/solvers/sensitivity/sparse/colouring.hpp>

#include <algorithm>
#include <cmath>
#include <numeric>
#include <random>
#include <utility>

namespace lagroid::multibody {

namespace {

/// A step near another, off its equations, in which nothing vanishes by chance.
class GenericStep {
 public:
  explicit GenericStep(const SolvedStep& near)
      : before_(near.before),
        displacements_(near.displacements),
        turns_(near.turns),
        multipliers_(near.multipliers),
        end_(near.end),
        h_(near.h) {
    before_.at.time += 0.7 * h_;
    end_ += 0.7 * h_;
    double size = 0;
    for (const Vec& x : before_.at.x) size = std::max(size, x.lpNorm<Eigen::Infinity>());
    const double part = 1e-2 * (size > 0 ? size : 1);
    for (std::size_t f = 0; f < displacements_.size(); ++f) {
      before_.at.x[f] += part * draw();
      displacements_[f] += part * draw();
      before_.momentum[f] += draw();
    }
    for (std::size_t r = 0; r < turns_.size(); ++r) {
      before_.attitude[r] = product(before_.attitude[r], Quaternion(1, 0.01, -0.02, 0.03)).normalized();
      before_.at.attitude[r] = SO3::from_quaternion(before_.attitude[r]);
      turns_[r] += 0.1 * draw();
      before_.spin[r] += draw();
    }
    for (double& lambda : multipliers_) lambda += draw()(0);
  }
  SolvedStep step() const { return {before_, displacements_, turns_, multipliers_, end_, h_}; }

 private:
  Vec draw() {
    std::uniform_real_distribution<double> size(0.5, 1);
    return {size(random_), -size(random_), size(random_)};
  }

  std::mt19937 random_;
  SceneState before_;
  std::vector<Vec> displacements_, turns_;
  std::vector<double> multipliers_;
  double end_, h_;
};

/// Calls visit(row, number) for each equation and each number of the end.
template <class Visit> void each_row(const VariedScene& scene, const Visit& visit) {
  const VariedNumbers &equations = scene.equations(), &end = scene.end();
  for (Eigen::Index i = 0; i < equations.size(); ++i) visit(int(i), equations(i));
  for (Eigen::Index i = 0; i < end.size(); ++i) visit(int(equations.size() + i), end(i));
}

}  // namespace

SceneDerivatives::SceneDerivatives(SceneSizes sizes, std::vector<double> numbers, WriteScene write, double step)
    : sizes_(std::move(sizes)),
      numbers_(std::move(numbers)),
      write_(std::move(write)),
      columns_(std::size_t(time_column()) + (step > 0 ? 2 : 0)),
      expected_(std::size_t(rows())) {
  std::mt19937 random;
  std::uniform_real_distribution<double> amount(0.5, 1.5);
  for (int k = 0; k < columns(); ++k) {
    const double number = k < rows() ? 1 : k < time_column() ? std::abs(numbers_[std::size_t(k - rows())]) : step;
    amounts_.push_back(amount(random) * (number > 0 ? number : 1));
  }
}

void SceneDerivatives::find(const VariedMotion& of, const SolvedStep& solved, std::optional<SparseStep>& out) {
  if (!pattern_) {
    see(of, GenericStep(solved).step());
    arrange(of.motion);
  }
  const auto evaluated = [&] {
    if (!out || out->pattern() != pattern_) out.emplace(pattern_);
    return evaluate(of, solved, *out);
  };
  if (evaluated()) return;
  see(of, solved);
  arrange(of.motion);
  evaluated();
}

void SceneDerivatives::see(const VariedMotion& of, const SolvedStep& solved) {
  const auto look = [&](const VariedScene& scene, int first, int last) {
    each_row(scene, [&](int row, const VariedNumber& value) {
      for (int k = first; k < std::min(last, first + varied_at_once); ++k)
        if (value.tangent(k - first) != 0) columns_[std::size_t(k)].push_back(row);
    });
  };
  const auto look_along = [&](int first, int last) {
    VariedScene& scene = of.scenes.front();
    scene.step(solved, sizes_, tangents([&](int column) {
                 const int k = column - first;
                 return 0 <= k && k < varied_at_once ? VariedTangent::unit(k) : VariedTangent{};
               }));
    look(scene, first, last);
  };
  for (int first = 0; first < rows(); first += varied_at_once) look_along(first, rows());
  for (int first = rows(); first < time_column(); first += varied_at_once) {
    VariedScene& scene = of.scenes[std::size_t(1 + (first - rows()) / varied_at_once)];
    scene.step(solved, sizes_, rows());
    look(scene, first, time_column());
  }
  if (time_column() < columns()) look_along(time_column(), columns());
  for (std::vector<int>& column : columns_) {
    std::sort(column.begin(), column.end());
    column.erase(std::unique(column.begin(), column.end()), column.end());
  }
}

template <class TangentOf> std::vector<VariedTangent> SceneDerivatives::tangents(const TangentOf& of) const {
  std::vector<VariedTangent> out;
  for (int k = 0; k < rows(); ++k) out.push_back(of(k));
  for (int k = 0; k < 3 * sizes_.linear; ++k) {
    VariedTangent& displacement = out[std::size_t(k)];
    displacement = displacement - out[std::size_t(sizes_.unknowns() + k)];
  }
  for (int k = time_column(); k < columns(); ++k) out.push_back(of(k));
  return out;
}

void SceneDerivatives::arrange(const Multibody& motion) {
  auto pattern = std::make_shared<StepPattern>();
  pattern->equations = sizes_.unknowns();
  pattern->leading = sizes_.n();
  pattern->states = sizes_.states();
  for (const std::vector<int>& column : columns_) {
    pattern->rows.insert(pattern->rows.end(), column.begin(), column.end());
    pattern->begins.push_back(int(pattern->rows.size()));
  }
  // Columns of numbers first, and of times, so that few scenes are varied by them.
  std::vector<int> order(columns_.size());
  std::iota(order.begin(), order.end(), 0);
  std::rotate(order.begin(), order.begin() + rows(), order.end());
  const std::vector<int> directions = coloured(columns_, order, rows());
  const int of_everything = directions.empty() ? 0 : 1 + *std::max_element(directions.begin(), directions.end());

  passes_.clear();
  for (int first = 0; first <= of_everything; first += varied_at_once) {
    Pass& pass = passes_.emplace_back();
    everything_ = of_everything - first;
    const auto tangent_of = [&](int column) {
      VariedTangent out{};
      if (const int k = directions[std::size_t(column)] - first; 0 <= k && k < varied_at_once)
        out = VariedTangent::unit(k);
      if (everything_ < varied_at_once) out = out + amounts_[std::size_t(column)] * VariedTangent::unit(everything_);
      return out;
    };
    pass.tangents = tangents(tangent_of);
    for (int column = 0; column < columns(); ++column) {
      const int direction = directions[std::size_t(column)] - first;
      if (direction < 0 || direction >= varied_at_once) continue;
      for (int k = pattern->begins[std::size_t(column)]; k < pattern->begins[std::size_t(column) + 1]; ++k) {
        const int row = pattern->rows[std::size_t(k)];
        const bool of_end = row >= sizes_.unknowns();
        (of_end ? pass.of_end : pass.of_equations)
            .push_back({of_end ? row - sizes_.unknowns() : row, direction, k, amounts_[std::size_t(column)]});
      }
    }
    std::vector<VariedNumber> numbers;
    bool varies = false;
    for (std::size_t k = 0; k < numbers_.size(); ++k) {
      const VariedNumber& x = numbers.emplace_back(numbers_[k], tangent_of(rows() + int(k)));
      varies = varies || !stays_zero(x - numbers_[k]);
    }
    if (varies) pass.scene.emplace(write_(numbers), motion);
  }
  pattern_ = std::move(pattern);
}

bool SceneDerivatives::evaluate(const VariedMotion& of, const SolvedStep& solved, SparseStep& out) {
  std::fill(expected_.begin(), expected_.end(), 0.0);
  const VariedScene* last = nullptr;
  for (Pass& pass : passes_) {
    VariedScene& scene = pass.scene ? *pass.scene : of.scenes.front();
    scene.step(solved, sizes_, pass.tangents);
    const auto take = [&](const std::vector<Entry>& entries, const VariedNumbers& from, int first) {
      for (const Entry& e : entries) {
        const double value = from(e.row).tangent(e.direction);
        out.values[std::size_t(e.value)] = value;
        expected_[std::size_t(first + e.row)] += e.amount * value;
      }
    };
    take(pass.of_equations, scene.equations(), 0);
    take(pass.of_end, scene.end(), sizes_.unknowns());
    last = &scene;
  }
  return agrees(*last, out);
}

bool SceneDerivatives::agrees(const VariedScene& last, const SparseStep& found) const {
  constexpr double rounding = 1e-12, noticed = 1e-9;
  const auto off = [&](int row, const VariedNumber& value) {
    return std::abs(value.tangent(everything_) - expected_[std::size_t(row)]);
  };
  bool is_exact = true;
  each_row(last, [&](int row, const VariedNumber& value) {
    is_exact = is_exact && off(row, value) <= rounding * std::abs(expected_[std::size_t(row)]);
  });
  if (is_exact) return true;
  // Sums may be smaller than their terms.
  std::vector<double> terms(std::size_t(rows()), 0.0);
  const StepPattern& pattern = *found.pattern();
  for (int j = 0; j < columns(); ++j)
    for (int k = pattern.begins[std::size_t(j)]; k < pattern.begins[std::size_t(j) + 1]; ++k)
      terms[std::size_t(pattern.rows[std::size_t(k)])] +=
          std::abs(amounts_[std::size_t(j)] * found.values[std::size_t(k)]);
  bool agree = true;
  each_row(last, [&](int row, const VariedNumber& value) {
    agree = agree && off(row, value) <= noticed * terms[std::size_t(row)];
  });
  return agree;
}

}  // namespace lagroid::multibody
