// Gappa's proofs of bounds that stand in texts, because no expression of the catalogue has them:
// stage axis up to a time (docs/theory.md, section 6.2, fast/certified/stages/axis.hpp) and the
// inequality of keeps_distance (section 8.6, fast/distance/kept_distance.cpp). Sizes are at most 1,
// and exponents have no end, so that a bound holds for any size in proportion; what underflow adds
// is in the texts. u is 2^-53.

#include <gtest/gtest.h>

#include <string>

#include "touchstone/derivation/gappa.hpp"

namespace touchstone::filters::bounds_by_hand_test {
namespace {

struct ByHand {
  std::string name;
  std::string script;  ///< up to the bound
  std::string bound;   ///< that the text has
  std::string rest;    ///< rules
  std::string less;    ///< a bound that is too small
};

const ByHand all[] = {
    {"a position is wrong by 5/2 u + 2 u²",
     R"(weight rnd= 1 - T;
position rnd= weight * a + T * b;
{ a in [-1,1] /\ b in [-1,1] /\ T in [0,1] -> |position - ((1 - T) * a + T * b)| <= )",
     "41b-57", "", "32b-57"},
    {"a height s·w is wrong by 16 u",
     R"(w0 rnd= a - b; w1 rnd= c - d; w2 rnd= e - f;
height rnd= s0 * w0 + s1 * w1 + s2 * w2;
{ s0 in [-1,1] /\ s1 in [-1,1] /\ s2 in [-1,1] /\ w0 in [-1,1] /\ w1 in [-1,1] /\ w2 in [-1,1]
-> |height - (s0 * (a - b) + s1 * (c - d) + s2 * (e - f))| <= )",
     "16b-53", "", "1b-53"},
    {"a motion of a corner is wrong by 2.01 u, before it is rounded",
     R"(start rnd= a - b; end rnd= c - d;
{ start in [-1,1] /\ end in [-1,1] -> |(end - start) - ((c - d) - (a - b))| <= )",
     "32b-57", "", "1b-54"},
    // For l from 1/2 to 1; 8 u l of the 16 u l are left for the caller.
    {"the sides of the inequality are wrong by 8 u l",
     R"(k = 1b-49 * a;
way rnd= T * b; gap rnd= a - way; left rnd= gap - k;
over rnd= a - c; share rnd= part * over; kept rnd= c + share;
wrong = (a - T * b) - (c + part * (a - c)) - (left - kept) - k;
{ a in [0.5,1] /\ T * b in [0,1] /\ c in [0,1] /\ over in [0,1] /\ part in [0,1]
-> |wrong| <= )",
     "8b-54",
     R"(wrong -> (way - T * b) + ((a - way) - gap) + ((gap - k) - left) + (kept - (c + share)) +
  (share - part * over) + part * (over - (a - c));
)",
     "1b-54"},
};

bool proves(const ByHand& one, const std::string& bound) {
  std::string script = "@rnd = float<53, -4000, ne>;\n";
  for (const char* const name : {"a", "b", "c", "d", "e", "f", "s0", "s1", "s2", "T", "part"}) {
    script += std::string(name) + " = rnd(" + name + "_);\n";
  }
  return run_gappa(script + one.script + bound + " }\n" + one.rest).proved;
}

TEST(BoundsByHand, AreProvedByGappa) {
  for (const ByHand& one : all) {
    EXPECT_TRUE(proves(one, one.bound)) << one.name;
    EXPECT_FALSE(proves(one, one.less)) << one.name;
  }
}

}  // namespace
}  // namespace touchstone::filters::bounds_by_hand_test
