#include "touchstone/tight_inclusion.hpp"

#include <algorithm>
#include <cmath>
#include <limits>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "fast/method.hpp"
#include "fast/platform/arithmetic_check.hpp"
#include "fast/tight_inclusion/curved_box_kernel.hpp"
#include "fast/tight_inclusion_variant.hpp"

namespace touchstone::fast {
namespace {

constexpr double infinity = std::numeric_limits<double>::infinity();

constexpr double scale_down = 0x1p-16;

/// The most boxes of a level, of 24 bytes in each of two arrays.
constexpr std::size_t most_boxes = std::size_t{1} << 22U;

bool is_single_precision(const BoxKernel& kernel) {
  return kernel.digits == std::numeric_limits<float>::digits;
}

/// Coordinates beyond this are scaled down before the search, so that nothing overflows in it.
double greatest_unscaled(const BoxKernel& kernel) {
  return is_single_precision(kernel) ? 0x1p120 : 0x1p1016;
}

/// The least number of the kernel's precision that is not below x ≥ 0.
double rounded_up(const BoxKernel& kernel, double x) {
  if (!is_single_precision(kernel)) return x;
  const auto rounded = static_cast<float>(x);
  const bool is_below = static_cast<double>(rounded) < x;
  return static_cast<double>(is_below ? std::nextafter(rounded, static_cast<float>(infinity))
                                      : rounded);
}

/// The lower ends of a box; its widths are those of its level.
using LowerCorner = std::array<double, 3>;

enum Axis : std::size_t { t_axis, u_axis, v_axis };

/// The memory of a search, reused by the next.
struct Workspace {
  BoxProblem problem;
  std::vector<LowerCorner> level;
  std::vector<LowerCorner> next_level;
  std::vector<LowerCorner> upper_halves;
};

/// The options of a search.
struct SearchOptions {
  double tolerance;
  std::int64_t max_checks;
  double t_end;  ///< of at most BoxKernel::digits fractional bits
};

/// The result of a search.
struct SearchResult {
  bool collides;
  double toi;
  double tolerance;
  std::int64_t checks;
};

/// One search: algorithm 2, level by level.
class Search {
 public:
  Search(const BoxKernel& kernel, Workspace& workspace, const SearchOptions& options)
      : kernel_(kernel), workspace_(workspace), options_(options) {}

  SearchResult run() {
    // Most queries end here, and do not need tolerances.
    const BoxTest root = kernel_.test(workspace_.problem, box_at({0.0, 0.0, 0.0}));
    if (root.rejected) return {false, 0.0, 0.0, 1};
    set_parameter_tolerances();
    workspace_.level.assign(1, {0.0, 0.0, 0.0});
    workspace_.upper_halves.clear();
    while (!workspace_.level.empty()) {
      if (examine_level()) return collision();
      std::swap(workspace_.level, workspace_.next_level);
    }
    if (remembered_ <= 1.0) return {true, remembered_, options_.tolerance, checks_};
    return {false, 0.0, 0.0, checks_};
  }

 private:
  [[nodiscard]] Box box_at(const LowerCorner& corner) const {
    const double t1 = std::min(corner[t_axis] + widths_[t_axis], options_.t_end);
    return {{corner[t_axis], t1, corner[u_axis], corner[u_axis] + widths_[u_axis], corner[v_axis],
             corner[v_axis] + widths_[v_axis]}};
  }

  /// The widths of parameters for which the image is certainly at most δ wide: δ/(3κ), with κ the
  /// greatest change of F along an edge of the unit box (paper, section 4.3).
  void set_parameter_tolerances() {
    const std::array<double, 3> kappa =
        kernel_.changes != nullptr ? kernel_.changes(workspace_.problem) : changes_of_corners();
    for (std::size_t axis = 0; axis < 3; ++axis) {
      parameter_tolerances_[axis] = options_.tolerance / (3.0 * kappa[axis]);
    }
    if (options_.t_end == 0.0) parameter_tolerances_[t_axis] = infinity;
  }

  [[nodiscard]] std::array<double, 3> changes_of_corners() const {
    const Box unit{{0.0, 1.0, 0.0, 1.0, 0.0, 1.0}};
    std::array<double, 3> kappa{};
    for (std::size_t axis = 0; axis < 3; ++axis) {
      const CornerValues f = kernel_.corners(workspace_.problem, unit, axis);
      for (std::size_t corner = 0; corner < f.size(); ++corner) {
        for (const Axis along : {t_axis, u_axis, v_axis}) {
          const std::size_t neighbour = corner | std::size_t{4} >> along;
          kappa[along] = std::max(kappa[along], std::abs(f[neighbour] - f[corner]));
        }
      }
    }
    return kappa;
  }

