#pragma once

/// \file
/// A query to be looked at: of any shape, or, as certificates may state it, on curves of degrees of
/// their own.

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

/// Points on curves of degrees of their own.
struct OwnCurves {
  Kind kind = Kind::vertex_face;
  CurvedQuery curves = {};

  friend bool operator==(const OwnCurves&, const OwnCurves&) = default;
};

/// A query to be looked at. Texts may hold any bytes.
struct ViewedQuery {
  std::string label = {};                           ///< where it is from
  std::variant<base::AnyQuery, OwnCurves> query{};  ///< finite numbers, positive weights
  Separation separation = fast::no_separation;
  std::vector<std::string> notes = {};  ///< what is recorded of it, a sentence each
  std::vector<judge::GivenAnswer> answers = {};
  /// False: how near the primitives come without a collision, which takes longest, is left out.
  bool with_approach = true;
  /// A stream of one certificate; where it is empty, the oracle's own is shown.
  std::string certificate = {};
};

[[nodiscard]] Kind kind_of(const ViewedQuery& viewed);

/// The curves of its points, each of its own degree.
[[nodiscard]] CurvedQuery curves_of(const ViewedQuery& viewed);

/// As solvers are asked it: curves of their own as those of one degree, where all have it or are
/// constant; nothing if they differ.
[[nodiscard]] std::optional<base::AnyQuery> in_one_shape(const ViewedQuery& viewed);

/// The same query on straight lines; null if it is on other curves.
[[nodiscard]] const Query* straight_of(const ViewedQuery& viewed);

/// The oracle's decision, and its proof. \throws as exact::decide and exact::prove
[[nodiscard]] exact::Decision decide(const ViewedQuery& viewed);
[[nodiscard]] exact::Certificate prove(const ViewedQuery& viewed, const exact::Decision& decision);

}  // namespace touchstone::verify::view
