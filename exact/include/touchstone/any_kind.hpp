#pragma once

/// \file
/// The kinds of contacts and of cells as one type, for what treats both alike: files, solvers under
/// test and their judge. Decisions take one or the other.

#include <algorithm>
#include <array>
#include <cstddef>
#include <cstdint>
#include <optional>
#include <span>
#include <stdexcept>
#include <string>
#include <string_view>

#include "touchstone/cell.hpp"
#include "touchstone/query.hpp"

namespace touchstone {

/// The kinds of contact of data sets and of solvers under test: others are asked as these.
inline constexpr std::array contact_kinds{ContactKind::vertex_face, ContactKind::edge_edge};

/// A kind of contact or of cell.
class AnyKind {
 public:
  constexpr AnyKind() = default;
  constexpr AnyKind(ContactKind kind)  // NOLINT(google-explicit-constructor)
      : number_(static_cast<std::uint8_t>(kind)) {}
  constexpr AnyKind(CellKind kind)  // NOLINT(google-explicit-constructor)
      : number_(static_cast<std::uint8_t>(contact_count + static_cast<std::size_t>(kind))) {}

  /// The kind with that number, as the interfaces in C have it (TouchstoneKind): contacts, then
  /// cells; nullopt if there is none.
  [[nodiscard]] static constexpr std::optional<AnyKind> with_number(std::int64_t number) {
    if (number < 0 || number >= static_cast<std::int64_t>(count)) return std::nullopt;
    AnyKind kind;
    kind.number_ = static_cast<std::uint8_t>(number);
    return kind;
  }
  static constexpr std::size_t contact_count = 4;
  static constexpr std::size_t count = contact_count + cell_records.size();

  [[nodiscard]] constexpr std::size_t number() const { return number_; }
  /// Its place in all_kinds. \pre it is one of these
  [[nodiscard]] constexpr std::size_t index() const {
    return is_cell() ? number_ - contact_count + contact_kinds.size() : number_;
  }
  [[nodiscard]] constexpr bool is_cell() const { return number_ >= contact_count; }
  /// \throws std::invalid_argument for a cell, and `cell` for a contact.
  [[nodiscard]] constexpr ContactKind contact() const {
    if (is_cell())
      throw std::invalid_argument("a cell inverts or not; a kind of contact is needed");
    return static_cast<ContactKind>(number_);
  }
  [[nodiscard]] constexpr CellKind cell() const {
    if (!is_cell())
      throw std::invalid_argument("primitives do not invert; a kind of cell is needed");
    return static_cast<CellKind>(number_ - contact_count);
  }

  friend constexpr auto operator<=>(const AnyKind&, const AnyKind&) = default;

 private:
  std::uint8_t number_ = 0;
};

/// The kinds of data sets and of solvers under test.
inline constexpr auto all_kinds = [] {
  std::array<AnyKind, contact_kinds.size() + cell_kinds.size()> kinds{};
  std::copy(cell_kinds.begin(), cell_kinds.end(),
            std::copy(contact_kinds.begin(), contact_kinds.end(), kinds.begin()));
  return kinds;
}();

using AnyShape = Shape<AnyKind>;
using AnyQueries = Batch<AnyKind>;

/// "vertex-face" and so on, "tetrahedron", "plane-triangle".
[[nodiscard]] constexpr std::string_view to_string(AnyKind kind) {
  return kind.is_cell() ? to_string(kind.cell()) : to_string(kind.contact());
}

/// The one of all_kinds with that name.
/// \throws std::invalid_argument for any other text.
[[nodiscard]] inline AnyKind kind_from_string(std::string_view text) {
  std::string names;
  for (const AnyKind kind : all_kinds) {
    if (text == to_string(kind)) return kind;
    names += kind == all_kinds.front() ? "" : kind == all_kinds.back() ? " or " : ", ";
    names += to_string(kind);
  }
  throw std::invalid_argument("kind must be " + names);
}

}  // namespace touchstone
