#include "verify/generate/families.hpp"

#include <algorithm>
#include <functional>
#include <stdexcept>
#include <utility>

#include "fast/method.hpp"
#include "verify/generate/curved_families.hpp"
#include "verify/generate/family_builder.hpp"
#include "verify/generate/random_stream.hpp"

namespace touchstone::verify::generate {

namespace {

std::span<const Definition> all_definitions() {
  static const std::vector<Definition> all = [] {
    std::vector<Definition> list(base_definitions().begin(), base_definitions().end());
    list.insert(list.end(), scaled_definitions().begin(), scaled_definitions().end());
    return list;
  }();
  return all;
}

const Definition& find_definition(std::string_view name) {
  for (const auto list : {all_definitions(), separated_definitions(), cell_definitions()}) {
    const auto found = std::ranges::find(
        list, name, [](const Definition& definition) { return definition.family.name; });
    if (found != list.end()) return *found;
  }
  throw std::invalid_argument("no family is named " + std::string(name));
}

/// The family on curves of that name; null if there is none.
const Family* find_curved(std::string_view name) {
  const auto found = std::ranges::find(curved_families(), name, &Family::name);
  return found == curved_families().end() ? nullptr : &*found;
}

bool is_about_separation(const Definition& definition) {
  const auto list = separated_definitions();
  return &definition >= list.data() && &definition < list.data() + list.size();
}

/// The definition of a family. \throws std::invalid_argument if it has no such queries.
const Definition& find_definition(const Family& family, AnyKind kind,
                                  const Separation& separation) {
  if (!supports(family, kind)) {
    throw std::invalid_argument(std::string(family.name) + " has no " +
                                std::string(to_string(kind)) + " queries");
  }
  const Definition& definition = find_definition(family.name);
  if (is_about_separation(definition) && !has_separation_families(separation)) {
    throw std::invalid_argument(std::string(family.name) +
                                " needs a minimum separation from 2^-1000 to 2^1000");
  }
  return definition;
}

std::vector<Family> families_of(std::span<const Definition> definitions) {
  std::vector<Family> list;
  for (const Definition& definition : definitions) list.push_back(definition.family);
  return list;
}

/// Every attempt at every query has a separate stream, independent of other queries.
Random stream_of(std::string_view name, AnyKind kind, std::uint64_t seed, std::uint64_t index,
                 std::uint64_t attempt) {
  std::uint64_t state = mix(seed ^ hash(name));
  state = mix(state + 1 + std::uint64_t{kind.index()});
  state = mix(state + index);
  return Random(mix(state + attempt));
}

/// Random significands sometimes end in zeros: a query with full significands that has too many of
/// those (about one in ten thousand) is drawn again.
KnownQuery build(const Definition& definition, AnyKind kind, std::uint64_t seed,
                 std::uint64_t index, const Separation& separation) {
  for (std::uint64_t attempt = 0;; ++attempt) {
    Recipe recipe{.kind = kind,
                  .index = index,
                  .variant = index / 2,
                  .full = index % 2 == 1,
                  .random = stream_of(definition.family.name, kind, seed, index, attempt),
                  .separation = separation};
    KnownQuery known = definition.build(recipe);
    const bool is_to_be_full = recipe.full && !is_about_separation(definition);
    if (is_to_be_full && !uses_full_significands(known.query)) continue;
    if (!recipe.as_printed) apply_random_symmetry(kind, recipe.random, known.query);
    return known;
  }
}

class DrawnSource final : public data::QuerySource {
 public:
  DrawnSource(DrawnSet set, std::uint64_t count,
              std::function<data::RecordedQuery(std::uint64_t)> draw)
      : set_(std::move(set)), count_(count), draw_(std::move(draw)) {}

  [[nodiscard]] const std::string& name() const override { return set_.name; }
  [[nodiscard]] AnyShape shape() const override { return set_.shape; }
  [[nodiscard]] Separation recorded_separation() const override { return set_.separation; }

  [[nodiscard]] std::optional<data::RecordedQuery> next() override {
    if (index_ == count_) return std::nullopt;
    return draw_(index_++);
  }

