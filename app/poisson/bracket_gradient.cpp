#include "bracket_gradient.hpp"
#include "poisson_node.hpp"
#include "poisson_run.hpp"

#include <lagroid/solvers/poisson/poisson_methods.hpp>
#include <lagroid/solvers/sensitivity/linearised_poisson_motion.hpp>

#include <algorithm>
#include <utility>

namespace lagroid::app {

namespace {

/// The state, and below it energy and Casimirs.
NodeValues observed(const AnyPoissonSystem& system, const std::vector<double>& x,
                    const std::vector<std::string>& parameters) {
  const NodeValues measured = system.differentiate(x, parameters);
  const Eigen::Index n = Eigen::Index(x.size()), rows = measured.values.size(), columns = measured.derivatives.cols();
  NodeValues out{Eigen::VectorXd(n + rows), Eigen::MatrixXd(n + rows, columns)};
  out.values << Eigen::Map<const Eigen::VectorXd>(x.data(), n), measured.values;
  out.derivatives << Eigen::MatrixXd::Identity(n, columns), measured.derivatives;
  return out;
}

/// The system and its start, which differ so from those that were read.
struct NudgedPoisson {
  std::shared_ptr<const AnyPoissonSystem> system;
  std::vector<double> start;
};
NudgedPoisson nudged(const PoissonToCheck& asked, const std::vector<Nudge>& nudges) {
  NudgedPoisson out{asked.system, asked.start};
  for (const Nudge& nudge : nudges) {
    if (nudge.parameter.empty()) {
      out.start[std::size_t(nudge.index)] += nudge.by;
    } else {
      out.system = out.system->changed(nudge.parameter, nudge.by);
    }
  }
  return out;
}

}  // namespace

GradientSubject bracket_gradient(const PoissonEntry& entry, const Section& scene) {
  const PoissonScene read = read_poisson(entry, scene, {});
  if (!read.extent.events.empty())
    scene.fail("event", "of Poisson systems there are no derivatives through events; leave the events out");
  GradientSubject out;
  out.system = entry.name;
  out.steps = read.extent.steps;
  if (read.to_check.options.method == poisson_methods::extrapolation.name) {
    out.notes.emplace_back("derivatives hold the inner steps that the tolerance asked for between nodes");
    out.tolerance = read.to_check.options.tolerance;
  }
  for (const std::string& label : entry.labels) out.start.push_back({"state", label});
  out.observed = out.start;
  out.observed.push_back({"energy", "energy"});
  for (std::size_t i = 0; i < entry.casimirs.size(); ++i) out.observed.push_back({"Casimirs", casimir_column(i)});
  out.sizes = read.to_check.start;
  for (const NamedNumber& number : read.to_check.system->numbers()) {
    out.parameters.push_back({"parameters", number.name});
    out.sizes.push_back(number.value);
  }
  out.begin = [asked = read.to_check](const std::vector<std::string>& parameters,
                                      const std::vector<Nudge>& nudges) -> std::unique_ptr<LinearisedMotion> {
    const auto [system, start] = nudged(asked, nudges);
    return std::make_unique<LinearisedPoissonMotion>(
        system->begin(start, asked.options), parameters,
        [system = system, parameters](const std::vector<double>& x) { return observed(*system, x, parameters); });
  };
  out.refusal = [asked = read.to_check](const std::vector<Nudge>& nudges) {
    const auto [system, start] = nudged(asked, nudges);
    const std::string why = system->refusal(start);
    return why.empty() ? why : "the start " + why;
  };
  find_refused(out);
  return out;
}

}  // namespace lagroid::app
