#include "exact/checker/step.hpp"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <utility>
#include <vector>

#include "exact/checker/places.hpp"
#include "exact/checker/proof.hpp"
#include "exact/checker/scene.hpp"

namespace touchstone::checker {
namespace {

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

constexpr std::array<const char*, 2> element_kinds{"tetrahedron", "plane_triangle"};

// ---- The certificate ----------------------------------------------------------------------------

class StepCheck {
 public:
  StepCheck(Reader& reader, const Options& options)
      : reader_(reader), options_(options), first_byte_(reader.bytes()) {}

  Proved run(Reader* scenes) {
    text_ = "step " + printable(read_label(reader_, "step")) + '\n';
    scene_ = read_scene(reader_, options_, Time::step);
    if (scenes != nullptr && read_scene(*scenes, options_, Time::step) != scene_) {
      reject("the scene is not the one given");
    }
    find_what_can_collide();
    separation_ = read_separation(reader_);
    distance_ = to_double(separation_.distance);
    find_thickness();
    read_claim();
    if (is_earliest_) prove_contact();
    const bool is_contact_at_start = is_earliest_ && upper_ == 0;
    if (!is_contact_at_start) {
      prove_no_contact();
      for (const std::size_t kind : {0U, 1U}) prove_volumes(kind);
    }
    reader_.begin("end");
    reader_.end();
    return {std::move(text_), std::move(statement_), std::move(scene_)};
  }

 private:
  void find_what_can_collide() {
    elements_ = find_elements(scene_);
    groups_ = Groups(scene_);
    const std::size_t taking_part = elements_.vertices.size();
    text_ += vertices_text(scene_, taking_part) + ", " + std::to_string(elements_.edges.size()) +
             " edges, " + std::to_string(elements_.faces.size()) + " faces\n";
    if (count_of(0) + count_of(1) > 0) {
      text_ += std::to_string(count_of(0)) + " tetrahedra, " + std::to_string(count_of(1)) +
               " plane triangles\n";
    }
    statement_.rules = rules_text(scene_.apart, scene_.vertices.size() - taking_part);
    if (!statement_.rules.empty()) text_ += "rules " + statement_.rules + '\n';
  }

  /// Finds the separations of groups, the greatest of all, and the reach of each vertex: of the
  /// reaches of two, the sum is not below the thickness of their groups.
  void find_thickness() {
    if (!is_thick()) return;
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
      const std::int32_t group = groups_.of(static_cast<std::int32_t>(n));
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
    // Of thick primitives the norm matters at 0, too.
    const std::string separation = to_text(separation_, is_thick());
    statement_.is_free = claim == "no_contact 1";
    statement_.contact = contact_text(separation_, is_thick());
    require_demanded(options_, claim, separation, statement_.rules, line);
    text_ += "separation " + separation + "\nclaim " + claim + '\n';
  }

  /// Reads the pair or the element of the earliest contact and its contact, and verifies both.
  void prove_contact() {
    text_ += printable(reader_.text()) + '\n';
    Certificate certificate =
        reader_.first_word() == "element" ? inverting_element() : colliding_pair();
    certificate.contact = read_contact(reader_, certificate.query);
    verify_within_limits(certificate);
  }

  Certificate inverting_element() {
    reader_.begin("element");
    const std::size_t kind = reader_.one_of({element_kinds[0], element_kinds[1]});
    const auto number = static_cast<std::size_t>(take_integer(reader_, 0, count_of(kind)));
    reader_.end();
    return certificate_of_element(kind, number, Claim::collision);
  }

