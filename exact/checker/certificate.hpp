#pragma once

/// \file
/// The syntax and the limits of certificates, without mathematics.

#include <gmpxx.h>

#include <array>
#include <cstddef>
#include <cstdint>
#include <initializer_list>
#include <istream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exact/checker/checker.hpp"

namespace touchstone::checker {

/// The limits of the format (exact/CERTIFICATES.md).
inline constexpr std::size_t max_line_bytes = 65'536;
inline constexpr std::size_t max_label_bytes = 1'024;
inline constexpr std::size_t max_number_bits = 16'384;
inline constexpr std::size_t max_subintervals = 4'096;
inline constexpr std::size_t max_root_degree = 256;
inline constexpr std::size_t max_curve_degree = 8;

/// Rejects a certificate; the label is added later.
/// \param line the line at fault; 0 for the reader's line
[[noreturn]] inline void reject(std::string reason, std::size_t line = 0) {
  throw Rejection{line, "", std::move(reason)};
}

/// Rejects more of something than the limit.
void require_at_most(std::size_t limit, std::size_t count, std::string_view what);

/// The text with every byte that is not printable ASCII as \xHH.
[[nodiscard]] std::string printable(std::string_view text);
/// The beginning of a word, for a message.
[[nodiscard]] std::string quoted(std::string_view word);

// ---- Numbers ------------------------------------------------------------------------------------

/// Parses a decimal integer, a fraction or a hexadecimal float.
/// \throws Rejection for any other word, or beyond the limits.
[[nodiscard]] mpq_class parse_number(std::string_view word);

/// The number in its only form: the shorter of the fraction in lowest terms and, if there is one,
/// the hexadecimal float whose first digit is 1.
[[nodiscard]] std::string to_text(const mpq_class& number);

// ---- The parts of a certificate -----------------------------------------------------------------

/// The coordinates x y z.
using Point = std::array<mpq_class, 3>;
/// A moving point: its control points from t=0 to t=1, two for a straight line.
struct Curve {
  std::vector<Point> control;
  /// The weights, > 0, of a rational curve; otherwise none.
  std::vector<mpq_class> weights;
};

/// A vertex and a face, two edges, or a tetrahedron, whose contacts are its inversions: a vertex
/// and a face, the plane of which it must not reach.
enum class Kind : std::uint8_t { vertex_face, edge_edge, tetrahedron };

struct Query {
  Kind kind = Kind::vertex_face;
  /// The points of a vertex and a face, or of two edges, in this order.
  std::array<Curve, 4> points;
};

/// The minimum separation and its norm: l2 or linf.
struct Separation {
  mpq_class distance = 0;
  bool is_l2 = false;
};

/// Of a tetrahedron they are called no_inversion, inversion, time_of_inversion.
enum class Claim : std::uint8_t { no_collision, collision, time_of_impact };

/// A statement about [from, to] on a line of its own.
struct Part {
  std::size_t line = 0;
  mpq_class from;
  mpq_class to;
  /// The corners of the feature or the place; the rest is unused.
  std::array<std::size_t, 3> corners{};
  /// The coordinate axis of an axis, a cross or a triangle.
  std::size_t axis = 0;
};

/// The name of the direction that separates.
enum class Feature : std::uint8_t { vertex, edge, face, axis, cross };

/// `separate`: no contact in the interval.
struct Subinterval : Part {
  Feature feature = Feature::vertex;
  /// True for the negative direction of a face or an axis.
  bool is_negative = false;
};

/// The place of a contact.
enum class Place : std::uint8_t { vertex, segment, triangle, edge, face, axes };

/// `contact` and `at`: the interval is that of the root; a given time is both its ends.
struct Contact : Part {
  bool is_root = false;
  /// The coefficients G0 … Gn of a root, n ≥ 1, Gn ≠ 0; none for a given time.
  std::vector<mpz_class> g;
  Place place = Place::vertex;
};

struct Certificate {
  /// The line of the claim.
  std::size_t line = 0;
  std::string label;
  Query query;
  Separation separation;
  Claim claim = Claim::no_collision;
  /// The subintervals cover [0,lower], the contact is in [lower,upper]. If upper is 0 there are no
  /// subintervals.
  mpq_class lower = 0;
  mpq_class upper = 1;
  std::vector<Subinterval> subintervals;
  Contact contact;

