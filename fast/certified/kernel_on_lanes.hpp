#pragma once

/// \file
/// The floating-point stages of the certified solver, written once for lanes, with one query
/// in each lane. Only the kernels include this file, one file for each instruction set
/// (kernel_*.cpp).
///
/// F = r − u p − v q (touchstone/filters/polynomial_expressions.hpp), the corners w_i are F at the
/// vertices of its domain, and there is contact at a time t iff 0 ∈ conv{w_i(t)}. Each stage
/// decides the queries for which its theorem applies. Its file begins with the theorem:
///
/// 1. **Axis** (stages/axis.hpp): a coordinate axis separates the primitives at all times.
/// 2. **Direction** (stages/direction.hpp): the direction of the sum of the corners separates them
///   at all times.
/// 3. **Determinant** (stages/determinant.hpp): det = r·(p×q), which is 0 at each contact, keeps
///    its sign.
/// 4. **Orientation** (stages/orientation.hpp): signs of the corners' orientations exclude a
///    contact, or prove that a zero of det is a contact. If det then has exactly one zero, that is
///    the time of impact.
/// 5. **The only zero** (stages/only_zero.hpp): the same on a short interval around the zero of
///    det, if it has one on [0,1].
/// 6. **Bisection** (stages/bisection.hpp): the same on intervals in order of time.
/// 7. **Refinement** (stages/refinement.hpp): the enclosure of the time of impact.
///
/// With a minimum separation, the bounds of 3. to 7. cover all polygons shifted by it
/// (stages/moving_vectors.hpp), and there is an additional stage:
///
/// 8. **Conservative advancement** (stages/conservative_advancement.hpp) for queries whose distance
///    is too large for the shifted bounds.
///
/// stages/distance_enclosure.hpp encloses the times of impact that advancement finds, and those
/// that refinement cannot enclose because the zero of det is too long after them.
///
/// Pairs of a mesh may come with their vertices in fixed point. Then stages/single_precision.hpp,
/// with the theorems of 2. to 4., takes the place of 2. and 3.
///
/// Inversions of cells are decided by 3., 6. and 7. alone (fast/cells/stages.hpp).
///
/// The stages for curves are kernels of their own (fast/certified/curves/stages.hpp).
///
/// Queries that no stage decides remain undecided, as do those with coordinates that are not finite
/// or too large for the bounds.

#include "fast/cells/stages.hpp"
#include "fast/certified/kernel.hpp"
#include "fast/certified/stages/axis.hpp"
#include "fast/certified/stages/bisection.hpp"
#include "fast/certified/stages/conservative_advancement.hpp"
#include "fast/certified/stages/crossing.hpp"
#include "fast/certified/stages/determinant.hpp"
#include "fast/certified/stages/distance_enclosure.hpp"
#include "fast/certified/stages/lanes.hpp"
#include "fast/certified/stages/only_zero.hpp"
#include "fast/certified/stages/orientation.hpp"
#include "fast/certified/stages/refinement.hpp"
#include "fast/certified/stages/single_precision.hpp"

namespace touchstone::fast::kernel {

/// \tparam First the source for the first stages: of one query, or Source
template <class Lanes, bool separated, ContactKind kind, class Source, class First>
void run_stages(const KernelInput& input, KernelOutput& output) {
  output.separated_in_direction.count = output.one_sided.count = 0;
  output.rejected.count = output.impacts.count = output.undecided.count = 0;
  Indices mixed, far, undecided;
  if (input.rounded != nullptr) {
    single_precision_stage<Lanes, separated, kind>(input, mixed);
  } else {
    Indices open;
    if (input.axis_is_done) {
      for (; open.count < input.count; ++open.count) {
        open.items[open.count] = static_cast<std::uint32_t>(open.count);
      }
    } else {
      AxisStage<Lanes, separated, kind, First>::run(input, open);
    }
    direction_and_determinant_stage<Lanes, separated, kind, First>(input, open, mixed, output);
  }
  if (mixed.count == 0) return;
  Crossings contacts, zeros;
  orientation_stage<Lanes, separated, kind, First>(input, mixed, contacts, zeros, undecided, far,
                                                   output);
  Indices& hopeless = separated ? far : output.undecided;
  zero_stages<Lanes, separated, kind, Source>(input, zeros, contacts, undecided, hopeless, far,
                                              output);
  Moving<Lanes, kind> moving;
  load_moving<Lanes, separated, kind, Source>(input, undecided, moving);
  Bisection<Lanes, kind>(input.t_limit, moving, contacts, output.rejected, hopeless).run();
  Refinement<Lanes, separated, kind, Source>::run(input, contacts, hopeless, output);
  if constexpr (separated) {
    with_norm(input.separation.norm, [&]<Norm norm>() {
      advancement_stage<Lanes, kind, norm, Source>(input, far, output);
    });
  }
}

template <class Lanes, bool separated, ContactKind kind>
void decide_kind(const KernelInput& input, KernelOutput& output) {
  using Pairs = FromPairs<Lanes, kind>;
  if (input.queries == nullptr) {
    run_stages<Lanes, separated, kind, Pairs, Pairs>(input, output);
  } else if (input.count == 1) {
    run_stages<Lanes, separated, kind, FromArray<Lanes>, FromOne<Lanes>>(input, output);
  } else {
    run_stages<Lanes, separated, kind, FromArray<Lanes>, FromArray<Lanes>>(input, output);
  }
}

template <class Lanes, bool separated>
void decide_separation(const KernelInput& input, KernelOutput& output) {
  if (input.kind == ContactKind::vertex_face) {
    decide_kind<Lanes, separated, ContactKind::vertex_face>(input, output);
  } else {
    decide_kind<Lanes, separated, ContactKind::edge_edge>(input, output);
  }
}

template <class Lanes>
void decide(const KernelInput& input, KernelOutput& output) {
  if (input.separation.distance > 0.0) {
    decide_separation<Lanes, true>(input, output);
  } else {
    decide_separation<Lanes, false>(input, output);
  }
}

}  // namespace touchstone::fast::kernel

namespace touchstone::fast {

template <class Lanes>
constexpr CertifiedKernel certified_kernel_on(InstructionSet instructions,
                                              const CurvedKernel& curves) {
  return {.instructions = instructions,
          .decide = kernel::decide<Lanes>,
          .invert = kernel::invert<Lanes>,
          .curves = &curves,
          .product_then_sum = product_then_sum<Lanes>};
}

}  // namespace touchstone::fast
