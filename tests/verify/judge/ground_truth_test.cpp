#include "verify/judge/ground_truth.hpp"

#include <gtest/gtest.h>

#include <limits>
#include <stdexcept>

namespace touchstone::verify::ground_truth_test {
namespace {

using exact::Rational;

/// A vertex falls from height 2 to height 0 on the middle of a resting triangle.
constexpr Query falling{{1, 1, 2, 0, 0, 0, 4, 0, 0, 0, 4, 0,  //
                         1, 1, 0, 0, 0, 0, 4, 0, 0, 0, 4, 0}};

TEST(Decision, IsAboutTheSeparation) {
  EXPECT_EQ(Decision(Kind::vertex_face, falling, {}).toi(), Rational(1));
  for (const Norm norm : {Norm::linf, Norm::l2}) {
    EXPECT_EQ(Decision(Kind::vertex_face, falling, {.distance = 1.0, .norm = norm}).toi(),
              Rational(1, 2));
    EXPECT_EQ(Decision(Kind::vertex_face, falling, {.distance = 0.0, .norm = norm}).toi(),
              Rational(1));
  }
  Query above = falling;
  above.at(1, 0, 2) = 1.5;
  EXPECT_FALSE(Decision(Kind::vertex_face, above, {.distance = 1.0}).collides());
  EXPECT_TRUE(Decision(Kind::vertex_face, above, {.distance = 1.5}).collides());
}

TEST(Decision, RefusesWhatIsNoQueryOrNoSeparation) {
  Query bad = falling;
  bad.at(0, 0, 0) = std::numeric_limits<double>::infinity();
  EXPECT_THROW(Decision(Kind::vertex_face, bad, {}), std::invalid_argument);
  EXPECT_THROW(Decision(Kind::vertex_face, bad, {.distance = 1.0}), std::invalid_argument);
  EXPECT_THROW(Decision(Kind::vertex_face, falling, {.distance = -1.0}), std::invalid_argument);
}

}  // namespace
}  // namespace touchstone::verify::ground_truth_test
