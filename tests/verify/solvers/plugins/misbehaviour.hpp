#pragma once

/// \file
/// The actions of the misbehaving plugin, which the first coordinate of a query selects.

namespace touchstone::tests {

enum class Misbehaviour {
  says_no,
  says_no_with_toi,  ///< from 1/4 to 1/2, tolerance 1e-9, as all with a wrong verdict
  is_undecided,
  verdict_too_large,
  verdict_negative,
  infinite_toi_lower,
  infinite_toi_upper,
  yes_without_toi,
  repeats_query,    ///< yes; times: coordinates 1 and 23; tolerance: the kind
  repeats_norm,     ///< yes, the norm as the time
  repeats_options,  ///< yes if max_checks is 77; times: tolerance, min_separation; tolerance: t_max
  negative_tolerance,
  nan_tolerance,
  infinite_tolerance,
  dies_at_call_1500,  ///< in one process; until then it says no
  leaves_answer_alone,
  throws,
  exits_with_3,
  prints,                ///< on both streams, then says no
  writes_a_file,         ///< into its working directory; no if it can
  forks,                 ///< eight children, each for a moment, then says no; throws if refused
  allocates,             ///< 2 GiB in blocks, then says no
  yes_with_tolerance_0,  ///< from time 0 on
  copies_itself,         ///< the copy says yes, it no, after the copy has ended
  signals_parent,        ///< yes if it may send its parent a signal, or may not send itself one
  aborts,
  writes_to_null,
  kills_itself,
  throws_a_number,
  exits_at_once,       ///< with status 0
  writes_without_end,  ///< a file
  hangs,               ///< at work
  sleeps,
  closes_all  ///< its descriptors, then sleeps
};

}  // namespace touchstone::tests
