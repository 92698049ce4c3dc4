#pragma once

/// \file
/// TCCD: Bernstein sign classification in floating point with running error bounds ([wang2015];
/// docs/methods.md, sections 6 and 7).
///
/// **Algorithm.** The coplanarity cubic Y is examined on [0,1], or, if it has an inflection, on the
/// parts before and after it, so that on each it has at most two roots. Counting them needs the
/// sign of Y at its extremum; a contact at one is decided by the signs of three quartics there.
/// Both are found without computing a root, by the reductions of bernstein.hpp. Every number
/// carries a bound of its error (error_bounded.hpp); a root is rejected only if a sign is certain.
///
/// **Answer.** A verdict, without a time of impact (a yes ignores t_max) and without separation.
///
/// **Known defects.**
///   - *False positives*: all motion in a common plane (Y ≡ 0). More: where Y is linear within its
///     bounds, as for any pair in relative translation, and changes sign in the middle third of the
///     step, its signs are +, +, −, −; that looks like an inflection at an unknown place and is
///     answered with a collision without any inside test. A vertex that falls through the plane of
///     a triangle five edges away is reported at every crossing time from 0.34 to 0.66. In the
///     outer thirds the decomposition degenerates and often rejects nothing.
///   - *False negatives at unknown signs*. The method is published as free of them. But if Y and
///     its derivative both have unknown signs at the zero of a linear form, the published rule uses
///     the form's signs at the ends as those at the two roots. The zero may also be before both or
///     after both; and if it is a double root of Y, a constraint that is 0 there rejects the first
///     root and another one the second. The test has such a grazing contact of few-bit coordinates.
///   - *False negatives by underflow*, which causes unknown signs. After an inflection the
///     coefficients of both parts are multiplied through by powers of its denominator: cubics have
///     degree 12 in the coordinates' scale, quartics 16, J 40, T 80, K 92, and Y where K vanishes
///     288. Differences of 1e-2 make 1e-576 of that: Y and its derivative are 0 with a bound of 0,
///     and the rule above applies. At other scales bounds vanish before their values and make them
///     certain, or T is "exactly 0" and J linear when it is not. The test scales collisions down by
///     powers of two, which should change no answer: a tenth of them are missed at 2^-8, including
///     all with an inflection (without one the highest degree is 72). When all numbers are 0, every
///     answer is a collision.
///
/// Of the true contacts of armadillo-rollers, 4,650 vertex-face and 19,308 edge-edge, it misses 23
/// and 171: 2.3 and 6.7 in 200,000 candidates, where the released code was seen to miss 3 and 4.
/// With all coordinates times 16 it misses 0 and 3: all others are underflow. In an experiment that
/// left the two unknown signs unknown, it missed none of them at either scale.
///
/// **Promise.** None, for these reasons. The reading of an uninitialised sign (both ends of the
/// derivative unknown) is not reproduced: the signs there follow from the curvature.

#include <memory>

#include "fast/method.hpp"
#include "touchstone/query.hpp"

namespace touchstone::baselines {

/// TCCD's verdict. \pre all coordinates are finite, and the rounding is to nearest.
[[nodiscard]] bool tccd_collides(Kind kind, const Query& query);

/// The method `tccd`. It ignores all options.
[[nodiscard]] std::unique_ptr<fast::Method> tccd_method();

}  // namespace touchstone::baselines
