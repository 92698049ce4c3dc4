#include <algorithm>
#include <array>
#include <iterator>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "exact/certificate/separation_intervals.hpp"
#include "exact/checker/summary.hpp"
#include "exact/contact/corner_motion.hpp"
#include "exact/scene/scene_text.hpp"
#include "exact/scene/step_places.hpp"
#include "fast/platform/floating_point_state.hpp"
#include "fast/platform/threads.hpp"
#include "fast/step/codimensional.hpp"
#include "fast/step/scene.hpp"
#include "touchstone/certificate.hpp"
#include "touchstone/certificate_text.hpp"
#include "touchstone/oracle.hpp"
#include "touchstone/scene_certificate.hpp"

namespace touchstone::exact {
namespace {

/// A pair of the step.
struct Pair {
  fast::PairKind kind;
  fast::IndexPair numbers;

  [[nodiscard]] std::size_t kind_number() const { return static_cast<std::size_t>(kind); }
  [[nodiscard]] std::string_view kind_name() const { return step_pair_kinds.at(kind_number()); }
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
  return step_element_kinds.at(kind == Kind::plane_triangle ? 1 : 0);
}

/// The earliest contact: the pair or the element, and the certificate of its time.
struct FirstContact {
  std::string name;
  Certificate certificate;
};

/// The contact with the least time. Enclosures do not tell which it is: the oracle does.
std::optional<FirstContact> first_contact(const fast::Step& step) {
  const std::optional<fast::StepImpact> impact = step.earliest();
  if (!impact) return std::nullopt;
  struct Candidate {
    std::string name;
    Kind kind;
    Query query;
    Decision decision;
  };
  std::optional<Candidate> first;
  const auto consider = [&](std::string name, Kind kind, const Query& query,
                            const Separation& separation) {
    Decision decision = decide(kind, query, separation);
    if (!decision.toi || (first && *decision.toi >= *first->decision.toi)) return;
    first = {std::move(name), kind, query, std::move(decision)};
  };
  for (const fast::StepCollision& collision : impact->pairs) {
    const Pair pair{collision.kind, collision.pair};
    const auto& [i, j] = pair.numbers;
    consider(words("pair", pair.kind_name(), i, j), fast::Step::kind_of(pair.kind),
             step.query_of(pair.kind, pair.numbers), step.separation_of(pair.kind, pair.numbers));
  }
  for (const fast::StepInversion& one : impact->inversions) {
    if (first && *first->decision.toi == Rational(0)) break;
    consider(words("element", keyword_of(one.kind), one.element), Kind::tetrahedron,
             step.query_of(one.kind, one.element), {});
  }
  if (!first) throw std::logic_error("touchstone: the earliest impact is none");
  return FirstContact{std::move(first->name), prove(first->kind, first->query, first->decision)};
}

/// The arguments of some pairs, as text.
struct PairArguments {
  std::string text;
  std::uint64_t directions = 0;
  std::uint64_t certificates = 0;
  std::string failure;
};

class StepProver : private ProofWriter {
 public:
  StepProver(const fast::Step& step, const ListedScene& scene, const SceneProofOptions& options)
      : ProofWriter(options), step_(step), scene_(scene) {}

  SceneProof run() {
    try {
      scene_.require_within_limit(step_.vertices().size());
      const std::optional<FirstContact> first = first_contact(step_);
      end_ = first ? first->certificate.toi.lower : Rational(decisions_.t_max);
      const bool is_at_zero = first && sgn(first->certificate.toi.upper) == 0;
      const std::vector<Pair> pairs = is_at_zero ? std::vector<Pair>() : needed_pairs();
      require_few_arguments(pairs.size());
      write_scene();
      write_claim(first);
      if (!is_at_zero) {
        write_arguments(pairs);
        write_volumes(Kind::tetrahedron, scene_.mesh.tetrahedra.size());
        write_volumes(Kind::plane_triangle, scene_.mesh.plane_triangles.size());
      }
    } catch (const CertificateLimitError& error) {
      proof().failure = error.what();
    }
    return finish(step_certificates_header(), step_certificates_closing_line(1));
  }

 private:
  // ---- The scene and the claim ----

  void write_scene() {
    const fast::Motion& vertices = step_.vertices();
    proof().rules = checker::rules_text(
        scene_.rules.apart,
        vertices.size() - fast::vertices_of(vertices.size(), scene_.mesh).size());
    std::string text;
    write_line(text, "step", label_text(options().label));
    write_line(text, "vertices", vertices.size());
    for (std::size_t i = 0; i < vertices.size(); ++i) {
      const auto& [start, end] = vertices[i];
      write_doubles(text, std::array{start[0], start[1], start[2], end[0], end[1], end[2]});
    }
    scene_.write(text);
    write_thickness(text);
    const auto& [tetrahedra, plane_triangles] = step_element_lists;
    const fast::Mesh& mesh = scene_.mesh;
    if (!mesh.tetrahedra.empty()) write_list(text, tetrahedra, mesh.tetrahedra);
    if (!mesh.plane_triangles.empty()) write_list(text, plane_triangles, mesh.plane_triangles);
    put(text);
  }

  void write_thickness(std::string& text) const {
    write_line(text, "radii", scene_.rules.radii.size());
    for (const double radius : scene_.rules.radii) write_doubles(text, std::array{radius});
    write_line(text, "separations", scene_.rules.separations.size());
    for (const auto& [groups, distance] : scene_.rules.separations) {
      text += words(groups[0], groups[1]) + ' ';
      write_doubles(text, std::array{distance});
    }
  }

