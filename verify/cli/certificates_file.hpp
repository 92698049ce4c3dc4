#pragma once

/// \file
/// The file of certificates that a command writes, compressed where its name says so.

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "exact/certificate/certificate_text.hpp"
#include "verify/cli/files.hpp"
#include "verify/io/compressor.hpp"
#include "verify/jobs/prove.hpp"

namespace touchstone::verify::cli {

/// A stream of certificates in a file, if one is named; compressed if the name ends in ".zst". A
/// failure is reported, once, as that of Output.
class CertificatesFile {
 public:
  /// \throws as Output does.
  /// \param header the first line
  CertificatesFile(Files& files, const std::string& name,
                   std::string_view header = exact::certificates_header());

  /// Was a file named?
  [[nodiscard]] explicit operator bool() const { return static_cast<bool>(output_); }
  [[nodiscard]] bool failed() const { return output_.failed(); }

  /// Bytes written to the file so far.
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

  /// Appends whole certificates.
  void write(std::string_view certificates);

  /// Completes the stream, of so many certificates, and the file.
  void close(std::uint64_t certificates) { close(exact::certificates_closing_line(certificates)); }
  /// The same with another closing line.
  void close(std::string_view closing_line);
  /// Closes a stream that lacks certificates: without its closing line, so that the checker takes it for cut,
  /// and in a file of another name (Output::close_incomplete).
  void close_incomplete();

 private:
  void put(std::string_view bytes);
  /// Writes all that is left.
  void finish();

  Output output_;
  std::optional<io::Compressor> compressor_;
  std::uint64_t bytes_ = 0;
};

/// Says on standard error which queries have no certificate, and why.
void report_beyond_limits(const jobs::ProofCounts& counts);

}  // namespace touchstone::verify::cli
