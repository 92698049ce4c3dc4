#pragma once

/// \file
/// The interface for solvers under test, for C99 and C++.
///
/// A plugin is a shared library that defines the three functions at the end of this header; it
/// needs no other header of Touchstone. `touchstone certify --plugin ./libsolver.so` loads it and
/// calls it for each query. `examples/plugin/` is a complete one.
///
/// The problem: four points move on straight lines from t=0 to t=1. Do a vertex and a triangle, or
/// two edges, collide at some t in [0,1], and when first? Contact at t=0, at t=1 and on the
/// boundary of the primitives counts. With a minimum separation, contact is a distance of at most
/// that separation.
///
/// Version 2 added touchstone_options::norm at the end. Plugins of version 1 are still accepted:
/// they receive the distance but not the norm, and are judged in the requested norm.

#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif
#pragma GCC visibility push(default)

/// The version of this interface; touchstone_plugin_version returns it.
enum { touchstone_interface_version = 2 };

/// The two primitives of a query.
enum touchstone_kind {
  touchstone_vertex_face = 0,  ///< a vertex v and the triangle f0, f1, f2
  touchstone_edge_edge = 1     ///< the edge ea0, ea1 and the edge eb0, eb1
};

/// Norm of the distance of two points.
enum touchstone_norm {
  touchstone_linf = 0,  ///< the greatest of its components
  touchstone_l2 = 1     ///< Euclid's
};

/// An answer to "do they collide?".
enum touchstone_verdict {
  touchstone_no = 0,
  touchstone_yes = 1,
  touchstone_undecided = 2,  ///< no decision; treated as a conservative yes
  touchstone_error = 3       ///< the solver does not accept the query or the options
};

/// The common options of solvers. A solver ignores the options that do not apply to it.
struct touchstone_options {
  double tolerance;    ///< of tolerance-driven solvers, in units of the coordinates; default 1e-6
  int64_t max_checks;  ///< of iterative solvers: steps for a query; 0 or less: no limit
  double min_separation;  ///< distance that counts as contact, 0 or more
  double t_max;           ///< only impacts up to this time count, 0 to 1
  int32_t norm;           ///< one of touchstone_norm: of min_separation; since version 2
};

/// The answer, which the solver fills in. Initially the verdict is touchstone_error and every other
/// field NaN; the solver does not change fields for which it has no value. Times matter only with
/// touchstone_yes, and must then be finite or NaN.
struct touchstone_answer {
  int32_t verdict;   ///< one of touchstone_verdict
  double toi_lower;  ///< claimed: not above the exact time of first contact
  double toi_upper;  ///< claimed: not below the exact time of first contact
  double tolerance;  ///< with yes, in units of the coordinates: claims that at some time the
                     ///< distance, in the requested norm, is at most min_separation + tolerance. A
                     ///< yes beyond that is a fault.
};

/// Defined by the plugin: returns touchstone_interface_version.
int32_t touchstone_plugin_version(void);

/// Defined by the plugin: the solver's name in reports, one line of UTF-8 text without control
/// characters or invisible ones, that stays valid.
const char* touchstone_plugin_name(void);

/// Defined by the plugin: answers one query. Must be thread-safe.
///
/// All three functions, and the library's constructors, run in a child process whose memory and
/// file size are limited, and which may create threads but no processes (options of the command
/// line change both), in a temporary working directory. Its output is captured.
///
/// \param kind one of touchstone_kind.
/// \param coordinates 24 finite doubles: x, y, z of the four points at t=0, then of the same four
///        at t=1. Vertex-face: v, f0, f1, f2. Edge-edge: ea0, ea1, eb0, eb1.
/// \param options the user's options.
/// \param answer to be filled in.
void touchstone_plugin_solve(int32_t kind, const double* coordinates,
                             const struct touchstone_options* options,
                             struct touchstone_answer* answer);

#pragma GCC visibility pop
#ifdef __cplusplus
}
#endif
