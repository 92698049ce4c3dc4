#include "exact/checker/step.hpp"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <limits>
#include <map>
#include <tuple>
#include <vector>

#include "exact/checker/places.hpp"
#include "exact/checker/proof.hpp"

namespace touchstone::checker {
namespace {

// ---- The scene ----------------------------------------------------------------------------------

using Face = std::array<std::int32_t, 3>;
/// The numbers of two vertices, two groups or two primitives.
using Two = std::array<std::int32_t, 2>;

/// Two groups and the thickness of their pairs.
struct GroupSeparation {
  Two groups{};
  double distance = 0.0;

  friend bool operator==(const GroupSeparation&, const GroupSeparation&) = default;
};

/// The scene as it is written.
struct Scene {
  std::vector<Motion> vertices;
  std::vector<Face> faces;
  std::vector<Two> edges;
  std::vector<std::int32_t> points;
  std::vector<std::int32_t> groups;
  std::vector<Two> apart;
  std::vector<double> radii;
  std::vector<GroupSeparation> separations;

  friend bool operator==(const Scene&, const Scene&) = default;
};

/// Takes a word that is a decimal integer from `least` to below `limit`, in its only form.
std::int32_t take_integer(Reader& reader, std::int32_t least, std::size_t limit) {
  const std::string_view word = reader.word();
  std::int32_t x = 0;
  const auto [end, error] = std::from_chars(word.data(), word.data() + word.size(), x);
  const bool is_integer = error == std::errc() && std::to_string(x) == word;
  const bool is_in_range = x >= least && x < static_cast<std::int64_t>(limit);
  if (!is_integer || !is_in_range) reject("not an integer, or out of range: " + quoted(word));
  return x;
}

/// Takes any integer that is not below 0.
std::int32_t take_count(Reader& reader) {
  return take_integer(reader, 0, std::numeric_limits<std::int32_t>::max());
}

double to_double(const mpq_class& number) {
  const bool is_in_range = abs(number) <= std::numeric_limits<double>::max();
  if (!is_in_range || number != number.get_d()) reject("a number that is not a double");
  return number.get_d();
}

/// Takes a double that is not below 0.
double take_length(Reader& reader) {
  const double length = to_double(take_number(reader));
  if (length < 0.0) reject("a distance below 0");
  return length;
}

/// Reads a line of a keyword and a number, and as many lines: take() makes an item of each.
template <class Item, class Take>
std::vector<Item> read_list(Reader& reader, std::string_view keyword, std::size_t& items_left,
                            const Take& take) {
  reader.begin(keyword);
  const auto count = static_cast<std::size_t>(take_count(reader));
  if (count > items_left) reject("the scene has too many items");
  items_left -= count;
  reader.end();
  std::vector<Item> list;
  for (std::size_t n = 0; n < count; ++n) {
    reader.begin();
    list.push_back(take());
    reader.end();
  }
  return list;
}

Scene read_scene(Reader& reader, const Options& options) {
  std::size_t items_left = options.max_items;
  Scene scene;
  scene.vertices = read_list<Motion>(reader, "vertices", items_left, [&] {
    Motion motion;
    for (double& x : motion.start) x = to_double(take_number(reader));
    for (double& x : motion.end) x = to_double(take_number(reader));
    return motion;
  });
  const std::size_t count = scene.vertices.size();
  const auto vertex = [&] { return take_integer(reader, 0, count); };
  const auto group = [&] { return take_count(reader); };
  // The numbers in braces are taken from the left to the right.
  const auto three_vertices = [&] { return Face{vertex(), vertex(), vertex()}; };
  const auto two_vertices = [&] { return Two{vertex(), vertex()}; };
  const auto two_groups = [&] { return Two{group(), group()}; };
  scene.faces = read_list<Face>(reader, "faces", items_left, three_vertices);
  scene.edges = read_list<Two>(reader, "edges", items_left, two_vertices);
  scene.points = read_list<std::int32_t>(reader, "points", items_left, vertex);
  scene.groups = read_list<std::int32_t>(reader, "groups", items_left, group);
  if (!scene.groups.empty() && scene.groups.size() != count) reject("not a group for each vertex");
  scene.apart = read_list<Two>(reader, "apart", items_left, two_groups);
  scene.radii = read_list<double>(reader, "radii", items_left, [&] { return take_length(reader); });
  const auto separation = [&] { return GroupSeparation{two_groups(), take_length(reader)}; };
  scene.separations = read_list<GroupSeparation>(reader, "separations", items_left, separation);
  return scene;
}

// ---- Its primitives -----------------------------------------------------------------------------

/// The primitives that take part.
struct Elements {
  Primitives vertices;
  Primitives edges;
  Primitives faces;
  /// The vertices without an edge.
  Primitives points;
  /// The edges of no face.
  Primitives bare_edges;
};

/// The next number of a list.
std::int32_t next_number(const Primitives& primitives) {
  return static_cast<std::int32_t>(primitives.size());
}

/// An edge by its vertices. Edges are numbered in the order of these.
struct Edge {
  std::int32_t larger;
  std::int32_t smaller;
  /// True for an edge of no face.
  bool is_bare;
};

/// All edges of the scene, each once, in the order of their numbers.
std::vector<Edge> find_edges(const Scene& scene) {
  std::vector<Edge> edges;
  const auto add = [&](std::int32_t a, std::int32_t b, bool is_bare) {
    edges.push_back({std::max(a, b), std::min(a, b), is_bare});
  };
  for (const auto& [a, b, c] : scene.faces) {
    add(a, b, false);
    add(b, c, false);
    add(c, a, false);
  }
  for (const auto& [a, b] : scene.edges) add(a, b, true);
  // The first of several with the same vertices is that of a face, if there is one.
  std::sort(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return std::tie(a.larger, a.smaller, a.is_bare) < std::tie(b.larger, b.smaller, b.is_bare);
  });
  const auto repeated = std::unique(edges.begin(), edges.end(), [](const Edge& a, const Edge& b) {
    return a.larger == b.larger && a.smaller == b.smaller;
  });
  edges.erase(repeated, edges.end());
  return edges;
}

Elements find_elements(const Scene& scene) {
  Elements elements;
  for (const Face& face : scene.faces) {
    elements.faces.push_back({next_number(elements.faces), face});
  }
  std::vector<bool> takes_part(scene.vertices.size());
  std::vector<bool> has_edge(scene.vertices.size());
  for (const auto& [larger, smaller, is_bare] : find_edges(scene)) {
    takes_part[static_cast<std::size_t>(larger)] = true;
    takes_part[static_cast<std::size_t>(smaller)] = true;
    // No edge goes from a vertex to itself.
    if (larger == smaller) continue;
    has_edge[static_cast<std::size_t>(larger)] = true;
    has_edge[static_cast<std::size_t>(smaller)] = true;
    const Primitive edge{next_number(elements.edges), {smaller, larger, smaller}};
    elements.edges.push_back(edge);
    if (is_bare) elements.bare_edges.push_back(edge);
  }
  for (const std::int32_t vertex : scene.points) {
    takes_part[static_cast<std::size_t>(vertex)] = true;
  }
  for (std::size_t n = 0; n < scene.vertices.size(); ++n) {
    const auto number = static_cast<std::int32_t>(n);
    const Primitive vertex{number, {number, number, number}};
    if (takes_part[n]) elements.vertices.push_back(vertex);
    if (takes_part[n] && !has_edge[n]) elements.points.push_back(vertex);
  }
  return elements;
}

/// \throws Rejection if there is none of this number.
const Primitive& find(const Primitives& primitives, std::int32_t number) {
  const auto place = std::ranges::lower_bound(primitives, number, {}, &Primitive::number);
  if (place == primitives.end() || place->number != number) reject("there is no such element");
  return *place;
}

/// A kind of pairs.
struct PairKind {
  const char* name;
  const Primitives& some;
  const Primitives& others;
  /// The numbers of those that have an argument, in order.
  std::vector<Two> proved = {};
};

struct Pair {
  const Primitive& a;
  const Primitive& b;
};

// ---- The certificate ----------------------------------------------------------------------------

class StepCheck {
 public:
  StepCheck(Reader& reader, const Options& options)
      : reader_(reader), options_(options), first_byte_(reader.bytes()) {}

