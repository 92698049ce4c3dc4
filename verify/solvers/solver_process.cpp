#include "verify/solvers/solver_process.hpp"

#include <sys/mman.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstdio>
#include <cstring>
#include <ctime>
#include <exception>
#include <iostream>
#include <new>
#include <optional>
#include <string>
#include <system_error>
#include <type_traits>
#include <utility>

#include "verify/base/deadline.hpp"

namespace touchstone::verify::solvers {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

/// Queries for which there is room; longer calls are cut into pieces.
constexpr std::size_t capacity = 4096;
/// The numbers of the largest query.
constexpr std::size_t most_numbers = (greatest_degree + 1) * moving_points * 4;
/// Queries in a step.
constexpr std::size_t longest_step = 512;
/// A step that takes less than this share of the limit may be followed by one twice as long.
constexpr double step_share = 0.02;
/// So many times the limit may pass for what waits for a processor.
constexpr double patience = 5.0;
/// The number of children in a row that may end before their first query without it being a failure
/// of the solver. A copy of a process whose other threads hold locks may wait for one of them.
constexpr int most_lost_starts = 2;
/// The interval at which this process looks for an interrupt without being notified.
constexpr Seconds longest_sleep(0.25);

[[noreturn]] void fail(const char* what) {
  throw std::system_error(errno, std::generic_category(), what);
}

/// Processor time of this process.
double processor_seconds() {
  timespec now{};
  ::clock_gettime(CLOCK_PROCESS_CPUTIME_ID, &now);
  return static_cast<double>(now.tv_sec) + static_cast<double>(now.tv_nsec) * 1e-9;
}

/// Wall-clock time from a moment that all processes share.
double wall_seconds() { return Seconds(Clock::now().time_since_epoch()).count(); }

/// The end of a text as fits.
struct ShortText {
  std::array<char, 256> bytes;

