#include "matrices.hpp"

#include <fmt/format.h>
#include <suitesparse/cholmod.h>
#include <boost/tokenizer.hpp>

#include <algorithm>
#include <cctype>
#include <charconv>
#include <cmath>
#include <cstdio>
#include <fstream>
#include <limits>
#include <memory>
#include <sstream>
#include <vector>

namespace lagroid::app {

namespace {

namespace fs = std::filesystem;
using Dense = Eigen::MatrixXd;
using Sparse = Eigen::SparseMatrix<double>;

std::string trimmed(const std::string& text) {
  const auto first = text.find_first_not_of(" \t\r");
  return first == std::string::npos ? "" : text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

Dense read_csv(const fs::path& file) {
  std::ifstream in(file);
  std::vector<double> values;
  std::size_t columns = 0;
  std::size_t rows = 0;
  std::size_t number = 0;
  for (std::string line; std::getline(in, line);) {
    ++number;
    if (trimmed(line).empty() || trimmed(line).front() == '#') continue;
    std::size_t column = 0;
    try {
      for (const std::string& field : boost::tokenizer<boost::escaped_list_separator<char>>(line)) {
        ++column;
        std::string word = trimmed(field);
        if (word.starts_with('+')) word.erase(0, 1);
        double x = 0;
        const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), x);
        if (error != std::errc() || end != word.data() + word.size())
          throw DataError(fmt::format(
              "{}: line {}, column {}: \"{}\" is no number; give numbers alone, with commas between them and "
              "without a header",
              file.string(), number, column, word));
        values.push_back(x);
      }
    } catch (const boost::escaped_list_error& error) {
      throw DataError(fmt::format("{}: line {}: {}", file.string(), number, error.what()));
    }
    if (rows > 0 && column != columns)
      throw DataError(fmt::format("{}: line {} has {} numbers, the lines before {}; make them equal", file.string(),
                                  number, column, columns));
    columns = column;
    ++rows;
  }
  if (in.bad()) throw DataError(fmt::format("{}: cannot be read to its end", file.string()));
  using RowMajor = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::RowMajor>;
  return Eigen::Map<const RowMajor>(values.data(), Eigen::Index(rows), Eigen::Index(columns));
}

/// CHOLMOD's workspace, and what it allocates.
class Cholmod {
 public:
  Cholmod() {
    cholmod_start(&common_);
    common_.print = 0;
    common_.error_handler = nullptr;
  }
  Cholmod(const Cholmod&) = delete;
  Cholmod& operator=(const Cholmod&) = delete;
  ~Cholmod() {
    if (read_ != nullptr && kind_ == CHOLMOD_SPARSE) {
      auto* sparse = static_cast<cholmod_sparse*>(read_);
      cholmod_free_sparse(&sparse, &common_);
    } else if (read_ != nullptr && kind_ == CHOLMOD_DENSE) {
      auto* full = static_cast<cholmod_dense*>(read_);
      cholmod_free_dense(&full, &common_);
    }
    cholmod_finish(&common_);
  }

  /// Symmetric ones with both their halves.
  AnyMatrix read(std::FILE* in, const fs::path& file) {
    constexpr int both_halves = 1;
    read_ = cholmod_read_matrix(in, both_halves, &kind_, &common_);
    if (read_ == nullptr) throw DataError(fmt::format("{}: CHOLMOD cannot read this MatrixMarket file", file.string()));
    const int type = kind_ == CHOLMOD_SPARSE ? static_cast<cholmod_sparse*>(read_)->xtype
                                             : static_cast<cholmod_dense*>(read_)->xtype;
    if (type != CHOLMOD_REAL) throw DataError(fmt::format("{}: complex; give a real matrix", file.string()));
    if (kind_ == CHOLMOD_DENSE) {
      const auto& full = *static_cast<const cholmod_dense*>(read_);
      return Dense(Eigen::Map<const Dense>(static_cast<const double*>(full.x), Eigen::Index(full.nrow),
                                           Eigen::Index(full.ncol)));
    }
    const auto& sparse = *static_cast<const cholmod_sparse*>(read_);
    return Sparse(Eigen::Map<const Sparse>(
        Eigen::Index(sparse.nrow), Eigen::Index(sparse.ncol), static_cast<const int*>(sparse.p)[sparse.ncol],
        static_cast<const int*>(sparse.p), static_cast<const int*>(sparse.i), static_cast<const double*>(sparse.x)));
  }

