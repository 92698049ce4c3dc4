#include <algorithm>
#include <array>
#include <cmath>
#include <functional>
#include <mutex>
#include <optional>
#include <stdexcept>
#include <string>
#include <tuple>
#include <utility>
#include <vector>

#include "exact/certificate/separation_intervals.hpp"
#include "exact/checker/places.hpp"
#include "exact/checker/summary.hpp"
#include "exact/contact/corner_motion.hpp"
#include "exact/scene/directions.hpp"
#include "exact/scene/scene_text.hpp"
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
  ContactKind kind;
  fast::IndexPair numbers;

  [[nodiscard]] std::size_t kind_number() const { return static_cast<std::size_t>(kind); }
  [[nodiscard]] std::string_view kind_name() const { return step_pair_kinds.at(kind_number()); }
};

/// The vertices of a pair's primitives.
class PairVertices {
 public:
  PairVertices(const fast::Step& step, const Pair& pair)
      : all_(step.vertices_of(pair.kind, pair.numbers)), counts_(counts.at(pair.kind_number())) {}

  [[nodiscard]] PrimitiveVertices first() const { return std::span(all_).first(counts_[0]); }
  [[nodiscard]] PrimitiveVertices second() const {
    return std::span(all_).subspan(counts_[0], counts_[1]);
  }

 private:
  using Counts = std::array<std::size_t, 2>;
  /// By the kinds of pairs.
  static constexpr std::array<Counts, 4> counts{{{1, 3}, {2, 2}, {1, 2}, {1, 1}}};

  std::array<std::int32_t, moving_points> all_;
  Counts counts_;
};

