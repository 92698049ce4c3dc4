#include "exact/scene/scene_text.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "fast/platform/floating_point_state.hpp"
#include "fast/platform/threads.hpp"
#include "touchstone/broad_phase.hpp"
#include "touchstone/certificate.hpp"
#include "touchstone/certificate_text.hpp"

namespace touchstone::exact {

std::string_view step_certificates_header() { return "touchstone-steps 2\n"; }

std::string step_certificates_closing_line(std::uint64_t steps) {
  return "steps " + std::to_string(steps) + '\n';
}

std::string_view mesh_certificates_header() { return "touchstone-meshes 1\n"; }

std::string mesh_certificates_closing_line(std::uint64_t meshes) {
  return "meshes " + std::to_string(meshes) + '\n';
}

void write_doubles(std::string& text, std::span<const double> numbers) {
  for (const double x : numbers) {
    write_hexadecimal(text, x);
    text += ' ';
  }
  text.back() = '\n';
}

// ---- The scene ----------------------------------------------------------------------------------

ListedScene::ListedScene(fast::Mesh given, fast::CollisionGroups given_rules,
                         bool are_groups_needed)
    : mesh(std::move(given)), rules(std::move(given_rules)) {
  if (!are_groups_needed && rules.apart.empty() && rules.radii.empty() &&
      rules.separations.empty()) {
    rules.of_vertices.clear();
  }
  std::vector<fast::Face> all = mesh.faces;
  for (const auto& [a, b] : mesh.edges) {
    if (a == b) mesh.points.push_back(a);
    all.push_back({a, b, b});
  }
  std::ranges::sort(mesh.points);
  mesh.points.erase(std::unique(mesh.points.begin(), mesh.points.end()), mesh.points.end());
  mesh.edges = fast::edges_of(all);
  std::ranges::set_difference(mesh.edges, fast::edges_of(mesh.faces),
                              std::back_inserter(bare_edges),
                              [](const fast::Edge& a, const fast::Edge& b) {
                                return std::tie(a[1], a[0]) < std::tie(b[1], b[0]);
                              });
}

void ListedScene::require_within_limit(std::size_t vertices) const {
  std::size_t items = vertices + mesh.faces.size() + bare_edges.size() + mesh.points.size() +
                      rules.of_vertices.size() + rules.apart.size() + rules.radii.size() +
                      rules.separations.size();
  for (const CellKind kind : cell_kinds) items += mesh.count_of(kind);
  if (items <= scene_item_limit) return;
  throw CertificateLimitError("the scene has " +
                              words(items, "items, more than", scene_item_limit));
}

void ListedScene::write(std::string& text) const {
  write_list(text, "faces", mesh.faces);
  write_list(text, "edges", bare_edges);
  write_list(text, "points", mesh.points);
  write_list(text, "groups", rules.of_vertices);
  write_list(text, "apart", rules.apart);
}

// ---- Writing ------------------------------------------------------------------------------------

ProofWriter::ProofWriter(const SceneProofOptions& options) : options_(options) {
  if (options.max_threads < 0) {
    throw std::invalid_argument("prove: max_threads must not be negative");
  }
}

void ProofWriter::put(std::string_view text) {
  proof_.bytes += text.size();
  if (options_.on_text) {
    options_.on_text(text);
  } else {
    proof_.stream += text;
  }
}

void ProofWriter::expect_arguments(std::size_t pairs, std::size_t cells) {
  if (pairs > scene_argument_limit) {
    throw CertificateLimitError(
        words(pairs, "pairs need an argument, more than", scene_argument_limit));
  }
  expected_ = pairs + cells;
}

void ProofWriter::write_arguments(std::size_t count,
                                  const std::function<void(std::size_t, Arguments&)>& argue) {
  static constexpr std::size_t block = 32'768, part = 64;
  for (std::size_t done = 0; done < count && proof_.is_complete(); done += block) {
    const std::size_t end = std::min(count, done + block);
    std::vector<Arguments> parts((end - done + part - 1) / part);
    fast::with_threads(options_.max_threads, [&] {
      fast::tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t n) {
        const fast::StrictFloatingPoint strict;
        const std::size_t first = done + n * part;
        for (std::size_t i = first; i < std::min(end, first + part); ++i) {
          if (is_stopped() || !parts[n].failure.empty()) return;
          argue(i, parts[n]);
        }
      });
    });
    proof_.interrupted = is_stopped();
    for (const Arguments& some : parts) {
      proof_.failure = some.failure;
      if (!proof_.is_complete()) return;
      put(some.text);
      proof_.directions += some.directions;
      proof_.certificates += some.certificates;
    }
    written_ += end - done;
    if (options_.on_progress) {
      options_.on_progress(static_cast<double>(written_) / static_cast<double>(expected_));
    }
  }
}

SceneProof ProofWriter::finish(std::string_view header, std::string_view closing_line) {
  if (proof_.is_complete()) put("end\n");
  if (options_.on_text || !proof_.is_complete()) {
    proof_.stream.clear();
  } else {
    proof_.stream.insert(0, header).append(closing_line);
  }
  return std::move(proof_);
}

}  // namespace touchstone::exact
