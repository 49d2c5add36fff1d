#include "members.hpp"

#include "../scenes/scene_keys.hpp"
#include "../study/run_scene.hpp"

#include <lagroid/run/interrupt.hpp>

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <algorithm>
#include <exception>
#include <limits>
#include <new>
#include <utility>

namespace lagroid::app {

namespace {

const KeyOf<Texts> final_key{"final", {},   "", "names of recorded quantities or columns, kept of the last node",
                             {},      "all"};
const KeyOf<Texts> initial_key{"initial", {}, "", "the same, of the first node", {}, "none"};
const KeyOf<Texts> series_key{"series", {}, "", "the same, of all recorded nodes", {}, "none"};
const KeyOf<Whole> every_key{"every", {1, most_apart}, "", "n: the series have each n-th node, and the last", 1};
const KeyOf<Flag> ledger_key{"ledger", {}, "", "whether the drifts of the ledger are kept", true};

/// What a series is called in a list of names: by itself, or by single columns.
bool named_in(const std::vector<std::string>& names, const Columns& series, std::size_t component) {
  return std::any_of(names.begin(), names.end(), [&](const std::string& name) {
    return name == series.name || name == series.components[component];
  });
}

bool is_drift(const Columns& series) { return series.name.starts_with("drift of "); }

/// The row that belongs to a node; null where there is none.
const double* row_of(const Columns& series, std::size_t node) {
  if (series.on_arrows && node == 0) return nullptr;
  const std::size_t row = series.on_arrows ? node - 1 : node;
  return (row + 1) * series.width() <= series.values.size() ? &series.values[row * series.width()] : nullptr;
}

void keep_node(const Trajectory& t, std::size_t node, const std::string& group, const std::vector<std::string>* names,
               long at, SweepPart& part) {
  for (const Columns& s : t.series) {
    const double* row = row_of(s, node);
    for (std::size_t i = 0; row != nullptr && i < s.width(); ++i)
      if (names != nullptr ? named_in(*names, s, i) : !is_drift(s))
        part.set(at, group + "/" + s.components[i], s.unit, s.meaning, row[i]);
  }
}

void keep_series(const Trajectory& t, const std::vector<std::string>& names, long at, SweepPart& part) {
  part.set_series(at, "series/t", "s", "time", t.time);
  for (const Columns& s : t.series)
    for (std::size_t i = 0; i < s.width(); ++i) {
      if (!named_in(names, s, i)) continue;
      std::vector<double> values;
      if (s.on_arrows) values.push_back(std::numeric_limits<double>::quiet_NaN());
      for (std::size_t row = i; row < s.values.size(); row += s.width()) values.push_back(s.values[row]);
      part.set_series(at, "series/" + s.components[i], s.unit, s.meaning, std::move(values));
    }
}

class SceneRunner final : public MemberRunner {
 public:
  SceneRunner(const Section& scene, const Design& design, const KeptColumns& keep)
      : scene_(recording(scene, keep)), design_(design), keep_(keep) {}

  std::string_view name() const override { return "scenes"; }

  std::optional<SweepPart> run(long first, long count) const override {
    SweepPart part(first, count);
    for (long at = 0; at < count; ++at) {
      if (InterruptGuard::interrupted()) return std::nullopt;
      try {
        const RunResult result = run_scene(scene_.with(design_.member(first + at)), {.record = true});
        if (result.interrupted()) return std::nullopt;
        part.set(at, "run/iterations", "1", "of the solver, all together", double(result.iterations));
        keep_result(result, keep_, at, part);
      } catch (const SceneError& error) {
        part.end(at, "invalid_scene", error.problem());
      } catch (const std::bad_alloc&) {
        part.end(at, "out_of_memory", "out of memory; lower time.steps, or raise keep.every");
      } catch (const std::exception& error) {
        part.end(at, "internal_error", fmt::format("internal error: {}; please report it", error.what()));
      }
    }
    return part;
  }

