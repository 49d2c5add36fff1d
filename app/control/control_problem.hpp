#pragma once
/// The optimal control problems that a scene can pose, each behind one interface: what they are called, which numbers
/// they take, and how they are solved.
///
///     const ControlProblem& problem = control_problem(scene);
///     const ControlResult found = problem.solve(scene, watch);

#include "../keys/key.hpp"
#include "results/equation_names.hpp"

#include <lagroid/run/ledger/certificate.hpp>
#include <lagroid/run/run_result.hpp>
#include <lagroid/solvers/control/control_search.hpp>
#include <lagroid/solvers/control/latency.hpp>

#include <functional>
#include <map>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace lagroid::app {

/// How a closed loop went.
struct LoopSummary {
  long stages = 0;  ///< that each plan looks ahead
  long samples = 0;
  long not_converged = 0;          ///< in the iterations that a sample is allowed, and followed all the same
  long restarts = 0;               ///< samples that were planned from nothing
  std::map<int, long> iterations;  ///< how often a sample took so many
  Latency latency;

  /// The number of iterations with which so many percent of the samples came out.
  long iterations_of(double percent) const;
};

/// A phase of a solution.
struct PhaseResult {
  std::string name;
  long stages = 0;
  double duration = 0;
  std::vector<double> lower;  ///< bounds of the controls, infinite where there are none
  std::vector<double> upper;
};

/// A solution in the words of its scene: node by node, what a plot and a file show.
struct ControlResult {
  std::string problem;
  std::string groupoid;
  std::vector<std::string> states;
  std::vector<std::string> state_units;
  std::vector<std::string> controls;
  std::vector<std::string> control_units;
  std::string cost_unit = "cost";                    ///< "cost": of several units, or of those that a scene gives
  std::vector<double> times;                         ///< of nodes 0 ... N
  std::vector<std::vector<double>> state_rows;       ///< of nodes
  std::vector<std::vector<double>> control_rows;     ///< of stages 0 ... N-1
  std::vector<std::vector<double>> costate_rows;     ///< of stages: of the equations of each displacement
  std::vector<std::vector<double>> inequality_rows;  ///< of stages: multipliers z
  std::vector<double> lower;                         ///< bounds of the controls, infinite where there are none
  std::vector<double> upper;
  std::vector<PhaseResult> phases = {};  ///< none: the scene has no list of them
  std::vector<EquationName> equations;   ///< of a stage; behind them stand conditions on the node where it ends
  std::vector<std::vector<std::string>> conditions;  ///< what these say, of each stage
  std::vector<std::string> inequalities;             ///< what the rows of gamma say
  std::vector<Shape> shapes;                         ///< what it looks like in space, by columns of states and `seen`
  std::vector<Columns> seen;                         ///< of nodes: what pictures need beside the states
  ControlReport report;
  std::optional<double> end_cost = {};  ///< what of the cost is that of the end, where a scene gives one
  CrossoverReport crossover;
  std::vector<double> costs;              ///< of all distinct solutions, cheapest first
  std::map<ControlStatus, int> outcomes;  ///< of the starts
  int iterations = 0;                     ///< of all starts
  double seconds = 0;                     ///< of processor time
  bool interrupted = false;               ///< by a signal: what is here is the best till then
  bool by_ipopt = false;                  ///< not by the interior point method
  std::optional<LoopSummary> loop = {};   ///< of a scene with [loop]: rows are those of the closed loop
};

class SceneLoop;

class ControlProblem {
 public:
  virtual ~ControlProblem() = default;
  virtual std::string_view name() const = 0;
  virtual std::string_view summary() const = 0;
  virtual std::vector<std::string> states() const = 0;
  virtual std::vector<std::string> controls() const = 0;
  virtual std::vector<Key> parameters() const = 0;
  /// Reads the scene and solves it. `keep_going` is asked in every iteration. Throws SceneError.
  virtual ControlResult solve(const Section& scene, const std::function<bool(int start)>& keep_going) const = 0;
  /// Reads the scene, solves it, and tests the laws of the problem and of its solution. Throws SceneError.
  virtual Certificate certify(const Section& scene, int samples, std::uint64_t seed) const = 0;
  /// A control loop that begins with the solution. Throws SceneError.
  virtual std::unique_ptr<SceneLoop> loop(const Section& scene,
                                          const std::function<bool(int start)>& keep_going) const = 0;
};

/// All of this program.
std::span<const ControlProblem* const> control_problems();
/// The one that the scene names. Throws SceneError.
const ControlProblem& control_problem(const Section& scene);
/// The keys of such scenes.
Table control_table();

}  // namespace lagroid::app
