#pragma once

/// \file
/// Methods whose answers are verdicts alone, with common rules for bad input and for
/// exceptions of the method.
///
/// The published comparison wraps every method and treats every exception as "collision". This rule
/// decides most answers of some methods (bsc.hpp), so it is reproduced here.

#include <cstddef>
#include <memory>
#include <new>
#include <span>
#include <string_view>

#include "fast/method.hpp"
#include "fast/platform/floating_point_state.hpp"
#include "touchstone/query.hpp"
#include "verify/baselines/method_support.hpp"

namespace touchstone::baselines {

/// The verdict of `collides(kind, query)`: error if a coordinate is not finite, yes if it throws.
/// \throws std::bad_alloc if `collides` throws that.
template <class Collides>
[[nodiscard]] fast::Verdict verdict_of(Kind kind, const Query& query, const Collides& collides) {
  if (!is_finite(query)) return fast::Verdict::error;
  try {
    return collides(kind, query) ? fast::Verdict::yes : fast::Verdict::no;
  } catch (const std::bad_alloc&) {
    throw;
  } catch (...) {
    return fast::Verdict::yes;
  }
}

/// Answers query i in answers[i] with its verdict alone, rounding to nearest in any environment of
/// the caller.
/// \pre both spans have the same length. \throws std::bad_alloc
template <class Collides>
void answer_each(Kind kind, std::span<const Query> queries, std::span<fast::Answer> answers,
                 const Collides& collides) {
  const fast::StrictFloatingPoint strict;
  for (std::size_t i = 0; i < queries.size(); ++i) {
    answers[i] = {.verdict = verdict_of(kind, queries[i], collides)};
  }
}

/// A baseline of verdicts alone, which promises nothing and ignores all options.
class VerdictMethod final : public fast::Method {
 public:
  using Collides = bool (*)(Kind, const Query&);

  /// \param reference key in docs/references.bib
  VerdictMethod(std::string_view name, std::string_view reference, Collides collides)
      : info_{.name = name, .reference = reference, .is_baseline = true}, collides_(collides) {}

  [[nodiscard]] const fast::MethodInfo& info() const override { return info_; }
  void solve(const Queries& queries, std::span<fast::Answer> answers,
             const fast::MethodOptions& /*options*/) const override {
    answer_each(queries.kind, queries.straight(), answers, collides_);
  }

 private:
  fast::MethodInfo info_;
  Collides collides_;
};

}  // namespace touchstone::baselines
