#include "touchstone/inversion.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>

#include "fast/candidates.hpp"
#include "fast/certified/block.hpp"
#include "fast/certified/exact/exact_stage.hpp"
#include "fast/certified/kernel.hpp"
#include "fast/certified/rescaling.hpp"
#include "fast/kernels.hpp"
#include "fast/platform/floating_point_state.hpp"

namespace touchstone::fast {
namespace {

// ---- Elements -----------------------------------------------------------------------------------

Query points_of(const KernelInput& input, std::span<const std::int32_t> numbers) {
  Query query;
  for (std::size_t point = 0; point < numbers.size(); ++point) {
    const MovingVertex& vertex = input.vertices[static_cast<std::size_t>(numbers[point])];
    for (std::size_t axis = 0; axis < 3; ++axis) {
      query.at(0, point, axis) = vertex.start[axis];
      query.at(1, point, axis) = vertex.end[axis];
    }
  }
  return query;
}

/// Element i as a tetrahedron.
Query tetrahedron(const KernelInput& input, std::size_t i) {
  if (input.triangles != nullptr) return to_tetrahedron(input.triangles[i]);
  if (input.tetrahedra != nullptr) return points_of(input, input.tetrahedra[i]);
  if (input.faces != nullptr)
    return to_tetrahedron(to_plane_triangle(points_of(input, input.faces[i])));
  return input.queries[i];
}

/// The block that begins at `first`, of all elements.
KernelInput block_at(const KernelInput& all, std::size_t size, std::size_t first) {
  KernelInput block = all;
  block.count = std::min(kernel_block, size - first);
  const auto advance = [&](auto& pointer) {
    if (pointer != nullptr) pointer += first;
  };
  advance(block.queries);
  advance(block.triangles);
  advance(block.tetrahedra);
  advance(block.faces);
  return block;
}

// ---- Blocks -------------------------------------------------------------------------------------

void require_valid(const InversionOptions& options) {
  fast::require_valid(CertifiedOptions{.toi_tolerance = options.toi_tolerance,
                                       .t_max = options.t_max,
                                       .max_threads = options.max_threads});
  // NaN fails, too.
  if (!(options.kept_volume >= 0.0 && options.kept_volume < 1.0)) {
    throw std::invalid_argument("inversions: kept_volume must be in [0,1)");
  }
}

constexpr InversionResult free_of_inversion{
    .verdict = Verdict::no, .stage = Stage::determinant, .start = 1};

InversionResult decided_exactly(const Query& query, const InversionOptions& options) {
  if (!is_finite(query)) return {};
  const ExactInversion found = decide_inversion_exactly(query, options.t_max, options.kept_volume);
  InversionResult result{.verdict = found.inverts ? Verdict::yes : Verdict::no,
                         .stage = Stage::exact,
                         .start = static_cast<std::int8_t>(found.start)};
  if (!found.inverts) return result;
  result.toi_lower = found.toi_lower;
  result.toi_upper = found.toi_upper;
  return result;
}

/// The result of the first time of an element with a positive volume at t=0, as of a contact.
InversionResult result_of(const CertifiedResult& contact) {
  return {.verdict = contact.verdict,
          .stage = Stage::bisection,
          .start = 1,
          .toi_lower = contact.toi_lower,
          .toi_upper = contact.toi_upper};
}

/// Decides a block, ignoring inversions after t_limit, and passes on the results that are not
/// free_of_inversion: report(index, result). \pre strict floating point
template <class Report>
void decide_block(KernelInput block, double t_limit, const InversionOptions& options,
                  const CertifiedKernel& kernel, const Report& report) {
  thread_local KernelOutput output;
  const CertifiedOptions for_impacts{.toi_tolerance = options.toi_tolerance,
                                     .t_max = options.t_max};
  block.toi_tolerance = std::max(options.toi_tolerance, least_kernel_tolerance);
  block.t_limit = t_limit;
  block.kept_volume = options.kept_volume;
  kernel.invert(block, output);
  if (output.undecided.count > 0) {
    thread_local std::vector<Query> undecided;
    undecided.clear();
    for (std::size_t i = 0; i < output.undecided.count; ++i) {
      undecided.push_back(tetrahedron(block, output.undecided.items[i]));
    }
    decide_rescaled({.toi_tolerance = block.toi_tolerance,
                     .t_limit = block.t_limit,
                     .kept_volume = block.kept_volume},
                    *kernel.invert, undecided, output);
  }
  const auto report_exact = [&](std::size_t index) {
    report(index, decided_exactly(tetrahedron(block, index), options));
  };
  for (std::size_t i = 0; i < output.one_sided.count; ++i) {
    report(output.one_sided.items[i], InversionResult{.verdict = Verdict::yes,
                                                      .stage = Stage::determinant,
                                                      .start = -1,
                                                      .toi_lower = 0.0,
                                                      .toi_upper = 0.0});
  }
  for (std::size_t i = 0; i < output.rejected.count; ++i) {
    report(output.rejected.items[i], result_of(CertifiedResult{.verdict = Verdict::no}));
  }
  for (std::size_t i = 0; i < output.impacts.count; ++i) {
    const KernelImpact& impact = output.impacts.items[i];
    if (const auto contact = fast::result_of(impact, for_impacts)) {
      report(impact.index, result_of(*contact));
    } else {
      report_exact(impact.index);
    }
  }
  for (std::size_t i = 0; i < output.undecided.count; ++i) report_exact(output.undecided.items[i]);
}

InversionResult decide_one(const KernelInput& element, const InversionOptions& options) {
  require_valid(options);
  const StrictFloatingPoint strict;
  InversionResult result = free_of_inversion;
  // The widest lanes for one, too: they have registers for all vectors.
  decide_block(element, options.t_max, options, certified_kernel(chosen_kernels()),
               [&](std::size_t, const InversionResult& found) { result = found; });
  return result;
}

/// So many blocks at once in one thread.
constexpr std::size_t blocks_of_task = 8;

void decide_all(const KernelInput& all, std::size_t size, std::span<InversionResult> results,
                const InversionOptions& options) {
  require_valid(options);
  if (results.size() != size) {
    throw std::invalid_argument("inversions: " + std::to_string(results.size()) + " results for " +
                                std::to_string(size) + " elements");
  }
  const CertifiedKernel& kernel = certified_kernel(chosen_kernels());
  for_each_kernel_block(size, options.max_threads, blocks_of_task, [&](std::size_t first) {
    const KernelInput block = block_at(all, size, first);
    const auto of_block = results.subspan(first, block.count);
    std::ranges::fill(of_block, free_of_inversion);
    decide_block(
        block, options.t_max, options, kernel,
        [&](std::size_t index, const InversionResult& result) { of_block[index] = result; });
  });
}

/// Of a mesh.
std::vector<Inversion> find_all(const KernelInput& all, std::size_t size,
                                const InversionOptions& options) {
  require_valid(options);
  std::vector<std::vector<Inversion>> of_blocks((size + kernel_block - 1) / kernel_block);
  for_each_kernel_block(size, options.max_threads, blocks_of_task, [&](std::size_t first) {
    std::vector<Inversion>& found = of_blocks[first / kernel_block];
    decide_elements(all, size, first, options.t_max, options,
                    [&](std::size_t element, const InversionResult& result) {
                      found.push_back({element, result});
                    });
  });
  std::vector<Inversion> result;
  for (const auto& some : of_blocks) result.insert(result.end(), some.begin(), some.end());
  return result;
}

}  // namespace

void decide_elements(const KernelInput& elements, std::size_t size, std::size_t first,
                     double t_limit, const InversionOptions& options,
                     const std::function<void(std::size_t, const InversionResult&)>& report) {
  std::vector<Inversion> found;
  decide_block(block_at(elements, size, first), t_limit, options,
               certified_kernel(chosen_kernels()),
               [&](std::size_t index, const InversionResult& result) {
                 if (result.verdict == Verdict::yes) found.push_back({first + index, result});
               });
  std::ranges::sort(found, {}, &Inversion::element);
  for (const auto& [element, result] : found) report(element, result);
}

// ---- Interface ----------------------------------------------------------------------------------

InversionResult inversion(const Query& tetrahedron, const InversionOptions& options) {
  return decide_one({.count = 1, .queries = &tetrahedron}, options);
}

InversionResult inversion(const PlaneTriangle& triangle, const InversionOptions& options) {
  return inversion(to_tetrahedron(triangle), options);
}

void inversions(std::span<const Query> tetrahedra, std::span<InversionResult> results,
                const InversionOptions& options) {
  decide_all({.queries = tetrahedra.data()}, tetrahedra.size(), results, options);
}

void inversions(std::span<const PlaneTriangle> triangles, std::span<InversionResult> results,
                const InversionOptions& options) {
  decide_all({.triangles = triangles.data()}, triangles.size(), results, options);
}

std::vector<Inversion> inversions(const MovingVertices& vertices,
                                  std::span<const Tetrahedron> tetrahedra,
                                  const InversionOptions& options) {
  require_finite(vertices);
  require_in_range(vertices, tetrahedra);
  return find_all({.vertices = vertices.data(), .tetrahedra = tetrahedra.data()}, tetrahedra.size(),
                  options);
}

std::vector<Inversion> inversions(const MovingVertices& vertices, std::span<const Face> triangles,
                                  const InversionOptions& options) {
  require_finite(vertices);
  require_in_range(vertices, triangles);
  return find_all({.vertices = vertices.data(), .faces = triangles.data()}, triangles.size(),
                  options);
}

}  // namespace touchstone::fast