  [[nodiscard]] double progress() const override {
    return count_ == 0 ? 1.0 : static_cast<double>(index_) / static_cast<double>(count_);
  }

 private:
  DrawnSet set_;
  std::uint64_t count_;
  std::function<data::RecordedQuery(std::uint64_t)> draw_;
  std::uint64_t index_ = 0;
};

DrawnSet set_of(const Family& family, AnyKind kind, const Separation& separation) {
  return {std::string(family.name), {kind, family.degree, family.is_rational}, separation};
}

}  // namespace

std::span<const Definition> base_definitions() {
  static const std::vector<Definition> base = [] {
    std::vector<Definition> list;
    for (const auto part : {dyadic_definitions(), endpoint_definitions(), silhouette_definitions(),
                            degenerate_definitions(), coplanar_definitions(), product_definitions(),
                            tangential_definitions(), published_definitions()}) {
      list.insert(list.end(), part.begin(), part.end());
    }
    return list;
  }();
  return base;
}

std::span<const Family> families() {
  static const std::vector<Family> all = families_of(all_definitions());
  return all;
}

std::span<const Family> separation_families() {
  static const std::vector<Family> all = families_of(separated_definitions());
  return all;
}

std::span<const Family> cell_families() {
  static const std::vector<Family> all = families_of(cell_definitions());
  return all;
}

bool has_separation_families(const Separation& separation) {
  return separation.distance >= 0x1p-1000 && separation.distance <= 0x1p1000;
}

std::vector<Family> families(const Separation& separation) {
  std::vector<Family> list(families().begin(), families().end());
  if (!has_separation_families(separation)) return list;
  list.insert(list.end(), separation_families().begin(), separation_families().end());
  return list;
}

std::vector<Family> families(const Separation& separation, std::span<const std::string> degrees) {
  std::vector<Family> list = families(separation);
  for (const auto more : {curved_families(), cell_families()}) {
    list.insert(list.end(), more.begin(), more.end());
  }
  std::erase_if(list, [&](const Family& family) {
    return std::ranges::find(degrees, degree_text(family)) == degrees.end();
  });
  return list;
}

std::string degree_text(const Family& family) {
  return family.is_rational ? "rational" : std::to_string(family.degree);
}

const Family& family_from_name(std::string_view name) {
  const Family* const curved = find_curved(name);
  return curved != nullptr ? *curved : find_definition(name).family;
}

bool supports(const Family& family, AnyKind kind) {
  if (find_curved(family.name) != nullptr) return !kind.is_cell();
  const Definition& definition = find_definition(family.name);
  if (kind.is_cell()) return definition.cells;
  return kind == ContactKind::vertex_face ? definition.vertex_face : definition.edge_edge;
}

KnownQuery make_query(const Family& family, AnyKind kind, std::uint64_t seed, std::uint64_t index,
                      const Separation& separation) {
  if (find_curved(family.name) != nullptr) {
    throw std::invalid_argument(std::string(family.name) + " is on curves");
  }
  const Definition& definition = find_definition(family, kind, separation);
  return build(definition, kind, seed, index, separation);
}

std::unique_ptr<data::QuerySource> open_family(const Family& family, AnyKind kind,
                                               std::uint64_t seed, std::uint64_t count,
                                               const Separation& separation) {
  if (const Family* const curved = find_curved(family.name)) {
    return open_drawn(set_of(*curved, kind, {}), count,
                      curved_draws(*curved, kind.contact(), seed));
  }
  const Definition& definition = find_definition(family, kind, separation);
  const Separation about = is_about_separation(definition) ? separation : Separation{};
  const auto draw = [&definition, kind, seed, about](std::uint64_t index) {
    KnownQuery known = build(definition, kind, seed, index, about);
    return data::RecordedQuery{{kind, known.query}, index, known.collides, std::move(known.toi)};
  };
  return open_drawn(set_of(definition.family, kind, about), count, draw);
}

std::unique_ptr<data::QuerySource> open_drawn(
    DrawnSet set, std::uint64_t count, std::function<data::RecordedQuery(std::uint64_t)> draw) {
  return std::make_unique<DrawnSource>(std::move(set), count, std::move(draw));
}

}  // namespace touchstone::verify::generate
