// What a simulator includes: the vocabulary and fast code, found under the installed prefix.

#include <exact/query.hpp>
#include <fast/arithmetic_check.hpp>
#include <fast/filter.hpp>
#include <fast/method.hpp>
#include <fast/tight_inclusion.hpp>

int main() {
  using namespace touchstone;
  fast::require_strict_arithmetic();
  // A vertex falls through a resting triangle: v, f0, f1, f2 at t=0, then at t=1.
  const Query query{{1, 1, 1,  0, 0, 0, 4, 0, 0, 0, 4, 0,  //
                     1, 1, -2, 0, 0, 0, 4, 0, 0, 0, 4, 0}};
  const fast::TightInclusionResult result = fast::tight_inclusion(Kind::vertex_face, query);
  const bool right = result.verdict == fast::Verdict::yes && result.toi <= 1.0 / 3.0;
  return right ? 0 : 1;
}