/// The earliest contact: the pair or the cell, and the certificate of its time.
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
    AlgebraicNumber toi;
    std::function<Certificate()> prove;
  };
  std::optional<Candidate> first;
  const auto consider = [&](std::string name, const std::optional<AlgebraicNumber>& toi,
                            std::function<Certificate()> prove) {
    if (!toi || (first && *toi >= first->toi)) return;
    first = {std::move(name), *toi, std::move(prove)};
  };
  for (const fast::StepCollision& collision : impact->pairs) {
    const Pair pair{collision.kind, collision.pair};
    const auto& [i, j] = pair.numbers;
    const Query query = step.query_of(pair.kind, pair.numbers);
    const Decision decision = decide(pair.kind, query, step.separation_of(pair.kind, pair.numbers));
    consider(words("pair", pair.kind_name(), i, j), decision.toi,
             [=, kind = pair.kind] { return prove(kind, query, decision); });
  }
  for (const fast::StepInversion& one : impact->inversions) {
    if (first && first->toi == Rational(0)) break;
    const Query cell = step.tetrahedron_of(one.kind, one.cell);
    const auto toi = first_inversion(CellKind::tetrahedron, cell);
    consider(words("element", record_of(one.kind).keyword, one.cell), toi,
             [=] { return prove_inversion(CellKind::tetrahedron, cell, toi); });
  }
  if (!first) throw std::logic_error("touchstone: the earliest impact is none");
  return FirstContact{std::move(first->name), first->prove()};
}

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
      std::size_t cells = 0;
      for (const CellKind kind : cell_kinds) cells += scene_.mesh.count_of(kind);
      expect_arguments(pairs.size(), cells);
      write_scene();
      write_claim(first);
      if (!is_at_zero) {
        write_pairs(pairs);
        for (const CellKind kind : cell_kinds) write_volumes(kind, scene_.mesh.count_of(kind));
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
    for (const CellKind kind : cell_kinds) write_cells(text, kind);
    put(text);
  }

  void write_cells(std::string& text, CellKind kind) const {
    const std::span corners = scene_.mesh.corners_of(kind);
    const std::size_t count = record_of(kind).point_count;
    if (!corners.empty()) write_line(text, record_of(kind).list, scene_.mesh.count_of(kind));
    for (std::size_t i = 0; i < corners.size(); ++i) {
      text += std::to_string(corners[i]) + ((i + 1) % count == 0 ? '\n' : ' ');
    }
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
    const auto& [distance, norm] = decisions_.separation;
    std::string& claim = proof().claim;
    claim = first ? "earliest " : "no_contact ";
    write_number(claim, end_);
    if (first) write_number(claim += ' ', first->certificate.toi.upper);
    proof().contact =
        checker::contact_text({.distance = distance, .is_l2 = norm == Norm::l2},
                              !scene_.rules.radii.empty() || !scene_.rules.separations.empty());
    std::string text = "separation ";
    write_hexadecimal(text, distance);
    text.append(" ").append(to_string(norm)).append("\n");
    write_line(text, "claim", claim);
    if (first) {
      write_line(text, first->name);
      write_contact(text, *first->certificate.contact);
    }
    put(text);
  }

  // ---- The arguments ----

  void write_pairs(std::span<const Pair> pairs) {
    put(std::string("sweep ") + "xyz"[longest_axis()] + '\n');
    for (std::size_t kind = 0; kind < step_pair_kinds.size(); ++kind) {
      if (!proof().is_complete()) return;
      put(std::string(step_pair_kinds.at(kind)) + '\n');
      const auto count =
          static_cast<std::size_t>(std::ranges::count(pairs, kind, &Pair::kind_number));
      write_arguments(count,
                      [&](std::size_t i, Arguments& arguments) { argue(pairs[i], arguments); });
      pairs = pairs.subspan(count);
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
    std::vector<checker::Motion> motions(step_.vertices().size());
    for (std::size_t i = 0; i < motions.size(); ++i) {
      const auto& [start, end] = step_.vertices()[i];
      motions[i] = {{start[0], start[1], start[2]}, {end[0], end[1], end[2]}};
    }
    places_.emplace(motions, greatest, end_);
    // The checker's integers may bring boxes a little nearer.
    Separation wider = decisions_.separation;
    wider.distance += std::ldexp(8.0, -places_->shift());
    const fast::Step near = step_.with_separation(wider);
    std::vector<Pair> pairs;
    std::mutex mutex;
    near.candidates([&](const fast::StepCandidates& some) {
      std::vector<Pair> needed;
      for (const fast::IndexPair& numbers : some.pairs) {
        const Pair pair{some.kind, numbers};
        const PairVertices vertices(step_, pair);
        const double distance = step_.separation_of(pair.kind, pair.numbers).distance;
        if (!places_->is_axis_between(primitive_of(vertices.first()),
                                      primitive_of(vertices.second()),
                                      places_->enlarged(distance))) {
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

  /// Writes the subintervals of the cells of a kind that need several.
  void write_volumes(CellKind kind, std::size_t count) {
    if (count == 0 || !proof().is_complete()) return;
    put(words(record_of(kind).keyword) + '\n');
    write_arguments(count, [&](std::size_t number, Arguments& arguments) {
      argue_volume(kind, number, arguments);
    });
  }

  void argue_volume(CellKind kind, std::size_t number, Arguments& arguments) const try {
    const Query cell = step_.tetrahedron_of(kind, static_cast<std::int32_t>(number));
    const auto subintervals = keep_volume(scale(ContactKind::vertex_face, cell), end_);
    if (subintervals.size() == 1) return;
    ++arguments.certificates;
    write_line(arguments.text, number);
    append(subintervals, arguments.text);
  } catch (const CertificateLimitError& error) {
    arguments.failure = words(record_of(kind).keyword, number) + ": " + error.what();
  }

  static void append(const std::vector<Subinterval>& subintervals, std::string& text) {
    if (subintervals.size() > subinterval_limit) {
      throw CertificateLimitError("a separation needs too many subintervals");
    }
    write_subintervals(text, subintervals);
  }

  void argue(const Pair& pair, Arguments& arguments) const {
    const PairVertices vertices(step_, pair);
    const Separation separation = step_.separation_of(pair.kind, pair.numbers);
    std::string& text = arguments.text;
    const auto [a, b] = pair.numbers;
    if (const auto d =
            find_direction(*places_, vertices.first(), vertices.second(), separation.distance)) {
      ++arguments.directions;
      return write_line(text, a, b, (*d)[0], (*d)[1], (*d)[2]);
    }
    ++arguments.certificates;
    write_line(text, a, b);
    try {
      Motion motion = scale_uniformly(decided_as(pair.kind),
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
  std::optional<checker::Places> places_;
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
