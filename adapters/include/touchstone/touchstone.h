#pragma once

/// \file
/// Touchstone in C99: exact answers about pairs of moving primitives and about whole steps of a
/// mesh, for languages that call C (Rust, Julia, C#, Python …). The library is `touchstone_c`,
/// shared.
///
/// All points move on straight lines from t=0 to t=1. Coordinates are doubles, x, y, z of each
/// point in turn.
///
/// **Errors.** Functions that can fail return a TouchstoneStatus. If it is not TOUCHSTONE_OK,
/// touchstone_last_error() describes the error, and nothing else was written. A coordinate that is
/// NaN or infinite is TOUCHSTONE_NOT_FINITE; only touchstone_solve, whose results have a verdict,
/// answers TOUCHSTONE_ERROR for it and decides the others.
///
/// **Memory.** Arrays that a function of a step returns are valid until its next call with this
/// step that returns TOUCHSTONE_OK, or until the step is freed.
///
/// **Structures.** TouchstoneOptions, TouchstoneMesh and TouchstoneLineSearchOptions, which the
/// caller fills in, can grow at their ends, within one SOVERSION. They begin with their size in
/// bytes, as the caller's header has it: start from touchstone_default_options(),
/// touchstone_empty_mesh() or touchstone_default_line_search_options(), which set it. A newer
/// library takes the members beyond the caller's size as they are there. A size less than that of
/// the first version (0 was forgotten), or greater than the library knows, is
/// TOUCHSTONE_INVALID_ARGUMENT. All other structures, the results, keep their layout within one
/// SOVERSION. Members neither move nor change their meaning.
///
/// **Threads.** All functions are thread-safe, but of the functions that take a step without
/// `const`, only one at a time may use the same step.

#include <stddef.h>
#include <stdint.h>
#include <string.h>

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

// ---- Errors and options -------------------------------------------------------------------------

enum TouchstoneStatus {
  TOUCHSTONE_OK = 0,
  TOUCHSTONE_INVALID_ARGUMENT = 1,  ///< an invalid option, a null pointer
  TOUCHSTONE_OUT_OF_RANGE = 2,      ///< an index that is no vertex
  TOUCHSTONE_NOT_FINITE = 3,        ///< a coordinate, or the motion of one, is NaN or infinite
  TOUCHSTONE_TOO_MANY = 4,          ///< more than 2^31 − 1 elements, or than fit into memory
  TOUCHSTONE_FAILURE = 5            ///< any other reason: arithmetic that is not IEEE 754
};

typedef struct TouchstoneOptions {
  size_t size;            ///< bytes of this structure, sizeof(TouchstoneOptions)
  double min_separation;  ///< a distance up to this is contact; finite, 0 or more
  double t_max;           ///< only contacts up to this time count, in [0,1]
  double toi_tolerance;   ///< greatest relative width of times of impact; finite, 0 or more
  int32_t norm;           ///< one of TouchstoneNorm: of min_separation
  /// Maximum number of threads; 0: one for each core that the process may use.
  int32_t max_threads;
} TouchstoneOptions;

/// The version, such as "1.2.3".
TOUCHSTONE_API const char* touchstone_version(void);

/// The message of the last call of this thread that failed; valid until its next call.
TOUCHSTONE_API const char* touchstone_last_error(void);

/// The default options: 0, 1, 1e-12, TOUCHSTONE_L2, 0. (Here, so that the size is the caller's.)
static inline TouchstoneOptions touchstone_default_options(void) {
  const TouchstoneOptions options = {sizeof(TouchstoneOptions), 0.0, 1.0, 1e-12, TOUCHSTONE_L2, 0};
  return options;
}

// ---- Queries ------------------------------------------------------------------------------------

typedef struct TouchstoneImpact {
  int32_t verdict;   ///< TOUCHSTONE_NO, _YES or _ERROR: the truth
  double toi_lower;  ///< with yes: before the time of impact, or 0 if that is 0; else NaN, as all
                     ///< that follow
  double toi_upper;  ///< with yes: not before the time of impact
  double u;          ///< with yes: the place f0 + u (f1 − f0) + v (f2 − f0) on the face,
  double v;          ///< or u on the first edge and v on the second, from their first points
} TouchstoneImpact;

/// A distance, enclosed by doubles that are equal or neighbours.
typedef struct TouchstoneDistance {
  double lower;
  double upper;  ///< infinity for distances beyond the greatest double
} TouchstoneDistance;

