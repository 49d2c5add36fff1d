// The schedule of parts, on ranks that are threads of this program.
#include <lagroid/app/sweep/work/schedule.hpp>

#include <gtest/gtest.h>

#include <atomic>
#include <chrono>
#include <deque>
#include <functional>
#include <mutex>
#include <new>
#include <numeric>
#include <optional>
#include <stdexcept>
#include <string>
#include <thread>
#include <vector>

namespace sweep_command_schedule_tests {
namespace {

using lagroid::app::Message;
using lagroid::app::Ranks;
using lagroid::app::ScheduleOutcome;
using lagroid::app::SchedulingOptions;

/// Where ranks that are threads leave their messages.
struct Post {
  std::mutex mutex;
  std::vector<std::deque<Ranks::Received>> boxes;
};

class LocalRanks final : public Ranks {
 public:
  LocalRanks(Post& post, int rank) : post_(post), rank_(rank) {}
  int rank() const override { return rank_; }
  int size() const override { return int(post_.boxes.size()); }
  void send(int to, const Message& message) override {
    const std::lock_guard lock(post_.mutex);
    post_.boxes[std::size_t(to)].push_back({rank_, message});
  }
  std::optional<Received> receive() override {
    const std::lock_guard lock(post_.mutex);
    auto& box = post_.boxes[std::size_t(rank_)];
    if (box.empty()) return std::nullopt;
    Received out = box.front();
    box.pop_front();
    return out;
  }
  std::string broadcast(const std::string& text) override { return text; }

 private:
  Post& post_;
  int rank_;
};

/// Has no memory for a message.
class Speechless final : public Ranks {
 public:
  int rank() const override { return 1; }
  int size() const override { return 2; }
  void send(int, const Message&) override { throw std::bad_alloc(); }
  std::optional<Received> receive() override { return std::nullopt; }
  std::string broadcast(const std::string& text) override { return text; }
  void abort(const std::string& why) override { told = why; }

  std::string told;
};

TEST(Schedule, ARankThatCannotGoOnEndsAll) {
  Speechless ranks;
  EXPECT_THROW(for_each_part(ranks, {}, {.threads = 1}, [](long) { return true; }), std::bad_alloc);
  EXPECT_EQ(ranks.told, std::bad_alloc().what());
}

ScheduleOutcome on_ranks(int ranks, int threads, long parts, const std::function<bool(int rank, long part)>& work,
                         const std::function<bool()>& interrupted = nullptr) {
  Post post;
  post.boxes.resize(std::size_t(ranks));
  std::vector<long> all(static_cast<std::size_t>(parts));
  std::iota(all.begin(), all.end(), 0L);
  ScheduleOutcome out;
  std::vector<std::thread> others;
  for (int rank = 0; rank < ranks; ++rank)
    others.emplace_back([&, rank] {
      LocalRanks self(post, rank);
      SchedulingOptions schedule{.threads = threads, .interrupted = interrupted};
      const auto outcome = for_each_part(self, all, schedule, [&work, rank](long part) { return work(rank, part); });
      if (rank == 0) out = outcome;
    });
  for (auto& each : others) each.join();
  return out;
}

TEST(Schedule, EveryPartIsDoneOnceOnAnyRanksAndThreads) {
  for (const int ranks : {1, 2, 5})
    for (const int threads : {1, 3})
      for (const long parts : {0L, 1L, 4L, 300L}) {
        std::vector<std::atomic<int>> done(static_cast<std::size_t>(parts));
        const auto outcome = on_ranks(ranks, threads, parts, [&](int, long part) {
          ++done[std::size_t(part)];
          return true;
        });
        EXPECT_TRUE(outcome.finished);
        for (const auto& count : done) EXPECT_EQ(count, 1) << ranks << " ranks, " << threads << " threads";
      }
}

TEST(Schedule, IdleRanksTakeTheWorkOfBusyOnes) {
  std::atomic<int> elsewhere = 0;
  const auto outcome = on_ranks(3, 1, 40, [&](int rank, long) {
    std::this_thread::sleep_for(std::chrono::milliseconds(rank == 0 ? 200 : 2));
    elsewhere += rank != 0;
    return true;
  });
  EXPECT_TRUE(outcome.finished);
  EXPECT_GT(elsewhere, 34);
}

TEST(Schedule, AFailureEndsItAndIsTold) {
  std::atomic<int> done = 0;
  const auto outcome = on_ranks(3, 2, 10000, [&](int rank, long) {
    std::this_thread::sleep_for(std::chrono::microseconds(100));
    if (++done > 50 && rank == 1) throw std::runtime_error("the disk is full");
    return true;
  });
  EXPECT_FALSE(outcome.finished);
  EXPECT_EQ(outcome.failure, "the disk is full");
  EXPECT_EQ(outcome.failed_rank, 1);
  EXPECT_LT(done, 10000);
}

TEST(Schedule, AnInterruptEndsIt) {
  std::atomic<int> done = 0;
  const auto outcome = on_ranks(
      2, 2, 10000,
      [&](int, long) {
        std::this_thread::sleep_for(std::chrono::microseconds(100));
        ++done;
        return true;
      },
      [&] { return done > 60; });
  EXPECT_FALSE(outcome.finished);
  EXPECT_EQ(outcome.failure, "");
  EXPECT_LT(done, 100);
}

}  // namespace
}  // namespace sweep_command_schedule_tests
