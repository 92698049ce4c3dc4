#include "touchstone/certificate_text.hpp"

#include <algorithm>
#include <array>
#include <bit>
#include <optional>
#include <span>
#include <variant>

namespace touchstone::exact {
namespace {

constexpr int fraction_bits = 52;
constexpr int exponent_bias = 1023;
constexpr std::uint64_t hidden_bit = std::uint64_t{1} << fraction_bits;

/// The bits of a number ≥ 0 as a double, if it is one.
std::optional<std::uint64_t> double_bits(const Rational& value) {
  static constexpr long least_exponent = -1074, greatest_exponent = 1023;
  if (sgn(value) == 0) return 0;
  if (sgn(value) < 0 || mpz_popcount(value.get_den_mpz_t()) != 1) return std::nullopt;
  Integer odd = value.get_num();
  long exponent = -static_cast<long>(mpz_scan1(value.get_den_mpz_t(), 0));
  const mp_bitcnt_t zeros = mpz_scan1(odd.get_mpz_t(), 0);
  odd >>= zeros;
  exponent += static_cast<long>(zeros);
  const auto bits = static_cast<long>(mpz_sizeinbase(odd.get_mpz_t(), 2));
  const long leading = exponent + bits - 1;
  if (bits > fraction_bits + 1 || exponent < least_exponent || leading > greatest_exponent) {
    return std::nullopt;
  }
  const auto significand = static_cast<std::uint64_t>(odd.get_d());
  if (leading < 1 - exponent_bias) return significand << (exponent - least_exponent);
  const auto field = static_cast<std::uint64_t>(leading + exponent_bias);
  return (field << fraction_bits) |
         ((significand << (fraction_bits + 1 - bits)) & (hidden_bit - 1));
}

void write_bits(std::string& text, std::uint64_t bits) {
  static constexpr std::string_view digits = "0123456789abcdef";
  static constexpr int exponent_mask = 0x7FF, digit_bits = 4;
  const int field = static_cast<int>(bits >> fraction_bits) & exponent_mask;
  std::uint64_t fraction = bits & (hidden_bit - 1);
  if ((bits >> 63U) != 0) text += '-';
  text += field == 0 ? "0x0" : "0x1";
  if (fraction != 0) text += '.';
  while (fraction != 0) {
    text += digits[fraction >> (fraction_bits - digit_bits)];
    fraction = (fraction << digit_bits) & (hidden_bit - 1);
  }
  // Zero has no exponent, and subnormal numbers have that of the least normal one.
  const bool is_zero = (bits << 1U) == 0;
  const int exponent = is_zero ? 0 : std::max(field, 1) - exponent_bias;
  text += exponent < 0 ? "p" : "p+";
  text += std::to_string(exponent);
}

void write_kind(std::string& text, const Certificate& certificate) {
  text += certificate.kind.is_cell()                   ? "query tetrahedron\n"
          : certificate.kind == ContactKind::edge_edge ? "query edge_edge\n"
                                                       : "query vertex_face\n";
}

void write_label(std::string& text, std::string_view label) {
  if (!label.empty()) text.append("label ").append(label_text(label)).append("\n");
}

void write_point(std::string& text, std::span<const double> numbers) {
  text += "point";
  for (const double x : numbers) write_hexadecimal(text += ' ', x);
  text += '\n';
}

void write_points(std::string& text, const Query& query) {
  const std::span<const double> coordinates(query.coordinates);
  for (std::size_t first = 0; first < coordinates.size(); first += 3) {
    write_point(text, coordinates.subspan(first, 3));
  }
}

void write_points(std::string& text, const CurvedQuery& query) {
  for (const Trajectory& curve : query) {
    text.append(curve.weights.empty() ? "curve " : "rational ");
    text.append(std::to_string(curve.degree())).append("\n");
    for (std::size_t j = 0; j < curve.control.size(); ++j) {
      const auto& [x, y, z] = curve.control[j];
      const std::array numbers{x, y, z, curve.weights.empty() ? 1.0 : curve.weights[j]};
      write_point(text, std::span(numbers).first(curve.weights.empty() ? 3 : 4));
    }
  }
}

void write_separation(std::string& text, const Separation& separation) {
  if (is_zero(separation)) return;
  text += "separation ";
  write_hexadecimal(text, separation.distance);
  text.append(" ").append(to_string(separation.norm)).append("\n");
}

void write_interval(std::string& text, const RationalInterval& interval) {
  write_number(text, interval.lower);
  text += ' ';
  write_number(text, interval.upper);
}

void write_claim(std::string& text, const Certificate& certificate) {
  const bool is_tetrahedron = certificate.kind.is_cell();
  switch (certificate.claim) {
    case Claim::no_collision:
      text += is_tetrahedron ? "claim no_inversion\n" : "claim no_collision\n";
      break;
    case Claim::collision:
      text += is_tetrahedron ? "claim inversion\n" : "claim collision\n";
      break;
    default:
      text += is_tetrahedron ? "claim time_of_inversion " : "claim time_of_impact ";
      write_interval(text, certificate.toi);
      text += '\n';
  }
}

char axis_name(std::size_t axis) { return "xyz"[axis]; }

template <std::size_t count>
void write_corners(std::string& text, const std::array<std::size_t, count>& corners) {
  for (const std::size_t corner : corners) text.append(" ").append(std::to_string(corner));
}

void write_feature(std::string& text, const Feature& feature) {
  using Sort = Feature::Sort;
  const auto& [sort, i, j, axis] = feature;
  switch (sort) {
    case Sort::vertex:
      return write_corners(text += "vertex", std::array{i});
    case Sort::edge:
      return write_corners(text += "edge", std::array{i, j});
    case Sort::cross:
      (text += "cross ") += axis_name(axis);
      return write_corners(text, std::array{i, j});
    case Sort::positive_axis:
    case Sort::negative_axis:
      (text += "axis ") += axis_name(axis);
      break;
    default:
      text += "face";
  }
  const bool is_positive = sort == Sort::positive_face || sort == Sort::positive_axis;
  text += is_positive ? " +" : " -";
}

/// Writes a place by its type.
struct PlaceWriter {
  std::string& text;