/// Decides `count` queries. A query of which a coordinate that has an effect is NaN or
/// infinite has the verdict TOUCHSTONE_ERROR; the others are decided.
/// \param kind of all queries, one of contact
/// \param coordinates 24 for each query: its four points at t=0, then the same at t=1
/// \param options null for the default ones
/// \param impacts `count` of them, for the results
TOUCHSTONE_API int32_t touchstone_solve(int32_t kind, size_t count, const double* coordinates,
                                        const TouchstoneOptions* options,
                                        TouchstoneImpact* impacts);

/// The answer about a cell.
typedef struct TouchstoneInversion {
  int32_t verdict;   ///< TOUCHSTONE_YES: its volume is 0 or negative at some time
  int32_t start;     ///< the sign of its volume at t=0: 1, 0 (flat) or −1 (inverted)
  double toi_lower;  ///< with yes: before the first such time, or 0 if that is 0
  double toi_upper;  ///< with yes: not before that time
} TouchstoneInversion;

/// Decides whether `count` cells invert: at some time the volume, or the area in the plane, is 0 or
/// negative. A cell of which a coordinate that has an effect is NaN or infinite has the verdict
/// TOUCHSTONE_ERROR.
/// \param kind of all cells, one of these
/// \param coordinates as above
/// \param options null for the default ones; without a min_separation
/// \param inversions `count` of them, for the results
TOUCHSTONE_API int32_t touchstone_inversions(int32_t kind, size_t count, const double* coordinates,
                                             const TouchstoneOptions* options,
                                             TouchstoneInversion* inversions);

/// The distances of the primitives of `count` queries at the time t, in [0,1]. 0 iff they have a
/// common point.
/// \param kind and coordinates as in touchstone_solve; all finite, else the status is
/// TOUCHSTONE_NOT_FINITE
/// \param max_threads maximum number of threads; 0: one for each core that the process may use
/// \param distances `count` of them, for the results
TOUCHSTONE_API int32_t touchstone_distances(int32_t kind, size_t count, const double* coordinates,
                                            double t, int32_t norm, int32_t max_threads,
                                            TouchstoneDistance* distances);

// ---- Steps --------------------------------------------------------------------------------------

/// Cells of a mesh, whose volume, or area in the plane of x and y, is to stay positive.
typedef struct TouchstoneCells {
  int32_t kind;  ///< of all: TOUCHSTONE_TETRAHEDRON or TOUCHSTONE_PLANE_TRIANGLE
  size_t count;
  const int32_t* vertices;  ///< 4 or 3 for each
} TouchstoneCells;

/// A mesh before and after a step. Unused members are 0 (null pointers).
typedef struct TouchstoneMesh {
  size_t size;  ///< bytes of this structure, sizeof(TouchstoneMesh)
  size_t vertices;
  const double* before;          ///< 3 · vertices coordinates at t=0
  const double* after;           ///< the same at t=1
  size_t edges;                  ///< the number of edges; if 0, the edges are those of the faces
  const int32_t* edge_vertices;  ///< 2 · edges
  size_t faces;
  const int32_t* face_vertices;  ///< 3 · faces
  size_t points;                 ///< vertices that are part of the scene without an edge or a face
  const int32_t* point_vertices;
  const int32_t* groups;  ///< a group, from 0, for each vertex; or null: all can collide
  /// The number of pairs of groups that cannot collide, each the group of a vertex; a group twice:
  /// not within it.
  size_t apart;
  const int32_t* apart_groups;  ///< 2 · apart
  /// A rule for pairs of vertices, or null: two primitives can collide if it is not 0 for a vertex
  /// of one and a vertex of the other that are in groups that can collide. It must be symmetric.
  /// Called by functions of the step, in several threads at once, with can_collide_context.
  int32_t (*can_collide)(void* context, int32_t vertex, int32_t other);
  void* can_collide_context;
  /// The number of radii: 0, or one for each group. Primitives are in contact within the separation
  /// and the radii of their groups in sum; of several vertices' groups, the greatest sum counts. In
  /// TOUCHSTONE_L2 vertices then are spheres, and edges capsules.
  size_t radii;
  const double* group_radii;  ///< not negative
  /// The number of pairs of groups with a distance in place of the sum of their radii, each the
  /// group of a vertex.
  size_t separations;
  const int32_t* separated_groups;  ///< 2 · separations; each pair once, in either order
  const double* group_separations;  ///< these distances, not negative
  /// The number of lists of cells, which do not collide.
  size_t cell_lists;
  const TouchstoneCells* cells;
  /// With a degree, from 1 to 8, the vertices move on Bézier curves, and before and after are not
  /// read. Functions that need straight lines then fail: of distances, contacts and step sizes.
  int32_t degree;
  int32_t is_rational;  ///< not 0: control points have positive weights
  /// Those of each vertex from t=0 to t=1: (degree + 1) · vertices of 3 coordinates, or of 4
  /// numbers with the weight last.
  const double* control_points;
} TouchstoneMesh;

