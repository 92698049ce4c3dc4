#pragma once

/// \file
/// The checker: believes a certificate only if it proves its claim.
///
/// It shares nothing with the rest of the project and needs only the standard library and GMP. Read
/// it in this order: certificate.hpp/.cpp parse (the format is exact/CERTIFICATES.md),
/// proof.hpp/.cpp have the mathematics, checker.cpp counts. For certificates of whole steps,
/// places.hpp/.cpp find the pairs that need an argument, and step.hpp/.cpp verify these.
///
/// Four points move on straight lines or on curves, polynomial or rational in t with positive
/// denominators. The *corners* are
///
///     vertex_face:  w = v−f0, v−f1, v−f2
///     edge_edge:    w = ea0−eb0, ea1−eb0, ea1−eb1, ea0−eb1     (a parallelogram, in cyclic order)
///
/// and the primitives touch at time t iff 0 ∈ conv{w_i(t)}. A certificate may name a distance D ≥ 0
/// and a norm, l2 or linf: then t is a *contact* iff ‖x‖ ≤ D for some x ∈ conv{w_i(t)}; else D = 0.
/// The *time of impact* (toi) is the least contact in [0,1]. ‖d‖* is |d| for l2, |d_x|+|d_y|+|d_z|
/// for linf. A *tetrahedron* a, b, c, d has the corners a−b, a−c, a−d and the volume V, 6V =
/// det(b−a,c−a,d−a) = −det(w_0,w_1,w_2); its contacts are the times with V ≤ 0.
///
/// **Theorem.** Each of these is a proof.
///   - *Separation* on [a,b]: a direction d(t) with d(t)·w_i(t) > D‖d(t)‖* for all i and all
///     t ∈ [a,b]. Then no t ∈ [a,b] is a contact: if x = Σ α_i w_i with α_i ≥ 0, Σ α_i = 1, then
///     ‖d‖*‖x‖ ≥ d·x = Σ α_i (d·w_i) > D‖d‖*.
///   - *Triangle* i, j, k at t, for one axis: det(w_i,w_j,w_k) = 0, and the three weights
///     (w_j×w_k)_axis, (w_k×w_i)_axis, (w_i×w_j)_axis are all ≥ 0 or all ≤ 0, and their sum is not
///     0. Then t is a contact, since
///     (w_j×w_k)_axis w_i + (w_k×w_i)_axis w_j + (w_i×w_j)_axis w_k = det(w_i,w_j,w_k) e_axis = 0
///     (Cramer's rule): 0 is a convex combination of the three corners.
///   - *Segment* i, j at t: w_i×w_j = 0 and w_i·w_j ≤ 0. Then t is a contact: either one of the two
///     is 0, or they point in opposite directions and |w_j| w_i + |w_i| w_j = 0.
///   - *Vertex* i, *edge* i, j, *face*: |w_i| ≤ D; or e = w_j−w_i ≠ 0, w_i·e ≤ 0 ≤ w_j·e and
///     |w_i×w_j| ≤ D|e|; or N ≠ 0, N·(w_i×w_j) ≥ 0 for all sides in cyclic order and |N·w_0| ≤ D|N|.
///     Then t is a contact in either norm: the corner, or the foot of the perpendicular from 0 on
///     the edge's line or the face's plane, is in the hull and within D by |·|, hence by linf.
///   - *Axes*, linf: for each coordinate axis, N, and each product of a coordinate axis and a side
///     as a, some corner has a·w ≤ D‖a‖* and some −a·w ≤ D‖a‖*. Then t is a contact: were there
///     none, a facet's normal of the polytope cube ⊕ −conv{w_i} would be an axis for which one
///     fails.
///   - *Volume*: 6V > 0 on [a,b], or 6V ≤ 0 at t, of a tetrahedron.
///   - *Root*: if a polynomial g has strictly opposite signs at LO < HI, it has a root t ∈ (LO,HI).
///     A polynomial that g divides is 0 at t; one that has a strict sign on [LO,HI] has it at t.
/// So: separations of subintervals that cover [0,1] prove `no_collision`; a contact in [0,1] proves
/// `collision`; separations that cover [0,LO] and a contact in [LO,HI] prove LO < toi ≤ HI; a
/// contact at 0 proves toi = 0.

