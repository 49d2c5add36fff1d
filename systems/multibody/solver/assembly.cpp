#include <lagroid/systems/multibody/solver/assembly.hpp>

#include <algorithm>
#include <iterator>
#include <numeric>
#include <stdexcept>
#include <utility>

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

class Assembly {
 public:
  Assembly(Scene scene, double h)
      : scene_(std::move(scene)), linears_(int(scene_.linear_.size())), rotations_(int(scene_.rotating_.size())) {
    start_.step = h;
    find_islands();
    sort_factors();
    place_sites();
    place_arms();
    add_linear_factors();
    add_rotations();
    clear_loads();
    add_joints();
    number_gradients();
    for (std::size_t i = 0; i < model_.islands.size(); ++i) add_entries(i);
    sort_entries();
    describe_rows();
    for (const Model::Island& island : model_.islands) require_one_principle(island);
    for (Model::Island& island : model_.islands) matrices_.push_back(couple_rows(island));
    add_effects();
  }
  Assembled take() { return {std::move(model_), std::move(start_), std::move(matrices_)}; }

 private:
  using Point = Scene::Point;
  struct Touch {
    std::vector<Site> sites;
    std::vector<Attitude> attitudes;
  };
  /// A batch, and what each of its joints touches.
  struct TouchingBatch {
    Model::Batch batch;
    std::vector<Touch> touches;
  };

  static bool is_factor(const Point& p) { return p.linear >= 0 && p.base < 0; }
  static bool is_ground(const Point& p) { return p.linear < 0 && p.rotation < 0; }
  const Point& point(Site s) const { return scene_.sites_[std::size_t(s.index)]; }

  std::vector<int> factors_of(const Joints& joints, int joint) const;
  /// The island of a joint; -1 where it touches nothing that moves.
  int island_of(const Joints& joints, int joint) const;
  Model::Island& island(int number) { return number < 0 ? model_.free : model_.islands[std::size_t(number)]; }
  /// Ranges of the islands in a list that is sorted by island.
  void set_ranges(const std::vector<int>& island_in_order, Model::Range Model::Island::*range);

  void find_islands();
  void sort_factors();
  void place_sites();
  void place_arms();
  void add_linear_factors();
  void add_rotations();
  void clear_loads();
  void add_joints();
  void number_gradients();
  void add_entries(std::size_t number);
  void add_entries(const Touch& touch, const Model::Batch& batch, int row, int gradient, Model::Island& island);
  void sort_entries();
  void describe_rows();
  void require_one_principle(const Model::Island& island) const;
  /// Which products of gradients and responses make an island's matrix.
  Elimination couple_rows(Model::Island& island);
  void add_effects();

  Scene scene_;
  int linears_;
  int rotations_;
  std::vector<int> islands_of_factors_;  ///< linear ones, then rotations
  std::vector<int> linear_order_, rotation_order_, site_order_;
  std::vector<int> touched_in_;                      ///< the island of a site; past the last where no joint touches it
  std::vector<std::vector<TouchingBatch>> batches_;  ///< of each island
  Model model_;
  SceneState start_;
  std::vector<Elimination> matrices_;
};

Assembled assemble(Scene scene, double h) { return Assembly(std::move(scene), h).take(); }

std::vector<int> Assembly::factors_of(const Joints& joints, int joint) const {
  std::vector<int> out;
  for (const Site s : joints.sites(joint)) {
    const Point& p = point(s);
    if (p.linear >= 0) out.push_back(p.linear);
    if (p.rotation >= 0) out.push_back(linears_ + p.rotation);
  }
  for (const Attitude a : joints.attitudes(joint))
    if (a.index >= 0) out.push_back(linears_ + a.index);
  return out;
}

int Assembly::island_of(const Joints& joints, int joint) const {
  const auto factors = factors_of(joints, joint);
  return factors.empty() ? -1 : islands_of_factors_[std::size_t(factors.front())];
}

void Assembly::set_ranges(const std::vector<int>& island_in_order, Model::Range Model::Island::*range) {
  for (int i = 0; i < int(island_in_order.size()); ++i) {
    Model::Range& r = island(island_in_order[std::size_t(i)]).*range;
    if (r.size() == 0) r.first = i;
    r.last = i + 1;
  }
}

