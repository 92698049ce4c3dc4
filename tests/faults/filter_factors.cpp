#include "tests/faults/filter_factors.hpp"

namespace touchstone::tests {

FilterFactors filter_factors;

}  // namespace touchstone::tests