  /// The axis to split on this level: the widest relative to its tolerance. None if all are small.
  [[nodiscard]] std::optional<Axis> axis_to_split() const {
    std::optional<Axis> widest;
    double greatest_ratio = 0.0;
    for (const Axis axis : {t_axis, u_axis, v_axis}) {
      const double ratio = widths_[axis] / parameter_tolerances_[axis];
      // Parameters and their complements to 1 are exact for as many splits as digits.
      if (widths_[axis] > parameter_tolerances_[axis] && splits_[axis] < kernel_.digits &&
          ratio > greatest_ratio) {
        widest = axis;
        greatest_ratio = ratio;
      }
    }
    return widest;
  }

  /// Examines the boxes of a level and creates the boxes of the next. True if the search ends with
  /// a collision, at the level's first box that is not dropped.
  bool examine_level() {
    const std::optional<Axis> axis = axis_to_split();
    bool is_first = true;
    workspace_.next_level.clear();
    for (const LowerCorner& corner : workspace_.level) {
      if (corner[t_axis] >= remembered_) break;
      ++checks_;
      const BoxTest test = kernel_.test(workspace_.problem, box_at(corner));
      if (test.rejected) continue;
      const bool is_small = test.inside || test.width <= options_.tolerance;
      if (std::exchange(is_first, false)) {
        first_ = {corner[t_axis],
                  test.inside ? options_.tolerance : std::max(test.width, options_.tolerance)};
        if (is_small || !axis) return true;
      }
      if (options_.max_checks > 0 && checks_ > options_.max_checks) return true;
      if (is_small) {
        remembered_ = corner[t_axis];
      } else if (axis) {
        split(corner, *axis);
      }
      if (workspace_.next_level.size() + workspace_.upper_halves.size() > most_boxes) {
        return true;
      }
    }
    append_upper_halves();
    if (axis) {
      widths_[*axis] /= 2.0;
      ++splits_[*axis];
    }
    return false;
  }

  /// Adds the halves of a box that reach into the domain to the next level.
  void split(const LowerCorner& corner, Axis axis) {
    LowerCorner upper = corner;
    upper[axis] += widths_[axis] / 2.0;
    if (axis == t_axis) {
      const auto& waiting = workspace_.upper_halves;
      if (!waiting.empty() && waiting.back()[t_axis] != upper[t_axis]) append_upper_halves();
      workspace_.next_level.push_back(corner);
      if (upper[t_axis] <= options_.t_end) workspace_.upper_halves.push_back(upper);
      return;
    }
    workspace_.next_level.push_back(corner);
    // A sum above 1 may round to 1; then the box is kept, which is harmless.
    if (workspace_.problem.kind == ContactKind::edge_edge || upper[u_axis] + upper[v_axis] <= 1.0) {
      workspace_.next_level.push_back(upper);
    }
  }

  void append_upper_halves() {
    auto& halves = workspace_.upper_halves;
    workspace_.next_level.insert(workspace_.next_level.end(), halves.begin(), halves.end());
    halves.clear();
  }

  [[nodiscard]] SearchResult collision() const {
    return {true, first_.toi, first_.tolerance, checks_};
  }

  struct First {
    double toi;
    double tolerance;
  };

