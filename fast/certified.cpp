#include "touchstone/certified.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "fast/cells/decision.hpp"
#include "fast/certified/block.hpp"
#include "fast/certified/curves.hpp"
#include "fast/kernels.hpp"
#include "fast/method.hpp"
#include "fast/platform/floating_point_state.hpp"

namespace touchstone::fast {
namespace {

/// Decides a block and passes on the results of queries that may have a contact: report(index,
/// result). \pre the kind is vertex_face or edge_edge
template <class Report>
void decide(const Queries& block, const CertifiedOptions& options, const CertifiedKernel& kernel,
            const Report& report) {
  if (!block.is_straight()) {
    decide_curves(block, options.t_max, options, kernel, report);
    return;
  }
  const std::span<const Query> queries = block.straight();
  decide_block(
      {.kind = block.kind, .count = queries.size(), .queries = queries.data()}, options.t_max,
      options, kernel, [&](std::size_t index) -> const Query& { return queries[index]; }, report);
}

/// Decides a query on straight lines.
CertifiedResult solve_one(ContactKind kind, const Query& query, const CertifiedOptions& options) {
  if (decided_as(kind) != kind) {
    return solve_one(decided_as(kind), decided_query(kind, query), options);
  }
  const StrictFloatingPoint strict;
  CertifiedResult result{.verdict = Verdict::no};
  decide(Queries(kind, std::span(&query, 1)), options, certified_kernel_for_one(options.kernels),
         [&](std::size_t, const CertifiedResult& found) { result = found; });
  return result;
}

void set(CertifiedResult& to, const CertifiedResult& result) { to = result; }
void set(Answer& to, const CertifiedResult& result) {
  to = {.verdict = result.verdict, .toi_lower = result.toi_lower, .toi_upper = result.toi_upper};
}

/// Decides query i in items[i], a result or an answer.
template <class Item>
void solve_blocks(const Queries& given, std::span<Item> items, const CertifiedOptions& options) {
  require_valid(options);
  if (items.size() != given.size()) {
    throw std::invalid_argument("solve: " + std::to_string(items.size()) + " results for " +
                                std::to_string(given.size()) + " queries");
  }
  if (items.size() == 1 && given.is_straight()) {
    set(items[0], solve_one(given.kind, given.straight()[0], options));
    return;
  }
  std::vector<double> memory;
  const Queries queries = decided_queries(given, memory);
  const CertifiedKernel& kernel = certified_kernel(options.kernels);
  const std::size_t blocks_a_task = queries.is_straight() ? 8 : 1;
  for_each_kernel_block(items.size(), options.max_threads, blocks_a_task, [&](std::size_t first) {
    const std::size_t count = std::min(kernel_block, items.size() - first);
    const std::span<Item> of_block = items.subspan(first, count);
    std::ranges::fill(of_block, Item{.verdict = Verdict::no});
    decide(queries.part(first, count), options, kernel,
           [&](std::size_t index, const CertifiedResult& result) { set(of_block[index], result); });
  });
}

}  // namespace

// ---- Interface ----------------------------------------------------------------------------------

CertifiedResult solve(ContactKind kind, const Query& query, const CertifiedOptions& options) {
  require_valid(options);
  return solve_one(kind, query, options);
}

void solve(const Queries& queries, std::span<CertifiedResult> results,
           const CertifiedOptions& options) {
  solve_blocks(queries, results, options);
}

namespace {

class CertifiedMethod : public Method {
 public:
  explicit CertifiedMethod(const CertifiedOptions& base) : base_(base) { require_valid(base); }

  [[nodiscard]] const MethodInfo& info() const override { return certified_info(); }

  void solve(const AnyQueries& queries, std::span<Answer> answers,
             const MethodOptions& options) const override {
    if (queries.kind.is_cell()) {
      std::ranges::fill(answers, Answer{.verdict = Verdict::no});
      for_each_inversion(queries.as(queries.kind.cell()),
                         {.toi_tolerance = base_.toi_tolerance,
                          .t_max = options.t_max,
                          .max_threads = 1,
                          .kernels = base_.kernels},
                         [&](std::size_t i, const Inversion& found) {
                           answers[i] = {.verdict = found.verdict,
                                         .toi_lower = found.toi_lower,
                                         .toi_upper = found.toi_upper};
                         });
      return;
    }
    if (!is_valid(options.separation)) {
      std::ranges::fill(answers, Answer{.verdict = Verdict::error});
      return;
    }
    CertifiedOptions of_call = base_;
    of_call.t_max = options.t_max;
    of_call.max_threads = 1;
    of_call.separation = options.separation;
    solve_blocks(queries.as(queries.kind.contact()), answers, of_call);
  }

 private:
  CertifiedOptions base_;
};

}  // namespace

const MethodInfo& certified_info() {
  static const MethodInfo info{
      .name = "certified",
      .promise = Promise::exact,
      .terms = {.cells = all_cells, .most_degree = greatest_degree, .rational = true},
      .norms = {Norm::linf, Norm::l2}};
  return info;
}

std::unique_ptr<Method> certified_method(const CertifiedOptions& base) {
  return std::make_unique<CertifiedMethod>(base);
}

}  // namespace touchstone::fast
