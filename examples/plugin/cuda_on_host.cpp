/// \file
/// A plugin of CUDA device code, compiled for the host: its words are defined away, the vector
/// types and functions that it uses are defined here. The order of floating-point operations stays;
/// nvcc contracts a*b + c to a fused operation unless told -fmad=false, so compile with
/// -ffp-contract=off for device code built that way, else with -ffp-contract=fast -mfma.

#include <cmath>
#include <cstdint>

#define __host__
#define __device__
#define __forceinline__ inline

struct float3 {
  float x, y, z;
};

inline float3 make_float3(float x, float y, float z) { return {x, y, z}; }

#include "touchstone/plugin.h"
#include "your_device_code.cuh"

std::int32_t touchstone_plugin_version() { return TOUCHSTONE_PLUGIN_VERSION; }

const char* touchstone_plugin_name() { return "cuda_on_host"; }

void touchstone_plugin_promise(TouchstonePluginPromise* promise) {
  promise->is_float = 1;
  promise->kinds[TOUCHSTONE_EDGE_EDGE] = 0;
  promise->times = TOUCHSTONE_TIMES_NONE;
}

void touchstone_plugin_solve(std::int32_t, const double* coordinates,
                             const TouchstonePluginOptions*, TouchstonePluginAnswer* answer) {
  float3 points[8];
  for (int i = 0; i < 8; ++i) {
    const double* const point = coordinates + 3 * i;
    points[i] = make_float3(static_cast<float>(point[0]), static_cast<float>(point[1]),
                            static_cast<float>(point[2]));
  }
  answer->verdict = vertex_face_may_collide(points) ? TOUCHSTONE_YES : TOUCHSTONE_NO;
}
