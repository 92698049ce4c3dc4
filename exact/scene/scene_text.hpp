#pragma once

/// \file
/// Certificates of scenes as text: exact/CERTIFICATES.md, "Steps", version 2, and "Meshes at rest".
/// The lists of the scene; and how arguments are made in parallel and written in order.

#include <array>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <span>
#include <string>
#include <string_view>
#include <type_traits>
#include <vector>

#include "touchstone/scene_certificate.hpp"
#include "touchstone/step.hpp"

namespace touchstone::exact {

/// The kinds of pairs in a step's certificate, in its order.
inline constexpr std::array<std::string_view, 4> step_pair_kinds{"vertex_face", "edge_edge",
                                                                 "vertex_edge", "vertex_vertex"};

/// Appends words and integers with blanks between them, and the end of the line.
template <class... Words>
void write_line(std::string& text, const Words&... all) {
  const auto add = [&text](const auto& word) {
    if constexpr (std::is_integral_v<std::remove_cvref_t<decltype(word)>>) {
      text += std::to_string(word);
    } else {
      text += word;
    }
    text += ' ';
  };
  (add(all), ...);
  text.back() = '\n';
}

/// Words and integers with blanks between them.
template <class... Words>
[[nodiscard]] std::string words(const Words&... all) {
  std::string text;
  write_line(text, all...);
  text.pop_back();
  return text;
}

/// Appends the line of doubles.
void write_doubles(std::string& text, std::span<const double> numbers);

/// Appends a list: the line "KEYWORD N", and a line for each of the N items.
template <class Items>
void write_list(std::string& text, std::string_view keyword, const Items& items) {
  write_line(text, keyword, items.size());
  for (const auto& item : items) {
    if constexpr (std::is_integral_v<std::remove_cvref_t<decltype(item)>>) {
      write_line(text, item);
    } else {
      std::apply([&text](const auto&... numbers) { write_line(text, numbers...); }, item);
    }
  }
}

/// A scene as certificates list it.
struct ListedScene {
  /// \param are_groups_needed true if groups count even without a rule about them
  ListedScene(fast::Mesh given, fast::CollisionGroups given_rules, bool are_groups_needed = false);

  /// \throws CertificateLimitError if the lists, with this many vertices, have too many items.
  void require_within_limit(std::size_t vertices) const;
  /// Appends the lists from "faces" to "apart".
  void write(std::string& text) const;

  /// Each edge once, in the order of edges_of; the points and the vertices with an edge to
  /// themselves in order, each once.
  fast::Mesh mesh;
  /// The edges of no face, which are listed.
  std::vector<fast::Edge> bare_edges;
  /// Without the groups of vertices if they are not needed.
  fast::CollisionGroups rules;
};

/// The arguments of some pairs or cells.
struct Arguments {
  std::string text;
  std::uint64_t directions = 0;    ///< pairs with a direction or a plane
  std::uint64_t certificates = 0;  ///< with subintervals
  std::string failure;             ///< the reason for a missing one
};

/// A certificate that is written.
class ProofWriter {
 public:
  ProofWriter(const ProofWriter&) = delete;
  ProofWriter& operator=(const ProofWriter&) = delete;
  ProofWriter(ProofWriter&&) = delete;
  ProofWriter& operator=(ProofWriter&&) = delete;

 protected:
  /// \throws std::invalid_argument for a negative number of threads.
  explicit ProofWriter(const SceneProofOptions& options);
  ~ProofWriter() = default;

  [[nodiscard]] const SceneProofOptions& options() const { return options_; }
  void put(std::string_view text);
  /// Says how many arguments will be written.
  /// \throws CertificateLimitError if the checker does not take those of so many pairs.
  void expect_arguments(std::size_t pairs, std::size_t cells);
  /// Writes what argue(i, arguments) adds for each i < count, on several threads; nothing behind a
  /// failure.
  void write_arguments(std::size_t count,
                       const std::function<void(std::size_t, Arguments&)>& argue);
  /// The proof, between these lines if it is complete and nobody has read it.
  [[nodiscard]] SceneProof finish(std::string_view header, std::string_view closing_line);
  [[nodiscard]] SceneProof& proof() { return proof_; }
  [[nodiscard]] const SceneProof& proof() const { return proof_; }

 private:
  [[nodiscard]] bool is_stopped() const { return options_.stop != nullptr && *options_.stop; }

  const SceneProofOptions& options_;
  SceneProof proof_;
  std::size_t expected_ = 0;  ///< arguments
  std::size_t written_ = 0;
};

}  // namespace touchstone::exact
