#pragma once

/// \file
/// The one job on the queries of a source: decide them, hold labels and solvers' answers against
/// the truth, and hand out what is asked for: truth, certificates, answers, wrong queries.
///
/// Queries stream from the source through the oracle, many at a time on all cores, and come out in
/// the order they went in: the output does not depend on the number of threads. Time is the
/// processor time that the oracle takes, so that it does not depend on them either, nor on reading.
/// Solvers and their recorded answers are judged on the way: the truth is there.

#include <atomic>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "touchstone/number.hpp"
#include "touchstone/query.hpp"
#include "verify/base/deadline.hpp"
#include "verify/data/query_source.hpp"
#include "verify/jobs/prove.hpp"
#include "verify/judge/judgement.hpp"
#include "verify/judge/label.hpp"
#include "verify/judge/separation_inference.hpp"
#include "verify/solvers/solver.hpp"

namespace touchstone::verify::jobs {

struct CertifyOptions {
  /// Minimum separation.
  Separation separation = {};
  /// False: the solvers are asked, and nothing is decided, compared, proved or judged.
  bool decides = true;
  /// False: what the source records is not compared with the truth.
  bool compares_labels = true;
  /// Cores to use; 0: all of them.
  unsigned threads = 0;
  /// A recorded time of impact may be off by this much; 0: not at all.
  exact::Rational toi_tolerance = default_toi_tolerance();
  /// Called for every query, in order, never from two threads at once.
  std::function<void(const judge::GroundTruth&)> on_truth = nullptr;
  /// Called with the certificates of queries (touchstone/certificate.hpp), whole ones and in order,
  /// never from two threads at once. Without it none are made.
  std::function<void(std::string_view)> on_certificates = nullptr;
  exact::ProveOptions proof = {};
  /// Called for each answer of the solvers with the query's index and, where more is known of it
  /// than the answer shows, its failure (else null); a block of one solver after the other, in
  /// order, never from two threads at once.
  std::function<void(std::uint64_t, const fast::Answer&, const judge::Failure*)> on_answer =
      nullptr;
  /// Called with each query that a solver answered wrongly (an answer that breaks its promise), or
  /// that has a mismatch; with the answers of all solvers; in order, never from two threads at
  /// once. Of a great many wrong answers in a row some are left out.
  std::function<void(judge::WrongQuery)> on_wrong = nullptr;
  /// Called now and then with the fraction of the source that is read; never from two threads at
  /// once.
  std::function<void(double)> on_progress = nullptr;
  /// Once true, no further queries are read and the result is that of those read so far.
  const std::atomic<bool>* stop = nullptr;
  /// Behind it no further queries are read (Budget::begin_source).
  base::Deadline deadline = {};
  /// Is time short? Then queries are decided in smaller blocks.
  bool is_short_of_time = false;
  /// Judged on every query; not null.
  std::vector<const solvers::Solver*> solvers = {};

  /// 1e-40: what the 45 digits of published times of impact have to offer.
  static exact::Rational default_toi_tolerance();
};

/// The judgement on one solver.
struct MethodResult {
  std::string name;
  fast::Promise promise = fast::Promise::none;  ///< what it is held to
  fast::Terms terms = {};                       ///< the terms of that
  bool timed = false;                           ///< true if its processor time is known
  judge::Judgement judgement;

  /// Mean processor time of a query, where it is known.
  [[nodiscard]] std::optional<double> nanoseconds_per_query() const;
  /// Mean number of checks of a query, where the solver counts them.
  [[nodiscard]] std::optional<double> checks_per_query() const;
};

/// The result of a solver that was asked nothing.
[[nodiscard]] MethodResult result_of(const solvers::Solver& solver);

/// The judgement on one source.
struct CertifyResult {
  std::string name;
  Separation separation = {};  ///< what counted as contact; not set in a total
  /// Which recorded claims were compared; not set in a total.
  judge::Inference compared = judge::Inference::all;
  std::optional<QueryShape> shape;  ///< empty for a total, and for a source that was not opened
  std::uint64_t queries = 0;        ///< decided
  std::uint64_t collisions = 0;     ///< of these, by the truth
  std::uint64_t labels = 0;         ///< queries with a recorded verdict that is compared
  std::uint64_t label_mismatches = 0;
  std::uint64_t tois = 0;  ///< queries with a recorded time of impact that is compared
  std::uint64_t toi_mismatches = 0;
  std::uint64_t skipped = 0;  ///< in error, left out
  std::uint64_t rounded = 0;  ///< coordinates rounded to double
  std::uint64_t errors = 0;   ///< errors that ended the reading
  double microseconds = 0.0;  ///< processor time of the oracle, summed over the queries
  std::vector<judge::Mismatch> mismatches;
  ProofCounts proofs;  ///< what was proved, where certificates are asked for
  /// In the order of CertifyOptions::solvers.
  std::vector<MethodResult> methods;
  /// The error that ended the reading before the source's end; all of the above holds up to there.
  std::optional<std::string> error;
  bool interrupted = false;  ///< by the stop, or by the deadline: queries are left

  /// Mean time of the oracle; 0 if there are no queries.
  [[nodiscard]] double microseconds_per_query() const;

  /// Sets the error that ended the reading.
  void fail(const std::string& message);

  /// Adds all counts of another source; the mismatches and wrong answers stay with their source.
  CertifyResult& operator+=(const CertifyResult& other);
};

/// True if a recorded answer differs from the truth, or a solver has broken its promise.
[[nodiscard]] bool has_wrong_answers(const CertifyResult& result);

/// Decides every query of the source, and judges labels (verify/judge/label.hpp) and answers
/// (verify/judge/judge.hpp). Errors of the source end up in the result.
[[nodiscard]] CertifyResult certify(data::QuerySource& source, const CertifyOptions& options = {});

/// Sums of all counts, in a result called "total"; the mismatches and wrong answers stay with their
/// sources. \pre all were judged with the same solvers.
[[nodiscard]] CertifyResult total(const std::vector<CertifyResult>& results);

}  // namespace touchstone::verify::jobs
