#include "exact/checker/step.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <set>
#include <string_view>
#include <vector>

#include "exact/checker/places.hpp"
#include "exact/checker/proof.hpp"

namespace touchstone::checker {
namespace {

using Numbers = std::array<std::int32_t, 2>;

/// Takes a word that is a decimal integer from `least` to below `limit`.
std::int32_t take_integer(Reader& reader, std::int32_t least, std::size_t limit) {
  const std::string_view word = reader.word();
  std::int32_t x = 0;
  const auto [end, error] = std::from_chars(word.begin(), word.end(), x);
  const bool is_integer = error == std::errc() && end == word.end();
  if (!is_integer || x < least || x >= std::int64_t(limit)) {
    reject("not an integer, or out of range: " + quoted(word));
  }
  return x;
}

double to_double(const mpq_class& number) {
  const bool is_small = abs(number) <= std::numeric_limits<double>::max();
  if (!is_small || number != number.get_d()) reject("a number that is not a double");
  return number.get_d();
}

/// A line of a keyword and a number, and so many lines: each an item that read(item) reads.
template <class Item, class Read>
std::vector<Item> read_list(Reader& reader, std::string_view keyword, const Read& read) {
  std::vector<Item> list;
  reader.begin(keyword);
  std::int32_t count = take_integer(reader, 0, max_items);
  for (reader.end(); count > 0; --count) {
    reader.begin();
    read(list.emplace_back());
    reader.end();
  }
  return list;
}

/// What is said of the scene, as it is written.
struct Scene {
  std::vector<Motion> vertices;
  /// The first numbers of each item count.
  std::vector<Primitive> faces, edges, points, groups, apart;

  friend bool operator==(const Scene&, const Scene&) = default;
};

Scene read_scene(Reader& reader) {
  Scene scene;
  scene.vertices = read_list<Motion>(reader, "vertices", [&](Motion& motion) {
    for (double& x : motion) x = to_double(read_number(reader));
  });
  const auto integers = [&](std::string_view keyword, std::size_t columns, std::size_t limit) {
    return read_list<Primitive>(reader, keyword, [&](Primitive& item) {
      for (std::size_t k = 0; k < columns; ++k) item.at(k) = take_integer(reader, 0, limit);
      for (std::size_t k = columns; k < 3; ++k) item.at(k) = item[0];
    });
  };
  const std::size_t count = scene.vertices.size();
  scene.faces = integers("faces", 3, count);
  scene.edges = integers("edges", 2, count);
  scene.points = integers("points", 1, count);
  scene.groups = integers("groups", 1, max_items);
  if (!scene.groups.empty() && scene.groups.size() != count) reject("not a group for each vertex");
  scene.apart = integers("apart", 2, max_items);
  return scene;
}

/// A kind of pairs, and those that have an argument.
struct PairKind {
  const char* name;
  const Elements &some, &others;
  std::set<Numbers> proved = {};
};

class StepCheck {
 public:
  StepCheck(Reader& reader, std::size_t& line) : reader_(reader), line_(line) {}

  std::string run(Reader* scenes) {
    read_text();
    reader_.begin("step");
    reader_.advance();
    scene_ = read_scene(reader_);
    if (scenes != nullptr && read_scene(*scenes) != scene_)
      reject("the scene is not the one given");
    find_elements();
    read_text();
    read_separation(reader_, pair_);
    to_double(pair_.distance);
    const bool is_at_zero = read_claim();
    if (!is_at_zero) prove_no_contact();
    reader_.begin("end");
    reader_.end();
    return text_;
  }

 private:
  /// Appends the present line to what is proved.
  void read_text() { text_ += printable(reader_.text().substr(0, max_label_bytes)) + '\n'; }

  void find_elements() {
    scene_.groups.resize(scene_.vertices.size());
    const auto side = [](std::int32_t a, std::int32_t b) -> Numbers {
      return {std::max(a, b), std::min(a, b)};
    };
    std::set<Numbers> sides;
    for (const auto& [a, b, c] : scene_.faces) {
      faces_[std::int32_t(faces_.size())] = {a, b, c};
      sides.insert({side(a, b), side(b, c), side(c, a)});
    }
    std::set<Numbers> all = sides;
    for (const Primitive& edge : scene_.edges) all.insert(side(edge[0], edge[1]));
    std::set<std::int32_t> named, joined;
    for (const auto& [a, b] : all) {
      named.insert({a, b});
      if (a == b) continue;
      joined.insert({a, b});
      const Element edge{std::int32_t(edges_.size()), {b, a, b}};
      edges_.insert(edge);
      if (!sides.contains({a, b})) bare_edges_.insert(edge);
    }
    for (const Primitive& point : scene_.points) named.insert(point[0]);
    for (const std::int32_t v : named) {
      vertices_[v] = {v, v, v};
      if (!joined.contains(v)) points_[v] = {v, v, v};
    }
    for (const auto& [a, b, c] : scene_.apart) apart_.insert({{a, b}, {b, a}});
    text_ += std::to_string(vertices_.size()) + " vertices, " + std::to_string(edges_.size()) +
             " edges, " + std::to_string(faces_.size()) + " faces\n";
  }

