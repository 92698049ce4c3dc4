#pragma once

/// \file
/// F (touchstone/query.hpp) from its definition, in any numbers.

#include <array>
#include <cstddef>

#include "touchstone/query.hpp"

namespace touchstone::tests {

/// F(t,u,v), evaluated with the operations of `Scalar` in the order of its formulas: the
/// value itself if they are exact (rationals), an unfiltered approximation if they are not.
/// `Scalar` must be constructible from double and have +, − and *.
template <class Scalar>
[[nodiscard]] std::array<Scalar, 3> contact_function(ContactKind kind, const Query& query,
                                                     const Scalar& t, const Scalar& u,
                                                     const Scalar& v) {
  const Scalar one(1.0);
  std::array<Scalar, 3> value;
  for (std::size_t axis = 0; axis < 3; ++axis) {
    const auto position = [&](std::size_t point) {
      return Scalar((one - t) * Scalar(query.at(0, point, axis)) +
                    t * Scalar(query.at(1, point, axis)));
    };
    const Scalar a = position(0), b = position(1), c = position(2), d = position(3);
    value[axis] = kind == ContactKind::vertex_face
                      ? Scalar(a - ((one - u - v) * b + u * c + v * d))
                      : Scalar(((one - u) * a + u * b) - ((one - v) * c + v * d));
  }
  return value;
}

}  // namespace touchstone::tests
