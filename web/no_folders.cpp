/// Checkpoints in a browser, which has no folders: nobody may ask for one.

#include <lagroid/run/files/checkpoint.hpp>
#include <lagroid/run/files/output_folder.hpp>

namespace lagroid {

Checkpoint::Checkpoint(const std::filesystem::path&, long steps) : steps_(steps) {
  throw OutputError("a page keeps no checkpoints");
}

void Checkpoint::remove() {}

}  // namespace lagroid
