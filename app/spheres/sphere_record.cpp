#include "sphere_record.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

namespace lagroid::app {

namespace {

constexpr std::size_t few = 12;  // bobs whose trails are drawn

/// head1tail, head2tail, ... for each of the tails in turn.
std::vector<std::string> labels(std::size_t count, const char* format, const std::array<const char*, 3>& axes) {
  std::vector<std::string> out;
  for (std::size_t i = 1; i <= count; ++i)
    for (const char* axis : axes) out.push_back(fmt::format(fmt::runtime(format), i, axis));
  return out;
}

std::vector<Coordinate> place(std::size_t bob) {
  if (bob == 0) return {0.0, 0.0, 0.0};
  return {fmt::format("x{}", bob), fmt::format("y{}", bob), fmt::format("z{}", bob)};
}

/// What the method does not promise: how far it went is told.
LedgerEntry unpromised(LedgerEntry entry) {
  entry.promise = "none";
  entry.bound = 0;
  entry.verdict = "watched";
  entry.reason.clear();
  return entry;
}

}  // namespace

bool SphereNode::finite() const {
  return std::isfinite(residual) && z.allFinite() &&
         std::all_of(measured.begin(), measured.end(), [](const Measured& m) { return std::isfinite(m.value); });
}

SphereRecord::SphereRecord(const SphereSystem& system, SphereForm form)
    : quantities_(system.quantities()), form_(form), rods_(system.rods()), bobs_(system.bobs()) {}

void SphereRecord::declare(Trajectory& trajectory) const {
  constexpr std::array axes{"x", "y", "z"};
  const bool velocities = form_ == SphereForm::velocities;
  const std::size_t k = rods_.size();
  auto& series = trajectory.series;
  std::vector<std::string> places;
  for (std::size_t i = 1; i <= k; ++i)
    for (const char* axis : axes) places.push_back(fmt::format("{}{}", axis, i));
  series.push_back({"position", places, "m", "of the bobs, z up", false, {}});
  series.push_back({"direction", labels(k, "q{}{}", axes), "1", "unit vectors q along the rods", false, {}});
  series.push_back(velocities ? Columns{"angular_velocity",
                                        labels(k, "w{}{}", axes),
                                        "rad/s",
                                        "w of the rods in space, q' = w x q",
                                        false,
                                        {}}
                              : Columns{"momentum",
                                        labels(k, "p{}{}", axes),
                                        "kg m^2/s",
                                        "p of the directions, tangent to the spheres",
                                        false,
                                        {}});
  for (const auto& q : quantities_) series.push_back({q.column, {q.column}, q.unit, q.name, false, {}});
  for (const auto& q : quantities_)
    series.push_back({"drift of " + q.name, {"drift " + q.name}, q.unit, "deviation from the first value", false, {}});
  series.push_back({"constraint_residual", {"residual"}, "1", "largest distance from the spheres", false, {}});
}

void SphereRecord::observe(const SphereNode& node, Trajectory& trajectory) {
  if (first_.empty())
    for (const Measured& m : node.measured) first_.push_back(m.value);
  trajectory.time.push_back(node.time);
  std::size_t at = 0;
  const auto next = [&]() -> std::vector<double>& { return trajectory.series[at++].values; };
  auto& places = next();
  Vector<double, 3> bob = Vector<double, 3>::Zero();
  for (Eigen::Index i = 0; i < node.z.cols(); ++i) {
    bob += rods_[std::size_t(i)] * node.z.col(i).head<3>();
    places.insert(places.end(), bob.data(), bob.data() + 3);
  }
  for (const Eigen::Index half : {0, 3}) {
    auto& values = next();
    for (Eigen::Index i = 0; i < node.z.cols(); ++i)
      values.insert(values.end(), node.z.col(i).data() + half, node.z.col(i).data() + half + 3);
  }
  for (const Measured& m : node.measured) next().push_back(m.value);
  for (std::size_t i = 0; i < first_.size(); ++i) next().push_back(std::abs(node.measured[i].value - first_[i]));
  next().push_back(node.residual);
}

void SphereRecord::describe(RunResult& result) const {
  const std::size_t k = rods_.size();
  const double extent = std::accumulate(rods_.begin(), rods_.end(), 0.0);
  const double heaviest = *std::max_element(bobs_.begin(), bobs_.end());
  for (std::size_t i = 1; i <= k; ++i) {
    Shape rod{"rod", {rods_[i - 1], 0.006 * extent}};
    rod.position = place(i - 1);
    rod.to = place(i);
    result.shapes.push_back(rod);
    Shape bob{"sphere", {std::max(0.03 * std::cbrt(bobs_[i - 1] / heaviest), 0.01) * extent}};
    bob.position = place(i);
    bob.trail = k <= few || i == k;
    result.shapes.push_back(bob);
  }
  Panel heights{"heights of the bobs", "t", "z", "t", {}};
  for (std::size_t i = k > 4 ? k - 3 : 1; i <= k; ++i) heights.curves.push_back(fmt::format("z{}", i));
  result.panels = {{"the last bob from above", "x", "y", fmt::format("x{}", k), {fmt::format("y{}", k)}, true},
                   heights};
  const bool velocities = form_ == SphereForm::velocities;
  Panel last{velocities ? "angular velocity of the last rod" : "momentum of the last direction",
             "t",
             velocities ? "w" : "p",
             "t",
             {}};
  for (const char* axis : {"x", "y", "z"})
    last.curves.push_back(fmt::format("{}{}{}", velocities ? "w" : "p", k, axis));
  result.panels.push_back(last);
  for (const auto& q : quantities_)
    result.panels.push_back({q.name + " error", "t", "error", "t", {"drift " + q.name}});
  result.panels.push_back({"distance from the spheres", "t", "residual", "t", {"residual"}});
  result.trajectory.conventions = {
      {"state", "directions q of the rods and angular velocities w, q' = w x q, or momenta p at the nodes"},
      {"position", "of the bobs: lengths times directions, summed from the origin; z up"},
      {"ends", "position holds the directions, momentum the momenta, in either form"}};
}

SpherePromises::SpherePromises(const SphereSystem& system, const MethodTraits& method, bool keeps_spheres, long every)
    : promises_(method.symplectic),
      keeps_spheres_(keeps_spheres),
      walk_(7 * std::numeric_limits<double>::epsilon() * std::sqrt(double(every - 1))) {
  for (const auto& q : system.quantities()) quantities_.emplace_back(q.name, q.promise, 1);
}

void SpherePromises::observe(const SphereNode& node) {
  residual_ = std::isnan(node.residual) ? node.residual : std::max(residual_, node.residual);
  for (std::size_t i = 0; i < quantities_.size(); ++i)
    quantities_[i].observe(&node.measured[i].value, node.measured[i].size, walk_ * node.measured[i].size);
}

void SpherePromises::report(Ledger& ledger) const {
  const LedgerEntry constraint = constraint_entry(residual_, 1);
  ledger.entries.push_back(keeps_spheres_ ? constraint : unpromised(constraint));
  for (const auto& watch : quantities_) ledger.entries.push_back(promises_ ? watch.entry() : unpromised(watch.entry()));
}

void SpherePromises::persist(Archive& archive) {
  archive("residual", residual_);
  for (std::size_t i = 0; i < quantities_.size(); ++i) archive(fmt::format("quantity {}", i), quantities_[i]);
}

}  // namespace lagroid::app
