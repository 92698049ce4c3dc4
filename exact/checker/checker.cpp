#include "exact/checker/checker.hpp"

#include <stdexcept>

#include "exact/checker/certificate.hpp"
#include "exact/checker/proof.hpp"

namespace touchstone::checker {
namespace {

constexpr std::string_view header = "touchstone-certificates 2";
constexpr std::string_view closing_word = "certificates";
constexpr std::size_t max_shown_bytes = 40;

void count_rejection(Report& report, const Options& options, Rejection rejection) {
  ++report.rejected;
  if (report.rejections.size() < options.max_rejections) {
    report.rejections.push_back(std::move(rejection));
  }
}

std::uint64_t& accepted(Report& report, Claim claim) {
  if (claim == Claim::no_collision) return report.no_collision;
  return claim == Claim::collision ? report.collision : report.time_of_impact;
}

/// Checks the certificate that begins at the present line, and goes to where the next may begin: the
/// line after it, or the next `query` line or closing line.
void check_one(Reader& reader, Report& report, const Options& options) {
  const std::size_t first = reader.number();
  Certificate certificate;
  std::size_t line_of_proof = 0;
  try {
    read_certificate(reader, certificate);
    verify(certificate, line_of_proof);
    ++accepted(report, certificate.claim);
  } catch (const Rejected& rejected) {
    const bool is_read = line_of_proof != 0;
    count_rejection(report, options,
                    {.line = is_read ? line_of_proof : reader.number(),
                     .label = printable(certificate.label),
                     .reason = rejected.reason});
    if (is_read) return;
    const auto may_begin = [&] {
      return reader.first_word() == "query" || reader.first_word() == closing_word;
    };
    while (!reader.at_end() && (reader.number() == first || !may_begin())) reader.advance();
  }
}

/// Checks the end of a stream with so many `query` lines: the closing line, and nothing behind it.
/// \throws Rejected if it is another, or missing.
void check_end(Reader& reader, std::uint64_t queries) {
  const std::string expected = std::string(closing_word) + ' ' + std::to_string(queries);
  if (reader.at_end()) reject("the stream is cut: it has no closing line '" + expected + "'");
  reader.begin(closing_word);
  if (reader.text() != expected) {
    reject("expected the closing line '" + expected + "', found '" +
           printable(reader.text().substr(0, max_shown_bytes)) + "'");
  }
  reader.advance();
  if (!reader.at_end()) reject("a line after the closing line");
}

}  // namespace

Report check(std::istream& certificates, const Options& options) {
  if (!certificates) throw std::runtime_error("the stream cannot be read");
  Report report;
  Reader reader(certificates);
  reader.advance();
  if (!reader.is_line() || reader.text() != header) {
    count_rejection(report, options,
                    {1, "", "the first line is not '" + std::string(header) + "'"});
    return report;
  }
  std::uint64_t queries = 0;
  for (reader.advance(); !reader.at_end() && reader.first_word() != closing_word;) {
    if (reader.first_word() == "query") ++queries;
    check_one(reader, report, options);
  }
  try {
    check_end(reader, queries);
  } catch (const Rejected& rejected) {
    count_rejection(report, options, {reader.number(), "", rejected.reason});
  }
  return report;
}

}  // namespace touchstone::checker
