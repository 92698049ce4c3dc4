#include "verify/jobs/prove_step.hpp"

#include <fmt/format.h>
#include <oneapi/tbb/parallel_for.h>
#include <oneapi/tbb/task_arena.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <mutex>
#include <optional>
#include <tuple>
#include <utility>
#include <vector>

#include "exact/certificate/separation_intervals.hpp"
#include "exact/certificate/step_certificate_text.hpp"
#include "exact/contact/corner_motion.hpp"
#include "touchstone/broad_phase.hpp"
#include "touchstone/certificate.hpp"
#include "touchstone/certificate_text.hpp"
#include "touchstone/oracle.hpp"
#include "verify/base/cores.hpp"
#include "verify/base/deadline.hpp"
#include "verify/jobs/step_places.hpp"

namespace touchstone::verify::jobs {
namespace {

/// A pair of the step.
struct Pair {
  fast::PairKind kind;
  fast::IndexPair numbers;

  [[nodiscard]] std::size_t kind_number() const { return static_cast<std::size_t>(kind); }
  [[nodiscard]] std::string_view kind_name() const {
    return exact::step_pair_kinds.at(kind_number());
  }
};

/// The vertices of a pair's primitives, each once.
struct PairVertices {
  PairVertices(const fast::Step& step, const Pair& pair)
      : all(step.vertices_of(pair.kind, pair.numbers)) {
    const std::span points(all);
    switch (pair.kind) {
      case fast::PairKind::edge_edge:
        first = points.first(2);
        second = points.last(2);
        return;
      case fast::PairKind::vertex_face:
        first = points.first(1);
        second = points.last(3);
        return;
      case fast::PairKind::vertex_edge:
        first = points.first(1);
        second = points.subspan(1, 2);
        return;
      case fast::PairKind::vertex_vertex:
        first = points.first(1);
        second = points.subspan(1, 1);
    }
  }
  PairVertices(const PairVertices&) = delete;
  PairVertices& operator=(const PairVertices&) = delete;
  PairVertices(PairVertices&&) = delete;
  PairVertices& operator=(PairVertices&&) = delete;
  ~PairVertices() = default;

  std::array<std::int32_t, moving_points> all;
  StepPlaces::Vertices first;
  StepPlaces::Vertices second;
};

/// The name of a kind of elements in certificates.
std::string_view keyword_of(Kind kind) {
  return exact::step_element_kinds.at(kind == Kind::plane_triangle ? 1 : 0);
}

/// The earliest contact: the pair or the element, and the certificate of its time.
struct FirstContact {
  std::string name;
  exact::Certificate certificate;
};

/// The contact with the least time. Enclosures do not tell which it is: the oracle does.
std::optional<FirstContact> first_contact(const fast::Step& step) {
  const std::optional<fast::StepImpact> impact = step.earliest();
  if (!impact) return std::nullopt;
  struct Candidate {
    std::string name;
    Kind kind;
    Query query;
    exact::Decision decision;
  };
  std::optional<Candidate> first;
  const auto consider = [&](std::string name, Kind kind, const Query& query,
                            const Separation& separation) {
    exact::Decision decision = exact::decide(kind, query, separation);
    if (!decision.toi || (first && *decision.toi >= *first->decision.toi)) return;
    first = {std::move(name), kind, query, std::move(decision)};
  };
  for (const fast::StepCollision& collision : impact->pairs) {
    const Pair pair{collision.kind, collision.pair};
    const auto& [i, j] = pair.numbers;
    consider(fmt::format("pair {} {} {}", pair.kind_name(), i, j), fast::Step::kind_of(pair.kind),
             step.query_of(pair.kind, pair.numbers), step.separation_of(pair.kind, pair.numbers));
  }
  for (const fast::StepInversion& one : impact->inversions) {
    if (first && *first->decision.toi == exact::Rational(0)) break;
    consider(fmt::format("element {} {}", keyword_of(one.kind), one.element), Kind::tetrahedron,
             step.query_of(one.kind, one.element), {});
  }
  if (!first) throw std::logic_error("touchstone: the earliest impact is none");
  return FirstContact{std::move(first->name),
                      exact::prove(first->kind, first->query, first->decision)};
}

/// The arguments of some pairs, as text.
struct PairArguments {
  std::string text;
  std::uint64_t directions = 0;
  std::uint64_t certificates = 0;
  std::string failure;
};

class StepProver {
 public:
  StepProver(const fast::Step& step, const StepProofOptions& options)
      : step_(step), mesh_(step.mesh()), options_(options) {}

