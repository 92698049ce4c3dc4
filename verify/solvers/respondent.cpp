#include "verify/solvers/respondent.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <mutex>
#include <utility>

#include "verify/run/thread_clock.hpp"

namespace touchstone::verify {
namespace {

/// What a span of queries should take.
constexpr double span_seconds = 0.01;
constexpr double longest_span = 1e6;

fast::MethodOptions with_separation(fast::MethodOptions options, const Questions& questions) {
  options.min_separation = questions.separation.distance;
  options.norm = questions.separation.norm;
  return options;
}

/// Solves one by one; what throws is in error.
std::vector<QueryFailure> solve_despite_exceptions(const fast::Method& method,
                                                   const Questions& questions,
                                                   std::span<fast::Answer> answers,
                                                   const fast::MethodOptions& options) {
  std::vector<QueryFailure> failures;
  for (std::size_t i = 0; i < answers.size(); ++i) {
    try {
      method.solve(questions.kind, questions.queries.subspan(i, 1), answers.subspan(i, 1), options);
    } catch (const std::exception& error) {
      answers[i] = {.verdict = fast::Verdict::error};
      failures.push_back(
          {.position = i, .failure = {.kind = FailureKind::exception, .what = error.what()}});
    }
  }
  return failures;
}

class InProcess final : public Respondent {
 public:
  InProcess(const fast::Method& method, const fast::MethodOptions& options)
      : Respondent(std::string(method.name()), method.promise(), true),
        method_(method),
        options_(options) {}

 private:
  [[nodiscard]] Response solve(const Questions& questions,
                               std::span<fast::Answer> answers) const override {
    const fast::MethodOptions options = with_separation(options_, questions);
    Response response;
    const double start = thread_nanoseconds();
    try {
      method_.solve(questions.kind, questions.queries, answers, options);
    } catch (const std::exception&) {
      std::ranges::fill(answers, fast::Answer{});
      response.failures = solve_despite_exceptions(method_, questions, answers, options);
    }
    response.nanoseconds = thread_nanoseconds() - start;
    return response;
  }

  const fast::Method& method_;
  fast::MethodOptions options_;
};

class Isolated final : public Respondent {
 public:
  Isolated(const fast::Method& method, const fast::MethodOptions& options,
           const SolverProcessOptions& process)
      : Respondent(std::string(method.name()), method.promise(), true),
        method_(method),
        options_(options),
        process_(process) {}

  [[nodiscard]] CapturedOutput output() const override {
    const std::scoped_lock lock(mutex_);
    for (const auto& process : idle_) {
      const CapturedOutput more = process->take_output();
      output_.append(more.text.data(), more.text.size());
      output_.dropped += more.dropped;
    }
    return output_;
  }

 private:
  [[nodiscard]] Response solve(const Questions& questions,
                               std::span<fast::Answer> answers) const override {
    std::unique_ptr<SolverProcess> process = take();
    SolverRun run = process->solve(questions.kind, questions.queries, answers,
                                   with_separation(options_, questions));
    give_back(std::move(process));
    return {.nanoseconds = 1e9 * run.processor_seconds,
            .seconds = run.wall_seconds,
            .failures = std::move(run.failures),
            .unplaced_crashes = run.unplaced_crashes,
            .stopped = run.answered < answers.size()};
  }

  /// A process that nobody else asks.
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
  mutable CapturedOutput output_;
};

class Recorded final : public Respondent {
 public:
  Recorded(std::string name, const RecordedAnswers& answers)
      : Respondent(std::move(name), fast::Promise::none, false), answers_(answers) {}

 private:
  [[nodiscard]] Response solve(const Questions& questions,
                               std::span<fast::Answer> answers) const override {
    Response response;
    for (std::size_t i = 0; i < answers.size(); ++i) {
      const auto answer =
          answers_.answer_to(questions.source, questions.kind, questions.indices[i]);
      if (!answer) {
        response.missing.push_back(i);
        continue;
      }
      answers[i] = answer->answer;
      if (answer->failure) {
        response.failures.push_back({.position = i, .failure = {.kind = *answer->failure}});
      }
    }
    return response;
  }

  const RecordedAnswers& answers_;
};

}  // namespace

Respondent::Respondent(std::string name, fast::Promise promise, bool timed)
    : name_(std::move(name)), promise_(promise), timed_(timed) {}

Response Respondent::answer(const Questions& questions, std::span<fast::Answer> answers) const {
  using Clock = std::chrono::steady_clock;
  const Clock::time_point start = Clock::now();
  Response response = solve(questions, answers);
  const double seconds = std::chrono::duration<double>(Clock::now() - start).count();
  if (!answers.empty()) {
    pace_ = response.seconds.value_or(seconds) / static_cast<double>(answers.size());
  }
  return response;
}

std::size_t Respondent::good_span() const {
  const double queries = span_seconds / std::max(pace_.load(), span_seconds / longest_span);
  return std::max<std::size_t>(1, static_cast<std::size_t>(queries));
}

std::unique_ptr<Respondent> respond_in_process(const fast::Method& method,
                                               const fast::MethodOptions& options) {
  return std::make_unique<InProcess>(method, options);
}

std::unique_ptr<Respondent> respond_isolated(const fast::Method& method,
                                             const fast::MethodOptions& options,
                                             const SolverProcessOptions& process) {
  return std::make_unique<Isolated>(method, options, process);
}

std::unique_ptr<Respondent> respond_recorded(std::string name, const RecordedAnswers& answers) {
  return std::make_unique<Recorded>(std::move(name), answers);
}

}  // namespace touchstone::verify