  std::string run(Reader* scenes) {
    text_ = "step " + printable(read_label(reader_, "step")) + '\n';
    scene_ = read_scene(reader_, options_);
    if (scenes != nullptr && read_scene(*scenes, options_) != scene_) {
      reject("the scene is not the one given");
    }
    find_what_can_collide();
    separation_ = read_separation(reader_);
    distance_ = to_double(separation_.distance);
    find_thickness();
    read_claim();
    if (is_earliest_) prove_contact();
    const bool is_contact_at_start = is_earliest_ && upper_ == 0;
    if (!is_contact_at_start) prove_no_contact();
    reader_.begin("end");
    reader_.end();
    return text_;
  }

 private:
  void find_what_can_collide() {
    elements_ = find_elements(scene_);
    for (const auto& [one, other] : scene_.apart) {
      apart_.push_back({one, other});
      apart_.push_back({other, one});
    }
    std::ranges::sort(apart_);
    text_ += std::to_string(elements_.vertices.size()) + " vertices, " +
             std::to_string(elements_.edges.size()) + " edges, " +
             std::to_string(elements_.faces.size()) + " faces\n";
  }

  /// Finds the separations of groups, the greatest of all, and the reach of each vertex: of the
  /// reaches of two, the sum is not below the thickness of their groups.
  void find_thickness() {
    if (scene_.radii.empty() && scene_.separations.empty()) return;
    const auto groups = static_cast<std::int32_t>(scene_.radii.size());
    double greatest = 0.0;
    for (const double radius : scene_.radii) greatest = std::max(greatest, 2.0 * radius);
    std::map<std::int32_t, double> halves;
    for (const auto& [two, distance] : scene_.separations) {
      const auto& [one, other] = two;
      const Two in_order{std::min(one, other), std::max(one, other)};
      if (!separations_.emplace(in_order, distance).second) reject("two groups are listed twice");
      greatest = std::max(greatest, distance);
      // (Half of the least double would be 0.)
      const double half = std::max(distance / 2.0, distance - distance / 2.0);
      for (const std::int32_t group : two) halves[group] = std::max(halves[group], half);
    }
    thickness_.greatest = distance_ + greatest;
    if (!std::isfinite(thickness_.greatest)) reject("the distances are too large");
    for (std::size_t n = 0; n < scene_.vertices.size(); ++n) {
      const std::int32_t group = group_of(static_cast<std::int32_t>(n));
      if (groups > 0 && group >= groups) reject("not a radius for each group");
      const auto half = halves.find(group);
      thickness_.reaches.push_back(
          std::max(radius_of(group), half == halves.end() ? 0.0 : half->second));
    }
    text_ += std::to_string(scene_.radii.size()) + " radii, " +
             std::to_string(scene_.separations.size()) + " separations of groups\n";
  }

