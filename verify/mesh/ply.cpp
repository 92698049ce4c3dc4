#include "verify/mesh/ply.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <cstdint>
#include <initializer_list>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <utility>
#include <variant>
#include <vector>

#include "touchstone/query.hpp"
#include "verify/io/dataset_error.hpp"
#include "verify/io/input_file.hpp"
#include "verify/io/number_text.hpp"
#include "verify/io/output_file.hpp"
#include "verify/io/terminal.hpp"

namespace touchstone::verify::mesh {
namespace {

enum class Format : std::uint8_t { ascii, little_endian, big_endian };

/// The type of a number: that of the alternative.
using Scalar = std::variant<std::int8_t, std::uint8_t, std::int16_t, std::uint16_t, std::int32_t,
                            std::uint32_t, float, double>;

/// A value of a property, or of a list of them.
struct Property {
  std::string name;
  Scalar type;
  std::optional<Scalar> length_type;  ///< of a list
};

struct Element {
  std::string name;
  std::uint64_t count;
  std::vector<Property> properties;
};

struct Header {
  std::optional<Format> format;
  std::vector<Element> elements;
};

std::optional<Scalar> scalar_from_name(std::string_view name) {
  struct Names {
    std::string_view name, sized_name;
    Scalar type;
  };
  static constexpr std::array<Names, 8> names{{{"char", "int8", std::int8_t{}},
                                               {"uchar", "uint8", std::uint8_t{}},
                                               {"short", "int16", std::int16_t{}},
                                               {"ushort", "uint16", std::uint16_t{}},
                                               {"int", "int32", std::int32_t{}},
                                               {"uint", "uint32", std::uint32_t{}},
                                               {"float", "float32", float{}},
                                               {"double", "float64", double{}}}};
  for (const Names& one : names) {
    if (name == one.name || name == one.sized_name) return one.type;
  }
  return std::nullopt;
}

bool is_whole(Scalar type) {
  return !std::holds_alternative<float>(type) && !std::holds_alternative<double>(type);
}

/// The file as lines and as bytes, with the position of errors.
class Input {
 public:
  explicit Input(const std::filesystem::path& path) : lines_(path) {}

  /// The next line without its end, valid until the next call; nothing at the end of the file.
  [[nodiscard]] std::optional<std::string_view> line() {
    const auto line = lines_.next();
    if (!line) return std::nullopt;
    line_number_ = line->number;
    return line->text;
  }

  /// Fills the bytes, or fails if there are not as many left.
  void read(std::span<char> bytes) {
    const std::string_view there = lines_.peek(bytes.size());
    if (there.size() < bytes.size()) fail_at_end();
    std::ranges::copy(there.substr(0, bytes.size()), bytes.begin());
    lines_.skip(bytes.size());
  }

  /// True if there are no more bytes.
  [[nodiscard]] bool at_end() { return lines_.peek(1).empty(); }

  /// From here on the file has no lines.
  void begin_binary() { binary_ = true; }

  /// All that is read from here on belongs to this element; the name has to outlive it.
  void begin_element(std::string_view name, std::uint64_t number) {
    element_ = name;
    number_ = number;
    element_offset_ = lines_.offset();
  }
  void end_elements() { begin_element({}, 0); }

  [[noreturn]] void fail(const std::string& reason) const {
    std::string place;
    if (!element_.empty()) place = std::string(element_) + " " + std::to_string(number_);
    if (binary_)
      place += (place.empty() ? "" : " at ") + ("byte " + std::to_string(element_offset_));
    throw io::DatasetError(lines_.path(), {.line = binary_ ? 0 : line_number_},
                           place.empty() ? reason : place + ": " + reason);
  }
  [[noreturn]] void fail_at_end() const { fail("the file ends early"); }

