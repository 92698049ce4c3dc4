#include "verify/solvers/solver.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <bit>
#include <chrono>
#include <cmath>
#include <exception>
#include <functional>
#include <iterator>
#include <map>
#include <mutex>
#include <stdexcept>
#include <utility>

#include "verify/base/thread_clock.hpp"
#include "verify/judge/terms.hpp"
#include "verify/solvers/hang_limits.hpp"

namespace touchstone::verify::solvers {
namespace {

using WallClock = std::chrono::steady_clock;

fast::MethodOptions with_separation(fast::MethodOptions options, const SolveRequest& request) {
  options.separation = request.separation;
  return options;
}

/// The time that work takes in this thread.
template <class Work>
SolverTime time_of(const Work& work) {
  const double start = base::thread_nanoseconds();
  const WallClock::time_point wall_start = WallClock::now();
  work();
  const double seconds = std::chrono::duration<double>(WallClock::now() - wall_start).count();
  return {.processor_nanoseconds = base::thread_nanoseconds() - start, .wall_seconds = seconds};
}

// ---- In this process ----------------------------------------------------------------------------

/// Solves one by one; a query where the method throws is in error.
std::vector<judge::QueryFailure> solve_despite_exceptions(const fast::Method& method,
                                                          const SolveRequest& request,
                                                          std::span<fast::Answer> answers,
                                                          const fast::MethodOptions& options) {
  std::vector<judge::QueryFailure> failures;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    try {
      method.solve(request.queries.part(i, 1), answers.subspan(i, 1), options);
    } catch (const std::exception& error) {
      answers[i] = {.verdict = fast::Verdict::error};
      failures.push_back(
          {.position = i, .failure = {.kind = judge::Fault::exception, .what = error.what()}});
    }
  }
  return failures;
}

class InProcess final : public Solver {
 public:
  InProcess(const fast::Method& method, const fast::MethodOptions& options)
      : Solver(method.info()), method_(method), options_(options) {}

  [[nodiscard]] SolveReply answer(const SolveRequest& request,
                                  std::span<fast::Answer> answers) const override {
    const fast::MethodOptions options = with_separation(options_, request);
    try {
      method_.solve(request.queries, answers, options);
    } catch (const std::exception&) {
      std::ranges::fill(answers, fast::Answer{});
      return {.failures = solve_despite_exceptions(method_, request, answers, options)};
    }
    return {};
  }

 private:
  const fast::Method& method_;
  fast::MethodOptions options_;
};

// ---- In child processes -------------------------------------------------------------------------

class InChildren final : public Solver {
 public:
  InChildren(const fast::Method& method, const fast::MethodOptions& options,
             const SolverProcessOptions& process)
      : Solver(method.info()),
        method_(method),
        options_(options),
        process_(process),
        hangs_(process.query_limit_seconds) {
    // After this number of failures the limits are checked.
    process_.most_failures = HangLimits::several;
  }

  [[nodiscard]] SolveReply answer(const SolveRequest& request,
                                  std::span<fast::Answer> answers) const override {
    SolveReply reply{.time = SolverTime{}};
    std::unique_ptr<SolverProcess> process = take();
    std::size_t first = 0;
    for (const judge::QueryFailure& lost : lost_among(request)) {
      ask(*process, request, answers, first, lost.position, reply);
      answers[lost.position] = {.verdict = judge::verdict_of(lost.failure.kind)};
      reply.failures.push_back(lost);
      first = lost.position + 1;
    }
    ask(*process, request, answers, first, answers.size(), reply);
    give_back(std::move(process));
    return reply;
  }

  [[nodiscard]] CapturedOutput take_output() const override {
    const std::scoped_lock lock(mutex_);
    CapturedOutput output;
    for (const auto& process : idle_) {
      const CapturedOutput more = process->take_output();
      output.append(more.text.data(), more.text.size());
      output.dropped += more.dropped;
    }
    return output;
  }

 private:
  /// The bits of a query, of its shape and of the separation.
  using QueryBits = std::vector<std::uint64_t>;

  static QueryBits bits_of(const SolveRequest& request, std::size_t i) {
    const AnyQueries& all = request.queries;
    const auto to_bits = [](double x) { return std::bit_cast<std::uint64_t>(x); };
    QueryBits bits{std::uint64_t{all.kind.index()}, all.degree, all.is_rational ? 1U : 0U,
                   static_cast<std::uint64_t>(request.separation.norm),
                   to_bits(request.separation.distance)};
    std::ranges::transform(all.row(i), std::back_inserter(bits), to_bits);
    return bits;
  }