  void read_claim() {
    std::string claim;
    const std::size_t line = reader_.begin("claim");
    is_earliest_ = reader_.one_of({"no_contact", "earliest"}) == 1;
    if (is_earliest_) {
      take_time_of_impact(reader_, lower_, upper_);
      claim = "earliest " + to_text(lower_) + ' ' + to_text(upper_);
    } else {
      lower_ = take_number(reader_);
      if (lower_ < 0 || lower_ > 1) reject("a time is from 0 to 1");
      claim = "no_contact " + to_text(lower_);
    }
    reader_.end();
    const std::string separation = to_text(separation_);
    require_demanded(options_, claim, separation, line);
    text_ += "separation " + separation + "\nclaim " + claim + '\n';
  }

  /// Reads the pair of the earliest contact and its contact, and verifies both.
  void prove_contact() {
    text_ += printable(reader_.text()) + '\n';
    reader_.begin("pair");
    const std::size_t kind =
        reader_.one_of({"vertex_face", "edge_edge", "vertex_edge", "vertex_vertex"});
    const Pair pair = take_pair(kinds_.at(kind));
    if (!can_collide(pair.a, pair.b)) reject("these two cannot collide");
    reader_.end();
    Certificate certificate = certificate_of(pair, Claim::collision);
    certificate.contact = read_contact(reader_, certificate.query);
    verify_within_limits(certificate);
  }

