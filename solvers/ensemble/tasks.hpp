#pragma once
/// Independent pieces of work, i = 0, ..., n - 1, on the threads of one machine. It is the one place that starts
/// threads, and results are in the order of i, so that no result depends on the number of threads.
///
///     std::vector<double> roots(100);
///     for_each_task(100, 0, [&](long i) { roots[std::size_t(i)] = std::sqrt(double(i)); });  // on all threads
///
/// Requires pieces that write to places of their own only. The exception of the least i is rethrown.

#include <cstddef>
#include <functional>
#include <mutex>
#include <optional>
#include <type_traits>
#include <utility>
#include <vector>

namespace lagroid {

/// Threads that this process may use.
int available_threads();

/// Calls work(i) once for every i in [0, count), on `threads` threads (0: all available ones; 1: on the caller's, in
/// order), in no particular order. Pieces may write to places of their own only, so that what they leave does not
/// depend on the number of threads; nor does the exception that is rethrown, that of the least i: pieces after it may
/// or may not have been called. Once `interrupted` (if there is one; all threads call it) returns true, no more pieces
/// are begun.
void for_each_task(long count, int threads, const std::function<void(long)>& work,
                   const std::function<bool()>& interrupted = nullptr);

/// What work(i) returns, in order of i. After each piece `report` is called, never twice at once, with the number of
/// those that are done.
template <class Work, class Report>
auto results_of_tasks(long count, int threads, const Work& work, const Report& report) {
  using Result = std::invoke_result_t<Work, long>;
  std::vector<std::optional<Result>> found(static_cast<std::size_t>(count));
  std::mutex reporting;
  int done = 0;
  for_each_task(count, threads, [&](long i) {
    found[std::size_t(i)].emplace(work(i));
    const std::lock_guard lock(reporting);
    report(++done);
  });
  std::vector<Result> out;
  out.reserve(found.size());
  for (auto& each : found) out.push_back(std::move(*each));
  return out;
}

}  // namespace lagroid
