#include "sphere_node.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numeric>
#include <utility>

namespace lagroid::app {

namespace {

constexpr std::size_t few = 12;  // bobs whose trails are drawn
constexpr std::array axes{"x", "y", "z"};
constexpr std::size_t before_quantities = 3;  // fields: bobs, directions, velocities or momenta

/// head1tail, head2tail, ... for each of the tails in turn.
std::vector<std::string> labels(std::size_t count, const char* format) {
  std::vector<std::string> out;
  for (std::size_t i = 1; i <= count; ++i)
    for (const char* axis : axes) out.push_back(fmt::format(fmt::runtime(format), i, axis));
  return out;
}

std::vector<Coordinate> place(std::size_t bob) {
  if (bob == 0) return {0.0, 0.0, 0.0};
  return {fmt::format("x{}", bob), fmt::format("y{}", bob), fmt::format("z{}", bob)};
}

}  // namespace

SphereNode::SphereNode(const SphereSystem& system, SphereForm form, const MethodTraits& method, bool keeps_spheres,
                       long every)
    : system_(system),
      form_(form),
      constrained_(keeps_spheres ? Constrained::promised : Constrained::watched),
      rounding_(7 * std::numeric_limits<double>::epsilon() * std::sqrt(double(every - 1))),
      rods_(system.rods()) {
  const std::size_t k = rods_.size();
  add({"position", labels(k, "{1}{0}"), "m", "of the bobs, z up", false, {}});
  add({"direction", labels(k, "q{}{}"), "1", "unit vectors q along the rods", false, {}});
  if (form == SphereForm::velocities)
    add({"angular_velocity", labels(k, "w{}{}"), "rad/s", "w of the rods in space, q' = w x q", false, {}});
  else
    add({"momentum", labels(k, "p{}{}"), "kg m^2/s", "p of the directions, tangent to the spheres", false, {}});
  const auto quantities = system.quantities();
  for (const auto& q : quantities) {
    watched_.push_back({q.name, {q.column}, q.promise, false, SizeOf::terms, method.symplectic});
    add({q.column, {q.column}, q.unit, q.name, false, {}});
  }
  for (std::size_t i = 0; i < quantities.size(); ++i)
    fields_.push_back(drift_field(i, quantities[i].name, quantities[i].name, quantities[i].unit));
  add({"constraint_residual", {"residual"}, "1", "largest distance from the spheres", false, {}});
}

void SphereNode::see(long index, double time, SphereIntegrator::Points points) {
  index_ = index;
  time_ = time;
  z_ = std::move(points);
  measured_ = system_.measure(z_, form_);
  residual_ = off_spheres(z_);
}

Endpoint SphereNode::endpoint() const {
  Endpoint end;
  end.time = time_;
  const auto z = system_.in_form(z_, form_, SphereForm::momenta);
  for (Eigen::Index i = 0; i < z.cols(); ++i) {
    end.position.insert(end.position.end(), z.col(i).data(), z.col(i).data() + 3);
    end.momentum.insert(end.momentum.end(), z.col(i).data() + 3, z.col(i).data() + 6);
  }
  return end;
}

bool SphereNode::finite() const {
  return std::isfinite(residual_) && z_.allFinite() &&
         std::all_of(measured_.begin(), measured_.end(), [](const Measured& m) { return std::isfinite(m.value); });
}

void SphereNode::read(std::size_t field, double* row) const {
  if (field == 0) {
    Vector<double, 3> bob = Vector<double, 3>::Zero();
    for (Eigen::Index i = 0; i < z_.cols(); ++i) {
      bob += rods_[std::size_t(i)] * z_.col(i).head<3>();
      row = std::copy_n(bob.data(), 3, row);
    }
  } else if (field < before_quantities) {
    const Eigen::Index half = field == 1 ? 0 : 3;
    for (Eigen::Index i = 0; i < z_.cols(); ++i) row = std::copy_n(z_.col(i).data() + half, 3, row);
  } else if (const std::size_t quantity = field - before_quantities; quantity < measured_.size()) {
    *row = measured_[quantity].value;
  } else {
    *row = residual_;
  }
}

void describe_spheres(const SphereSystem& system, SphereForm form, RunResult& result) {
  const std::vector<double> rods = system.rods(), bobs = system.bobs();
  const std::size_t k = rods.size();
  const double extent = std::accumulate(rods.begin(), rods.end(), 0.0);
  const double heaviest = *std::max_element(bobs.begin(), bobs.end());
  for (std::size_t i = 1; i <= k; ++i) {
    Shape rod{"rod", {rods[i - 1], 0.006 * extent}};
    rod.position = place(i - 1);
    rod.to = place(i);
    result.shapes.push_back(rod);
    Shape bob{"sphere", {std::max(0.03 * std::cbrt(bobs[i - 1] / heaviest), 0.01) * extent}};
    bob.position = place(i);
    bob.trail = k <= few || i == k;
    result.shapes.push_back(bob);
  }
  Panel heights{"heights of the bobs", "t", "z", "t", {}};
  for (std::size_t i = k > 4 ? k - 3 : 1; i <= k; ++i) heights.curves.push_back(fmt::format("z{}", i));
  result.panels = {{"the last bob from above", "x", "y", fmt::format("x{}", k), {fmt::format("y{}", k)}, true},
                   heights};
  const bool velocities = form == SphereForm::velocities;
  Panel last{velocities ? "angular velocity of the last rod" : "momentum of the last direction",
             "t",
             velocities ? "w" : "p",
             "t",
             {}};
  for (const char* axis : {"x", "y", "z"})
    last.curves.push_back(fmt::format("{}{}{}", velocities ? "w" : "p", k, axis));
  result.panels.push_back(last);
  for (const auto& q : system.quantities())
    result.panels.push_back({q.name + " error", "t", "error", "t", {"drift " + q.name}});
  result.panels.push_back({"distance from the spheres", "t", "residual", "t", {"residual"}});
  result.trajectory.conventions = {
      {"state", "directions q of the rods and angular velocities w, q' = w x q, or momenta p at the nodes"},
      {"position", "of the bobs: lengths times directions, summed from the origin; z up"},
      {"ends", "position holds the directions, momentum the momenta, in either form"}};
}

}  // namespace lagroid::app