  /// Finds all pairs that no axis keeps apart, and requires that they have an argument.
  void prove_no_contact() {
    const Places places(scene_.vertices, distance_, lower_, thickness_);
    read_sweep();
    for (PairKind& kind : kinds_) read_arguments(kind, places);
    std::int64_t comparisons_left = options_.max_comparisons_per_byte * bytes_read();
    for (const PairKind& kind : kinds_) {
      const auto require_argument = [&](const Primitive& a, const Primitive& b) {
        const Two numbers{a.number, b.number};
        if (std::ranges::binary_search(kind.proved, numbers) || !can_collide(a, b)) return;
        if (places.is_axis_between(a, b, places.enlarged(distance_of(a, b)))) return;
        reject("no argument for " + std::string(kind.name) + ' ' + std::to_string(a.number) + ' ' +
               std::to_string(b.number));
      };
      places.find_near(kind.some, kind.others, comparisons_left, require_argument);
    }
  }

  /// Reads the axis for checkers that sort boxes along one.
  void read_sweep() {
    reader_.begin("sweep");
    reader_.one_of({"x", "y", "z"});
    reader_.end();
  }

  /// Reads the arguments of a kind, and verifies each.
  void read_arguments(PairKind& kind, const Places& places) {
    reader_.begin(kind.name);
    reader_.end();
    while (reader_.first_word().find_first_not_of("0123456789") == std::string_view::npos) {
      require_at_most(options_.max_arguments, ++arguments_, "arguments");
      read_argument(kind, places);
    }
    std::ranges::sort(kind.proved);
  }

  /// An argument: a pair and its direction, or a pair and lines of subintervals.
  void read_argument(PairKind& kind, const Places& places) {
    const std::size_t line = reader_.begin();
    const Pair pair = take_pair(kind);
    kind.proved.push_back({pair.a.number, pair.b.number});
    if (reader_.has_word()) {
      const Direction direction = take_direction();
      const std::int64_t distance = places.enlarged(distance_of(pair.a, pair.b));
      if (!places.is_above(pair.a, pair.b, direction, distance)) {
        reject("the direction separates not");
      }
      reader_.end();
      return;
    }
    reader_.end();
    Certificate certificate = certificate_of(pair, Claim::no_collision);
    certificate.line = line;
    certificate.subintervals = read_subintervals(reader_, certificate.query);
    verify_within_limits(certificate);
  }

  Direction take_direction() {
    Direction direction{};
    for (auto& x : direction) x = take_integer(reader_, 1 - max_direction, max_direction);
    return direction;
  }

  /// Takes the numbers of a pair.
  Pair take_pair(const PairKind& kind) {
    const Primitive& a = find(kind.some, take_count(reader_));
    const Primitive& b = find(kind.others, take_count(reader_));
    return {a, b};
  }

  /// A certificate of two primitives, without its proof.
  [[nodiscard]] Certificate certificate_of(const Pair& pair, Claim claim) const {
    const Face& a = pair.a.vertices;
    const Face& b = pair.b.vertices;
    Certificate certificate;
    certificate.separation = separation_;
    certificate.separation.distance = distance_of(pair.a, pair.b);
    certificate.claim = claim;
    certificate.lower = lower_;
    certificate.upper = upper_;
    // The first of two is a vertex, all of whose numbers are the same, or an edge.
    const bool is_edge_edge = a[0] != a[1];
    const std::array<std::int32_t, 4> of_vertex_and_face{a[0], b[0], b[1], b[2]};
    const std::array<std::int32_t, 4> of_edges{a[0], a[1], b[0], b[1]};
    certificate.query.is_edge_edge = is_edge_edge;
    for (std::size_t n = 0; n < 4; ++n) {
      const std::int32_t number = is_edge_edge ? of_edges[n] : of_vertex_and_face[n];
      const Motion& vertex = scene_.vertices[static_cast<std::size_t>(number)];
      for (const auto& [x, y, z] : {vertex.start, vertex.end}) {
        certificate.query.points[n].control.push_back({x, y, z});
      }
    }
    return certificate;
  }