  /// Asks for the answers from number `first` to before `last`, and skips queries after the time is
  /// used up, and after several hangs at the sort.
  void ask(SolverProcess& process, const SolveRequest& request, std::span<fast::Answer> answers,
           std::size_t first, std::size_t last, SolveReply& reply) const {
    const std::string sort = fmt::format("{} {}", request.source, to_string(request.queries.kind));
    const base::Deadline deadline(std::max(0.0, allowance()));
    while (first < last && !reply.stopped && !deadline.is_over() && !is_over(sort, process)) {
      const std::size_t count = last - first;
      SolverRun run =
          process.solve(request.queries.part(first, count), answers.subspan(first, count),
                        with_separation(options_, request), {.begin = deadline});
      take_times(run, reply);
      const bool has_lost = take_failures(run, request, first, sort, reply);
      reply.stopped = run.answered < count && !has_lost && !deadline.is_over();
      first += run.answered;
    }
    for (; first < last && !reply.stopped; ++first) {
      reply.unasked.push_back({.position = first, .why = judge::Unasked::left_out});
    }
  }

  /// True if the sort is skipped. Otherwise sets the limit of the process.
  [[nodiscard]] bool is_over(const std::string& sort, SolverProcess& process) const {
    const std::scoped_lock lock(mutex_);
    process.set_query_limit(hangs_.seconds());
    return hangs_.is_over(sort);
  }

  static void take_times(const SolverRun& run, SolveReply& reply) {
    SolverTime& time = reply.time.value();
    time.processor_nanoseconds += 1e9 * run.processor_seconds;
    time.wall_seconds += run.wall_seconds;
    reply.unplaced_crashes += run.unplaced_crashes;
  }

  /// Takes the failures of a run that began at a number of the request. True if one ended its
  /// process.
  bool take_failures(SolverRun& run, const SolveRequest& request, std::size_t begin,
                     const std::string& sort, SolveReply& reply) const {
    bool has_lost = false;
    for (judge::QueryFailure& failure : run.failures) {
      failure.position += begin;
      if (failure.failure.kind != judge::Fault::exception) {
        has_lost = true;
        remember(bits_of(request, failure.position), failure.failure, sort);
      }
      reply.failures.push_back(std::move(failure));
    }
    return has_lost;
  }

  // ---- Queries that ended a process or took too long

  void remember(const QueryBits& query, const judge::Failure& failure,
                const std::string& sort) const {
    const std::scoped_lock lock(mutex_);
    if (failure.kind == judge::Fault::hang) hangs_.add(sort);
    lost_.emplace(query, failure);
  }

  [[nodiscard]] std::vector<judge::QueryFailure> lost_among(const SolveRequest& request) const {
    const std::scoped_lock lock(mutex_);
    std::vector<judge::QueryFailure> found;
    for (std::size_t i = 0; i < request.queries.size() && !lost_.empty(); ++i) {
      const auto lost = lost_.find(bits_of(request, i));
      if (lost != lost_.end()) found.push_back({.position = i, .failure = lost->second});
    }
    return found;
  }

  // ---- Processes that nobody else asks

  [[nodiscard]] std::unique_ptr<SolverProcess> take() const {
    const std::scoped_lock lock(mutex_);
    if (idle_.empty()) return std::make_unique<SolverProcess>(method_, process_);
    std::unique_ptr<SolverProcess> process = std::move(idle_.back());
    idle_.pop_back();
    return process;
  }

  void give_back(std::unique_ptr<SolverProcess> process) const {
    const std::scoped_lock lock(mutex_);
    idle_.push_back(std::move(process));
  }

  const fast::Method& method_;
  fast::MethodOptions options_;
  SolverProcessOptions process_;
  mutable std::mutex mutex_;
  mutable std::vector<std::unique_ptr<SolverProcess>> idle_;
  mutable std::map<QueryBits, judge::Failure> lost_;
  mutable HangLimits hangs_;
};

// ---- Recorded -----------------------------------------------------------------------------------

/// The terms with curves, unless numbers are to be rounded.
fast::Terms with_curves(fast::Terms terms) {
  if (terms.float_coordinates) return terms;
  terms.most_degree = greatest_degree;
  terms.rational = true;
  return terms;
}

class Recorded final : public Solver {
 public:
  Recorded(std::string_view name, const RecordedAnswers& answers, const fast::Terms& terms)
      : Solver(fast::MethodInfo{.name = name, .terms = with_curves(terms)}), answers_(answers) {}

  [[nodiscard]] bool is_timed() const override { return false; }

