#include <lagroid/run/process.hpp>

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <system_error>

namespace lagroid {

namespace {

/// Makes the descriptor that of a file. Whether that was possible.
bool send(int descriptor, const std::filesystem::path& file) {
  if (file.empty()) return true;
  const int opened = ::open(file.c_str(), O_WRONLY | O_CREAT | O_TRUNC, 0600);
  return opened >= 0 && ::dup2(opened, descriptor) >= 0 && (opened == descriptor || ::close(opened) == 0);
}

/// What the child does; it returns only where the program could not be started. Other threads may have held locks when
/// it came to be: nothing here takes one.
void become(char* const* arguments, const ProcessOptions& options) {
  std::signal(SIGPIPE, SIG_DFL);
  std::signal(SIGXFSZ, SIG_DFL);
  ::prctl(PR_SET_PDEATHSIG, SIGTERM);
  if (!options.folder.empty() && ::chdir(options.folder.c_str()) != 0) return;
  if (send(STDOUT_FILENO, options.out) && send(STDERR_FILENO, options.error)) ::execvp(arguments[0], arguments);
}

}  // namespace

Process::Process(const std::vector<std::string>& words, const ProcessOptions& options) {
  const auto refuse = [&](int why) { throw std::system_error(why, std::generic_category(), words.front()); };
  std::vector<std::string> kept = words;
  std::vector<char*> arguments;
  for (std::string& word : kept) arguments.push_back(word.data());
  arguments.push_back(nullptr);
  // Closed by the program's start; what comes through it is why there was none.
  std::array<int, 2> reason{};
  if (::pipe2(reason.data(), O_CLOEXEC) != 0) refuse(errno);
  child_ = ::fork();
  if (child_ == 0) {
    become(arguments.data(), options);
    const int why = errno;
    _exit(::write(reason[1], &why, sizeof why) == sizeof why ? 127 : 126);
  }
  int why = child_ < 0 ? errno : 0;
  ::close(reason[1]);
  while (child_ > 0 && ::read(reason[0], &why, sizeof why) < 0 && errno == EINTR) continue;
  ::close(reason[0]);
  if (why == 0) return;
  if (child_ > 0) wait();
  refuse(why);
}

Process::~Process() { collect(0); }

void Process::collect(int flags) {
  while (!ended_) {
    const int found = ::waitpid(child_, &status_, flags);
    if (found == 0) return;
    ended_ = found > 0 || errno != EINTR;
  }
}

bool Process::running() {
  collect(WNOHANG);
  return !ended_;
}

void Process::kill() {
  if (running()) ::kill(child_, SIGKILL);
}

int Process::wait() {
  collect(0);
  return WIFEXITED(status_) ? WEXITSTATUS(status_) : 128 + WTERMSIG(status_);
}

int run_process(const std::vector<std::string>& words, const ProcessOptions& options) {
  return Process(words, options).wait();
}

}  // namespace lagroid