 private:
  cholmod_common common_{};
  int kind_ = CHOLMOD_SPARSE;
  void* read_ = nullptr;
};

/// What CHOLMOD would take for something else: another kind of matrix, more or fewer entries than announced, indices
/// from zero. Throws DataError.
void require_market(const fs::path& file) {
  std::ifstream in(file);
  std::string line;
  std::size_t number = 1;
  const auto refuse = [&](const std::string& problem) {
    throw DataError(fmt::format("{}: line {}: {}", file.string(), number, problem));
  };
  std::getline(in, line);
  std::transform(line.begin(), line.end(), line.begin(), [](unsigned char c) { return char(std::tolower(c)); });
  if (!line.starts_with("%%matrixmarket matrix")) refuse("a MatrixMarket file begins with \"%%MatrixMarket matrix\"");
  const bool sparse = line.find("coordinate") != std::string::npos;
  const bool whole = line.find("general") != std::string::npos;
  const bool skew = line.find("skew") != std::string::npos;
  // CHOLMOD makes a Laplacian of patterns.
  if (line.find("pattern") != std::string::npos) refuse("a pattern without numbers; give a real matrix");
  if (line.find("complex") != std::string::npos) refuse("complex; give a real matrix");
  long rows = -1;
  long columns = -1;
  long announced = -1;
  long found = 0;
  while (std::getline(in, line)) {
    ++number;
    if (trimmed(line).empty() || trimmed(line).front() == '%') continue;
    std::istringstream words(line);
    if (rows < 0) {
      if (!(words >> rows >> columns) || (sparse && !(words >> announced)) || rows < 1 || columns < 1)
        refuse(sparse ? "expected rows, columns and the number of entries" : "expected rows and columns");
      if (!sparse) announced = whole ? rows * columns : rows * (skew ? rows - 1 : rows + 1) / 2;
      continue;
    }
    if (++found > announced) refuse(fmt::format("more than the {} entries that were announced", announced));
    long i = 1;
    long j = 1;
    double x = 0;
    if ((sparse && !(words >> i >> j)) || !(words >> x)) refuse(fmt::format("\"{}\" is no entry", trimmed(line)));
    if (i < 1 || j < 1 || i > rows || j > columns)
      refuse(fmt::format("entry ({}, {}) of a matrix of {} x {}; indices begin at 1", i, j, rows, columns));
  }
  if (found < announced || rows < 0)
    throw DataError(fmt::format("{}: {} entries where {} were announced", file.string(), found, announced));
}

AnyMatrix read_market(const fs::path& file) {
  require_market(file);
  const std::unique_ptr<std::FILE, int (*)(std::FILE*)> in(std::fopen(file.c_str(), "r"), &std::fclose);
  if (!in) throw DataError(fmt::format("{}: cannot be opened", file.string()));
  return Cholmod().read(in.get(), file);
}

void require_finite(const AnyMatrix& matrix, const std::string& name) {
  const auto refuse = [&](Eigen::Index i, Eigen::Index j, double x) {
    throw DataError(fmt::format("{}: entry ({}, {}) is {}; every entry has to be finite", name, i + 1, j + 1, x));
  };
  if (const auto* full = std::get_if<Dense>(&matrix)) {
    for (Eigen::Index j = 0; j < full->cols(); ++j)
      for (Eigen::Index i = 0; i < full->rows(); ++i)
        if (!std::isfinite((*full)(i, j))) refuse(i, j, (*full)(i, j));
  } else {
    const Sparse& sparse = std::get<Sparse>(matrix);
    for (Eigen::Index j = 0; j < sparse.cols(); ++j)
      for (Sparse::InnerIterator entry(sparse, j); entry; ++entry)
        if (!std::isfinite(entry.value())) refuse(entry.row(), entry.col(), entry.value());
  }
}

}  // namespace

AnyMatrix read_matrix(const std::string& name, const fs::path& folder) {
  const auto colon = name.rfind(":/");
  const std::string file_name = colon == std::string::npos ? name : name.substr(0, colon);
  fs::path file = folder / file_name;
  std::error_code ignored;
  if (!fs::exists(file, ignored) && fs::exists(file_name, ignored)) file = file_name;
  if (!fs::is_regular_file(file, ignored))
    throw DataError(fmt::format("{}: there is no such file; paths are seen from the scene, or from the working folder",
                                file.string()));
  if (!std::ifstream(file)) throw DataError(fmt::format("{}: cannot be read", file.string()));
  const std::string extension = file.extension().string();
  AnyMatrix out;
  if (colon != std::string::npos || extension == ".h5" || extension == ".hdf5") {
    if (colon == std::string::npos)
      throw DataError(fmt::format("{}: say which data set, as in \"{}:/A\"", file.string(), name));
    out = read_hdf5(file, name.substr(colon + 1));
  } else if (extension == ".csv") {
    out = read_csv(file);
  } else if (extension == ".mtx") {
    out = read_market(file);
  } else {
    throw DataError(
        fmt::format("{}: matrices come from .csv, .mtx (MatrixMarket) and .h5 (HDF5) files", file.string()));
  }
  if (rows(out) == 0 || columns(out) == 0) throw DataError(fmt::format("{}: an empty matrix", file.string()));
  require_finite(out, file.string());
  return out;
}

Dense dense(const AnyMatrix& matrix) {
  return std::visit([](const auto& a) { return Dense(a); }, matrix);
}
Eigen::Index rows(const AnyMatrix& matrix) {
  return std::visit([](const auto& a) { return a.rows(); }, matrix);
}
Eigen::Index columns(const AnyMatrix& matrix) {
  return std::visit([](const auto& a) { return a.cols(); }, matrix);
}

double asymmetry(const AnyMatrix& matrix) {
  if (rows(matrix) != columns(matrix)) return std::numeric_limits<double>::infinity();
  const auto largest = [](const auto& a) {
    if constexpr (std::is_same_v<std::decay_t<decltype(a)>, Sparse>) {
      return a.nonZeros() > 0 ? Eigen::Map<const Eigen::VectorXd>(a.valuePtr(), a.nonZeros()).cwiseAbs().maxCoeff()
                              : 0.0;
    } else {
      return a.cwiseAbs().maxCoeff();
    }
  };
  return std::visit(
      [&](const auto& a) {
        using A = std::decay_t<decltype(a)>;
        const double size = largest(a);
        return size > 0 ? largest(A(a - A(a.transpose()))) / size : 0.0;
      },
      matrix);
}

}  // namespace lagroid::app
