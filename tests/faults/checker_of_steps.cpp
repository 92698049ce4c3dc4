/// \file
/// The checker as one source and one function, for faults to be planted in it.

#include <sstream>
#include <string>

#include "exact/checker/certificate.cpp"
#include "exact/checker/checker.cpp"
#include "exact/checker/proof.cpp"
#include "exact/checker/step.cpp"

namespace touchstone::tests {

bool checker_of_steps(const std::string& stream);

bool checker_of_steps(const std::string& stream) {
  std::istringstream in(stream);
  return checker::check(in).all_accepted();
}

}  // namespace touchstone::tests
