#pragma once

/// \file
/// The stages of the certified solver that run in floating point, for blocks of queries or of
/// cells, one implementation for each instruction set. (The algorithms: kernel_on_lanes.hpp,
/// fast/cells/stages.hpp.)

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "fast/certified/fixed_point_vertices.hpp"
#include "fast/platform/instruction_set.hpp"
#include "touchstone/cell.hpp"
#include "touchstone/mesh.hpp"
#include "touchstone/query.hpp"

namespace touchstone::fast {

/// The maximum number of queries in a block: small enough that they stay in the cache between
/// stages.
inline constexpr std::size_t kernel_block = 1024;

/// A block of queries: from an array, or from pairs of indices.
struct KernelInput {
  ContactKind kind = ContactKind::vertex_face;
  std::size_t count = 0;  ///< at most kernel_block
  /// The first query of the block, for an array.
  const Query* queries = nullptr;
  /// All vertices, all edges or faces, and the first pair of the block, for pairs.
  const MovingVertex* vertices = nullptr;
  const Edge* edges = nullptr;
  const Face* faces = nullptr;
  const IndexPair* pairs = nullptr;
  /// True if coordinates are known to be finite and few queries are separated on an axis. Then the
  /// first stage is omitted.
  bool axis_is_done = false;
  /// All vertices of pairs in fixed point, on an interval [0, t], or null. With them, queries
  /// without a contact up to t may be decided in single precision.
  const FixedPointVertex* rounded = nullptr;
  float rounded_distance = 0.0F;  ///< of FixedPointVertices
  /// The distance at which primitives are in contact.
  Separation separation = {};
  /// The CertifiedOptions::toi_tolerance, at least least_kernel_tolerance.
  double toi_tolerance = 1e-12;
  /// Contacts after this time may or may not be found.
  double t_limit = 1.0;
};

/// A block of cells: from an array, or of a mesh.
struct CellInput {
  CellKind kind = CellKind::tetrahedron;
  std::size_t count = 0;  ///< at most kernel_block
  /// The first cell of the block, for an array.
  const Query* queries = nullptr;
  /// All vertices, and the vertices of the first cell of the block, for a mesh.
  const MovingVertex* vertices = nullptr;
  const std::int32_t* corners = nullptr;
  /// As in KernelInput.
  double toi_tolerance = 1e-12;
  double t_limit = 1.0;
  /// Cells invert when no more than this part of their volume at t=0 is left, in [0,1).
  double kept_volume = 0.0;
};

/// The least tolerance for which the rounding of the enclosure's ends is negligible.
inline constexpr double least_kernel_tolerance = 0x1p-48;

/// A collision: there is no contact up to toi_lower, and one up to toi_upper; or both are 0 and the
/// toi is 0.
struct KernelImpact {
  std::uint32_t index;  ///< in the block
  double toi_lower;
  double toi_upper;
  double u;
  double v;
};

/// The first time of a cell: its volume is positive up to toi_lower, and not so up to toi_upper.
struct KernelInversion {
  std::uint32_t index;  ///< in the block
  double toi_lower;
  double toi_upper;
};

/// Items of a block.
template <class T>
struct KernelList {
  std::size_t count = 0;
  std::array<T, kernel_block> items;
};

/// The results of a block. Queries that are in no list are separated on an axis, or have no contact
/// up to t_limit in single precision.
struct KernelOutput {
  KernelList<std::uint32_t> separated_in_direction;
  KernelList<std::uint32_t> one_sided;  ///< the determinant keeps its sign
  KernelList<std::uint32_t> rejected;   ///< by bisection, no contact up to t_limit
  KernelList<KernelImpact> impacts;
  KernelList<std::uint32_t> undecided;  ///< for the exact stage
};

/// The results of a block of cells. Those in no list keep their volume up to t_limit.
struct CellOutput {
  KernelList<std::uint32_t> inverted;      ///< at t=0
  KernelList<KernelInversion> inversions;  ///< of cells with a positive volume at t=0
  KernelList<std::uint32_t> undecided;     ///< for integers
};

namespace curved {

/// The greatest degree of a control polygon.
inline constexpr std::size_t greatest_corner_degree = greatest_degree;

/// The form of the control polygons of queries. With more than one denominator,
/// 2 · degree ≤ greatest_corner_degree.
enum class Denominators : std::uint8_t {
  one,   ///< the weights of all points are equal, or there are none
  two,   ///< those of each primitive are
  four,  ///< each point has its own; for distance 0
};
inline constexpr std::size_t denominators_count = 3;

/// A block of queries on curves, at most kernel_block. The rest is as in KernelInput.
struct Block : Queries {
  Separation separation = {};
  double toi_tolerance = 1e-12;
  double t_limit = 1.0;
};

}  // namespace curved

/// A function that decides a block of queries, or of cells.
using KernelFunction = void(const KernelInput& input, KernelOutput& output);
using CellFunction = void(const CellInput& input, CellOutput& output);

/// The functions on curves of one instruction set (fast/certified/curves/stages.hpp).
struct CurvedKernel {
  InstructionSet instructions;
  /// Lists the queries that no axis separates.
  void (*axis)(const curved::Block& block, KernelList<std::uint32_t>& open);
  /// Decides the queries of a list, with control polygons of one form; appends to the output.
  void (*search)(const curved::Block& block, const KernelList<std::uint32_t>& queries,
                 curved::Denominators denominators, KernelOutput& output);
  double (*product_then_sum)(double a, double b, double c);
};

// One definition a file, each compiled for its instruction set (curves/kernel_*.cpp).
extern const CurvedKernel scalar_curved_kernel, avx2_curved_kernel, avx512_curved_kernel,
    neon_curved_kernel;

/// The functions of one instruction set. All sets make the same decisions.
struct CertifiedKernel {
  InstructionSet instructions;
  KernelFunction* decide;
  CellFunction* invert;
  const CurvedKernel* curves;
  /// a b + c on its lanes: certified_kernels() uses it, and that of the curves, to check that
  /// products are rounded before they are added.
  double (*product_then_sum)(double a, double b, double c);
};

/// The kernels that this processor can run, slowest first; scalar is always among them.
/// \throws std::runtime_error if one was compiled so that products are contracted.
[[nodiscard]] std::span<const CertifiedKernel* const> certified_kernels();

}  // namespace touchstone::fast
