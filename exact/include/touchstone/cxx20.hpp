#pragma once

/// \file
/// A check of the language, before all other headers.

#if __cplusplus <= 201703L && (!defined(_MSVC_LANG) || _MSVC_LANG <= 201703L)
#error "Touchstone needs C++20: compile with -std=c++20"
// A missing file ends the compilation, before errors of the other headers hide this one.
#include <touchstone_needs_cxx20>
#endif
