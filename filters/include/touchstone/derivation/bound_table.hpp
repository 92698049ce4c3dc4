#pragma once

/// \file
/// The table of all bounds, by each model, as `touchstone-derive` prints it.

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "touchstone/derivation/rounding_model.hpp"
#include "touchstone/derivation/worst_case.hpp"

namespace touchstone::filters {

/// The origin of a bound.
enum class Model : std::uint8_t {
  published,  ///< the paper's rounding model (published_model.hpp)
  rigorous,   ///< ours (rounding_model.hpp)
  gappa,      ///< the bound that Gappa proves (gappa.hpp)
  observed    ///< no bound: the worst error found (worst_case.hpp)
};

struct DeriveOptions {
  std::set<Model> models{Model::published, Model::rigorous, Model::gappa, Model::observed};
  std::vector<Format> formats{double_format, float_format, double_double_format};
  WorstCaseOptions search;
  unsigned threads = 0;  ///< 0: one for each core
};

/// An expression in a precision. Bounds are multiples of u x^k. A bound that was not requested or
/// not found is empty.
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
};

/// All rows of the catalogue.
/// \throws the exceptions of the models except GappaMissing.
[[nodiscard]] DeriveResult derive(const DeriveOptions& options);

/// The rows as text, a line each.
[[nodiscard]] std::string to_table(const DeriveResult& result);

}  // namespace touchstone::filters
