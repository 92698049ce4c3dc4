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

namespace touchstone::verify::solvers {
namespace {

using Clock = std::chrono::steady_clock;
using Seconds = std::chrono::duration<double>;

/// Queries for which there is room; longer calls are cut into pieces.
constexpr std::size_t capacity = 4096;
/// The numbers of the largest query.
constexpr std::size_t most_numbers = (greatest_degree + 1) * moving_points * 4;
/// Queries in a batch at first; a slow solver gets fewer.
constexpr std::size_t longest_batch = 512;
constexpr std::size_t batch_divisor = 8;
/// A solver that waits for a processor may take this multiple of the limit.
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

/// The beginning of a text, as far as it fits.
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
  std::atomic<std::size_t> begin;  ///< the heartbeat: of the batch that the child is at
  std::atomic<std::size_t> end;
  std::atomic<double> started;            ///< its processor seconds at the beginning of the batch
  std::atomic<double> started_at;         ///< wall-clock seconds then; 0 before the first batch
  std::atomic<double> processor_seconds;  ///< of the batches that are done
  std::atomic<double> wall_seconds;
  AnyShape shape;
  fast::MethodOptions options;
  std::size_t first;   ///< queries from this number
  std::size_t last;    ///< to before this one are to be solved,
  std::size_t batch;   ///< in batches of this number,
  double begin_until;  ///< the first batch, and those that begin before this time
  std::array<double, capacity * most_numbers> numbers;  ///< query after query
  std::array<fast::Answer, capacity> answers;
  std::array<bool, capacity> has_thrown;
  std::array<ShortText, capacity> thrown;  ///< what() of the exception
};
static_assert(std::atomic<std::size_t>::is_always_lock_free &&
              std::atomic<double>::is_always_lock_free);
static_assert(std::is_trivially_destructible_v<Shared>);

struct Unmap {
  void operator()(Shared* shared) const { ::munmap(shared, sizeof(Shared)); }
};

/// Memory that children made later share with this process.
std::unique_ptr<Shared, Unmap> share_memory() {
  void* const memory =
      ::mmap(nullptr, sizeof(Shared), PROT_READ | PROT_WRITE, MAP_SHARED | MAP_ANONYMOUS, -1, 0);
  // NOLINTNEXTLINE(performance-no-int-to-ptr): the system's constant
  if (memory == MAP_FAILED) fail("cannot share memory with a solver's process");
  // The system's memory is zero, and every page that is not touched costs nothing.
  return std::unique_ptr<Shared, Unmap>(new (memory) Shared);
}

// ---- The child ----------------------------------------------------------------------------------

/// Lets the method load what it needs, and touches the memory of the answers, so that neither
/// counts as time of the solver.
void warm_up(const fast::Method& method, Shared& shared) {
  std::ranges::fill(shared.answers, fast::Answer{});
  try {
    method.solve(AnyQueries(shared.shape, {}), {}, shared.options);
  } catch (...) {
    // The queries will show it.
    return;
  }
}

/// Notes the text of the exception. \pre an exception is being handled.
void note_exception(ShortText& text) {
  try {
    throw;
  } catch (const std::exception& error) {
    text.set(error.what());
  } catch (...) {
    text.set("not a std::exception");
  }
}

/// Solves a batch. False if the method throws in a batch of several queries: they are then asked
/// one by one, and the time of the batch does not count.
bool solve_batch(const fast::Method& method, Shared& shared, std::size_t begin, std::size_t count) {
  shared.end.store(begin + count, std::memory_order_release);
  shared.begin.store(begin, std::memory_order_release);
  shared.started_at = base::steady_seconds();
  shared.started = processor_seconds();
  const std::size_t size = shared.shape.numbers_of_query();
  const auto numbers = std::span<const double>(shared.numbers).subspan(begin * size, count * size);
  try {
    method.solve(AnyQueries(shared.shape, numbers), std::span(shared.answers).subspan(begin, count),
                 shared.options);
  } catch (...) {
    if (count > 1) return false;
    shared.has_thrown.at(begin) = true;
    note_exception(shared.thrown.at(begin));
  }
  const double wall = base::steady_seconds() - shared.started_at;
  shared.processor_seconds = shared.processor_seconds + processor_seconds() - shared.started;
  shared.wall_seconds = shared.wall_seconds + wall;
  return true;
}

/// Solves the requested queries, at least the first batch.
void solve_all(const fast::Method& method, Shared& shared) {
  std::size_t begin = shared.first;
  do {
    const std::size_t count = std::min(shared.batch, shared.last - begin);
    if (!solve_batch(method, shared, begin, count)) {
      for (std::size_t i = begin; i < begin + count; ++i) solve_batch(method, shared, i, 1);
    }
    begin += count;
  } while (begin < shared.last && base::steady_seconds() < shared.begin_until);
  shared.begin.store(begin, std::memory_order_release);
}

/// The child's work: until the other end closes.
void serve(const fast::Method& method, Shared& shared, const ChildChannel& channel) {
  bool is_warm = false;
  while (const auto message = channel.receive()) {
    if (!std::exchange(is_warm, true)) warm_up(method, shared);
    solve_all(method, shared);
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

  SolverRun solve(const AnyQueries& queries, std::span<fast::Answer> answers,
                  const fast::MethodOptions& method_options, const SolverDeadlines& deadlines) {
    deadlines_ = deadlines;
    run_ = {};
    lost_children_ = 0;
    Shared& shared = *memory_;
    shared.shape = queries;
    shared.options = method_options;
    shared.begin_until = base::steady_seconds() + deadlines.begin.seconds_left();
    while (run_.answered < queries.size() && goes_on()) {
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

  /// The progress of a child. If it is not done, the child has ended.
  struct Stop {
    bool done = false;
    bool hang = false;
    std::size_t begin = 0;  ///< of the batch that it was at, or behind the last one
    std::size_t end = 0;
    judge::Failure failure = {};
    bool has_begun = false;          ///< a batch
    double processor_seconds = 0.0;  ///< of that batch
    double wall_seconds = 0.0;
  };

  [[nodiscard]] bool is_stopped() const {
    return verify::base::is_stopped(options_.stop) || deadlines_.end.is_over();
  }

  [[nodiscard]] bool goes_on() const {
    const bool has_failed_enough =
        options_.most_failures != 0 && lost_children_ >= options_.most_failures;
    return !is_stopped() && !deadlines_.begin.is_over() && !has_failed_enough;
  }

  /// Answers as many queries as fit into the shared memory, from number `offset` of all on.
  void solve_part(const AnyQueries& queries, std::span<fast::Answer> answers, std::size_t offset) {
    std::ranges::copy(queries.numbers, memory_->numbers.begin());
    std::ranges::fill(std::span(memory_->has_thrown).first(answers.size()), false);
    answers_ = answers;
    offset_ = offset;
    for (std::size_t next = 0; next < answers.size() && goes_on();) {
      const Stop stop = run_child(next, answers.size(), batch_);
      next = stop.begin;
      if (!stop.done && !is_stopped()) next = search(stop);
    }
  }

  /// Solves one by one the queries of a batch that ended its child or took too long. Returns the
  /// next position.
  std::size_t search(const Stop& batch) {
    if (batch.end - batch.begin == 1) return ask_again(batch);
    const std::size_t failures = run_.failures.size();
    // A batch may take long without a fault.
    bool is_explained = batch.hang;
    std::size_t next = batch.begin;
    while (next < batch.end && goes_on()) {
      const Stop stop = run_child(next, batch.end, 1);
      next = stop.begin;
      if (stop.done || is_stopped()) continue;
      is_explained = true;
      // In a batch that is too slow, it is so the second time.
      next = batch.hang && stop.hang ? add_lost(stop) : ask_again(stop);
    }
    if (next == batch.end && !is_explained) ++run_.unplaced_crashes;
    if (batch.hang && run_.failures.size() == failures) {
      batch_ = std::max<std::size_t>(1, batch_ / batch_divisor);
    }
    return next;
  }

  /// Asks a query at which a child ended alone, in a child of its own. Returns the next position.
  std::size_t ask_again(const Stop& first) {
    const Stop again = run_child(first.begin, first.begin + 1, 1);
    if (!again.done) return is_stopped() ? first.begin : add_lost(again);
    if (!first.hang) ++run_.unplaced_crashes;
    return again.begin;
  }

  /// Counts the query as one that ended its child. Returns the next one.
  std::size_t add_lost(const Stop& stop) {
    run_.processor_seconds += stop.processor_seconds;
    run_.wall_seconds += stop.wall_seconds;
    add_failure(stop.begin, stop.failure);
    ++lost_children_;
    run_.answered = offset_ + stop.begin + 1;
    return stop.begin + 1;
  }

  void add_failure(std::size_t i, judge::Failure failure) {
    answers_[i] = {.verdict = judge::verdict_of(failure.kind)};
    run_.failures.push_back({.position = offset_ + i, .failure = std::move(failure)});
  }

  /// Lets the child, a new one if necessary, solve the queries from `first` to before `last`, and
  /// takes its answers. A child that ends before its first query is replaced.
  Stop run_child(std::size_t first, std::size_t last, std::size_t batch) {
    Stop stop = try_child(first, last, batch);
    while (!stop.done && !stop.has_begun && lost_starts_++ < most_lost_starts && !is_stopped()) {
      stop = try_child(first, last, batch);
    }
    if (stop.has_begun) lost_starts_ = 0;
    take_answers(first, stop.begin);
    return stop;
  }

  Stop try_child(std::size_t first, std::size_t last, std::size_t batch) {
    prepare(first, last, batch);
    child_->send("solve");
    const Event event = wait(first);
    Shared& shared = *memory_;
    Stop stop{.done = event == Event::message,
              .hang = event == Event::none,
              .has_begun = shared.started_at > 0.0};
    if (stop.done) {
      // Whatever stands there now, the first one is done.
      stop.begin = std::clamp(shared.begin.load(), first + 1, last);
      return stop;
    }
    stop.begin = std::clamp(shared.begin.load(), first, last - 1);
    const ChildEnd end = child_->end(output_);
    child_.reset();
    stop.end = std::clamp(shared.end.load(), stop.begin + 1, last);
    stop.failure = stop.hang ? judge::Failure{.kind = judge::Fault::hang} : end.failure;
    if (stop.has_begun) {
      stop.processor_seconds = std::max(0.0, end.processor_seconds - shared.started);
      stop.wall_seconds = std::max(0.0, base::steady_seconds() - shared.started_at);
    }
    return stop;
  }

  void prepare(std::size_t first, std::size_t last, std::size_t batch) {
    Shared& shared = *memory_;
    shared.first = first;
    shared.last = last;
    shared.batch = batch;
    shared.begin = first;
    shared.end = first + 1;
    shared.started = 0.0;
    shared.started_at = 0.0;
    shared.processor_seconds = 0.0;
    shared.wall_seconds = 0.0;
    if (child_) return;
    if (!folder_) folder_.emplace();
    child_ = std::make_unique<ChildProcess>(
        [this](const ChildChannel& channel) { serve(method_, *memory_, channel); }, options_.limits,
        folder_->path());
  }

  /// Takes the answers of the finished batches, and their time.
  void take_answers(std::size_t first, std::size_t last) {
    const Shared& shared = *memory_;
    run_.processor_seconds += shared.processor_seconds;
    run_.wall_seconds += shared.wall_seconds;
    for (std::size_t i = first; i < last; ++i) {
      answers_[i] = shared.answers.at(i);
      if (!shared.has_thrown.at(i)) continue;
      add_failure(i, {.kind = judge::Fault::exception, .what = shared.thrown.at(i).get()});
    }
    run_.answered = offset_ + last;
  }

  /// Sleeps until the child is done or has ended. Nothing if it takes too long, or is to stop.
  Event wait(std::size_t first) {
    const Seconds limit(options_.query_limit_seconds);
    const bool is_limited = limit > Seconds::zero();
    std::size_t watched = first;
    Clock::time_point since = Clock::now();
    std::string message;
    while (!is_stopped()) {
      const Event event = child_->wait(
          is_limited ? std::min(longest_sleep, limit / 10) : longest_sleep, message, output_);
      if (event != Event::none) return event;
      const std::size_t current = memory_->begin;
      const Clock::time_point now = Clock::now();
      if (current != watched) since = now;
      watched = current;
      if (is_limited && now - since > limit && is_overdue(now - since)) break;
    }
    return Event::none;
  }

  /// True if the limit has passed. On a busy machine a solver that gets little processor time has
  /// more time, so that the machine's delays are not taken for hangs.
  [[nodiscard]] bool is_overdue(Seconds passed) const {
    const double limit = options_.query_limit_seconds;
    if (passed.count() > patience * limit || !child_->is_runnable()) return true;
    return child_->processor_seconds() - memory_->started > 0.5 * limit;
  }

  const fast::Method& method_;
  SolverProcessOptions options_;
  std::unique_ptr<Shared, Unmap> memory_ = share_memory();
  std::optional<TemporaryFolder> folder_;
  std::unique_ptr<ChildProcess> child_;
  CapturedOutput output_;
  std::size_t batch_ = longest_batch;
  /// Children in a row that ended before their first query.
  int lost_starts_ = 0;

  // The state of the present call, and of its part in the shared memory.
  SolverDeadlines deadlines_;
  SolverRun run_;
  std::size_t lost_children_ = 0;
  std::span<fast::Answer> answers_;
  std::size_t offset_ = 0;
};

SolverProcess::SolverProcess(const fast::Method& method, const SolverProcessOptions& options)
    : impl_(std::make_unique<Impl>(method, options)) {}

SolverProcess::~SolverProcess() = default;

SolverRun SolverProcess::solve(const AnyQueries& queries, std::span<fast::Answer> answers,
                               const fast::MethodOptions& method_options,
                               const SolverDeadlines& deadlines) {
  return impl_->solve(queries, answers, method_options, deadlines);
}

void SolverProcess::set_query_limit(double seconds) { impl_->set_query_limit(seconds); }

CapturedOutput SolverProcess::take_output() { return impl_->take_output(); }

}  // namespace touchstone::verify::solvers
