#pragma once

/// \file
/// Certificates as text: exact/CERTIFICATES.md, version 2. All functions are thread-safe.

#include <cstddef>
#include <cstdint>
#include <string>
#include <string_view>
#include <vector>

#include "touchstone/certificate.hpp"

namespace touchstone::exact {

/// The maximum length of a label in bytes.
inline constexpr std::size_t label_limit = 1024;

/// A label of one line within the limit: control characters become question marks, and of a label
/// that is too long the last characters remain.
[[nodiscard]] std::string label_text(std::string_view label);

/// The first line of a stream of certificates.
[[nodiscard]] std::string_view certificates_header();

/// The last line of a stream with this number of certificates. A stream without it is incomplete.
[[nodiscard]] std::string certificates_closing_line(std::uint64_t certificates);

/// Appends the lines of a certificate.
/// \param label A text for messages, such as the file of the query; written as label_text(). An
/// empty label has no line.
void write(std::string& text, const Certificate& certificate, std::string_view label = {});

/// A stream of one certificate, from the first line to the closing line. \param label as for
/// write()
[[nodiscard]] std::string certificate_stream(const Certificate& certificate,
                                             std::string_view label = {});

/// Appends the lines of subintervals, or of a contact, as in a certificate.
void write_subintervals(std::string& text, const std::vector<Subinterval>& subintervals);
void write_contact(std::string& text, const ContactProof& contact);

/// Appends a finite double as C's %a writes it, in any locale and floating-point environment.
void write_hexadecimal(std::string& text, double value);

/// Appends a rational number in the shortest of its forms: a hexadecimal double if it is one, a
/// decimal integer, or P/Q.
void write_number(std::string& text, const Rational& value);

}  // namespace touchstone::exact
