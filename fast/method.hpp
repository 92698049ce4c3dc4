#pragma once

/// \file
/// The interface of every solver: a description, and answers to queries. verify/
/// uses solvers through it alone.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string_view>
#include <vector>

#include "touchstone/any_kind.hpp"
#include "touchstone/certified.hpp"
#include "touchstone/tight_inclusion.hpp"

namespace touchstone::fast {

/// An answer with its uncertainty. Fields that the method does not provide are NaN.
struct Answer {
  static constexpr double none = no_number;

  Verdict verdict = Verdict::undecided;
  /// The number of steps that the method counts, such as boxes; 0 if it counts none.
  std::uint32_t checks = 0;
  double toi_lower = none;  ///< claimed: not above the exact time of impact; only with yes
  double toi_upper = none;  ///< claimed: not below the exact time of impact; only with yes
  double tolerance = none;  ///< with yes: claimed bound of the distance beyond contact
};
// `checks` fills a gap of the layout, because batches of answers cost memory.
static_assert(sizeof(Answer) == 4 * sizeof(double));

/// The promise of a method about its answers.
enum class Promise : std::uint8_t {
  none,          ///< wrong answers of all kinds occur
  conservative,  ///< no false negative, no late time of impact; false positives occur
  exact,         ///< no wrong answer at all
};

/// The meaning of a method's times of impact.
enum class Times : std::uint8_t {
  bounds,     ///< toi_lower and toi_upper enclose the exact time
  estimates,  ///< the exact time is within Terms::time_error of toi_lower (or of toi_upper alone)
  none,       ///< the verdict alone counts
};

/// By CellKind: true of all.
inline constexpr auto all_cells = [] {
  std::array<bool, cell_records.size()> result{};
  result.fill(true);
  return result;
}();

/// The terms of a promise: the queries and the times that it covers. Other queries are not asked,
/// and their answers are no faults.
struct Terms {
  /// By ContactKind, of the first two, and by CellKind: true if it answers these queries.
  std::array<bool, contact_kinds.size()> contacts{true, true};
  std::array<bool, cell_records.size()> cells{};
  bool straight = true;  ///< It answers queries on straight lines.
  /// The degrees of the other curves that it answers, of contacts; none unless least ≤ most.
  std::size_t least_degree = 1;
  std::size_t most_degree = 0;
  bool rational = false;  ///< It answers rational ones, too.
  /// The least distance at t=0 beyond the minimum separation, exclusive; nothing: any distance.
  /// Cells must have a positive volume at t=0, unless there is nothing here.
  std::optional<double> starts_apart = std::nullopt;
  /// True if it takes coordinates in single precision: queries are rounded first.
  bool float_coordinates = false;
  Times times = Times::bounds;
  double time_error = 1e-6;  ///< of estimates, in units of the step; not negative

  /// Lets it answer the queries of a kind. \pre the kind is one of all_kinds
  void add(AnyKind kind) {
    (kind.is_cell() ? cells[static_cast<std::size_t>(kind.cell())] : contacts[kind.number()]) =
        true;
  }
  [[nodiscard]] bool answers(AnyKind kind) const {
    if (kind.is_cell()) return cells[static_cast<std::size_t>(kind.cell())];
    return kind.number() < contacts.size() && contacts[kind.number()];
  }
  [[nodiscard]] bool answers(const AnyShape& shape) const {
    if (!answers(shape.kind)) return false;
    if (shape.is_straight()) return straight;
    if (shape.kind.is_cell()) return false;
    return least_degree <= shape.degree && shape.degree <= most_degree &&
           (rational || !shape.is_rational);
  }
  friend bool operator==(const Terms&, const Terms&) = default;
};

/// The common options of methods. A method ignores the options that do not apply to it.
struct MethodOptions {
  double tolerance = 1e-6;              ///< of tolerance-driven methods: Tight-Inclusion's δ
  std::int64_t max_checks = 1'000'000;  ///< of iterative methods: Tight-Inclusion's m_I; ≤ 0: none
  /// The distance at which primitives are in contact. A method that supports L∞ alone is
  /// conservative for L2. At distance 0, too, the claim of an answer with a tolerance is a distance
  /// in this norm.
  Separation separation = {};
  double t_max = 1.0;  ///< only impacts up to this time count (0 to 1)
};

/// A function as error_filter().
using ErrorFilter = std::array<double, 3> (*)(ContactKind kind, const std::array<double, 3>& x_max,
                                              double distance);

/// The description of a method, for the registry, reports and help.
struct MethodInfo {
  /// The name on the command line: unique, snake_case.
  std::string_view name;
  Promise promise = Promise::none;
  Terms terms = {};
  /// The key in docs/references.bib of the work that describes it; empty if there is none.
  std::string_view reference = {};
  /// True for a published method that is here for comparison, with its known errors.
  bool is_baseline = false;
  /// The name of the method of which this is a variant with other settings, for comparison; empty
  /// if it is none.
  std::string_view variant_of = {};
  /// The norms of the minimum separations that it supports; empty if it supports distance 0 alone.
  std::vector<Norm> norms = {};
  /// True if it searches down to MethodOptions::tolerance.
  bool is_tolerance_driven = false;
  /// The limit of checks in comparisons with other methods: lower for slow searches.
  std::int64_t usual_max_checks = MethodOptions{}.max_checks;
  /// The filter that its tolerances do not include: a yes claims a distance of at most its
  /// tolerance plus twice this filter. Without one, of at most its tolerance (docs/theory.md,
  /// section 7.3).
  ErrorFilter filter = nullptr;

  [[nodiscard]] bool measures_in(Norm norm) const {
    return std::ranges::find(norms, norm) != norms.end();
  }
};

/// A solver. Thread-safe.
class Method {
 public:
  Method() = default;
  Method(const Method&) = delete;
  Method& operator=(const Method&) = delete;
  Method(Method&&) = delete;
  Method& operator=(Method&&) = delete;
  virtual ~Method() = default;

  /// The description. It never changes; its texts live as long as the method.
  [[nodiscard]] virtual const MethodInfo& info() const = 0;
  [[nodiscard]] std::string_view name() const { return info().name; }
  [[nodiscard]] Promise promise() const { return info().promise; }

  /// Answers query i in answers[i], in this thread.
  /// \pre as many answers as queries; info().terms.answers(queries).
  /// \throws std::invalid_argument for options that the method refuses; std::runtime_error if the
  /// arithmetic violates its assumptions; std::bad_alloc.
  virtual void solve(const AnyQueries& queries, std::span<Answer> answers,
                     const MethodOptions& options) const = 0;
};

/// The description of the certified solver as a method: its name is `certified`, its promise exact.
[[nodiscard]] const MethodInfo& certified_info();

/// The certified solver as a method.
[[nodiscard]] std::unique_ptr<Method> certified_method(const CertifiedOptions& base = {});

/// Tight-Inclusion as a method, `tight_inclusion`, of the base's kernel.
[[nodiscard]] std::unique_ptr<Method> tight_inclusion_method(
    const TightInclusionOptions& base = {});

}  // namespace touchstone::fast
