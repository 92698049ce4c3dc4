#pragma once

/// \file
/// The macros of Tight-Inclusion's `tight_inclusion/config.hpp`: the version of its interface, and
/// the options with which it would be configured.

#define TIGHT_INCLUSION_NAME "Touchstone"
#define TIGHT_INCLUSION_VER "1.0.4"
#define TIGHT_INCLUSION_VER_MAJOR "1"
#define TIGHT_INCLUSION_VER_MINOR "0"
#define TIGHT_INCLUSION_VER_PATCH "4"

#ifndef TOUCHSTONE_TICCD_FLOAT
#define TIGHT_INCLUSION_WITH_DOUBLE_PRECISION
#endif
