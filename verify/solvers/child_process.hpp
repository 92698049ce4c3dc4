#pragma once

/// \file
/// A child process for code that is not trusted: a copy of this process made by fork(), of which
/// this one survives whatever it does.
///
/// - It leads a process group of its own: the keys of a terminal do not reach it, and processes
///   that it has started (unless they left the group) are killed when it ends.
/// - It dies with this process, even if that is killed. It cannot send this process a signal.
/// - Its memory, its files and their size are limited, it writes no core files and, unless allowed,
///   makes no processes (threads it may make). The limit of memory is of one process.
/// - It works in a folder of its own, reads nothing from standard input, and has no descriptors of
///   this process. Its output is captured.
///
/// In the child there are no other threads: fork() copies only the one that calls it. Code that
/// hands work to threads of a pool that existed before waits for ever.
///
/// The implementation, child_process.cpp, is for Linux alone.

#include <sys/types.h>

#include <chrono>
#include <cstddef>
#include <cstdint>
#include <filesystem>
#include <functional>
#include <optional>
#include <string>

#include "verify/io/descriptor.hpp"
#include "verify/judge/fault.hpp"

namespace touchstone::verify::solvers {

/// Limits of a child process.
struct ChildLimits {
  /// Bytes of memory that it may allocate (heap, stacks, private maps), beyond what it is made
  /// with; 0: no limit. Ignored under the sanitizers, whose own memory has no bound.
  std::uint64_t memory_bytes = std::uint64_t{4} << 30U;
  /// Bytes of a file that it writes; 0: no limit. Beyond, the system ends it with SIGXFSZ.
  std::uint64_t file_bytes = std::uint64_t{256} << 20U;
  /// True if it may make processes. Otherwise fork() fails with EAGAIN. (RLIMIT_NPROC counts all
  /// processes of a user, and does not apply to root.)
  bool may_fork = false;
};

/// A new folder among the system's temporary files. It is removed with its contents when this
/// object is destroyed.
class TemporaryFolder {
 public:
  /// \throws std::system_error if none can be made.
  TemporaryFolder();
  TemporaryFolder(const TemporaryFolder&) = delete;
  TemporaryFolder& operator=(const TemporaryFolder&) = delete;
  TemporaryFolder(TemporaryFolder&&) = delete;
  TemporaryFolder& operator=(TemporaryFolder&&) = delete;
  ~TemporaryFolder();

  [[nodiscard]] const std::filesystem::path& path() const { return path_; }

 private:
  std::filesystem::path path_;
};

/// The beginning of the children's output, standard output and standard error in the order of their
/// arrival.
struct CapturedOutput {
  static constexpr std::size_t most_bytes = std::size_t{1} << 16U;

  std::string text = {};      ///< at most most_bytes
  std::uint64_t dropped = 0;  ///< bytes behind these

  void append(const char* bytes, std::size_t count);
};

/// Outcome of a child process.
struct ChildEnd {
  /// crash or exit.
  judge::Failure failure = {};
  double processor_seconds = 0.0;  ///< of its whole life
};

/// The child's end of the connection: messages are kept apart.
class ChildChannel {
 public:
  static constexpr std::size_t most_bytes = 4096;

  explicit ChildChannel(int socket) : socket_(socket) {}

  /// The next message; nothing once the other end is closed.
  [[nodiscard]] std::optional<std::string> receive() const;
  /// \pre at most most_bytes, at least one. False once the other end is closed.
  [[nodiscard]] bool send(const std::string& message) const;

 private:
  int socket_;
};

/// A running child. May be used by one thread after the other, by one at a time.
class ChildProcess {
 public:
  using Seconds = std::chrono::duration<double>;
  /// The work of the child; it exits with status 0 afterwards, with 1 if it throws.
  using Work = std::function<void(const ChildChannel&)>;

  /// \throws std::system_error if the system cannot make a process.
  ChildProcess(const Work& work, const ChildLimits& limits, const std::filesystem::path& folder);
  ChildProcess(const ChildProcess&) = delete;
  ChildProcess& operator=(const ChildProcess&) = delete;
  ChildProcess(ChildProcess&&) = delete;
  ChildProcess& operator=(ChildProcess&&) = delete;
  /// Kills it and its group.
  ~ChildProcess();

  /// Sends a message. If the child has ended, the message is lost.
  void send(const std::string& message) const;

  enum class Event : std::uint8_t { none, message, ended };

  /// Sleeps until a message arrives or the child ends, at most for this long, and takes its output.
  [[nodiscard]] Event wait(Seconds longest, std::string& message, CapturedOutput& output);

  /// Kills it if it still runs, and the rest of its group, and takes the rest of its output.
  ChildEnd end(CapturedOutput& output);

  /// Processor seconds so far, of all its threads; 0 if it has ended.
  [[nodiscard]] double processor_seconds() const;

  /// True if its main thread is runnable: it has work, and perhaps no processor.
  [[nodiscard]] bool is_runnable() const;

 private:
  void take_output(CapturedOutput& output);
  [[nodiscard]] bool has_ended() const;

  pid_t process_ = -1;
  io::Descriptor socket_;    ///< messages
  io::Descriptor lifeline_;  ///< the child is killed when this closes
  io::Descriptor output_;    ///< its standard output and error
  io::Descriptor ended_;     ///< readable when it has ended
};

}  // namespace touchstone::verify::solvers
