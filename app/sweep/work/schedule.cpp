#include "schedule.hpp"

#include <lagroid/solvers/ensemble/tasks.hpp>
#include <lagroid/solvers/processor_time.hpp>

#include <tbb/global_control.h>

#include <chrono>
#include <condition_variable>
#include <deque>
#include <exception>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>

namespace lagroid::app {

namespace {

using Clock = std::chrono::steady_clock;

enum Kind : int {
  ask,    ///< to rank 0: a part is wanted; value: parts finished since the last message
  give,   ///< from rank 0: value is the part, or `none`
  ended,  ///< to rank 0: all threads have ended; value as for `ask`; text: failure, waiting and whether interrupted
  leave   ///< from rank 0: all ranks have ended
};
constexpr long none = -1;

/// How long the calling thread sleeps before it looks for messages again.
constexpr std::chrono::microseconds between_looks(200);

/// The threads of this process, and the parts that wait for them.
class Crew {
 public:
  Crew(int threads, const std::function<bool(long)>& work, const std::function<bool()>& interrupted)
      : allowed_(tbb::global_control::max_allowed_parallelism, std::size_t(threads)),
        work_(work),
        interrupted_(interrupted),
        running_(threads) {
    threads_ = std::thread([this, threads] { for_each_task(threads, threads, [this](long) { serve(); }); });
  }
  Crew(const Crew&) = delete;
  Crew& operator=(const Crew&) = delete;
  ~Crew() {
    close();
    threads_.join();
  }

  /// Threads for which there is no part yet.
  long idle() {
    const std::lock_guard lock(mutex_);
    return closed_ || stopped_ ? 0 : waiting_ - long(ready_.size());
  }
  bool over() {
    const std::lock_guard lock(mutex_);
    return running_ == 0;
  }
  void give(long part) {
    const std::lock_guard lock(mutex_);
    ready_.push_back(part);
    come_.notify_one();
  }
  /// There are no more parts.
  void close() {
    const std::lock_guard lock(mutex_);
    closed_ = true;
    come_.notify_all();
  }
  /// Sleeps until a thread wants something or has ended, and no longer than `most`.
  void wait(std::chrono::microseconds most) {
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, most, [&] { return changes_ > 0; });
    changes_ = 0;
  }
  /// Parts finished since the last call.
  long take_finished() {
    const std::lock_guard lock(mutex_);
    return std::exchange(finished_, 0);
  }
  /// Some part was not finished: an interrupt, or a failure.
  bool stopped() {
    const std::lock_guard lock(mutex_);
    return stopped_;
  }
  std::string failure() {
    const std::lock_guard lock(mutex_);
    return failure_;
  }
  double seconds_waiting() {
    const std::lock_guard lock(mutex_);
    return seconds_waiting_;
  }

 private:
  std::optional<long> next() {
    std::unique_lock lock(mutex_);
    ++waiting_;
    note();
    const auto asked = Clock::now();
    come_.wait(lock, [&] { return closed_ || stopped_ || !ready_.empty(); });
    --waiting_;
    if (stopped_ || ready_.empty()) return std::nullopt;
    seconds_waiting_ += std::chrono::duration<double>(Clock::now() - asked).count();
    const long part = ready_.front();
    ready_.pop_front();
    return part;
  }

  void serve() {
    while (const auto part = next()) {
      bool done = false;
      std::string failure;
      try {
        done = !(interrupted_ && interrupted_()) && work_(*part);
      } catch (const std::exception& error) {
        failure = error.what();
      }
      const std::lock_guard lock(mutex_);
      if (done) ++finished_;
      if (done) continue;
      stopped_ = true;
      if (failure_.empty()) failure_ = failure;
      come_.notify_all();
      note();
    }
    const std::lock_guard lock(mutex_);
    --running_;
    note();
  }

  /// With the lock held.
  void note() {
    ++changes_;
    changed_.notify_one();
  }

