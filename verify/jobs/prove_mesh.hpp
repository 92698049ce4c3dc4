#pragma once

/// \file
/// The certificate of a mesh at rest: the pairs of its elements that intersect, and no others
/// (exact/CERTIFICATES.md, "Meshes at rest").
///
/// A pair that intersects has a point of both elements, by its weights in each: an extreme point of
/// the rational intersection. Any other pair that the checker asks for has a plane. If the elements
/// share an edge, it is mostly the plane of one of them, otherwise one with a normal of small
/// integers between them. Where there is none, its normal is exact: let G be the differences that
/// the normal must have on one side; it is the sum of the extreme rays of the cone of all d with
/// d·g ≥ 0 for all g of G, which is inside the cone if that has an inside.
///
/// The numbers of elements, the pairs that need an argument, and whether one is accepted, are asked
/// of the checker's own functions: what it refuses is never written.

#include <cstdint>
#include <span>
#include <string>
#include <string_view>

#include "touchstone/intersections.hpp"
#include "verify/jobs/prove_step.hpp"
#include "verify/mesh/mesh_file.hpp"

namespace touchstone::verify::jobs {

/// The first line of a stream of certificates of meshes, and the last line of one with one
/// certificate.
inline constexpr std::string_view mesh_certificates_header = "touchstone-meshes 1\n";
inline constexpr std::string_view mesh_certificates_closing_line = "meshes 1\n";

struct MeshProof {
  std::uint64_t arguments = 0;  ///< pairs proved not to intersect
  std::uint64_t bytes = 0;
  /// The reason for a missing proof; empty if there is one.
  std::string failure = {};
  bool interrupted = false;

  [[nodiscard]] bool is_complete() const { return failure.empty() && !interrupted; }
};

/// Proves which elements intersect.
/// \param search the groups and `weld` of the search, which has no rule `can_collide`
/// \param found its result: all intersections
/// \param options as for a step
/// \throws the exceptions of on_text.
[[nodiscard]] MeshProof prove_mesh(const mesh::Mesh& mesh, const fast::IntersectionOptions& search,
                                   std::span<const fast::Intersection> found,
                                   const StepProofOptions& options);

}  // namespace touchstone::verify::jobs
