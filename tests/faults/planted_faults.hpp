#pragma once

/// \file
/// Solvers' parts with one fault each (CMakeLists.txt), which the tests of the parts and the fuzzer must find. A build
/// plants one a stage, or all of them (TOUCHSTONE_ALL_FAULTS); under the sanitizers none. The address of one that is not
/// planted is null.

#include <memory>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "exact/query.hpp"
#include "fast/active_set.hpp"
#include "fast/broad_phase/float_bounds.hpp"
#include "fast/broad_phase/search.hpp"
#include "fast/certified/exact/exact_stage.hpp"
#include "fast/certified/kernel.hpp"
#include "fast/distance.hpp"
#include "fast/line_search.hpp"
#include "fast/mesh.hpp"
#include "fast/method.hpp"
#include "fast/tight_inclusion.hpp"
#include "fast/tight_inclusion/box_kernel.hpp"

namespace touchstone::fast {

#define TOUCHSTONE_PLANTED __attribute__((weak))

// The bounds of FloatBounds, with which the broad phase begins.
using MakeBounds = std::vector<VertexBounds>(const MovingVertices&, double end, double distance);
extern MakeBounds TOUCHSTONE_PLANTED bounds_without_error, bounds_widened_inwards,
    bounds_widened_on_one_side, bounds_in_disorder;

// The search of the broad phase.
extern const SearchKernel TOUCHSTONE_PLANTED search_of_open_boxes, search_apart_at_one_end,
    search_apart_either_way, search_without_axis, search_without_lane, search_with_empty_lanes,
    search_without_own_node, search_of_neighbours, search_too_sure, search_of_all_bodies,
    search_without_mixed_bodies, division_by_another_rank, division_on_another_axis;

// Tight-Inclusion's box test.
extern const BoxKernel TOUCHSTONE_PLANTED box_of_wrong_sign, box_in_float, box_of_squared_width,
    box_of_least_width, box_of_one_sided_distance, box_of_swapped_corners;

// Its search.
using MakeSearch = std::unique_ptr<Method>(const TightInclusionOptions&);
extern MakeSearch TOUCHSTONE_PLANTED search_without_domain_edge, search_in_part_of_triangle,
    search_of_edges_as_triangle, search_split_off_by_one, search_remembers_late,
    search_gives_upper_time, search_out_of_order, search_claims_its_tolerance,
    search_forgets_the_remembered;

// The certified solver's kernel.
extern const CertifiedKernel TOUCHSTONE_PLANTED kernel_with_factors, kernel_without_product_error,
    fault_in_axis, fault_in_direction, fault_in_determinant, fault_in_bound, fault_in_rejection,
    fault_in_agreement, fault_in_zero, fault_in_refinement, fault_in_axis_distance,
    fault_in_widening, fault_in_shift, fault_in_step, fault_in_witness;

// Its exact stage, which is two functions: without a distance and with one.
using DecideContact = std::optional<ExactImpact>(Kind, const Query&, double, double);
extern DecideContact TOUCHSTONE_PLANTED exact_without_last_bound, exact_without_parallel_case,
    fault_on_boundary, fault_on_line, fault_in_enclosure, fault_in_neighbour, fault_in_filter,
    fault_in_general;
using DecideDistance = std::optional<ExactImpact>(Kind, const Query&, const Separation&, double,
                                                  double);
extern DecideDistance TOUCHSTONE_PLANTED exact_without_last_bound, exact_without_parallel_case,
    fault_on_boundary, fault_on_line, fault_in_enclosure, fault_in_neighbour, fault_in_filter,
    fault_in_general, fault_in_side, fault_in_vertex, fault_in_face, fault_in_cube, fault_in_dip,
    fault_in_horizon;
/// Without a fault: it counts its work (limb_products.hpp).
extern DecideDistance TOUCHSTONE_PLANTED exact_that_counts;

// The distance of two primitives: its exact stage and its filter.
using ExactDistance = Distance(Kind, const Query&, double, Norm);
extern ExactDistance TOUCHSTONE_PLANTED distance_to_lines, distance_to_planes,
    distance_with_short_axes, distance_without_sides;
using FilteredDistance = std::optional<Distance>(Kind, const Query&, double, Norm);
extern FilteredDistance TOUCHSTONE_PLANTED distance_without_radius, distance_without_rounding;

// Active set and line search.
using FindActive = std::vector<ActiveContact>(const Step&, double, Norm);
extern FindActive TOUCHSTONE_PLANTED active_set_without_side;
using LimitStep = LineSearchLimit(const Step&, double, const LineSearchOptions&);
extern LimitStep TOUCHSTONE_PLANTED line_search_too_far, line_search_too_near, line_search_of_few;

}  // namespace touchstone::fast

namespace touchstone::tests {

// The checker of certificates of steps (checker_of_steps.cpp).
using Accepts = bool(const std::string& stream);
extern Accepts TOUCHSTONE_PLANTED checker_of_open_boxes, checker_of_one_end,
    checker_of_directions_at_start, checker_of_pieces_with_gaps, checker_without_closing_line;

#undef TOUCHSTONE_PLANTED

/// How many faults of a kind a build has to plant at least: none under the sanitizers.
[[nodiscard]] constexpr int least_planted([[maybe_unused]] int usual) {
#ifdef TOUCHSTONE_SANITIZED
  return 0;
#else
  return usual;
#endif
}

}  // namespace touchstone::tests
