#include "verify/mesh/obj.hpp"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>
#include <string>
#include <string_view>
#include <unordered_map>
#include <utility>
#include <vector>

#include "verify/io/dataset_error.hpp"
#include "verify/io/input_file.hpp"
#include "verify/io/number_text.hpp"
#include "verify/io/obj_statements.hpp"

namespace touchstone::verify::mesh {
namespace {

constexpr std::int32_t no_group = -1;
constexpr std::size_t most_vertices = std::numeric_limits<std::int32_t>::max();

/// True for whole numbers, of which the second and the third may be empty: 1/2/3, 1//3, 1/2, 1/, 1.
bool is_corner(std::string_view word) {
  std::size_t parts = 1;
  for (std::size_t slash = word.find('/'); slash != std::string_view::npos;
       slash = word.find('/')) {
    word.remove_prefix(slash + 1);
    const std::string_view part = word.substr(0, word.find('/'));
    if (!part.empty() && !io::number_from_text<std::int32_t>(part)) return false;
    ++parts;
  }
  return parts <= 3;
}

/// A reader of OBJ. Corners are checked at the end, because they may name later vertices.
class ObjReader {
 public:
  explicit ObjReader(const std::filesystem::path& path) : path_(path), statements_(path) {}

  [[nodiscard]] Mesh read() {
    while (const auto statement = statements_.next()) {
      line_ = statement->line;
      read_statement(statement->keyword, statement->words);
    }
    if (vertices_.empty()) {
      throw io::DatasetError(path_, {},
                             "no vertex (a line \"v x y z\"): an empty mesh, or not an OBJ file");
    }
    require_vertices(faces_, face_places_);
    require_vertices(edges_, edge_places_);
    require_vertices(points_, point_places_);
    Mesh mesh = make_mesh(vertices_, std::move(faces_), edges_, points_);
    if (!group_names_.empty()) mesh.groups = groups(mesh.faces);
    mesh.note = note_of(polygons_, statements_.passed_over());
    return mesh;
  }

 private:
  /// The place of an element in the file.
  struct Place {
    std::uint64_t line;
    std::int32_t group;
  };

  void read_statement(std::string_view keyword, std::string_view words) {
    if (keyword == "o" || keyword == "g") begin_group(words);
    if (keyword == "p") read_points(words);
    if (keyword == "v") read_vertex(words);
    if (keyword == "f") read_face(words);
    if (keyword == "l") read_polyline(words);
  }

  void read_vertex(std::string_view words) {
    if (vertices_.size() == most_vertices) fail("more than 2^31-1 vertices");
    std::array<double, 3> vertex{};
    for (double& coordinate : vertex) {
      const std::string_view word = io::take_word(words);
      if (word.empty()) fail("a vertex must have three coordinates");
      const auto value = io::number_from_text<double>(word);
      if (!value) fail(io::quote(word) + " is no number, or none that a double holds");
      if (!std::isfinite(*value)) fail("a coordinate must be finite");
      coordinate = *value;
    }
    statements_.pass_over_behind_vertex(words, line_);
    vertices_.push_back(vertex);
    group_of_line_.push_back(group_);
  }

  /// Elements before the first group are in a group without a name.
  void begin_group(std::string_view name) {
    if (group_names_.empty()) {
      group_names_.emplace_back();
      group_numbers_.emplace();
    }
    const std::string trimmed(io::trimmed(name));
    const auto [found, is_new] =
        group_numbers_.try_emplace(trimmed, static_cast<std::int32_t>(group_names_.size()));
    if (is_new) group_names_.push_back(trimmed);
    group_ = found->second;
  }

  [[nodiscard]] Place place() const { return {.line = line_, .group = group_}; }

  void read_points(std::string_view words) {
    for (const std::int32_t corner : read_corners(words, 1, "a point")) {
      points_.push_back({corner});
      point_places_.push_back(place());
    }
  }

  [[nodiscard]] Groups groups(const std::vector<fast::Face>& faces) const {
    Groups result{.names = group_names_,
                  .of_vertex = std::vector<std::int32_t>(vertices_.size(), no_group),
                  .error = {}};
    add_to(result, faces, face_places_);
    add_to(result, edges_, edge_places_);
    add_to(result, points_, point_places_);
    for (std::size_t i = 0; i < vertices_.size(); ++i) {
      if (result.of_vertex[i] == no_group) result.of_vertex[i] = group_of_line_[i];
    }
    // A rule cannot name a group without vertices.
    std::vector<bool> has_vertex(result.names.size());
    for (const std::int32_t group : result.of_vertex) {
      has_vertex[static_cast<std::size_t>(group)] = true;
    }
    for (std::size_t i = 0; i < has_vertex.size(); ++i) {
      if (!has_vertex[i]) result.names[i].clear();
    }
    return result;
  }

