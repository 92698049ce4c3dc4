#include "verify/solvers/child_process.hpp"

#include <fcntl.h>
#include <linux/audit.h>
#include <linux/filter.h>
#include <linux/seccomp.h>
#include <poll.h>
#include <sched.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/socket.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <ctime>
#include <fstream>
#include <iostream>
#include <span>
#include <system_error>
#include <utility>
#include <vector>

namespace touchstone::verify::solvers {
namespace {

#ifdef TOUCHSTONE_SANITIZED
constexpr bool is_sanitized = true;
#else
constexpr bool is_sanitized = false;
#endif

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

// ---- The child ----------------------------------------------------------------------------------

/// Private memory that can be written, in bytes, as RLIMIT_DATA counts it.
std::uint64_t data_bytes() {
  std::ifstream file("/proc/self/statm");
  std::uint64_t pages = 0;
  constexpr int data_field = 6;
  for (int i = 0; i < data_field; ++i) file >> pages;
  return file ? pages * static_cast<std::uint64_t>(::sysconf(_SC_PAGESIZE)) : 0;
}

/// The type of a resource depends on the C library.
void limit_resource(auto resource, std::uint64_t value) {
  const rlimit limit{.rlim_cur = value, .rlim_max = value};
  ::setrlimit(resource, &limit);
}

// Rules for system calls: of this process, and of those that it makes.
#if defined(__x86_64__) || defined(__aarch64__)

#if defined(__x86_64__)
constexpr std::uint32_t architecture = AUDIT_ARCH_X86_64;
#else
constexpr std::uint32_t architecture = AUDIT_ARCH_AARCH64;
#endif
constexpr sock_filter allow = BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ALLOW);

sock_filter load(std::size_t offset) {
  return BPF_STMT(BPF_LD | BPF_W | BPF_ABS, static_cast<std::uint32_t>(offset));
}

sock_filter fail_with(int error) {
  return BPF_STMT(BPF_RET | BPF_K, SECCOMP_RET_ERRNO | static_cast<std::uint32_t>(error));
}

/// Skips `if_equal` rules if the value is this one, `if_not` rules if it is another.
sock_filter jump(std::uint32_t value, std::size_t if_equal, std::size_t if_not) {
  return BPF_JUMP(BPF_JMP | BPF_JEQ | BPF_K, value, static_cast<std::uint8_t>(if_equal),
                  static_cast<std::uint8_t>(if_not));
}

void apply(std::span<sock_filter> rules) {
  const sock_fprog program{.len = static_cast<unsigned short>(rules.size()),
                           .filter = rules.data()};
  ::prctl(PR_SET_NO_NEW_PRIVS, 1, 0, 0, 0);
  ::prctl(PR_SET_SECCOMP, SECCOMP_MODE_FILTER, &program);
}

/// Forbids making processes; threads are still allowed. The flags of clone() tell a thread from a
/// process; those of clone3() lie in memory, so clone3() is refused, and the C library falls back
/// to clone().
void forbid_processes() {
  std::array rules {
    load(offsetof(seccomp_data, arch)), jump(architecture, 0, 1), load(offsetof(seccomp_data, nr)),
        jump(SYS_clone3, 0, 1), fail_with(ENOSYS),
#if defined(__x86_64__)
        jump(SYS_fork, 0, 1), fail_with(EAGAIN), jump(SYS_vfork, 0, 1), fail_with(EAGAIN),
#endif
        jump(SYS_clone, 0, 4), load(offsetof(seccomp_data, args[0])),
        sock_filter BPF_JUMP(BPF_JMP | BPF_JSET | BPF_K, CLONE_THREAD, 1, 0), fail_with(EAGAIN),
        allow, allow,
  };
  apply(rules);
}

/// Forbids signals to the parent, to its group and to all processes.
void protect_parent() {
  const auto number = [](pid_t process) { return static_cast<std::uint32_t>(process); };
  const std::array targets{number(::getppid()), number(-::getpgid(::getppid())), number(-1)};
  constexpr std::array<std::uint32_t, 6> calls{
      SYS_kill, SYS_tkill, SYS_tgkill, SYS_rt_sigqueueinfo, SYS_rt_tgsigqueueinfo, SYS_pidfd_open};
  std::vector rules{load(offsetof(seccomp_data, arch)), jump(architecture, 1, 0), allow,
                    load(offsetof(seccomp_data, nr))};
  // Each jump leads to the rule after the one that allows all other calls; later ones to the rule
  // after the last.
  for (std::size_t i = 0; i < calls.size(); ++i) {
    rules.push_back(jump(calls.at(i), calls.size() - i, 0));
  }
  rules.insert(rules.end(), {allow, load(offsetof(seccomp_data, args[0]))});
  for (std::size_t i = 0; i < targets.size(); ++i) {
    rules.push_back(jump(targets.at(i), targets.size() - i, 0));
  }
  rules.insert(rules.end(), {allow, fail_with(EPERM)});
  apply(rules);
}

#else
void forbid_processes() {}
void protect_parent() {}
#endif

void set_limits(const ChildLimits& limits) {
  limit_resource(RLIMIT_CORE, 0);
  ::prctl(PR_SET_DUMPABLE, 0);
  if (limits.file_bytes != 0) limit_resource(RLIMIT_FSIZE, limits.file_bytes);
  if (limits.memory_bytes != 0 && !is_sanitized) {
    limit_resource(RLIMIT_DATA, data_bytes() + limits.memory_bytes);
  }
  protect_parent();
  if (!limits.may_fork) forbid_processes();
}

/// Makes the system kill this process and its group when all other ends of the pipe are closed,
/// that is, when the parent has ended. (PR_SET_PDEATHSIG would be about the thread that made this
/// process.)
void die_with(int lifeline) {
  ::fcntl(lifeline, F_SETOWN, -::getpid());
  ::fcntl(lifeline, F_SETSIG, SIGKILL);
  ::fcntl(lifeline, F_SETFL, O_ASYNC | O_NONBLOCK);
  pollfd event{.fd = lifeline, .events = POLLIN, .revents = 0};
  if (::poll(&event, 1, 0) > 0) ::_exit(1);
}

/// The child's ends of its connections with the parent.
struct ChildEnds {
  int socket;
  int lifeline;
  int output;
};

/// Closes all descriptors but these, which get other numbers.
ChildEnds keep_only(const ChildEnds& ends) {
  constexpr int first_free = 3;
  // Out of the way of the numbers that they are to have.
  constexpr int aside = 16;
  const int socket = ::fcntl(ends.socket, F_DUPFD, aside);
  const int lifeline = ::fcntl(ends.lifeline, F_DUPFD, aside);
  const int output = ::fcntl(ends.output, F_DUPFD, aside);
  const int nothing = ::open("/dev/null", O_RDONLY);
  ::dup2(nothing, STDIN_FILENO);
  ::dup2(output, STDOUT_FILENO);
  ::dup2(output, STDERR_FILENO);
  ::dup2(socket, first_free);
  ::dup2(lifeline, first_free + 1);
  ::syscall(SYS_close_range, first_free + 2, ~0U, 0U);
  return {.socket = first_free, .lifeline = first_free + 1, .output = STDOUT_FILENO};
}

[[noreturn]] void leave(int status, void* = nullptr) {
  std::fflush(stdout);
  std::cout.flush();
  ::_exit(status);
}

[[noreturn]] void live(const ChildProcess::Work& work, const ChildLimits& limits,
                       const std::filesystem::path& folder, const ChildEnds& inherited) {
  ::setpgid(0, 0);
  // Those of crashes too, which a sanitizer would make exits of.
  for (const int signal : {SIGINT, SIGTERM, SIGHUP, SIGPIPE, SIGCHLD, SIGXFSZ, SIGSEGV, SIGBUS,
                           SIGFPE, SIGILL, SIGABRT}) {
    std::signal(signal, SIG_DFL);
  }
  const ChildEnds ends = keep_only(inherited);
  die_with(ends.lifeline);
  // The last registered function runs first: the clean-up of the parent's copy is not for this
  // process, whose threads it would wait for.
  ::on_exit(leave, nullptr);
  int status = 1;
  try {
    std::filesystem::current_path(folder);
    set_limits(limits);
    work(ChildChannel(ends.socket));
    status = 0;
  } catch (...) {
    status = 1;
  }
  leave(status);
}

// ---- The parent ---------------------------------------------------------------------------------

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
}