 private:
  io::LineReader lines_;
  std::uint64_t line_number_ = 0;
  bool binary_ = false;
  std::string_view element_;
  std::uint64_t number_ = 0;
  std::uint64_t element_offset_ = 0;
};

/// Reads the header's lines.
class HeaderReader {
 public:
  explicit HeaderReader(Input& input) : input_(input) {}

  [[nodiscard]] Header read() {
    if (input_.line().value_or("") != "ply") input_.fail("not a PLY file");
    for (;;) {
      const auto line = input_.line();
      if (!line) input_.fail("the header has no end");
      std::string_view rest = *line;
      const std::string_view keyword = io::take_word(rest);
      if (keyword == "end_header") break;
      if (keyword == "comment" || keyword == "obj_info") continue;
      read_statement(keyword, rest);
      if (!io::take_word(rest).empty()) fail_at(*line);
    }
    if (!header_.format) input_.fail("the header has no format");
    return std::move(header_);
  }

 private:
  /// Text that is not understood stays in `rest`, or is an error at once.
  void read_statement(std::string_view keyword, std::string_view& rest) {
    if (keyword == "format") {
      read_format(rest);
    } else if (keyword == "element") {
      read_element(rest);
    } else if (keyword == "property" && !header_.elements.empty()) {
      header_.elements.back().properties.push_back(read_property(rest));
    } else {
      fail_at(keyword);
    }
  }

  void read_format(std::string_view& rest) {
    static constexpr std::array<std::string_view, 3> names{"ascii", "binary_little_endian",
                                                           "binary_big_endian"};
    const std::string_view name = io::take_word(rest), version = io::take_word(rest);
    const auto* const found = std::ranges::find(names, name);
    if (found == names.end() || header_.format) fail_at(name);
    if (version != "1.0") fail_at(version);
    header_.format = static_cast<Format>(found - names.begin());
  }

  void read_element(std::string_view& rest) {
    const std::string_view name = io::take_word(rest), count = io::take_word(rest);
    const auto number = io::number_from_text<std::uint64_t>(count);
    if (name.empty() || !number) fail_at(count);
    header_.elements.push_back({.name = std::string(name), .count = *number, .properties = {}});
  }

  Property read_property(std::string_view& rest) {
    std::string_view type = io::take_word(rest);
    Property property{};
    if (type == "list") {
      const std::string_view length_type = io::take_word(rest);
      property.length_type = read_type(length_type);
      if (!is_whole(*property.length_type)) fail_at(length_type);
      type = io::take_word(rest);
    }
    property.type = read_type(type);
    property.name = io::take_word(rest);
    if (property.name.empty()) input_.fail("a property must have a name");
    return property;
  }

  [[nodiscard]] Scalar read_type(std::string_view name) const {
    const auto type = scalar_from_name(name);
    if (!type) fail_at(name);
    return *type;
  }

  [[noreturn]] void fail_at(std::string_view text) const {
    input_.fail("malformed header at " + io::quote(text));
  }

  Input& input_;
  Header header_;
};

/// Elements as lines of text.
class TextValues {
 public:
  explicit TextValues(Input& input) : input_(input) {}

  void begin() {
    do {
      const auto line = input_.line();
      if (!line) input_.fail_at_end();
      rest_ = *line;
      word_ = io::take_word(rest_);
    } while (word_.empty());
  }

  /// The element's next value; every type fits into a double.
  double next(Scalar type) {
    if (word_.empty()) input_.fail("too few values");
    const auto parse = [this](auto number) -> std::optional<double> {
      const auto parsed = io::number_from_text<decltype(number)>(word_);
      return parsed ? std::optional(static_cast<double>(*parsed)) : std::nullopt;
    };
    const auto value = std::visit(parse, type);
    if (!value) input_.fail(io::quote(word_) + " is not a number of the property's type");
    word_ = io::take_word(rest_);
    return *value;
  }

  void end() {
    if (!word_.empty()) input_.fail("too many values");
  }

