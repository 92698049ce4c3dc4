#pragma once

/// \file
/// What the fuzzer finds: an answer of a solver that is wrong, or none at all.

#include <cstdint>
#include <string>
#include <string_view>

#include "exact/query.hpp"
#include "fast/method.hpp"

namespace touchstone::verify {

/// What is wrong.
enum class FindingKind : std::uint8_t {
  false_negative,   ///< no, but they collide
  late_toi,         ///< toi_lower is above the exact time of impact
  early_toi_upper,  ///< toi_upper is below the exact time of impact
  beyond_promise,   ///< a false positive of what calls itself exact, or beyond its tolerance
  asymmetry,        ///< another answer than to what the query is an exact image of, and wrong
  crash,            ///< it ends its process, or answers error to a valid query
  hang,             ///< it takes longer than the limit
  not_finite,       ///< yes with bounds or a tolerance that are none
};
inline constexpr std::size_t finding_kinds = 8;

/// "false_negative", "late_toi" and so on, as above.
[[nodiscard]] std::string_view to_string(FindingKind what);

/// Something that a solver does wrong, confirmed by the oracle.
struct Finding {
  FindingKind what = FindingKind::false_negative;
  Kind kind = Kind::vertex_face;
  Query query{};
  Separation separation = {};
  std::string method;  ///< that is wrong: the one asked, or "certified" where the judge is
  fast::Answer answer = {};
  bool collides = false;  ///< the truth
  std::string truth;      ///< as to_text(Truth) says it
  std::string detail;     ///< what is wrong, in words
  /// Of the truth, as text (exact/CERTIFICATES.md); empty if beyond its limits.
  std::string certificate;
  double seconds = 0.0;       ///< wall-clock time of the run when it was found
  std::uint64_t queries = 0;  ///< asked by then, itself included
  std::string generator;      ///< that made the query
};

}  // namespace touchstone::verify