  void set(const char* text) {
    const std::size_t length = std::min(std::strlen(text), bytes.size() - 1);
    std::copy_n(text, length, bytes.begin());
    bytes.at(length) = '\0';
  }
  [[nodiscard]] std::string get() const {
    return {bytes.data(), ::strnlen(bytes.data(), bytes.size())};
  }
};

/// The memory of both processes. The child may have written anything there.
struct Shared {
  std::atomic<std::size_t> begin;  ///< of the step that the child is at
  std::atomic<std::size_t> end;
  std::atomic<double> step_started;       ///< its processor seconds at the beginning of the step
  std::atomic<double> step_started_at;    ///< wall-clock seconds then
  std::atomic<double> processor_seconds;  ///< of the steps that are done
  std::atomic<double> wall_seconds;
  QueryShape shape;
  fast::MethodOptions options;
  double query_limit_seconds;
  std::size_t first;                                    ///< queries from this number
  std::size_t last;                                     ///< to before this one are to be solved,
  std::size_t careful_until;                            ///< those before this one in steps of one
  std::array<double, capacity * most_numbers> numbers;  ///< query after query
  std::array<fast::Answer, capacity> answers;
  std::array<bool, capacity> has_thrown;
  std::array<ShortText, capacity> thrown;  ///< what() of what it threw
};
static_assert(std::atomic<std::size_t>::is_always_lock_free &&
              std::atomic<double>::is_always_lock_free);
static_assert(std::is_trivially_destructible_v<Shared>);

/// Memory that children made later share with this process.
class SharedMemory {
 public:
  SharedMemory()
      : memory_(::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS,
                       -1, 0)) {
    // NOLINTNEXTLINE(performance-no-int-to-ptr): the system's constant
    if (memory_ == MAP_FAILED) fail("cannot share memory with a solver's process");
    // The system's memory is zero, and every page that is not touched costs nothing.
    shared_ = new (memory_) Shared;
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

// ---- The child ----------------------------------------------------------------------------------

/// Solves what is asked, in steps whose length follows the pace.
class Worker {
 public:
  Worker(const fast::Method& method, Shared& shared) : method_(method), shared_(shared) {}

  /// Has the method load what it needs, and touches the memory that answers go to: neither is time
  /// of the solver.
  void warm_up() const {
    std::ranges::fill(shared_.answers, fast::Answer{});
    try {
      method_.solve(Queries(shared_.shape, {}), {}, shared_.options);
    } catch (...) {
      // The queries will show it.
      return;
    }
  }

  void solve_block() {
    const double longest = step_share * shared_.query_limit_seconds;
    for (std::size_t begin = shared_.first; begin < shared_.last;) {
      const bool careful = begin < shared_.careful_until;
      const std::size_t count = careful ? 1 : std::min(step_, shared_.last - begin);
      const double seconds = time_step(begin, count);
      const bool is_fast = longest == 0.0 || seconds < longest;
      step_ = is_fast ? std::min(2 * step_, longest_step) : std::max<std::size_t>(1, step_ / 2);
      begin += count;
    }
    shared_.begin.store(shared_.last, std::memory_order_release);
  }

 private:
  /// Solves a step, and returns the wall-clock seconds that it took.
  double time_step(std::size_t begin, std::size_t count) {
    start_step(begin, count);
    try {
      solve(begin, count);
    } catch (...) {
      // Which of them it is, it says alone. What it took until then is no time of the solver.
      for (std::size_t i = begin; count > 1 && i < begin + count; ++i) time_step(i, 1);
      if (count == 1) note_exception(begin);
      if (count > 1) return step_share * shared_.query_limit_seconds;
    }
    const double wall = wall_seconds() - shared_.step_started_at;
    shared_.processor_seconds =
        shared_.processor_seconds + processor_seconds() - shared_.step_started;
    shared_.wall_seconds = shared_.wall_seconds + wall;
    return wall;
  }

  void start_step(std::size_t begin, std::size_t count) {
    shared_.end.store(begin + count, std::memory_order_release);
    shared_.begin.store(begin, std::memory_order_release);
    shared_.step_started_at = wall_seconds();
    shared_.step_started = processor_seconds();
  }

  void solve(std::size_t begin, std::size_t count) const {
    const std::size_t size = shared_.shape.numbers_of_query();
    const auto numbers =
        std::span<const double>(shared_.numbers).subspan(begin * size, count * size);
    method_.solve(Queries(shared_.shape, numbers), std::span(shared_.answers).subspan(begin, count),
                  shared_.options);
  }

  /// \pre an exception is being handled.
  void note_exception(std::size_t position) {
    shared_.has_thrown.at(position) = true;
    ShortText& text = shared_.thrown.at(position);
    try {
      throw;
    } catch (const std::exception& error) {
      text.set(error.what());
    } catch (...) {
      text.set("not a std::exception");
    }
  }

  const fast::Method& method_;
  Shared& shared_;
  std::size_t step_ = 1;
};

/// The child's work: until the other end closes.
void serve(const fast::Method& method, Shared& shared, const ChildChannel& channel) {
  Worker worker(method, shared);
  bool is_warm = false;
  while (const auto message = channel.receive()) {
    if (!std::exchange(is_warm, true)) worker.warm_up();
    worker.solve_block();
    // Its output comes before the answers.
    std::fflush(stdout);
    std::cout.flush();
    if (!channel.send(*message)) return;
  }
}

}  // namespace

// ---- The parent ---------------------------------------------------------------------------------

class SolverProcess::Impl {
 public:
  Impl(const fast::Method& method, const SolverProcessOptions& options)
      : method_(method), options_(options) {}

  SolverRun solve(const Queries& queries, std::span<fast::Answer> answers,
                  const fast::MethodOptions& method_options, const base::Deadline& deadline) {
    deadline_ = deadline;
    run_ = {};
    lost_children_ = 0;
    (*memory_).shape = queries;
    (*memory_).options = method_options;
    while (run_.answered < queries.size() && !is_stopped() && !has_failed_enough()) {
      const std::size_t first = run_.answered;
      const std::size_t count = std::min(capacity, queries.size() - first);
      solve_part(queries.part(first, count), answers.subspan(first, count), first);
    }
    return std::move(run_);
  }

  void set_query_limit(double seconds) { options_.query_limit_seconds = seconds; }

  CapturedOutput take_output() { return std::exchange(output_, {}); }

 private:
  using Event = ChildProcess::Event;

