// Stands for device code of your own.
#pragma once

struct Range {
  float lower, upper;
};

__device__ __forceinline__ Range x_range(const float3* points, int first, int count) {
  Range range = {points[first].x, points[first].x};
  for (int end = 0; end < 2; ++end) {
    for (int i = first; i < first + count; ++i) {
      range.lower = fminf(range.lower, points[4 * end + i].x);
      range.upper = fmaxf(range.upper, points[4 * end + i].x);
    }
  }
  return range;
}

/// Do the ranges of vertex and face along x overlap? Four points at t=0, then at t=1.
__device__ bool vertex_face_may_collide(const float3* points) {
  const Range vertex = x_range(points, 0, 1), face = x_range(points, 1, 3);
  return vertex.lower <= face.upper && face.lower <= vertex.upper;
}