// Islands are numbered in the order of their first bodies.
void Assembly::find_islands() {
  const auto factors_count = std::size_t(linears_ + rotations_);
  Groups groups(linears_ + rotations_);
  std::vector<char> tied(factors_count, 0);
  for (const auto& of_kind : scene_.joints_)
    for (int j = 0; j < of_kind.all->count(); ++j) {
      const auto factors = factors_of(*of_kind.all, j);
      for (const int f : factors) {
        groups.join(f, factors.front());
        tied[std::size_t(f)] = 1;
      }
    }
  islands_of_factors_.assign(factors_count, -1);
  std::vector<int> named(factors_count, -1);
  int islands = 0;
  for (int f = 0; f < linears_ + rotations_; ++f) {
    if (!tied[std::size_t(f)]) continue;
    int& name = named[std::size_t(groups.of(f))];
    if (name < 0) name = islands++;
    islands_of_factors_[std::size_t(f)] = name;
  }
  model_.islands.resize(std::size_t(islands));
}

void Assembly::sort_factors() {
  const std::vector<int> of_linear(islands_of_factors_.begin(), islands_of_factors_.begin() + linears_);
  const std::vector<int> of_rotations(islands_of_factors_.begin() + linears_, islands_of_factors_.end());
  linear_order_ = sorted_by(of_linear);
  rotation_order_ = sorted_by(of_rotations);
  set_ranges(in_order(of_linear, linear_order_), &Model::Island::linear);
  set_ranges(in_order(of_rotations, rotation_order_), &Model::Island::rotations);
  model_.linear_places = inverse(linear_order_);
  model_.places.attitudes = inverse(rotation_order_);
}

// Places of linear factors, then points fixed in bodies by island, then the ground.
void Assembly::place_sites() {
  const std::size_t count = scene_.sites_.size();
  touched_in_.assign(count, int(model_.islands.size()));
  for (const auto& of_kind : scene_.joints_)
    for (int j = 0; j < of_kind.all->count(); ++j)
      if (const int number = island_of(*of_kind.all, j); number >= 0)
        for (const Site s : of_kind.all->sites(j)) touched_in_[std::size_t(s.index)] = number;
  site_order_ = sorted_by(touched_in_);

  std::vector<int>& places = model_.places.sites;
  places.resize(count);
  int slot = linears_;
  for (const int s : site_order_) {
    const Point& p = point({s});
    if (is_factor(p)) {
      places[std::size_t(s)] = model_.linear_places[std::size_t(p.linear)];
    } else if (!is_ground(p)) {
      places[std::size_t(s)] = slot++;
    }
  }
  start_.at.x.resize(count, Vec::Zero());
  start_.at.arm.resize(count, 0.0);
  for (std::size_t s = 0; s < count; ++s) {
    const Point& p = scene_.sites_[s];
    if (!is_ground(p)) continue;
    start_.at.x[std::size_t(slot)] = p.place;
    if (!p.amplitude.isZero(0)) {
      start_.at.arm[std::size_t(slot)] = 2 * p.amplitude.norm();
      model_.points.moving.push_back({slot, p.place, p.amplitude, p.rate});
    }
    places[s] = slot++;
  }
}

void Assembly::place_arms() {
  const Places& places = model_.places;
  std::vector<int> islands, planar_islands;
  for (const int s : site_order_) {
    const Point& p = point({s});
    if (is_factor(p) || is_ground(p)) continue;
    const int touched = touched_in_[std::size_t(s)];
    const int number = touched == int(model_.islands.size()) ? -1 : touched;
    const int at = places.sites[std::size_t(s)];
    const int base = places.sites[std::size_t(p.base)];
    start_.at.arm[std::size_t(at)] = p.place.norm();
    if (p.rotation >= 0) {
      model_.points.arms.push_back({at, base, places.attitudes[std::size_t(p.rotation)], p.place});
      islands.push_back(number);
    } else {
      model_.points.planar_arms.push_back({at, base, -1, p.place});
      planar_islands.push_back(number);
    }
  }
  set_ranges(islands, &Model::Island::arms);
  set_ranges(planar_islands, &Model::Island::planar_arms);
}

