#include "verify/methods/isolation.hpp"

#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <sys/syscall.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <atomic>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <ctime>
#include <memory>
#include <new>
#include <optional>
#include <system_error>

namespace touchstone::verify {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

/// Queries that are timed as one, and solved as one where there is no limit.
constexpr std::size_t span_size = 1024;
/// How often the parent looks even if nothing tells it to: for an interrupt.
constexpr Seconds longest_sleep(0.25);
/// How often where the system cannot tell it that the child has ended.
constexpr Seconds short_sleep(0.005);

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

/// Processor time of this process.
double processor_seconds() {
  timespec now{};
  clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

/// Wall-clock time from a moment that all processes share.
double wall_seconds() { return Seconds(Clock::now().time_since_epoch()).count(); }

double seconds(const timeval& time) {
  return static_cast<double>(time.tv_sec) + static_cast<double>(time.tv_usec) * 1e-6;
}

/// What the child tells the parent besides the answers. The parent reads the times only when the
/// child has ended.
struct Progress {
  std::atomic<std::size_t> current;  ///< first query of the step that the child is at
  std::atomic<bool> complete;        ///< all queries are answered
  double started;                    ///< processor seconds of the child when the solver began
  double started_at;                 ///< wall-clock seconds then; 0 before
  double ended_at;                   ///< the same, when it was done; only if complete
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

  /// Solves a query, for nothing but the pages that this process then has of its own: the copying
  /// would count as time of the solver. With a limit, and on the search for a deadly query, each
  /// query is solved once only.
  void warm_up(std::size_t begin, const SharedMemory& shared) const {
    if (careful(begin)) return;
    shared.progress().current.store(begin, std::memory_order_release);
    method.solve(kind, queries.subspan(begin, 1), shared.answers().subspan(begin, 1), options);
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
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
  ::prctl(PR_SET_DUMPABLE, 0);
  Progress& progress = shared.progress();
  try {
    job.warm_up(begin, shared);
    progress.started = processor_seconds();
    progress.started_at = wall_seconds();
    progress.solving = job.solve(begin, shared);
    progress.ended_at = wall_seconds();
    progress.complete.store(true, std::memory_order_release);
  } catch (...) {
    ::_exit(1);
  }
  ::_exit(0);
}

/// A running child, the leader of a process group. Killed and reaped at the latest when this object
/// goes, with all of the group.
class Child {
 public:
  Child(const Job& job, std::size_t begin, const SharedMemory& shared) {
    const pid_t parent = ::getpid();
    process_ = ::fork();
    if (process_ == 0) live_as_child(job, begin, shared, parent);
    if (process_ < 0) fail("cannot make a solver's process");
    // The child does the same; whoever comes first, the group is there from now on.
    ::setpgid(process_, process_);
    descriptor_ = static_cast<int>(::syscall(SYS_pidfd_open, process_, 0U));
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  Child(Child&&) = delete;
  Child& operator=(Child&&) = delete;
  ~Child() {
    if (!ended_) kill();
    if (descriptor_ >= 0) ::close(descriptor_);
  }

  /// Sleeps until the child ends, at most for this long. True if it has ended.
  bool wait(Seconds longest) {
    const double milliseconds =
        std::min(longest, descriptor_ < 0 ? short_sleep : longest_sleep).count() * 1e3;
    // poll() passes over a descriptor that is none.
    pollfd event{.fd = descriptor_, .events = POLLIN, .revents = 0};
    // A signal to this process cuts the sleep short, which does no harm.
    ::poll(&event, 1, static_cast<int>(milliseconds) + 1);
    if (has_ended()) reap();
    return ended_;
  }

  void kill() {
    ::kill(process_, SIGKILL);
    reap();
  }

  /// Processor seconds in all. Only of a child that has ended.
  [[nodiscard]] double processor_seconds() const { return processor_seconds_; }

 private:
  void reap() {
    // Not yet reaped, the child keeps its number from becoming that of another group.
    ::kill(-process_, SIGKILL);
    int status = 0;
    rusage usage{};
    while (::wait4(process_, &status, 0, &usage) < 0 && errno == EINTR) continue;
    ended_ = true;
    processor_seconds_ = seconds(usage.ru_utime) + seconds(usage.ru_stime);
  }

  /// Looks without reaping.
  [[nodiscard]] bool has_ended() const {
    siginfo_t info{};
    const int result =
        ::waitid(P_PID, static_cast<id_t>(process_), &info, WEXITED | WNOHANG | WNOWAIT);
    // An error means that this process lets the system reap its children.
    return result != 0 || info.si_pid == process_;
  }

  pid_t process_ = -1;
  int descriptor_ = -1;  ///< tells of the end; none where the system has no such thing
  bool ended_ = false;
  double processor_seconds_ = 0.0;
};

/// The parent's side: makes children until every query is answered.
class Supervisor {
 public:
  Supervisor(const Job& job, const IsolationOptions& options)
      : job_(job),
        limit_(options.query_limit_seconds),
        stop_(options.stop),
        shared_(job.queries.size()) {
    if (limit_ > Seconds::zero()) job_.careful_until = job_.queries.size();
  }

  IsolatedSolve run() {
    std::size_t begin = 0;
    while (begin < job_.queries.size()) {
      begin = run_child(begin);
      if (is_to_stop()) break;
    }
    result_.stopped = begin < job_.queries.size();
    return result_;
  }

  [[nodiscard]] std::span<const fast::Answer> answers() const { return shared_.answers(); }

 private:
  [[nodiscard]] bool is_to_stop() const { return stop_ != nullptr && stop_->load(); }

  /// Solves from `begin` on as far as one child gets. Returns where the next one has to begin.
  std::size_t run_child(std::size_t begin) {
    Progress& progress = shared_.progress();
    progress.current = begin;
    progress.complete = false;
    progress.started = 0.0;
    progress.started_at = 0.0;
    Child child(job_, begin, shared_);
    const std::optional<std::size_t> overdue = wait(child);
    if (progress.started_at > 0.0) {
      // The end of a process that is done takes time, too, which is not the solver's.
      const double end = progress.complete ? progress.ended_at : wall_seconds();
      result_.wall_seconds += std::max(0.0, end - progress.started_at);
    }
    if (progress.complete) {
      result_.processor_seconds += progress.solving;
      return job_.queries.size();
    }
    result_.processor_seconds += std::max(0.0, child.processor_seconds() - progress.started);
    if (is_to_stop()) return begin;
    // A solver that writes where it should not may have hit the index as well.
    const std::size_t current = progress.current;
    return go_on(current >= begin && current < job_.queries.size() ? current : begin, overdue);
  }

  /// Returns when the child has ended. If it was killed for it, the query that was overdue.
  std::optional<std::size_t> wait(Child& child) const {
    std::size_t watched = shared_.progress().current;
    Clock::time_point since = Clock::now();
    const bool limited = limit_ > Seconds::zero();
    Seconds left = limited ? limit_ : longest_sleep;
    while (!child.wait(limited ? std::min(left, limit_ / 10) : longest_sleep)) {
      if (is_to_stop()) {
        child.kill();
        return std::nullopt;
      }
      if (!limited) continue;
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
      ++result_.unplaced_crashes;
      searching_ = true;
      return current;
    }
    // Between the last look and the kill, the child may have got an answer after all.
    if (overdue && *overdue != current) return current;
    if (searching_ && job_.careful(current)) {
      // Found: the death of the span was this query's.
      --result_.unplaced_crashes;
      searching_ = false;
    }
    ++(overdue ? result_.limit_hits : result_.crashes);
    shared_.answers()[current] = {.verdict =
                                      overdue ? fast::Verdict::undecided : fast::Verdict::error};
    return current + 1;
  }

  Job job_;
  Seconds limit_;
  const std::atomic<bool>* stop_;
  SharedMemory shared_;
  IsolatedSolve result_;
  /// Is a span solved one by one whose death is not yet that of one of its queries?
  bool searching_ = false;
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
