#include "exact/checker/mesh.hpp"

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <string_view>
#include <utility>
#include <vector>

#include "exact/checker/resting_mesh.hpp"

namespace touchstone::checker {
namespace {

/// The integer, of any size, that a word is.
mpz_class parse_integer(std::string_view word) {
  const mpq_class number = parse_number(word);
  if (number.get_den() != 1) reject("not an integer: " + quoted(word));
  return number.get_num();
}

class MeshCheck {
 public:
  MeshCheck(Reader& reader, const Options& options)
      : reader_(reader), options_(options), first_byte_(reader.bytes()) {}

  Proved run(Reader* scenes) {
    text_ = "mesh " + printable(read_label(reader_, "mesh")) + '\n';
    const Scene scene = read_scene(reader_, options_, Time::rest);
    if (scenes != nullptr && read_scene(*scenes, options_, Time::rest) != scene) {
      reject("the scene is not the one given");
    }
    read_claim();
    mesh_.emplace(scene, is_welded_);
    const std::size_t taking_part = mesh_->vertices_of_elements();
    statement_.rules = rules_text(scene.apart, scene.vertices.size() - taking_part);
    require_demanded(options_, claim_.substr(claim_.find(' ') + 1), to_text(Separation{}),
                     statement_.rules, claim_line_);
    text_ += vertices_text(scene, taking_part) + ", " + std::to_string(mesh_->faces()) +
             " faces, " + std::to_string(mesh_->edges()) + " edges of no face, " +
             std::to_string(mesh_->points()) + " points\n";
    if (!statement_.rules.empty()) text_ += "rules " + statement_.rules + '\n';
    text_ += claim_ + '\n';
    for (std::int32_t n = 0; n < intersections_; ++n) read_intersection();
    read_separations();
    require_all_known();
    reader_.begin("end");
    reader_.end();
    return {std::move(text_), std::move(statement_), {}};
  }

 private:
  void read_claim() {
    claim_ = printable(reader_.text());
    claim_line_ = reader_.begin("claim");
    is_welded_ = reader_.one_of({"intersections", "welded_intersections"}) == 1;
    intersections_ = take_count(reader_);
    statement_.is_free = !is_welded_ && intersections_ == 0;
    reader_.end();
  }

  /// Takes the numbers of a pair, and counts it as known.
  Two take_pair() {
    require_at_most(options_.max_arguments, known_.size() + 1, "arguments");
    const std::int32_t a = take_integer(reader_, 0, mesh_->elements().size());
    const std::int32_t b = take_integer(reader_, 0, mesh_->elements().size());
    if (a == b) reject("a pair of an element and itself");
    known_.push_back({std::min(a, b), std::max(a, b)});
    return {a, b};
  }

  std::vector<mpz_class> take_weights(std::int32_t number) {
    std::vector<mpz_class> weights(mesh_->corners(number));
    for (mpz_class& weight : weights) weight = parse_integer(reader_.word());
    return weights;
  }

  /// Reads `I J` of two with the same vertices, or with the weights of a common point behind it.
  void read_intersection() {
    reader_.begin();
    const bool is_first = known_.empty();
    const Two last = is_first ? Two{} : known_.back();
    const auto [a, b] = take_pair();
    if (a > b || (!is_first && known_.back() <= last)) reject("the pairs are not in order");
    if (!mesh_->can_meet(a, b)) reject("these two cannot meet");
    const RestingPair pair = mesh_->pair(a, b);
    if (reader_.has_word()) {
      const std::vector<mpz_class> of_a = take_weights(a), of_b = take_weights(b);
      if (!pair.is_common_point(of_a, of_b)) reject("not a common point outside what is shared");
    } else if (!pair.are_duplicates()) {
      reject("the two have not the same vertices");
    }
    reader_.end();
  }

  void read_separations() {
    reader_.begin("separations");
    reader_.end();
    while (reader_.first_word().find_first_not_of("0123456789") == std::string_view::npos) {
      reader_.begin();
      const auto [a, b] = take_pair();
      if (!is_separated(a, b)) reject("the argument separates not");
      reader_.end();
    }
  }

  /// Takes `plane`, `line` or `X Y Z`.
  bool is_separated(std::int32_t a, std::int32_t b) {
    const std::string_view word = reader_.word();
    if (word == "plane") return mesh_->pair(a, b).is_separated_by_first_plane();
    if (word == "line") return mesh_->pair(a, b).are_separated_on_lines();
    Vector d{parse_integer(word), 0, 0};
    for (const std::size_t k : {1U, 2U}) d[k] = parse_integer(reader_.word());
    return mesh_->is_separated_by(a, b, d);
  }

  void require_all_known() {
    std::ranges::sort(known_);
    std::int64_t comparisons_left =
        options_.max_comparisons_per_byte * (reader_.bytes() - first_byte_);
    mesh_->find_pairs(comparisons_left, [&](const Primitive& a, const Primitive& b) {
      if (std::ranges::binary_search(known_, Two{a.number, b.number})) return;
      reject("no argument for " + std::to_string(a.number) + ' ' + std::to_string(b.number));
    });
  }

  Reader& reader_;
  const Options& options_;
  /// Where the certificate begins.
  std::int64_t first_byte_;
  /// What is proved, for a reader.
  std::string text_;
  Statement statement_{.is_free = false, .contact = "intersect", .rules = ""};
  std::string claim_;
  std::size_t claim_line_ = 0;
  bool is_welded_ = false;
  std::int32_t intersections_ = 0;
  std::optional<RestingMesh> mesh_;
  /// The pairs that are said to intersect or not to, the smaller number first.
  std::vector<Two> known_;
};

}  // namespace

Proved check_mesh(Reader& reader, Reader* scenes, const Options& options) {
  return MeshCheck(reader, options).run(scenes);
}

}  // namespace touchstone::checker
