#include "exact/scene/scene_text.hpp"

#include <algorithm>
#include <iterator>
#include <stdexcept>
#include <tuple>
#include <utility>

#include "touchstone/broad_phase.hpp"
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
  const std::size_t items = vertices + mesh.faces.size() + bare_edges.size() + mesh.points.size() +
                            rules.of_vertices.size() + rules.apart.size() + rules.radii.size() +
                            rules.separations.size() + mesh.tetrahedra.size() +
                            mesh.plane_triangles.size();
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

// ---- The claim of a step ------------------------------------------------------------------------

std::string to_text(const StepClaim& claim) {
  std::string text = claim.earliest ? "earliest " : "no_contact ";
  write_number(text, claim.end);
  if (claim.earliest) write_number(text += ' ', claim.earliest->upper);
  return text;
}

void write_step_claim(std::string& text, const StepClaim& claim) {
  text += "separation ";
  write_hexadecimal(text, claim.separation.distance);
  text.append(" ").append(to_string(claim.separation.norm)).append("\n");
  write_line(text, "claim", to_text(claim));
  if (!claim.earliest) return;
  write_line(text, claim.earliest->name);
  write_contact(text, claim.earliest->proof);
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

void ProofWriter::report(std::size_t done, std::size_t all) const {
  if (options_.on_progress) {
    options_.on_progress(static_cast<double>(done) / static_cast<double>(all));
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

void require_few_arguments(std::size_t pairs) {
  if (pairs <= scene_argument_limit) return;
  throw CertificateLimitError(
      words(pairs, "pairs need an argument, more than", scene_argument_limit));
}

}  // namespace touchstone::exact
