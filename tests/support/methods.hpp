#pragma once

/// \file
/// Solvers for tests: a correct one from the oracle, and any other as a function.

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "fast/method.hpp"
#include "touchstone/any_kind.hpp"
#include "touchstone/oracle.hpp"
#include "verify/base/any_decision.hpp"
#include "verify/base/thread_clock.hpp"

namespace touchstone::tests {

/// Answers each query with a function.
class FunctionMethod final : public fast::Method {
 public:
  using Function = std::function<fast::Answer(AnyKind, const Query&)>;
  /// Of one query, of any shape.
  using AnyFunction = std::function<fast::Answer(const AnyQueries&)>;

  explicit FunctionMethod(Function function, fast::Promise promise = fast::Promise::conservative,
                          std::string name = "function")
      : function_(of_any(std::move(function))),
        name_(std::move(name)),
        info_{.name = name_, .promise = promise} {}
  FunctionMethod(Function function, fast::MethodInfo info)
      : FunctionMethod(of_any(std::move(function)), std::move(info)) {}
  FunctionMethod(AnyFunction function, fast::MethodInfo info)
      : function_(std::move(function)), info_(std::move(info)) {}

  [[nodiscard]] const fast::MethodInfo& info() const override { return info_; }
  void solve(const AnyQueries& queries, std::span<fast::Answer> answers,
             const fast::MethodOptions&) const override {
    for (std::size_t i = 0; i < answers.size(); ++i) answers[i] = function_(queries.part(i, 1));
  }

 private:
  static AnyFunction of_any(Function function) {
    return [of_lines = std::move(function)](const AnyQueries& one) {
      return of_lines(one.kind, one.straight().front());
    };
  }

  AnyFunction function_;
  std::string name_;
  fast::MethodInfo info_;
};

/// The truth of one query as an answer, with the narrowest enclosure in doubles.
[[nodiscard]] inline fast::Answer true_answer_to(const AnyQueries& one) {
  const exact::Decision verdict = verify::base::decide(one, 0);
  if (!verdict.collides()) return {.verdict = fast::Verdict::no};
  const exact::DoubleInterval toi = verdict.toi->enclosure();
  return {.verdict = fast::Verdict::yes,
          .toi_lower = toi.lower,
          .toi_upper = toi.upper,
          .tolerance = 0.0};
}
[[nodiscard]] inline fast::Answer true_answer(AnyKind kind, const Query& query) {
  return true_answer_to(AnyQueries(kind, {&query, 1}));
}

/// Spends processor time.
inline void burn(double nanoseconds) {
  const double start = verify::base::thread_nanoseconds();
  while (verify::base::thread_nanoseconds() < start + nanoseconds) continue;
}

[[nodiscard]] inline fast::Answer always_no(AnyKind, const Query&) {
  return {.verdict = fast::Verdict::no};
}

/// In a millisecond.
[[nodiscard]] inline fast::Answer slow_no(AnyKind kind, const Query& query) {
  burn(1e6);
  return always_no(kind, query);
}

}  // namespace touchstone::tests
