#include "verify/fuzz/contact.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstddef>
#include <map>

#include "tests/support/trials.hpp"
#include "touchstone/oracle.hpp"
#include "verify/generate/family_builder.hpp"
#include "verify/generate/random_stream.hpp"

namespace touchstone::verify::fuzz::contact_test {
namespace {

using generate::Random;
using Maker = Query (*)(ContactKind, Random&);

constexpr std::array<ContactKind, 2> both_kinds{ContactKind::vertex_face, ContactKind::edge_edge};

/// Calls use(kind, query) for drawn queries, half of each kind.
template <class Use>
void for_each_query(Maker make, int count, const Use& use) {
  Random random(1);
  for (int i = 0; i < count; ++i) {
    const ContactKind kind = both_kinds.at(static_cast<std::size_t>(i % 2));
    use(kind, make(kind, random));
  }
}

/// The times on a grid are eighths, and earlier contacts of some constructions; those at one level
/// are anywhere, with full significands.
TEST(Contact, IsContactAlways) {
  const auto times_of = [](Maker make, int count, int& full) {
    std::map<double, int> tois;
    for_each_query(make, count, [&](ContactKind kind, const Query& query) {
      const exact::Decision verdict = exact::decide(kind, query);
      ASSERT_TRUE(verdict.collides());
      ++tois[verdict.toi->enclosure().lower];
      full += generate::uses_full_significands(query) ? 1 : 0;
    });
    return tois;
  };
  int full = 0;
  const auto on_grid = times_of(grid_contact, tests::trials(2000), full);
  for (const double eighth : {0.0, 0.125, 0.5, 0.875, 1.0}) EXPECT_TRUE(on_grid.contains(eighth));
  full = 0;
  const int count = tests::trials(2000);
  auto anywhere = times_of(level_contact, count, full);
  EXPECT_GT(full, tests::trials(1200));
  EXPECT_GT(count - anywhere[0.0] - anywhere[1.0], tests::trials(600));
  EXPECT_GT(anywhere[1.0], tests::trials(100));
}

}  // namespace
}  // namespace touchstone::verify::fuzz::contact_test
