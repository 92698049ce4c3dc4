#include "tests/faults/limb_products.hpp"

namespace touchstone::tests {

std::uint64_t limb_products = 0;

}  // namespace touchstone::tests
