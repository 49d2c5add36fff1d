#include <lagroid/systems/multibody/control/scene_transcription.hpp>

#include <lagroid/core/scalars/second_jet.hpp>
#include <lagroid/systems/multibody/control/arrow_momenta.hpp>

#include <algorithm>
#include <cmath>
#include <utility>

namespace lagroid::multibody {

namespace {

/// Momenta of factor f on the arrow between two nodes.
ArrowMomenta<double> momenta_of(const ControlledScene& scene, int f, const ControlledNode& from,
                                const ControlledNode& to, double h) {
  if (f < scene.linear()) {
    const auto i = std::size_t(f);
    return arrow_momenta<double>(scene.inertia(f), scene.drag(f), Vec(to.places[i] - from.places[i]), h);
  }
  const auto r = std::size_t(f - scene.linear());
  return arrow_momenta<double>(scene.inertia(f), scene.drag(f), scene.rotation(),
                               Mat(from.attitudes[r].transpose() * to.attitudes[r]), h);
}

}  // namespace

SceneTranscription::SceneTranscription(ControlledScene& scene, ScenePath start, Coordinates coordinates)
    : scene_(scene), coordinates_(coordinates), now_(std::move(start)), tried_(now_) {
  const SceneControl& task = scene.task();
  for (int j = 0; j < scene.actuators(); ++j) {
    const Actuator& each = task.actuators[std::size_t(j)];
    if (std::isfinite(each.upper)) bounds_.push_back({j, 1, each.upper});
    if (std::isfinite(each.lower)) bounds_.push_back({j, -1, each.lower});
  }
  const int last = int(scene.end_rows().size());
  sizes_.node = 2 * scene.n();
  sizes_.control = scene.actuators() + scene.joints();
  sizes_.node_equality = std::max(scene.joints(), last);
  sizes_.equality = equations() + sizes_.node_equality;
  sizes_.inequality = scene.limits().size() + int(bounds_.size());
  sizes_.stages = now_.stages();
  TranscriptionPhase& phase = sizes_.phases.emplace_back();
  phase.end = sizes_.stages;
  phase.duration_is_free = task.duration_is_free;
  for (const Bound& each : bounds_) phase.bounds.push_back({each.control, each.sign});
  sizes_.conditions.assign(std::size_t(sizes_.stages), scene.joints());
  sizes_.conditions.back() = last;
  variables_ = sizes_.variables();
  free_start_.assign(std::size_t(sizes_.node), false);
  free_end_.assign(std::size_t(sizes_.node), true);
  joint_hessians_.resize(std::size_t(scene.joints() * scene.n() * scene.n()));
  gradients_.resize(scene.joints(), scene.n());
  along_.resize(scene.n(), scene.joints());
  reaction_.resize(scene.joints(), scene.joints());
  slope_.resize(scene.n());
  slopes_of_velocities_.resize(scene.n() + 3 * scene.limits().points(), scene.n());
  bent_.resize(scene.joints());
}

void SceneTranscription::values(StageValues& out) const {
  const SceneControl& task = scene_.task();
  const int n = scene_.n(), actuators = scene_.actuators(), joints = scene_.joints();
  const double h = tried_.step;
  for (long k = 0; k < sizes_.stages; ++k) {
    const ControlledNode& from = tried_.nodes[std::size_t(k)];
    const ControlledNode& to = tried_.nodes[std::size_t(k) + 1];
    double* equality = out.equality[k];
    for (int f = 0; f < scene_.factors(); ++f) {
      const ArrowMomenta<double> p = momenta_of(scene_, f, from, to, h);
      for (int i = 0; i < 3; ++i) {
        equality[3 * f + i] = from.momenta(3 * f + i) - p.source(i);
        equality[n + 3 * f + i] = p.target(i) - to.momenta(3 * f + i);
      }
    }
    if (scene_.is_damped()) {
      const DamperForces<double>& damping = scene_.dampers(from, to);
      for (int i = 0; i < n; ++i) {
        equality[i] += damping(End::source, i);
        equality[n + i] += damping(End::target, i);
      }
    }
    const double* u = tried_.controls[k];
    double cost = task.duration_weight;
    for (int j = 0; j < actuators; ++j) cost += task.actuators[std::size_t(j)].weight * u[j] * u[j];
    out.cost[k][0] = h * cost;
    for (std::size_t b = 0; b < bounds_.size(); ++b)
      out.inequality[k][before_bounds() + int(b)] = bounds_[b].sign * (u[bounds_[b].control] - bounds_[b].value);
  }
  for (long k = 0; k <= sizes_.stages; ++k) {
    const ControlledNode& node = tried_.nodes[std::size_t(k)];
    const NodeForces<double>& at = scene_.forces(node);
    for (const End end : {End::source, End::target}) {
      const long stage = end == End::source ? k : k - 1;
      if (stage < 0 || stage == sizes_.stages) continue;
      const double* u = tried_.controls[stage];
      double* equality = out.equality[stage] + (end == End::source ? 0 : n);
      for (int i = 0; i < n; ++i) {
        double force = at.own(i);
        for (int j = 0; j < actuators; ++j) force += u[j] * at.of_control(j, i);
        equality[i] += 0.5 * h * force;
        if (end == End::source)
          for (int row = 0; row < joints; ++row) equality[i] += u[actuators + row] * at.gradient(row, i);
      }
    }
    if (k == 0) continue;
    const NodeLimits& limits = scene_.limits();
    for (int i = 0; i < limits.on_places(); ++i) out.inequality[k - 1][i] = limits.value(i, at);
    if (limits.on_velocities() > 0) {
      const std::vector<double> velocities = scene_.velocities(node);
      for (int i = 0; i < limits.on_velocities(); ++i)
        out.inequality[k - 1][limits.on_places() + i] = limits.value_of_speed(i, velocities);
    }
    double* conditions = out.equality[k - 1] + equations();
    if (k < sizes_.stages) {
      for (int row = 0; row < joints; ++row) conditions[row] = at.joint(row);
    } else {
      scene_.end_values(node, end_values_);
      for (const int row : scene_.end_rows()) *conditions++ = end_values_[std::size_t(row)];
    }
  }
}

void SceneTranscription::derivatives(const StageRows& lambda, const StageRows& z, StageDerivatives& out) const {
  set_all(out.gradient, 0);
  set_all(out.equality, 0);
  set_all(out.inequality, 0);
  set_all(out.hessian, 0);
  const auto block = [&](long k) {
    return Block{out.gradient[k], out.equality[k], out.inequality[k], out.hessian[k], lambda[k], z[k],
                 now_.controls[k]};
  };
  for (long k = 0; k < sizes_.stages; ++k) {
    add_cost(block(k));
    add_kinetic(k, block(k));
    if (scene_.is_damped()) add_dampers(k, block(k));
  }
  for (long k = 0; k <= sizes_.stages; ++k) {
    const ControlledNode& node = now_.nodes[std::size_t(k)];
    const bool is_last = k == sizes_.stages;
    for (int left = 0; left < scene_.factors(); ++left)
      for (int right = left; right < scene_.factors(); ++right) {
        const NodeForces<SecondNumber>& at = scene_.forces(node, left, right);
        keep_joints(at, left, right);
        if (!is_last) add_forces(at, left, right, End::source, block(k));
        if (k == 0) continue;
        add_forces(at, left, right, End::target, block(k - 1));
        add_conditions(node, at, left, right, is_last, block(k - 1));
      }
    if (k == 0) continue;
    bend_along_joints(k - 1, End::target, block(k - 1));
    if (!is_last) bend_along_joints(k, End::source, block(k));
    add_momenta(node, is_last, block(k - 1));
  }
}

void SceneTranscription::keep_joints(const NodeForces<SecondNumber>& at, int left, int right) const {
  const int n = scene_.n(), joints = scene_.joints();
  for (int row = 0; row < joints; ++row) {
    double* hessian = joint_hessians_.data() + row * n * n;
    for (int i = 0; i < 3; ++i)
      for (int j = 0; j < 3; ++j) {
        const double x = at.joint(row).mixed(i, j);
        hessian[(3 * left + i) * n + 3 * right + j] = hessian[(3 * right + j) * n + 3 * left + i] = x;
      }
  }
  if (left + right > 0 || joints == 0) return;
  for (int row = 0; row < joints; ++row)
    for (int i = 0; i < n; ++i) {
      gradients_(row, i) = at.gradient(row, i).value;
      along_(i, row) = gradients_(row, i) / scene_.inertia(i / 3)(i % 3);
    }
  reaction_.noalias() = gradients_ * along_;
  factor_.compute(reaction_);
}

/// A displacement v is one by v - W D^T (D W D^T)^{-1} C''(v, v) / 2: of a function with the gradient g the Hessian has
/// sum_i nu_i C_i'' more, nu = -(D W D^T)^{-1} D W g.
void SceneTranscription::bend_along_joints(long stage, End end, const Block& out) const {
  const int n = scene_.n(), joints = scene_.joints();
  if (joints == 0 || coordinates_ == Coordinates::straight) return;
  const int node = end == End::source ? 0 : sizes_.at_target();
  slope_.setZero();
  for (int row = 0; row < sizes_.equalities_of(stage); ++row)
    for (int i = 0; i < n; ++i) slope_(i) += out.lambda[row] * out.equality[row * variables_ + node + i];
  for (int row = 0; row < before_bounds(); ++row)
    for (int i = 0; i < n; ++i) slope_(i) += out.z[row] * out.inequality[row * variables_ + node + i];
  bent_.noalias() = along_.transpose() * slope_;
  bent_ = factor_.solve(bent_).eval();
  for (int row = 0; row < joints; ++row)
    for (int i = 0; i < n; ++i)
      for (int j = 0; j < n; ++j)
        out.hessian[(node + i) * variables_ + node + j] -=
            bent_(row) * joint_hessians_[std::size_t((row * n + i) * n + j)];
}

void SceneTranscription::add_cost(const Block& out) const {
  const SceneControl& task = scene_.task();
  const double h = now_.step;
  const int t = sizes_.at_duration();
  double cost = task.duration_weight;
  for (int j = 0; j < scene_.actuators(); ++j) {
    const double weight = task.actuators[std::size_t(j)].weight;
    const double u = out.controls[j];
    const int at = sizes_.at_control() + j;
    cost += weight * u * u;
    out.gradient[at] = 2 * h * weight * u;
    add_to(out.hessian, at, at, 2 * h * weight);
    add_to(out.hessian, at, t, 2 * h * weight * u);
  }
  out.gradient[t] = h * cost;
  add_to(out.hessian, t, t, h * cost);
}

void SceneTranscription::add_kinetic(long stage, const Block& out) const {
  const int n = scene_.n(), source = 0, target = sizes_.at_target(), t = sizes_.at_duration();
  const ControlledNode& from = now_.nodes[std::size_t(stage)];
  const ControlledNode& to = now_.nodes[std::size_t(stage) + 1];
  const auto row = [&](int i) { return out.equality + i * variables_; };
  for (int i = 0; i < n; ++i) {
    row(i)[source + n + i] += 1;
    row(n + i)[target + n + i] -= 1;
  }
  for (int f = 0; f < scene_.factors(); ++f) {
    const double* before = out.lambda + 3 * f;
    const double* after = out.lambda + n + 3 * f;
    const auto place = [&](int i) { return i < 3 ? source + 3 * f + i : i < 6 ? target + 3 * f + i - 3 : t; };
    // -F- and F+, drag and all, along both ends and log h.
    const auto put = [&](const auto& momenta) {
      auto lagrangian = momenta.target(0) * after[0] - momenta.source(0) * before[0];
      for (int i = 1; i < 3; ++i) lagrangian += momenta.target(i) * after[i] - momenta.source(i) * before[i];
      for (int p = 0; p < 7; ++p) {
        for (int i = 0; i < 3; ++i) {
          row(3 * f + i)[place(p)] -= momenta.source(i).gradient(p);
          row(n + 3 * f + i)[place(p)] += momenta.target(i).gradient(p);
        }
        for (int q = 0; q <= p; ++q) add_to(out.hessian, place(p), place(q), lagrangian.hessian(p, q));
      }
    };
    using J = SecondJet<double, 7>;
    const J h = J::variable(0, 6).chain(now_.step, now_.step, now_.step);
    Vector<J, 3> a, b;
    for (int i = 0; i < 3; ++i) {
      a(i) = J::variable(0, i);
      b(i) = J::variable(0, 3 + i);
    }
    if (f < scene_.linear()) {
      const Vec d = to.places[std::size_t(f)] - from.places[std::size_t(f)];
      put(arrow_momenta<J>(scene_.inertia(f), scene_.drag(f), Vector<J, 3>(d.cast<J>() + b - a), h));
    } else {
      const auto r = std::size_t(f - scene_.linear());
      const Mat turn = from.attitudes[r].transpose() * to.attitudes[r];
      const Matrix<J, 3, 3> moved =
          SO3::inverse(turn_of(scene_.rotation(), a)) * Matrix<J, 3, 3>(turn.cast<J>() * turn_of(scene_.rotation(), b));
      put(arrow_momenta<J>(scene_.inertia(f), scene_.drag(f), scene_.rotation(), moved, h));
    }
  }
}

void SceneTranscription::add_dampers(long stage, const Block& out) const {
  const int n = scene_.n();
  const ControlledNode& from = now_.nodes[std::size_t(stage)];
  const ControlledNode& to = now_.nodes[std::size_t(stage) + 1];
  const auto place = [&](const FactorEnd& of) {
    return (of.end == End::source ? 0 : sizes_.at_target()) + 3 * of.factor;
  };
  std::vector<FactorEnd> varied;
  for (const End end : {End::source, End::target})
    for (const int factor : scene_.damped_factors()) varied.push_back({end, factor});
  for (std::size_t p = 0; p < varied.size(); ++p)
    for (std::size_t q = p; q < varied.size(); ++q) {
      const bool is_one = p == q;
      const DamperForces<SecondNumber>& at = scene_.dampers(from, to, varied[p], varied[q]);
      SecondNumber weighed = SecondNumber(0);
      for (const End end : {End::source, End::target})
        for (const int factor : scene_.damped_factors())
          for (int i = 3 * factor; i < 3 * factor + 3; ++i) {
            const int equation = (end == End::source ? 0 : n) + i;
            weighed += at(end, i) * out.lambda[equation];
            for (int j = 0; j < 3 && is_one; ++j)
              out.equality[equation * variables_ + place(varied[p]) + j] += at(end, i).left(j);
          }
      for (int i = 0; i < 3; ++i)
        for (int j = is_one ? i : 0; j < 3; ++j)
          add_to(out.hessian, place(varied[p]) + i, place(varied[q]) + j, weighed.mixed(i, j));
    }
}

void SceneTranscription::add_forces(const NodeForces<SecondNumber>& at, int left, int right, End end,
                                    const Block& out) const {
  const int n = scene_.n(), actuators = scene_.actuators(), t = sizes_.at_duration();
  const int joints = end == End::source ? scene_.joints() : 0;
  const int equation = end == End::source ? 0 : n;
  const int node = end == End::source ? 0 : sizes_.at_target();
  const int control = sizes_.at_control();
  const double half = 0.5 * now_.step;
  const double* lambda = out.lambda + equation;
  const double* u = out.controls;
  const auto weighed = [&](const auto& force) {
    SecondNumber sum = SecondNumber(0);
    for (int i = 0; i < n; ++i) sum += force(i) * lambda[i];
    return sum;
  };
  const auto force = [&](int i) {
    SecondNumber sum = at.own(i);
    for (int j = 0; j < actuators; ++j) sum += at.of_control(j, i) * u[j];
    return sum;
  };
  // Where one factor is varied, rows and what is mixed with controls and the duration follow, too.
  const bool is_one = left == right;
  const SecondNumber acting = weighed(force);
  SecondNumber whole = acting * half;
  for (int row = 0; row < joints; ++row) {
    const SecondNumber reaction = weighed([&](int i) { return at.gradient(row, i); });
    whole += reaction * u[actuators + row];
    for (int i = 0; i < 3 && is_one; ++i)
      add_to(out.hessian, node + 3 * left + i, control + actuators + row, reaction.left(i));
  }
  for (int i = 0; i < 3; ++i)
    for (int j = is_one ? i : 0; j < 3; ++j)
      add_to(out.hessian, node + 3 * left + i, node + 3 * right + j, whole.mixed(i, j));
  if (!is_one) return;

  const bool is_first = left == 0;  // what varies with no place is put once
  for (int i = 0; i < 3; ++i) add_to(out.hessian, node + 3 * left + i, t, half * acting.left(i));
  if (is_first) add_to(out.hessian, t, t, half * acting.value);
  for (int j = 0; j < actuators; ++j) {
    const SecondNumber of_one = weighed([&](int i) { return at.of_control(j, i); });
    for (int i = 0; i < 3; ++i) add_to(out.hessian, node + 3 * left + i, control + j, half * of_one.left(i));
    if (is_first) add_to(out.hessian, control + j, t, half * of_one.value);
  }
  for (int e = 0; e < n; ++e) {
    double* row = out.equality + (equation + e) * variables_;
    SecondNumber sum = force(e) * half;
    if (is_first) row[t] += sum.value;
    for (int k = 0; k < joints; ++k) sum += at.gradient(k, e) * u[actuators + k];
    for (int i = 0; i < 3; ++i) row[node + 3 * left + i] += sum.left(i);
    if (!is_first) continue;
    for (int j = 0; j < actuators; ++j) row[control + j] += half * at.of_control(j, e).value;
    for (int k = 0; k < joints; ++k) row[control + actuators + k] += at.gradient(k, e).value;
  }
}

void SceneTranscription::add_conditions(const ControlledNode& node, const NodeForces<SecondNumber>& at, int left,
                                        int right, bool is_last, const Block& out) const {
  const int target = sizes_.at_target();
  const bool is_one = left == right;
  const auto put = [&](const SecondNumber& value, double weight, double* row) {
    for (int i = 0; i < 3; ++i) {
      for (int j = is_one ? i : 0; j < 3; ++j)
        add_to(out.hessian, target + 3 * left + i, target + 3 * right + j, weight * value.mixed(i, j));
      if (is_one) row[target + 3 * left + i] += value.left(i);
    }
  };
  const NodeLimits& limits = scene_.limits();
  for (int i = 0; i < limits.on_places(); ++i) put(limits.value(i, at), out.z[i], out.inequality + i * variables_);
  if (limits.on_velocities() > 0) scene_.velocities(node, -1, varied_velocities_);
  for (int k = 0; k < limits.on_velocities(); ++k) {
    const int i = limits.on_places() + k;
    put(limits.value_of_speed(k, varied_velocities_), out.z[i], out.inequality + i * variables_);
  }
  double* row = out.equality + equations() * variables_;
  const double* lambda = out.lambda + equations();
  if (!is_last) {
    for (int k = 0; k < scene_.joints(); ++k, row += variables_) put(at.joint(k), *lambda++, row);
    return;
  }
  scene_.end_values(node, -1, varied_end_);
  for (const int k : scene_.end_rows()) {
    put(varied_end_[std::size_t(k)], *lambda++, row);
    row += variables_;
  }
}

/// What a node is to satisfy, along the momenta there: the end's conditions are linear in these, squares of speeds are
/// not.
void SceneTranscription::add_momenta(const ControlledNode& node, bool is_last, const Block& out) const {
  const NodeLimits& limits = scene_.limits();
  if (!is_last && limits.on_velocities() == 0) return;
  const int places = sizes_.at_target(), momenta = places + scene_.n();
  const auto put = [&](const SecondNumber& value, double weight, double* row, int left, int right) {
    for (int j = 0; j < 3; ++j) {
      for (int i = 0; i < 3; ++i)
        add_to(out.hessian, places + 3 * left + i, momenta + 3 * right + j, weight * value.mixed(i, j));
      if (left == 0) row[momenta + 3 * right + j] += value.right(j);
    }
  };
  for (int left = 0; left < scene_.factors(); ++left) {
    scene_.forces(node, left, -1);
    for (int right = 0; right < scene_.factors(); ++right) {
      if (is_last) {
        scene_.end_values(node, right, varied_end_);
        double* row = out.equality + equations() * variables_;
        const double* lambda = out.lambda + equations();
        for (const int k : scene_.end_rows()) {
          put(varied_end_[std::size_t(k)], *lambda++, row, left, right);
          row += variables_;
        }
      }
      if (limits.on_velocities() == 0) continue;
      scene_.velocities(node, right, varied_velocities_);
      for (int k = 0; k < limits.on_velocities(); ++k) {
        const int i = limits.on_places() + k;
        put(limits.value_of_speed(k, varied_velocities_), out.z[i], out.inequality + i * variables_, left, right);
      }
      for (int i = 0; i < int(slopes_of_velocities_.rows()) && left == 0; ++i)
        for (int j = 0; j < 3; ++j)
          slopes_of_velocities_(i, 3 * right + j) = varied_velocities_[std::size_t(i)].right(j);
    }
  }
  for (int k = 0; k < limits.on_velocities(); ++k) {
    const double weight = 2 * out.z[limits.on_places() + k] * limits.weight(k);
    for (const int c : limits.components(k))
      for (int i = 0; i < scene_.n(); ++i)
        for (int j = 0; j < scene_.n(); ++j)
          out.hessian[(momenta + i) * variables_ + momenta + j] +=
              weight * slopes_of_velocities_(c, i) * slopes_of_velocities_(c, j);
  }
}

void SceneTranscription::try_displacement(const TrajectoryDisplacement& by, double fraction) {
  for (std::size_t k = 1; k < now_.nodes.size(); ++k)
    if (coordinates_ == Coordinates::straight)
      scene_.displace(now_.nodes[k], by.nodes[long(k)], fraction, tried_.nodes[k]);
    else
      scene_.displace_along_joints(now_.nodes[k], by.nodes[long(k)], fraction, tried_.nodes[k]);
  tried_.controls = now_.controls;
  add(tried_.controls, fraction, by.controls);
  tried_.step = now_.step * std::exp(fraction * by.durations.front());
}

}  // namespace lagroid::multibody
