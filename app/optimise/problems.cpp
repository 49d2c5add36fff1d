#include "problems.hpp"

#include "matrices.hpp"

#include <lagroid/systems/optimisation/random.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <exception>
#include <string>

namespace lagroid::app {

namespace {

namespace fs = std::filesystem;
using optimisation::Instance;

/// data.`key`: a file, or a table {random = "symmetric" or "gaussian", rows, columns, seed}.
AnyMatrix read_data(const Section& scene, const char* key, const fs::path& folder) {
  constexpr long most = 20000;
  const Section data = scene.section("data", "the matrices of the problem");
  if (data.is_table(key)) {
    const Section table = data.section(key, "a random matrix");
    const bool symmetric = table.choice("random", {"symmetric", "gaussian"}) == "symmetric";
    const auto seed = unsigned(table.integer_or("seed", 1, 0, 4294967295));
    const long size = table.integer("rows", 1, most);
    if (symmetric) return optimisation::random_symmetric(size, seed);
    return optimisation::random_matrix(size, table.integer("columns", 1, most), seed);
  }
  try {
    return read_matrix(data.text(key, "the name of a file, or a table with the key random"), folder);
  } catch (const DataError& error) {
    data.fail(key, error.what());
  }
}

optimisation::SymmetricOperator read_symmetric(const Section& scene, const fs::path& folder) {
  constexpr double rounding = 1e-12;
  const AnyMatrix a = read_data(scene, "A", folder);
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
  const auto weights = scene.section("parameters", "the weights")
                           .list("weights", "one for each eigenvalue, increasing from zero or more");
  return made(scene, "parameters", "weights", [&] {
    return optimisation::brockett_instance(
        a, Eigen::Map<const Eigen::VectorXd>(weights.data(), Eigen::Index(weights.size())));
  });
}

Instance read_procrustes(const Section& scene, const fs::path& folder) {
  const Eigen::MatrixXd a = dense(read_data(scene, "A", folder));
  const Eigen::MatrixXd b = dense(read_data(scene, "B", folder));
  return made(scene, "data", "B", [&] { return optimisation::procrustes_instance(a, b); });
}

const ListedParameter data_a{"data.A", "", "", "a symmetric matrix: a file, or {random = \"symmetric\", rows, seed}"};

}  // namespace

std::span<const ProblemEntry> problems() {
  static const std::vector<ProblemEntry> all{
      {"rayleigh", "-v^T A v on the sphere: the largest eigenvalue", {data_a}, read_rayleigh},
      {"brockett",
       "Trace(X^T A X N) on the Stiefel manifold: the m smallest eigenvalues",
       {data_a, {"parameters.weights", "", "", "the m diagonal entries of N, increasing from zero or more"}},
       read_brockett},
      {"procrustes",
       "|A X - B|^2 on the Stiefel manifold; balanced, on O(n), where B has as many columns as A",
       {{"data.A", "", "", "a file, or {random = \"gaussian\", rows, columns, seed}"},
        {"data.B", "", "", "as many rows as A, no more columns"}},
       read_procrustes}};
  return all;
}

Instance read_problem(const Section& scene, const fs::path& folder) {
  std::vector<std::string> names;
  for (const auto& entry : problems()) names.emplace_back(entry.name);
  const std::string name = scene.choice("problem", names);
  return std::find_if(problems().begin(), problems().end(), [&](const auto& e) { return e.name == name; })
      ->read(scene, folder);
}

}  // namespace lagroid::app
