#pragma once

/// \file
/// The record of a report: measurements of a method, under some options, on a group of queries.
/// Plain data, and the only source of all tables and figures (report_page.hpp).

#include <cstdint>
#include <limits>
#include <map>
#include <nlohmann/json_fwd.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fast/method.hpp"
#include "touchstone/query.hpp"
#include "verify/judge/fault.hpp"
#include "verify/judge/judgement.hpp"

namespace touchstone::verify::report {

/// The experiment that a measurement belongs to.
enum class Experiment : std::uint8_t {
  field,       ///< all methods side by side, as each is meant to be used (the paper's table 1)
  separation,  ///< over the minimum separation d (its tables 2 and 3)
  tolerance,   ///< over the tolerance δ
  checks,      ///< over the maximum number of checks m_I
  filter,      ///< the misses of Tight-Inclusion with each of its filters; nothing is timed
};

/// "field", "separation", "tolerance", "checks" or "filter".
[[nodiscard]] std::string_view to_string(Experiment experiment);

/// The experiment of that name. \throws std::invalid_argument if there is none.
[[nodiscard]] Experiment experiment_from_string(std::string_view name);

/// Running times of single queries, counted in bins of which eight make a factor of ten.
struct TimeHistogram {
  static constexpr int bins_per_decade = 8;

  /// By the bin's number: bin b holds times from 10^(b/8) to 10^((b+1)/8) nanoseconds.
  std::map<int, std::uint64_t> bins;

  /// Times below a nanosecond count as one.
  void add(double nanoseconds);

  friend bool operator==(const TimeHistogram&, const TimeHistogram&) = default;
};

/// Two numbers that stand for many. The median is one of them, to 1.6% above; the maximum is exact.
struct Spread {
  std::uint64_t count = 0;
  double median = 0.0;
  double max = 0.0;

  friend bool operator==(const Spread&, const Spread&) = default;
};

/// The number of queries that a stage ended.
struct StageShare {
  std::string stage;
  std::uint64_t queries = 0;

  friend bool operator==(const StageShare&, const StageShare&) = default;
};

/// The faults of answers to some queries, and what they cost.
struct JudgedAnswers {
  static constexpr double unknown = std::numeric_limits<double>::quiet_NaN();

  std::uint64_t collisions = 0;  ///< by the oracle
  std::uint64_t false_positives = 0;
  std::uint64_t false_negatives = 0;
  std::uint64_t late_tois = 0;         ///< toi_lower above the exact time of impact
  std::uint64_t early_upper_tois = 0;  ///< toi_upper below the exact time of impact
  std::uint64_t beyond_tolerance = 0;  ///< yes, but never as near as the tolerance claims
  std::uint64_t errors = 0;
  std::uint64_t undecided = 0;
  /// From toi_lower to the exact time of impact; of collisions whose time the method gives.
  std::optional<Spread> toi_error = {};
  double nanoseconds = unknown;  ///< processor time a query

  friend bool operator==(const JudgedAnswers&, const JudgedAnswers&) = default;
};

/// A method, under some options, on a group of queries. Its time is that of all of them in one
/// call, in one thread; the median of `repetitions`.
struct Measurement : JudgedAnswers {
  Experiment experiment = Experiment::field;
  std::string group;
  Kind kind = Kind::vertex_face;
  std::string method;
  fast::Promise promise = fast::Promise::none;
  double tolerance = 0.0;       ///< MethodOptions::tolerance
  std::int64_t max_checks = 0;  ///< MethodOptions::max_checks
  Separation separation = {};   ///< that counts as contact, for the method and for the truth
  /// The scale of a group that is made for one: no coordinate is greater in magnitude.
  std::optional<double> scale;

  std::uint64_t group_queries = 0;  ///< in the group
  std::uint64_t asked = 0;          ///< of these, an evenly spread sample; all below is about them
  std::uint64_t outside = 0;        ///< of the sample, not asked: outside the terms of its promise
  std::uint64_t left_out = 0;       ///< of the sample, not asked for lack of time
  std::uint64_t at_limit = 0;       ///< queries that took max_checks or more, or were given up
  bool keeps_promise = true;
  judge::LateTimes late = {};  ///< the late times, bounds and estimates

  std::uint64_t repetitions = 0;
  /// The time of the certified solver on the same queries in the same run.
  double certified_nanoseconds = unknown;
  /// The tolerance that a yes claims, where the method gives one.
  std::optional<Spread> achieved_tolerance;
  /// The stages of a method that has some, all in their order.
  std::vector<StageShare> stages;
  /// The times of one call a query, of those that collide and of those that do not.
  TimeHistogram collision_times;
  TimeHistogram no_collision_times;
};

/// One cell of a map of stability (stability.hpp).
struct StabilityMark : JudgedAnswers {
  std::string method = {};
  std::string hardness = {};
  std::string measure = {};  ///< the meaning of its levels
  int exponent = 0;          ///< the level is 2 to this power, or this itself
  bool is_power = true;
  Kind kind = Kind::vertex_face;
  std::uint64_t queries = 0;
  std::uint64_t hangs = 0;                 ///< of those undecided
  std::optional<judge::Fault> worst = {};  ///< nothing if nothing is wrong
  bool is_slight = false;                  ///< true if the worst is a time that is late slightly
  double worst_rate = 0.0;                 ///< its share of the queries that can have it
  double checks = unknown;                 ///< a query, where the method counts them

  friend bool operator==(const StabilityMark&, const StabilityMark&) = default;
};

/// The queries of a group.
struct MeasuredGroup {
  std::string name;
  Kind kind = Kind::vertex_face;
  std::uint64_t queries = 0;
  std::uint64_t digest = 0;  ///< as QueryGroup::digest gives it

  friend bool operator==(const MeasuredGroup&, const MeasuredGroup&) = default;
};

/// The data of a report.
struct Measurements {
  std::string command;  ///< the command line that made them
  std::string version;  ///< of this program, with its commit; empty if not known
  std::string machine;  ///< the processor they were made on
  std::string date;     ///< the day they were made, YYYY-MM-DD in UTC; empty if not known
  std::vector<MeasuredGroup> groups;
  std::vector<Measurement> all;
  std::vector<StabilityMark> stability;
  bool interrupted = false;
};

/// The same with all names and texts printable (printable.hpp), for pages and tables.
[[nodiscard]] Measurements with_printable_texts(Measurements measurements);

/// True if a method gave a wrong answer that its promise excludes.
[[nodiscard]] bool has_wrong_answers(const Measurements& measurements);

// Measurements as JSON and back, without loss.

/// `format` (its name and version), `command`, `machine`, `interrupted`; `measurements`, a list of
/// objects with the fields of Measurement under their names, `separation` as an object of
/// `min_separation` and `norm`, `scale` as null where there is none, times in `ns_per_query` and
/// `certified_ns_per_query`, spreads as null or an object of `count`, `median` and `max`,
/// histograms as lists of `[bin, count]`, stages as a list of `[name, queries]`; `stability`, a
/// list of objects with the fields of StabilityMark. Numbers are as number_to_json (io/json.hpp)
/// writes them.
[[nodiscard]] nlohmann::json to_json(const Measurements& measurements);

/// The inverse.
/// \throws std::runtime_error, with the reason, for anything else.
[[nodiscard]] Measurements measurements_from_json(const nlohmann::json& json);

}  // namespace touchstone::verify::report
