#include "verify/families/families.hpp"

#include <algorithm>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#include "verify/families/random.hpp"
#include "verify/families/recipe.hpp"

namespace touchstone::verify {

namespace builtin {

namespace {

void append(std::vector<Definition>& list, std::span<const Definition> more) {
  list.insert(list.end(), more.begin(), more.end());
}

std::vector<Definition> collect_base() {
  std::vector<Definition> list;
  append(list, dyadic_definitions());
  append(list, endpoint_definitions());
  append(list, silhouette_definitions());
  append(list, degenerate_definitions());
  append(list, coplanar_definitions());
  append(list, product_definitions());
  append(list, tangential_definitions());
  append(list, published_definitions());
  return list;
}

std::span<const Definition> all_definitions() {
  static const std::vector<Definition> all = [] {
    std::vector<Definition> list = collect_base();
    append(list, scaled_definitions());
    return list;
  }();
  return all;
}

const Definition& find_definition(std::string_view name) {
  const auto all = all_definitions();
  const auto found = std::find_if(all.begin(), all.end(), [&](const Definition& definition) {
    return definition.family.name == name;
  });
  if (found == all.end()) throw std::invalid_argument("no family is named " + std::string(name));
  return *found;
}

/// Every attempt at every query has its own stream, whatever was drawn for others.
Random stream_of(std::string_view name, Kind kind, std::uint64_t seed, std::uint64_t index,
                 std::uint64_t attempt) {
  std::uint64_t state = mix(seed ^ hash(name));
  state = mix(state + (kind == Kind::vertex_face ? 1 : 2));
  state = mix(state + index);
  return Random(mix(state + attempt));
}

/// Random significands end in zeros now and then: a query that is to be full but has too many of
/// those (about one in ten thousand) is drawn again.
KnownQuery build(const Definition& definition, Kind kind, std::uint64_t seed, std::uint64_t index) {
  for (std::uint64_t attempt = 0;; ++attempt) {
    Recipe recipe{.kind = kind,
                  .index = index,
                  .variant = index / 2,
                  .full = index % 2 == 1,
                  .random = stream_of(definition.family.name, kind, seed, index, attempt)};
    KnownQuery known = definition.build(recipe);
    if (recipe.full && !uses_full_significands(known.query)) continue;
    known.full_significands = recipe.full;
    if (!recipe.as_printed) apply_random_symmetry(kind, recipe.random, known);
    return known;
  }
}

/// The stream of queries behind open_family.
class FamilySource final : public QuerySource {
 public:
  FamilySource(const Family& family, Kind kind, std::uint64_t seed, std::uint64_t count)
      : family_(family), name_(family.name), kind_(kind), seed_(seed), count_(count) {}

  [[nodiscard]] const std::string& name() const override { return name_; }
  [[nodiscard]] Kind kind() const override { return kind_; }

  [[nodiscard]] std::optional<RecordedQuery> next() override {
    if (index_ == count_) return std::nullopt;
    KnownQuery known = make_query(family_, kind_, seed_, index_);
    return RecordedQuery{known.query, index_++, known.collides, std::move(known.toi)};
  }

  [[nodiscard]] double progress() const override {
    return count_ == 0 ? 1.0 : static_cast<double>(index_) / static_cast<double>(count_);
  }

 private:
  Family family_;
  std::string name_;
  Kind kind_;
  std::uint64_t seed_;
  std::uint64_t count_;
  std::uint64_t index_ = 0;
};

}  // namespace

std::span<const Definition> base_definitions() {
  static const std::vector<Definition> base = collect_base();
  return base;
}

}  // namespace builtin

std::span<const Family> families() {
  static const std::vector<Family> all = [] {
    std::vector<Family> list;
    for (const builtin::Definition& definition : builtin::all_definitions()) {
      list.push_back(definition.family);
    }
    return list;
  }();
  return all;
}

const Family& family_from_name(std::string_view name) {
  return builtin::find_definition(name).family;
}

bool supports(const Family& family, Kind kind) {
  const builtin::Definition& definition = builtin::find_definition(family.name);
  return kind == Kind::vertex_face ? definition.vertex_face : definition.edge_edge;
}

KnownQuery make_query(const Family& family, Kind kind, std::uint64_t seed, std::uint64_t index) {
  if (!supports(family, kind)) {
    throw std::invalid_argument(std::string(family.name) + " has no " +
                                std::string(to_string(kind)) + " queries");
  }
  return builtin::build(builtin::find_definition(family.name), kind, seed, index);
}

std::unique_ptr<QuerySource> open_family(const Family& family, Kind kind, std::uint64_t seed,
                                         std::uint64_t count) {
  if (!supports(family, kind)) {
    throw std::invalid_argument(std::string(family.name) + " has no " +
                                std::string(to_string(kind)) + " queries");
  }
  return std::make_unique<builtin::FamilySource>(family, kind, seed, count);
}

}  // namespace touchstone::verify
