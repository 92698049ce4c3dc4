#pragma once

/// \file
/// A query to be looked at.

#include <string>
#include <vector>

#include "touchstone/any_kind.hpp"
#include "verify/base/any_query.hpp"
#include "verify/judge/judgement.hpp"

namespace touchstone::verify::view {

/// A query to be looked at. Texts may hold any bytes.
struct ViewedQuery {
  std::string label = {};     ///< its origin
  base::AnyQuery query = {};  ///< finite numbers, positive weights
  Separation separation = {};
  std::vector<std::string> notes = {};  ///< recorded remarks, a sentence each
  std::vector<judge::GivenAnswer> answers = {};
  /// False: leaves out the nearest approach of primitives that do not collide, which takes longest.
  bool with_approach = true;
  /// A stream of one certificate; where it is empty, the oracle's own is shown.
  std::string certificate = {};
};

}  // namespace touchstone::verify::view
