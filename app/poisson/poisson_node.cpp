#include "poisson_node.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <string>
#include <utility>

namespace lagroid::app {

namespace {

constexpr const char* defect_name = "Poisson defect";

}  // namespace

std::string casimir_column(std::size_t i) { return fmt::format("C{}", i + 1); }

PoissonNode::PoissonNode(const PoissonEntry& entry, const AnyPoissonSystem& system, const PoissonIntegrator& method,
                         long every, bool driven)
    : system_(system),
      rounding_(7 * std::numeric_limits<double>::epsilon() * std::sqrt(double(every - 1))),
      has_defect_(std::isfinite(method.poisson_defect())) {
  const KeptStructure kept = method.kept();
  fields_.push_back({.columns = {"state", entry.labels, "1", "coordinates of the Poisson manifold", false, {}}});
  const auto watch = [&](const std::string& name, const std::string& column, Promise promise, bool promised,
                         const char* meaning) {
    watched_.push_back({name, {column}, promise, false, SizeOf::terms, promised});
    fields_.push_back({.columns = {column, {column}, "1", meaning, false, {}}});
  };
  watch("energy", "energy", kept.energy ? Promise::conserved : Promise::bounded,
        (kept.energy || kept.bracket == 0) && !driven, "H");
  for (std::size_t i = 0; i < entry.casimirs.size(); ++i)
    watch("Casimir " + entry.casimirs[i], casimir_column(i), Promise::conserved, kept.casimirs == 0, "Casimir");
  if (has_defect_)
    watch(defect_name, "defect", Promise::conserved, kept.bracket == 0,
          "of the next step: the largest entry of D pi D^T - pi, relative");
  for (std::size_t i = 0; i < watched_.size(); ++i)
    fields_.push_back(drift_field(i, watched_[i].name, watched_[i].components.front()));
}

void PoissonNode::see(long index, double time, const PoissonIntegrator& at) {
  index_ = index;
  time_ = time;
  x_ = at.point();
  measured_ = system_.measure(x_);
  at_ = &at;
  defect_.reset();
}

double PoissonNode::defect() const {
  if (!defect_) defect_ = at_->poisson_defect();
  return *defect_;
}

bool PoissonNode::finite() const {
  return std::all_of(measured_.begin(), measured_.end(), [](const auto& m) { return std::isfinite(m.value); }) &&
         (!has_defect_ || std::isfinite(defect()));
}

void PoissonNode::read(std::size_t field, double* row) const {
  if (field == 0) {
    std::copy(x_.begin(), x_.end(), row);
  } else {
    measure(field - 1, row);
  }
}

void describe_poisson(const PoissonEntry& entry, RunResult& result) {
  const std::vector<std::string>& labels = entry.labels;
  Shape point{"sphere", {0.03}};
  point.position = {labels[0], labels[1], 0.0};
  if (labels.size() > 2) point.position[2] = labels[2];
  point.trail = true;
  result.shapes = {point};
  Panel states{"state", "t", "", "t", labels};
  result.panels = {{labels[1] + " over " + labels[0], labels[0], labels[1], labels[0], {labels[1]}}, states};
  result.panels.push_back({"energy error", "t", "error", "t", {"drift energy"}});
  if (!entry.casimirs.empty()) {
    Panel drifts{"errors of Casimirs", "t", "error", "t", {}};
    for (std::size_t i = 0; i < entry.casimirs.size(); ++i) drifts.curves.push_back("drift " + casimir_column(i));
    result.panels.push_back(drifts);
  }
  result.trajectory.conventions = {
      {"state", fmt::format("x' = pi(x) dH(x), {{x_i, x_j}} = pi_ij; bracket: {}", entry.bracket)},
      {"ends", "position holds the state"}};
}

}  // namespace lagroid::app
