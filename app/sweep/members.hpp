#pragma once
/// Running the members of a sweep.

#include "design.hpp"
#include "work/part.hpp"

#include <lagroid/run/run_result.hpp>

#include <memory>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace lagroid::app {

/// [keep]: what of every member. Names are those of recorded quantities ("momentum") or of single columns ("px").
struct KeptColumns {
  std::optional<std::vector<std::string>> final;  ///< at the last node; all but drifts where it is not said
  std::vector<std::string> initial;               ///< at the first node
  std::vector<std::string> series;                ///< at every `every`-th node and the last
  long every = 1;
  bool ledger = true;  ///< how far each quantity drifted
};
Table keep_table();
KeptColumns read_keep(const Section& sweep);

/// Runs members; may be asked by several threads at once.
class MemberRunner {
 public:
  virtual ~MemberRunner() = default;
  virtual std::string_view name() const = 0;
  /// Members `first` to `first` + `count`; none where an interrupt came before all were done.
  virtual std::optional<SweepPart> run(long first, long count) const = 0;
};

/// By `run_scene`, one after the other: any scene. One that fails does so alone: its row has a status and a message.
std::unique_ptr<MemberRunner> scene_runner(const Section& scene, const Design& design, const KeptColumns& keep);

/// A scene that records what is kept, and no more.
Section recording(const Section& scene, const KeptColumns& keep);

/// Sets what is kept of a member, at its place in the part.
void keep_result(const RunResult& result, const KeptColumns& keep, long at, SweepPart& part);

/// Runs one step (or, of a boundary value, one start) of the scene as it is written, so that its mistakes, and names of
/// `keep` that it does not record, are found before all else. Returns what would be kept of it. Throws SceneError.
SweepPart try_scene(const Section& sweep, const Section& scene, const KeptColumns& keep);

}  // namespace lagroid::app