  const BoxKernel& kernel_;
  Workspace& workspace_;
  const SearchOptions options_;
  std::array<double, 3> parameter_tolerances_{};
  std::array<double, 3> widths_{1.0, 1.0, 1.0};
  std::array<int, 3> splits_{};
  First first_{};            ///< the level's first box that is not dropped
  double remembered_ = 2.0;  ///< lower t of the earliest small box that was not the first
  std::int64_t checks_ = 0;
};

void require_valid(const TightInclusionOptions& options) {
  const auto require = [](bool holds, const char* rule) {
    if (!holds) throw std::invalid_argument(std::string("tight_inclusion: ") + rule);
  };
  // NaN fails, too.
  const auto is_filter = [](double x) { return x >= 0.0; };
  require(options.tolerance > 0.0 && options.tolerance < infinity,
          "the tolerance must be positive and finite");
  require(is_valid(options.separation), "the separation must be finite and not negative");
  require(options.t_max >= 0.0 && options.t_max <= 1.0, "t_max must be in [0,1]");
  require(!options.scene_filter || std::ranges::all_of(*options.scene_filter, is_filter),
          "the filter of a scene must not be negative");
}

/// The least number of so many fractional bits that is not below t ∈ [0,1].
double round_up_to_exact(double t, int digits) {
  return std::ldexp(std::ceil(std::ldexp(t, digits)), -digits);
}

/// The kernel for queries of a shape.
const BoxKernel& kernel_of(const QueryShape& shape, const TightInclusionOptions& options) {
  if (shape.is_straight())
    return options.kernel != nullptr ? *options.kernel : *box_kernels().back();
  if (shape.degree < 2 || shape.degree > BoxProblem::greatest_curve_degree) {
    throw std::invalid_argument("tight_inclusion: curves must be of degree 2 or 3");
  }
  if (options.scene_filter) {
    throw std::invalid_argument("tight_inclusion: curves have no filter of a scene");
  }
  return shape.is_rational ? rational_box_kernel() : curved_box_kernel();
}

/// Solves one query by a search.
class QuerySolver {
 public:
  QuerySolver(const TightInclusionVariant& variant, Workspace& workspace,
              const TightInclusionOptions& options)
      : kernel_(variant.kernel),
        error_filter_(variant.filter),
        workspace_(workspace),
        options_(options) {}

  TightInclusionResult solve(ContactKind kind, const Query& query) {
    workspace_.problem.kind = kind;
    const Extent extent = kernel_.load(query, workspace_.problem);
    if (!extent.finite) return {};
    prepare(kind, query, extent);
    return search();
  }

  /// Query i, on curves.
  TightInclusionResult solve(const Queries& queries, std::size_t i) {
    BoxProblem& problem = workspace_.problem;
    problem.kind = queries.kind;
    const Extent extent = load_curves(queries, i, problem);
    if (!extent.finite) return {};
    const double distance = options_.separation.distance;
    std::optional<std::array<double, 3>> filter;
    if (queries.is_rational) {
      filter = filter_of_rational_curves(problem, extent.x_max, distance);
    } else if (std::max(std::ranges::max(extent.x_max), distance) <= greatest_of_curves) {
      filter = filter_of_curves(queries.kind, queries.degree, extent.x_max, distance);
    }
    if (!filter) return {.verdict = Verdict::yes, .toi = 0.0, .tolerance = infinity};
    tolerance_ = options_.tolerance;
    problem.separation = distance;
    std::ranges::copy(*filter, problem.filter.begin());
    return search();
  }

 private:
  /// Sets scale, separation and filter.
  void prepare(ContactKind kind, const Query& query, Extent extent) {
    const double greatest = std::max(std::ranges::max(extent.x_max), options_.separation.distance);
    if (greatest > greatest_unscaled(kernel_)) {
      scale_ = scale_down;
      Query scaled = query;
      for (double& x : scaled.coordinates) x *= scale_;
      extent = kernel_.load(scaled, workspace_.problem);
    }
    tolerance_ = std::max(options_.tolerance * scale_, std::numeric_limits<double>::denorm_min());
    workspace_.problem.separation = rounded_up(kernel_, options_.separation.distance * scale_);
    const std::array<double, 3> exact = filter(kind, extent.x_max);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      workspace_.problem.filter[axis] = rounded_up(kernel_, exact[axis]);
    }
  }

  [[nodiscard]] std::array<double, 3> filter(ContactKind kind,
                                             const std::array<double, 3>& x_max) const {
    std::array<double, 3> result = options_.scene_filter
                                       ? *options_.scene_filter
                                       : error_filter_(kind, x_max, workspace_.problem.separation);
    if (scale_ == 1.0) return result;
    // Scaling does not reduce underflow, and truncates coordinates by as much again.
    const std::array<double, 3> underflow =
        (is_single_precision(kernel_) ? error_filter_ : error_filter)(kind, {0.0, 0.0, 0.0}, 0.0);
    for (std::size_t axis = 0; axis < 3; ++axis) {
      if (options_.scene_filter) result[axis] *= scale_;
      result[axis] = std::nextafter(result[axis] + 2.0 * underflow[axis], infinity);
    }
    return result;
  }

