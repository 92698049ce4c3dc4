#pragma once

/// \file
/// The one job on the queries of a source: decide them, hold labels and solvers' answers against
/// the truth, and pass on truth, certificates, answers or wrong queries, as requested.
///
/// Queries stream from the source through the oracle and the solvers, in blocks on all cores, and
/// come out in the order they went in: the output does not depend on the number of threads. Time is
/// the processor time that the oracle takes, so that it does not depend on them either, nor on
/// reading.

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fast/method.hpp"
#include "touchstone/any_kind.hpp"
#include "touchstone/number.hpp"
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
  /// Cores to use; 0: all of them.
  unsigned threads = 0;
  /// The tolerated error of a recorded time of impact (published ones have 45 digits); 0: none.
  exact::Rational toi_tolerance = exact::rational_from_decimal("1e-40");
  /// Called for every query, in order, never from two threads at once.
  std::function<void(const judge::GroundTruth&)> on_truth = nullptr;
  /// Called with the certificates of queries (touchstone/certificate.hpp), whole ones and in order,
  /// never from two threads at once. Without it none are made.
  std::function<void(std::string_view)> on_certificates = nullptr;
  exact::ProveOptions proof = {};
  /// Called for each answer of a solver, with the query's index and its failure, if more is
  /// known than the answer shows (else null). The answers of a block come solver by solver, in
  /// order, never from two threads at once.
  std::function<void(const solvers::Solver&, std::uint64_t, const fast::Answer&,
                     const judge::Failure*)>
      on_answer = nullptr;
  /// Called with each query that a solver answered wrongly (an answer that breaks its promise), or
  /// that has a mismatch; with the answers of all solvers; in order, never from two threads at
  /// once. Some of a great many wrong answers in a row are left out.
  std::function<void(judge::WrongQuery)> on_wrong = nullptr;
  /// Called now and then with the fraction of the source that is read; never from two threads at
  /// once.
  std::function<void(double)> on_progress = nullptr;
  /// Once true, no further queries are read and the result is that of those read so far.
  const std::atomic<bool>* stop = nullptr;
  /// No further queries are read after it (Budget::begin_source).
  base::Deadline deadline = {};
  /// Judged on every query; not null.
  std::vector<const solvers::Solver*> solvers = {};
};

/// The judgement on one solver.
struct MethodResult {
  std::string name;
  fast::Promise promise = fast::Promise::none;  ///< the promise that it is judged by
  fast::Terms terms = {};                       ///< the terms of that promise
  bool timed = false;                           ///< true if its processor time is known
  judge::Judgement judgement;

  /// Mean processor time of a query, where it is known.
  [[nodiscard]] std::optional<double> nanoseconds_per_query() const;
};

/// The result of a solver that was asked nothing.
[[nodiscard]] MethodResult result_of(const solvers::Solver& solver);

/// The judgement on one source.
struct CertifyResult {
  std::string name;
  Separation separation = {};  ///< the distance that counted as contact; not set in a total
  /// The recorded claims that were compared; not set in a total.
  judge::Inference compared = judge::Inference::all;
  std::optional<AnyShape> shape;  ///< empty for a total, and for a source that was not opened
  std::uint64_t queries = 0;
  std::uint64_t collisions = 0;  ///< of these, by the truth
  std::uint64_t labels = 0;      ///< queries with a recorded verdict that is compared
  std::uint64_t label_mismatches = 0;
  std::uint64_t tois = 0;  ///< queries with a recorded time of impact that is compared
  std::uint64_t toi_mismatches = 0;
  std::uint64_t skipped = 0;  ///< in error, left out
  std::uint64_t rounded = 0;  ///< coordinates rounded to double
  std::uint64_t errors = 0;   ///< errors that ended the reading
  double microseconds = 0.0;  ///< processor time of the oracle, summed over the queries
  std::vector<judge::Mismatch> mismatches;
  ProofCounts proofs;  ///< the proofs, where certificates are asked for
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

/// The wall-clock time of a run over several sources. The remaining sources share the remaining
/// time equally, and within a source the solvers share nearly all of it equally, so that neither a
/// slow source nor a slow solver takes the time of the others. When a solver's share is used up,
/// its further queries are skipped (Solver::allow); a query that was begun may end.
class Budget {
 public:
  /// No limit.
  Budget() = default;

  /// \param seconds positive
  /// \param threads that ask each solver, 0: all cores
  Budget(double seconds, std::vector<const solvers::Solver*> solvers, unsigned threads,
         const base::SecondsClock& clock = base::steady_seconds);

  /// Begins one of the sources that are left: gives each solver its share, and returns the deadline
  /// after which no further queries are to be read.
  [[nodiscard]] base::Deadline begin_source(std::size_t sources_left) const;

  [[nodiscard]] bool is_over() const { return end_.is_over(); }

 private:
  base::Deadline end_;
  std::vector<const solvers::Solver*> solvers_;
  int threads_ = 1;
};

}  // namespace touchstone::verify::jobs
