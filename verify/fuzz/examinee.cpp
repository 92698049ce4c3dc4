#include "verify/fuzz/examinee.hpp"

#include <poll.h>
#include <sys/mman.h>
#include <sys/prctl.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <new>
#include <system_error>
#include <type_traits>

#include "verify/deadline.hpp"
#include "verify/methods/isolation.hpp"

namespace touchstone::verify {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

/// Queries for which there is room; longer calls are cut into pieces.
constexpr std::size_t room = 4096;
/// Queries in a step.
constexpr std::size_t longest_step = 512;
/// A step that takes less than this share of the limit may be followed by one twice as long.
constexpr double step_share = 0.02;
/// How often this process looks even if nothing tells it to: for an interrupt.
constexpr Seconds longest_sleep(0.25);

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

/// What both processes see.
struct Shared {
  std::atomic<std::size_t> begin;  ///< of the step that the child is at
  std::atomic<std::size_t> end;
  Kind kind;
  std::size_t first;          ///< queries from this number
  std::size_t last;           ///< to before this one are to be solved,
  std::size_t careful_until;  ///< those before this one in steps of one
  std::array<Query, room> queries;
  std::array<fast::Answer, room> answers;
};
static_assert(std::atomic<std::size_t>::is_always_lock_free);
static_assert(std::is_trivially_destructible_v<Shared>);

/// Memory that children made later share with this process.
class SharedMemory {
 public:
  SharedMemory()
      : memory_(::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS,
                       -1, 0)) {
    // NOLINTNEXTLINE(performance-no-int-to-ptr): the system's constant
    if (memory_ == MAP_FAILED) fail("cannot share memory with a solver's process");
    shared_ = new (memory_) Shared{};
  }
  SharedMemory(const SharedMemory&) = delete;
  SharedMemory& operator=(const SharedMemory&) = delete;
  SharedMemory(SharedMemory&&) = delete;
  SharedMemory& operator=(SharedMemory&&) = delete;
  ~SharedMemory() { ::munmap(memory_, sizeof(Shared)); }

  [[nodiscard]] Shared& operator*() const { return *shared_; }

 private:
  void* memory_;
  Shared* shared_ = nullptr;
};

/// What the child runs.
struct Task {
  const fast::Method& method;
  const ExamineeOptions& options;
  Shared& shared;
};

/// Solves all that is asked, in steps whose length follows the pace.
void solve_block(const Task& task, std::size_t& step) {
  Shared& shared = task.shared;
  const double longest = step_share * task.options.query_limit_seconds;
  for (std::size_t begin = shared.first; begin < shared.last;) {
    const bool careful = begin < shared.careful_until;
    const std::size_t count = careful ? 1 : std::min(step, shared.last - begin);
    shared.end.store(begin + count, std::memory_order_release);
    shared.begin.store(begin, std::memory_order_release);
    const Clock::time_point start = Clock::now();
    task.method.solve(shared.kind, std::span(shared.queries).subspan(begin, count),
                      std::span(shared.answers).subspan(begin, count), task.options.method);
    const bool is_fast = longest == 0.0 || Seconds(Clock::now() - start).count() < longest;
    step = is_fast ? std::min(2 * step, longest_step) : std::max<std::size_t>(1, step / 2);
    begin += count;
  }
}

/// The child's whole life: until the other end of the socket closes, or the parent is gone.
[[noreturn]] void live_as_child(const Task& task, int socket, pid_t parent) {
  ::setpgid(0, 0);
  ::prctl(PR_SET_PDEATHSIG, SIGKILL);
  if (::getppid() != parent) ::_exit(1);
  ::prctl(PR_SET_DUMPABLE, 0);
  std::size_t step = 1;
  char message = 0;
  try {
    while (::recv(socket, &message, 1, 0) == 1) {
      solve_block(task, step);
      if (::send(socket, &message, 1, MSG_NOSIGNAL) != 1) break;
    }
  } catch (...) {
    ::_exit(1);
  }
  ::_exit(0);
}

