#include "touchstone/certified.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "fast/candidates.hpp"
#include "fast/certified/block.hpp"
#include "fast/certified/curves.hpp"
#include "fast/kernels.hpp"
#include "fast/method.hpp"
#include "fast/platform/floating_point_state.hpp"
#include "fast/platform/threads.hpp"
#include "touchstone/element.hpp"

namespace touchstone::fast {
namespace {

// ---- Queries ------------------------------------------------------------------------------------

/// The queries of a batch, in one of two forms.
struct Batch {
  Queries queries;                           ///< either queries
  const MovingVertices* vertices = nullptr;  ///< or vertices
  Candidates candidates = {};                ///< with candidates
  const CertifiedKernel& kernel = certified_kernel(chosen_kernels());

  [[nodiscard]] std::size_t size() const {
    return vertices == nullptr ? queries.size() : candidates.pairs.size();
  }

  /// A block of queries on straight lines.
  [[nodiscard]] KernelInput block(std::size_t first, std::size_t count) const {
    KernelInput input{.kind = queries.kind, .count = count};
    if (vertices == nullptr) {
      input.queries = queries.straight().data() + first;
    } else {
      input.kind = candidates.kind;
      input.vertices = vertices->data();
      input.edges = candidates.edges.data();
      input.faces = candidates.faces.data();
      input.pairs = candidates.pairs.data() + first;
    }
    return input;
  }