  void verify_within_limits(const Certificate& certificate) {
    const std::int64_t allowed =
        options_.max_work_bits + options_.max_step_work_bits_per_byte * bytes_read();
    std::int64_t work_bits_left = allowed - work_bits_used_;
    verify(certificate, work_bits_left);
    work_bits_used_ = allowed - work_bits_left;
  }

  /// The bytes of the certificate so far.
  [[nodiscard]] std::int64_t bytes_read() const { return reader_.bytes() - first_byte_; }

  [[nodiscard]] bool can_collide(const Primitive& a, const Primitive& b) const {
    bool do_groups_meet = false;
    for (const std::int32_t v : a.vertices) {
      for (const std::int32_t w : b.vertices) {
        if (v == w) return false;
        const Two groups{group_of(v), group_of(w)};
        if (!std::ranges::binary_search(apart_, groups)) do_groups_meet = true;
      }
    }
    return do_groups_meet;
  }

  /// The distance at which two primitives are in contact.
  [[nodiscard]] double distance_of(const Primitive& a, const Primitive& b) const {
    if (thickness_.reaches.empty()) return distance_;
    double greatest = 0.0;
    for (const std::int32_t v : a.vertices) {
      for (const std::int32_t w : b.vertices) {
        greatest = std::max(greatest, thickness_of(group_of(v), group_of(w)));
      }
    }
    return distance_ + greatest;
  }

  [[nodiscard]] double thickness_of(std::int32_t one, std::int32_t other) const {
    const auto listed = separations_.find({std::min(one, other), std::max(one, other)});
    return listed != separations_.end() ? listed->second : radius_of(one) + radius_of(other);
  }

  [[nodiscard]] double radius_of(std::int32_t group) const {
    return scene_.radii.empty() ? 0.0 : scene_.radii[static_cast<std::size_t>(group)];
  }

  /// The group of a vertex: 0 if there are no groups.
  [[nodiscard]] std::int32_t group_of(std::int32_t vertex) const {
    return scene_.groups.empty() ? 0 : scene_.groups[static_cast<std::size_t>(vertex)];
  }

  Reader& reader_;
  const Options& options_;
  /// The first byte of the certificate.
  std::int64_t first_byte_;
  /// The proved claims, as text.
  std::string text_;
  Scene scene_;
  Elements elements_;
  /// The groups that are held apart, each two in both orders; sorted.
  std::vector<Two> apart_;
  Separation separation_;
  double distance_ = 0.0;
  Thickness thickness_;
  /// The thickness of groups that are listed, the smaller number first.
  std::map<Two, double> separations_;
  /// No contact in [0,lower]; if the claim is `earliest`, one in [lower,upper].
  bool is_earliest_ = false;
  mpq_class lower_ = 0;
  mpq_class upper_ = 1;
  std::array<PairKind, 4> kinds_{{
      {"vertex_face", elements_.vertices, elements_.faces},
      {"edge_edge", elements_.edges, elements_.edges},
      {"vertex_edge", elements_.points, elements_.bare_edges},
      {"vertex_vertex", elements_.points, elements_.points},
  }};
  std::size_t arguments_ = 0;
  std::int64_t work_bits_used_ = 0;
};

}  // namespace

std::string check_step(Reader& reader, Reader* scenes, const Options& options) {
  return StepCheck(reader, options).run(scenes);
}

}  // namespace touchstone::checker
