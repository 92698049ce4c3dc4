#pragma once

/// \file
/// The published numbers, as printed in [wang2021]: table 1 (without separation), its
/// table of MSRF against Tight-Inclusion and, in the appendix, of FPRF against it (over the minimum
/// separation d).
///
/// They were measured on another machine and on more data: 12K and 15K handcrafted queries, 18M and
/// 41M of simulations (vertex-face, edge-edge). Of these 4,884 and one step each are public.

#include <optional>
#include <string_view>

#include "touchstone/query.hpp"

namespace touchstone::verify::report {

/// A cell of a published table, as printed; K and M stand for thousands and millions.
struct PublishedNumbers {
  std::string_view microseconds;  ///< a query
  std::string_view false_positives;
  std::string_view false_negatives;
};

/// So many queries a published dataset has, as printed; empty if it is none.
/// \param dataset "handcrafted", "simulation", or "own-simulation": queries that `./run simulate --record` wrote, which stand
///     beside the published ones of simulations
[[nodiscard]] std::string_view published_size(std::string_view dataset, Kind kind);

/// The entry of a method in table 1, by our name of it; nothing if it is not there.
[[nodiscard]] std::optional<PublishedNumbers> published_field(std::string_view dataset, Kind kind,
                                                              std::string_view method);

/// The entries of a method in the tables over d.
[[nodiscard]] std::optional<PublishedNumbers> published_separation(std::string_view dataset,
                                                                   Kind kind,
                                                                   std::string_view method,
                                                                   double distance);

}  // namespace touchstone::verify::report