  /// True if anything but blank lines is left.
  [[nodiscard]] bool at_end() {
    while (auto line = input_.line()) {
      if (!io::take_word(*line).empty()) return false;
    }
    return true;
  }

 private:
  Input& input_;
  std::string_view rest_;
  std::string_view word_;
};

/// Elements as bytes.
class BinaryValues {
 public:
  BinaryValues(Input& input, Format format)
      : input_(input),
        swap_((format == Format::little_endian) != (std::endian::native == std::endian::little)) {}

  void begin() { input_.begin_binary(); }

  double next(Scalar type) {
    const auto take = [this](auto number) {
      std::array<char, sizeof(number)> bytes{};
      input_.read(bytes);
      if (swap_) std::ranges::reverse(bytes);
      return static_cast<double>(std::bit_cast<decltype(number)>(bytes));
    };
    return std::visit(take, type);
  }

  void end() {}

  [[nodiscard]] bool at_end() { return input_.at_end(); }

 private:
  Input& input_;
  bool swap_;
};

/// Reads the elements of the header.
template <class Values>
class BodyReader {
 public:
  BodyReader(Input& input, const Header& header, Values values)
      : input_(input), header_(header), values_(std::move(values)) {}

  [[nodiscard]] Mesh read() {
    const Element* const vertices = find_element("vertex");
    if (vertices == nullptr) input_.fail("the header has no element vertex");
    vertex_count_ = vertices->count;
    const Element* const faces = find_element("face");
    const Element* const edges = find_element("edge");
    const Element* const strips = find_element("tristrips");
    for (const Element& element : header_.elements) {
      const Element* const it = &element;
      if (it != vertices && it != faces && it != edges && it != strips) pass_over(element);
    }
    for (const Element& element : header_.elements) {
      if (&element == vertices) {
        read_vertices(element);
      } else if (&element == faces) {
        read_faces(element);
      } else if (&element == edges) {
        read_edges(element);
      } else if (&element == strips) {
        read_strips(element);
      } else {
        for_each(element, nothing, [] {});
      }
    }
    input_.end_elements();
    if (!values_.at_end()) input_.fail("data after the last element");
    if (vertices_.empty()) input_.fail("no vertex: the header says element vertex 0");
    Mesh mesh = make_mesh(vertices_, std::move(faces_), edges_);
    mesh.note = note_of(polygons_, passed_over_, of_strips_);
    return mesh;
  }

 private:
  static constexpr std::size_t nothing = std::numeric_limits<std::size_t>::max();
  static constexpr std::int32_t end_of_strip = -1;

  /// The vertices in a list.
  enum class Corners : std::uint8_t { of_face, of_strips };

  /// Notes an element that is not read. One that has vertices would be missing in the mesh.
  void pass_over(const Element& element) {
    static constexpr std::array<std::string_view, 4> of_vertices{"vertex_indices", "vertex_index",
                                                                 "vertex1", "vertex2"};
    if (element.count == 0) return;
    for (const Property& property : element.properties) {
      if (std::ranges::find(of_vertices, property.name) == of_vertices.end()) continue;
      input_.fail(io::quote(element.name) +
                  " has vertices and is not read: write it as element face or edge");
    }
    passed_over_.push_back(element.name + ' ' + std::to_string(element.count));
  }

  /// Notes the properties of an element that is read, but for those that are used.
  void pass_over(const Element& element, std::initializer_list<std::size_t> used) {
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      if (std::ranges::find(used, i) != used.end()) continue;
      passed_over_.push_back(element.name + '.' + element.properties[i].name);
    }
  }

  [[nodiscard]] const Element* find_element(std::string_view name) const {
    const Element* found = nullptr;
    for (const Element& element : header_.elements) {
      if (element.name != name) continue;
      if (found != nullptr) input_.fail("the header has two elements " + std::string(name));
      if (element.count > std::numeric_limits<std::int32_t>::max()) {
        input_.fail("more than 2^31-1 elements " + std::string(name));
      }
      found = &element;
    }
    return found;
  }

