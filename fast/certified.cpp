#include "touchstone/certified.hpp"

#include <algorithm>
#include <stdexcept>

#include "fast/certified/block.hpp"
#include "fast/kernels.hpp"
#include "fast/method.hpp"
#include "fast/platform/threads.hpp"

namespace touchstone::fast {
namespace {

// ---- Queries ------------------------------------------------------------------------------------

/// The queries of a batch, in one of two forms.
struct Batch {
  Kind kind = Kind::vertex_face;
  std::size_t size = 0;
  std::span<const Query> queries;            ///< either queries
  const MovingVertices* vertices = nullptr;  ///< or vertices
  Candidates candidates;                     ///< with candidates
  const CertifiedKernel& kernel = certified_kernel(chosen_kernels());

  [[nodiscard]] KernelInput block(std::size_t first) const {
    KernelInput input{.kind = kind, .count = std::min(kernel_block, size - first)};
    if (vertices == nullptr) {
      input.queries = queries.data() + first;
    } else {
      input.vertices = vertices->data();
      input.edges = candidates.edges.data();
      input.faces = candidates.faces.data();
      input.pairs = candidates.pairs.data() + first;
    }
    return input;
  }

  [[nodiscard]] Query query(std::size_t i) const {
    return vertices == nullptr ? queries[i] : query_of(*vertices, candidates, candidates.pairs[i]);
  }
};

Batch batch_of(Kind kind, std::span<const Query> queries) {
  return {.kind = kind, .size = queries.size(), .queries = queries, .candidates = {}};
}

Batch batch_of(const MovingVertices& vertices, const Candidates& candidates) {
  require_in_range(vertices, candidates);
  return {.kind = candidates.kind,
          .size = candidates.pairs.size(),
          .queries = {},
          .vertices = &vertices,
          .candidates = candidates};
}

// ---- A block ------------------------------------------------------------------------------------

/// Decides the block that begins at `first`, ignoring contacts after t_limit, and passes on the
/// results of queries that may have a contact: report(number, result).
template <class Report>
const KernelOutput& decide(const Batch& batch, std::size_t first, double t_limit,
                           const CertifiedOptions& options, const Report& report) {
  return decide_block(
      batch.block(first), t_limit, options, batch.kernel,
      [&](std::size_t index) { return batch.query(first + index); },
      [&](std::size_t index, const CertifiedResult& result) { report(first + index, result); });
}

/// Calls body(first) for each block, in the allowed number of threads.
template <class Body>
void for_each_block(std::size_t size, int max_threads, const Body& body) {
  constexpr std::size_t blocks_a_task = 8;
  for_each_kernel_block(size, max_threads, blocks_a_task, body);
}

void solve(const Batch& batch, std::span<CertifiedResult> results,
           const CertifiedOptions& options) {
  require_valid(options);
  if (results.size() != batch.size) {
    throw std::invalid_argument("certified: as many results as queries are needed");
  }
  for_each_block(batch.size, options.max_threads, [&](std::size_t first) {
    const std::size_t count = std::min(kernel_block, batch.size - first);
    const std::span<CertifiedResult> of_block = results.subspan(first, count);
    std::ranges::fill(of_block, CertifiedResult{.verdict = Verdict::no, .stage = Stage::axis});
    const KernelOutput& output = decide(
        batch, first, options.t_max, options,
        [&](std::size_t number, const CertifiedResult& result) { results[number] = result; });
    mark_stages(output, [&](std::size_t index, Stage stage) { of_block[index].stage = stage; });
  });
}

// ---- Collisions ---------------------------------------------------------------------------------

/// Appends the block's collisions, in order.
void collect(const Batch& batch, std::size_t first, const CertifiedOptions& options,
             std::vector<Collision>& found) {
  const auto before = static_cast<std::ptrdiff_t>(found.size());
  decide(batch, first, options.t_max, options,
         [&](std::size_t number, const CertifiedResult& result) {
           if (result.verdict != Verdict::no) found.push_back({number, result});
         });
  std::ranges::sort(found.begin() + before, found.end(), {}, &Collision::candidate);
}

std::vector<Collision> collisions(const Batch& batch, const CertifiedOptions& options) {
  require_valid(options);
  std::vector<Collision> all;
  if (options.max_threads == 1) {
    for_each_block(batch.size, 1, [&](std::size_t first) { collect(batch, first, options, all); });
    return all;
  }
  tbb::enumerable_thread_specific<std::vector<Collision>> of_threads;
  for_each_block(batch.size, options.max_threads,
                 [&](std::size_t first) { collect(batch, first, options, of_threads.local()); });
  for (const std::vector<Collision>& some : of_threads) {
    all.insert(all.end(), some.begin(), some.end());
  }
  std::ranges::sort(all, {}, &Collision::candidate);
  return all;
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
  CertifiedResult result;
  solve(batch_of(kind, std::span(&query, 1)), std::span(&result, 1), options);
  return result;
}

void solve(Kind kind, std::span<const Query> queries, std::span<CertifiedResult> results,
           const CertifiedOptions& options) {
  solve(batch_of(kind, queries), results, options);
}

std::vector<Collision> collisions(Kind kind, std::span<const Query> queries,
                                  const CertifiedOptions& options) {
  return collisions(batch_of(kind, queries), options);
}

std::vector<Collision> collisions(const MovingVertices& vertices, const Candidates& candidates,
                                  const CertifiedOptions& options) {
  return collisions(batch_of(vertices, candidates), options);
}

namespace {

/// The number of stages of a query that this one decides.
constexpr std::uint32_t stages_up_to(Stage stage) { return static_cast<std::uint32_t>(stage) + 1; }

std::vector<std::string_view> stage_names() {
  std::vector<std::string_view> names;
  for (std::size_t i = 0; i < stages; ++i) names.push_back(to_string(static_cast<Stage>(i)));
  return names;
}

class CertifiedMethod : public Method {
 public:
  explicit CertifiedMethod(const CertifiedOptions& base) : base_(base) { require_valid(base); }

