#include <lagroid/systems/multibody/solver/assembly.hpp>

#include <lagroid/core/derivatives/varied_directions.hpp>
#include <lagroid/systems/multibody/control/second_number.hpp>
#include <lagroid/systems/multibody/solver/orders.hpp>

#include <algorithm>
#include <numeric>
#include <stdexcept>
#include <utility>

namespace lagroid::multibody {

template <class S> class Assembly {
 public:
  using Model = BasicModel<S>;
  using Island = typename Model::Island;
  using Range = typename Model::Range;
  using Batch = typename Model::Batch;
  using Entry = typename Model::Entry;
  using Arm = typename Model::Arm;

  Assembly(BasicScene<S> scene, double h)
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
    for (const Island& island : model_.islands) require_one_principle(island);
    for (Island& island : model_.islands) matrices_.push_back(couple_rows(island));
    add_effects();
  }
  BasicAssembled<S> take() { return {std::move(model_), std::move(start_), std::move(matrices_)}; }

 private:
  using Point = typename BasicScene<S>::Point;
  struct Touch {
    std::vector<Site> sites;
    std::vector<Attitude> attitudes;
  };
  /// A batch, and what each of its joints touches.
  struct TouchingBatch {
    Batch batch;
    std::vector<Touch> touches;
  };

  static bool is_factor(const Point& p) { return p.linear >= 0 && p.base < 0; }
  static bool is_ground(const Point& p) { return p.linear < 0 && p.rotation < 0; }
  const Point& point(Site s) const { return scene_.sites_[std::size_t(s.index)]; }

  std::vector<int> factors_of(const BasicJoints<S>& joints, int joint) const;
  /// The island of a joint; -1 where it touches nothing that moves.
  int island_of(const BasicJoints<S>& joints, int joint) const;
  Island& island(int number) { return number < 0 ? model_.free : model_.islands[std::size_t(number)]; }
  /// Ranges of the islands in a list that is sorted by island.
  void set_ranges(const std::vector<int>& island_in_order, Range Island::*range);

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
  void add_entries(const Touch& touch, const Batch& batch, int row, int gradient, Island& island);
  void sort_entries();
  void describe_rows();
  void require_one_principle(const Island& island) const;
  /// Which products of gradients and responses make an island's matrix.
  Elimination couple_rows(Island& island);
  void add_effects();

  BasicScene<S> scene_;
  int linears_;
  int rotations_;
  std::vector<int> islands_of_factors_;  ///< linear ones, then rotations
  std::vector<int> linear_order_, rotation_order_, site_order_;
  std::vector<int> touched_in_;                      ///< the island of a site; past the last where no joint touches it
  std::vector<std::vector<TouchingBatch>> batches_;  ///< of each island
  Model model_;
  BasicSceneState<S> start_;
  std::vector<Elimination> matrices_;
};

template <class S> BasicAssembled<S> assemble(BasicScene<S> scene, double h) {
  return Assembly<S>(std::move(scene), h).take();
}