  /// The one property of that name that is a list or not, or `nothing`.
  [[nodiscard]] std::size_t find_property(const Element& element, std::string_view name,
                                          bool list) const {
    std::size_t found = nothing;
    for (std::size_t i = 0; i < element.properties.size(); ++i) {
      const Property& property = element.properties[i];
      if (property.name != name || property.length_type.has_value() != list) continue;
      if (found != nothing) {
        input_.fail(element.name + " has two properties " + std::string(name));
      }
      found = i;
    }
    return found;
  }

  [[nodiscard]] std::size_t need_property(const Element& element, std::string_view name) const {
    const std::size_t found = find_property(element, name, false);
    if (found == nothing) input_.fail(element.name + " has no property " + std::string(name));
    return found;
  }

  void need_whole(const Element& element, std::size_t property) const {
    const auto& [name, type, length_type] = element.properties[property];
    if (!is_whole(type)) input_.fail(element.name + ": " + name + " must be of a whole type");
  }

  /// Calls use() for each element, with its values in row_ and those of the wanted list in
  /// corners_.
  template <class Use>
  void for_each(const Element& element, std::size_t wanted, const Use& use,
                Corners corners = Corners::of_face) {
    if (element.properties.empty()) return;
    row_.assign(element.properties.size(), 0.0);
    for (std::uint64_t i = 0; i < element.count; ++i) {
      input_.begin_element(element.name, i);
      values_.begin();
      for (std::size_t k = 0; k < row_.size(); ++k) {
        const Property& property = element.properties[k];
        if (property.length_type) {
          read_list(property, k == wanted, corners);
        } else {
          row_[k] = values_.next(property.type);
        }
      }
      values_.end();
      use();
    }
  }

  void read_list(const Property& property, bool wanted, Corners corners) {
    const double length = values_.next(*property.length_type);
    if (length < 0.0) input_.fail("a list of negative length");
    if (wanted) corners_.clear();
    if (wanted && corners == Corners::of_face && length < 3.0) {
      input_.fail("vertices: " + std::to_string(static_cast<std::int64_t>(length)) +
                  "; a face must have 3 or more");
    }
    for (std::uint64_t i = 0; i < static_cast<std::uint64_t>(length); ++i) {
      const double value = values_.next(property.type);
      if (!wanted) continue;
      const bool is_end = corners == Corners::of_strips && value == end_of_strip;
      corners_.push_back(is_end ? end_of_strip : vertex(value));
    }
  }

  void read_vertices(const Element& element) {
    const std::array<std::size_t, 3> axes{need_property(element, "x"), need_property(element, "y"),
                                          need_property(element, "z")};
    pass_over(element, {axes[0], axes[1], axes[2]});
    for_each(element, nothing, [&] {
      const std::array<double, 3> vertex{row_[axes[0]], row_[axes[1]], row_[axes[2]]};
      if (!is_finite(vertex)) input_.fail("a coordinate must be finite");
      vertices_.push_back(vertex);
    });
  }

  void read_faces(const Element& element) {
    for_each(element, list_of_vertices(element), [&] { add_polygon(faces_, corners_, polygons_); });
  }

  void read_strips(const Element& element) {
    for_each(
        element, list_of_vertices(element), [&] { add_strips(); }, Corners::of_strips);
  }

  /// The one property that is a list of vertices. Notes the others.
  [[nodiscard]] std::size_t list_of_vertices(const Element& element) {
    const std::size_t indices = find_property(element, "vertex_indices", true);
    const std::size_t index = find_property(element, "vertex_index", true);
    if ((indices == nothing) == (index == nothing)) {
      input_.fail(element.name + " must have one list vertex_indices or vertex_index");
    }
    const std::size_t list = indices == nothing ? index : indices;
    need_whole(element, list);
    pass_over(element, {list});
    return list;
  }

