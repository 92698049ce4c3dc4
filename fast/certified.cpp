#include "touchstone/certified.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "fast/certified/block.hpp"
#include "fast/certified/curves.hpp"
#include "fast/kernels.hpp"
#include "fast/method.hpp"
#include "fast/platform/floating_point_state.hpp"
#include "touchstone/element.hpp"

namespace touchstone::fast {
namespace {

/// The result of queries that no stage reports.
constexpr CertifiedResult result_of_no(Kind kind) {
  return is_element(kind) ? free_of_inversion : CertifiedResult{.verdict = Verdict::no};
}

void require_element(const QueryShape& shape, const CertifiedOptions& options) {
  if (shape.is_straight() && is_zero(options.separation)) return;
  throw std::invalid_argument("solve: an element moves on straight lines, without a separation");
}

/// Decides a block and passes on the results of queries that may have a contact: report(index,
/// result).
template <class Report>
void decide(const Queries& block, const CertifiedOptions& options, const CertifiedKernel& kernel,
            const Report& report) {
  if (is_element(block.kind)) {
    require_element(block, options);
  } else if (!block.is_straight()) {
    decide_curves(block, options.t_max, options, kernel, report);
    return;
  }
  const std::span<const Query> queries = block.straight();
  const KernelInput input{.kind = block.kind, .count = queries.size(), .queries = queries.data()};
  if (is_element(block.kind)) {
    decide_elements(
        input, options.t_max, options, kernel,
        [&](std::size_t index) { return to_tetrahedron(block.kind, queries[index]); }, report);
  } else {
    decide_block(
        input, options.t_max, options, kernel,
        [&](std::size_t index) -> const Query& { return queries[index]; }, report);
  }
}

/// Decides a query on straight lines.
CertifiedResult solve_one(Kind kind, const Query& query, const CertifiedOptions& options) {
  const StrictFloatingPoint strict;
  CertifiedResult result = result_of_no(kind);
  // Elements take the widest lanes, which have registers for all vectors.
  decide(Queries(kind, std::span(&query, 1)), options,
         is_element(kind) ? certified_kernel(options.kernels)
                          : certified_kernel_for_one(options.kernels),
         [&](std::size_t, const CertifiedResult& found) { result = found; });
  return result;
}

void set(CertifiedResult& to, const CertifiedResult& result) { to = result; }
void set(Answer& to, const CertifiedResult& result) {
  to = {.verdict = result.verdict, .toi_lower = result.toi_lower, .toi_upper = result.toi_upper};
}

/// Decides query i in items[i], a result or an answer.
template <class Item>
void solve_blocks(const Queries& queries, std::span<Item> items, const CertifiedOptions& options) {
  require_valid(options);
  if (items.size() != queries.size()) {
    throw std::invalid_argument("solve: " + std::to_string(items.size()) + " results for " +
                                std::to_string(queries.size()) + " queries");
  }
  if (items.size() == 1 && queries.is_straight()) {
    set(items[0], solve_one(queries.kind, queries.straight()[0], options));
    return;
  }
  Item free;
  set(free, result_of_no(queries.kind));
  const CertifiedKernel& kernel = certified_kernel(options.kernels);
  const std::size_t blocks_a_task = queries.is_straight() ? 8 : 1;
  for_each_kernel_block(items.size(), options.max_threads, blocks_a_task, [&](std::size_t first) {
    const std::size_t count = std::min(kernel_block, items.size() - first);
    const std::span<Item> of_block = items.subspan(first, count);
    std::ranges::fill(of_block, free);
    decide(queries.part(first, count), options, kernel,
           [&](std::size_t index, const CertifiedResult& result) { set(of_block[index], result); });
  });
}

}  // namespace

// ---- Interface ----------------------------------------------------------------------------------

CertifiedResult solve(Kind kind, const Query& query, const CertifiedOptions& options) {
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

  void solve(const Queries& queries, std::span<Answer> answers,
             const MethodOptions& options) const override {
    if (!is_valid(options.separation)) {
      std::ranges::fill(answers, Answer{.verdict = Verdict::error});
      return;
    }
    CertifiedOptions of_call = base_;
    of_call.t_max = options.t_max;
    of_call.max_threads = 1;
    of_call.separation = options.separation;
    solve_blocks(queries, answers, of_call);
  }

 private:
  CertifiedOptions base_;
};

}  // namespace

const MethodInfo& certified_info() {
  static const MethodInfo info{.name = "certified",
                               .promise = Promise::exact,
                               .terms = {.kinds = {true, true, true, true},
                                         .most_degree = greatest_degree,
                                         .rational = true},
                               .norms = {Norm::linf, Norm::l2}};
  return info;
}

std::unique_ptr<Method> certified_method(const CertifiedOptions& base) {
  return std::make_unique<CertifiedMethod>(base);
}

}  // namespace touchstone::fast