  /// Progress of a child. If it is not done, it has ended.
  struct Stop {
    bool done = false;
    bool hang = false;
    std::size_t begin = 0;  ///< of the step that it was at
    std::size_t end = 0;
    judge::Failure failure = {};
    bool has_begun = false;          ///< a step
    double processor_seconds = 0.0;  ///< of that step
    double wall_seconds = 0.0;
  };

  [[nodiscard]] bool is_stopped() const {
    return verify::base::is_stopped(options_.stop) || deadline_.is_over();
  }

  [[nodiscard]] bool has_failed_enough() const {
    return options_.most_failures != 0 && lost_children_ >= options_.most_failures;
  }

  /// Answers what fits into the shared memory, which begins at number `offset` of all.
  void solve_part(const Queries& queries, std::span<fast::Answer> answers, std::size_t offset) {
    Shared& shared = *memory_;
    std::ranges::copy(queries.numbers, shared.numbers.begin());
    std::ranges::fill(std::span(shared.has_thrown).first(answers.size()), false);
    shared.query_limit_seconds = options_.query_limit_seconds;
    shared.last = answers.size();
    shared.careful_until = 0;
    searched_until_ = 0;
    slow_until_ = 0;
    doubtful_.reset();
    for (std::size_t first = 0; first < answers.size() && !has_failed_enough();) {
      const Stop stop = run_child(first);
      add_times();
      take_answers(answers, first, stop.begin, offset);
      run_.answered = offset + stop.begin;
      if (is_stopped() && !stop.done) return;
      leave_behind(stop.begin);
      if (stop.done) return;
      if (!stop.has_begun && lost_starts_++ < most_lost_starts) continue;
      first = go_on(stop, answers, offset);
    }
  }

  /// Of the steps that are done.
  void add_times() {
    const Shared& shared = *memory_;
    run_.processor_seconds += shared.processor_seconds;
    run_.wall_seconds += shared.wall_seconds;
  }

  void take_answers(std::span<fast::Answer> answers, std::size_t first, std::size_t last,
                    std::size_t offset) {
    const Shared& shared = *memory_;
    for (std::size_t i = first; i < last; ++i) {
      answers[i] = shared.answers.at(i);
      if (!shared.has_thrown.at(i)) continue;
      add_failure(answers, i, offset,
                  {.kind = judge::Fault::exception, .what = shared.thrown.at(i).get()});
    }
  }

  void add_failure(std::span<fast::Answer> answers, std::size_t i, std::size_t offset,
                   judge::Failure failure) {
    answers[i] = {.verdict = judge::verdict_of(failure.kind)};
    run_.failures.push_back({.position = offset + i, .failure = std::move(failure)});
  }

  /// A step, or a query, that ended a child is behind: nothing in it has done so again.
  void leave_behind(std::size_t begin) {
    const bool is_behind_step = searched_until_ != 0 && begin >= searched_until_;
    const bool is_behind_doubtful = doubtful_ && begin > *doubtful_;
    if (!is_behind_step && !is_behind_doubtful) return;
    ++run_.unplaced_crashes;
    searched_until_ = 0;
    doubtful_.reset();
  }

  /// Where to begin anew behind what stopped a child.
  std::size_t go_on(const Stop& stop, std::span<fast::Answer> answers, std::size_t offset) {
    Shared& shared = *memory_;
    const std::size_t begin = stop.begin;
    if (stop.end - begin > 1) {
      shared.careful_until = stop.end;
      slow_until_ = stop.hang ? stop.end : 0;
      if (!stop.hang) searched_until_ = stop.end;
      return begin;
    }
    // A step that was too slow, and then the query alone, are twice; what ends a child it is to do
    // in a child of its own.
    const bool is_sure = stop.hang && begin < slow_until_;
    if (!is_sure && doubtful_ != begin) {
      shared.careful_until = std::max(shared.careful_until, begin + 1);
      doubtful_ = begin;
      return begin;
    }
    run_.processor_seconds += stop.processor_seconds;
    run_.wall_seconds += stop.wall_seconds;
    add_failure(answers, begin, offset, stop.failure);
    ++lost_children_;
    run_.answered = offset + begin + 1;
    // Found: the end of the child in the step was this query's.
    searched_until_ = 0;
    doubtful_.reset();
    return begin + 1;
  }

