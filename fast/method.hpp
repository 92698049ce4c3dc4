#pragma once

/// \file
/// What every solver looks like from outside: a name, what it promises, and answers to a span of
/// queries. The judge in verify/ knows solvers by nothing else.

#include <cstdint>
#include <limits>
#include <span>
#include <string_view>

#include "exact/query.hpp"

namespace touchstone::fast {

/// A solver's answer to "do they collide?".
enum class Verdict : std::uint8_t {
  no,
  yes,
  undecided,  ///< it cannot say; to be taken as a conservative yes
  error,      ///< the query or the options are none it accepts (NaN, infinities, …)
};

/// An answer with its own uncertainty. A field that the method does not give is NaN.
struct Answer {
  static constexpr double none = std::numeric_limits<double>::quiet_NaN();

  Verdict verdict = Verdict::undecided;
  /// Steps it took, of whatever sort the method counts: boxes, stages; 0 where it does not say.
  std::uint32_t checks = 0;
  double toi_lower = none;  ///< claimed: not above the exact time of impact; only with yes
  double toi_upper = none;  ///< claimed: not below the exact time of impact; only with yes
  double tolerance = none;  ///< how near to contact a yes claims to be, in units of the coordinates
};
// The steps stand where the compiler would have left a gap: batches of answers cost memory.
static_assert(sizeof(Answer) == 4 * sizeof(double));

/// What a method claims of its answers.
enum class Promise : std::uint8_t {
  none,          ///< wrong answers of any sort occur
  conservative,  ///< no false negative, no late time of impact; false positives occur
  exact,         ///< no wrong answer at all
};

/// Options that methods share. One that a method has no use for, it ignores.
struct MethodOptions {
  double tolerance = 1e-6;              ///< of tolerance-driven methods: Tight-Inclusion's δ
  std::int64_t max_checks = 1'000'000;  ///< of iterative methods: Tight-Inclusion's m_I; ≤ 0: none
  double min_separation = 0.0;          ///< contact is to be this near (d ≥ 0),
  Norm norm = Norm::linf;  ///< measured so; what can only do L∞ finds all of L2 with it
  double t_max = 1.0;      ///< only impacts up to this time count (0 to 1)
};

/// A solver. Safe to use from several threads at once.
class Method {
 public:
  Method() = default;
  Method(const Method&) = delete;
  Method& operator=(const Method&) = delete;
  Method(Method&&) = delete;
  Method& operator=(Method&&) = delete;
  virtual ~Method() = default;

  /// Unique, snake_case: what the command line calls it.
  [[nodiscard]] virtual std::string_view name() const = 0;
  [[nodiscard]] virtual Promise promise() const = 0;

  /// Answers query i in answers[i], in this thread.
  /// \pre both spans have the same length.
  /// \throws std::runtime_error if the arithmetic is not what the method needs; std::bad_alloc.
  virtual void solve(Kind kind, std::span<const Query> queries, std::span<Answer> answers,
                     const MethodOptions& options) const = 0;
};

}  // namespace touchstone::fast
