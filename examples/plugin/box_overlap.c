/* A solver as a plugin of Touchstone: the swept boxes of both primitives.
 *
 * A point that moves on a Bezier curve stays in the box around its control points, which of a
 * straight line are its two ends, so a primitive stays in the box around all control points of its
 * points. If the boxes are apart along an axis, the primitives never touch; if not, they may, and
 * the answer is yes: never a false negative, many false positives.
 *
 * The gap between two boxes is a rounded difference. It is still compared as if it were exact:
 * rounding is monotone and leaves the separation, a double, where it is, so a rounded gap above the
 * separation is a gap above it.
 */

#include <math.h>

#include "touchstone/plugin.h"

/* The control points of a query: of each degree + 1 groups of four points with so many numbers. */
struct curves {
  const double* control;
  int degree;
  int numbers;
};

/* Range of the points first, …, first + count − 1 along an axis, of all their control points. */
struct range {
  double lower;
  double upper;
};

static struct range swept_range(const struct curves* curves, int first, int count, int axis) {
  struct range range = {INFINITY, -INFINITY};
  for (int group = 0; group <= curves->degree; ++group) {
    for (int point = first; point < first + count; ++point) {
      const double x = curves->control[(4 * group + point) * curves->numbers + axis];
      if (x < range.lower) range.lower = x;
      if (x > range.upper) range.upper = x;
    }
  }
  return range;
}

static int all_finite(const struct curves* curves) {
  for (int i = 0; i < 4 * (curves->degree + 1) * curves->numbers; ++i) {
    if (!isfinite(curves->control[i])) return 0;
  }
  return 1;
}

int32_t touchstone_plugin_version(void) { return TOUCHSTONE_PLUGIN_VERSION; }

const char* touchstone_plugin_name(void) { return "box_overlap"; }

void touchstone_plugin_solve_curved(int32_t kind, int32_t degree, int32_t is_rational,
                                    const double* control, const TouchstonePluginOptions* options,
                                    TouchstonePluginAnswer* answer) {
  const struct curves curves = {control, degree, is_rational ? 4 : 3};
  /* Points of the first primitive: a vertex, or an edge. The verdict is an error until set. */
  const int first = kind == TOUCHSTONE_VERTEX_FACE ? 1 : 2;
  if (!all_finite(&curves) || !(options->min_separation >= 0.0)) return;
  for (int axis = 0; axis < 3; ++axis) {
    const struct range a = swept_range(&curves, 0, first, axis);
    const struct range b = swept_range(&curves, first, 4 - first, axis);
    if (b.lower - a.upper > options->min_separation ||
        a.lower - b.upper > options->min_separation) {
      answer->verdict = TOUCHSTONE_NO;
      return;
    }
  }
  answer->verdict = TOUCHSTONE_YES;
  answer->toi_lower = 0.0;
}

/* Straight lines are curves of degree 1. */
void touchstone_plugin_solve(int32_t kind, const double* coordinates,
                             const TouchstonePluginOptions* options,
                             TouchstonePluginAnswer* answer) {
  touchstone_plugin_solve_curved(kind, 1, 0, coordinates, options, answer);
}
