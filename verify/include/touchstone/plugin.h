#pragma once

/// \file
/// The interface for solvers under test, for C99 and C++.
///
/// \code{.c}
/// // A solver that takes all for collisions but primitives with heights that stay apart.
/// #include <touchstone/plugin.h>
///
/// int32_t touchstone_plugin_version(void) { return TOUCHSTONE_PLUGIN_VERSION; }
/// const char* touchstone_plugin_name(void) { return "heights"; }
///
/// void touchstone_plugin_solve(int32_t kind, const double* x,
///                              const TouchstonePluginOptions* options,
///                              TouchstonePluginAnswer* answer) {
///   const int first = kind == TOUCHSTONE_VERTEX_FACE ? 1 : 2;  // points of the first primitive
///   int above = 1, below = 1;
///   for (int i = 0; i < 2 * first; ++i) {       // at t=0 and t=1
///     for (int j = 0; j < 2 * (4 - first); ++j) {
///       const double a = x[12 * (i / first) + 3 * (i % first) + 2];
///       const double b = x[12 * (j / (4 - first)) + 3 * (first + j % (4 - first)) + 2];
///       above = above && a > b + options->min_separation;
///       below = below && b > a + options->min_separation;
///     }
///   }
///   answer->verdict = above || below ? TOUCHSTONE_NO : TOUCHSTONE_YES;
///   answer->toi_lower = 0;  // no contact before this time
/// }
/// \endcode
///
/// A plugin is a shared library that defines the first three functions at the end of this header;
/// the fourth if its promise is another than the usual one; and the fifth if it is faster with many
/// queries at once. It needs no other header of Touchstone. `touchstone certify --plugin
/// ./libsolver.so` loads it and calls it for each query. `examples/plugin/` is a complete one.
///
/// The problem: four points move on straight lines from t=0 to t=1. A solver decides whether a
/// vertex and a triangle, or two edges, collide at some t in [0,1], and finds the first such t.
/// Contact at t=0, at t=1 and on the boundary of the primitives counts. With a minimum separation,
/// contact is a distance of at most that separation.
///
/// A solver may also, or only, answer queries about the inversion of cells, if its promise says
/// so (TouchstonePluginPromise::elements): "yes" if the volume of a tetrahedron with these four
/// points, or the area of a triangle in the plane, is 0 or negative at some t, the first of which
/// is its time. There is no separation then.
///
/// Version 2 added TouchstonePluginOptions::norm at the end. Plugins of version 1 are still
/// accepted: they receive the distance but not the norm, and are judged in the requested norm.

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif

// ---- Types in common: the same text in touchstone/touchstone.h and touchstone/plugin.h ----------
#ifndef TOUCHSTONE_TYPES
#define TOUCHSTONE_TYPES

#if defined(_WIN32)
#define TOUCHSTONE_API __declspec(dllexport)
#elif defined(__GNUC__)
#define TOUCHSTONE_API __attribute__((visibility("default")))
#else
#define TOUCHSTONE_API
#endif

/// The two primitives of a query, with its points in their order, or of a pair of a mesh; or the
/// kind of a cell. Points that a kind does not have have no effect.
enum TouchstoneKind {
  TOUCHSTONE_VERTEX_FACE = 0,    ///< v, f0, f1, f2; of a mesh: a vertex and a face
  TOUCHSTONE_EDGE_EDGE = 1,      ///< ea0, ea1, eb0, eb1; of a mesh: the smaller number first
  TOUCHSTONE_VERTEX_EDGE = 2,    ///< v, e0, e1; of a mesh: a codimensional point and edge
  TOUCHSTONE_VERTEX_VERTEX = 3,  ///< v, w; of a mesh: codimensional points, the smaller first
  TOUCHSTONE_TETRAHEDRON = 4,    ///< a cell a, b, c, d; det(b-a, c-a, d-a) > 0 upright
  TOUCHSTONE_PLANE_TRIANGLE = 5  ///< a cell: x and y of a, b, c; the rest has no effect
};

/// Norm of the distance of two points.
enum TouchstoneNorm {
  TOUCHSTONE_LINF = 0,  ///< the greatest of its components
  TOUCHSTONE_L2 = 1     ///< Euclid's
};

/// An answer to "do they collide?".
enum TouchstoneVerdict {
  TOUCHSTONE_NO = 0,
  TOUCHSTONE_YES = 1,
  TOUCHSTONE_UNDECIDED = 2,  ///< of plugins only: no decision; treated as a conservative yes
  TOUCHSTONE_ERROR = 3       ///< a coordinate is NaN or infinite; of plugins also: invalid options
};

#endif  // TOUCHSTONE_TYPES
// ---- End of the types in common -----------------------------------------------------------------

/// The version of this interface; touchstone_plugin_version returns it.
enum { TOUCHSTONE_PLUGIN_VERSION = 2 };

/// The common options of solvers. A solver ignores the options that do not apply to it.
typedef struct TouchstonePluginOptions {
  double tolerance;    ///< of tolerance-driven solvers, in units of the coordinates; default 1e-6
  int64_t max_checks;  ///< of iterative solvers: steps for a query; 0 or less: no limit
  double min_separation;  ///< distance that counts as contact, 0 or more
  double t_max;           ///< only impacts up to this time count, 0 to 1
  int32_t norm;           ///< one of TouchstoneNorm: of min_separation; since version 2
} TouchstonePluginOptions;

