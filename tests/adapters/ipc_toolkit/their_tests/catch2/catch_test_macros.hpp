#pragma once

/// \file
/// The header of Catch2 3 by this name: Debian 12 has Catch2 2.

#include <catch2/catch.hpp>
