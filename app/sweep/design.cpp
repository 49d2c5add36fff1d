#include "design.hpp"

#include "work/member_list.hpp"

#include <fmt/format.h>
#include <boost/math/distributions/normal.hpp>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <functional>
#include <numbers>
#include <numeric>
#include <random>
#include <utility>

namespace lagroid::app {

namespace {

constexpr long most_members = 100'000'000;

const KeyOf<Text> path_key{"key", {}, "", "a number of the scene, as in \"initial.momentum.0\""};
const KeyOf<OneOf> scale{"scale", {{"linear", "log"}}, "", "in which the range is evenly filled", "linear"};
const KeyOf<Number> from_key{"from", {}, "", "the first of the range; positive where the scale is log"};
const KeyOf<Number> to_key{"to", {}, "", "the last of the range; positive where the scale is log"};
const KeyOf<Whole> count_on_grid{"count", {1, most_members}, "", "numbers on the grid"};
const KeyOf<NumberList> values_key{"values", {}, "", "the numbers that it takes"};
const KeyOf<Number> mean{"mean", {}, "", "of a normal distribution"};
const KeyOf<Number> deviation{"deviation", {positive}, "", "of a normal distribution"};
const std::string on_sphere = "sphere";
const std::string of_attitudes = "attitude";
KeyOf<OneOf> distribution_key(std::vector<std::string> words) {
  return {"distribution", {std::move(words)}, "", "uniform: a vector on a sphere, or a unit quaternion"};
}
const KeyOf<Number> radius_key{"radius", {positive}, "", "of the sphere", 1.0};

const std::string grid_design = "grid";
const std::string latin_hypercube = "latin-hypercube";
const std::string list_of_members = "list";
KeyOf<OneOf> kind_key(std::vector<std::string> words) {
  return {"kind", {std::move(words)}, "", "how members are laid out"};
}
const KeyOf<Whole> member_count{"count", {1, most_members}, "", "members"};
const KeyOf<Whole> seed_key{"seed", {0, 2147483647}, "", "of what is drawn", 1};

/// How one key varies: which numbers it has at points of the unit cube, and on a grid.
struct Variation {
  Section section;
  Design::Key key;
  std::size_t dimensions = 1;  ///< of the cube
  std::function<void(const double* uniform, double* out)> at;
  long count = 0;  ///< of the numbers on a grid
  std::function<double(long)> on_grid;
};

/// The columns of a key that stands for `size` numbers of the scene; `said` is where the sweep names it.
std::vector<std::string> columns_of(const Section& at, const char* said, const std::string& path, std::size_t size,
                                    const Section& scene) {
  const std::size_t there = scene.numbers_at(path).size();
  if (there == 0)
    at.fail(said, fmt::format("\"{}\" is no number of the scene, nor an array of them; write it there, with any number",
                              path));
  // An attitude may be written as a rotation vector, and be varied as a quaternion.
  const bool attitude = size == 4 && there == 3;
  if (there != size && !attitude)
    at.fail(said, size == 1
                      ? fmt::format("\"{}\" is an array of {}; vary one of them, as in \"{}.0\"", path, there, path)
                      : fmt::format("\"{}\" holds {} numbers, not {}", path, there, size));
  std::vector<std::string> columns;
  if (size == 1) columns = {path};
  for (std::size_t i = 0; size > 1 && i < size; ++i) columns.push_back(fmt::format("{}.{}", path, i));
  return columns;
}

/// Fails where the path, or a part of it, is among the keys.
void require_new(const Section& at, const char* said, const std::string& path, const std::vector<Design::Key>& keys) {
  for (const Design::Key& key : keys)
    if (path == key.path || path.starts_with(key.path + ".") || key.path.starts_with(path + "."))
      at.fail(said, fmt::format("\"{}\" varies already, as \"{}\"", path, key.path));
}

/// The whole number that x misses by round-off; else x.
double whole_if_near(double x) {
  const double whole = std::round(x);
  return std::abs(x - whole) <= 1e-13 * std::abs(whole) ? whole : x;
}

void read_range(const Section& vary, Variation& v, bool on_grid) {
  const bool logarithmic = read_key(vary, scale) != *scale.fallback;
  const NumberRule& rule = logarithmic ? positive : any_number;
  const double from = vary.number(from_key.name, rule);
  const double to = vary.number(to_key.name, rule);
  v.at = [=](const double* u, double* out) {
    *out = logarithmic ? from * std::pow(to / from, *u) : from + (to - from) * *u;
  };
  v.key.logarithmic = logarithmic;
  if (!on_grid) return;
  const long count = read_key(vary, count_on_grid);
  v.key.equally_spaced = !logarithmic && count > 1;
  v.count = count;
  // Both ends are met, and whole numbers stay whole.
  v.on_grid = [=](long i) {
    const double last = double(std::max(count - 1, 1L));
    if (!logarithmic) return (from * (last - double(i)) + to * double(i)) / last;
    if (i == 0) return from;
    return i == count - 1 ? to : whole_if_near(from * std::pow(to / from, double(i) / last));
  };
}

void read_values(const Section& vary, Variation& v) {
  const std::vector<double> values = read_key(vary, values_key);
  v.count = long(values.size());
  v.on_grid = [values](long i) { return values[std::size_t(i)]; };
  v.at = [values](const double* u, double* out) {
    *out = values[std::min(std::size_t(*u * double(values.size())), values.size() - 1)];
  };
}

void read_normal(const Section& vary, Variation& v) {
  const boost::math::normal_distribution<double> normal(read_key(vary, mean), read_key(vary, deviation));
  v.at = [normal](const double* u, double* out) { *out = quantile(normal, *u); };
}

void read_sphere(const Section& vary, Variation& v) {
  v.dimensions = 2;
  v.at = [radius = read_key(vary, radius_key)](const double* u, double* out) {
    const double z = 1 - 2 * u[0];
    const double ring = std::sqrt((1 - z) * (1 + z));
    const double angle = 2 * std::numbers::pi * u[1];
    out[0] = radius * ring * std::cos(angle);
    out[1] = radius * ring * std::sin(angle);
    out[2] = radius * z;
  };
}

/// Unit quaternions w, x, y, z, uniform on SO(3) (Shoemake).
void read_attitude(Variation& v) {
  v.dimensions = 3;
  v.at = [](const double* u, double* out) {
    const double a = 2 * std::numbers::pi * u[1];
    const double b = 2 * std::numbers::pi * u[2];
    const double inner = std::sqrt(u[0]);
    const double outer = std::sqrt(1 - u[0]);
    out[0] = inner * std::cos(b);
    out[1] = outer * std::sin(a);
    out[2] = outer * std::cos(a);
    out[3] = inner * std::sin(b);
  };
}

Variation read_variation(const Section& vary, bool on_grid, const Section& scene) {
  Variation v;
  v.section = vary;
  const std::string path = read_key(vary, path_key);
  std::size_t size = 1;
  if (vary.has("distribution")) {
    if (on_grid) vary.fail("distribution", "has no grid; give from, to and count, or values, or another design.kind");
    size = read_key(vary, distribution_key({on_sphere, of_attitudes})) == on_sphere ? 3 : 4;
    if (size == 3) read_sphere(vary, v);
    if (size == 4) read_attitude(v);
  } else if (vary.has("values")) {
    read_values(vary, v);
  } else if (vary.has("mean")) {
    if (on_grid) vary.fail("mean", "a normal distribution has no grid; give from, to and count, or values");
    read_normal(vary, v);
  } else {
    read_range(vary, v, on_grid);
  }
  v.key.path = path;
  v.key.columns = columns_of(vary, "key", path, size, scene);
  return v;
}

std::vector<Variation> read_variations(const Section& sweep, bool on_grid, const Section& scene) {
  const std::vector<Section> tables = sweep.tables("vary");
  if (tables.empty()) sweep.fail("", "no [[vary]]: say what of the scene the members change");
  std::vector<Variation> out;
  std::vector<Design::Key> keys;
  for (const Section& vary : tables) {
    out.push_back(read_variation(vary, on_grid, scene));
    require_new(vary, "key", out.back().key.path, keys);
    keys.push_back(out.back().key);
  }
  return out;
}

void fill_grid(const Section& sweep, const std::vector<Variation>& variations, Design& design) {
  long count = 1;
  for (const Variation& v : variations) {
    count = v.count > most_members / count ? most_members + 1 : count * v.count;
    if (count > most_members)
      sweep.fail("vary", fmt::format("more than {} members; use smaller counts, or a random design", most_members));
  }
  std::vector<std::vector<double>> grids;
  for (const Variation& v : variations)
    for (auto& grid = grids.emplace_back(); long(grid.size()) < v.count;) grid.push_back(v.on_grid(long(grid.size())));
  for (long i = 0; i < count; ++i) {
    long block = count;
    for (const std::vector<double>& grid : grids) {
      block /= long(grid.size());
      design.values.push_back(grid[std::size_t(i / block) % grid.size()]);
    }
  }
}

/// Numbers strictly between zero and one, the same everywhere.
class Uniform {
 public:
  explicit Uniform(long seed) : bits_(std::uint64_t(seed)) {}
  double operator()() { return (double(bits_() >> 11) + 0.5) * 0x1p-53; }
  /// From 0, 1, ..., count - 1.
  long below(long count) { return std::min(long((*this)() * double(count)), count - 1); }