/// The answer, which the solver fills in. Initially the verdict is TOUCHSTONE_ERROR and every other
/// field NaN; the solver does not change fields for which it has no value. Times matter only with
/// TOUCHSTONE_YES, and must then be finite or NaN.
typedef struct TouchstonePluginAnswer {
  int32_t verdict;   ///< one of TouchstoneVerdict
  double toi_lower;  ///< claimed: not above the exact time of first contact
  double toi_upper;  ///< claimed: not below the exact time of first contact
  double tolerance;  ///< with yes, in units of the coordinates: claims that at some time the
                     ///< distance, in the requested norm, is at most min_separation + tolerance. A
                     ///< yes beyond that is a fault.
} TouchstonePluginAnswer;

/// The promise of a solver about its answers.
enum TouchstonePromise {
  TOUCHSTONE_PROMISES_NOTHING = 0,       ///< wrong answers of all kinds occur
  TOUCHSTONE_PROMISES_CONSERVATIVE = 1,  ///< no missed collision, no late time; false positives
  TOUCHSTONE_PROMISES_EXACT = 2          ///< no wrong answer at all
};

/// The meaning of a solver's times of impact.
enum TouchstoneTimes {
  TOUCHSTONE_TIMES_BOUNDS = 0,     ///< toi_lower and toi_upper enclose the exact time
  TOUCHSTONE_TIMES_ESTIMATES = 1,  ///< the exact time is within time_error of toi_lower
  TOUCHSTONE_TIMES_NONE = 2        ///< the verdict alone counts
};

/// The promise of a solver, by which it is judged. It arrives with the values named below; the
/// plugin changes those that differ.
typedef struct TouchstonePluginPromise {
  uint32_t size;        ///< bytes of this struct that the caller knows; do not change it
  int32_t promise;      ///< one of TouchstonePromise; conservative
  int32_t kinds[2];     ///< by TouchstoneKind: 1 if it answers these queries, else 0; 1, 1
  int32_t is_float;     ///< 1 if it takes coordinates in single precision: queries are rounded to
                        ///< float before it is asked, and the truth is that of the rounded query; 0
  int32_t times;        ///< one of TouchstoneTimes; bounds
  double starts_apart;  ///< the distance at t=0 must be more than min_separation plus this, and the
                        ///< volume of a cell positive; negative: any start; -1
  double time_error;  ///< of estimates, in units of the step: an error up to this is no fault; 1e-6
  int32_t elements[2];  ///< 1 if it answers queries about tetrahedra, and about triangles in the
                        ///< plane; 0, 0. An addition: set it only if size is that of this struct.
} TouchstonePluginPromise;

/// Defined by the plugin: returns TOUCHSTONE_PLUGIN_VERSION.
TOUCHSTONE_API int32_t touchstone_plugin_version(void);

/// Defined by the plugin: the solver's name in reports, one line of UTF-8 text of at most 100 bytes
/// without control characters or invisible ones, that stays valid; not that of a built-in solver.
TOUCHSTONE_API const char* touchstone_plugin_name(void);

/// Defined by the plugin: answers one query. Must be thread-safe.
///
/// All functions, and the library's constructors, run in a child process whose memory and
/// file size are limited, and which may create threads but no processes (options of the command
/// line change both), in a temporary working directory. Its output is captured.
///
/// \param kind TOUCHSTONE_VERTEX_FACE or TOUCHSTONE_EDGE_EDGE, or an element that it has promised.
/// \param coordinates 24 finite doubles: x, y, z of the four points at t=0, then of the same four
///        at t=1, in the order that TouchstoneKind names.
/// \param options the user's options.
/// \param answer to be filled in.
TOUCHSTONE_API void touchstone_plugin_solve(int32_t kind, const double* coordinates,
                                            const TouchstonePluginOptions* options,
                                            TouchstonePluginAnswer* answer);

/// Defined by the plugin if its promise is not: conservative, both contacts, any start, double
/// precision, bounds of the time. Queries outside of the promise are not asked, and are no faults.
/// \param promise to be changed where it differs.
TOUCHSTONE_API void touchstone_plugin_promise(TouchstonePluginPromise* promise);

/// Defined by the plugin if it solves many queries at once: called in place of
/// touchstone_plugin_solve. After a crash, an exception or a hang the same queries are asked one by
/// one, with count = 1, so one of them costs no other.
/// \param count the number of queries, at least 1 and at most 512; as many answers, and 24 doubles
///        of coordinates for each query, one after the other.
TOUCHSTONE_API void touchstone_plugin_solve_batch(int32_t kind, int64_t count,
                                                  const double* coordinates,
                                                  const TouchstonePluginOptions* options,
                                                  TouchstonePluginAnswer* answers);

/// Defined by the plugin if it answers queries whose points move on Bezier curves: one query, as
/// touchstone_plugin_solve answers one on straight lines, and under the same rules. `touchstone
/// certify` calls it, and needs no touchstone_plugin_solve. The function is an addition that a
/// plugin may leave out, so the version of the interface stays 2.
///
/// The promise is that of touchstone_plugin_promise, but is_float must be 0, and the tolerance of
/// an answer is not judged.
/// \param degree of the curves, 1 to 8.
/// \param is_rational 1 if each control point has a weight, which is positive; else 0.
/// \param control the control points from t=0 to t=1, for each of the degree + 1 the four points in
///        the order of touchstone_plugin_solve, for each of these x, y, z, and the weight if the
///        curves are rational: (degree + 1) x 4 x (3 or 4) finite doubles.
TOUCHSTONE_API void touchstone_plugin_solve_curved(int32_t kind, int32_t degree,
                                                   int32_t is_rational, const double* control,
                                                   const TouchstonePluginOptions* options,
                                                   TouchstonePluginAnswer* answer);

#ifdef __cplusplus
}
#endif