/// The two descriptors that a system call has made. \param result of the call, negative if it
/// failed
std::pair<io::Descriptor, io::Descriptor> checked(int result, const std::array<int, 2>& ends) {
  if (result != 0) fail("cannot talk to a solver's process");
  return {io::Descriptor(ends[0]), io::Descriptor(ends[1])};
}

std::pair<io::Descriptor, io::Descriptor> make_pipe() {
  std::array<int, 2> ends{};
  const int result = ::pipe2(ends.data(), O_CLOEXEC);
  return checked(result, ends);
}

std::pair<io::Descriptor, io::Descriptor> make_sockets() {
  std::array<int, 2> ends{};
  const int result = ::socketpair(AF_UNIX, SOCK_SEQPACKET | SOCK_CLOEXEC, 0, ends.data());
  return checked(result, ends);
}

}  // namespace

TemporaryFolder::TemporaryFolder() {
  std::string name = (std::filesystem::temp_directory_path() / "touchstone-XXXXXX").string();
  if (::mkdtemp(name.data()) == nullptr) fail("cannot make a temporary folder");
  path_ = name;
}

TemporaryFolder::~TemporaryFolder() {
  std::error_code ignored;
  std::filesystem::remove_all(path_, ignored);
}

void CapturedOutput::append(const char* bytes, std::size_t count) {
  const std::size_t kept = std::min(count, most_bytes - std::min(most_bytes, text.size()));
  text.append(bytes, kept);
  dropped += count - kept;
}

std::optional<std::string> ChildChannel::receive() const {
  std::string message(most_bytes, '\0');
  ssize_t received = 0;
  do {
    received = ::recv(socket_, message.data(), message.size(), 0);
  } while (received < 0 && errno == EINTR);
  if (received <= 0) return std::nullopt;
  message.resize(static_cast<std::size_t>(received));
  return message;
}

