/// \file
/// A solver written in Python as a plugin of the command line (touchstone/plugin.h).
///
/// The process that asks starts an interpreter of its own, which reads the solver from a file and
/// then answers batch after batch through a socket (touchstone/_child.py). What the interpreter
/// does, this process does too: where it is ended by a signal, or ends itself, the process ends in
/// the same way, and whoever asked it sees that as the end of any other solver. The interpreter is
/// killed with the group of the process.
///
/// The environment says the rest: TOUCHSTONE_PYTHON the interpreter's program,
/// TOUCHSTONE_PYTHON_SCRIPT what it runs, TOUCHSTONE_PYTHON_SOLVER the file,
/// TOUCHSTONE_PYTHON_NAME the solver's name.

#include <fcntl.h>
#include <spawn.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdlib>
#include <mutex>
#include <stdexcept>
#include <string>
#include <system_error>

#include "touchstone/plugin.h"

extern char** environ;

namespace {

/// The interpreter's end of the socket.
constexpr int interpreter_socket = 3;

/// The coordinates of the queries follow.
struct Request {
  std::int64_t number;
  std::int64_t kind;
  std::int64_t count;
  TouchstonePluginOptions options;
};

/// Before the answers, or an exception's text.
struct Reply {
  std::int64_t number;   ///< of the request
  std::int64_t process;  ///< that writes it
  std::int64_t bytes;    ///< of the text; −1: answers follow
};

std::string setting(const char* name) {
  const char* const value = std::getenv(name);
  if (value == nullptr) throw std::runtime_error(std::string(name) + " is not set");
  return value;
}

class Interpreter {
 public:
  Interpreter() {
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
      throw std::system_error(errno, std::generic_category(), "socketpair");
    }
    socket_ = ends[0];
    // dup2() to the same number would leave the descriptor closed by exec().
    const int theirs = ::fcntl(ends[1], F_DUPFD_CLOEXEC, interpreter_socket + 1);
    ::close(ends[1]);
    std::string program = setting("TOUCHSTONE_PYTHON");
    std::string solver = setting("TOUCHSTONE_PYTHON_SOLVER");
    std::string script = setting("TOUCHSTONE_PYTHON_SCRIPT");
    const std::array<char*, 4> arguments{program.data(), script.data(), solver.data(), nullptr};
    posix_spawn_file_actions_t actions;
    ::posix_spawn_file_actions_init(&actions);
    ::posix_spawn_file_actions_adddup2(&actions, theirs, interpreter_socket);
    const int error =
        ::posix_spawn(&process_, program.c_str(), &actions, nullptr, arguments.data(), environ);
    ::posix_spawn_file_actions_destroy(&actions);
    ::close(theirs);
    if (error != 0) throw std::system_error(error, std::generic_category(), program);
  }

  void solve(Request request, const double* coordinates, TouchstonePluginAnswer* answers) {
    request.number = ++requests_;
    const auto count = std::size_t(request.count);
    transfer(::send, &request, sizeof request);
    transfer(::send, coordinates, count * sizeof(double) * 24);
    Reply reply{};
    transfer(::recv, &reply, sizeof reply);
    if (reply.number != requests_ || reply.process != process_) {
      throw std::runtime_error("the reply is not that of the interpreter to this request");
    }
    if (reply.bytes < 0) {
      transfer(::recv, answers, count * sizeof *answers);
      return;
    }
    std::string text(std::size_t(reply.bytes), ' ');
    transfer(::recv, text.data(), text.size());
    throw std::runtime_error(text);
  }

 private:
  template <class Call, class Data>
  void transfer(const Call& call, Data* data, std::size_t bytes) {
    auto* at = reinterpret_cast<const char*>(data);
    while (bytes > 0) {
      const ssize_t done = call(socket_, const_cast<char*>(at), bytes, MSG_NOSIGNAL);
      if (done < 0 && errno == EINTR) continue;
      if (done <= 0) end_as_the_interpreter();
      at += done;
      bytes -= std::size_t(done);
    }
  }

  [[noreturn]] void end_as_the_interpreter() const {
    int status = 0;
    while (::waitpid(process_, &status, 0) < 0 && errno == EINTR) {
    }
    if (WIFSIGNALED(status)) {
      ::signal(WTERMSIG(status), SIG_DFL);
      ::raise(WTERMSIG(status));
    }
    ::_exit(WEXITSTATUS(status));
  }

  int socket_ = -1;
  pid_t process_ = 0;
  std::int64_t requests_ = 0;
};

}  // namespace

int32_t touchstone_plugin_version(void) { return TOUCHSTONE_PLUGIN_VERSION; }

const char* touchstone_plugin_name(void) {
  static const std::string name = setting("TOUCHSTONE_PYTHON_NAME");
  return name.c_str();
}

void touchstone_plugin_promise(TouchstonePluginPromise* promise) {
  promise->elements[0] = promise->elements[1] = 1;
}

void touchstone_plugin_solve_batch(int32_t kind, int64_t count, const double* coordinates,
                                   const TouchstonePluginOptions* options,
                                   TouchstonePluginAnswer* answers) {
  static std::mutex guard;
  static Interpreter interpreter;
  const std::scoped_lock lock(guard);
  interpreter.solve({.number = 0, .kind = kind, .count = count, .options = *options}, coordinates,
                    answers);
}

void touchstone_plugin_solve(int32_t kind, const double* coordinates,
                             const TouchstonePluginOptions* options,
                             TouchstonePluginAnswer* answer) {
  touchstone_plugin_solve_batch(kind, 1, coordinates, options, answer);
}