  void prepare(std::size_t first) {
    Shared& shared = *memory_;
    shared.first = first;
    shared.begin = first;
    shared.end = first + 1;
    shared.step_started = 0.0;
    shared.step_started_at = 0.0;
    shared.processor_seconds = 0.0;
    shared.wall_seconds = 0.0;
    if (child_) return;
    if (!folder_) folder_.emplace();
    child_ = std::make_unique<ChildProcess>(
        [this](const ChildChannel& channel) { serve(method_, *memory_, channel); }, options_.limits,
        folder_->path());
  }

  /// Has the child, a new one if need be, solve from `first` on.
  Stop run_child(std::size_t first) {
    prepare(first);
    child_->send("solve");
    const Event event = wait(first);
    Shared& shared = *memory_;
    if (event == Event::message) {
      lost_starts_ = 0;
      return {.done = true, .begin = shared.last, .end = shared.last};
    }
    Stop stop{.hang = event == Event::none};
    const ChildEnd end = child_->end(output_);
    child_.reset();
    stop.begin = std::clamp(shared.begin.load(), first, shared.last - 1);
    stop.end = std::clamp(shared.end.load(), stop.begin + 1, shared.last);
    stop.failure = stop.hang ? judge::Failure{.kind = judge::Fault::hang} : end.failure;
    stop.has_begun = shared.step_started_at > 0.0;
    if (stop.has_begun) {
      lost_starts_ = 0;
      stop.processor_seconds = std::max(0.0, end.processor_seconds - shared.step_started);
      stop.wall_seconds = std::max(0.0, wall_seconds() - shared.step_started_at);
    }
    return stop;
  }

  /// Sleeps until the child is done or has ended. None: it takes too long, or is to stop.
  Event wait(std::size_t first) {
    const Shared& shared = *memory_;
    const Seconds limit(options_.query_limit_seconds);
    const bool is_limited = limit > Seconds::zero();
    std::size_t watched = first;
    Clock::time_point since = Clock::now();
    std::string message;
    while (!is_stopped()) {
      const Event event = child_->wait(
          is_limited ? std::min(longest_sleep, limit / 10) : longest_sleep, message, output_);
      if (event != Event::none) return event;
      const std::size_t current = shared.begin;
      const Clock::time_point now = Clock::now();
      if (current != watched) since = now;
      watched = current;
      if (is_limited && now - since > limit && is_overdue(now - since)) break;
    }
    return Event::none;
  }

  /// On a busy machine what gets little processor time gets more time.
  [[nodiscard]] bool is_overdue(Seconds passed) const {
    const double limit = options_.query_limit_seconds;
    if (passed.count() > patience * limit || !child_->is_runnable()) return true;
    return child_->processor_seconds() - (*memory_).step_started > 0.5 * limit;
  }

  const fast::Method& method_;
  SolverProcessOptions options_;
  SharedMemory memory_;
  std::optional<TemporaryFolder> folder_;
  std::unique_ptr<ChildProcess> child_;
  CapturedOutput output_;
  base::Deadline deadline_;
  SolverRun run_;
  /// Failures of this call that ended a child.
  std::size_t lost_children_ = 0;
  /// Children in a row that ended before their first query.
  int lost_starts_ = 0;
  /// Solved one by one up to here, since a step that ends here ended a child; 0: not.
  std::size_t searched_until_ = 0;
  /// The same, since the step took too long.
  std::size_t slow_until_ = 0;
  /// Queries that failed alone and are asked again.
  std::optional<std::size_t> doubtful_;
};

SolverProcess::SolverProcess(const fast::Method& method, const SolverProcessOptions& options)
    : impl_(std::make_unique<Impl>(method, options)) {}

SolverProcess::~SolverProcess() = default;

SolverRun SolverProcess::solve(const Queries& queries, std::span<fast::Answer> answers,
                               const fast::MethodOptions& method_options,
                               const base::Deadline& deadline) {
  return impl_->solve(queries, answers, method_options, deadline);
}

void SolverProcess::set_query_limit(double seconds) { impl_->set_query_limit(seconds); }

CapturedOutput SolverProcess::take_output() { return impl_->take_output(); }

}  // namespace touchstone::verify::solvers
