#pragma once

/// \file
/// What every solver looks like from outside: a description and answers to a span of queries.
/// verify/ knows solvers by nothing else.

#include <algorithm>
#include <cstdint>
#include <limits>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "exact/query.hpp"
#include "fast/filter.hpp"

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
  /// Steps it took, of whatever sort the method counts: boxes, or the stages of MethodInfo::stages
  /// that the query went through; 0 where it does not say.
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
  /// Contact is to be this near; a method that can only do L∞ finds all of L2 with it.
  Separation separation = {};
  double t_max = 1.0;  ///< only impacts up to this time count (0 to 1)
};

/// All that is known of a method beside its answers. The registry, reports and help read it here.
struct MethodInfo {
  /// Unique, snake_case: what the command line calls it.
  std::string_view name;
  Promise promise = Promise::none;
  /// The work that it comes from, by its key in docs/references.bib; empty: none.
  std::string_view reference = {};
  /// Is it a published method, here for comparison, known errors and all?
  bool is_baseline = false;
  /// The name of the method of which this is another setting, for comparison; empty: of none.
  std::string_view variant_of = {};
  /// In which it measures a minimum separation; empty: it knows of contact alone.
  std::vector<Norm> norms = {};
  /// Does it search until it is as near as MethodOptions::tolerance?
  bool is_tolerance_driven = false;
  /// The limit of checks that it is compared with others under: lower for slow searches.
  std::int64_t usual_max_checks = MethodOptions{}.max_checks;
  /// The filter that its tolerances do not include: a yes claims to be as near as its tolerance and
  /// twice this filter. Without one, as its tolerance alone (docs/theory.md, section 7.3).
  std::optional<ErrorModel> filter = std::nullopt;
  /// Names of its stages, in their order; empty if it has none.
  std::vector<std::string_view> stages = {};

  [[nodiscard]] bool measures_in(Norm norm) const {
    return std::ranges::find(norms, norm) != norms.end();
  }
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

  /// Always the same; its texts live as long as the method.
  [[nodiscard]] virtual const MethodInfo& info() const = 0;
  [[nodiscard]] std::string_view name() const { return info().name; }
  [[nodiscard]] Promise promise() const { return info().promise; }

  /// Answers query i in answers[i], in this thread.
  /// \pre both spans have the same length.
  /// \throws std::runtime_error if the arithmetic is not what the method needs; std::bad_alloc.
  virtual void solve(Kind kind, std::span<const Query> queries, std::span<Answer> answers,
                     const MethodOptions& options) const = 0;
};

}  // namespace touchstone::fast
