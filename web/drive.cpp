/// A run from its first step to its last in a browser, which has no folder for checkpoints, no terminal and no signals.

#include <lagroid/run/followed_run.hpp>
#include <lagroid/run/motion/drive.hpp>

#include <chrono>

namespace lagroid {

void drive(Motion& motion, const RunExtent& extent, const RunContext& context, RunResult& result) {
  const auto start = std::chrono::steady_clock::now();
  FollowedRun run(motion, extent, context.record, result);
  run.begin();
  run.advance(extent.steps);
  run.tell_end();
  run.finish();
  result.seconds = std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

}  // namespace lagroid
