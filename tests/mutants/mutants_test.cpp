#include "tests/mutants/mutants.hpp"

#include <gtest/gtest.h>

#include <set>
#include <string>
#include <string_view>

#include "tests/mutants/hunt.hpp"
#include "verify/methods/registry.hpp"

namespace touchstone::tests {
namespace {

TEST(Mutants, are_many_and_each_is_of_a_method) {
  std::set<std::string_view> names;
  std::size_t faulty = 0;
  for (const Mutant& mutant : mutants()) {
    EXPECT_TRUE(names.insert(mutant.name).second) << mutant.name;
    EXPECT_EQ(mutant.make()->promise(), verify::find_method(mutant.of).promise()) << mutant.name;
    EXPECT_EQ(&find_mutant(mutant.name), &mutant);
    faulty += mutant.harmless.empty();
  }
  EXPECT_GE(faulty, 20U);
  EXPECT_THROW((void)find_mutant("none"), std::invalid_argument);
}

}  // namespace
}  // namespace touchstone::tests
