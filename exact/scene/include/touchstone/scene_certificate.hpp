#pragma once

/// \file
/// Certificates of scenes, for touchstone-check: a step has no contact up to a time, or its
/// earliest contact is between two neighbouring doubles; and the elements of a mesh at rest that
/// intersect are these and no others (exact/CERTIFICATES.md, "Steps" and "Meshes at rest").
///
/// \code{.cpp}
/// // The proof that a step is free.
/// #include <touchstone/scene_certificate.hpp>
///
/// #include <cstdio>
///
/// using namespace touchstone;
///
/// int main() {
///   // A triangle comes near another one.
///   const Eigen::MatrixX3d before{{0, 0, 0}, {4, 0, 0}, {0, 4, 0},
///                                 {1, 1, 3}, {2, 1, 4}, {1, 2, 4}};
///   Eigen::MatrixX3d after = before;
///   after.bottomRows<3>().col(2).array() -= 2;
///   const fast::Step step(before, after, {.faces = {{0, 1, 2}, {3, 4, 5}}});
///
///   const exact::SceneProof proof = exact::prove_step(step, {.label = "one above another"});
///   if (!proof.is_complete()) return 1;
///   std::printf("%s\n", proof.claim.c_str());  // proof.stream is the file for touchstone-check
/// }
/// // no_contact 1
/// \endcode
///
/// **A step.** The checker needs an argument for each pair that no axis separates until the time
/// that is claimed. Most have a direction of small integers, the others the subintervals of the
/// oracle. It verifies the volumes of all elements, and needs subintervals only for those that are
/// nearly flat.
///
/// **A mesh at rest.** A pair that intersects has a point of both elements, by its weights in each:
/// an extreme point of the rational intersection. Any other pair that the checker asks for has a
/// plane. If the elements share an edge, it is mostly the plane of one of them, otherwise one with
/// a normal of small integers between them. Where there is none, its normal is exact: let G be the
/// differences that the normal must have on one side; it is the sum of the extreme rays of the cone
/// of all d with d·g ≥ 0 for all g of G, which is inside the cone if that has an inside. The
/// numbers of elements, the pairs that need an argument, and whether one is accepted, are asked of
/// the checker's own functions: what it refuses is never written.
///
/// The search for pairs and impacts is that of touchstone::fast, the proof that of the oracle; the
/// checker believes neither. The text is the same for any number of threads.

#include <Eigen/Core>

#include <atomic>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>

#include "touchstone/certificate.hpp"
#include "touchstone/intersections.hpp"
#include "touchstone/step.hpp"

namespace touchstone::exact {

/// The limits of the checker: items of all lists of a scene, and pairs with an argument.
inline constexpr std::size_t scene_item_limit = std::size_t{1} << 22U;
inline constexpr std::size_t scene_argument_limit = std::size_t{1} << 24U;

/// The first line of a stream of certificates of steps.
[[nodiscard]] std::string_view step_certificates_header();
/// The last line of a stream with this number of certificates. A stream without it is incomplete.
[[nodiscard]] std::string step_certificates_closing_line(std::uint64_t steps);

/// The same of meshes.
[[nodiscard]] std::string_view mesh_certificates_header();
[[nodiscard]] std::string mesh_certificates_closing_line(std::uint64_t meshes);

struct SceneProofOptions {
  /// A line of text, which the certificate has in the form of label_text().
  std::string label = {};
  /// The maximum number of threads; 0 (all_cores): one for each core that the process may use.
  int max_threads = all_cores;
  /// Called with the certificate's lines in order, never from two threads at once. Without it,
  /// SceneProof::stream has them.
  std::function<void(std::string_view)> on_text = nullptr;
  /// Called occasionally with the completed fraction, never from two threads at once.
  std::function<void(double)> on_progress = nullptr;
  /// Once true, the certificate ends there and is invalid. May be null.
  const std::atomic<bool>* stop = nullptr;
};

struct SceneProof {
  /// The claim, as in the certificate: "no_contact T" or "earliest LO HI" of a step; "intersections
  /// N" or "welded_intersections N" of a mesh at rest.
  std::string claim = {};
  /// What two primitives do in a contact, or two elements, as the checker says it: "touch", "come
  /// within D (NORM)", "intersect".
  std::string contact = {};
  /// What of the scene is left out, which weakens the claim, as the checker says it: "1 pair of
  /// groups held apart"; empty if nothing is.
  std::string rules = {};
  std::uint64_t directions = 0;    ///< pairs with a direction or a plane
  std::uint64_t certificates = 0;  ///< pairs and elements of a step with subintervals
  std::uint64_t bytes = 0;         ///< of the certificate
  /// The reason for a missing proof; empty if there is one.
  std::string failure = {};
  bool interrupted = false;
  /// A whole stream with this certificate, if the proof is complete and there is no on_text.
  std::string stream = {};

  [[nodiscard]] bool is_complete() const { return failure.empty() && !interrupted; }
};

/// Proves that the step is free up to its t_max, or the time of its earliest contact or inversion.
/// The certificate has the edges of the step in the order of edges_of (touchstone/broad_phase.hpp),
/// and an edge from a vertex to itself as a point; the claim is about the scene as it is listed.
/// \throws std::invalid_argument if the step has a rule `can_collide`: certificates know groups
/// alone. \throws Stopped as the step; the exceptions of on_text.
[[nodiscard]] SceneProof prove_step(const fast::Step& step, const SceneProofOptions& options = {});

/// Proves which elements of a mesh at rest intersect.
/// \param vertices the mesh is that at t=0
/// \param mesh, search as of fast::intersections; all pairs are asked for, without their places
/// \throws std::invalid_argument for a rule `can_collide`; as fast::intersections; the exceptions
/// of on_text.
[[nodiscard]] SceneProof prove_mesh(const fast::Motion& vertices, const fast::Mesh& mesh,
                                    const fast::IntersectionOptions& search = {},
                                    const SceneProofOptions& options = {});

/// The same for a matrix of float or double, n×3, in any storage order.
template <class Derived>
[[nodiscard]] SceneProof prove_mesh(const Eigen::MatrixBase<Derived>& vertices,
                                    const fast::Mesh& mesh,
                                    const fast::IntersectionOptions& search = {},
                                    const SceneProofOptions& options = {}) {
  return prove_mesh(fast::Motion(vertices, vertices), mesh, search, options);
}

}  // namespace touchstone::exact