  tbb::global_control allowed_;  ///< also for what the parts themselves do on several threads
  const std::function<bool(long)>& work_;
  const std::function<bool()>& interrupted_;
  std::mutex mutex_;
  std::condition_variable come_;
  std::condition_variable changed_;
  std::deque<long> ready_;
  long waiting_ = 0;
  long running_;
  long finished_ = 0;
  long changes_ = 0;
  bool closed_ = false;
  bool stopped_ = false;
  std::string failure_;
  double seconds_waiting_ = 0;
  std::thread threads_;
};

/// Rank 0: hands out, and counts.
ScheduleOutcome hand_out(Ranks& ranks, std::span<const long> parts, const SchedulingOptions& schedule, Crew& crew) {
  ScheduleOutcome outcome;
  const double begun = processor_time();
  std::size_t next = 0;
  long finished = 0;
  int others = ranks.size() - 1;
  bool stopping = false;
  const auto part = [&] { return stopping || next == parts.size() ? none : parts[next++]; };
  const auto stop = [&](int rank, const std::string& failure) {
    stopping = true;
    if (failure.empty() || !outcome.failure.empty()) return;
    outcome.failure = failure;
    outcome.failed_rank = rank;
  };
  for (;;) {
    const bool over = crew.over();
    finished += crew.take_finished();
    if (crew.stopped()) stop(0, crew.failure());
    if (schedule.interrupted && schedule.interrupted()) stopping = true;
    for (long i = crew.idle(); i > 0; --i) {
      const long given = part();
      if (given == none) {
        crew.close();
        break;
      }
      crew.give(given);
    }
    while (const auto received = ranks.receive()) {
      const auto& [from, message] = *received;
      finished += message.value;
      if (message.kind == ask) ranks.send(from, {give, part(), {}});
      if (message.kind == ended) {
        --others;
        const auto end = message.text.find(' ');
        outcome.seconds_waiting += std::stod(message.text.substr(0, end));
        if (end + 1 < message.text.size()) stop(from, message.text.substr(end + 1));
      }
    }
    if (schedule.progress) schedule.progress(finished);
    if (over && others == 0) break;
    crew.wait(others > 0 ? between_looks : std::chrono::milliseconds(100));
  }
  outcome.seconds_waiting += crew.seconds_waiting();
  outcome.seconds_handing = processor_time() - begun;
  outcome.finished = finished == long(parts.size());
  for (int rank = 1; rank < ranks.size(); ++rank) ranks.send(rank, {leave, 0, {}});
  return outcome;
}

/// Any other rank: asks.
void ask_for_parts(Ranks& ranks, Crew& crew) {
  long asked = 0;
  const auto receive = [&] {
    while (const auto received = ranks.receive()) {
      --asked;
      if (received->message.value == none)
        crew.close();
      else
        crew.give(received->message.value);
    }
  };
  while (!crew.over() || asked > 0) {
    for (; crew.idle() > asked; ++asked) ranks.send(0, {ask, crew.take_finished(), {}});
    receive();
    crew.wait(asked > 0 ? between_looks : std::chrono::milliseconds(100));
  }
  ranks.send(0, {ended, crew.take_finished(), std::to_string(crew.seconds_waiting()) + " " + crew.failure()});
  while (!ranks.receive()) std::this_thread::sleep_for(10 * between_looks);
}

}  // namespace

ScheduleOutcome for_each_part(Ranks& ranks, std::span<const long> parts, const SchedulingOptions& schedule,
                              const std::function<bool(long)>& work) {
  try {
    Crew crew(schedule.threads > 0 ? schedule.threads : available_threads(), work, schedule.interrupted);
    if (ranks.rank() == 0) return hand_out(ranks, parts, schedule, crew);
    ask_for_parts(ranks, crew);
    return {};
  } catch (const std::exception& error) {
    ranks.abort(error.what());
    throw;
  }
}

}  // namespace lagroid::app