 private:
  std::mt19937_64 bits_;
};

void fill_random(const std::vector<Variation>& variations, long count, long seed, bool stratified, Design& design) {
  Uniform uniform(seed);
  std::size_t dimensions = 0;
  for (const Variation& v : variations) dimensions += v.dimensions;
  std::vector<double> cube(std::size_t(count) * dimensions);
  for (double& u : cube) u = uniform();
  if (stratified) {
    std::vector<long> strata(static_cast<std::size_t>(count));
    for (std::size_t d = 0; d < dimensions; ++d) {
      std::iota(strata.begin(), strata.end(), 0L);
      for (long i = count - 1; i > 0; --i) std::swap(strata[std::size_t(i)], strata[std::size_t(uniform.below(i + 1))]);
      for (std::size_t i = 0; i < strata.size(); ++i) {
        double& u = cube[i * dimensions + d];
        u = (double(strata[i]) + u) / double(count);
      }
    }
  }
  design.values.resize(std::size_t(count) * design.width());
  double* out = design.values.data();
  for (const double* u = cube.data(); u != cube.data() + cube.size();)
    for (const Variation& v : variations) {
      v.at(u, out);
      u += v.dimensions;
      out += v.key.columns.size();
    }
}

void read_list(const Section& sweep, const Section& section, const Section& scene, Design& design) {
  if (!sweep.tables("vary").empty()) sweep.fail("vary", "the columns of the list say what varies; leave it out");
  MemberList list = read_member_list(section);
  for (const std::string& column : list.columns) {
    require_new(section, "file", column, design.keys);
    design.keys.push_back({column, columns_of(section, "file", column, 1, scene)});
  }
  design.values = std::move(list.values);
  if (design.count() > most_members)
    section.fail("file", fmt::format("more than {} members; use several sweeps", most_members));
}

}  // namespace

std::size_t Design::width() const {
  std::size_t out = 0;
  for (const Key& key : keys) out += key.columns.size();
  return out;
}

std::vector<std::string> Design::columns() const {
  std::vector<std::string> out;
  for (const Key& key : keys) out.insert(out.end(), key.columns.begin(), key.columns.end());
  return out;
}

std::vector<Change> Design::member(long i) const {
  std::vector<Change> out;
  auto at = values.begin() + i * std::ptrdiff_t(width());
  for (const Key& key : keys) {
    const auto end = at + std::ptrdiff_t(key.columns.size());
    out.push_back({key.path, {at, end}});
    at = end;
  }
  return out;
}

std::vector<Table> design_tables() {
  const Table range{{path_key, from_key, to_key, scale}};
  Table counted = range;
  counted.keys.push_back(count_on_grid);
  const Table values{{path_key, values_key}};
  const auto sweep = [](const Table& design, std::vector<Table> vary) -> Table {
    return {{KeyOf<Table>{"design", design, "", "which members there are"},
             KeyOf<Tables>{"vary", {{{}, std::move(vary)}}, "", "what of the scene the members change"}}};
  };
  return {sweep({{kind_key({grid_design})}}, {counted, values}),
          sweep({{kind_key({"random", latin_hypercube}), member_count, seed_key}},
                {range,
                 values,
                 {{path_key, mean, deviation}},
                 {{path_key, distribution_key({on_sphere}), radius_key}},
                 {{path_key, distribution_key({of_attitudes})}}}),
          {{KeyOf<Table>{"design", {{kind_key({list_of_members}), member_file}}, "", "which members there are"}}}};
}

Design read_design(const Section& sweep, const Section& scene) {
  const Section section = sweep.section("design", "which members there are");
  Design design;
  design.kind = read_key(section, kind_key({grid_design, "random", latin_hypercube, list_of_members}));
  if (design.kind == list_of_members) {
    read_list(sweep, section, scene, design);
    return design;
  }
  const bool on_grid = design.kind == grid_design;
  const std::vector<Variation> variations = read_variations(sweep, on_grid, scene);
  for (const Variation& v : variations) design.keys.push_back(v.key);
  if (on_grid) {
    fill_grid(sweep, variations, design);
  } else {
    const long count = read_key(section, member_count);
    const long seed = read_key(section, seed_key);
    fill_random(variations, count, seed, design.kind == latin_hypercube, design);
  }
  const std::vector<std::string> columns = design.columns();
  for (std::size_t i = 0; i < design.values.size(); ++i)
    if (!std::isfinite(design.values[i])) {
      const std::string& column = columns[i % columns.size()];
      sweep.fail("vary", fmt::format("{} of member {} is {}; use a narrower range", column, i / columns.size(),
                                     design.values[i]));
    }
  return design;
}

}  // namespace lagroid::app
