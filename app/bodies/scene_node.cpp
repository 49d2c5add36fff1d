#include "scene_node.hpp"

#include "scene_picture.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

namespace lagroid::app {

using multibody::Vec;

namespace {

void put(const Vec& v, double* row) { std::copy_n(v.data(), 3, row); }
/// Compiled once, in the C library: Eigen's is compiled where it is called, and fuses products as the place suggests,
/// so that a bound would differ in its last digit from one program to the next.
double length_of(const Vec& v) { return std::hypot(std::hypot(v(0), v(1)), v(2)); }
void append(std::vector<double>& list, const Vec& v) { list.insert(list.end(), v.data(), v.data() + 3); }

}  // namespace

SceneNode::SceneNode(const multibody::Multibody& motion, const SceneBodies& bodies, const std::set<std::string>& chosen,
                     bool controlled)
    : motion_(motion) {
  const auto is_shown = [&](const NamedBody& b) { return chosen.empty() || chosen.contains(b.name); };
  for (const NamedBody& b : bodies.bodies) {
    if (!is_shown(b)) continue;
    shown_.push_back(&b);
    add_body(b);
  }
  for (std::size_t k = 0; k < bodies.lines.size(); ++k) add_line(k, bodies.lines[k], is_shown);
  add({"energy", {"energy"}, "J", "kinetic and potential energy", false, {}}, [this](double* row) { *row = energy(); });
  if (controlled)
    add({"step_size", {"h"}, "s", "step size of the arrow that led here", false, {}},
        [this](double* row) { *row = motion_.step(); });
  if (bodies.counts_cost)
    add({"cost", {"cost"}, "J s", "of the controls so far: the kinetic terms of the arrows", false, {}},
        [this](double* row) { *row = cost_; });
  add({"constraint_residual", {"residual"}, "1", "largest |C|, over the size of its terms", false, {}},
      [this](double* row) { *row = residual_; });

  if (!bodies.driven && !bodies.timed)
    watch({bodies.dissipates ? "energy and what drag took" : "energy", {"energy"}, Promise::bounded},
          [this](double* value) {
            *value = energy() + motion_.dissipated();
            return kinetic_ + std::abs(potential_);
          });
  if (!bodies.isolated) return;
  watch({"momentum", {"px", "py", "pz"}, Promise::conserved}, [this](double* value) {
    put(motion_.linear_momentum(momenta_), value);
    return momentum_size();
  });
  watch({"angular momentum", {"Lx", "Ly", "Lz"}, Promise::conserved}, [this](double* value) {
    put(motion_.angular_momentum(momenta_), value);
    return angular_size();
  });
}

void SceneNode::see(double cost) {
  cost_ = cost;
  momenta_ = motion_.momenta();
  kinetic_ = motion_.kinetic_energy(momenta_);
  potential_ = motion_.potential_energy();
  residual_ = motion_.constraint_residual();
}

bool SceneNode::finite() const { return std::isfinite(energy()) && std::isfinite(residual_); }

std::span<const double> SceneNode::positions() const {
  const auto& places = motion_.configuration().x;
  return {places.empty() ? nullptr : places.front().data(), 3 * places.size()};
}

/// Places of the bodies, and inertia times velocity of those that move, one after another.
Endpoint SceneNode::endpoint() const {
  Endpoint end;
  end.time = motion_.time();
  for (const NamedBody* b : shown_) {
    append(end.position, motion_.configuration()(motion_(b->body.centre)));
    if (b->linear >= 0) append(end.momentum, linear_momentum(b->linear));
    if (b->body.attitude.index >= 0) append(end.momentum, momenta_.spin[std::size_t(motion_(b->body.attitude).index)]);
  }
  return end;
}

void SceneNode::add(Columns columns, Read read) {
  fields_.push_back({std::move(columns)});
  read_.push_back(std::move(read));
}

void SceneNode::watch(Watched quantity, Measure measure) {
  watched_.push_back(std::move(quantity));
  measure_.push_back(std::move(measure));
}

void SceneNode::add_point(const std::string& name, multibody::Site site) {
  add({name, columns(name, {"x", "y", "z"}), "m", "position in space", false, {}},
      [this, site](double* row) { put(motion_.configuration()(motion_(site)), row); });
}

/// Its ends, where no other column has them. One that can be switched ends where it begins while it is off.
void SceneNode::add_line(std::size_t number, const SceneBodies::Line& line,
                         const std::function<bool(const NamedBody&)>& is_shown) {
  const auto is_point = [&](const Attachment& end) {
    return end.moved || (end.body && !end.arm.isZero(0) && is_shown(*end.body));
  };
  if (line.switched_by == 0) {
    for (const auto& [end, name] : {std::pair{&line.from, "from"}, {&line.to, "to"}})
      if (is_point(*end)) add_point(end_column(number, name), end->site);
    return;
  }
  for (const Attachment* end : {&line.from, &line.to})
    if (end->body && !is_shown(*end->body)) return;
  const std::string name = end_column(number, "to");
  if (is_point(line.from)) add_point(end_column(number, "from"), line.from.site);
  add({name, columns(name, {"x", "y", "z"}), "m", "position in space; of its other end while it is off", false, {}},
      [this, &line](double* row) {
        const bool on = motion_.switches().on[std::size_t(line.switched_by)] != 0;
        put(motion_.configuration()(motion_(on ? line.to.site : line.from.site)), row);
      });
}

void SceneNode::add_body(const NamedBody& b) {
  add_point(b.name, b.body.centre);
  if (b.body.attitude.index >= 0) {
    const auto spin = [this, a = b.body.attitude]() -> const Vec& {
      return momenta_.spin[std::size_t(motion_(a).index)];
    };
    add({b.name + ".attitude",
         attitude_of(b.name),
         "1",
         "rotation A from body to space, unit quaternion w, x, y, z",
         false,
         {}},
        [this, a = b.body.attitude](double* row) { std::copy_n(motion_.quaternion(a).data(), 4, row); });
    add({b.name + ".spin", columns(b.name, {"M1", "M2", "M3"}), "kg m^2/s", "body angular momentum", false, {}},
        [spin](double* row) { put(spin(), row); });
    add({b.name + ".angular_velocity",
         columns(b.name, {"w1", "w2", "w3"}),
         "rad/s",
         "angular velocity in the body",
         false,
         {}},
        [this, spin, a = b.body.attitude](double* row) { put(spin().cwiseQuotient(motion_.moments(a)), row); });
  }
  if (b.linear < 0) return;
  const auto momentum = [this, linear = b.linear](double* row) { put(linear_momentum(linear), row); };
  if (!b.planar) {
    add({b.name + ".momentum", columns(b.name, {"px", "py", "pz"}), "kg m/s", "momentum in space", false, {}},
        momentum);
    return;
  }
  add({b.name + ".angle", {column(b.name, "angle")}, "rad", "of the body in the plane", false, {}},
      [this, linear = b.linear](double* row) {
        *row = motion_.configuration().x[std::size_t(motion_.linear_place(linear))](2);
      });
  add({b.name + ".momentum",
       columns(b.name, {"px", "py", "L"}),
       "kg m/s; kg m^2/s",
       "momentum, and angular momentum about the centre",
       false,
       {}},
      momentum);
  add({b.name + ".angular_velocity", {column(b.name, "w")}, "rad/s", "of the body in the plane", false, {}},
      [this, linear = b.linear](double* row) { *row = linear_momentum(linear)(2) / motion_.inertia(linear)(2); });
}

const Vec& SceneNode::linear_momentum(int linear) const {
  return momenta_.linear[std::size_t(motion_.linear_place(linear))];
}

double SceneNode::momentum_size() const {
  double size = 0;
  for (const Vec& p : momenta_.linear) size += length_of(p);
  return size;
}

double SceneNode::angular_size() const {
  double size = 0;
  for (std::size_t f = 0; f < momenta_.linear.size(); ++f)
    size += length_of(momenta_.linear[f]) * length_of(motion_.configuration().x[f]);
  for (const Vec& spin : momenta_.spin) size += length_of(spin);
  return size;
}

}  // namespace lagroid::app
