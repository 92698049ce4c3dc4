#include "tests/mutants/mutants.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <cstddef>
#include <iterator>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <utility>

#include "fast/certified.hpp"
#include "fast/certified/exact/exact_stage.hpp"
#include "fast/filter.hpp"
#include "fast/tight_inclusion.hpp"
#include "tests/faults/filter_factors.hpp"
#include "tests/faults/planted_faults.hpp"
#include "verify/fuzz/recheck.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::tests {
namespace {

using fast::Answer;
using fast::MethodOptions;
using fast::Verdict;
using verify::fuzz::answer_of;

using Make = std::function<std::unique_ptr<fast::Method>()>;

/// A method as a function of one query.
class AlteredMethod final : public fast::Method {
 public:
  using Solve = std::function<Answer(Kind, const Query&, const MethodOptions&)>;

  /// \param of the name of the method that is altered
  AlteredMethod(std::string_view of, Solve solve)
      : info_(verify::solvers::find_method(of).info()), solve_(std::move(solve)) {}

  [[nodiscard]] const fast::MethodInfo& info() const override { return info_; }
  void solve(Kind kind, std::span<const Query> queries, std::span<Answer> answers,
             const MethodOptions& options) const override {
    for (std::size_t i = 0; i < queries.size(); ++i) answers[i] = solve_(kind, queries[i], options);
  }