/// A running child, the leader of a process group. Killed and reaped when this object goes.
class Child {
 public:
  explicit Child(const Task& task) {
    std::array<int, 2> ends{};
    if (::socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0) {
      fail("cannot talk to a solver's process");
    }
    const pid_t parent = ::getpid();
    process_ = ::fork();
    if (process_ == 0) {
      ::close(ends[0]);
      live_as_child(task, ends[1], parent);
    }
    socket_ = ends[0];
    ::close(ends[1]);
    if (process_ < 0) {
      ::close(socket_);
      fail("cannot make a solver's process");
    }
    // The child does the same; whoever comes first, the group is there from now on.
    ::setpgid(process_, process_);
  }
  Child(const Child&) = delete;
  Child& operator=(const Child&) = delete;
  Child(Child&&) = delete;
  Child& operator=(Child&&) = delete;
  ~Child() {
    ::kill(process_, SIGKILL);
    ::kill(-process_, SIGKILL);
    while (::waitpid(process_, nullptr, 0) < 0 && errno == EINTR) continue;
    ::close(socket_);
  }

  /// Tells it to begin. A child that is gone shows in wait().
  void begin() const {
    const char message = 0;
    static_cast<void>(::send(socket_, &message, 1, MSG_NOSIGNAL));
  }

  enum class News : std::uint8_t { none, done, dead };

  /// Sleeps until there is something to tell, at most for this long.
  [[nodiscard]] News wait(Seconds longest) const {
    pollfd event{.fd = socket_, .events = POLLIN, .revents = 0};
    ::poll(&event, 1, static_cast<int>(longest.count() * 1e3) + 1);
    char message = 0;
    const ssize_t received = ::recv(socket_, &message, 1, MSG_DONTWAIT);
    if (received == 1) return News::done;
    if (received == 0 || (errno != EAGAIN && errno != EINTR)) return News::dead;
    // What the solver has started in turn may hold the socket open.
    siginfo_t info{};
    const int result =
        ::waitid(P_PID, static_cast<id_t>(process_), &info, WEXITED | WNOHANG | WNOWAIT);
    return result != 0 || info.si_pid == process_ ? News::dead : News::none;
  }

 private:
  pid_t process_ = -1;
  int socket_ = -1;
};

}  // namespace

class Examinee::Impl {
 public:
  Impl(const fast::Method& method, const ExamineeOptions& options)
      : method_(method), options_(options) {}

  Sitting answer(Kind kind, std::span<const Query> queries, std::span<fast::Answer> answers,
                 double seconds) {
    deadline_ = Deadline(seconds);
    Sitting sitting;
    while (sitting.answered < queries.size() && !is_stopped() &&
           sitting.incidents.size() < options_.most_incidents) {
      const std::size_t first = sitting.answered;
      const std::size_t count = std::min(room, queries.size() - first);
      answer_piece(kind, queries.subspan(first, count), answers.subspan(first, count), first,
                   sitting);
    }
    return sitting;
  }

 private:
  [[nodiscard]] bool is_stopped() const {
    return (options_.stop != nullptr && options_.stop->load()) || deadline_.is_over();
  }

