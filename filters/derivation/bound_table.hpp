#pragma once

/// \file
/// The table of all bounds, by each model: what `touchstone derive` prints.

#include <cstdint>
#include <functional>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "filters/derivation/rounding_model.hpp"
#include "filters/derivation/worst_case.hpp"

namespace touchstone::filters {

/// Where a bound comes from.
enum class Model : std::uint8_t {
  published,  ///< the paper's rounding model (published_model.hpp)
  rigorous,   ///< ours (rounding_model.hpp)
  gappa,      ///< what Gappa proves (gappa.hpp)
  observed    ///< no bound: the worst error found (worst_case.hpp)
};

struct DeriveOptions {
  std::set<Model> models{Model::published, Model::rigorous, Model::gappa, Model::observed};
  std::vector<Format> formats{double_format, float_format, double_double_format};
  WorstCaseOptions search;
  unsigned threads = 0;  ///< 0: as many as the machine has
  /// Called with the fraction done, from 0 to 1, from any thread but one at a time.
  std::function<void(double)> progress = [](double) {};
  /// Asked before each piece of work: return true to leave out the rest.
  std::function<bool()> stop = [] { return false; };
};

/// An expression in a precision. Bounds are multiples of u x^k; what was not asked for, or could
/// not be had, is empty.
struct DeriveRow {
  std::string expression;
  Format format;
  std::string published_constant;      ///< as printed; empty if none
  std::optional<mpq_class> published;  ///< the published model on the published order
  std::optional<mpq_class> rigorous;   ///< our bound
  std::optional<mpq_class> gappa;      ///< Gappa's
  std::optional<WorstCase> observed;   ///< the worst input found
  [[nodiscard]] std::optional<double> tightness() const;  ///< our bound over the worst observed
};

struct DeriveResult {
  std::vector<DeriveRow> rows;
  bool gappa_missing = false;  ///< Gappa was asked for but cannot be run
  bool stopped = false;
};

/// All rows of the catalogue.
/// \throws what the models throw, GappaMissing excepted.
[[nodiscard]] DeriveResult derive(const DeriveOptions& options);

/// The rows as text, a line each.
[[nodiscard]] std::string to_table(const DeriveResult& result);

}  // namespace touchstone::filters
