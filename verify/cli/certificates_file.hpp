#pragma once

/// \file
/// The output file of certificates, compressed if its name ends in ".zst".

#include <cstdint>
#include <optional>
#include <string>
#include <string_view>

#include "touchstone/certificate_text.hpp"
#include "verify/cli/files.hpp"
#include "verify/io/compressor.hpp"
#include "verify/jobs/prove.hpp"

namespace touchstone::verify::cli {

/// A stream of certificates in a file, if one is named. A failure is reported once, as by Output.
class CertificatesFile {
 public:
  /// \throws as Output.
  /// \param header the first line
  CertificatesFile(Files& files, const std::string& name,
                   std::string_view header = exact::certificates_header());

  /// True if a file was named.
  [[nodiscard]] explicit operator bool() const { return static_cast<bool>(output_); }
  [[nodiscard]] bool failed() const { return output_.failed(); }

  /// Bytes written to the file so far.
  [[nodiscard]] std::uint64_t bytes() const { return bytes_; }

  /// Appends whole certificates.
  void write(std::string_view certificates);

  /// Completes the stream with this number of certificates, and the file; closes it as incomplete
  /// if the run was interrupted.
  void close(std::uint64_t certificates);
  /// The same with another closing line.
  void close(std::string_view closing_line);
  /// Closes a stream that lacks certificates: without its closing line, so that the checker takes
  /// it for cut, and in a file of another name (Output::close_incomplete).
  void close_incomplete();
  /// Leaves the file of that name as it was.
  void discard() {
    output_.discard();
    bytes_ = 0;
  }

 private:
  void put(std::string_view bytes);
  /// Writes all that is left.
  void finish();

  Output output_;
  std::optional<io::Compressor> compressor_;
  std::uint64_t bytes_ = 0;
};

/// Reports on standard error the queries without a certificate, with the reasons.
void report_beyond_limits(const jobs::ProofCounts& counts);

}  // namespace touchstone::verify::cli