  template <class Element>
  void add_to(Groups& groups, const std::vector<Element>& elements,
              const std::vector<Place>& places) const {
    for (std::size_t i = 0; i < elements.size(); ++i) {
      for (const std::int32_t vertex : elements[i]) {
        std::int32_t& group = groups.of_vertex[static_cast<std::size_t>(vertex)];
        if (group == no_group) group = places[i].group;
        if (group == places[i].group || !groups.error.empty()) continue;
        groups.error =
            io::DatasetError(
                path_, {.line = places[i].line},
                "vertex " + std::to_string(std::int64_t{vertex} + 1) + " is in two groups, " +
                    io::quote(group_names_[static_cast<std::size_t>(group)]) + " and " +
                    io::quote(group_names_[static_cast<std::size_t>(places[i].group)]))
                .what();
      }
    }
  }

  void read_face(std::string_view words) {
    add_polygon(faces_, read_corners(words, 3, "a face"), polygons_);
    face_places_.resize(faces_.size(), place());
  }

  void read_polyline(std::string_view words) {
    const std::vector<std::int32_t>& corners = read_corners(words, 2, "a line");
    for (std::size_t i = 1; i < corners.size(); ++i) {
      edges_.push_back({corners[i - 1], corners[i]});
      edge_places_.push_back(place());
    }
  }

  /// The corners of an element, at least the given number; valid until the next call.
  [[nodiscard]] const std::vector<std::int32_t>& read_corners(std::string_view words,
                                                              std::size_t least,
                                                              std::string_view element) {
    corners_.clear();
    for (auto word = io::take_word(words); !word.empty(); word = io::take_word(words)) {
      corners_.push_back(read_corner(word));
    }
    if (corners_.size() < least) {
      fail("corners: " + std::to_string(corners_.size()) + "; " + std::string(element) +
           " must have " + std::to_string(least) + " or more");
    }
    return corners_;
  }

  /// The vertex's index, counted from 0. Numbers of a texture and a normal may follow.
  [[nodiscard]] std::int32_t read_corner(std::string_view word) const {
    const auto number = io::number_from_text<std::int32_t>(word.substr(0, word.find('/')));
    if (!number || !is_corner(word)) fail(io::quote(word) + " is no corner");
    if (*number > 0) return *number - 1;
    const auto index = static_cast<std::int64_t>(vertices_.size()) + *number;
    if (*number == 0 || index < 0) {
      fail("corner " + io::quote(word) + ", but there are " + std::to_string(vertices_.size()) +
           " vertices before it, counted from 1");
    }
    return static_cast<std::int32_t>(index);
  }

  template <class Element>
  void require_vertices(const std::vector<Element>& elements, const std::vector<Place>& places) {
    for (std::size_t i = 0; i < elements.size(); ++i) {
      const std::int32_t greatest = *std::ranges::max_element(elements[i]);
      if (static_cast<std::size_t>(greatest) < vertices_.size()) continue;
      line_ = places[i].line;
      fail("corner " + std::to_string(std::int64_t{greatest} + 1) + ", but there are " +
           std::to_string(vertices_.size()) + " vertices");
    }
  }

  [[noreturn]] void fail(const std::string& reason) const {
    throw io::DatasetError(path_, {.line = line_}, reason);
  }

  std::filesystem::path path_;
  io::ObjStatements statements_;
  std::uint64_t line_ = 0;
  std::vector<std::array<double, 3>> vertices_;
  std::vector<std::int32_t> corners_;
  std::size_t polygons_ = 0;
  std::vector<fast::Face> faces_;
  std::vector<Place> face_places_;
  std::vector<fast::Edge> edges_;
  std::vector<Place> edge_places_;
  std::vector<Point> points_;
  std::vector<Place> point_places_;
  std::int32_t group_ = 0;
  std::vector<std::string> group_names_;
  std::unordered_map<std::string, std::int32_t> group_numbers_;  // of the names
  std::vector<std::int32_t> group_of_line_;                      // of each vertex
};

}  // namespace

Mesh read_obj(const std::filesystem::path& path) { return ObjReader(path).read(); }

}  // namespace touchstone::verify::mesh
