#pragma once

/// \file
/// Certificates as text: exact/CERTIFICATES.md, version 1.

#include <string>
#include <string_view>

#include "exact/certificate.hpp"

namespace touchstone::exact {

/// A label has at most so many bytes.
inline constexpr std::size_t label_limit = 1024;

/// The first line of a stream of certificates.
[[nodiscard]] std::string_view certificates_header();

/// Appends the lines of a certificate.
/// \param label For messages: from which file the query is, say. Control characters become question
/// marks, and of a longer one the last label_limit bytes remain. No line if it is empty.
void write(std::string& text, const Certificate& certificate, std::string_view label = {});

/// Appends a finite double as C's %a writes it, in any locale and floating-point environment.
void write_hexadecimal(std::string& text, double value);

/// Appends a rational number in the shortest of its forms: a hexadecimal double if it is one, a
/// decimal integer, or P/Q.
void write_number(std::string& text, const Rational& value);

}  // namespace touchstone::exact
