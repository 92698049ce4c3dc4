#pragma once

/// \file
/// Properties for RapidCheck as expectations of GoogleTest: the same cases in every run, from
/// the seed in the test, and failures are reduced to the simplest case before they are reported.

#include <gtest/gtest.h>
#include <rapidcheck.h>

#include <cstdint>
#include <sstream>
#include <utility>

#include "tests/support/trials.hpp"

namespace touchstone::tests {

/// Expects the property for this number of random arguments (fewer under the sanitizers). It fails
/// by RC_ASSERT or by returning false; RC_PRE discards arguments.
template <class Property>
void expect_property(std::uint64_t seed, int cases, Property&& property) {
  rc::detail::TestParams parameters;
  parameters.seed = seed;
  parameters.maxSuccess = trials(cases);
  const auto result = rc::detail::checkTestable(std::forward<Property>(property),
                                                rc::detail::TestMetadata{}, parameters);
  if (result.template is<rc::detail::SuccessResult>()) return;
  std::ostringstream text;
  rc::detail::printResultMessage(result, text);
  ADD_FAILURE() << text.str();
}

}  // namespace touchstone::tests
