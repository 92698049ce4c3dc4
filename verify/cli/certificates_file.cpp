#include "verify/cli/certificates_file.hpp"

#include "exact/certificate/certificate_text.hpp"

namespace touchstone::verify::cli {

CertificatesFile::CertificatesFile(const std::string& name) : output_(name) {
  if (name.ends_with(".zst")) compressor_.emplace();
  write(exact::certificates_header());
}

void CertificatesFile::write(std::string_view certificates) {
  if (!output_ || output_.failed()) return;
  if (compressor_) {
    put(compressor_->compress(certificates));
  } else {
    put(certificates);
  }
}

void CertificatesFile::close(std::uint64_t certificates) {
  write(exact::certificates_closing_line(certificates));
  if (output_ && !output_.failed() && compressor_) put(compressor_->finish());
  output_.close();
}

void CertificatesFile::put(std::string_view bytes) {
  output_.write(bytes);
  bytes_ += bytes.size();
}

void report_beyond_limits(const jobs::ProofCounts& counts) {
  for (const std::string& reason : counts.beyond_limits) report_error(reason);
}

}  // namespace touchstone::verify::cli
