#pragma once

/// \file
/// Certificates of steps as text: exact/CERTIFICATES.md, "Steps", version 2. The scene and the
/// claim; the arguments of pairs stand between the claim and the line "end", in the order of
/// step_pair_kinds, and those of elements follow.

#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <string_view>

#include "touchstone/certificate.hpp"
#include "touchstone/query.hpp"

namespace touchstone::exact {

/// The kinds of pairs in a step's certificate, in its order.
inline constexpr std::array<std::string_view, 4> step_pair_kinds{"vertex_face", "edge_edge",
                                                                 "vertex_edge", "vertex_vertex"};

/// The kinds of elements, and the keywords of their lists, which are left out where they are empty.
inline constexpr std::array<std::string_view, 2> step_element_kinds{"tetrahedron",
                                                                    "plane_triangle"};
inline constexpr std::array<std::string_view, 2> step_element_lists{"tetrahedra",
                                                                    "plane_triangles"};

/// The limits of the checker: items of a scene, and pairs with an argument.
inline constexpr std::size_t step_item_limit = std::size_t{1} << 22U;
inline constexpr std::size_t step_argument_limit = std::size_t{1} << 24U;

/// The first line of a stream of certificates of steps.
[[nodiscard]] std::string_view step_certificates_header();

/// The last line of a stream with this number of certificates. A stream without it is incomplete.
[[nodiscard]] std::string step_certificates_closing_line(std::uint64_t steps);

/// Appends the first lines of a certificate: its label, as label_text() makes it, and the number of
/// vertices, whose lines follow.
void write_step_head(std::string& text, std::string_view label, std::size_t vertices);

/// Appends the line of a vertex. \param start, end its coordinates x, y, z at t=0 and t=1
void write_step_vertex(std::string& text, std::span<const double, 3> start,
                       std::span<const double, 3> end);

/// Appends a line of numbers with blanks between them.
void write_step_numbers(std::string& text, std::span<const std::int32_t> numbers);

/// Appends a list: the line "KEYWORD N", and a line for each of the N items.
template <class Items>
void write_step_list(std::string& text, std::string_view keyword, const Items& items) {
  text.append(keyword).append(" ").append(std::to_string(items.size())).append("\n");
  for (const auto& item : items) write_step_numbers(text, item);
}

/// The claim of a certificate: there is no contact up to a time; or the earliest contact is one
/// that is named.
struct StepClaim {
  /// A contact in (end, upper]; at 0 if both are.
  struct Contact {
    Rational upper;
    std::string name;  ///< "pair KIND I J" or "element KIND I"
    ContactProof proof;
  };

  Separation separation = {};
  Rational end;  ///< There is no contact before.
  std::optional<Contact> earliest = std::nullopt;
};

/// The claim as in the certificate: "no_contact T" or "earliest LO HI".
[[nodiscard]] std::string to_text(const StepClaim& claim);

/// Appends the lines of the separation and the claim.
void write_step_claim(std::string& text, const StepClaim& claim);

}  // namespace touchstone::exact
