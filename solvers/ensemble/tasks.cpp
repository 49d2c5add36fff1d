#include "tasks.hpp"

#include <tbb/blocked_range.h>
#include <tbb/global_control.h>
#include <tbb/parallel_for.h>
#include <tbb/partitioner.h>
#include <tbb/task_arena.h>

#include <atomic>
#include <cstddef>
#include <exception>
#include <limits>
#include <mutex>

namespace lagroid {

int available_threads() { return tbb::this_task_arena::max_concurrency(); }

void for_each_task(long count, int threads, const std::function<void(long)>& work,
                   const std::function<bool()>& interrupted) {
  if (threads == 1) {
    for (long i = 0; i < count && !(interrupted && interrupted()); ++i) work(i);
    return;
  }
  // Every piece before the first one that failed is called, whatever the order: the failure told is always the same.
  std::atomic<long> failed = std::numeric_limits<long>::max();
  std::exception_ptr failure;
  std::mutex telling;
  const auto guarded = [&](long i) {
    if (i > failed || (interrupted && interrupted())) return;
    try {
      work(i);
    } catch (...) {
      const std::lock_guard lock(telling);
      if (i < failed) {
        failed = i;
        failure = std::current_exception();
      }
    }
  };
  const int wanted = threads > 0 ? threads : available_threads();
  const tbb::global_control allowed(tbb::global_control::max_allowed_parallelism, std::size_t(wanted));
  tbb::task_arena arena(wanted);
  arena.execute([&] {
    tbb::parallel_for(
        tbb::blocked_range<long>(0, count, 1),
        [&](const tbb::blocked_range<long>& range) {
          for (long i = range.begin(); i < range.end(); ++i) guarded(i);
        },
        tbb::simple_partitioner{});
  });
  if (failure) std::rethrow_exception(failure);
}

}  // namespace lagroid
