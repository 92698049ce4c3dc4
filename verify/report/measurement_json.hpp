#pragma once

/// \file
/// Measurements as JSON and back, without loss.

#include <nlohmann/json_fwd.hpp>

#include "verify/report/measurement.hpp"

namespace touchstone::verify::report {

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
