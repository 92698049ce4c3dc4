#include "verify/methods/respondent.hpp"

#include <algorithm>
#include <chrono>
#include <exception>
#include <utility>

#include "verify/thread_clock.hpp"

namespace touchstone::verify {
namespace {

constexpr double longest_span = 1e6;
/// A child costs milliseconds: it is to solve much longer, and to begin with as much as it gets.
constexpr Respondent::Pacing isolated_pacing{.span_seconds = 0.5, .first_guess = 0.0};

fast::MethodOptions with_separation(fast::MethodOptions options, const Questions& questions) {
  options.min_separation = questions.separation.distance;
  options.norm = questions.separation.norm;
  return options;
}

/// Solves one by one; what throws is in error.
void solve_despite_exceptions(const fast::Method& method, const Questions& questions,
                              std::span<fast::Answer> answers, const fast::MethodOptions& options) {
  for (std::size_t i = 0; i < answers.size(); ++i) {
    try {
      method.solve(questions.kind, questions.queries.subspan(i, 1), answers.subspan(i, 1), options);
    } catch (const std::exception&) {
      answers[i] = {.verdict = fast::Verdict::error};
    }
  }
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
    const double start = thread_nanoseconds();
    try {
      method_.solve(questions.kind, questions.queries, answers, options);
    } catch (const std::exception&) {
      std::ranges::fill(answers, fast::Answer{});
      solve_despite_exceptions(method_, questions, answers, options);
    }
    return {.nanoseconds = thread_nanoseconds() - start};
  }

  const fast::Method& method_;
  fast::MethodOptions options_;
};

class Isolated final : public Respondent {
 public:
  Isolated(const fast::Method& method, const fast::MethodOptions& options,
           const IsolationOptions& isolation)
      : Respondent(std::string(method.name()), method.promise(), true, isolated_pacing),
        method_(method),
        options_(options),
        isolation_(isolation) {}

 private:
  [[nodiscard]] Response solve(const Questions& questions,
                               std::span<fast::Answer> answers) const override {
    const IsolatedSolve solved = solve_isolated(method_, questions.kind, questions.queries, answers,
                                                with_separation(options_, questions), isolation_);
    return {.nanoseconds = 1e9 * solved.processor_seconds,
            .seconds = solved.wall_seconds,
            .unplaced_crashes = solved.unplaced_crashes,
            .stopped = solved.stopped};
  }

  const fast::Method& method_;
  fast::MethodOptions options_;
  IsolationOptions isolation_;
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
      if (answer) {
        answers[i] = *answer;
      } else {
        response.missing.push_back(i);
      }
    }
    return response;
  }

  const RecordedAnswers& answers_;
};

}  // namespace

Respondent::Respondent(std::string name, fast::Promise promise, bool timed, const Pacing& pacing)
    : name_(std::move(name)),
      promise_(promise),
      timed_(timed),
      span_seconds_(pacing.span_seconds),
      pace_(pacing.first_guess) {}

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
  const double queries = span_seconds_ / std::max(pace_.load(), span_seconds_ / longest_span);
  return std::max<std::size_t>(1, static_cast<std::size_t>(queries));
}

std::unique_ptr<Respondent> respond_in_process(const fast::Method& method,
                                               const fast::MethodOptions& options) {
  return std::make_unique<InProcess>(method, options);
}

std::unique_ptr<Respondent> respond_isolated(const fast::Method& method,
                                             const fast::MethodOptions& options,
                                             const IsolationOptions& isolation) {
  return std::make_unique<Isolated>(method, options, isolation);
}

std::unique_ptr<Respondent> respond_recorded(std::string name, const RecordedAnswers& answers) {
  return std::make_unique<Recorded>(std::move(name), answers);
}

}  // namespace touchstone::verify
