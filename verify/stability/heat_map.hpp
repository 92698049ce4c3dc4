#pragma once

/// \file
/// A map of stability as a picture (SVG) to be read at a glance, on a screen of any size and on paper,
/// in light and dark, and whatever colours one tells apart.
///
/// At its top a table, a row a method and a column a hardness, each field coloured by the worst that
/// happened at any level. Below it each method's panels, one a hardness: a column a level; rows, for
/// each kind, of the worst outcome, of the time of impact's error (median, greatest), of time, and of
/// checks where the method counts them.
///
/// Outcomes: calm where nothing is wrong, blue the deeper the more false positives, and a colour of its
/// own, with a frame and bold white words, for false negatives, so that they are seen at once; others
/// for the faults between. The colours are those of Okabe and Ito. Numbers stand in the cells, and all
/// there is to say about a cell appears where one points at it.

#include <string>

#include "verify/stability/stability.hpp"

namespace touchstone::verify {

/// The picture as the text of an SVG document. Without any cell it says so.
[[nodiscard]] std::string heat_map(const StabilityResult& result);

/// A power of two as people write it, for its exponent: "2⁻⁵⁰".
[[nodiscard]] std::string power_text(int exponent);

}  // namespace touchstone::verify