void Assembly::add_linear_factors() {
  Model::Factors& factors = model_.factors;
  std::vector<int> islands;  // of those with drag
  for (const int i : linear_order_) {
    const auto& l = scene_.linear_[std::size_t(i)];
    const int f = int(factors.inertia.size());
    factors.inertia.push_back(l.inertia);
    factors.planar.push_back(l.planar);
    start_.at.x[std::size_t(f)] = l.place;
    start_.momentum.push_back(l.inertia.cwiseProduct(l.rate));
    if (l.drag.isZero(0)) continue;
    factors.dragged.push_back({f, l.drag});
    islands.push_back(islands_of_factors_[std::size_t(i)]);
  }
  set_ranges(islands, &Model::Island::dragged);
  start_.momentum_compensation = start_.place_compensation = std::vector<Vec>(start_.momentum.size(), Vec::Zero());
}

void Assembly::add_rotations() {
  Model::Factors& factors = model_.factors;
  factors.rotation = scene_.rotation;
  for (const int i : rotation_order_) {
    const auto& r = scene_.rotating_[std::size_t(i)];
    const int k = int(factors.moments.size());
    factors.moments.push_back(r.inertia);
    factors.turn_damping.push_back(r.damping);
    start_.attitude.push_back(r.attitude);
    start_.spin.push_back(r.inertia.cwiseProduct(r.rate));
    start_.guess.turns.push_back(start_.step * r.rate);
    if (!r.damping.isZero(0)) factors.damped_turns.push_back(k);
  }
  start_.at.attitude.assign(start_.spin.size() + 1, Mat::Identity());
  start_.spin_compensation = std::vector<Vec>(start_.spin.size(), Vec::Zero());
}

void Assembly::clear_loads() {
  start_.loads = {std::vector<Vec>(start_.at.x.size(), Vec::Zero()),
                  std::vector<Vec>(start_.at.attitude.size(), Vec::Zero())};
}

// Joints of what does not move have no rows.
void Assembly::add_joints() {
  batches_.resize(model_.islands.size());
  for (auto& [all, kind, switched_by] : scene_.joints_) {
    Joints* const joints = model_.joints.emplace_back(std::move(all)).get();
    std::vector<int> islands;
    for (int j = 0; j < joints->count(); ++j) islands.push_back(island_of(*joints, j));
    auto order = sorted_by(islands);
    order.erase(order.begin(),
                std::find_if(order.begin(), order.end(), [&](int j) { return islands[std::size_t(j)] >= 0; }));
    for (int k = 0; k < int(order.size()); ++k) {
      const int j = order[std::size_t(k)];
      auto& of_island = batches_[std::size_t(islands[std::size_t(j)])];
      if (of_island.empty() || of_island.back().batch.joints != joints)
        of_island.push_back({{joints, joints->role(), k, 0, 0, 0, switched_by}, {}});
      ++of_island.back().batch.count;
      of_island.back().touches.push_back({joints->sites(j), joints->attitudes(j)});
    }
    joints->reorder(order);
    joints->place(model_.places);
  }
}

void Assembly::number_gradients() {
  int row = 0;
  int gradient = 0;
  for (auto& of_island : batches_)
    for (auto& [batch, touches] : of_island) {
      batch.row = row;
      batch.gradient = gradient;
      const int rows = batch.count * batch.joints->rows();
      row += rows;
      gradient += rows * int(touches.front().sites.size() + touches.front().attitudes.size());
    }
  model_.rows.roles.assign(std::size_t(row), Role::holonomic);
  model_.rows.gradients = gradient;
}