/// A mesh of which everything is 0 but the size.
static inline TouchstoneMesh touchstone_empty_mesh(void) {
  TouchstoneMesh mesh;
  memset(&mesh, 0, sizeof(mesh));
  mesh.size = sizeof(mesh);
  return mesh;
}

/// A step of a mesh, made by touchstone_step_new.
typedef struct TouchstoneStep TouchstoneStep;

/// Two primitives of a mesh.
typedef struct TouchstonePair {
  int32_t kind;    ///< one of TouchstoneKind
  int32_t first;   ///< number of a vertex or an edge
  int32_t second;  ///< number of a face, an edge or a vertex
} TouchstonePair;

/// Two primitives in contact.
typedef struct TouchstoneCollision {
  TouchstonePair pair;
  double toi_lower;  ///< as in TouchstoneImpact
  double toi_upper;
  double u;
  double v;
} TouchstoneCollision;

/// A cell of a mesh that inverts.
typedef struct TouchstoneStepInversion {
  int32_t kind;      ///< as in TouchstoneCells
  int32_t cell;      ///< its number among those of its kind
  int32_t start;     ///< the sign of its volume at t=0: 1, 0 (flat) or −1 (inverted)
  double toi_lower;  ///< before the first time at which it is 0 or negative, or 0 if that is 0
  double toi_upper;  ///< not before that time
} TouchstoneStepInversion;

/// A new step of a mesh, to be freed by touchstone_step_free. Everything is copied; the context of
/// a rule must outlive the step.
/// \param options null for the default ones
TOUCHSTONE_API int32_t touchstone_step_new(const TouchstoneMesh* mesh,
                                           const TouchstoneOptions* options, TouchstoneStep** step);

/// \param step may be null
TOUCHSTONE_API void touchstone_step_free(TouchstoneStep* step);

/// Writes 1 if the step is free, of collisions and inversions, else 0.
TOUCHSTONE_API int32_t touchstone_step_is_free(const TouchstoneStep* step, int32_t* is_free);

/// The earliest impact, with the smallest toi_lower and toi_upper of all pairs and cells;
/// verdict TOUCHSTONE_NO and NaN if the step is free. u and v are NaN.
TOUCHSTONE_API int32_t touchstone_step_earliest(const TouchstoneStep* step,
                                                TouchstoneImpact* impact);

/// All pairs in contact.
TOUCHSTONE_API int32_t touchstone_step_collisions(TouchstoneStep* step,
                                                  const TouchstoneCollision** collisions,
                                                  size_t* count);

/// All cells that invert, tetrahedra first, in the order of their numbers.
TOUCHSTONE_API int32_t touchstone_step_inversions(TouchstoneStep* step,
                                                  const TouchstoneStepInversion** inversions,
                                                  size_t* count);

/// A maximal step size, up to the step's t_max: the step from x0 to fl(x0 + fl(alpha fl(x1 − x0)))
/// is free and, unless alpha is t_max, that of the next double is not. Because of rounding, the
/// step of a larger alpha may be free too, and that of a smaller one may not. Writes −1 if not even
/// a step of size 0 is free. TOUCHSTONE_NOT_FINITE if x1 − x0 of a coordinate is greater than any
/// double; the message names the vertex.
TOUCHSTONE_API int32_t touchstone_step_free_step_size(const TouchstoneStep* step, double* alpha);

/// The least distance of all pairs of the step at the time t, in [0,1], and all pairs with this
/// enclosure; with radii, of thick primitives, and all pairs whose enclosures overlap it. Infinity
/// and no pairs if the step has none. The separation of the step has no effect.
TOUCHSTONE_API int32_t touchstone_step_least_distance(TouchstoneStep* step, double t, int32_t norm,
                                                      TouchstoneDistance* distance,
                                                      const TouchstonePair** pairs, size_t* count);

// ---- Contacts -----------------------------------------------------------------------------------