template <class S> std::vector<int> Assembly<S>::factors_of(const BasicJoints<S>& joints, int joint) const {
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

template <class S> int Assembly<S>::island_of(const BasicJoints<S>& joints, int joint) const {
  const auto factors = factors_of(joints, joint);
  return factors.empty() ? -1 : islands_of_factors_[std::size_t(factors.front())];
}

template <class S> void Assembly<S>::set_ranges(const std::vector<int>& island_in_order, Range Island::*range) {
  for (int i = 0; i < int(island_in_order.size()); ++i) {
    Range& r = island(island_in_order[std::size_t(i)]).*range;
    if (r.size() == 0) r.first = i;
    r.last = i + 1;
  }
}

// Islands are numbered in the order of their first bodies.
template <class S> void Assembly<S>::find_islands() {
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

template <class S> void Assembly<S>::sort_factors() {
  const std::vector<int> of_linear(islands_of_factors_.begin(), islands_of_factors_.begin() + linears_);
  const std::vector<int> of_rotations(islands_of_factors_.begin() + linears_, islands_of_factors_.end());
  linear_order_ = sorted_by(of_linear);
  rotation_order_ = sorted_by(of_rotations);
  set_ranges(in_order(of_linear, linear_order_), &Island::linear);
  set_ranges(in_order(of_rotations, rotation_order_), &Island::rotations);
  model_.linear_places = inverse(linear_order_);
  model_.places.attitudes = inverse(rotation_order_);
}

// Places of linear factors, then points fixed in bodies by island, then the ground.
template <class S> void Assembly<S>::place_sites() {
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
  start_.at.x.resize(count, Vector<S, 3>::Zero());
  start_.at.arm.resize(count, 0.0);
  for (std::size_t s = 0; s < count; ++s) {
    const Point& p = scene_.sites_[s];
    if (!is_ground(p)) continue;
    start_.at.x[std::size_t(slot)] = p.place;
    if (!stays_zero(p.amplitude)) {
      start_.at.arm[std::size_t(slot)] = 2 * values_of(p.amplitude).norm();
      model_.points.moving.push_back({slot, p.place, p.amplitude, p.rate});
    }
    places[s] = slot++;
  }
}

template <class S> void Assembly<S>::place_arms() {
  const Places& places = model_.places;
  std::vector<int> islands, planar_islands;
  for (const int s : site_order_) {
    const Point& p = point({s});
    if (is_factor(p) || is_ground(p)) continue;
    const int touched = touched_in_[std::size_t(s)];
    const int number = touched == int(model_.islands.size()) ? -1 : touched;
    const int at = places.sites[std::size_t(s)];
    const int base = places.sites[std::size_t(p.base)];
    start_.at.arm[std::size_t(at)] = values_of(p.place).norm();
    if (p.rotation >= 0) {
      model_.points.arms.push_back({at, base, places.attitudes[std::size_t(p.rotation)], p.place});
      islands.push_back(number);
    } else {
      model_.points.planar_arms.push_back({at, base, -1, p.place});
      planar_islands.push_back(number);
    }
  }
  set_ranges(islands, &Island::arms);
  set_ranges(planar_islands, &Island::planar_arms);
}

template <class S> void Assembly<S>::add_linear_factors() {
  typename Model::Factors& factors = model_.factors;
  std::vector<int> islands;  // of those with drag
  for (const int i : linear_order_) {
    const auto& l = scene_.linear_[std::size_t(i)];
    const int f = int(factors.inertia.size());
    factors.inertia.push_back(l.inertia);
    factors.planar.push_back(l.planar);
    start_.at.x[std::size_t(f)] = l.place;
    start_.momentum.push_back(l.inertia.cwiseProduct(l.rate));
    if (stays_zero(l.drag)) continue;
    factors.dragged.push_back({f, l.drag});
    islands.push_back(islands_of_factors_[std::size_t(i)]);
  }
  set_ranges(islands, &Island::dragged);
  start_.momentum_compensation = start_.place_compensation =
      std::vector<Vector<S, 3>>(start_.momentum.size(), Vector<S, 3>::Zero());
}

template <class S> void Assembly<S>::add_rotations() {
  typename Model::Factors& factors = model_.factors;
  factors.rotation = scene_.rotation;
  for (const int i : rotation_order_) {
    const auto& r = scene_.rotating_[std::size_t(i)];
    const int k = int(factors.moments.size());
    factors.moments.push_back(r.inertia);
    factors.turn_damping.push_back(r.damping);
    start_.attitude.push_back(r.attitude);
    start_.spin.push_back(r.inertia.cwiseProduct(r.rate));
    start_.guess.turns.push_back(start_.step * r.rate);
    if (!stays_zero(r.damping)) factors.damped_turns.push_back(k);
  }
  start_.at.attitude.assign(start_.spin.size() + 1, Matrix<S, 3, 3>::Identity());
  start_.spin_compensation = std::vector<Vector<S, 3>>(start_.spin.size(), Vector<S, 3>::Zero());
}

template <class S> void Assembly<S>::clear_loads() {
  start_.loads = {std::vector<Vector<S, 3>>(start_.at.x.size(), Vector<S, 3>::Zero()),
                  std::vector<Vector<S, 3>>(start_.at.attitude.size(), Vector<S, 3>::Zero())};
}

// Joints of what does not move have no rows.
template <class S> void Assembly<S>::add_joints() {
  batches_.resize(model_.islands.size());
  for (auto& [all, kind, switched_by] : scene_.joints_) {
    BasicJoints<S>* const joints = model_.joints.emplace_back(std::move(all)).get();
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

template <class S> void Assembly<S>::number_gradients() {
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

template <class S> void Assembly<S>::add_entries(std::size_t number) {
  Island& island = model_.islands[number];
  typename Model::Rows& rows = model_.rows;
  const auto open = [](Range& r, const auto& list) { r.first = int(list.size()); };
  const auto close = [](Range& r, const auto& list) { r.last = int(list.size()); };
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
template <class S>
void Assembly<S>::add_entries(const Touch& touch, const Batch& batch, int row, int gradient, Island& island) {
  typename Model::Rows& rows = model_.rows;
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
template <class S> void Assembly<S>::sort_entries() {
  auto& entries = model_.rows.linear_entries;
  for (const Island& island : model_.islands)
    std::stable_sort(entries.begin() + island.linear_entries.first, entries.begin() + island.linear_entries.last,
                     [](const Entry& a, const Entry& b) { return a.factor < b.factor; });
  auto& begins = model_.rows.factor_entries;
  begins.assign(std::size_t(linears_) + 1, 0);
  for (const Entry& e : entries) ++begins[std::size_t(e.factor) + 1];
  std::partial_sum(begins.begin(), begins.end(), begins.begin());
}

template <class S> void Assembly<S>::describe_rows() {
  typename Model::Rows& rows = model_.rows;
  const std::size_t count = rows.roles.size();
  std::vector<S> multipliers(count, S(0));
  rows.left_out.assign(count, 0);
  for (const Batch& batch : rows.batches) {
    rows.on_arrows = rows.on_arrows || batch.role == Role::nonholonomic || batch.role == Role::vakonomic;
    rows.vakonomic = rows.vakonomic || batch.role == Role::vakonomic;
    if (batch.role == Role::damping) rows.compliance.resize(count, S(0));
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
  start_.gradients.assign(std::size_t(rows.gradients), Vector<S, 3>::Zero());
  start_.sizes.resize(count);
  start_.precision.assign(count, 0.0);
}

template <class S> void Assembly<S>::require_one_principle(const Island& island) const {
  if (!island.vakonomic) return;
  for (const Role role : island.rows.of(model_.rows.roles))
    if (role == Role::nonholonomic || role == Role::damping)
      throw std::domain_error("nonholonomic joints and dampers do not go together with vakonomic joints");
  if (island.dragged.size() > 0)
    throw std::domain_error("drag and gyroscopic forces do not go together with vakonomic joints");
  for (const Vector<S, 3>& damping : island.rotations.of(model_.factors.turn_damping))
    if (!stays_zero(damping)) throw std::domain_error("drag does not go together with vakonomic joints");
}

template <class S> Elimination Assembly<S>::couple_rows(Island& island) {
  using Entries = std::vector<Entry>;
  typename Model::Rows& rows = model_.rows;
  const int first = island.rows.first;
  const auto same_factor = [](const Entries& entries, const Range& range, const Range& factors, const auto& visit) {
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
        const Entry& left = rows.linear_entries[std::size_t(a)];
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

template <class S> void Assembly<S>::add_effects() {
  model_.switches = std::move(scene_.switches_);
  std::vector<char> pushed(start_.at.x.size(), 0);
  for (auto& [all, kind, switched_by] : scene_.effects_) {
    for (const Site s : all->sites()) pushed[std::size_t(model_.places(s).index)] = 1;
    all->place(model_.places);
    model_.effects.push_back({std::move(all), switched_by});
  }
  const auto keep_pushed = [&](const std::vector<Arm>& all, std::vector<Arm>& out) {
    std::copy_if(all.begin(), all.end(), std::back_inserter(out),
                 [&](const Arm& a) { return pushed[std::size_t(a.site)] != 0; });
  };
  keep_pushed(model_.points.arms, model_.points.pushed_arms);
  keep_pushed(model_.points.planar_arms, model_.points.pushed_planar_arms);
}

template BasicAssembled<double> assemble(Scene, double);
template BasicAssembled<VariedNumber> assemble(BasicScene<VariedNumber>, double);
template BasicAssembled<SecondNumber> assemble(BasicScene<SecondNumber>, double);

}  // namespace lagroid::multibody