  [[nodiscard]] Query query(std::size_t i) const {
    return vertices == nullptr ? queries.straight()[i]
                               : query_of(*vertices, candidates, candidates.pairs[i]);
  }
};

// ---- Elements -----------------------------------------------------------------------------------

/// The result of queries that no stage reports.
constexpr CertifiedResult result_of_no(Kind kind) {
  if (is_element(kind)) return free_of_inversion;
  return {.verdict = Verdict::no, .stage = Stage::axis};
}

void require_element(const QueryShape& shape, const CertifiedOptions& options) {
  if (shape.is_straight() && is_zero(options.separation)) return;
  throw std::invalid_argument("solve: an element moves on straight lines, without a separation");
}

// ---- Blocks -------------------------------------------------------------------------------------

/// Decides the block that begins at `first` and passes on the results of queries that may have a
/// contact: report(number, result).
template <class Report>
const KernelOutput& decide(const Batch& batch, std::size_t first, const CertifiedOptions& options,
                           const Report& report) {
  const std::size_t count = std::min(kernel_block, batch.size() - first);
  const auto report_of_block = [&](std::size_t index, const CertifiedResult& result) {
    report(first + index, result);
  };
  if (is_element(batch.queries.kind)) {
    static const KernelOutput none_by_stage{};
    require_element(batch.queries, options);
    decide_elements(
        batch.block(first, count), options.t_max, options, batch.kernel,
        [&](std::size_t index) {
          return to_tetrahedron(batch.queries.kind, batch.query(first + index));
        },
        report_of_block);
    return none_by_stage;
  }
  if (batch.queries.is_straight()) {
    return decide_block(
        batch.block(first, count), options.t_max, options, batch.kernel,
        [&](std::size_t index) { return batch.query(first + index); }, report_of_block);
  }
  const Queries block = batch.queries.part(first, count);
  const KernelOutput& output = search_curves(block, options, batch.kernel);
  report_contacts(
      output, options, [&](std::size_t index) { return decided_exactly(block, index, options); },
      report_of_block);
  return output;
}

/// Calls body(first) for each block, in the allowed number of threads.
template <class Body>
void for_each_block(const Batch& batch, int max_threads, const Body& body) {
  const std::size_t blocks_a_task = batch.queries.is_straight() ? 8 : 1;
  for_each_kernel_block(batch.size(), max_threads, blocks_a_task, body);
}

// ---- Results and answers ------------------------------------------------------------------------

void set_stage(CertifiedResult& to, Stage stage) { to.stage = stage; }
/// Counts the stages that the query went through.
void set_stage(Answer& to, Stage stage) { to.checks = static_cast<std::uint32_t>(stage) + 1; }

void set(CertifiedResult& to, const CertifiedResult& result) { to = result; }
void set(Answer& to, const CertifiedResult& result) {
  to = {.verdict = result.verdict, .toi_lower = result.toi_lower, .toi_upper = result.toi_upper};
  set_stage(to, result.stage);
}

/// Decides a query on straight lines.
CertifiedResult solve_one(Kind kind, const Query& query, const CertifiedOptions& options) {
  const StrictFloatingPoint strict;
  CertifiedResult result = result_of_no(kind);
  const auto one = [&] { return KernelInput{.kind = kind, .count = 1, .queries = &query}; };
  const auto take = [&](std::size_t, const CertifiedResult& found) { result = found; };
  if (is_element(kind)) {
    require_element({.kind = kind}, options);
    // The widest lanes: they have registers for all vectors.
    decide_elements(
        one(), options.t_max, options, certified_kernel(chosen_kernels()),
        [&](std::size_t) { return to_tetrahedron(kind, query); }, take);
    return result;
  }
  const KernelOutput& output = decide_block(
      one(), options.t_max, options, certified_kernel_for_one(chosen_kernels()),
      [&](std::size_t) -> const Query& { return query; }, take);
  mark_stages(output, [&](std::size_t, Stage stage) { result.stage = stage; });
  return result;
}

/// Decides query i in items[i], a result or an answer.
template <class Item>
void solve_blocks(const Batch& batch, std::span<Item> items, const CertifiedOptions& options) {
  require_valid(options);
  if (items.size() != batch.size()) {
    throw std::invalid_argument("solve: " + std::to_string(items.size()) + " results for " +
                                std::to_string(batch.size()) + " queries");
  }
  const QueryShape& shape = batch.queries;
  if (items.size() == 1 && shape.is_straight()) {
    set(items[0], solve_one(shape.kind, batch.queries.straight()[0], options));
    return;
  }
  Item free;
  set(free, result_of_no(shape.kind));
  for_each_block(batch, options.max_threads, [&](std::size_t first) {
    const std::size_t count = std::min(kernel_block, items.size() - first);
    const std::span<Item> of_block = items.subspan(first, count);
    std::ranges::fill(of_block, free);
    const auto take = [&](std::size_t number, const CertifiedResult& result) {
      set(items[number], result);
    };
    mark_stages(decide(batch, first, options, take),
                [&](std::size_t index, Stage stage) { set_stage(of_block[index], stage); });
  });
}

// ---- Collisions ---------------------------------------------------------------------------------

/// Appends the block's collisions, and the queries that are an error, in order.
void collect(const Batch& batch, std::size_t first, const CertifiedOptions& options,
             std::vector<Collision>& found) {
  const auto before = static_cast<std::ptrdiff_t>(found.size());
  decide(batch, first, options, [&](std::size_t number, const CertifiedResult& result) {
    if (result.verdict != Verdict::no) found.push_back({number, result});
  });
  std::ranges::sort(found.begin() + before, found.end(), {}, &Collision::candidate);
}

std::vector<Collision> all_collisions(const Batch& batch, const CertifiedOptions& options) {
  std::vector<Collision> all;
  if (options.max_threads == 1) {
    for_each_block(batch, 1, [&](std::size_t first) { collect(batch, first, options, all); });
    return all;
  }
  tbb::enumerable_thread_specific<std::vector<Collision>> of_threads;
  for_each_block(batch, options.max_threads,
                 [&](std::size_t first) { collect(batch, first, options, of_threads.local()); });
  for (const std::vector<Collision>& some : of_threads) {
    all.insert(all.end(), some.begin(), some.end());
  }
  std::ranges::sort(all, {}, &Collision::candidate);
  return all;
}

std::vector<Collision> collisions(const Batch& batch, const CertifiedOptions& options) {
  require_valid(options);
  std::vector<Collision> all = all_collisions(batch, options);
  const auto bad = std::ranges::find(all, Verdict::error,
                                     [](const Collision& one) { return one.result.verdict; });
  if (bad == all.end()) return all;
  throw std::domain_error(
      "collisions: query " + std::to_string(bad->candidate) + ": a coordinate is not finite" +
      (batch.queries.is_rational ? ", or a weight is not positive and finite" : ""));
}

}  // namespace

// ---- Interface ----------------------------------------------------------------------------------

std::string_view to_string(Stage stage) {
  switch (stage) {
    case Stage::axis:
      return "axis";
    case Stage::direction:
      return "direction";
    case Stage::determinant:
      return "determinant";
    case Stage::bisection:
      return "bisection";
    case Stage::exact:
      break;
  }
  return "exact";
}

CertifiedResult solve(Kind kind, const Query& query, const CertifiedOptions& options) {
  require_valid(options);
  return solve_one(kind, query, options);
}

void solve(const Queries& queries, std::span<CertifiedResult> results,
           const CertifiedOptions& options) {
  solve_blocks(Batch{.queries = queries}, results, options);
}

void solve(Kind kind, std::span<const Query> queries, std::span<CertifiedResult> results,
           const CertifiedOptions& options) {
  solve(Queries(kind, queries), results, options);
}

std::vector<Collision> collisions(const Queries& queries, const CertifiedOptions& options) {
  return collisions(Batch{.queries = queries}, options);
}

std::vector<Collision> collisions(Kind kind, std::span<const Query> queries,
                                  const CertifiedOptions& options) {
  return collisions(Queries(kind, queries), options);
}

std::vector<Collision> collisions(const MovingVertices& vertices, const Candidates& candidates,
                                  const CertifiedOptions& options) {
  require_contact(candidates.kind);
  return collisions(Batch{.queries = {}, .vertices = &vertices, .candidates = candidates}, options);
}

namespace {

std::vector<std::string_view> stage_names() {
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < stage_count; ++i) names.push_back(to_string(static_cast<Stage>(i)));
  return names;
}

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
    const UseKernels use(kernels_);
    solve_blocks(Batch{.queries = queries}, answers, of_call);
  }

 private:
  CertifiedOptions base_;
  Kernels kernels_ = chosen_kernels();
};

}  // namespace

const MethodInfo& certified_info() {
  static const MethodInfo info{.name = "certified",
                               .promise = Promise::exact,
                               .terms = {.kinds = {true, true, true, true},
                                         .most_degree = greatest_degree,
                                         .rational = true},
                               .norms = {Norm::linf, Norm::l2},
                               .stages = stage_names()};
  return info;
}

std::unique_ptr<Method> certified_method(const CertifiedOptions& base) {
  return std::make_unique<CertifiedMethod>(base);
}

}  // namespace touchstone::fast