  Certificate colliding_pair() {
    reader_.begin("pair");
    const std::size_t kind =
        reader_.one_of({"vertex_face", "edge_edge", "vertex_edge", "vertex_vertex"});
    const Pair pair = take_pair(kinds_.at(kind));
    if (!can_collide(pair.a, pair.b)) reject("these two cannot collide");
    reader_.end();
    return certificate_of(pair, Claim::collision);
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

  [[nodiscard]] bool is_thick() const {
    return !scene_.radii.empty() || !scene_.separations.empty();
  }

  [[nodiscard]] std::size_t count_of(std::size_t kind) const {
    return kind == 0 ? scene_.tetrahedra.size() : scene_.plane_triangles.size();
  }

  /// Proves that no element of a kind has a contact: each is listed with its subintervals, in the
  /// order of the numbers, or needs none.
  void prove_volumes(std::size_t kind) {
    if (count_of(kind) == 0) return;
    reader_.begin(element_kinds.at(kind));
    reader_.end();
    for (std::size_t number = 0; number < count_of(kind); ++number) {
      Certificate certificate = certificate_of_element(kind, number, Claim::no_collision);
      const std::string name = std::to_string(number);
      try {
        read_subintervals_of_element(name, certificate);
        verify_within_limits(certificate);
      } catch (const Rejection& rejection) {
        reject(element_kinds.at(kind) + (' ' + name) + ": " + rejection.reason, rejection.line);
      }
    }
  }

  void read_subintervals_of_element(const std::string& name, Certificate& certificate) {
    if (reader_.first_word() != name) {
      certificate.subintervals.resize(1);
      certificate.subintervals[0].to = lower_;
      return;
    }
    require_at_most(options_.max_arguments, ++arguments_, "arguments");
    certificate.line = reader_.begin(name);
    reader_.end();
    certificate.subintervals = read_subintervals(reader_, certificate.query);
  }

  /// A certificate of an element, without its proof.
  [[nodiscard]] Certificate certificate_of_element(std::size_t kind, std::size_t number,
                                                   Claim claim) const {
    Certificate certificate = empty_certificate(claim);
    certificate.query.kind = Kind::tetrahedron;
    if (kind == 0) {
      set_points(scene_.tetrahedra[number], certificate.query);
      return certificate;
    }
    const auto& [a, b, c] = scene_.plane_triangles[number];
    set_points({a, b, c, b}, certificate.query);
    for (std::size_t n = 0; n < 4; ++n) {
      for (Point& point : certificate.query.points[n].control) point[2] = n == 3 ? 1 : 0;
    }
    return certificate;
  }

  void set_points(const std::array<std::int32_t, 4>& vertices, Query& query) const {
    for (std::size_t n = 0; n < 4; ++n) {
      const Motion& vertex = scene_.vertices[static_cast<std::size_t>(vertices[n])];
      for (const auto& [x, y, z] : {vertex.start, vertex.end}) {
        query.points[n].control.push_back({x, y, z});
      }
    }
  }

  [[nodiscard]] Certificate empty_certificate(Claim claim) const {
    Certificate certificate;
    certificate.claim = claim;
    certificate.lower = lower_;
    certificate.upper = upper_;
    return certificate;
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
    Certificate certificate = empty_certificate(claim);
    certificate.separation = separation_;
    certificate.separation.distance = distance_of(pair.a, pair.b);
    // The first of two is a vertex, all of whose numbers are the same, or an edge.
    const bool is_edge_edge = a[0] != a[1];
    const std::array<std::int32_t, 4> of_vertex_and_face{a[0], b[0], b[1], b[2]};
    const std::array<std::int32_t, 4> of_edges{a[0], a[1], b[0], b[1]};
    certificate.query.kind = is_edge_edge ? Kind::edge_edge : Kind::vertex_face;
    set_points(is_edge_edge ? of_edges : of_vertex_and_face, certificate.query);
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
    const auto is_of_b = [&](std::int32_t v) { return std::ranges::count(b.vertices, v) > 0; };
    return std::ranges::none_of(a.vertices, is_of_b) && groups_.meet(a, b);
  }

  /// The distance at which two primitives are in contact.
  [[nodiscard]] double distance_of(const Primitive& a, const Primitive& b) const {
    if (thickness_.reaches.empty()) return distance_;
    double greatest = 0.0;
    for (const std::int32_t v : a.vertices) {
      for (const std::int32_t w : b.vertices) {
        greatest = std::max(greatest, thickness_of(groups_.of(v), groups_.of(w)));
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

  Reader& reader_;
  const Options& options_;
  /// The first byte of the certificate.
  std::int64_t first_byte_;
  /// The proved claims, as text.
  std::string text_;
  Statement statement_;
  Scene scene_;
  Elements elements_;
  Groups groups_;
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

Proved check_step(Reader& reader, Reader* scenes, const Options& options) {
  return StepCheck(reader, options).run(scenes);
}

}  // namespace touchstone::checker
