#include "process.hpp"

#include <fcntl.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <system_error>

namespace lagroid::app {

namespace {

/// What is changed for the program: its streams, and signals that programs of ours do without.
class Change {
 public:
  Change() {
    posix_spawn_file_actions_init(&files);
    posix_spawnattr_init(&attributes);
    sigset_t usual;
    sigemptyset(&usual);
    sigaddset(&usual, SIGPIPE);
    sigaddset(&usual, SIGXFSZ);
    posix_spawnattr_setsigdefault(&attributes, &usual);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETSIGDEF);
  }
  ~Change() {
    posix_spawn_file_actions_destroy(&files);
    posix_spawnattr_destroy(&attributes);
  }
  Change(const Change&) = delete;
  Change& operator=(const Change&) = delete;

  void send(int descriptor, const std::filesystem::path& file) {
    if (!file.empty())
      posix_spawn_file_actions_addopen(&files, descriptor, file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  }

  posix_spawn_file_actions_t files;
  posix_spawnattr_t attributes;
};

}  // namespace

int run_process(const std::vector<std::string>& words, const Streams& streams) {
  std::vector<std::string> kept = words;
  std::vector<char*> arguments;
  for (std::string& word : kept) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  Change change;
  change.send(STDOUT_FILENO, streams.out);
  change.send(STDERR_FILENO, streams.error);
  pid_t child = 0;
  const int failed = posix_spawnp(&child, arguments[0], &change.files, &change.attributes, arguments.data(), environ);
  if (failed != 0) throw std::system_error(failed, std::generic_category(), words.front());
  int status = 0;
  while (waitpid(child, &status, 0) < 0)
    if (errno != EINTR) throw std::system_error(errno, std::generic_category(), words.front());
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace lagroid::app
