#include "problems.hpp"

#include "../reading/kinds.hpp"
#include "matrices.hpp"

#include <lagroid/systems/optimisation/random.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <string>
#include <utility>

namespace lagroid::app {

namespace {

namespace fs = std::filesystem;
using optimisation::Instance;

const std::string symmetric = "symmetric";
const std::string gaussian = "gaussian";
KeyOf<OneOf> random_key(std::vector<std::string> words) {
  return {"random", {std::move(words)}, "", "how it is drawn"};
}
const KeyOf<Whole> drawn_seed_key{"seed", {0, 4294967295}, "", "of what is drawn", 1};
const KeyOf<Whole> rows_key{"rows", {1, 20000}, "", "how many"};
const KeyOf<Whole> columns_key{"columns", {1, 20000}, "", "how many"};

/// A file, or a table that says how a matrix is drawn.
KeyOf<Either> matrix_key(std::string name, std::string meaning) {
  const Table drawn{{drawn_seed_key, rows_key},
                    {Table{{random_key({symmetric})}}, Table{{random_key({gaussian}), columns_key}}}};
  return {std::move(name), {{{Text{}}, {drawn}}}, "", std::move(meaning)};
}
const KeyOf<Either> symmetric_a =
    matrix_key("A", "a symmetric matrix: a file, or {random = \"symmetric\", rows, seed}");
const KeyOf<Either> any_a = matrix_key("A", "a file, or {random = \"gaussian\", rows, columns, seed}");
const KeyOf<Either> any_b = matrix_key("B", "as many rows as A, no more columns");
const KeyOf<NumberList> weights_key{
    "weights", {}, "", "one for each eigenvalue sought, increasing from zero or more: the diagonal entries of N"};

const KeyOf<Either> points_key = matrix_key(
    "points", "the space parts of points, one a line: a file, or {random = \"gaussian\", rows, columns, seed}");
const KeyOf<Text> matrices_key{
    "matrices", {}, "", "a file of symmetric positive definite matrices, one below the other"};

AnyMatrix read_data(const Section& scene, const KeyOf<Either>& key, const fs::path& folder) {
  const Section data = scene.section("data", "the matrices of the problem");
  if (data.is_table(key.name)) {
    const Section table = data.section(key.name, "a random matrix");
    const bool is_symmetric = read_key(table, random_key({symmetric, gaussian})) == symmetric;
    const auto seed = unsigned(read_key(table, drawn_seed_key));
    const long size = read_key(table, rows_key);
    if (is_symmetric) return optimisation::random_symmetric(size, seed);
    return optimisation::random_matrix(size, read_key(table, columns_key), seed);
  }
  try {
    return read_matrix(data.text(key.name, "the name of a file, or a table with the key random"), folder);
  } catch (const DataError& error) {
    data.fail(key.name, error.what());
  }
}

optimisation::SymmetricOperator read_symmetric(const Section& scene, const fs::path& folder) {
  constexpr double rounding = 1e-12;
  const AnyMatrix a = read_data(scene, symmetric_a, folder);
  const Section data = scene.section("data", "the matrices of the problem");
  if (rows(a) != columns(a))
    data.fail("A", fmt::format("a matrix of {} x {}; give a symmetric one", rows(a), columns(a)));
  if (const double off = asymmetry(a); off > rounding)
    data.fail("A", fmt::format("not symmetric, by {:.1e} of its largest entry; give (A + A^T) / 2", off));
  return std::visit([](const auto& matrix) { return optimisation::SymmetricOperator::of(matrix); }, a);
}

/// The instance; what it says of data that do not fit is told of table.key.
template <class Make> Instance made(const Section& scene, const char* table, const char* key, const Make& make) {
  try {
    return make();
  } catch (const std::exception& error) {
    scene.section(table, "").fail(key, error.what());
  }
}

Instance read_rayleigh(const Section& scene, const fs::path& folder) {
  const auto a = read_symmetric(scene, folder);
  if (a.size < 2) scene.section("data", "").fail("A", "a matrix of 1 x 1 has one eigenvalue");
  return made(scene, "data", "A", [&] { return optimisation::rayleigh_instance(a); });
}

Instance read_brockett(const Section& scene, const fs::path& folder) {
  const auto a = read_symmetric(scene, folder);
  const auto weights = read_key(scene.section("parameters", "the weights"), weights_key);
  return made(scene, "parameters", "weights", [&] {
    return optimisation::brockett_instance(
        a, Eigen::Map<const Eigen::VectorXd>(weights.data(), Eigen::Index(weights.size())));
  });
}

Instance read_procrustes(const Section& scene, const fs::path& folder) {
  const Eigen::MatrixXd a = dense(read_data(scene, any_a, folder));
  const Eigen::MatrixXd b = dense(read_data(scene, any_b, folder));
  return made(scene, "data", "B", [&] { return optimisation::procrustes_instance(a, b); });
}

Instance read_hyperbolic_mean(const Section& scene, const fs::path& folder) {
  const Eigen::MatrixXd points = dense(read_data(scene, points_key, folder));
  return made(scene, "data", "points", [&] { return optimisation::hyperbolic_mean_instance(points); });
}

Instance read_positive_definite_mean(const Section& scene, const fs::path& folder) {
  const std::string file = read_key(scene.section("data", "the matrices of the problem"), matrices_key);
  return made(scene, "data", "matrices",
              [&] { return optimisation::positive_definite_mean_instance(dense(read_matrix(file, folder))); });
}

}  // namespace

std::span<const ProblemEntry> problems() {
  static const std::vector<ProblemEntry> all{
      {"rayleigh", "-v^T A v on the sphere: the largest eigenvalue", {symmetric_a}, {}, read_rayleigh},
      {"brockett",
       "Trace(X^T A X N) on the Stiefel manifold: the m smallest eigenvalues",
       {symmetric_a},
       {weights_key},
       read_brockett},
      {"procrustes",
       "|A X - B|^2 on the Stiefel manifold; balanced, on O(n), where B has as many columns as A",
       {any_a, any_b},
       {},
       read_procrustes},
      {"hyperbolic-mean",
       "the Frechet mean in hyperbolic space: the point with the least squared distances to others",
       {points_key},
       {},
       read_hyperbolic_mean},
      {"positive-definite-mean",
       "the Frechet mean of positive definite matrices, the same in every basis",
       {matrices_key},
       {},
       read_positive_definite_mean}};
  return all;
}

Instance read_problem(const Section& scene, const fs::path& folder) {
  KeyOf<OneOf> key{std::string(keys::optimisation)};
  for (const auto& entry : problems()) key.value.words.emplace_back(entry.name);
  const std::string name = read_key(scene, key);
  return std::find_if(problems().begin(), problems().end(), [&](const auto& e) { return e.name == name; })
      ->read(scene, folder);
}

}  // namespace lagroid::app
