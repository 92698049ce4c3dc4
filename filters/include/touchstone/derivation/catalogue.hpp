#pragma once

/// \file
/// The list of all expressions. To add one, write its template in
/// touchstone/filters/expressions.hpp or touchstone/filters/polynomial_expressions.hpp and its line
/// in catalogue.cpp; filters/README.md has an example.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "touchstone/derivation/expression_graph.hpp"
#include "touchstone/derivation/worst_case.hpp"

namespace touchstone::filters {

/// Constants published for a function [wang2021], as printed, and the expression whose order of
/// operations yields them in the published model.
struct PublishedConstants {
  std::string_view in_double;
  std::string_view in_float;
  std::string_view order;  ///< name of an expression of the catalogue
};

/// An expression with its evaluators and the published constants.
struct CatalogueEntry {
  ExpressionGraph graph;
  Evaluators evaluators;
  std::optional<PublishedConstants> published;
  std::vector<Format> formats;  ///< the formats that it runs in
  bool ships = false;           ///< its bounds stand in touchstone/filters/error_bounds.hpp
};

/// All expressions: those that ship, then the paper's orders of operations.
[[nodiscard]] const std::vector<CatalogueEntry>& catalogue();

/// The entry of a name.
/// \throws std::invalid_argument if there is none.
[[nodiscard]] const CatalogueEntry& find_expression(std::string_view name);

/// The text of touchstone/filters/error_bounds.hpp.
[[nodiscard]] std::string error_bounds_header();

}  // namespace touchstone::filters
