#include "exact/checker/checker.hpp"

#include <optional>
#include <stdexcept>

#include "exact/checker/certificate.hpp"
#include "exact/checker/proof.hpp"
#include "exact/checker/step.hpp"

namespace touchstone::checker {
namespace {

constexpr std::string_view header = "touchstone-certificates 2";
constexpr std::string_view steps_header = "touchstone-steps 1";
constexpr std::string_view closing_word = "certificates";
constexpr std::size_t max_shown_bytes = 40;

/// Does what may be rejected, and counts a rejection: at the line, or else that of the reader.
/// \returns whether there was none.
template <class Work>
bool attempt(Report& report, const Options& options, const Reader& reader, const std::size_t& line,
             const std::string& label, const Work& work) {
  try {
    work();
    return true;
  } catch (const Rejected& rejected) {
    const std::size_t place = line != 0 ? line : reader.number();
    if (report.rejected++ < options.max_rejections) {
      report.rejections.push_back({place, printable(label), rejected.reason});
    }
    return false;
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
  const bool is_accepted = attempt(report, options, reader, line_of_proof, certificate.label, [&] {
    read_certificate(reader, certificate);
    verify(certificate, line_of_proof);
    ++accepted(report, certificate.claim);
  });
  if (is_accepted || line_of_proof != 0) return;
  const auto may_begin = [&] {
    return reader.first_word() == "query" || reader.first_word() == closing_word;
  };
  while (!reader.at_end() && (reader.number() == first || !may_begin())) reader.advance();
}

/// Checks the end of a stream of so many certificates: the closing line, and nothing behind it.
/// \throws Rejected if it is another, or missing.
void check_end(Reader& reader, std::string_view word, std::uint64_t certificates) {
  const std::string expected = std::string(word) + ' ' + std::to_string(certificates);
  if (reader.at_end()) reject("the stream is cut: it has no closing line '" + expected + "'");
  reader.begin(word);
  if (reader.text() != expected) {
    reject("expected the closing line '" + expected + "', found '" +
           printable(reader.text().substr(0, max_shown_bytes)) + "'");
  }
  reader.advance();
  if (!reader.at_end()) reject("a line after the closing line");
}

/// Checks the certificates of steps to the first that is rejected.
void check_steps(Reader& reader, Report& report, const Options& options) {
  std::size_t line_of_proof = 0;
  attempt(report, options, reader, line_of_proof, "", [&] {
    std::optional<Reader> scenes;
    if (options.scenes != nullptr) scenes.emplace(*options.scenes).advance();
    for (reader.advance(); reader.first_word() == "step";) {
      report.steps.push_back(check_step(reader, scenes ? &*scenes : nullptr, line_of_proof));
    }
    check_end(reader, "steps", report.steps.size());
    if (scenes && !scenes->at_end()) reject("not all scenes are proved");
  });
}

}  // namespace

Report check(std::istream& certificates, const Options& options) {
  if (!certificates) throw std::runtime_error("the stream cannot be read");
  Report report;
  Reader reader(certificates);
  reader.advance();
  if (reader.is_line() && reader.text() == steps_header) {
    check_steps(reader, report, options);
    return report;
  }
  if (!reader.is_line() || reader.text() != header) {
    attempt(report, options, reader, 1, "",
            [] { reject("the first line is not '" + std::string(header) + "'"); });
    return report;
  }
  std::uint64_t queries = 0;
  for (reader.advance(); !reader.at_end() && reader.first_word() != closing_word;) {
    if (reader.first_word() == "query") ++queries;
    check_one(reader, report, options);
  }
  attempt(report, options, reader, 0, "", [&] { check_end(reader, closing_word, queries); });
  return report;
}

}  // namespace touchstone::checker