  /// \returns whether the claim is a contact at time 0.
  bool read_claim() {
    read_text();
    reader_.begin("claim");
    const bool is_earliest = reader_.one_of({"no_contact", "earliest"}) == 1;
    if (is_earliest) pair_.lower = read_number(reader_);
    pair_.upper = read_number(reader_);
    reader_.end();
    end_ = is_earliest ? pair_.lower : pair_.upper;
    const bool is_at_zero = is_earliest && end_ == 0 && pair_.upper == 0;
    if (end_ < 0 || pair_.upper > 1 || (is_earliest && !is_at_zero && end_ >= pair_.upper)) {
      reject("a claim is no_contact T, earliest 0 0 or earliest LO HI, 0 <= LO < HI <= 1");
    }
    if (!is_earliest) return false;
    read_text();
    reader_.begin("pair");
    const PairKind& kind =
        kinds_.at(reader_.one_of({"vertex_face", "edge_edge", "vertex_edge", "vertex_vertex"}));
    if (!can_collide(take_pair(kind))) reject("these two cannot collide");
    reader_.end();
    read_contact(reader_, pair_);
    pair_.claim = Claim::collision;
    verify(pair_, line_);
    line_ = 0;
    return is_at_zero;
  }

  /// Finds all pairs that no axis keeps apart, and requires that they have an argument.
  void prove_no_contact() {
    Places places(scene_.vertices, pair_.distance.get_d(), end_);
    reader_.begin("sweep");
    const std::size_t axis = reader_.one_of({"x", "y", "z"});
    reader_.end();
    pair_.claim = Claim::no_collision, pair_.lower = 0, pair_.upper = end_;
    for (PairKind& kind : kinds_) read_arguments(kind, places);
    for (const PairKind& kind : kinds_) {
      places.find_near(kind.some, kind.others, axis, [&](const Element& a, const Element& b) {
        if (kind.proved.contains({a.first, b.first}) || !can_collide({&a, &b})) return;
        reject("no argument for " + std::string(kind.name) + ' ' + std::to_string(a.first) + ' ' +
               std::to_string(b.first));
      });
    }
  }

  /// The arguments of a kind: a pair and its direction, or a pair and lines of pieces.
  void read_arguments(PairKind& kind, const Places& places) {
    reader_.begin(kind.name);
    reader_.end();
    while (reader_.first_word().find_first_not_of("0123456789") == std::string_view::npos) {
      pair_.line = reader_.number();
      reader_.begin();
      const auto [a, b] = take_pair(kind);
      kind.proved.insert({a->first, b->first});
      if (reader_.has_word()) {
        Direction d{};
        for (auto& x : d) x = take_integer(reader_, 1 - max_direction, max_direction);
        if (!places.is_above(a->second, b->second, d)) reject("the direction separates not");
        reader_.end();
      } else {
        reader_.end();
        read_pieces(reader_, pair_);
        work_bits_ += verify(pair_, line_);
        if (work_bits_ > max_step_work_bits) reject("the proofs of all pairs take too much work");
        line_ = 0;
      }
    }
  }

  using Pair = std::array<const Element*, 2>;

  /// Takes the numbers of a pair, whose points are then those of pair_.
  Pair take_pair(const PairKind& kind) {
    const auto take = [&](const Elements& elements) {
      const auto place = elements.find(take_integer(reader_, 0, max_items));
      if (place == elements.end()) reject("there is no such element");
      return &*place;
    };
    const Pair pair{take(kind.some), take(kind.others)};
    pair_.is_edge_edge = &kind.some == &edges_;
    const Primitive &a = pair[0]->second, &b = pair[1]->second;
    const std::array points = pair_.is_edge_edge ? std::array{a[0], a[1], b[0], b[1]}
                                                 : std::array{a[0], b[0], b[1], b[2]};
    for (std::size_t k = 0; k < 24; ++k) {
      pair_.coordinates[k] = scene_.vertices[std::size_t(points[k / 3 % 4])][k / 12 * 3 + k % 3];
    }
    return pair;
  }

  [[nodiscard]] bool can_collide(const Pair& pair) const {
    bool meet = false;
    for (const std::int32_t v : pair[0]->second) {
      for (const std::int32_t w : pair[1]->second) {
        if (v == w) return false;
        const Numbers groups{scene_.groups[std::size_t(v)][0], scene_.groups[std::size_t(w)][0]};
        meet = meet || !apart_.contains(groups);
      }
    }
    return meet;
  }

  Reader& reader_;
  std::size_t& line_;
  std::string text_;
  Scene scene_;
  /// The vertices that take part, and so on.
  Elements vertices_, edges_, faces_, points_, bare_edges_;
  /// The groups that are held apart, each two in both orders.
  std::set<Numbers> apart_;
  std::array<PairKind, 4> kinds_{{{"vertex_face", vertices_, faces_},
                                  {"edge_edge", edges_, edges_},
                                  {"vertex_edge", points_, bare_edges_},
                                  {"vertex_vertex", points_, points_}}};
  /// The pair at hand, with the step's separation.
  Certificate pair_;
  /// Until when there is no contact.
  mpq_class end_;
  std::uint64_t work_bits_ = 0;
};

}  // namespace

std::string check_step(Reader& reader, Reader* scenes, std::size_t& line) {
  return StepCheck(reader, line).run(scenes);
}

}  // namespace touchstone::checker
