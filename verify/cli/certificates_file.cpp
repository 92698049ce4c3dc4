#include "verify/cli/certificates_file.hpp"

#include "verify/cli/options.hpp"

namespace touchstone::verify::cli {

CertificatesFile::CertificatesFile(Files& files, const std::string& name, std::string_view header)
    : output_(files, name) {
  if (name.ends_with(".zst")) compressor_.emplace();
  write(header);
}

void CertificatesFile::write(std::string_view certificates) {
  if (!output_ || output_.failed()) return;
  if (compressor_) {
    put(compressor_->compress(certificates));
  } else {
    put(certificates);
  }
}

void CertificatesFile::close(std::string_view closing_line) {
  write(closing_line);
  finish();
  output_.close();
}

void CertificatesFile::close_incomplete() {
  finish();
  output_.close_incomplete();
}

void CertificatesFile::finish() {
  if (output_ && !output_.failed() && compressor_) put(compressor_->finish());
}

void CertificatesFile::put(std::string_view bytes) {
  output_.write(bytes);
  bytes_ += bytes.size();
}

void report_beyond_limits(const jobs::ProofCounts& counts) {
  for (const std::string& reason : counts.beyond_limits) report_error(reason);
}

}  // namespace touchstone::verify::cli
