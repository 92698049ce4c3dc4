#pragma once

/// \file
/// A query to be looked at: of any shape, or, as in certificates, with a curve of its own degree
/// for each point.

#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "fast/method.hpp"
#include "touchstone/certificate.hpp"
#include "touchstone/curved_query.hpp"
#include "touchstone/oracle.hpp"
#include "touchstone/query.hpp"
#include "verify/base/any_query.hpp"
#include "verify/judge/judgement.hpp"

namespace touchstone::verify::view {

/// Points on curves that may differ in degree.
struct OwnCurves {
  Kind kind = Kind::vertex_face;
  CurvedQuery curves = {};

  friend bool operator==(const OwnCurves&, const OwnCurves&) = default;
};

/// A query to be looked at. Texts may hold any bytes.
struct ViewedQuery {
  std::string label = {};                           ///< its origin
  std::variant<base::AnyQuery, OwnCurves> query{};  ///< finite numbers, positive weights
  Separation separation = {};
  std::vector<std::string> notes = {};  ///< recorded remarks, a sentence each
  std::vector<judge::GivenAnswer> answers = {};
  /// False: leaves out the nearest approach of primitives that do not collide, which takes longest.
  bool with_approach = true;
  /// A stream of one certificate; where it is empty, the oracle's own is shown.
  std::string certificate = {};
};

[[nodiscard]] Kind kind_of(const ViewedQuery& viewed);

/// The curves of its points, each of its own degree.
[[nodiscard]] CurvedQuery curves_of(const ViewedQuery& viewed);

/// The query in the form for solvers: own curves as those of one degree, if all have this degree or
/// are constant; else nothing.
[[nodiscard]] std::optional<base::AnyQuery> in_one_shape(const ViewedQuery& viewed);

/// The same query on straight lines; null if it is on other curves.
[[nodiscard]] const Query* straight_of(const ViewedQuery& viewed);

/// The oracle's decision, and its proof. \throws as exact::decide and exact::prove
[[nodiscard]] exact::Decision decide(const ViewedQuery& viewed);
[[nodiscard]] exact::Certificate prove(const ViewedQuery& viewed, const exact::Decision& decision);

}  // namespace touchstone::verify::view
