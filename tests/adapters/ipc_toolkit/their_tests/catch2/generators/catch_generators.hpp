#pragma once

/// \file
/// The header of Catch2 3 by this name: Debian 12 has Catch2 2.

#include <catch2/catch.hpp>
#include <memory>

namespace Catch::Detail {
using std::make_unique;
using std::unique_ptr;
}  // namespace Catch::Detail