void Assembly::add_entries(std::size_t number) {
  Model::Island& island = model_.islands[number];
  Model::Rows& rows = model_.rows;
  const auto open = [](Model::Range& r, const auto& list) { r.first = int(list.size()); };
  const auto close = [](Model::Range& r, const auto& list) { r.last = int(list.size()); };
  const auto bound = [&](const auto& set) {
    set(island.batches, rows.batches);
    set(island.linear_entries, rows.linear_entries);
    set(island.rotation_entries, rows.rotation_entries);
    set(island.levers, rows.levers);
    set(island.planar_levers, rows.planar_levers);
  };
  bound(open);
  island.rows.first = batches_[number].front().batch.row;
  for (const auto& [batch, touches] : batches_[number]) {
    rows.batches.push_back(batch);
    island.vakonomic = island.vakonomic || batch.role == Role::vakonomic;
    int gradient = batch.gradient;
    int row = batch.row;
    for (const Touch& touch : touches)
      for (int k = 0; k < batch.joints->rows(); ++k) {
        add_entries(touch, batch, row++, gradient, island);
        gradient += int(touch.sites.size() + touch.attitudes.size());
      }
    island.rows.last = row;
  }
  bound(close);
}

// Gradients along turns, of what moves points fixed in bodies, come after those that joints write.
void Assembly::add_entries(const Touch& touch, const Model::Batch& batch, int row, int gradient,
                           Model::Island& island) {
  Model::Rows& rows = model_.rows;
  const bool along_arrows = batch.joints->along_arrows();
  for (const Site s : touch.sites) {
    const Point& p = point(s);
    const int at = model_.places(s).index;
    if (p.rotation >= 0) {
      const int rotation = model_.places.attitudes[std::size_t(p.rotation)];
      rows.levers.push_back({gradient, rows.gradients, rotation, p.place});
      rows.rotation_entries.push_back({rows.gradients++, rotation, row, batch.role, along_arrows});
    }
    if (p.linear >= 0) {
      const int body = model_.linear_places[std::size_t(p.linear)];
      const bool planar = scene_.linear_[std::size_t(p.linear)].planar && !is_factor(p);
      if (planar) rows.planar_levers.push_back({gradient, rows.gradients, at, body});
      rows.linear_entries.push_back({planar ? rows.gradients++ : gradient, body, row, batch.role, along_arrows});
    }
    const auto& moving = model_.points.moving;
    for (int m = 0; m < int(moving.size()); ++m)
      if (moving[std::size_t(m)].site == at) {
        rows.moving_entries.push_back({gradient, row, m});
        island.moved = true;
      }
    ++gradient;
  }
  for (const Attitude a : touch.attitudes) {
    if (a.index >= 0)
      rows.rotation_entries.push_back({gradient, model_.places(a).index, row, batch.role, along_arrows});
    ++gradient;
  }
}

// An island's entries, by factor.
void Assembly::sort_entries() {
  auto& entries = model_.rows.linear_entries;
  for (const Model::Island& island : model_.islands)
    std::stable_sort(entries.begin() + island.linear_entries.first, entries.begin() + island.linear_entries.last,
                     [](const Model::Entry& a, const Model::Entry& b) { return a.factor < b.factor; });
  auto& begins = model_.rows.factor_entries;
  begins.assign(std::size_t(linears_) + 1, 0);
  for (const Model::Entry& e : entries) ++begins[std::size_t(e.factor) + 1];
  std::partial_sum(begins.begin(), begins.end(), begins.begin());
}

void Assembly::describe_rows() {
  Model::Rows& rows = model_.rows;
  const std::size_t count = rows.roles.size();
  std::vector<double> multipliers(count, 0.0);
  rows.left_out.assign(count, 0);
  for (const Model::Batch& batch : rows.batches) {
    rows.on_arrows = rows.on_arrows || batch.role == Role::nonholonomic || batch.role == Role::vakonomic;
    rows.vakonomic = rows.vakonomic || batch.role == Role::vakonomic;
    if (batch.role == Role::damping) rows.compliance.resize(count, 0.0);
    const int of_joint = batch.joints->rows();
    for (int i = 0; i < batch.count * of_joint; ++i) {
      const auto at = std::size_t(batch.row + i);
      const int joint = batch.first + i / of_joint;
      rows.roles[at] = batch.role;
      if (batch.role == Role::damping) rows.compliance[at] = 2 / batch.joints->damping(joint);
      multipliers[at] = -batch.joints->multiplier(joint, i % of_joint);
    }
  }
  start_.guess.multipliers = {multipliers, multipliers, multipliers};
  start_.gradients.assign(std::size_t(rows.gradients), Vec::Zero());
  start_.sizes.resize(count);
  start_.precision.assign(count, 0.0);
}