#include <cstddef>
#include <cstdint>
#include <istream>
#include <string>
#include <string_view>
#include <vector>

namespace touchstone::checker {

struct Options {
  /// Number of rejections that are kept with their reason; all are counted.
  std::size_t max_rejections = 100;
  /// The scenes that certificates of steps or of meshes must have, in order, without labels; null:
  /// any.
  std::istream* scenes = nullptr;
  /// The claim that every certificate must make, as `demanded_claim` writes it; empty: any.
  std::string claim = {};
  /// The separation of the claim, as `demanded_separation` writes it; empty: any.
  std::string separation = {};
  /// The rules of the scene, in the words of the report. Empty: any; but none if the claim is
  /// `free` or `sequence` and no scenes are given.
  std::string rules = {};
  /// The total size of all polynomials in one certificate's proof, halves included.
  std::int64_t max_work_bits = std::int64_t{1} << 28U;
  /// The additional size for the polynomials of a step, for each byte of the certificate so far.
  std::int64_t max_step_work_bits_per_byte = std::int64_t{1} << 14U;
  /// The number of comparisons of boxes in the search for the pairs of a scene, for each byte of
  /// the certificate.
  std::int64_t max_comparisons_per_byte = 256;
  /// The total number of items in the lists of a scene.
  std::size_t max_items = std::size_t{1} << 22U;
  /// The number of arguments of a step or a mesh.
  std::size_t max_arguments = std::size_t{1} << 24U;
};

/// The reason why a certificate was rejected. The texts are printable ASCII; any other byte that
/// was read is written as \xHH.
struct Rejection {
  /// The line at fault, from 1; at the end of the stream its last line.
  std::size_t line = 0;
  /// The certificate's label; empty if it has none.
  std::string label;
  std::string reason;
};

/// Results for the certificates of a stream.
struct Report {
  /// Accepted certificates by their claim.
  std::uint64_t no_collision = 0;
  std::uint64_t collision = 0;
  std::uint64_t time_of_impact = 0;
  std::uint64_t no_inversion = 0;
  std::uint64_t inversion = 0;
  std::uint64_t time_of_inversion = 0;
  /// The claims that accepted certificates of steps prove, some lines each.
  std::vector<std::string> steps;
  /// The same of meshes at rest.
  std::vector<std::string> meshes;
  /// What all of these prove together, a sentence (summary.hpp); empty if one is rejected.
  std::string summary;
  /// The number of rejected certificates. A stream without its header, or without its closing line,
  /// counts as one.
  std::uint64_t rejected = 0;
  /// The first rejections, in the order of the stream.
  std::vector<Rejection> rejections;

  [[nodiscard]] std::uint64_t accepted() const {
    return no_collision + collision + time_of_impact + inversions() + steps.size() + meshes.size();
  }
  /// Those about tetrahedra.
  [[nodiscard]] std::uint64_t inversions() const {
    return no_inversion + inversion + time_of_inversion;
  }
  [[nodiscard]] bool all_accepted() const { return rejected == 0; }
};

/// The claim in the words of a certificate, its numbers in their only form. `time_of_impact` and
/// `earliest` without numbers stand for all times, `intersections` and `welded_intersections` for
/// all counts; `free` is `no_contact 1` of a step and `intersections 0` of a mesh; `sequence` is
/// `no_contact 1` of steps each of which begins where the last one ended.
/// \throws Rejection if it is no claim.
[[nodiscard]] std::string demanded_claim(std::string_view words);

/// The separation in its only form. \param distance as in certificates, or a decimal number, which
/// means the double nearest to it. \param norm `linf` or `l2`
/// \throws Rejection if it is none.
[[nodiscard]] std::string demanded_separation(std::string_view distance, std::string_view norm);

/// Checks every certificate of a stream. After a rejected one it continues at the next `query`
/// line; a stream whose first line is wrong is one rejection. The closing line must give the number
/// of certificates, so neither an empty nor a truncated stream is accepted. Memory and time per
/// certificate are bounded for any bytes. Thread-safe for different streams.
/// \throws std::runtime_error if the stream cannot be read.
[[nodiscard]] Report check(std::istream& certificates, const Options& options = {});

}  // namespace touchstone::checker