  StepProof run() {
    try {
      // First, as it may exceed the limits, and the search takes long.
      write_scene();
      const std::optional<FirstContact> first = first_contact(step_);
      write_claim(first);
      const bool is_at_zero = first && sgn(first->certificate.toi.upper) == 0;
      if (!is_at_zero) write_arguments();
      if (!is_at_zero) {
        write_volumes(Kind::tetrahedron, mesh_.tetrahedra.size());
        write_volumes(Kind::plane_triangle, mesh_.plane_triangles.size());
      }
    } catch (const exact::CertificateLimitError& error) {
      proof_.failure = error.what();
    }
    if (proof_.is_complete()) put("end\n");
    return std::move(proof_);
  }

 private:
  void put(std::string_view text) {
    proof_.bytes += text.size();
    if (options_.on_text) options_.on_text(text);
  }

  void progress(double fraction) const {
    if (options_.on_progress) options_.on_progress(fraction);
  }

  // ---- What is claimed ----

  void write_scene() {
    const fast::MovingVertices& vertices = step_.vertices();
    const std::vector<fast::Edge> edges = bare_edges();
    const fast::CollisionGroups& rules = step_.groups();
    const bool are_needed =
        !rules.apart.empty() || !rules.radii.empty() || !rules.separations.empty();
    const auto groups = are_needed ? std::span(rules.of_vertices) : std::span<const std::int32_t>();
    const std::size_t items = vertices.size() + mesh_.faces.size() + edges.size() +
                              mesh_.points.size() + groups.size() + rules.apart.size() +
                              rules.radii.size() + rules.separations.size() +
                              mesh_.tetrahedra.size() + mesh_.plane_triangles.size();
    if (items > exact::step_item_limit) {
      throw exact::CertificateLimitError(
          fmt::format("the scene has more than {} items", exact::step_item_limit));
    }
    proof_.statement.rules = checker::rules_text({rules.apart.begin(), rules.apart.end()},
                                                 vertices.size() - vertices_of(edges));
    std::string text;
    exact::write_step_head(text, options_.label, vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      exact::write_step_vertex(text, std::span(vertices[i].start).first<3>(),
                               std::span(vertices[i].end).first<3>());
    }
    exact::write_step_list(text, "faces", mesh_.faces);
    exact::write_step_list(text, "edges", edges);
    exact::write_step_list(text, "points", as_items(mesh_.points));
    exact::write_step_list(text, "groups", as_items(groups));
    exact::write_step_list(text, "apart", rules.apart);
    write_thickness(text);
    const auto& [tetrahedra, plane_triangles] = exact::step_element_lists;
    if (!mesh_.tetrahedra.empty()) exact::write_step_list(text, tetrahedra, mesh_.tetrahedra);
    if (!mesh_.plane_triangles.empty()) {
      exact::write_step_list(text, plane_triangles, mesh_.plane_triangles);
    }
    put(text);
  }

  void write_thickness(std::string& text) const {
    const auto to = std::back_inserter(text);
    fmt::format_to(to, "radii {}\n", step_.groups().radii.size());
    for (const double radius : step_.groups().radii) {
      exact::write_hexadecimal(text, radius);
      text += '\n';
    }
    fmt::format_to(to, "separations {}\n", step_.groups().separations.size());
    for (const auto& [groups, distance] : step_.groups().separations) {
      fmt::format_to(to, "{} {} ", groups[0], groups[1]);
      exact::write_hexadecimal(text, distance);
      text += '\n';
    }
  }

  static std::vector<std::array<std::int32_t, 1>> as_items(std::span<const std::int32_t> numbers) {
    std::vector<std::array<std::int32_t, 1>> items;
    for (const std::int32_t number : numbers) items.push_back({number});
    return items;
  }

  /// The number of vertices that a face, one of these edges or a point names.
  [[nodiscard]] std::size_t vertices_of(const std::vector<fast::Edge>& edges) const {
    std::vector<bool> is_named(step_.vertices().size());
    const auto name = [&](std::int32_t v) { is_named[static_cast<std::size_t>(v)] = true; };
    for (const fast::Face& face : parts_.faces) std::ranges::for_each(face, name);
    for (const fast::Edge& edge : edges) std::ranges::for_each(edge, name);
    std::ranges::for_each(parts_.points, name);
    return static_cast<std::size_t>(std::ranges::count(is_named, true));
  }

