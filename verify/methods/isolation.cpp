#include "verify/methods/isolation.hpp"

#include <fcntl.h>
#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <ctime>
#include <memory>
#include <mutex>
#include <new>
#include <optional>
#include <system_error>

namespace touchstone::verify {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

/// Queries that are timed as one, and solved as one where there is no limit.
constexpr std::size_t span_size = 1024;
/// How often the parent looks even if nothing tells it to: no wake-up can then be lost for good.
constexpr Seconds longest_sleep(1.0);

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

/// Processor time of this process.
double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
}

/// What the child tells the parent besides the answers. The parent reads the times only when the
/// child has ended.
struct Progress {
  std::atomic<std::size_t> current;  ///< first query of the step that the child is at
  std::atomic<bool> complete;        ///< all queries are answered
  double started;                    ///< processor seconds of the child when the solver began
  double solving;                    ///< processor seconds of the solver; only if complete
};
static_assert(std::atomic<std::size_t>::is_always_lock_free &&
              std::atomic<bool>::is_always_lock_free);

/// Memory that a child made later shares with this process: the progress and all answers.
class SharedMemory {
 public:
  explicit SharedMemory(std::size_t answers)
      : bytes_(sizeof(Progress) + answers * sizeof(fast::Answer)),
        memory_(
            ::mmap(nullptr, bytes_, PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0)) {
    // NOLINTNEXTLINE(performance-no-int-to-ptr): the system's constant
    if (memory_ == MAP_FAILED) fail("cannot share memory with a solver's process");
    progress_ = new (memory_) Progress{};
    answers_ = {reinterpret_cast<fast::Answer*>(progress_ + 1), answers};
  }
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;
  SharedMemory(SharedMemory&&) = delete;
  SharedMemory& operator=(SharedMemory&&) = delete;
  ~SharedMemory() { ::munmap(memory_, bytes_); }

  [[nodiscard]] Progress& progress() const { return *progress_; }
  [[nodiscard]] std::span<fast::Answer> answers() const { return answers_; }

 private:
  std::size_t bytes_;
  void* memory_;
  Progress* progress_ = nullptr;
  std::span<fast::Answer> answers_;
};
static_assert(sizeof(Progress) % alignof(fast::Answer) == 0);

/// What is to be solved, in steps that a death is charged to.
struct Job {
  const fast::Method& method;
  Kind kind;
  std::span<const Query> queries;
  const fast::MethodOptions& options;
  /// Queries before this index are solved one by one.
  std::size_t careful_until;

  [[nodiscard]] bool careful(std::size_t begin) const { return begin < careful_until; }

  /// Number of queries in the step that begins at this index.
  [[nodiscard]] std::size_t step(std::size_t begin) const {
    return careful(begin) ? 1 : std::min(span_size, queries.size() - begin);
  }

  /// Solves from `begin` on and returns the processor seconds that the solver took.
  double solve(std::size_t begin, const SharedMemory& shared) const {
    double sum = 0.0;
    for (std::size_t end = begin; begin < queries.size(); begin = end) {
      end = careful(begin) ? std::min(begin + span_size, careful_until) : begin + step(begin);
      // Shared pages that this process has not touched yet would count as time of the solver.
      std::ranges::uninitialized_value_construct(shared.answers().subspan(begin, end - begin));
      const double start = processor_seconds();
      solve_steps(begin, end, shared);
      sum += processor_seconds() - start;
    }
    return sum;
  }

 private:
  void solve_steps(std::size_t begin, std::size_t end, const SharedMemory& shared) const {
    while (begin < end) {
      const std::size_t count = step(begin);
      shared.progress().current.store(begin, std::memory_order_release);
      method.solve(kind, queries.subspan(begin, count), shared.answers().subspan(begin, count),
                   options);
      begin += count;
    }
  }
};

/// The child's whole life. It leaves without the parent's clean-up, and dies with the thread that
/// made it, which does not leave run_child() before.
[[noreturn]] void live_as_child(const Job& job, std::size_t begin, const SharedMemory& shared,
                                pid_t parent) {
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
  ::prctl(PR_SET_DUMPABLE, 0);
  Progress& progress = shared.progress();
  try {
    progress.started = processor_seconds();
    progress.solving = job.solve(begin, shared);
    progress.complete.store(true, std::memory_order_release);
  } catch (...) {
    ::_exit(1);
  }
  ::_exit(0);
}