  /// Answers what fits into the shared memory, which begins at number `offset` of all.
  void answer_piece(Kind kind, std::span<const Query> queries, std::span<fast::Answer> answers,
                    std::size_t offset, Sitting& sitting) {
    Shared& shared = *memory_;
    std::ranges::copy(queries, shared.queries.begin());
    shared.kind = kind;
    shared.last = queries.size();
    shared.careful_until = 0;
    searching_ = false;
    for (std::size_t first = 0; first < queries.size();) {
      const Child::News news = run_child(first);
      const bool done = news == Child::News::done;
      if (!done) child_.reset();
      // The solver may have written where it should not.
      const std::size_t begin =
          done ? queries.size() : std::clamp(shared.begin.load(), first, queries.size() - 1);
      const std::size_t end =
          done ? begin : std::clamp(shared.end.load(), begin + 1, queries.size());
      std::ranges::copy(std::span(shared.answers).subspan(first, begin - first),
                        answers.subspan(first).begin());
      sitting.answered = offset + begin;
      if (is_stopped()) return;
      if (searching_ && begin >= shared.careful_until) give_up_search(sitting);
      if (done) return;
      first = begin;
      if (end - begin > 1) {
        shared.careful_until = end;
        searching_ = news == Child::News::dead;
        continue;
      }
      if (!confirm(kind, queries.subspan(begin, 1), answers.subspan(begin, 1), sitting)) return;
      if (news == Child::News::dead && !is_last_incident(sitting, offset + begin)) {
        ++sitting.unplaced;
      }
      if (sitting.incidents.size() >= options_.most_incidents) return;
      ++first;
    }
  }

  /// A step ended the child, none of its queries alone did.
  void give_up_search(Sitting& sitting) {
    ++sitting.unplaced;
    searching_ = false;
  }

  [[nodiscard]] static bool is_last_incident(const Sitting& sitting, std::size_t position) {
    return !sitting.incidents.empty() && sitting.incidents.back().position == position;
  }

  /// Has the child, a new one if need be, solve from `first` on. No news: it takes too long, or is to
  /// stop.
  Child::News run_child(std::size_t first) {
    Shared& shared = *memory_;
    shared.first = first;
    shared.begin = first;
    shared.end = first + 1;
    if (!child_) child_ = std::make_unique<Child>(Task{method_, options_, shared});
    child_->begin();
    const Seconds limit(options_.query_limit_seconds);
    const bool limited = limit > Seconds::zero();
    std::size_t watched = first;
    Clock::time_point since = Clock::now();
    while (!is_stopped()) {
      const auto news = child_->wait(limited ? std::min(longest_sleep, limit / 10) : longest_sleep);
      if (news != Child::News::none) return news;
      const std::size_t current = shared.begin;
      const Clock::time_point now = Clock::now();
      if (current != watched) since = now;
      watched = current;
      if (limited && now - since > limit) break;
    }
    return Child::News::none;
  }

  /// Solves a query that ended or held up the child once more, alone. On a busy machine what gets
  /// little processor time gets more time, as long as there is some. False if stopped.
  bool confirm(Kind kind, std::span<const Query> query, std::span<fast::Answer> answer,
               Sitting& sitting) {
    constexpr double longer = 5.0, least = 1e-3;
    IsolatedSolve solved;
    for (const double factor : {1.0, longer}) {
      double limit = factor * options_.query_limit_seconds;
      if (limit > 0.0) limit = std::clamp(deadline_.seconds_left(), least, limit);
      solved = solve_isolated(method_, kind, query, answer, options_.method,
                              {.query_limit_seconds = limit, .stop = options_.stop});
      if (solved.stopped) return false;
      if (solved.limit_hits == 0 || solved.processor_seconds > 0.5 * limit) break;
    }
    if (solved.crashes + solved.limit_hits != 0) {
      sitting.incidents.push_back({.position = sitting.answered, .hang = solved.limit_hits != 0});
    }
    searching_ = false;
    ++sitting.answered;
    return true;
  }

  const fast::Method& method_;
  ExamineeOptions options_;
  SharedMemory memory_;
  std::unique_ptr<Child> child_;
  Deadline deadline_;
  /// Is a step solved one by one since the child died in it?
  bool searching_ = false;
};

Examinee::Examinee(const fast::Method& method, const ExamineeOptions& options)
    : impl_(std::make_unique<Impl>(method, options)) {}

Examinee::~Examinee() = default;

Sitting Examinee::answer(Kind kind, std::span<const Query> queries, std::span<fast::Answer> answers,
                         double seconds) {
  return impl_->answer(kind, queries, answers, seconds);
}

}  // namespace touchstone::verify
