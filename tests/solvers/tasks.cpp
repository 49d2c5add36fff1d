// Independent pieces of work: each once, the same failure whatever the threads, none begun after an interrupt.
#include <lagroid/solvers/ensemble/tasks.hpp>

#include <gtest/gtest.h>

#include <atomic>
#include <stdexcept>
#include <string>
#include <vector>

namespace solvers_tasks_tests {
namespace {

using namespace lagroid;

TEST(Tasks, EachIsCalledOnce) {
  for (const int threads : {0, 1, 2, 7}) {
    std::vector<int> calls(1000);
    for_each_task(1000, threads, [&](long i) { ++calls[std::size_t(i)]; });
    EXPECT_EQ(calls, std::vector<int>(1000, 1)) << threads;
  }
  for_each_task(0, 2, [](long) { FAIL(); });
}

TEST(Tasks, TheFirstFailureIsTold) {
  for (const int threads : {0, 1, 2, 7}) {
    for (int repetition = 0; repetition < 20; ++repetition) {
      try {
        for_each_task(500, threads, [](long i) {
          if (i % 100 == 37) throw std::runtime_error(std::to_string(i));
        });
        FAIL() << threads;
      } catch (const std::runtime_error& error) {
        EXPECT_STREQ(error.what(), "37") << threads;
      }
    }
  }
}

TEST(Tasks, NoneIsBegunAfterAnInterrupt) {
  for (const int threads : {1, 2}) {
    std::atomic<long> done = 0;
    for_each_task(
        100000, threads, [&](long) { ++done; }, [&] { return done >= 10; });
    EXPECT_GE(done, 10);
    EXPECT_LT(done, 10 + threads);
  }
}

}  // namespace
}  // namespace solvers_tasks_tests