/// A running child. Killed and reaped at the latest when this object goes.
class Child {
 public:
  Child(const Job& job, std::size_t begin, const SharedMemory& shared) {
    // A child made by another thread between these calls would inherit the pipe's end for writing,
    // and this child's end would not be seen before that one's.
    static std::mutex mutex;
    const std::lock_guard lock(mutex);
    std::array<int, 2> ends{};
    if (::pipe2(ends.data(), O_CLOEXEC) != 0) fail("cannot make a pipe to a solver's process");
    const pid_t parent = ::getpid();
    process_ = ::fork();
    if (process_ == 0) live_as_child(job, begin, shared, parent);
    const int fork_error = errno;
    ::close(ends[1]);
    pipe_ = ends[0];
    if (process_ > 0) return;
    ::close(pipe_);
    errno = fork_error;
    fail("cannot make a solver's process");
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  Child(Child&&) = delete;
  Child& operator=(Child&&) = delete;
  ~Child() {
    if (!ended_) kill();
    ::close(pipe_);
  }

  /// Sleeps until the child ends, at most for this long. True if it has ended.
  bool wait(Seconds longest) {
    pollfd event{.fd = pipe_, .events = POLLIN, .revents = 0};
    const double milliseconds = std::min(longest, longest_sleep).count() * 1e3;
    // A signal to this process cuts the sleep short, which does no harm.
    const bool closed = ::poll(&event, 1, static_cast<int>(milliseconds) + 1) > 0;
    return reap(closed ? 0 : WNOHANG);
  }

  void kill() {
    ::kill(process_, SIGKILL);
    reap(0);
  }

  /// Processor seconds in all. Only of a child that has ended.
  [[nodiscard]] double processor_seconds() const { return processor_seconds_; }

 private:
  bool reap(int flags) {
    int status = 0;
    rusage usage{};
    pid_t reaped = 0;
    do {
      reaped = ::wait4(process_, &status, flags, &usage);
    } while (reaped < 0 && errno == EINTR);
    // An error means that this process lets the system reap its children.
    ended_ = reaped != 0;
    processor_seconds_ = seconds(usage.ru_utime) + seconds(usage.ru_stime);
    return ended_;
  }

  pid_t process_ = -1;
  int pipe_ = -1;
  bool ended_ = false;
  double processor_seconds_ = 0.0;
};

/// The parent's side: makes children until every query is answered.
class Supervisor {
 public:
  Supervisor(const Job& job, const IsolationOptions& options)
      : job_(job), limit_(options.query_limit_seconds), shared_(job.queries.size()) {
    if (limit_ > Seconds::zero()) job_.careful_until = job_.queries.size();
  }

  IsolatedSolve run() {
    for (std::size_t begin = 0; begin < job_.queries.size();) begin = run_child(begin);
    return result_;
  }

  [[nodiscard]] std::span<const fast::Answer> answers() const { return shared_.answers(); }

 private:
  /// Solves from `begin` on as far as one child gets. Returns where the next one has to begin.
  std::size_t run_child(std::size_t begin) {
    Progress& progress = shared_.progress();
    progress.current = begin;
    progress.complete = false;
    progress.started = 0.0;
    Child child(job_, begin, shared_);
    const std::optional<std::size_t> overdue = wait(child);
    if (progress.complete) {
      result_.processor_seconds += progress.solving;
      return job_.queries.size();
    }
    result_.processor_seconds += std::max(0.0, child.processor_seconds() - progress.started);
    // A solver that writes where it should not may have hit the index as well.
    const std::size_t current = progress.current;
    return go_on(current >= begin && current < job_.queries.size() ? current : begin, overdue);
  }

  /// Returns when the child has ended. If it was killed for it, the query that was overdue.
  std::optional<std::size_t> wait(Child& child) const {
    if (limit_ == Seconds::zero()) {
      while (!child.wait(longest_sleep)) continue;
      return std::nullopt;
    }
    std::size_t watched = shared_.progress().current;
    Clock::time_point since = Clock::now();
    Seconds left = limit_;
    while (!child.wait(std::min(left, limit_ / 10))) {
      const std::size_t current = shared_.progress().current;
      const Clock::time_point now = Clock::now();
      if (current != watched) {
        watched = current;
        since = now;
      }
      left = limit_ - (now - since);
      if (left > Seconds::zero()) continue;
      child.kill();
      return watched;
    }
    return std::nullopt;
  }

  /// Answers the query at which a child ended, or has its span solved once more one by one.
  std::size_t go_on(std::size_t current, std::optional<std::size_t> overdue) {
    const std::size_t count = job_.step(current);
    if (count > 1) {
      job_.careful_until = current + count;
      return current;
    }
    // Between the last look and the kill, the child may have got an answer after all.
    if (overdue && *overdue != current) return current;
    ++(overdue ? result_.limit_hits : result_.crashes);
    shared_.answers()[current] = {.verdict =
                                      overdue ? fast::Verdict::undecided : fast::Verdict::error};
    return current + 1;
  }

  Job job_;
  Seconds limit_;
  SharedMemory shared_;
  IsolatedSolve result_;
};

}  // namespace

IsolatedSolve solve_isolated(const fast::Method& method, Kind kind, std::span<const Query> queries,
                             std::span<fast::Answer> answers,
                             const fast::MethodOptions& method_options,
                             const IsolationOptions& options) {
  Supervisor supervisor({.method = method,
                         .kind = kind,
                         .queries = queries,
                         .options = method_options,
                         .careful_until = 0},
                        options);
  const IsolatedSolve result = supervisor.run();
  std::ranges::copy(supervisor.answers(), answers.begin());
  return result;
}

}  // namespace touchstone::verify
