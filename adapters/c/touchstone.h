#pragma once

/// \file
/// Touchstone in C99: exact answers about pairs of moving primitives and about whole steps of a
/// mesh, for languages that call C (Rust, Julia, C#, Python …). The library is `touchstone_c`,
/// shared.
///
/// All points move on straight lines from t=0 to t=1. Coordinates are doubles, x, y, z of each
/// point in turn. Functions that can fail return 0, or 2 for bad input: then
/// touchstone_last_error() describes the error, and nothing else was written. All functions may be
/// called from several threads at once, except touchstone_step_collisions of one step.

#include <stddef.h>
#include <stdint.h>

#ifdef __cplusplus
extern "C" {
#endif
#if defined(__GNUC__)
#define TOUCHSTONE_API __attribute__((visibility("default")))
#else
#define TOUCHSTONE_API
#endif

/// The primitives of a pair. Their points, in the order of a query:
enum {
  TOUCHSTONE_VERTEX_FACE = 0,  ///< v, f0, f1, f2; of a mesh: a vertex and a face
  TOUCHSTONE_EDGE_EDGE = 1,  ///< ea0, ea1, eb0, eb1; of a mesh: two edges, the smaller number first
  TOUCHSTONE_VERTEX_EDGE = 2,  ///< of a mesh only: a codimensional point and a codimensional edge
  TOUCHSTONE_VERTEX_VERTEX =
      3  ///< of a mesh only: two codimensional points, the smaller number first
};

/// Norm of the distance of two points.
enum {
  TOUCHSTONE_LINF = 0,  ///< the greatest of its components
  TOUCHSTONE_L2 = 1     ///< Euclid's
};

/// An answer to the question of contact, which is the truth.
enum {
  TOUCHSTONE_NO = 0,
  TOUCHSTONE_YES = 1,
  TOUCHSTONE_ERROR = 3  ///< a coordinate is NaN or infinite
};

typedef struct TouchstoneOptions {
  double min_separation;  ///< a distance up to this is contact; finite, 0 or more
  double t_max;           ///< only contacts up to this time count, in [0,1]
  double toi_tolerance;   ///< greatest relative width of times of impact; finite, 0 or more
  int32_t norm;           ///< TOUCHSTONE_LINF or TOUCHSTONE_L2: of min_separation
  int32_t max_threads;    ///< 0: the number of cores
} TouchstoneOptions;

typedef struct TouchstoneImpact {
  int32_t verdict;   ///< TOUCHSTONE_NO, _YES or _ERROR
  double toi_lower;  ///< with yes: before the time of impact, or 0 if that is 0; else NaN, as all
                     ///< that follow
  double toi_upper;  ///< with yes: not before the time of impact
  double u;          ///< with yes: the place f0 + u (f1 − f0) + v (f2 − f0) on the face,
  double v;          ///< or u on the first edge and v on the second, from their first points
} TouchstoneImpact;

/// Two primitives of a mesh in contact.
typedef struct TouchstoneCollision {
  int32_t kind;      ///< TOUCHSTONE_VERTEX_FACE and so on
  int32_t first;     ///< number of a vertex or an edge
  int32_t second;    ///< number of a face, an edge or a vertex
  double toi_lower;  ///< as in TouchstoneImpact
  double toi_upper;
  double u;
  double v;
} TouchstoneCollision;

/// A mesh before and after a step. Unused members are 0 (null pointers).
typedef struct TouchstoneMesh {
  size_t vertices;
  const double* before;          ///< 3 · vertices coordinates at t=0
  const double* after;           ///< the same at t=1
  size_t edges;                  ///< the number of edges; if 0, the edges are those of the faces
  const int32_t* edge_vertices;  ///< 2 · edges
  size_t faces;
  const int32_t* face_vertices;  ///< 3 · faces
  size_t points;                 ///< vertices that are part of the scene without an edge or a face
  const int32_t* point_vertices;
  const int32_t* groups;  ///< a group, from 0, for each vertex; or null: all may meet
  size_t apart;  ///< the number of pairs of groups that do not meet; a group twice does not meet
                 ///< itself
  const int32_t* apart_groups;  ///< 2 · apart
} TouchstoneMesh;

/// A step of a mesh, made by touchstone_step_new.
typedef struct TouchstoneStep TouchstoneStep;

/// The version, such as "1.2.3".
TOUCHSTONE_API const char* touchstone_version(void);

/// The message of the last call of this thread that returned 2 (or null); valid until its next
/// call.
TOUCHSTONE_API const char* touchstone_last_error(void);

/// The default options: 0, 1, 1e-12, TOUCHSTONE_LINF, 0.
TOUCHSTONE_API TouchstoneOptions touchstone_default_options(void);

/// Decides `count` queries of one kind, vertex-face or edge-edge.
/// \param coordinates 24 for each query: its four points at t=0, then the same at t=1
/// \param options null for the default ones
/// \param impacts `count` of them, for the results
TOUCHSTONE_API int32_t touchstone_solve(int32_t kind, size_t count, const double* coordinates,
                                        const TouchstoneOptions* options,
                                        TouchstoneImpact* impacts);

/// A step of a mesh; null for bad input. Everything is copied.
/// \param options null for the default ones
TOUCHSTONE_API TouchstoneStep* touchstone_step_new(const TouchstoneMesh* mesh,
                                                   const TouchstoneOptions* options);

/// \param step may be null
TOUCHSTONE_API void touchstone_step_free(TouchstoneStep* step);

/// Writes 1 if the step is free, else 0.
TOUCHSTONE_API int32_t touchstone_step_is_free(const TouchstoneStep* step, int32_t* is_free);

/// The earliest impact, with the smallest toi_lower and toi_upper of all pairs; verdict
/// TOUCHSTONE_NO and NaN if the step is free. u and v are NaN.
TOUCHSTONE_API int32_t touchstone_step_earliest(const TouchstoneStep* step,
                                                TouchstoneImpact* impact);

/// All pairs in contact. They are valid until the next call of this function that returns 0 with
/// this step, or until its end.
TOUCHSTONE_API int32_t touchstone_step_collisions(TouchstoneStep* step,
                                                  const TouchstoneCollision** collisions,
                                                  size_t* count);

/// The largest step size: the step from x0 to fl(x0 + alpha (x1 − x0)) is free, and that of the
/// next double is not. Writes −1 if not even a step of size 0 is free. Status 2 if x1 − x0 of a
/// coordinate is greater than any double; the message names the vertex.
TOUCHSTONE_API int32_t touchstone_step_free_step_size(const TouchstoneStep* step, double* alpha);

#ifdef __cplusplus
}
#endif
