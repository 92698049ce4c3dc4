#include "exact/checker/step.hpp"

#include <algorithm>
#include <charconv>
#include <limits>
#include <set>

#include "exact/checker/places.hpp"
#include "exact/checker/proof.hpp"

namespace touchstone::checker {
namespace {

using Numbers = std::array<std::int32_t, 2>;

/// Takes a word that is a decimal integer from `least` to below `limit`, in its only form.
std::int32_t take_integer(Reader& reader, std::int32_t least, std::size_t limit) {
  const std::string_view word = reader.word();
  std::int32_t x = 0;
  const auto [end, error] = std::from_chars(word.begin(), word.end(), x);
  const bool is_integer = error == std::errc() && end == word.end() && std::to_string(x) == word;
  const bool is_in_range = x >= least && x < std::int64_t(limit);
  if (!is_integer || !is_in_range) reject("not an integer, or out of range: " + quoted(word));
  return x;
}

double to_double(const mpq_class& number) {
  if (abs(number) > std::numeric_limits<double>::max() || number != number.get_d())
    reject("a number that is not a double");
  return number.get_d();
}

/// A line of a keyword and a number, and so many lines: each an item, of whose numbers take() takes
/// the first `columns`. The others are as the first.
template <class Item, class Take>
std::vector<Item> read_list(Reader& reader, std::string_view keyword, std::size_t columns,
                            const Take& take) {
  std::vector<Item> list;
  reader.begin(keyword);
  std::int32_t count = take_integer(reader, 0, max_items);
  for (reader.end(); count > 0; --count) {
    reader.begin();
    Item& item = list.emplace_back();
    for (std::size_t k = 0; k < item.size(); ++k) item[k] = k < columns ? take() : item[0];
    reader.end();
  }
  return list;
}

/// What is said of the scene, as it is written.
struct Scene {
  std::vector<Motion> vertices;
  std::vector<Primitive> faces, edges, points, groups, apart;

