// In the place of tasks.cpp in a build without TBB.
#include <lagroid/solvers/ensemble/tasks.hpp>
#include <lagroid/solvers/missing_library.hpp>

namespace lagroid {

int available_threads() { return 1; }

void for_each_task(long count, int threads, const std::function<void(long)>& work,
                   const std::function<bool()>& interrupted) {
  if (threads > 1) throw MissingLibrary("work on several threads", "TBB", "libtbb-dev");
  for (long i = 0; i < count && !(interrupted && interrupted()); ++i) work(i);
}

}  // namespace lagroid