/// Two primitives that touch, or come within a distance, with the place of contact at the time of
/// impact. The head of touchstone/contacts.hpp says what is exact, and the rule for contact that is
/// degenerate.
typedef struct TouchstoneActiveContact {
  TouchstoneCollision collision;  ///< u and v are those of the points
  double first[3];                ///< the contact point on the first primitive
  double second[3];               ///< and on the second
  double normal[3];               ///< a unit vector, from the second primitive to the first
  double point_error;   ///< the greatest distance of both points from the exact ones, in L2
  double normal_error;  ///< of the normal from the exact one; infinity: there is none, or no bound
  int32_t has_side;     ///< 1: it points to the side that the first primitive comes from; 0: that
                        ///< side is not proved, and the opposite vector may be the normal
} TouchstoneActiveContact;

/// The contacts of `count` collisions of this step, as from touchstone_step_collisions.
/// \param contacts `count` of them, for the results
TOUCHSTONE_API int32_t touchstone_step_contacts(const TouchstoneStep* step,
                                                const TouchstoneCollision* collisions, size_t count,
                                                TouchstoneActiveContact* contacts);

/// Every pair that comes within `eta`, and the radii, up to the step's t_max, exactly these, in the
/// order of their times. The separation of the step has no effect.
/// \param eta η, finite, 0 or more
TOUCHSTONE_API int32_t touchstone_step_active_set(TouchstoneStep* step, double eta, int32_t norm,
                                                  const TouchstoneActiveContact** contacts,
                                                  size_t* count);

// ---- Line searches ------------------------------------------------------------------------------

/// The reference distance at the start of a line search.
enum TouchstoneStartDistance {
  TOUCHSTONE_OF_SCENE = 0,  ///< the least distance of the scene
  TOUCHSTONE_OF_PAIR = 1    ///< of each pair its own, for pairs whose swept boxes meet
};

/// The reason for a step size.
enum TouchstoneLimitReason {
  TOUCHSTONE_WHOLE = 0,       ///< the whole step is allowed
  TOUCHSTONE_LIMITED = 1,     ///< a pair or a cell limits the step
  TOUCHSTONE_IN_CONTACT = 2,  ///< a pair is in contact at the start; the step size is 0
  TOUCHSTONE_TOO_SMALL = 3,   ///< the step size would be below the least doubles; it is 0
  TOUCHSTONE_INVERTED = 4     ///< a cell is flat or inverted at the start; the step size is 0
};

typedef struct TouchstoneLineSearchOptions {
  size_t size;             ///< bytes of this structure, sizeof(TouchstoneLineSearchOptions)
  int32_t norm;            ///< one of TouchstoneNorm
  int32_t start_distance;  ///< one of TouchstoneStartDistance
  double kept_volume;      ///< the part of its volume at t=0 of which a cell keeps more, in [0,1)
} TouchstoneLineSearchOptions;

typedef struct TouchstoneLineSearchLimit {
  int32_t reason;               ///< one of TouchstoneLimitReason
  double step_size;             ///< in [0, t_max] of the step
  TouchstoneDistance distance;  ///< the least distance at the start; infinity if there are no pairs
  const TouchstoneCollision* pairs;           ///< the pairs that limit the step
  size_t count;                               ///< the number of pairs
  const TouchstoneStepInversion* inversions;  ///< the cells that limit the step
  size_t inversion_count;                     ///< the number of cells
} TouchstoneLineSearchLimit;

/// The default options: TOUCHSTONE_L2, TOUCHSTONE_OF_SCENE, 0.
static inline TouchstoneLineSearchOptions touchstone_default_line_search_options(void) {
  const TouchstoneLineSearchOptions options = {sizeof(TouchstoneLineSearchOptions), TOUCHSTONE_L2,
                                               TOUCHSTONE_OF_SCENE, 0.0};
  return options;
}

/// The greatest step size, rounded down by at most the step's toi_tolerance, up to which all
/// primitives, with radii thick ones, stay at least p times as far apart as at the start, and all
/// cells keep their volumes. The separation of the step has no effect.
/// \param p more than 0 and at most 1 − 2^-50
/// \param options null for the default ones
TOUCHSTONE_API int32_t touchstone_step_line_search_limit(TouchstoneStep* step, double p,
                                                         const TouchstoneLineSearchOptions* options,
                                                         TouchstoneLineSearchLimit* limit);

#ifdef __cplusplus
}
#endif