  void operator()(const TriangleContact& place) const {
    write_corners(text += "triangle", place.corners);
    (text += ' ') += axis_name(place.axis);
  }
  void operator()(const SegmentContact& place) const {
    write_corners(text += "segment", place.corners);
  }
  void operator()(const VertexContact& place) const {
    write_corners(text += "vertex", std::array{place.corner});
  }
  void operator()(const EdgeContact& place) const { write_corners(text += "edge", place.corners); }
  void operator()(const FaceContact&) const { text += "face"; }
  void operator()(const AxesContact&) const { text += "axes"; }
  void operator()(const PlaneContact&) const { text += "plane"; }
};

/// True for a byte of a UTF-8 character after its first.
bool is_continuation(char c) { return (static_cast<unsigned char>(c) & 0xC0U) == 0x80U; }

}  // namespace

std::string label_text(std::string_view label) {
  if (label.size() > label_limit) {
    label.remove_prefix(label.size() - label_limit);
    static constexpr std::size_t most_continuations = 3;
    for (std::size_t n = 0; n < most_continuations && is_continuation(label.front()); ++n) {
      label.remove_prefix(1);
    }
  }
  static constexpr unsigned char first_printable = 0x20, last_control = 0x7F;
  std::string text(label);
  for (char& c : text) {
    const auto byte = static_cast<unsigned char>(c);
    if (byte < first_printable || byte == last_control) c = '?';
  }
  return text;
}

std::string_view certificates_header() { return "touchstone-certificates 2\n"; }

std::string certificates_closing_line(std::uint64_t certificates) {
  return "certificates " + std::to_string(certificates) + "\n";
}

void write(std::string& text, const Certificate& certificate, std::string_view label) {
  write_kind(text, certificate);
  write_label(text, label);
  std::visit([&](const auto& query) { write_points(text, query); }, certificate.query);
  write_separation(text, certificate.separation);
  write_claim(text, certificate);
  write_subintervals(text, certificate.subintervals);
  if (certificate.contact) write_contact(text, *certificate.contact);
  text += "end\n";
}

void write_subintervals(std::string& text, const std::vector<Subinterval>& subintervals) {
  for (const auto& [from, to, feature] : subintervals) {
    text += "separate ";
    write_interval(text, {from, to});
    text += ' ';
    write_feature(text, feature);
    text += '\n';
  }
}

void write_contact(std::string& text, const ContactProof& contact) {
  if (const auto* time = std::get_if<Rational>(&contact.time)) {
    text += "contact time ";
    write_number(text, *time);
  } else {
    const auto& root = std::get<RootTime>(contact.time);
    text += "contact root ";
    write_interval(text, root.interval);
    for (const Integer& x : root.polynomial.coefficients()) text.append(" ").append(x.get_str());
  }
  text += "\nat ";
  std::visit(PlaceWriter{text}, contact.place);
  text += '\n';
}

std::string certificate_stream(const Certificate& certificate, std::string_view label) {
  std::string text(certificates_header());
  write(text, certificate, label);
  return text + certificates_closing_line(1);
}

void write_hexadecimal(std::string& text, double value) {
  write_bits(text, std::bit_cast<std::uint64_t>(value));
}

void write_number(std::string& text, const Rational& value) {
  std::string fraction = value.get_str();
  if (const auto bits = double_bits(value)) {
    std::string hexadecimal;
    write_bits(hexadecimal, *bits);
    if (hexadecimal.size() < fraction.size()) fraction = std::move(hexadecimal);
  }
  text += fraction;
}

}  // namespace touchstone::exact