  /// Adds the triangles of the strips in a list.
  void add_strips() {
    auto first = corners_.begin();
    while (first != corners_.end()) {
      const auto last = std::find(first, corners_.end(), end_of_strip);
      add_strip({first, last});
      first = last == corners_.end() ? last : last + 1;
    }
  }

  /// Adds the triangles of three consecutive vertices, every other one turned round, so that all
  /// face the same side. A triangle with a vertex twice only joins two strips, and is left out.
  void add_strip(std::span<const std::int32_t> strip) {
    for (std::size_t k = 2; k < strip.size(); ++k) {
      fast::Face face{strip[k - 2], strip[k - 1], strip[k]};
      if (k % 2 == 1) std::swap(face[0], face[1]);
      if (face[0] == face[1] || face[1] == face[2] || face[2] == face[0]) continue;
      faces_.push_back(face);
      ++of_strips_;
    }
  }

  void read_edges(const Element& element) {
    const std::size_t first = need_property(element, "vertex1");
    const std::size_t second = need_property(element, "vertex2");
    need_whole(element, first);
    need_whole(element, second);
    pass_over(element, {first, second});
    for_each(element, nothing, [&] {
      edges_.push_back({vertex(row_[first]), vertex(row_[second])});
    });
  }

  /// An index that is a vertex's.
  [[nodiscard]] std::int32_t vertex(double index) const {
    if (index < 0.0 || index >= static_cast<double>(vertex_count_)) {
      input_.fail("vertex " + std::to_string(static_cast<std::int64_t>(index)) +
                  ", but there are " + std::to_string(vertex_count_) + ", counted from 0");
    }
    return static_cast<std::int32_t>(index);
  }

  Input& input_;
  const Header& header_;
  Values values_;
  std::uint64_t vertex_count_ = 0;
  std::vector<double> row_;
  std::vector<std::int32_t> corners_;
  std::size_t polygons_ = 0;
  std::size_t of_strips_ = 0;  // triangles
  std::vector<std::string> passed_over_;
  std::vector<std::array<double, 3>> vertices_;
  std::vector<fast::Face> faces_;
  std::vector<fast::Edge> edges_;
};

}  // namespace

Mesh read_ply(const std::filesystem::path& path) {
  Input input(path);
  const Header header = HeaderReader(input).read();
  if (*header.format == Format::ascii) return BodyReader(input, header, TextValues(input)).read();
  return BodyReader(input, header, BinaryValues(input, *header.format)).read();
}

void write_ply(const std::filesystem::path& path, const Vertices& vertices,
               std::span<const fast::Face> faces, std::span<const fast::Edge> edges) {
  static_assert(std::endian::native == std::endian::little,
                "numbers are written as they are stored");
  io::OutputFile file(path);
  const auto write_numbers = [&file](const auto* numbers, std::size_t count) {
    const void* const bytes = numbers;
    file.write({static_cast<const char*>(bytes), count * sizeof(*numbers)});
  };
  std::string header = "ply\nformat binary_little_endian 1.0\nelement vertex " +
                       std::to_string(vertices.rows()) +
                       "\nproperty double x\nproperty double y\nproperty double z\nelement face " +
                       std::to_string(faces.size()) + "\nproperty list uchar int vertex_indices\n";
  if (!edges.empty()) {
    header += "element edge " + std::to_string(edges.size()) +
              "\nproperty int vertex1\nproperty int vertex2\n";
  }
  file.write(header + "end_header\n");
  write_numbers(vertices.data(), static_cast<std::size_t>(vertices.size()));
  for (const fast::Face& face : faces) {
    io::throw_if_interrupted();
    file.write("\3");
    write_numbers(face.data(), face.size());
  }
  for (const fast::Edge& edge : edges) write_numbers(edge.data(), edge.size());
  file.close();
}

}  // namespace touchstone::verify::mesh
