/* A solver as a plugin of Touchstone: the swept boxes of both primitives.
 *
 * A point that moves on a straight line stays in the box around its two ends, so a primitive stays
 * in the box around all ends of its points. If the boxes are apart along an axis, the primitives
 * never touch; if not, they may, and the answer is yes: never a false negative, many false
 * positives.
 *
 * The gap between two boxes is a rounded difference. It is still compared as if it were exact:
 * rounding is monotone and leaves the separation, a double, where it is, so a rounded gap above the
 * separation is a gap above it.
 */

#include <math.h>

#include "touchstone/plugin.h"

/* Range of the points first, …, first + count − 1 along an axis, at both ends of their motion. */
struct range {
  double lower;
  double upper;
};

static double coordinate(const double* coordinates, int end, int point, int axis) {
  return coordinates[12 * end + 3 * point + axis];
}

static struct range swept_range(const double* coordinates, int first, int count, int axis) {
  struct range range = {INFINITY, -INFINITY};
  for (int end = 0; end < 2; ++end) {
    for (int point = first; point < first + count; ++point) {
      const double x = coordinate(coordinates, end, point, axis);
      if (x < range.lower) range.lower = x;
      if (x > range.upper) range.upper = x;
    }
  }
  return range;
}

static int all_finite(const double* coordinates) {
  for (int i = 0; i < 24; ++i) {
    if (!isfinite(coordinates[i])) return 0;
  }
  return 1;
}

int32_t touchstone_plugin_version(void) { return TOUCHSTONE_PLUGIN_VERSION; }

const char* touchstone_plugin_name(void) { return "box_overlap"; }

void touchstone_plugin_solve(int32_t kind, const double* coordinates,
                             const TouchstonePluginOptions* options,
                             TouchstonePluginAnswer* answer) {
  /* Points of the first primitive: a vertex, or an edge. The verdict is an error until set. */
  const int first = kind == TOUCHSTONE_VERTEX_FACE ? 1 : 2;
  if (!all_finite(coordinates) || !(options->min_separation >= 0.0)) return;
  for (int axis = 0; axis < 3; ++axis) {
    const struct range a = swept_range(coordinates, 0, first, axis);
    const struct range b = swept_range(coordinates, first, 4 - first, axis);
    if (b.lower - a.upper > options->min_separation ||
        a.lower - b.upper > options->min_separation) {
      answer->verdict = TOUCHSTONE_NO;
      return;
    }
  }
  answer->verdict = TOUCHSTONE_YES;
  answer->toi_lower = 0.0;
}