void Assembly::require_one_principle(const Model::Island& island) const {
  if (!island.vakonomic) return;
  for (const Role role : island.rows.of(model_.rows.roles))
    if (role == Role::nonholonomic || role == Role::damping)
      throw std::domain_error("nonholonomic joints and dampers do not go together with vakonomic joints");
  if (island.dragged.size() > 0)
    throw std::domain_error("drag and gyroscopic forces do not go together with vakonomic joints");
  for (const Vec& damping : island.rotations.of(model_.factors.turn_damping))
    if (!damping.isZero(0)) throw std::domain_error("drag does not go together with vakonomic joints");
}

Elimination Assembly::couple_rows(Model::Island& island) {
  using Entries = std::vector<Model::Entry>;
  Model::Rows& rows = model_.rows;
  const int first = island.rows.first;
  const auto same_factor = [](const Entries& entries, const Model::Range& range, const Model::Range& factors,
                              const auto& visit) {
    std::vector<std::vector<int>> of(std::size_t(factors.size()));
    for (int e = range.first; e < range.last; ++e)
      of[std::size_t(entries[std::size_t(e)].factor - factors.first)].push_back(e);
    for (const auto& list : of)
      for (const int a : list)
        for (const int b : list) visit(a, b);
  };
  const auto each_pair = [&](const auto& visit_linear, const auto& visit_rotation) {
    same_factor(rows.linear_entries, island.linear_entries, island.linear, visit_linear);
    same_factor(rows.rotation_entries, island.rotation_entries, island.rotations, visit_rotation);
  };
  std::vector<std::pair<int, int>> pattern;
  const auto couple = [&](const Entries& entries) {
    return [&](int a, int b) {
      const int i = entries[std::size_t(a)].row - first;
      const int j = entries[std::size_t(b)].row - first;
      if (i < j) pattern.emplace_back(i, j);
    };
  };
  each_pair(couple(rows.linear_entries), couple(rows.rotation_entries));
  const Elimination matrix(island.rows.size(), pattern);

  island.linear_products.first = int(rows.linear_products.size());
  island.rotation_products.first = int(rows.rotation_products.size());
  each_pair(
      [&](int a, int b) {
        const Model::Entry& left = rows.linear_entries[std::size_t(a)];
        const int right = rows.linear_entries[std::size_t(b)].row;
        rows.linear_products.push_back({left.gradient, left.row, b, matrix.index(left.row - first, right - first)});
      },
      [&](int a, int b) {
        const int left = rows.rotation_entries[std::size_t(a)].row;
        const int right = rows.rotation_entries[std::size_t(b)].row;
        rows.rotation_products.push_back({a, left, b, matrix.index(left - first, right - first)});
      });
  island.linear_products.last = int(rows.linear_products.size());
  island.rotation_products.last = int(rows.rotation_products.size());
  return matrix;
}

void Assembly::add_effects() {
  model_.switches = std::move(scene_.switches_);
  std::vector<char> pushed(start_.at.x.size(), 0);
  for (auto& [all, kind, switched_by] : scene_.effects_) {
    for (const Site s : all->sites()) pushed[std::size_t(model_.places(s).index)] = 1;
    all->place(model_.places);
    model_.effects.push_back({std::move(all), switched_by});
  }
  const auto keep_pushed = [&](const std::vector<Model::Arm>& all, std::vector<Model::Arm>& out) {
    std::copy_if(all.begin(), all.end(), std::back_inserter(out),
                 [&](const Model::Arm& a) { return pushed[std::size_t(a.site)] != 0; });
  };
  keep_pushed(model_.points.arms, model_.points.pushed_arms);
  keep_pushed(model_.points.planar_arms, model_.points.pushed_planar_arms);
}

}  // namespace lagroid::multibody