  /// The edges of no face.
  [[nodiscard]] std::vector<fast::Edge> bare_edges() const {
    const std::vector<fast::Edge> sides = fast::edges_of(mesh_.faces);
    std::vector<fast::Edge> result;
    std::ranges::set_difference(mesh_.edges, sides, std::back_inserter(result),
                                [](const fast::Edge& a, const fast::Edge& b) {
                                  return std::tie(a[1], a[0]) < std::tie(b[1], b[0]);
                                });
    return result;
  }

  void write_claim(const std::optional<FirstContact>& first) {
    end_ = first ? first->certificate.toi.lower : exact::Rational(step_.options().t_max);
    exact::StepClaim claim{.separation = step_.options().separation, .end = end_};
    if (first) {
      claim.earliest = {.upper = first->certificate.toi.upper,
                        .name = first->name,
                        .proof = *first->certificate.contact};
    }
    proof_.claim = to_text(claim);
    proof_.statement.is_free = proof_.claim == "no_contact 1";
    proof_.statement.contact = checker::contact_text(
        {.distance = claim.separation.distance, .is_l2 = claim.separation.norm == Norm::l2},
        !parts_.groups.radii.empty() || !parts_.groups.separations.empty());
    std::string text;
    exact::write_step_claim(text, claim);
    put(text);
  }

  // ---- PairArguments ----

  void write_arguments() {
    places_.emplace(step_.vertices(), greatest_distance(), end_);
    put(fmt::format("sweep {}\n", "xyz"[longest_axis()]));
    const std::vector<Pair> pairs = needed_pairs();
    if (pairs.size() > exact::step_argument_limit) {
      throw exact::CertificateLimitError(
          fmt::format("more than {} pairs need an argument", exact::step_argument_limit));
    }
    static constexpr std::size_t block = 32'768;
    std::size_t done = 0;
    for (std::size_t kind = 0; kind < exact::step_pair_kinds.size(); ++kind) {
      put(fmt::format("{}\n", exact::step_pair_kinds.at(kind)));
      const auto end = static_cast<std::size_t>(
          std::ranges::find_if(pairs.begin() + static_cast<std::ptrdiff_t>(done), pairs.end(),
                               [&](const Pair& pair) { return pair.kind_number() != kind; }) -
          pairs.begin());
      for (; done < end; done = std::min(done + block, end)) {
        write_block(std::span(pairs).subspan(done, std::min(block, end - done)));
        if (!proof_.is_complete()) return;
        progress(static_cast<double>(std::min(done + block, end)) /
                 static_cast<double>(pairs.size()));
      }
    }
  }

  /// A bound of the distances at which pairs are in contact.
  [[nodiscard]] double greatest_distance() const {
    double thickness = 0.0;
    for (const double radius : step_.groups().radii) thickness = std::max(thickness, 2.0 * radius);
    for (const fast::GroupSeparation& one : step_.groups().separations) {
      thickness = std::max(thickness, one.distance);
    }
    return step_.options().separation.distance + thickness;
  }

  [[nodiscard]] std::size_t longest_axis() const {
    const fast::MovingVertices& vertices = step_.vertices();
    std::array<double, 3> lower{}, upper{};
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      for (std::size_t k = 0; k < 3; ++k) {
        const double x = vertices[i].start.at(k);
        lower.at(k) = i == 0 ? x : std::min(lower.at(k), x);
        upper.at(k) = i == 0 ? x : std::max(upper.at(k), x);
      }
    }
    std::size_t longest = 0;
    for (const std::size_t k : {1U, 2U}) {
      if (0.5 * upper.at(k) - 0.5 * lower.at(k) > 0.5 * upper.at(longest) - 0.5 * lower.at(longest))
        longest = k;
    }
    return longest;
  }

  /// The pairs that the checker does not see kept apart by an axis, in order.
  [[nodiscard]] std::vector<Pair> needed_pairs() const {
    // The checker's integers may bring boxes a little nearer.
    Separation wider = step_.options().separation;
    wider.distance += places_->uncertainty();
    const fast::Step near = step_.with_separation(wider);
    std::vector<Pair> pairs;
    std::mutex mutex;
    near.candidates([&](const fast::StepCandidates& some) {
      std::vector<Pair> needed;
      for (const fast::IndexPair& numbers : some.pairs) {
        const Pair pair{some.kind, numbers};
        const PairVertices vertices(step_, pair);
        const double distance = step_.separation_of(pair.kind, pair.numbers).distance;
        if (!places_->is_axis_between(vertices.first, vertices.second, distance)) {
          needed.push_back(pair);
        }
      }
      const std::scoped_lock lock(mutex);
      pairs.insert(pairs.end(), needed.begin(), needed.end());
    });
    std::ranges::sort(pairs, {},
                      [](const Pair& pair) { return std::tuple(pair.kind, pair.numbers); });
    return pairs;
  }