  friend bool operator==(const Scene&, const Scene&) = default;
};

Scene read_scene(Reader& reader) {
  Scene scene;
  const auto coordinate = [&] { return to_double(read_number(reader)); };
  scene.vertices = read_list<Motion>(reader, "vertices", 6, coordinate);
  const auto integers = [&](std::string_view keyword, std::size_t columns, std::size_t limit) {
    const auto integer = [&] { return take_integer(reader, 0, limit); };
    return read_list<Primitive>(reader, keyword, columns, integer);
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
  StepCheck(Reader& reader, const Options& options)
      : reader_(reader), options_(options), work_bits_left_(options.max_step_work_bits) {}

  std::string run(Reader* scenes) {
    read_label();
    scene_ = read_scene(reader_);
    const bool is_another = scenes != nullptr && read_scene(*scenes) != scene_;
    if (is_another) reject("the scene is not the one given");
    find_elements();
    read_separation(reader_, pair_);
    to_double(pair_.distance);
    const std::string separation = separation_text(pair_);
    text_ += "separation " + separation + '\n';
    const std::size_t line = reader_.number();
    const std::string claim = read_claim();
    text_ += "claim " + claim + '\n';
    require_demanded(options_, claim, separation, line);
    if (pair_.claim == Claim::time_of_impact) read_earliest();
    pair_.claim = Claim::no_collision;
    if (pair_.has_subintervals()) prove_no_contact();
    reader_.begin("end");
    reader_.end();
    return text_;
  }

 private:
  void read_label() {
    reader_.begin("step");
    require_at_most(max_label_bytes, reader_.text().size(), "bytes in a label");
    text_ += printable(reader_.text()) + '\n';
    reader_.advance();
  }

  void find_elements() {
    scene_.groups.resize(scene_.vertices.size());
    const auto side = [](std::int32_t a, std::int32_t b) -> Numbers {
      return {std::max(a, b), std::min(a, b)};
    };
    std::map<Numbers, bool> all;  // is it the side of a face?
    for (const auto& [a, b, c] : scene_.faces) {
      faces_[std::int32_t(faces_.size())] = {a, b, c};
      all[side(a, b)] = all[side(b, c)] = all[side(c, a)] = true;
    }
    for (const Primitive& edge : scene_.edges) all.emplace(side(edge[0], edge[1]), false);
    for (const auto& [ends, is_side] : all) {
      const auto& [a, b] = ends;
      vertices_[a] = {a, a, a}, vertices_[b] = {b, b, b};
      const Element edge{std::int32_t(edges_.size()), {b, a, b}};
      if (a != b) edges_.insert(edge);
      if (a != b && !is_side) bare_edges_.insert(edge);
    }
    for (const Primitive& point : scene_.points) vertices_[point[0]] = point;
    points_ = vertices_;
    for (const auto& [number, edge] : edges_) points_.erase(edge[0]), points_.erase(edge[1]);
    for (const auto& [a, b, c] : scene_.apart) apart_.insert({{a, b}, {b, a}});
    text_ += std::to_string(vertices_.size()) + " vertices, " + std::to_string(edges_.size()) +
             " edges, " + std::to_string(faces_.size()) + " faces\n";
  }

  /// Takes the claim. \returns it, with its numbers in one form.
  std::string read_claim() {
    reader_.begin("claim");
    const bool is_no_contact = reader_.one_of({"no_contact", "earliest"}) == 0;
    pair_.claim = is_no_contact ? Claim::no_collision : Claim::time_of_impact;
    if (is_no_contact) {
      pair_.lower = read_number(reader_);
      if (pair_.lower < 0 || pair_.lower > 1) reject("a time is from 0 to 1");
    } else {
      read_time_of_impact(reader_, pair_);
    }
    reader_.end();
    if (is_no_contact) return "no_contact " + to_text(pair_.lower);
    return "earliest " + to_text(pair_.lower) + ' ' + to_text(pair_.upper);
  }

  /// Takes the pair of the earliest contact and verifies the contact.
  void read_earliest() {
    text_ += printable(reader_.text()) + '\n';
    reader_.begin("pair");
    const PairKind& kind =
        kinds_.at(reader_.one_of({"vertex_face", "edge_edge", "vertex_edge", "vertex_vertex"}));
    if (!can_collide(take_pair(kind))) reject("these two cannot collide");
    reader_.end();
    read_contact(reader_, pair_);
    pair_.claim = Claim::collision;
    verify(pair_, work_bits_left_);
  }

  /// Finds all pairs that no axis keeps apart, and requires that they have an argument.
  void prove_no_contact() {
    const Places places(scene_.vertices, pair_.distance.get_d(), pair_.lower);
    reader_.begin("sweep");
    static_cast<void>(reader_.one_of({"x", "y", "z"}));
    reader_.end();
    for (PairKind& kind : kinds_) read_arguments(kind, places);
    std::int64_t comparisons_left = options_.max_comparisons_per_byte * reader_.bytes();
    for (const PairKind& kind : kinds_) {
      const auto require_argument = [&](const Element& a, const Element& b) {
        if (kind.proved.contains({a.first, b.first}) || !can_collide({&a, &b})) return;
        reject("no argument for " + std::string(kind.name) + ' ' + std::to_string(a.first) + ' ' +
               std::to_string(b.first));
      };
      places.find_near(kind.some, kind.others, comparisons_left, require_argument);
    }
  }

  /// The arguments of a kind: a pair and its direction, or a pair and lines of subintervals.
  void read_arguments(PairKind& kind, const Places& places) {
    reader_.begin(kind.name);
    reader_.end();
    while (reader_.first_word().find_first_not_of("0123456789") == std::string_view::npos) {
      pair_.line = reader_.begin();
      const auto [a, b] = take_pair(kind);
      kind.proved.insert({a->first, b->first});
      if (reader_.has_word()) {
        Direction d{};
        for (auto& x : d) x = take_integer(reader_, 1 - max_direction, max_direction);
        if (!places.is_above(a->second, b->second, d)) reject("the direction separates not");
        reader_.end();
      } else {
        reader_.end();
        read_subintervals(reader_, pair_);
        verify(pair_, work_bits_left_);
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
  /// The pair at hand, with the step's separation and times.
  Certificate pair_;
  const Options& options_;
  std::int64_t work_bits_left_;
};

}  // namespace

std::string check_step(Reader& reader, Reader* scenes, const Options& options) {
  return StepCheck(reader, options).run(scenes);
}

}  // namespace touchstone::checker