 private:
  const fast::MethodInfo& info_;
  Solve solve_;
};

// ---- Mutants of Tight-Inclusion -----------------------------------------------------------------

constexpr std::string_view tight_inclusion = "tight_inclusion", certified = "certified";

using PerAxis = std::array<double, 3>;

/// The greatest magnitude on each axis of the points from `first` on.
PerAxis greatest_of(const Query& query, std::size_t first, std::size_t last) {
  PerAxis result{};
  for (std::size_t i = 3 * first; i < 3 * last; ++i) {
    result[i % 3] = std::max(result[i % 3], std::abs(query.coordinates[i]));
  }
  return result;
}

using Filter = std::function<PerAxis(Kind, const Query&, double separation)>;

/// Tight-Inclusion with a filter of its own.
Make with_filter(Filter filter) {
  return [filter = std::move(filter)]() -> std::unique_ptr<fast::Method> {
    return std::make_unique<AlteredMethod>(
        tight_inclusion,
        [filter](Kind kind, const Query& query, const MethodOptions& options) -> Answer {
          const auto result = fast::tight_inclusion(
              kind, query,
              {.tolerance = options.tolerance,
               .max_checks = options.max_checks,
               .min_separation = options.separation.distance,
               .t_max = options.t_max,
               .scene_filter = filter(kind, query, options.separation.distance)});
          return {.verdict = result.verdict,
                  .toi_lower = result.toi,
                  .toi_upper = Answer::none,
                  .tolerance = result.tolerance};
        });
  };
}

/// The right filter times a factor.
Make with_filter_times(double factor) {
  return with_filter([factor](Kind kind, const Query& query, double separation) {
    PerAxis result = fast::error_filter(kind, greatest_of(query, 0, query_points), separation);
    for (double& x : result) x *= factor;
    return result;
  });
}

/// The right filter for some of the points only.
Make with_filter_of_points(std::size_t first, std::size_t last) {
  return with_filter([first, last](Kind kind, const Query& query, double separation) {
    return fast::error_filter(kind, greatest_of(query, first, last), separation);
  });
}

/// That of the public Tight-Inclusion: the published constants times min(x_max, 1)³; published is max.
PerAxis filter_of_min(Kind kind, const Query& query, double separation) {
  return fast::error_filter(kind, greatest_of(query, 0, query_points), separation,
                            fast::ErrorModel::released);
}

/// The filter of the first axis for all.
PerAxis filter_of_first_axis(Kind kind, const Query& query, double separation) {
  const PerAxis right = fast::error_filter(kind, greatest_of(query, 0, query_points), separation);
  return {right[0], right[0], right[0]};
}

// Of a part that this build does not plant there is no mutant.

Make with_box(const fast::BoxKernel* kernel) {
  if (kernel == nullptr) return nullptr;
  return [kernel] { return fast::tight_inclusion_method({.kernel = kernel}); };
}

Make with_search(fast::MakeSearch* make) {
  if (make == nullptr) return nullptr;
  return [make] { return make({}); };
}

// ---- Mutants of the certified solver ------------------------------------------------------------

Make with_kernel(const fast::CertifiedKernel* kernel) {
  if (kernel == nullptr) return nullptr;
  return [kernel] { return fast::certified_method({.kernel = kernel}); };
}

/// The certified solver, each query by itself.
Make with_alteration(AlteredMethod::Solve solve) {
  return [solve = std::move(solve)]() -> std::unique_ptr<fast::Method> {
    return std::make_unique<AlteredMethod>(certified, solve);
  };
}

fast::CertifiedOptions certified_options(const MethodOptions& options) {
  return {.t_max = options.t_max, .separation = options.separation, .max_threads = 1};
}

/// With another last stage.
Make with_exact_stage(fast::DecideDistance* decide) {
  if (decide == nullptr) return nullptr;
  return with_alteration([decide](Kind kind, const Query& query, const MethodOptions& options) {
    const fast::CertifiedOptions all = certified_options(options);
    const fast::CertifiedResult right = fast::certified(kind, query, all);
    if (right.stage != fast::Stage::exact || right.verdict == Verdict::error) {
      return verify::fuzz::answer_of(right);
    }
    const auto impact = decide(kind, query, all.separation, all.toi_tolerance, all.t_max);
    if (!impact) return Answer{.verdict = Verdict::no};
    return Answer{.verdict = Verdict::yes,
                  .toi_lower = impact->toi_lower,
                  .toi_upper = impact->toi_upper,
                  .tolerance = Answer::none};
  });
}

/// With bounds of the kernel times factors.
Make with_factors(const FilterFactors& factors) {
  return with_alteration([factors](Kind kind, const Query& query, const MethodOptions& options) {
    filter_factors = factors;
    fast::CertifiedOptions all = certified_options(options);
    all.kernel = &fast::kernel_with_factors;
    return verify::fuzz::answer_of(fast::certified(kind, query, all));
  });
}

Answer without_start(Kind kind, const Query& query, const MethodOptions& options) {
  const auto right = fast::certified(kind, query, certified_options(options));
  if (right.verdict == Verdict::yes && right.toi_upper == 0.0) return {.verdict = Verdict::no};
  return verify::fuzz::answer_of(right);
}

Answer without_end(Kind kind, const Query& query, const MethodOptions& options) {
  fast::CertifiedOptions all = certified_options(options);
  all.t_max = std::min(all.t_max, std::nextafter(1.0, 0.0));
  return verify::fuzz::answer_of(fast::certified(kind, query, all));
}

Answer of_floats(Kind kind, const Query& query, const MethodOptions& options) {
  Query rounded = query;
  for (double& x : rounded.coordinates) {
    if (std::abs(x) < 0x1p126) x = static_cast<double>(static_cast<float>(x));
  }
  return verify::fuzz::answer_of(fast::certified(kind, rounded, certified_options(options)));
}

Answer with_upper_for_lower(Kind kind, const Query& query, const MethodOptions& options) {
  Answer answer = verify::fuzz::answer_of(fast::certified(kind, query, certified_options(options)));
  answer.toi_lower = answer.toi_upper;
  return answer;
}

Answer in_the_other_norm(Kind kind, const Query& query, const MethodOptions& options) {
  fast::CertifiedOptions all = certified_options(options);
  all.separation.norm = options.separation.norm == Norm::l2 ? Norm::linf : Norm::l2;
  return verify::fuzz::answer_of(fast::certified(kind, query, all));
}

// ---- The list -----------------------------------------------------------------------------------

constexpr Separation near{.distance = 0x1p-10, .norm = Norm::linf};
constexpr Separation near_in_l2{.distance = 0x1p-10, .norm = Norm::l2};

std::vector<Mutant> filters_of_tight_inclusion() {
  return {
      {"filter_none", tight_inclusion, "no filter at all", with_filter_times(0.0)},
      {"filter_1000", tight_inclusion, "the filter is too small by 1000", with_filter_times(1e-3)},
      {"filter_10", tight_inclusion, "the filter is too small by 10", with_filter_times(0.1)},
      {"filter_3", tight_inclusion, "the filter is too small by 3", with_filter_times(1.0 / 3.0)},
      {"filter_2",
       tight_inclusion,
       "the filter is too small by 2",
       with_filter_times(0.5),
       {},
       {},
       "All corner values of a box with a contact must err by more than half the bound, to one "
       "side. Those of contact_aligned err by 4 u x, of two edges' bound of 10 u x; values near it "
       "are multiples of 2 u x, and none of 6 u x was met."},
      {"filter_min_for_max", tight_inclusion, "the filter has min(x_max, 1) for max(x_max, 1)",
       with_filter(filter_of_min)},
      {"filter_of_start", tight_inclusion, "the filter looks at the points at t=0 only",
       with_filter_of_points(0, moving_points)},
      {"filter_of_first_point", tight_inclusion, "the filter looks at the first point only",
       with_filter_of_points(0, 1)},
      {"filter_of_first_axis", tight_inclusion, "the filter of the x axis is taken for all",
       with_filter(filter_of_first_axis)},
  };
}

std::vector<Mutant> parts_of_tight_inclusion() {
  return {
      {"box_of_wrong_sign", tight_inclusion, "a box is dropped below +filter, not below −filter",
       with_box(&fast::box_of_wrong_sign)},
      {"box_in_float", tight_inclusion, "products are rounded to float",
       with_box(&fast::box_in_float)},
      {"box_of_squared_width", tight_inclusion,
       "a box's width is a sum of squares without the root", with_box(&fast::box_of_squared_width)},
      {"box_of_least_width", tight_inclusion,
       "a box's width is the least of 0 and its sides, min for max",
       with_box(&fast::box_of_least_width)},
      {"box_of_one_sided_distance", tight_inclusion, "the separation is forgotten on one side",
       with_box(&fast::box_of_one_sided_distance), near},
      {"box_of_swapped_corners", tight_inclusion,
       "one corner of a triangle's box has the weight of another",
       with_box(&fast::box_of_swapped_corners)},
      {"search_without_domain_edge",
       tight_inclusion,
       "boxes that begin on u+v=1 are dropped",
       with_search(&fast::search_without_domain_edge),
       {},
       "Such a box has one point in the domain, its lower corner. The lower half it was split "
       "from, or a "
       "box on the same side of that, is closed and has that point too, at the same times."},
      {"search_in_part_of_triangle", tight_inclusion, "boxes that begin beyond u+v=3/4 are dropped",
       with_search(&fast::search_in_part_of_triangle)},
      {"search_of_edges_as_triangle", tight_inclusion, "two edges are looked at where u+v ≤ 1 only",
       with_search(&fast::search_of_edges_as_triangle)},
      {"search_split_off_by_one", tight_inclusion, "the upper half begins a whole width later",
       with_search(&fast::search_split_off_by_one)},
      {"search_remembers_late", tight_inclusion, "a small box is remembered with its upper time",
       with_search(&fast::search_remembers_late)},
      {"search_gives_upper_time", tight_inclusion, "a box's upper time is returned",
       with_search(&fast::search_gives_upper_time)},
      {"search_out_of_order", tight_inclusion, "upper halves in t wait for the end of the level",
       with_search(&fast::search_out_of_order)},
      {"search_claims_its_tolerance", tight_inclusion,
       "what runs out of checks claims δ all the same",
       with_search(&fast::search_claims_its_tolerance)},
      {"search_forgets_the_remembered", tight_inclusion,
       "a remembered box after t=1/2 is forgotten",
       with_search(&fast::search_forgets_the_remembered)},
  };
}

std::vector<Mutant> filters_of_certified() {
  return {
      {"gap_bound_none", certified, "no bound in stage direction", with_factors({.gap = 0.0})},
      {"determinant_bound_1000", certified, "the determinant's bound is too small by 1000",
       with_factors({.determinant = 1e-3})},
      {"determinant_bound_10",
       certified,
       "the determinant's bound is too small by 10",
       with_factors({.determinant = 0.1}),
       {},
       {},
       "All four coefficients of a determinant with a zero must err by more than 28 u to one side. "
       "The worst "
       "error observed of one is 57 u (touchstone derive), the usual one is below 3 u."},
      {"orientation_bound_1000", certified, "the orientations' bound is too small by 1000",
       with_factors({.orientation = 1e-3})},
      {"precise_bound_none",
       certified,
       "no bound in double-double",
       with_factors({.precise = 0.0}),
       {},
       {},
       "A zero of the determinant that is nearly threefold: the values at the ends of an enclosure "
       "of any other are "
       "far beyond the bound."},
      {"kernel_without_product_error", certified,
       "the error of a product is lost, as by contraction to a fused operation",
       with_kernel(&fast::kernel_without_product_error)},
  };
}

std::vector<Mutant> kernels_of_certified() {
  return {
      {"axis_of_start", certified, "stage axis looks at t=0 only",
       with_kernel(&fast::fault_in_axis)},
      {"direction_wrong_sign", certified, "stage direction asks for a gap above −bound",
       with_kernel(&fast::fault_in_direction)},
      {"determinant_of_ends", certified, "the determinant's middle coefficients are left out",
       with_kernel(&fast::fault_in_determinant)},
      {"determinant_without_bound", certified, "the determinant has no bound",
       with_kernel(&fast::fault_in_bound)},
      {"rejection_by_one", certified, "one sign of an orientation is enough to reject",
       with_kernel(&fast::fault_in_rejection)},
      {"agreement_of_one", certified, "one sign of an orientation is enough for a contact",
       with_kernel(&fast::fault_in_agreement)},
      {"zero_without_orientation", certified, "a zero of the determinant is a contact",
       with_kernel(&fast::fault_in_zero)},
      {"refinement_unproved", certified, "the enclosure is not proved",
       with_kernel(&fast::fault_in_refinement)},
      {"axis_without_distance", certified, "stage axis forgets the distance",
       with_kernel(&fast::fault_in_axis_distance), near},
      {"bounds_not_widened", certified, "bounds are not widened by the distance",
       with_kernel(&fast::fault_in_widening), near},
      {"bounds_widened_too_little", certified,
       "bounds are widened for the ends' coefficients, not the middle ones",
       with_kernel(&fast::fault_in_shift), near},
      {"step_of_one_end", certified, "a step is free if it begins so",
       with_kernel(&fast::fault_in_step), near},
      {"witness_unproved", certified, "a time of impact that is too early is not noticed",
       with_kernel(&fast::fault_in_witness), near_in_l2},
  };
}

std::vector<Mutant> last_stages_of_certified() {
  return {
      {"exact_without_boundary", certified, "contact on the boundary is none",
       with_exact_stage(&fast::fault_on_boundary)},
      {"exact_line_without_ends", certified, "on a line contact at an end is none",
       with_exact_stage(&fast::fault_on_line)},
      {"exact_enclosure_reversed", certified, "the search for a root goes the wrong way",
       with_exact_stage(&fast::fault_in_enclosure)},
      {"exact_neighbour", certified,
       "a root at the end of the searched interval is taken for the one before",
       with_exact_stage(&fast::fault_in_neighbour)},
      {"exact_filter_8192", certified, "the filter of signs is 8192 times too small",
       with_exact_stage(&fast::fault_in_filter)},
      {"exact_general_early", certified, "the general case gives the lower time twice",
       with_exact_stage(&fast::fault_in_general)},
      {"exact_without_last_bound", certified, "the last side of the domain is forgotten",
       with_exact_stage(&fast::exact_without_last_bound)},
      {"exact_without_parallel_case", certified, "the case of a normal that is 0 is missing",
       with_exact_stage(&fast::exact_without_parallel_case)},
      {"exact_side_without_distance", certified, "a side is as near as its line is zero",
       with_exact_stage(&fast::fault_in_side), near_in_l2},
      {"exact_vertex_off", certified, "the beginning of a side is not subtracted",
       with_exact_stage(&fast::fault_in_vertex), near_in_l2},
      {"exact_face_without_distance", certified, "a face is as near as its plane is zero",
       with_exact_stage(&fast::fault_in_face), near_in_l2},
      {"exact_cube_of_size_zero", certified, "the cube of L∞ has no size",
       with_exact_stage(&fast::fault_in_cube), near},
      {"exact_form_cut_late",
       certified,
       "a form is looked at up to an end that has moved since",
       with_exact_stage(&fast::fault_in_dip),
       near,
       {},
       "A form of a separator must be negative for a moment only, of 2^-40 of the step or less, "
       "just before the root of another form that ends the separator."},
      {"exact_horizon", certified, "what is near from the first contact on only is none",
       with_exact_stage(&fast::fault_in_horizon), near},
      {"root_at_start_missing", certified, "contact at t=0 is none",
       with_alteration(without_start)},
      {"root_at_end_missing", certified, "contact at t=1 is none", with_alteration(without_end)},
      {"coordinates_as_floats", certified, "coordinates are rounded to float",
       with_alteration(of_floats)},
      {"upper_for_lower", certified, "the upper time is given as the lower one",
       with_alteration(with_upper_for_lower)},
      {"other_norm", certified, "the distance is measured in L2 where L∞ is asked for",
       with_alteration(in_the_other_norm), near},
  };
}

std::vector<Mutant> all_mutants() {
  std::vector<Mutant> all;
  for (std::vector<Mutant>& some :
       std::array{filters_of_tight_inclusion(), parts_of_tight_inclusion(), filters_of_certified(),
                  kernels_of_certified(), last_stages_of_certified()}) {
    std::ranges::move(some, std::back_inserter(all));
  }
  std::erase_if(all, [](const Mutant& mutant) { return !mutant.make; });
  return all;
}

}  // namespace

const std::vector<Mutant>& mutants() {
  static const std::vector<Mutant> all = all_mutants();
  return all;
}

const Mutant& find_mutant(std::string_view name) {
  const auto found = std::ranges::find(mutants(), name, &Mutant::name);
  if (found == mutants().end()) {
    throw std::invalid_argument("no mutant is called " + std::string(name));
  }
  return *found;
}

}  // namespace touchstone::tests