  [[nodiscard]] const MethodInfo& info() const override { return certified_info(); }

  void solve(Kind kind, std::span<const Query> queries, std::span<Answer> answers,
             const MethodOptions& options) const override {
    CertifiedOptions of_call = base_;
    of_call.t_max = options.t_max;
    of_call.max_threads = 1;
    of_call.separation = options.separation;
    if (!is_valid(of_call.separation)) {
      std::ranges::fill(answers, Answer{.verdict = Verdict::error});
      return;
    }
    require_valid(of_call);
    const UseKernels use(kernels_);
    const Batch batch = batch_of(kind, queries);
    for_each_block(batch.size, of_call.max_threads, [&](std::size_t first) {
      const std::size_t count = std::min(kernel_block, batch.size - first);
      const std::span<Answer> of_block = answers.subspan(first, count);
      std::ranges::fill(of_block,
                        Answer{.verdict = Verdict::no, .checks = stages_up_to(Stage::axis)});
      const auto take = [&](std::size_t number, const CertifiedResult& result) {
        answers[number] = {.verdict = result.verdict,
                           .checks = stages_up_to(result.stage),
                           .toi_lower = result.toi_lower,
                           .toi_upper = result.toi_upper,
                           .tolerance = Answer::none};
      };
      mark_stages(
          decide(batch, first, of_call.t_max, of_call, take),
          [&](std::size_t index, Stage stage) { of_block[index].checks = stages_up_to(stage); });
    });
  }

 private:
  CertifiedOptions base_;
  Kernels kernels_ = chosen_kernels();
};

}  // namespace

const MethodInfo& certified_info() {
  static const MethodInfo info{.name = "certified",
                               .promise = Promise::exact,
                               .norms = {Norm::linf, Norm::l2},
                               .stages = stage_names()};
  return info;
}

std::unique_ptr<Method> certified_method(const CertifiedOptions& base) {
  return std::make_unique<CertifiedMethod>(base);
}

}  // namespace touchstone::fast