  [[nodiscard]] SolveReply answer(const SolveRequest& request,
                                  std::span<fast::Answer> answers) const override {
    SolveReply reply;
    for (std::size_t i = 0; i < answers.size(); ++i) {
      const auto answer =
          answers_.answer_to(request.source, request.queries.kind, request.indices[i]);
      if (!answer) {
        reply.unasked.push_back({.position = i, .why = judge::Unasked::missing});
        continue;
      }
      answers[i] = answer->answer;
      if (answer->failure) {
        reply.failures.push_back({.position = i, .failure = {.kind = *answer->failure}});
      }
    }
    return reply;
  }

 private:
  const RecordedAnswers& answers_;
};

}  // namespace

Solver::Solver(const fast::MethodInfo& info) : name_(info.name), info_(info) { info_.name = name_; }

void Solver::rename(std::string name) {
  name_ = std::move(name);
  info_.name = name_;
}

std::optional<judge::Unasked> SolveReply::why_unasked(std::size_t position) const {
  const auto found = std::ranges::lower_bound(unasked, position, {}, &UnaskedQuery::position);
  if (found == unasked.end() || found->position != position) return std::nullopt;
  return found->why;
}

SolveReply Solver::solve(const SolveRequest& request, std::span<fast::Answer> answers) const {
  if (!judge::select_queries(terms(), request.queries)) return answer_in_time(request, answers);
  SolveReply reply;
  std::vector<std::size_t> positions;
  std::vector<double> numbers;
  std::vector<std::uint64_t> indices;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    const base::AnyQuery query = judge::as_asked(terms(), {request.queries, i});
    answers[i] = {};
    if (!judge::admits(terms(), query, request.separation)) {
      reply.unasked.push_back({.position = i, .why = judge::Unasked::outside});
      continue;
    }
    positions.push_back(i);
    numbers.insert(numbers.end(), query.numbers().begin(), query.numbers().end());
    if (!request.indices.empty()) indices.push_back(request.indices[i]);
  }
  std::vector<fast::Answer> given(positions.size());
  SolveRequest within = request;
  within.queries = AnyQueries(request.queries, numbers);
  within.indices = indices;
  SolveReply of_within;
  const SolverTime time = time_of([&] {
    if (!given.empty()) of_within = answer_in_time(within, given);
  });
  for (std::size_t i = 0; i < given.size(); ++i) answers[positions[i]] = given[i];
  for (UnaskedQuery& unasked : of_within.unasked) {
    unasked.position = positions[unasked.position];
    reply.unasked.push_back(unasked);
  }
  std::ranges::sort(reply.unasked, {}, &UnaskedQuery::position);
  for (judge::QueryFailure& failure : of_within.failures) {
    failure.position = positions[failure.position];
    reply.failures.push_back(std::move(failure));
  }
  reply.time = of_within.time.value_or(time);
  reply.unplaced_crashes = of_within.unplaced_crashes;
  reply.stopped = of_within.stopped;
  return reply;
}

SolveReply Solver::answer_in_time(const SolveRequest& request,
                                  std::span<fast::Answer> answers) const {
  if (std::isinf(allowance())) return answer(request, answers);
  SolveReply reply;
  if (allowance() > 0.0) {
    const WallClock::time_point start = WallClock::now();
    reply = answer(request, answers);
    allowance_ = allowance_ - std::chrono::duration<double>(WallClock::now() - start).count();
    return reply;
  }
  for (std::size_t i = 0; i < answers.size(); ++i) {
    reply.unasked.push_back({.position = i, .why = judge::Unasked::left_out});
  }
  reply.time = SolverTime{};
  return reply;
}

SolveReply Solver::solve_timed(const SolveRequest& request, std::span<fast::Answer> answers) const {
  SolveReply reply;
  SolverTime time = time_of([&] { reply = solve(request, answers); });
  if (!is_timed()) time.processor_nanoseconds = 0.0;
  reply.time = reply.time.value_or(time);
  return reply;
}

std::unique_ptr<Solver> solver_in_process(const fast::Method& method,
                                          const fast::MethodOptions& options) {
  return std::make_unique<InProcess>(method, options);
}

std::unique_ptr<Solver> solver_in_children(const fast::Method& method,
                                           const fast::MethodOptions& options,
                                           const SolverProcessOptions& process) {
  return std::make_unique<InChildren>(method, options, process);
}

std::unique_ptr<Solver> recorded_solver(std::string_view name, const RecordedAnswers& answers,
                                        const fast::Terms& terms) {
  return std::make_unique<Recorded>(name, answers, terms);
}

}  // namespace touchstone::verify::solvers