  void write_claim(const std::optional<FirstContact>& first) {
    StepClaim claim{.separation = decisions_.separation, .end = end_};
    if (first) {
      claim.earliest = {.upper = first->certificate.toi.upper,
                        .name = first->name,
                        .proof = *first->certificate.contact};
    }
    proof().claim = to_text(claim);
    proof().contact = checker::contact_text(
        {.distance = claim.separation.distance, .is_l2 = claim.separation.norm == Norm::l2},
        !scene_.rules.radii.empty() || !scene_.rules.separations.empty());
    std::string text;
    write_step_claim(text, claim);
    put(text);
  }

  // ---- The arguments of pairs ----

  void write_arguments(std::span<const Pair> pairs) {
    put(std::string("sweep ") + "xyz"[longest_axis()] + '\n');
    static constexpr std::size_t block = 32'768;
    std::size_t done = 0;
    for (std::size_t kind = 0; kind < step_pair_kinds.size(); ++kind) {
      put(std::string(step_pair_kinds.at(kind)) + '\n');
      const auto end = static_cast<std::size_t>(
          std::ranges::find_if(pairs.begin() + static_cast<std::ptrdiff_t>(done), pairs.end(),
                               [&](const Pair& pair) { return pair.kind_number() != kind; }) -
          pairs.begin());
      for (; done < end; done = std::min(done + block, end)) {
        write_block(pairs.subspan(done, std::min(block, end - done)));
        if (!proof().is_complete()) return;
        report(std::min(done + block, end), pairs.size());
      }
    }
  }

  [[nodiscard]] std::size_t longest_axis() const {
    const fast::Motion& vertices = step_.vertices();
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
  [[nodiscard]] std::vector<Pair> needed_pairs() {
    // A bound of the distances at which pairs are in contact.
    const double greatest =
        decisions_.separation.distance + fast::scene_of(step_).greatest_thickness();
    places_.emplace(step_.vertices(), greatest, end_);
    // The checker's integers may bring boxes a little nearer.
    Separation wider = decisions_.separation;
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
    fast::with_threads(options().max_threads, [&] {
      fast::tbb::parallel_for(std::size_t{0}, parts.size(), [&](std::size_t n) {
        const fast::StrictFloatingPoint strict;
        if (is_stopped()) return;
        for (std::size_t i = n * part; i < std::min(count, (n + 1) * part); ++i) {
          argue_one(i, parts[n]);
        }
      });
    });
    proof().interrupted = is_stopped();
    for (const PairArguments& some : parts) {
      if (proof().failure.empty()) proof().failure = some.failure;
      if (!proof().is_complete()) return;
      put(some.text);
      proof().directions += some.directions;
      proof().certificates += some.certificates;
    }
  }

  /// Writes the subintervals of the elements of a kind that need several.
  void write_volumes(Kind kind, std::size_t count) {
    if (count == 0 || !proof().is_complete()) return;
    put(words(keyword_of(kind)) + '\n');
    write_parts(count, [&](std::size_t number, PairArguments& arguments) {
      argue_volume(kind, number, arguments);
    });
  }

  void argue_volume(Kind kind, std::size_t number, PairArguments& arguments) const try {
    const Query element = step_.query_of(kind, static_cast<std::int32_t>(number));
    const auto subintervals = keep_volume(scale(Kind::vertex_face, element), end_);
    if (subintervals.size() == 1) return;
    ++arguments.certificates;
    write_line(arguments.text, number);
    append(subintervals, arguments.text);
  } catch (const CertificateLimitError& error) {
    arguments.failure = words(keyword_of(kind), number) + ": " + error.what();
  }

  static void append(const std::vector<Subinterval>& subintervals, std::string& text) {
    if (subintervals.size() > subinterval_limit) {
      throw CertificateLimitError("a separation needs too many subintervals");
    }
    write_subintervals(text, subintervals);
  }

  void argue(const Pair& pair, PairArguments& arguments) const {
    const PairVertices vertices(step_, pair);
    const Separation separation = step_.separation_of(pair.kind, pair.numbers);
    std::string& text = arguments.text;
    const auto [a, b] = pair.numbers;
    if (const auto d = places_->direction(vertices.first, vertices.second, separation.distance)) {
      ++arguments.directions;
      return write_line(text, a, b, (*d)[0], (*d)[1], (*d)[2]);
    }
    ++arguments.certificates;
    write_line(text, a, b);
    try {
      Motion motion = scale_uniformly(fast::Step::kind_of(pair.kind),
                                      step_.query_of(pair.kind, pair.numbers), separation);
      // At distance 0 both norms mean the same, and l2 has fewer features.
      if (sgn(motion.distance) == 0) motion.norm = Norm::l2;
      append(separate(motion, end_), text);
    } catch (const CertificateLimitError& error) {
      arguments.failure = words(pair.kind_name(), a, b) + ": " + error.what();
    }
  }

  const fast::Step& step_;
  const fast::CertifiedOptions& decisions_ = fast::scene_of(step_).certified();
  const ListedScene& scene_;
  /// The time up to which there is no contact.
  Rational end_;
  std::optional<StepPlaces> places_;
};

}  // namespace

SceneProof prove_step(const fast::Step& step, const SceneProofOptions& options) {
  fast::require_straight(step.vertices(), "prove");
  const fast::Scene& scene = fast::scene_of(step);
  if (scene.can_collide()) {
    throw std::invalid_argument("prove: certificates know groups alone, not a rule can_collide");
  }
  const ListedScene listed(step.mesh(), step.groups());
  if (step.mesh().edges == listed.mesh.edges) return StepProver(step, listed, options).run();
  const fast::Step in_order(
      step.vertices(), listed.mesh,
      {.solve = scene.certified(), .groups = listed.rules, .stop = scene.stop()});
  return StepProver(in_order, listed, options).run();
}

}  // namespace touchstone::exact