bool ChildChannel::send(const std::string& message) const {
  return ::send(socket_, message.data(), message.size(), MSG_NOSIGNAL) >= 0;
}

ChildProcess::ChildProcess(const Work& work, const ChildLimits& limits,
                           const std::filesystem::path& folder) {
  auto [socket, child_socket] = make_sockets();
  auto [child_lifeline, lifeline] = make_pipe();
  auto [output, child_output] = make_pipe();
  ::fcntl(output.get(), F_SETFL, O_NONBLOCK);
  // Buffered output belongs to this process.
  std::fflush(stdout);
  process_ = ::fork();
  if (process_ == 0) {
    live(work, limits, folder,
         {.socket = child_socket.get(),
          .lifeline = child_lifeline.get(),
          .output = child_output.get()});
  }
  if (process_ < 0) fail("cannot make a solver's process");
  // The child does the same; whoever comes first, the group is there from now on.
  ::setpgid(process_, process_);
  socket_ = std::move(socket);
  lifeline_ = std::move(lifeline);
  output_ = std::move(output);
  ended_ = io::Descriptor(static_cast<int>(::syscall(SYS_pidfd_open, process_, 0U)));
}

ChildProcess::~ChildProcess() {
  CapturedOutput ignored;
  if (process_ >= 0) end(ignored);
}

void ChildProcess::send(const std::string& message) const {
  static_cast<void>(
      ::send(socket_.get(), message.data(), message.size(), MSG_NOSIGNAL | MSG_DONTWAIT));
}

ChildProcess::Event ChildProcess::wait(Seconds longest, std::string& message,
                                       CapturedOutput& output) {
  // poll() passes over descriptors that are none.
  std::array<pollfd, 3> events{{{.fd = socket_.get(), .events = POLLIN, .revents = 0},
                                {.fd = output_.get(), .events = POLLIN, .revents = 0},
                                {.fd = ended_.get(), .events = POLLIN, .revents = 0}}};
  // A signal to this process cuts the sleep short, which does no harm.
  ::poll(events.data(), events.size(), static_cast<int>(longest.count() * 1e3) + 1);
  const bool has_ended = this->has_ended();
  message.resize(ChildChannel::most_bytes);
  const ssize_t received = ::recv(socket_.get(), message.data(), message.size(), MSG_DONTWAIT);
  message.resize(static_cast<std::size_t>(std::max<ssize_t>(received, 0)));
  // The child may have closed its end, and live on.
  if (received == 0) socket_.close();
  // The output is read after the message, so that output before the message is included.
  take_output(output);
  if (!message.empty()) return Event::message;
  return has_ended ? Event::ended : Event::none;
}

void ChildProcess::take_output(CapturedOutput& output) {
  std::array<char, 4096> buffer{};
  // Not for ever: the child may print as fast as this reads.
  constexpr int most_reads = 256;
  for (int i = 0; i < most_reads && output_.get() >= 0; ++i) {
    const ssize_t count = ::read(output_.get(), buffer.data(), buffer.size());
    if (count > 0) output.append(buffer.data(), static_cast<std::size_t>(count));
    if (count == 0) output_.close();
    if (count < 0 && errno != EINTR) return;
  }
}

ChildEnd ChildProcess::end(CapturedOutput& output) {
  // Not yet reaped, the child keeps its number from becoming that of another group.
  if (!has_ended()) ::kill(process_, SIGKILL);
  ::kill(-process_, SIGKILL);
  int status = 0;
  rusage usage{};
  pid_t reaped = 0;
  do {
    reaped = ::wait4(process_, &status, 0, &usage);
  } while (reaped < 0 && errno == EINTR);
  process_ = -1;
  take_output(output);
  ChildEnd result;
  // If this process lets the system reap its children, the end is not known.
  result.failure = {.kind = judge::Fault::crash};
  if (reaped > 0 && WIFEXITED(status)) {
    result.failure = {.kind = judge::Fault::exit, .number = WEXITSTATUS(status)};
  } else if (reaped > 0) {
    result.failure.number = WTERMSIG(status);
  }
  result.processor_seconds = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  return result;
}

double ChildProcess::processor_seconds() const {
  clockid_t clock{};
  timespec now{};
  if (::clock_getcpuclockid(process_, &clock) != 0 || ::clock_gettime(clock, &now) != 0) return 0.0;
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

bool ChildProcess::is_runnable() const {
  std::ifstream file("/proc/" + std::to_string(process_) + "/stat");
  std::string text;
  std::getline(file, text);
  // The state stands behind the name of the program, which may hold anything.
  const std::size_t behind_name = text.rfind(") ");
  return behind_name != std::string::npos && text.compare(behind_name + 2, 1, "R") == 0;
}

/// Looks without reaping.
bool ChildProcess::has_ended() const {
  siginfo_t info{};
  const int result =
      ::waitid(P_PID, static_cast<id_t>(process_), &info, WEXITED | WNOHANG | WNOWAIT);
  // An error means that this process lets the system reap its children.
  return result != 0 || info.si_pid == process_;
}

}  // namespace touchstone::verify::solvers
