#pragma once

/// \file
/// Decisions and proofs about queries of any kind: contacts or inversions. Of an inversion, a
/// decision and a result have the time alone. All functions are thread-safe.

#include <cstddef>
#include <span>

#include "touchstone/any_kind.hpp"
#include "touchstone/certificate.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone::verify::base {

/// The oracle's decision. \throws as exact::decide and exact::first_inversion;
/// std::invalid_argument for a separation of cells.
[[nodiscard]] exact::Decision decide(const AnyQueries& queries, std::size_t i,
                                     const Separation& separation = {});

/// The proof of a decision. \throws as exact::prove and exact::prove_inversion
[[nodiscard]] exact::Certificate prove(const AnyQueries& queries, std::size_t i,
                                       const exact::Decision& decision,
                                       const exact::ProveOptions& options = {});

/// The certified solver's results. \throws as fast::solve and fast::inversions
void solve(const AnyQueries& queries, std::span<fast::CertifiedResult> results,
           const fast::CertifiedOptions& options = {});

}  // namespace touchstone::verify::base
