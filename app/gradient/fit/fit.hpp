#pragma once
/// Parameters and starts from measured columns, by least squares with the exact derivatives of runs:
///
///     minimise  sum_i rho(((y_i(x) - d_i) / sigma_i)^2),    x the starts of the runs and the parameters,
///
/// rho(s) = s, or the loss of Huber, which outliers pull less. x stays where scenes allow it. At the solution, with J
/// the derivatives of the n weighted residuals r by the p combinations of unknowns that they tell, the covariance of x
/// is
///
///     c^2 s^2 (J^T J)^{-1},    s^2 = sum psi(r)^2 / (n - p),    c = (1 + p (1 - m) / (n m)) / m,
///
/// psi(r) = r and m = 1, or of Huber's loss r cut off at the bound and m the share that is not. Where n = p it is
/// (J^T J)^{-1} if all columns have a sigma, else nothing is known of it. Directions in which J^T J vanishes to
/// round-off cannot be told from these data and are named, by what of each unknown changes together. An unknown at its
/// bound is held there: it has no deviation, and those of the others are as if it were known.
///
///     const Fit fit = fit_scene(subject, {"run.csv"}, {.unknowns = {"initial", "parameters.length"}});
///     std::cout << text_of(fit);
///
/// Errors: GradientRefused and DataError, one line, for unknowns that are none or that cannot be fitted, for columns
/// that are not observed and times that are not those of nodes. A run that fails is no error: Fit::failure says so.
/// Source: Triggs, McLauchlan, Hartley, Fitzgibbon, Bundle adjustment, 2000, sec. 4 (robust least squares); Huber,
/// Robust Statistics, 1981, sec. 7.6 (their covariance); solved by Ceres' trust region of Levenberg and Marquardt.

#include "../columns/computed_columns.hpp"
#include "../gradient_table.hpp"

#include <array>
#include <cstdint>
#include <map>
#include <string>
#include <vector>

namespace lagroid::app {

struct FitOptions {
  std::vector<std::string> unknowns{"initial", "parameters"};  ///< initial.NAME or parameters.NAME
  std::vector<std::string> columns{};                          ///< of the data; all that are observed where it is empty
  std::vector<NamedText> combinations{};                       ///< functions of unknowns that are to be told, too
  std::map<std::string, double> sigma{};                       ///< of a column, 1 where nothing stands
  std::map<std::string, std::array<double, 2>> bounds{};       ///< of an unknown
  double huber = 0;     ///< residuals beyond so many sigma weigh by their size, not its square; 0: all by its square
  int starts = 1;       ///< guesses: the scene, and others drawn around it
  double spread = 0.3;  ///< of these, relative to the unknown
  std::uint64_t seed = 1;
};

struct Fit {
  struct Unknown {
    std::string name;
    double start = 0;  ///< what the scene has
    double value = 0;
    double deviation = 0;  ///< infinite where the data do not tell, NaN where it is not known or the unknown is held
    bool at_bound = false;
  };
  /// A function of unknowns and parameters.
  struct Combination {
    std::string name;
    double value = 0;
    double deviation = 0;  ///< infinite where the data do not tell, NaN where it is not known
  };
  /// What is left over of a column.
  struct Column {
    std::string name;
    long count = 0;
    double rms = 0;          ///< in the column's own unit
    double largest = 0;      ///< of what was measured
    double correlation = 0;  ///< of each residual with the next
    bool white = true;       ///< whether that is what independent errors have, within three deviations
    /// Whether nothing but rounding is left over, of which nothing can be said.
    bool exact() const { return rms <= 1e-12 * largest; }
  };
  /// One number that was measured, and what the fitted run has there.
  struct Point {
    std::size_t run = 0;
    double time = 0;
    std::size_t column = 0;
    double measured = 0;
    double predicted = 0;
  };

  std::string system;
  std::string status;           ///< converged, not_converged or failed
  std::string failure;          ///< of the scene's own run
  std::string stopped_by = {};  ///< why there was no run where the search went last; empty where there was one
  int iterations = 0;           ///< of all solves from the guess
  std::size_t runs = 0;
  double cost = 0;   ///< half the sum
  double scale = 0;  ///< s: the root mean square of what is left over, in sigmas; NaN where n = p
  std::vector<Unknown> unknowns;
  Eigen::MatrixXd covariance;             ///< of those that the data tell; no numbers where it is not known
  Eigen::Index rank = 0;                  ///< how many combinations of unknowns they tell
  Eigen::VectorXd singular_values;        ///< of derivatives with columns of length one
  Eigen::MatrixXd null_space;             ///< changes of the unknowns that the data do not see, a row each
  std::vector<std::string> undetermined;  ///< these in words
  std::vector<Combination> combinations;
  std::vector<Column> columns;
  std::vector<Point> points;
  std::vector<double> other_costs;    ///< of the other guesses, least first
  std::vector<std::string> ignored;   ///< columns of the data that are none of those that runs are fitted by
  std::vector<std::string> left_out;  ///< columns of the data that were not chosen
  std::vector<std::string> notes;     ///< on numbers that are not fitted, on gaps, and on where the search ended

  bool converged() const { return status == "converged"; }
};

Fit fit_scene(const GradientSubject& scene, const std::vector<std::string>& files, const FitOptions& options);

std::string text_of(const Fit& fit);
std::string json_of(const Fit& fit);
/// run, t, column, measured, predicted, residual.
std::string csv_of(const Fit& fit);

}  // namespace lagroid::app
