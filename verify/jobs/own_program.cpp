#include "verify/jobs/own_program.hpp"

#include <fcntl.h>
#include <sys/prctl.h>
#include <sys/wait.h>
#include <unistd.h>

#include <cerrno>
#include <csignal>
#include <system_error>

#include "verify/io/terminal.hpp"

namespace touchstone::verify::jobs {
namespace {

/// Replaces this child by the program, which the system kills when the parent's thread ends.
[[noreturn]] void become(char** arguments, pid_t parent) {
  constexpr int cannot_run = 127;  // as of a shell
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  // The parent may have ended before.
  if (::getppid() != parent) ::_exit(cannot_run);
  ::dup2(::open("/dev/null", O_WRONLY | O_CLOEXEC), STDOUT_FILENO);
  ::execv("/proc/self/exe", arguments);
  ::_exit(cannot_run);
}

}  // namespace

int run_own_program(std::vector<std::string> arguments) {
  std::vector<char*> pointers;
  pointers.reserve(arguments.size() + 1);
  for (std::string& argument : arguments) pointers.push_back(argument.data());
  pointers.push_back(nullptr);
  const pid_t parent = ::getpid(), process = ::fork();
  if (process == 0) become(pointers.data(), parent);
  if (process < 0) throw std::system_error(errno, std::generic_category(), "cannot run a piece");
  int status = 0;
  while (::waitpid(process, &status, 0) < 0 && errno == EINTR) {
    if (io::interrupted()) ::kill(process, SIGINT);
  }
  return WIFEXITED(status) ? WEXITSTATUS(status) : 128 + WTERMSIG(status);
}

}  // namespace touchstone::verify::jobs