  void write_block(std::span<const Pair> pairs) {
    write_parts(pairs.size(),
                [&](std::size_t i, PairArguments& arguments) { argue(pairs[i], arguments); });
  }

  /// Writes the arguments that argue(i, arguments) adds for each i < count.
  template <class Argue>
  void write_parts(std::size_t count, const Argue& argue_one) {
    static constexpr std::size_t part = 256;
    std::vector<PairArguments> parts((count + part - 1) / part);
    tbb::task_arena arena(base::cores_for(options_.threads));
    arena.execute([&] {
      tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t n) {
        if (base::is_stopped(options_.stop)) return;
        for (std::size_t i = n * part; i < std::min(count, (n + 1) * part); ++i) {
          argue_one(i, parts[n]);
        }
      });
    });
    proof_.interrupted = base::is_stopped(options_.stop);
    for (const PairArguments& some : parts) {
      if (proof_.failure.empty()) proof_.failure = some.failure;
      if (!proof_.is_complete()) return;
      put(some.text);
      proof_.directions += some.directions;
      proof_.certificates += some.certificates;
    }
  }

  /// Writes the subintervals of the elements of a kind that need several.
  void write_volumes(Kind kind, std::size_t count) {
    if (count == 0 || !proof_.is_complete()) return;
    put(fmt::format("{}\n", keyword_of(kind)));
    write_parts(count, [&](std::size_t number, PairArguments& arguments) {
      argue_volume(kind, number, arguments);
    });
  }

  void argue_volume(Kind kind, std::size_t number, PairArguments& arguments) const try {
    const Query element = step_.query_of(kind, static_cast<std::int32_t>(number));
    const auto subintervals = exact::keep_volume(exact::scale(Kind::vertex_face, element), end_);
    if (subintervals.size() == 1) return;
    ++arguments.certificates;
    fmt::format_to(std::back_inserter(arguments.text), "{}\n", number);
    write_subintervals(subintervals, arguments.text);
  } catch (const exact::CertificateLimitError& error) {
    arguments.failure = fmt::format("{} {}: {}", keyword_of(kind), number, error.what());
  }

  static void write_subintervals(const std::vector<exact::Subinterval>& subintervals,
                                 std::string& text) {
    if (subintervals.size() > exact::subinterval_limit) {
      throw exact::CertificateLimitError("a separation needs too many subintervals");
    }
    exact::write_subintervals(text, subintervals);
  }

  void argue(const Pair& pair, PairArguments& arguments) const {
    const PairVertices vertices(step_, pair);
    const Separation separation = step_.separation_of(pair.kind, pair.numbers);
    std::string& text = arguments.text;
    fmt::format_to(std::back_inserter(text), "{} {}", pair.numbers[0], pair.numbers[1]);
    if (const auto d = places_->direction(vertices.first, vertices.second, separation.distance)) {
      ++arguments.directions;
      fmt::format_to(std::back_inserter(text), " {}\n", fmt::join(*d, " "));
      return;
    }
    ++arguments.certificates;
    text += '\n';
    try {
      exact::Motion motion = exact::scale_uniformly(
          fast::Step::kind_of(pair.kind), step_.query_of(pair.kind, pair.numbers), separation);
      // At distance 0 both norms mean the same, and l2 has fewer features.
      if (sgn(motion.distance) == 0) motion.norm = Norm::l2;
      write_subintervals(exact::separate(motion, end_), text);
    } catch (const exact::CertificateLimitError& error) {
      arguments.failure = fmt::format("{} {} {}: {}", pair.kind_name(), pair.numbers[0],
                                      pair.numbers[1], error.what());
    }
  }

  const fast::Step& step_;
  const fast::Mesh& mesh_;
  const StepProofOptions& options_;
  StepProof proof_;
  /// The time up to which there is no contact.
  exact::Rational end_;
  std::optional<StepPlaces> places_;
};

}  // namespace

StepProof prove_step(const fast::Step& step, const StepProofOptions& options) {
  return StepProver(step, options).run();
}

}  // namespace touchstone::verify::jobs
