/// Other programs, started and ended by run/process.hpp.
#include <lagroid/run/process.hpp>

#include <gtest/gtest.h>

#include <csignal>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <string>
#include <system_error>
#include <vector>

#include <unistd.h>

namespace run_processes_tests {
namespace {

namespace fs = std::filesystem;
using lagroid::Process;
using lagroid::run_process;

class Processes : public testing::Test {
 protected:
  void SetUp() override { fs::create_directories(folder_); }
  void TearDown() override { fs::remove_all(folder_); }
  std::string text(const char* name) const {
    std::ifstream in(folder_ / name);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  const fs::path folder_ = fs::temp_directory_path() / ("lagroid-processes-" + std::to_string(::getpid()));
};

TEST_F(Processes, TellHowTheyEnded) {
  EXPECT_EQ(run_process({"true"}), 0);
  EXPECT_EQ(run_process({"sh", "-c", "exit 7"}), 7);
  EXPECT_EQ(run_process({"sh", "-c", "kill -TERM $$"}), 128 + SIGTERM);
}

TEST_F(Processes, WorkInTheirFolder) {
  EXPECT_EQ(run_process({"sh", "-c", "pwd; echo no >&2"}, {.folder = folder_, .out = "said", .error = "log"}), 0);
  EXPECT_EQ(text("said"), fs::canonical(folder_).string() + "\n");
  EXPECT_EQ(text("log"), "no\n");
}

TEST_F(Processes, ThatCannotStartSayWhy) {
  const auto why = [](const std::vector<std::string>& words, const lagroid::ProcessOptions& options) {
    try {
      run_process(words, options);
    } catch (const std::system_error& error) {
      return error.code();
    }
    return std::error_code();
  };
  EXPECT_EQ(why({"no-such-program"}, {}), std::errc::no_such_file_or_directory);
  EXPECT_EQ(why({folder_.string()}, {}), std::errc::permission_denied);
  EXPECT_EQ(why({"true"}, {.folder = folder_ / "none"}), std::errc::no_such_file_or_directory);
  EXPECT_EQ(why({"true"}, {.out = folder_}), std::errc::is_a_directory);
  EXPECT_EQ(why({"true"}, {.out = folder_ / "said"}), std::error_code());
}

TEST_F(Processes, AreEnded) {
  Process sleeping({"sleep", "1000"});
  EXPECT_TRUE(sleeping.running());
  sleeping.kill();
  EXPECT_EQ(sleeping.wait(), 128 + SIGKILL);
  EXPECT_FALSE(sleeping.running());
}

/// The program ignores it (app/command), a reader that goes away must end what writes for it.
TEST_F(Processes, KnowABrokenPipe) {
  std::signal(SIGPIPE, SIG_IGN);
  EXPECT_EQ(run_process({"sh", "-c", "kill -PIPE $$; exit 3"}), 128 + SIGPIPE);
  std::signal(SIGPIPE, SIG_DFL);
}

}  // namespace
}  // namespace run_processes_tests