 private:
  Section scene_;
  const Design& design_;
  const KeptColumns& keep_;
};

}  // namespace

Table keep_table() { return {{final_key, initial_key, series_key, every_key, ledger_key}}; }

KeptColumns read_keep(const Section& sweep) {
  const Section section = sweep.section_or_empty("keep");
  KeptColumns keep;
  if (section.has(final_key.name)) keep.final = read_key(section, final_key);
  keep.initial = read_key(section, initial_key);
  keep.series = read_key(section, series_key);
  if (section.has("every") && keep.series.empty()) section.fail("every", "goes with series");
  keep.every = read_key(section, every_key);
  keep.ledger = read_key(section, ledger_key);
  return keep;
}

Section recording(const Section& scene, const KeptColumns& keep) {
  return scene.with({{"output.every", {double(keep.series.empty() ? most_apart : keep.every)}}});
}

void keep_result(const RunResult& r, const KeptColumns& keep, long at, SweepPart& part) {
  part.end(at, r.status, r.converged() ? std::string() : r.message);
  part.set(at, "run/steps", "1", "arrows computed", double(r.steps));
  if (r.cost) part.set(at, "run/cost", "action", "of the path", *r.cost);
  if (!r.stationary_paths.empty())
    part.set(at, "run/stationary_paths", "1", "found", double(r.stationary_paths.size()));
  const auto broken = std::count_if(r.ledger.entries.begin(), r.ledger.entries.end(),
                                    [](const LedgerEntry& entry) { return entry.broken(); });
  if (!r.ledger.entries.empty())
    part.set(at, "run/broken", "1", "promises of the ledger that were broken", double(broken));
  if (keep.ledger)
    for (const LedgerEntry& entry : r.ledger.entries)
      part.set(at, "ledger/" + entry.name, entry.promise == "counted" ? "1" : "unit of the quantity",
               entry.promise == "counted" ? "how often" : "largest deviation from the initial value", entry.drift);
  const Trajectory& t = r.trajectory;
  if (t.time.empty()) return;
  keep_node(t, 0, "initial", &keep.initial, at, part);
  part.set(at, "final/t", "s", "time", t.time.back());
  keep_node(t, t.time.size() - 1, "final", keep.final ? &*keep.final : nullptr, at, part);
  if (!keep.series.empty()) keep_series(t, keep.series, at, part);
}

std::unique_ptr<MemberRunner> scene_runner(const Section& scene, const Design& design, const KeptColumns& keep) {
  return std::make_unique<SceneRunner>(scene, design, keep);
}

SweepPart try_scene(const Section& sweep, const Section& scene, const KeptColumns& keep) {
  Section few = recording(scene, keep);
  if (few.has("boundary"))
    few = few.with({{"solver.starts", {1}}});
  else if (!few.numbers_at("time.steps").empty())
    few = few.with({{"time.steps", {1}}});
  const RunResult result = run_scene(few, {.record = true});
  const std::vector<Columns>& recorded = result.trajectory.series;
  SweepPart part(0, 1);
  keep_result(result, keep, 0, part);
  if (recorded.empty()) return part;
  std::vector<std::string> known;
  for (const Columns& s : recorded) {
    known.push_back(s.name);
    if (s.width() > 1 || s.components[0] != s.name) known.insert(known.end(), s.components.begin(), s.components.end());
  }
  const auto check = [&](const char* key, const std::vector<std::string>& names) {
    for (const std::string& name : names)
      if (std::find(known.begin(), known.end(), name) == known.end())
        sweep.section("keep", "")
            .fail(key,
                  fmt::format("\"{}\" is not recorded by this scene; these are: {}", name, fmt::join(known, ", ")));
  };
  if (keep.final) check("final", *keep.final);
  check("initial", keep.initial);
  check("series", keep.series);
  return part;
}

}  // namespace lagroid::app
