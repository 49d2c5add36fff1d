// From a written scene to the arrays that a step runs over.

#include <lagroid/systems/multibody/multibody.hpp>

#include <Eigen/LU>

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <stdexcept>

namespace lagroid::multibody {

namespace {

/// Sets of factors that joints tie together.
class Groups {
 public:
  explicit Groups(int size) : parent_(std::size_t(size)) { std::iota(parent_.begin(), parent_.end(), 0); }
  int of(int i) {
    while (parent_[std::size_t(i)] != i) {
      parent_[std::size_t(i)] = parent_[std::size_t(parent_[std::size_t(i)])];
      i = parent_[std::size_t(i)];
    }
    return i;
  }
  void join(int i, int j) { parent_[std::size_t(of(i))] = of(j); }

 private:
  std::vector<int> parent_;
};

/// The order that sorts by key; equal ones stay as they are.
std::vector<int> sorted_by(const std::vector<int>& key) {
  std::vector<int> order(key.size());
  std::iota(order.begin(), order.end(), 0);
  std::stable_sort(order.begin(), order.end(), [&](int i, int j) { return key[std::size_t(i)] < key[std::size_t(j)]; });
  return order;
}

std::vector<int> inverse(const std::vector<int>& order) {
  std::vector<int> place(order.size());
  for (std::size_t k = 0; k < order.size(); ++k) place[std::size_t(order[k])] = int(k);
  return place;
}

template <class T> std::vector<T> in_order(const std::vector<T>& all, const std::vector<int>& order) {
  std::vector<T> out;
  out.reserve(all.size());
  for (const int i : order) out.push_back(all[std::size_t(i)]);
  return out;
}

}  // namespace

Multibody::Multibody(Scene scene, double h, const Options& options) : h_(h), options_(options), whole_step_(h) {
  assemble(scene);
  begin();
  leave_out_dependent();
  add_multipliers(momentum_, spin_, -1);
  if (options.controlled) {
    if (!has_time_scale())
      throw std::invalid_argument("steps are controlled by attractions alone: no joints, no other effects");
    control_.emplace(h, time_scale_rate());
  }
  if (options.composition.stages() > 1) compose(options.composition);
}

bool Multibody::has_time_scale() const {
  const auto attracts = [](const auto& effect) { return effect->attracts(); };
  return std::all_of(effects_.begin(), effects_.end(), attracts) && islands_.empty() && dragged_.empty() &&
         damped_turns_.empty() && std::isfinite(time_scale_rate());
}

void Multibody::compose(const Composition& composition) {
  const bool holonomic = std::all_of(roles_.begin(), roles_.end(), [](Role role) { return role == Role::holonomic; });
  if (control_ || !holonomic || !dragged_.empty() || !damped_turns_.empty())
    throw std::invalid_argument("a step is composed where it can be taken back");
  for (const double share : composition.coefficients) {
    Stage stage{share * whole_step_, earlier_, turned_before_};
    for (auto& multipliers : stage.earlier)
      for (double& lambda : multipliers) lambda *= share;
    for (Vec& turn : stage.turned) turn *= share;
    stages_.push_back(std::move(stage));
  }
}

void Multibody::assemble(Scene& scene) {
  const int linears = int(scene.linear_.size());
  const int rotations = int(scene.rotating_.size());
  const auto factors_of = [&](const Joints& joints, int joint) {
    std::vector<int> out;
    for (const Site s : joints.sites(joint)) {
      const auto& p = scene.sites_[std::size_t(s.index)];
      if (p.linear >= 0) out.push_back(p.linear);
      if (p.rotation >= 0) out.push_back(linears + p.rotation);
    }
    for (const Attitude a : joints.attitudes(joint))
      if (a.index >= 0) out.push_back(linears + a.index);
    return out;
  };

  // Islands, in the order of their first bodies.
  Groups groups(linears + rotations);
  std::vector<int> island_of(std::size_t(linears + rotations), -1);
  std::vector<char> tied(std::size_t(linears + rotations), 0);
  for (const auto& joints : scene.joints_)
    for (int j = 0; j < joints->count(); ++j) {
      const auto factors = factors_of(*joints, j);
      for (const int f : factors) {
        groups.join(f, factors.front());
        tied[std::size_t(f)] = 1;
      }
    }
  std::vector<int> named(std::size_t(linears + rotations), -1);
  int islands = 0;
  for (int f = 0; f < linears + rotations; ++f) {
    if (!tied[std::size_t(f)]) continue;
    int& name = named[std::size_t(groups.of(f))];
    if (name < 0) name = islands++;
    island_of[std::size_t(f)] = name;
  }
  islands_.resize(std::size_t(islands));

  // Factors, sorted.
  const std::vector<int> linear_islands(island_of.begin(), island_of.begin() + linears);
  const std::vector<int> rotation_islands(island_of.begin() + linears, island_of.end());
  const auto linear_order = sorted_by(linear_islands);
  const auto rotation_order = sorted_by(rotation_islands);
  const auto linear_place = inverse(linear_order);
  const auto island_range = [&](const std::vector<int>& island_in_order, Range Island::*range) {
    for (int i = 0; i < int(island_in_order.size()); ++i) {
      const int k = island_in_order[std::size_t(i)];
      Range& r = (k < 0 ? free_ : islands_[std::size_t(k)]).*range;
      if (r.size() == 0) r.first = i;
      r.last = i + 1;
    }
  };
  island_range(in_order(linear_islands, linear_order), &Island::linear);
  island_range(in_order(rotation_islands, rotation_order), &Island::rotations);
  places_.attitudes = inverse(rotation_order);
  linear_places_ = linear_place;

  // Sites: places of linear factors, points fixed in bodies by island, the ground.
  const auto is_factor = [](const Scene::Point& p) { return p.linear >= 0 && p.base < 0; };
  const auto is_ground = [](const Scene::Point& p) { return p.linear < 0 && p.rotation < 0; };
  std::vector<int> touched_in(scene.sites_.size(), islands);
  for (const auto& joints : scene.joints_)
    for (int j = 0; j < joints->count(); ++j)
      if (const auto factors = factors_of(*joints, j); !factors.empty())
        for (const Site s : joints->sites(j))
          touched_in[std::size_t(s.index)] = island_of[std::size_t(factors.front())];
  int slot = linears;
  places_.sites.resize(scene.sites_.size());
  const auto site_order = sorted_by(touched_in);
  for (const int s : site_order) {
    const auto& p = scene.sites_[std::size_t(s)];
    if (is_factor(p)) {
      places_.sites[std::size_t(s)] = linear_place[std::size_t(p.linear)];
    } else if (!is_ground(p)) {
      places_.sites[std::size_t(s)] = slot++;
    }
  }
  now_.x.resize(scene.sites_.size(), Vec::Zero());
  now_.arm.resize(scene.sites_.size(), 0.0);
  for (std::size_t s = 0; s < scene.sites_.size(); ++s) {
    const auto& p = scene.sites_[s];
    if (!is_ground(p)) continue;
    now_.x[std::size_t(slot)] = p.place;
    if (!p.amplitude.isZero(0)) {
      now_.arm[std::size_t(slot)] = 2 * p.amplitude.norm();
      moving_.push_back({slot, p.place, p.amplitude, p.rate});
    }
    places_.sites[s] = slot++;
  }
  std::vector<int> arm_islands;
  std::vector<int> planar_arm_islands;
  for (const int s : site_order) {
    const auto& p = scene.sites_[std::size_t(s)];
    if (is_factor(p) || is_ground(p)) continue;
    const int island = touched_in[std::size_t(s)];
    const int at = places_.sites[std::size_t(s)];
    const int base = places_.sites[std::size_t(p.base)];
    now_.arm[std::size_t(at)] = p.place.norm();
    if (p.rotation >= 0) {
      arms_.push_back({at, base, places_.attitudes[std::size_t(p.rotation)], p.place});
      arm_islands.push_back(island == islands ? -1 : island);
    } else {
      planar_arms_.push_back({at, base, -1, p.place});
      planar_arm_islands.push_back(island == islands ? -1 : island);
    }
  }
  island_range(arm_islands, &Island::arms);
  island_range(planar_arm_islands, &Island::planar_arms);

  // What moves.
  for (const int i : linear_order) {
    const auto& l = scene.linear_[std::size_t(i)];
    const int f = int(inertia_.size());
    inertia_.push_back(l.inertia);
    planar_.push_back(l.planar);
    now_.x[std::size_t(f)] = l.place;
    momentum_.push_back(l.inertia.cwiseProduct(l.rate));
    if (!l.drag.isZero(0)) {
      dragged_.push_back({f, l.drag, {}});
      const int island = linear_islands[std::size_t(i)];
      Range& range = (island < 0 ? free_ : islands_[std::size_t(island)]).dragged;
      if (range.size() == 0) range.first = int(dragged_.size()) - 1;
      range.last = int(dragged_.size());
    }
  }
  for (const int i : rotation_order) {
    const auto& r = scene.rotating_[std::size_t(i)];
    const int k = int(moments_.size());
    moments_.push_back(r.inertia);
    turns_.push_back({{}, scene.rotation});
    turn_damping_.push_back(r.damping);
    quaternions_.push_back(r.attitude);
    now_.attitude.push_back(SO3::from_quaternion(r.attitude));
    spin_.push_back(r.inertia.cwiseProduct(r.rate));
    turned_before_.push_back(h_ * r.rate);
    if (!r.damping.isZero(0)) damped_turns_.push_back(k);
  }
  now_.attitude.push_back(Mat::Identity());
  response_.resize(inertia_.size());
  set_step(h_);
  next_quaternions_ = quaternions_;
  const auto zeros = [](std::size_t n) { return std::vector<Vec>(n, Vec::Zero()); };
  momentum_carry_ = place_carry_ = impulse_ = kicked_ = displacement_ = zeros(momentum_.size());
  spin_carry_ = spin_impulse_ = spin_kicked_ = spin_total_ = turned_ = turn_residual_ = zeros(spin_.size());
  turn_inverse_.resize(spin_.size());
  spin_size_.resize(spin_.size());
  turn_frame_.resize(spin_.size());
  loads_ = {zeros(now_.x.size()), zeros(now_.attitude.size())};

  // Joints by island, their rows and gradients.
  joints_ = std::move(scene.joints_);
  struct Touch {
    std::vector<Site> sites;
    std::vector<Attitude> attitudes;
  };
  std::vector<std::vector<Batch>> batches(islands_.size());
  std::vector<std::vector<std::vector<Touch>>> touches(islands_.size());
  for (const auto& joints : joints_) {
    std::vector<int> island;
    for (int j = 0; j < joints->count(); ++j) {
      const auto factors = factors_of(*joints, j);
      island.push_back(factors.empty() ? -1 : island_of[std::size_t(factors.front())]);
    }
    // Joints of what does not move have no rows.
    auto order = sorted_by(island);
    order.erase(order.begin(),
                std::find_if(order.begin(), order.end(), [&](int j) { return island[std::size_t(j)] >= 0; }));
    for (int k = 0; k < int(order.size()); ++k) {
      const int j = order[std::size_t(k)];
      const auto i = std::size_t(island[std::size_t(j)]);
      if (batches[i].empty() || batches[i].back().joints != joints.get()) {
        batches[i].push_back({joints.get(), joints->role(), k, 0, 0, 0});
        touches[i].emplace_back();
      }
      ++batches[i].back().count;
      touches[i].back().push_back({joints->sites(j), joints->attitudes(j)});
    }
    joints->reorder(order);
    joints->place(places_);
  }
  int row = 0;
  int gradient = 0;
  for (auto& of_island : batches)
    for (std::size_t b = 0; b < of_island.size(); ++b) {
      auto& batch = of_island[b];
      const auto& touch = touches[std::size_t(&of_island - batches.data())][b].front();
      batch.row = row;
      batch.gradient = gradient;
      row += batch.count * batch.joints->rows();
      gradient += batch.count * batch.joints->rows() * int(touch.sites.size() + touch.attitudes.size());
    }
  int further = gradient;  // gradients along turns, of what moves points fixed in bodies
  for (std::size_t i = 0; i < islands_.size(); ++i) {
    Island& island = islands_[i];
    const auto open = [](Range& r, std::size_t size) { r = {int(size), int(size)}; };
    open(island.batches, batches_.size());
    open(island.linear_entries, linear_entries_.size());
    open(island.rotation_entries, rotation_entries_.size());
    open(island.levers, levers_.size());
    open(island.planar_levers, planar_levers_.size());
    island.rows.first = batches[i].front().row;
    for (std::size_t b = 0; b < batches[i].size(); ++b) {
      const Batch& batch = batches[i][b];
      batches_.push_back(batch);
      island.vakonomic = island.vakonomic || batch.role == Role::vakonomic;
      const bool along_arrows = batch.joints->along_arrows();
      int at = batch.gradient;
      int r = batch.row;
      for (const Touch& touch : touches[i][b])
        for (int k = 0; k < batch.joints->rows(); ++k, ++r) {
          for (const Site s : touch.sites) {
            const auto& p = scene.sites_[std::size_t(s.index)];
            if (p.rotation >= 0) {
              const int rotation = places_.attitudes[std::size_t(p.rotation)];
              levers_.push_back({at, further, rotation, p.place});
              rotation_entries_.push_back({further++, rotation, r, batch.role, along_arrows});
            }
            if (p.linear >= 0) {
              const int body = linear_place[std::size_t(p.linear)];
              const bool planar = scene.linear_[std::size_t(p.linear)].planar && !is_factor(p);
              if (planar) planar_levers_.push_back({at, further, places_(s).index, body});
              linear_entries_.push_back({planar ? further++ : at, body, r, batch.role, along_arrows});
            }
            for (int m = 0; m < int(moving_.size()); ++m)
              if (moving_[std::size_t(m)].site == places_(s).index) {
                moving_entries_.push_back({at, r, m});
                island.moved = true;
              }
            ++at;
          }
          for (const Attitude a : touch.attitudes) {
            if (a.index >= 0) rotation_entries_.push_back({at, places_(a).index, r, batch.role, along_arrows});
            ++at;
          }
        }
      island.rows.last = r;
    }
    island.batches.last = int(batches_.size());
    island.linear_entries.last = int(linear_entries_.size());
    island.rotation_entries.last = int(rotation_entries_.size());
    island.levers.last = int(levers_.size());
    island.planar_levers.last = int(planar_levers_.size());
  }
  // An island's entries, by factor.
  for (const Island& island : islands_)
    std::stable_sort(linear_entries_.begin() + island.linear_entries.first,
                     linear_entries_.begin() + island.linear_entries.last,
                     [](const Entry& a, const Entry& b) { return a.factor < b.factor; });
  factor_entries_.assign(std::size_t(linears) + 1, 0);
  for (const Entry& e : linear_entries_) ++factor_entries_[std::size_t(e.factor) + 1];
  std::partial_sum(factor_entries_.begin(), factor_entries_.end(), factor_entries_.begin());
  gradients_ = next_gradients_ = zeros(std::size_t(further));
  linear_response_ = zeros(linear_entries_.size());
  rotation_response_ = rotation_gradient_ = zeros(rotation_entries_.size());
  multipliers_.assign(std::size_t(row), 0.0);
  values_ = right_ = multipliers_;
  precision_ = multipliers_;
  sizes_.resize(std::size_t(row));
  left_out_.assign(std::size_t(row), 0);
  roles_.assign(std::size_t(row), Role::holonomic);
  for (const Batch& batch : batches_) {
    has_arrow_rows_ = has_arrow_rows_ || batch.role == Role::nonholonomic || batch.role == Role::vakonomic;
    has_vakonomic_ = has_vakonomic_ || batch.role == Role::vakonomic;
    if (batch.role == Role::damping) softness_.resize(std::size_t(row), 0.0);
    const int rows = batch.joints->rows();
    for (int i = 0; i < batch.count * rows; ++i) {
      const auto at = std::size_t(batch.row + i);
      const int joint = batch.first + i / rows;
      roles_[at] = batch.role;
      if (batch.role == Role::damping) softness_[at] = 2 / batch.joints->damping(joint);
      multipliers_[at] = -batch.joints->multiplier(joint, i % rows);
    }
  }
  earlier_ = {multipliers_, multipliers_, multipliers_};
  accepted_precision_ = precision_;
  for (const Island& island : islands_) require_one_principle(island);
  if (has_vakonomic_) {
    drifts_ = gradients_;
    free_displacement_ = displacement_;
  }

  // Which products of gradients and responses make the matrices.
  for (Island& island : islands_) {
    const auto same_factor = [](const std::vector<Entry>& entries, const Range& range, const Range& factors,
                                const auto& visit) {
      std::vector<std::vector<int>> of(std::size_t(factors.size()));
      for (int e = range.first; e < range.last; ++e)
        of[std::size_t(entries[std::size_t(e)].factor - factors.first)].push_back(e);
      for (const auto& list : of)
        for (const int a : list)
          for (const int b : list) visit(a, b);
    };
    std::vector<std::pair<int, int>> pattern;
    const auto couple = [&](const std::vector<Entry>& entries) {
      return [&](int a, int b) {
        const int i = entries[std::size_t(a)].row - island.rows.first;
        const int j = entries[std::size_t(b)].row - island.rows.first;
        if (i < j) pattern.emplace_back(i, j);
      };
    };
    same_factor(linear_entries_, island.linear_entries, island.linear, couple(linear_entries_));
    same_factor(rotation_entries_, island.rotation_entries, island.rotations, couple(rotation_entries_));
    island.matrix = Elimination(island.rows.size(), pattern);
    const auto place_of = [&](const Entry& a, const Entry& b) {
      return island.matrix.index(a.row - island.rows.first, b.row - island.rows.first);
    };
    island.linear_pairs.first = int(linear_pairs_.size());
    same_factor(linear_entries_, island.linear_entries, island.linear, [&](int a, int b) {
      const Entry& left = linear_entries_[std::size_t(a)];
      linear_pairs_.push_back({left.gradient, left.row, b, place_of(left, linear_entries_[std::size_t(b)])});
    });
    island.linear_pairs.last = int(linear_pairs_.size());
    island.rotation_pairs.first = int(rotation_pairs_.size());
    same_factor(rotation_entries_, island.rotation_entries, island.rotations, [&](int a, int b) {
      const Entry& left = rotation_entries_[std::size_t(a)];
      rotation_pairs_.push_back({a, left.row, b, place_of(left, rotation_entries_[std::size_t(b)])});
    });
    island.rotation_pairs.last = int(rotation_pairs_.size());
  }

  // Effects, and the points fixed in bodies that they act on.
  std::vector<char> pushed(now_.x.size(), 0);
  for (auto& effect : scene.effects_) {
    for (const Site s : effect->sites()) pushed[std::size_t(places_(s).index)] = 1;
    effect->place(places_);
    effects_.push_back(std::move(effect));
  }
  for (const Arm& a : arms_)
    if (pushed[std::size_t(a.site)]) pushed_arms_.push_back(a);
  for (const Arm& a : planar_arms_)
    if (pushed[std::size_t(a.site)]) pushed_planar_arms_.push_back(a);
}

void Multibody::require_one_principle(const Island& island) const {
  if (!island.vakonomic) return;
  for (int row = island.rows.first; row < island.rows.last; ++row)
    if (role(row) == Role::nonholonomic || role(row) == Role::damping)
      throw std::domain_error("nonholonomic joints and dampers do not go together with vakonomic joints");
  if (island.dragged.size() > 0)
    throw std::domain_error("drag and deflection do not go together with vakonomic joints");
  for (int r = island.rotations.first; r < island.rotations.last; ++r)
    if (!turn_damping_[std::size_t(r)].isZero(0))
      throw std::domain_error("drag does not go together with vakonomic joints");
}

void Multibody::leave_out_dependent() {
  // Whether rows depend on others is a matter of geometry: neither masses nor units count. Gradients are taken in units
  // of the largest that moves the same factor.
  const auto weights = [&](const std::vector<Entry>& entries, std::size_t factors) {
    std::vector<double> unit(factors, 0.0);
    for (const Entry& e : entries) {
      const double size = gradients_[std::size_t(e.gradient)].squaredNorm();
      if (!std::isfinite(size)) throw std::invalid_argument("the gradient of a joint is not finite");
      if (size < std::numeric_limits<double>::min() && !gradients_[std::size_t(e.gradient)].isZero(0))
        throw std::invalid_argument("the gradient of a joint vanishes in round-off");
      unit[std::size_t(e.factor)] = std::max(unit[std::size_t(e.factor)], size);
    }
    std::vector<Vec> out;
    for (const double size : unit) out.push_back(Vec::Constant(size > 0 ? 1 / size : 0));
    return out;
  };
  const auto linear_weights = weights(linear_entries_, inertia_.size());
  const auto rotation_weights = weights(rotation_entries_, moments_.size());
  for (Island& island : islands_) {
    gather(
        island, linear_weights, rotation_weights, [](Role) { return true; }, island.matrix);
    for (int row = 0; row < island.rows.size(); ++row)  // dampers add to what they share with others
      if (role(island.rows.first + row) == Role::damping) island.matrix.value(island.matrix.index(row, row)) += 1;
    std::vector<char> moves_something(std::size_t(island.rows.size()));
    for (int row = 0; row < island.rows.size(); ++row)
      moves_something[std::size_t(row)] = island.matrix.value(island.matrix.index(row, row)) != 0;
    for (const int row : island.matrix.leave_out_dependent()) {
      left_out_[std::size_t(island.rows.first + row)] = 1;
      dependent_rows_ += moves_something[std::size_t(row)];
    }
  }
}

}  // namespace lagroid::multibody
