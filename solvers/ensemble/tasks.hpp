#pragma once
/// Independent pieces of work on the threads of one machine.

#include <functional>

namespace lagroid {

/// Threads that this process may use.
int available_threads();

/// Calls work(i) once for every i in [0, count), on `threads` threads (0: all available ones; 1: on the caller's, in
/// order), in no particular order. Pieces may write to places of their own only, so that what they leave does not
/// depend on the number of threads; nor does the exception that is rethrown, that of the least i: pieces after it may
/// or may not have been called. Once `interrupted` (if there is one, asked by all threads) returns true, no more pieces
/// are begun.
void for_each_task(long count, int threads, const std::function<void(long)>& work,
                   const std::function<bool()>& interrupted = nullptr);

}  // namespace lagroid
