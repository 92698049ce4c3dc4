#pragma once

/// \file
/// Solvers for tests: a correct one from the oracle, and any other as a function.

#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <utility>

#include "fast/method.hpp"
#include "touchstone/oracle.hpp"
#include "touchstone/query.hpp"

namespace touchstone::tests {

/// Answers each query with a function.
class FunctionMethod final : public fast::Method {
 public:
  using Function = std::function<fast::Answer(Kind, const Query&)>;

  explicit FunctionMethod(Function function, fast::Promise promise = fast::Promise::conservative,
                          std::string name = "function")
      : function_(std::move(function)),
        name_(std::move(name)),
        info_{.name = name_, .promise = promise} {}
  FunctionMethod(Function function, fast::MethodInfo info)
      : function_(std::move(function)), info_(std::move(info)) {}

  [[nodiscard]] const fast::MethodInfo& info() const override { return info_; }
  void solve(Kind kind, std::span<const Query> queries, std::span<fast::Answer> answers,
             const fast::MethodOptions&) const override {
    for (std::size_t i = 0; i < queries.size(); ++i) answers[i] = function_(kind, queries[i]);
  }

 private:
  Function function_;
  std::string name_;
  fast::MethodInfo info_;
};

/// The truth as an answer, with the narrowest enclosure in doubles.
[[nodiscard]] inline fast::Answer true_answer(Kind kind, const Query& query) {
  const exact::Decision verdict = exact::decide(kind, query);
  if (!verdict.collides()) return {.verdict = fast::Verdict::no};
  const exact::DoubleInterval toi = verdict.toi->enclosure();
  return {.verdict = fast::Verdict::yes,
          .toi_lower = toi.lower,
          .toi_upper = toi.upper,
          .tolerance = 0.0};
}

}  // namespace touchstone::tests
