#include "tests/mutants/filter_factors.hpp"

namespace touchstone::tests {

FilterFactors filter_factors;

}  // namespace touchstone::tests
