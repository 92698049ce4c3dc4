#include "touchstone/derivation/catalogue.hpp"

#include <algorithm>
#include <stdexcept>

#include "touchstone/derivation/shipped_bound.hpp"
#include "touchstone/filters/expressions.hpp"
#include "touchstone/filters/polynomial_expressions.hpp"
#include "touchstone/filters/separation_expressions.hpp"

namespace touchstone::filters {
namespace {

enum class Ships : bool { no, yes };

template <class Expression>
CatalogueEntry entry(Ships ships, const PublishedConstants& published) {
  return {.graph = record<Expression>(),
          .evaluators = evaluators<Expression>(),
          .published = published,
          .formats = {double_format, float_format},
          .ships = ships == Ships::yes};
}

/// An expression of the certified solver, in the formats in which it runs.
template <class Expression>
CatalogueEntry entry(const std::vector<Format>& formats) {
  return {.graph = record<Expression>(),
          .evaluators = evaluators<Expression>(),
          .published = std::nullopt,
          .formats = formats,
          .ships = true};
}

constexpr PublishedConstants edge_edge{"6.217248937900877e-15", "3.337861e-06",
                                       PaperEdgeEdge::name};
constexpr PublishedConstants vertex_face{"6.661338147750939e-15", "3.576279e-06",
                                         PaperVertexFace::name};
constexpr PublishedConstants edge_edge_separated{"7.105427357601002e-15", "3.814698e-06",
                                                 PaperEdgeEdgeSeparated::name};
constexpr PublishedConstants vertex_face_separated{"7.549516567451064e-15", "4.053116e-06",
                                                   PaperVertexFaceSeparated::name};

std::vector<CatalogueEntry> make_catalogue() {
  return {
      entry<EdgeEdge>(Ships::yes, edge_edge),
      entry<VertexFace>(Ships::yes, vertex_face),
      entry<EdgeEdgeSeparated>(Ships::yes, edge_edge_separated),
      entry<VertexFaceSeparated>(Ships::yes, vertex_face_separated),
      entry<MeasuredProjectedGap>({double_format}),
      entry<MeasuredDeterminantEnd>({double_format, float_format}),
      entry<MeasuredDeterminantMiddle>({double_format, float_format}),
      entry<MeasuredOrientationEnd>({double_format, float_format}),
      entry<MeasuredOrientationMiddle>({double_format, float_format}),
      entry<DeterminantEnd>({double_double_format}),
      entry<MeasuredAdvancedGap>({double_format, float_format}),
      entry<AdvancedGap>({double_double_format}),
      entry<CornerGap>({double_format}),
      entry<ComponentSum>({double_format, float_format}),
      entry<SquaredLength>({double_format, float_format}),
      entry<LengthDefect>({double_double_format}),
      entry<ContactComponent>({double_double_format}),
      entry<Position>({double_format}),
      entry<QuadraticEdgeEdgeSeparated>({double_format}),
      entry<QuadraticVertexFaceSeparated>({double_format}),
      entry<CubicEdgeEdgeSeparated>({double_format}),
      entry<CubicVertexFaceSeparated>({double_format}),
      entry<PaperEdgeEdge>(Ships::no, edge_edge),
      entry<PaperVertexFace>(Ships::no, vertex_face),
      entry<PaperEdgeEdgeSeparated>(Ships::no, edge_edge_separated),
      entry<PaperVertexFaceSeparated>(Ships::no, vertex_face_separated),
  };
}

}  // namespace

const std::vector<CatalogueEntry>& catalogue() {
  static const std::vector<CatalogueEntry> entries = make_catalogue();
  return entries;
}

const CatalogueEntry& find_expression(std::string_view name) {
  const auto found =
      std::ranges::find(catalogue(), name, [](const CatalogueEntry& e) { return e.graph.name; });
  if (found == catalogue().end()) {
    throw std::invalid_argument("no expression " + std::string(name) + " in the catalogue");
  }
  return *found;
}

std::string error_bounds_header() {
  std::vector<ShippedExpression> shipped;
  for (const CatalogueEntry& e : catalogue()) {
    if (!e.ships) continue;
    for (const Format& format : e.formats) shipped.push_back({e.graph, format});
  }
  return error_bounds_header(shipped);
}

}  // namespace touchstone::filters
