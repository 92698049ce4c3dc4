#pragma once

/// \file
/// Answers of a solver held against the truth: what is wrong with them, and how far off the times
/// of impact are.
///
/// - A yes and an undecided both mean "take it for a collision"; so an undecided is never a false
///   negative, and one about a query that does not collide is a false positive, as a yes is. It is
///   counted as undecided in any case.
/// - Truth is about the separation that was asked for, in the norm that was asked for.
/// - A failure (solvers/failure.hpp) is counted by its kind. Those that are not taken for undecided are
///   errors, answers to nothing, and counted as nothing else.
/// - Times of impact are judged for a yes to a query that does collide, and only where the method
///   gives them. All comparisons are exact: the truth is enclosed by neighbouring doubles, or is
///   one, so a double t is above it iff t > lower, and below it iff t < upper.

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "exact/algebra/number.hpp"
#include "fast/method.hpp"
#include "verify/judge/ground_truth.hpp"
#include "verify/solvers/failure.hpp"

namespace touchstone::verify::judge {

/// The faults of an answer.
enum class Fault : std::uint8_t {
  false_negative,   ///< no, but they collide
  false_positive,   ///< yes or undecided, but they do not collide
  late_toi,         ///< toi_lower is above the exact time of impact
  early_toi_upper,  ///< toi_upper is below the exact time of impact
  error,            ///< the method could not answer
  beyond_tolerance,  ///< yes, but they never come as near as its tolerance claims (claimed_distance.hpp)
};
inline constexpr std::size_t fault_count = 6;

/// "false negative", "false positive", "late toi", "early toi_upper", "error" or "beyond
/// tolerance".
[[nodiscard]] std::string_view to_string(Fault fault);

/// The errors of toi_lower against the exact time of impact, of many answers, in bounded memory.
///
/// A histogram: 64 buckets to a factor of two, so a quantile is known to 1.6%; it is the upper end
/// of its bucket, never less than the true quantile. Zero and the maximum are exact.
class ToiErrors {
 public:
  /// \pre error ≥ 0
  void add(double error);
  ToiErrors& operator+=(const ToiErrors& other);

  [[nodiscard]] std::uint64_t count() const { return count_; }

  /// The least error that at least `fraction` (0 to 1) of all do not exceed; NaN if there are none.
  [[nodiscard]] double quantile(double fraction) const;

  /// NaN if there are none.
  [[nodiscard]] double max() const;

 private:
  std::map<std::uint32_t, std::uint64_t> buckets_;
  std::uint64_t count_ = 0;
  double max_ = 0.0;
};

/// An answer that is not the truth.
struct WrongAnswer {
  Fault fault;
  std::uint64_t index;
  std::string answer;
  std::string truth;
  fast::Answer given = {};  ///< the answer itself
  /// Why it is none, where that is known.
  std::optional<solvers::Failure> failure = std::nullopt;
};

/// "SOLVER: false negative: no, the truth is collision at 0.5".
[[nodiscard]] std::string to_text(const std::string& solver, const WrongAnswer& wrong);

/// What a solver said to a query.
struct GivenAnswer {
  std::string solver;
  fast::Answer answer = {};
  std::optional<solvers::Failure> failure = std::nullopt;
  /// What it is held to; nothing: what is known of a solver of that name.
  std::optional<fast::Promise> promise = std::nullopt;
};

/// A query with an answer, or a recorded claim, that is not the truth.
struct WrongQuery {
  std::string source;
  std::uint64_t index = 0;
  Kind kind = Kind::vertex_face;
  Query query{};
  Separation separation = {};
  std::vector<std::string> faults = {};  ///< what is wrong, a text each
  std::vector<GivenAnswer> answers = {};
};

/// The judgement on a method's answers to some queries of one source.
struct Judgement {
  /// So many wrong answers of each fault are kept; the counts count them all.
  static constexpr std::size_t most_kept = 1000;

  std::uint64_t queries = 0;  ///< answered
  std::uint64_t missing = 0;  ///< not answered (in recorded answers), and not in `queries`
  std::optional<std::uint64_t> first_missing;  ///< index of the first of these
  std::array<std::uint64_t, fault_count> faults{};
  /// Queries without an answer, by FailureKind.
  std::array<std::uint64_t, solvers::failure_kinds> failures{};
  /// Of the errors, processes that the method ended at no particular query: see solver_process.hpp.
  std::uint64_t unplaced_crashes = 0;
  std::uint64_t undecided = 0;  ///< by itself, or for the limit of time
  std::uint64_t checks = 0;  ///< steps of the method, summed over the queries, where it counts them
  double nanoseconds = 0.0;  ///< processor time of the method, summed over the queries
  ToiErrors toi_errors;
  /// In the order of the queries.
  std::vector<WrongAnswer> wrong_answers;

  [[nodiscard]] std::uint64_t count(Fault fault) const {
    return faults[static_cast<std::size_t>(fault)];
  }
  [[nodiscard]] std::uint64_t count(solvers::FailureKind kind) const {
    return failures[static_cast<std::size_t>(kind)];
  }

  /// Mean time of the method; 0 if there are no queries.
  [[nodiscard]] double nanoseconds_per_query() const;

  /// Judges an answer. \pre truth.toi is there if it collides.
  /// \param failure why there is none; null: as the answer shows
  void add(const GroundTruth& truth, const fast::Answer& answer,
           const solvers::Failure* failure = nullptr);

  /// Notes that a yes claims more nearness than there is.
  void add_beyond_tolerance(const GroundTruth& truth, const fast::Answer& answer);

  /// Notes that there is no answer to that query.
  void add_missing(std::uint64_t index);

  /// Counts processes that the method ended at no particular query as errors.
  void add_unplaced_crashes(std::uint64_t crashes);

  /// Adds the counts of the queries that follow, with the wrong answers.
  Judgement& operator+=(const Judgement& next);

 private:
  void add_fault(Fault fault, const GroundTruth& truth, const fast::Answer& answer,
                 const std::optional<solvers::Failure>& failure = std::nullopt);
  void add_toi(const GroundTruth& truth, const fast::Answer& answer);
};

/// Does that fault break the promise? Every method, whatever it promises, is to be free of false
/// negatives, of times of impact that exclude the true one, of errors, and of a yes that claims more
/// nearness than there is; one that promises exactness also of false positives.
[[nodiscard]] bool breaks(Fault fault, fast::Promise promise);

/// Is there no fault that breaks the promise?
[[nodiscard]] bool keeps(const Judgement& judgement, fast::Promise promise);

}  // namespace touchstone::verify::judge