  TightInclusionResult search() {
    const SearchResult found =
        Search(kernel_, workspace_,
               {tolerance_, options_.max_checks, round_up_to_exact(options_.t_max, kernel_.digits)})
            .run();
    if (!found.collides) return {.verdict = Verdict::no, .checks = found.checks};
    return {.verdict = Verdict::yes,
            .toi = std::min(found.toi, options_.t_max),
            .tolerance = found.tolerance / scale_,
            .checks = found.checks};
  }

  const BoxKernel& kernel_;
  const ErrorFilter error_filter_;
  Workspace& workspace_;
  const TightInclusionOptions& options_;
  double scale_ = 1.0;
  double tolerance_ = 0.0;
};

Workspace& workspace_of_this_thread() {
  thread_local Workspace workspace;
  return workspace;
}

/// Passes on the result of each query: take(i, result).
template <class Take>
void solve_all(const Queries& given, const TightInclusionOptions& options, const Take& take) {
  require_strict_environment();
  require_valid(options);
  std::vector<double> memory;
  const Queries queries = decided_queries(given, memory);
  const TightInclusionVariant usual{kernel_of(queries, options), error_filter};
  Workspace& workspace = workspace_of_this_thread();
  const std::size_t size = queries.size();
  for (std::size_t i = 0; i < size; ++i) {
    QuerySolver solver(usual, workspace, options);
    take(i, queries.is_straight() ? solver.solve(queries.kind, queries.straight()[i])
                                  : solver.solve(queries, i));
  }
}

/// Saturates the number at the maximum of an answer.
std::uint32_t to_answer_checks(std::int64_t checks) {
  return static_cast<std::uint32_t>(
      std::min<std::int64_t>(checks, std::numeric_limits<std::uint32_t>::max()));
}

class TightInclusionMethod final : public Method {
 public:
  explicit TightInclusionMethod(const BoxKernel* kernel) : kernel_(kernel) {}

  [[nodiscard]] const MethodInfo& info() const override { return info_; }

  void solve(const AnyQueries& queries, std::span<Answer> answers,
             const MethodOptions& options) const override {
    const TightInclusionOptions all{.tolerance = options.tolerance,
                                    .max_checks = options.max_checks,
                                    .separation = options.separation,
                                    .t_max = options.t_max,
                                    .kernel = kernel_};
    solve_all(queries.as(queries.kind.contact()), all,
              [&](std::size_t i, const TightInclusionResult& result) {
                answers[i] = {.verdict = result.verdict,
                              .checks = to_answer_checks(result.checks),
                              .toi_lower = result.toi,
                              .toi_upper = Answer::none,
                              .tolerance = result.tolerance};
              });
  }

 private:
  MethodInfo info_{.name = "tight_inclusion",
                   .promise = Promise::conservative,
                   .terms = {.least_degree = 2,
                             .most_degree = BoxProblem::greatest_curve_degree,
                             .rational = true},
                   .reference = "wang2021",
                   .norms = {Norm::linf},
                   .is_tolerance_driven = true,
                   .filter = error_filter};
  const BoxKernel* kernel_;
};

}  // namespace

TightInclusionResult tight_inclusion(ContactKind kind, const Query& query,
                                     const TightInclusionOptions& options) {
  TightInclusionResult result;
  tight_inclusion(Queries(kind, std::span(&query, 1)), std::span(&result, 1), options);
  return result;
}

TightInclusionResult tight_inclusion(ContactKind kind, const Query& query,
                                     const TightInclusionOptions& options,
                                     const TightInclusionVariant& variant) {
  require_strict_environment();
  require_valid(options);
  return QuerySolver(variant, workspace_of_this_thread(), options).solve(kind, query);
}

void tight_inclusion(const Queries& queries, std::span<TightInclusionResult> results,
                     const TightInclusionOptions& options) {
  if (results.size() != queries.size()) {
    throw std::invalid_argument("tight_inclusion: " + std::to_string(results.size()) +
                                " results for " + std::to_string(queries.size()) + " queries");
  }
  solve_all(queries, options,
            [&](std::size_t i, const TightInclusionResult& result) { results[i] = result; });
}

std::unique_ptr<Method> tight_inclusion_method(const TightInclusionOptions& base) {
  return std::make_unique<TightInclusionMethod>(base.kernel);
}

}  // namespace touchstone::fast
