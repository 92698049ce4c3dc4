#pragma once

/// \file
/// The header of {fmt} by the name that it has inside spdlog: Debian has it beside spdlog.

#include <fmt/ranges.h>
