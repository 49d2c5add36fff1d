#include "lanes.hpp"

#include "../scenes/system_module.hpp"

#include <lagroid/run/interrupt.hpp>
#include <lagroid/run/motion/recorder.hpp>
#include <lagroid/run/motion/system_node.hpp>
#include <lagroid/systems/ensembles.hpp>

#include <fmt/format.h>

#include <algorithm>
#include <optional>
#include <utility>
#include <vector>

namespace lagroid::app {

namespace {

/// Visits the module where its system has compiled ensembles.
template <class Visit> void visit_ensemble(const SystemModule& module, const Visit& visit) {
  for_each_ensemble_system([&]<class Sys>() {
    if (const auto* of = module_of<Sys>(module)) visit(*of);
  });
}

template <class Sys> class LaneRunner final : public MemberRunner {
 public:
  using G = typename Sys::GroupoidType;

  LaneRunner(const ModuleOf<Sys>& module, const Section& scene, const Design& design, const KeptColumns& keep)
      : module_(module), scene_(recording(scene, keep)), design_(design), keep_(keep) {}

  std::string_view name() const override { return "lanes"; }

  std::optional<SweepPart> run(long first, long count) const override {
    SweepPart part(first, count);
    std::vector<Member> members;
    for (long at = 0; at < count; ++at) {
      if (InterruptGuard::interrupted()) return std::nullopt;
      try {
        members.emplace_back(at, module_.prepare(scene_.with(design_.member(first + at)), {.record = true}));
      } catch (const SceneError& error) {
        part.end(at, "invalid_scene", error.problem());
      } catch (const std::exception& error) {
        part.end(at, "internal_error", fmt::format("internal error: {}; please report it", error.what()));
      }
    }
    if (members.empty()) return part;
    std::vector<State<G>> states;
    std::vector<ArrowOf<G>> configurations;
    for (const Member& member : members) {
      states.push_back(member.prepared.stated->initial);
      configurations.push_back(member.prepared.stated->configuration);
    }
    const RunExtent& extent = members.front().prepared.stated->extent;
    Ensemble<Sys> ensemble(members.front().prepared.system, states, configurations);
    for (std::size_t i = 0; i < members.size(); ++i) members[i].see(ensemble.point(long(i)));
    EnsembleOptions<Sys> options;
    options.interrupted = InterruptGuard::interrupted;
    options.every = extent.every;
    if (extent.every <= extent.steps)
      options.observe = [&](long i, const TrajectoryPoint<Sys>& point) { members[std::size_t(i)].see(point); };
    if (!ensemble.advance_to(extent.steps, options)) return std::nullopt;
    for (std::size_t i = 0; i < members.size(); ++i)
      keep_result(members[i].end(ensemble.point(long(i)), ensemble.status(long(i))), keep_, members[i].at, part);
    return part;
  }

 private:
  struct Member {
    Member(long place, PreparedScene<Sys> its)
        : at(place),
          prepared(std::move(its)),
          node(std::make_unique<SystemNode<Sys>>(prepared.system, prepared.stated->presentation,
                                                 std::vector<Quantity<Sys>>())),
          recorder(*node) {}

    void see(const TrajectoryPoint<Sys>& point) {
      node->see(point);
      recorder.record(*node, nullptr);
    }

    RunResult end(const TrajectoryPoint<Sys>& last, SolveStatus status) {
      if (last.index % prepared.stated->extent.every != 0) see(last);
      RunResult out;
      out.trajectory = std::move(recorder.trajectory());
      out.steps = last.index;
      out.steps_asked = prepared.stated->extent.steps;
      if (status != SolveStatus::converged) {
        out.status = std::string(to_string(status));
        out.message = fmt::format("step {} (from t = {:.6g}): {}; lagroid run of this member says what to do",
                                  last.index + 1, last.time, to_string(status));
      }
      return out;
    }

    long at;
    PreparedScene<Sys> prepared;
    std::unique_ptr<SystemNode<Sys>> node;
    Recorder recorder;
  };

  const ModuleOf<Sys>& module_;
  Section scene_;
  const Design& design_;
  const KeptColumns& keep_;
};

bool names_drifts(const std::vector<std::string>& names) {
  return std::any_of(names.begin(), names.end(), [](const std::string& name) { return name.starts_with("drift "); });
}

/// The runner, or why there is none.
std::pair<std::unique_ptr<MemberRunner>, std::string> make_lanes(const Section& scene, const Design& design,
                                                                 const KeptColumns& keep) {
  if (keep.ledger) return {nullptr, "the ledger looks at every step of every member; set keep.ledger = false"};
  if (names_drifts(keep.initial) || names_drifts(keep.series) || (keep.final && names_drifts(*keep.final)))
    return {nullptr, "drifts are the ledger's"};
  for (const Design::Key& key : design.keys)
    if (!key.path.starts_with("initial.")) return {nullptr, fmt::format("{} varies, which all must share", key.path)};
  std::pair<std::unique_ptr<MemberRunner>, std::string> out{nullptr, "this system has none"};
  if (!scene.has("system")) return out;
  const std::string system = scene.text("system", "its name");
  const auto found = std::ranges::find(system_modules(), system, &SystemModule::name);
  if (found == system_modules().end()) return out;
  visit_ensemble(**found, [&]<class Sys>(const ModuleOf<Sys>& module) {
    try {
      const auto value = module.prepare(scene, {}).stated;
      if (value && value->is_plain())
        out = {std::make_unique<LaneRunner<Sys>>(module, scene, design, keep), ""};
      else
        out.second = "they take initial values by equal steps of order 2 by Newton's method";
    } catch (const SceneError& error) {
      out.second = error.problem();
    }
  });
  return out;
}

}  // namespace

std::string why_no_lanes(const Section& scene, const Design& design, const KeptColumns& keep) {
  return make_lanes(scene, design, keep).second;
}

std::unique_ptr<MemberRunner> lane_runner(const Section& scene, const Design& design, const KeptColumns& keep) {
  return make_lanes(scene, design, keep).first;
}

}  // namespace lagroid::app
