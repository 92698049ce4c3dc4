#include "exact/checker/checker.hpp"

#include <array>
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

class StreamCheck {
 public:
  StreamCheck(std::istream& stream, const Options& options) : reader_(stream), options_(options) {}

  Report run() {
    attempt("", [&] {
      reader_.advance();
      if (reader_.text() == steps_header) return check_steps();
      if (reader_.text() == header) return check_certificates();
      reject("the first line is not '" + std::string(header) + "'", 1);
    });
    return std::move(report_);
  }

 private:
  /// Does what may be rejected, and counts a rejection.
  template <class Work>
  void attempt(const std::string& label, const Work& work) {
    try {
      work();
    } catch (const Rejection& thrown) {
      const std::size_t line = thrown.line != 0 ? thrown.line : reader_.number();
      if (report_.rejected++ < options_.max_rejections) {
        report_.rejections.push_back({line, printable(label), thrown.reason});
      }
    }
  }

  void check_certificates() {
    std::uint64_t queries = 0;
    for (reader_.advance(); !reader_.at_end() && reader_.first_word() != closing_word;) {
      if (reader_.first_word() == "query") ++queries;
      check_one();
    }
    check_end(closing_word, queries);
  }

  /// Checks the certificate that begins at the present line, and goes to where the next may begin:
  /// the line after it, or the next `query` line or closing line.
  void check_one() {
    const std::size_t first = reader_.number();
    Certificate certificate;
    bool is_read = false;
    std::int64_t work_bits_left = options_.max_work_bits;
    attempt(certificate.label, [&] {
      read_certificate(reader_, certificate);
      is_read = true;
      verify(certificate, work_bits_left);
      static constexpr std::array counts{&Report::no_collision, &Report::collision,
                                         &Report::time_of_impact};
      ++(report_.*counts.at(std::size_t(certificate.claim)));
    });
    if (is_read) return;
    const auto may_begin = [&] {
      return reader_.first_word() == "query" || reader_.first_word() == closing_word;
    };
    while (!reader_.at_end() && (reader_.number() == first || !may_begin())) reader_.advance();
  }

  /// Checks the certificates of steps to the first that is rejected.
  void check_steps() {
    std::optional<Reader> scenes;
    if (options_.scenes != nullptr) scenes.emplace(*options_.scenes).advance();
    for (reader_.advance(); reader_.first_word() == "step";) {
      report_.steps.push_back(check_step(reader_, scenes ? &*scenes : nullptr, options_));
    }
    check_end("steps", report_.steps.size());
    if (scenes && !scenes->at_end()) reject("not all scenes are proved");
  }

  /// Checks the end of a stream of so many certificates: the closing line, and nothing behind it.
  void check_end(std::string_view word, std::uint64_t certificates) {
    const std::string expected = std::string(word) + ' ' + std::to_string(certificates);
    if (reader_.at_end()) reject("the stream is cut: it has no closing line '" + expected + "'");
    reader_.begin(word);
    if (reader_.text() != expected) {
      reject("expected the closing line '" + expected + "', found " + quoted(reader_.text()));
    }
    reader_.advance();
    if (!reader_.at_end()) reject("a line after the closing line");
  }

  Reader reader_;
  const Options& options_;
  Report report_;
};

}  // namespace

Report check(std::istream& certificates, const Options& options) {
  if (!certificates) throw std::runtime_error("the stream cannot be read");
  return StreamCheck(certificates, options).run();
}

}  // namespace touchstone::checker