  [[nodiscard]] bool has_subintervals() const { return claim != Claim::collision && upper != 0; }
  [[nodiscard]] bool has_contact() const { return claim != Claim::no_collision; }
};

/// The claim and the separation in their only form, which a demand has too (checker.hpp). At
/// distance 0 the norm does not matter, and is not named unless `is_norm_named`.
[[nodiscard]] std::string to_text(const Certificate& certificate);
[[nodiscard]] std::string to_text(const Separation& separation, bool is_norm_named = false);

/// \param rules of the scene, as rules_text() says them
/// \throws Rejection, with that line, unless the options demand this claim, this separation and
/// these rules, or any.
void require_demanded(const Options& options, const std::string& claim,
                      const std::string& separation, const std::string& rules, std::size_t line);

// ---- Reading ------------------------------------------------------------------------------------

/// The lines of a stream, except empty lines and comments, and the words of the current line.
class Reader {
 public:
  /// Reads nothing yet.
  explicit Reader(std::istream& stream) : stream_(&stream), buffer_(max_line_bytes + 2, ' ') {}

  /// Goes to the next line that is neither empty nor a comment, at first to the first one.
  /// \throws std::runtime_error if the stream cannot be read.
  void advance();

  [[nodiscard]] bool at_end() const { return at_end_; }
  /// The bytes of the stream up to the end of the line.
  [[nodiscard]] std::int64_t bytes() const { return bytes_; }
  /// The number of the line, from 1; at the end that of the last line.
  [[nodiscard]] std::size_t number() const { return number_; }
  /// The line as far as it was read, until the next advance.
  [[nodiscard]] std::string_view text() const { return text_; }
  [[nodiscard]] std::string_view first_word() const { return text_.substr(0, text_.find(' ')); }

  /// Begins the line, and takes its first word if there is a keyword. \returns the line's number.
  /// \throws Rejection if there is no line or the word is another.
  std::size_t begin(std::string_view keyword = {});
  [[nodiscard]] bool has_word() const { return !rest_.empty(); }
  /// Takes the next word; words are separated by single spaces. \throws Rejection if there is none.
  std::string_view word();
  /// Takes one of these words. \returns its place among them. \throws Rejection if it is another.
  std::size_t one_of(std::initializer_list<std::string_view> words);
  /// Leaves the line and advances. \throws Rejection if the line has more words.
  void end();

 private:
  /// Reads the next line of any kind.
  void read_line();

  std::istream* stream_;
  /// A space and the line.
  std::vector<char> buffer_;
  std::size_t number_ = 0;
  std::int64_t bytes_ = 0;
  bool at_end_ = false;
  /// The reason why the line cannot be read; null if it can.
  const char* fault_ = nullptr;
  std::string_view text_;
  /// The rest of the line: nothing, or a space and the words after it.
  std::string_view rest_;
};

/// Reads the certificate that begins at the current line, to the line after its `end`. If it
/// throws, the reader is at the line at fault, and the certificate has its label if that was read.
/// \throws Rejection if the text is no certificate, std::runtime_error as Reader::advance.
void read_certificate(Reader& reader, Certificate& certificate);

// Common parts of the certificates of queries and steps. These throw as read_certificate.

[[nodiscard]] mpq_class take_number(Reader& reader);
/// Reads a line of the keyword and a label, which is the rest of the line.
[[nodiscard]] std::string read_label(Reader& reader, std::string_view keyword);
[[nodiscard]] Separation read_separation(Reader& reader);
/// Takes LO and HI, the ends of an interval with the first contact.
void take_time_of_impact(Reader& reader, mpq_class& lower, mpq_class& upper);
[[nodiscard]] std::vector<Subinterval> read_subintervals(Reader& reader, const Query& query);
[[nodiscard]] Contact read_contact(Reader& reader, const Query& query);

}  // namespace touchstone::checker
