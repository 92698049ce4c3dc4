#pragma once

/// \file
/// The stages of the certified solver that run in floating point, for blocks of queries, one
/// implementation for each instruction set. (The algorithm: kernel_on_lanes.hpp.)

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

#include "fast/certified/fixed_point_vertices.hpp"
#include "fast/platform/instruction_set.hpp"
#include "touchstone/mesh.hpp"
#include "touchstone/query.hpp"

namespace touchstone::fast {

/// The maximum number of queries in a block: small enough that they stay in the cache between
/// stages.
inline constexpr std::size_t kernel_block = 1024;

/// A block of queries: from an array, or from pairs of indices.
struct KernelInput {
  Kind kind = Kind::vertex_face;
  std::size_t count = 0;  ///< at most kernel_block
  /// The first query of the block, for an array.
  const Query* queries = nullptr;
  /// All vertices, all edges or faces, and the first pair of the block, for pairs.
  const MovingVertex* vertices = nullptr;
  const Edge* edges = nullptr;
  const Face* faces = nullptr;
  const IndexPair* pairs = nullptr;
  /// A block of elements (CertifiedKernel::invert) is one of queries or, with vertices, of
  /// tetrahedra or faces, which are triangles in the plane. Here its first ones.
  const std::array<std::int32_t, 4>* tetrahedra = nullptr;
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
  /// Elements invert when no more than this part of their volume at t=0 is left, in [0,1).
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

/// The results of a block. Queries that are in no list are separated on an axis, or have no contact
/// up to t_limit in single precision.
struct KernelOutput {
  template <class T>
  struct List {
    std::size_t count = 0;
    std::array<T, kernel_block> items;
  };
  List<std::uint32_t> separated_in_direction;
  List<std::uint32_t> one_sided;  ///< the determinant keeps its sign
  List<std::uint32_t> rejected;   ///< by bisection, no contact up to t_limit
  List<KernelImpact> impacts;
  List<std::uint32_t> undecided;  ///< for the exact stage
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

/// A function that decides a block of queries or elements.
using KernelFunction = void(const KernelInput& input, KernelOutput& output);

/// The functions on curves of one instruction set (fast/certified/curves/stages.hpp).
struct CurvedKernel {
  InstructionSet instructions;
  /// Lists the queries that no axis separates.
  void (*axis)(const curved::Block& block, KernelOutput::List<std::uint32_t>& open);
  /// Decides the queries of a list, with control polygons of one form; appends to the output.
  void (*search)(const curved::Block& block, const KernelOutput::List<std::uint32_t>& queries,
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
  /// Inversions of elements (fast/certified/stages/inversion.hpp). Elements that are in no list,
  /// and the rejected ones, do not invert up to t_limit; those in `one_sided` are inverted at t=0;
  /// impacts are the first times of those with a positive volume at t=0.
  KernelFunction* invert;
  const CurvedKernel* curves;
  /// a b + c on its lanes: certified_kernels() uses it, and that of the curves, to check that
  /// products are rounded before they are added.
  double (*product_then_sum)(double a, double b, double c);
};

/// The kernels that this processor can run, slowest first; scalar is always among them.
/// \throws std::runtime_error if one was compiled so that products are contracted.
[[nodiscard]] std::span<const CertifiedKernel* const> certified_kernels();

}  // namespace touchstone::fast
