#include "verify/view/viewed_query.hpp"

#include <algorithm>
#include <cstddef>
#include <utility>

namespace touchstone::verify::view {
namespace {

QueryShape common_shape(const OwnCurves& own) {
  QueryShape shape{.kind = own.kind};
  for (const Trajectory& curve : own.curves) {
    shape.degree = std::max(shape.degree, curve.degree());
    shape.is_rational = shape.is_rational || !curve.weights.empty();
  }
  return shape;
}

std::optional<base::AnyQuery> in_one_shape(const OwnCurves& own) {
  const QueryShape shape = common_shape(own);
  std::vector<double> numbers;
  for (std::size_t j = 0; j <= shape.degree; ++j) {
    for (const Trajectory& curve : own.curves) {
      if (curve.degree() != 0 && curve.degree() != shape.degree) return std::nullopt;
      const std::size_t i = std::min(j, curve.degree());
      numbers.insert(numbers.end(), curve.control[i].begin(), curve.control[i].end());
      if (shape.is_rational) numbers.push_back(curve.weights.empty() ? 1.0 : curve.weights[i]);
    }
  }
  return base::AnyQuery(shape, std::move(numbers));
}

}  // namespace

Kind kind_of(const ViewedQuery& viewed) {
  const auto* const own = std::get_if<OwnCurves>(&viewed.query);
  return own != nullptr ? own->kind : std::get<base::AnyQuery>(viewed.query).kind();
}

CurvedQuery curves_of(const ViewedQuery& viewed) {
  const auto* const own = std::get_if<OwnCurves>(&viewed.query);
  return own != nullptr ? own->curves
                        : to_curved(std::get<base::AnyQuery>(viewed.query).queries(), 0);
}

std::optional<base::AnyQuery> in_one_shape(const ViewedQuery& viewed) {
  const auto* const own = std::get_if<OwnCurves>(&viewed.query);
  return own != nullptr ? in_one_shape(*own) : std::get<base::AnyQuery>(viewed.query);
}

const Query* straight_of(const ViewedQuery& viewed) {
  const auto* const query = std::get_if<base::AnyQuery>(&viewed.query);
  return query != nullptr && query->shape().is_straight() ? &query->straight() : nullptr;
}

exact::Decision decide(const ViewedQuery& viewed) {
  const auto* const own = std::get_if<OwnCurves>(&viewed.query);
  if (own != nullptr) return exact::decide(own->kind, own->curves, viewed.separation);
  return exact::decide(std::get<base::AnyQuery>(viewed.query).queries(), 0, viewed.separation);
}

exact::Certificate prove(const ViewedQuery& viewed, const exact::Decision& decision) {
  const auto* const own = std::get_if<OwnCurves>(&viewed.query);
  if (own != nullptr) return exact::prove(own->kind, own->curves, decision);
  return exact::prove(std::get<base::AnyQuery>(viewed.query).queries(), 0, decision);
}

}  // namespace touchstone::verify::view
