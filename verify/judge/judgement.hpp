#pragma once

/// \file
/// Judgements added up: how often a solver's answers to some queries have each fault (judge.hpp),
/// which ones they are, and how far off the times of impact are.

#include <array>
#include <cstddef>
#include <cstdint>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <vector>

#include "fast/method.hpp"
#include "touchstone/number.hpp"
#include "verify/base/any_query.hpp"
#include "verify/judge/fault.hpp"
#include "verify/judge/ground_truth.hpp"
#include "verify/judge/judge.hpp"

namespace touchstone::verify::judge {

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
  friend nlohmann::json to_json(const ToiErrors& errors);
  friend ToiErrors toi_errors_from_json(const nlohmann::json& json);

  std::map<std::uint32_t, std::uint64_t> buckets_;
  std::uint64_t count_ = 0;
  double max_ = 0.0;
};

/// `count`, `p50`, `p90`, `p99`, `max`, and `histogram`, a list of the number of each bucket that
/// is not empty and its count; null if there are no errors.
[[nodiscard]] nlohmann::json to_json(const ToiErrors& errors);
/// The reverse. \throws nlohmann::json::exception if it has another form.
[[nodiscard]] ToiErrors toi_errors_from_json(const nlohmann::json& json);

/// The times of impact that are later than the exact ones, bounds and estimates, of many answers.
struct LateTimes {
  /// Fractions of the step; for each the number of later times is counted.
  static constexpr std::array<double, 4> thresholds{1e-12, 1e-9, 1e-6, 1e-3};

  std::uint64_t count = 0;
  std::array<std::uint64_t, thresholds.size()> beyond{};
  Lateness greatest = {};  ///< each of the two

  void add(const Lateness& lateness);
  LateTimes& operator+=(const LateTimes& other);
};

/// An answer that is not the truth.
struct WrongAnswer {
  Fault fault;
  std::uint64_t index;
  std::string answer;
  std::string truth;
  fast::Answer given = {};  ///< the answer itself
  /// The reason for a missing answer, where it is known.
  std::optional<Failure> failure = std::nullopt;
  /// The lateness of a late time.
  std::optional<Lateness> lateness = std::nullopt;
};

/// "SOLVER: false negative: no, the truth is collision at 0.5".
[[nodiscard]] std::string to_text(const std::string& solver, const WrongAnswer& wrong);

/// The reason why a solver was not asked a query, or has no recorded answer.
enum class Unasked : std::uint8_t {
  missing,   ///< a file of answers has none
  outside,   ///< outside the terms of its promise (terms.hpp)
  left_out,  ///< for lack of time, or because the solver hangs at many queries like it
};

/// The answer of a solver to a query.
struct GivenAnswer {
  std::string solver;
  fast::Answer answer = {};
  std::optional<Failure> failure = std::nullopt;
  /// The standard that it is judged by; nothing: that of the solver of that name.
  std::optional<Standard> standard = std::nullopt;
};

/// A query with an answer, or a recorded claim, that is not the truth.
struct WrongQuery {
  std::string source;
  std::uint64_t index = 0;
  base::AnyQuery query = {};
  Separation separation = {};
  std::vector<std::string> faults = {};  ///< a text for each fault
  std::vector<GivenAnswer> answers = {};
};

/// The judgement on a method's answers to some queries of one source.
struct Judgement {
  /// The number of wrong answers that are kept for each fault; the counts include all.
  static constexpr std::size_t most_kept = 1000;

  std::uint64_t queries = 0;     ///< answered
  std::uint64_t collisions = 0;  ///< of these, by the truth, or by the answers without one
  /// Queries not asked, because they are outside the terms of the promise; not in `queries`.
  std::uint64_t outside = 0;
  std::uint64_t left_out = 0;  ///< not asked for lack of time, and not in `queries`
  std::uint64_t missing = 0;   ///< not answered (in recorded answers), and not in `queries`
  std::optional<std::uint64_t> first_missing;       ///< index of the first of these
  std::array<std::uint64_t, fault_count> faults{};  ///< answers with each fault
  /// Processes that the method ended at no particular query (solver_process.hpp): errors, but in no
  /// count of faults.
  std::uint64_t unplaced_crashes = 0;
  double nanoseconds = 0.0;  ///< processor time of the method, summed over the queries
  ToiErrors toi_errors;
  LateTimes late;
  std::uint64_t slightly_late = 0;  ///< of the faults late_toi
  /// In the order of the queries; of late times those that are slightly late and the others are
  /// counted apart. A hang or an undecided alone is none.
  std::vector<WrongAnswer> wrong_answers;

  /// Answers with that fault.
  [[nodiscard]] std::uint64_t count(Fault fault) const {
    return faults[static_cast<std::size_t>(fault)];
  }
  /// The errors of all kinds, at queries and elsewhere.
  [[nodiscard]] std::uint64_t errors() const;
  [[nodiscard]] std::uint64_t errors_at_queries() const { return errors() - unplaced_crashes; }
  /// Undecided by itself, or for the limit of time.
  [[nodiscard]] std::uint64_t undecided() const {
    return count(Fault::undecided) + count(Fault::hang);
  }
  /// The number of faults with the same text (to_text): all errors together, or that fault.
  [[nodiscard]] std::uint64_t total(Fault fault) const {
    return is_error(fault) ? errors() : count(fault);
  }

  /// Mean time of the method; 0 if there are no queries.
  [[nodiscard]] double nanoseconds_per_query() const;

  /// Judges an answer to a query within the terms of the standard. The parameters are those of
  /// judge(), but query and truth those before they are rounded for the solver.
  void add(const Question& question, const GroundTruth& known, const fast::Answer& answer,
           const Standard& standard, const Failure* failure = nullptr);

  /// Counts an answer where the truth is not known.
  void add(const fast::Answer& answer, const Failure* failure);

  /// Notes that there is no answer to that query.
  void add_unasked(Unasked why, std::uint64_t index);

  /// Adds the counts of the queries that follow, with the wrong answers.
  Judgement& operator+=(const Judgement& next);

 private:
  /// Counts a fault, and says whether its answer is one of those that are kept.
  [[nodiscard]] bool count_kept(Fault fault, bool is_slight);
};

/// True if no fault breaks the promise.
[[nodiscard]] bool keeps(const Judgement& judgement, fast::Promise promise);

}  // namespace touchstone::verify::judge
