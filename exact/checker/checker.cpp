#include "exact/checker/checker.hpp"

#include <stdexcept>

#include "exact/checker/certificate.hpp"
#include "exact/checker/proof.hpp"

namespace touchstone::checker {
namespace {

constexpr std::string_view header = "touchstone-certificates 1";

void reject(Report& report, const Options& options, Rejection rejection) {
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
/// line after it, or the next `query` line.
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
    reject(report, options,
           {.line = is_read ? line_of_proof : reader.number(),
            .label = printable(certificate.label),
            .reason = rejected.reason});
    if (is_read) return;
    while (!reader.at_end() && (reader.number() == first || reader.first_word() != "query")) {
      reader.advance();
    }
  }
}

}  // namespace

Report check(std::istream& certificates, const Options& options) {
  if (!certificates) throw std::runtime_error("the stream cannot be read");
  Report report;
  Reader reader(certificates);
  reader.advance();
  if (!reader.is_line() || reader.text() != header) {
    reject(report, options, {1, "", "the first line is not '" + std::string(header) + "'"});
    return report;
  }
  for (reader.advance(); !reader.at_end();) check_one(reader, report, options);
  return report;
}

}  // namespace touchstone::checker
