#pragma once

/// \file
/// The files of a command's results: a stream of certificates (--prove), compressed if the name
/// ends in ".zst", and a page to look at (--view), as `touchstone view` writes it.

#include <cstddef>
#include <cstdint>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "fast/method.hpp"
#include "touchstone/certificate_text.hpp"
#include "verify/cli/files.hpp"
#include "verify/io/compressor.hpp"
#include "verify/jobs/prove.hpp"
#include "verify/view/step_facts.hpp"
#include "verify/view/viewed_query.hpp"

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

/// A page of the first queries that a command found, if a file is named. A failure is reported
/// once, as by Output.
class ViewFile {
 public:
  /// The maximum number of queries on a page.
  static constexpr std::size_t most_queries = 100;

  /// \throws as Output.
  ViewFile(Files& files, const std::string& name) : name_(name), output_(files, name) {}

  /// True if a file was named.
  [[nodiscard]] explicit operator bool() const { return static_cast<bool>(output_); }

  /// True if the page is full.
  [[nodiscard]] bool is_full() const { return queries_.size() >= most_queries; }

  /// Adds a query unless the page is full. If the page has the query already, its notes and answers
  /// are extended. Queries about elements are counted, and not drawn.
  void add(view::ViewedQuery query);

  /// Adds a step, and the first of its pairs.
  void add(const view::ViewedStep& step);

  /// Adds a mesh at rest, from view::resting_facts().
  void add(nlohmann::json resting_mesh);

  /// Writes the page, with answers of the certified solver under these options. Whatever fails is
  /// reported.
  void write(const fast::MethodOptions& options = {});

  /// Lines about the contents of the page; empty if no file was named or it could not be written.
  /// \param allowed false positives, which break no promise and are not on the page
  [[nodiscard]] std::string summary(std::uint64_t allowed = 0) const;

 private:
  [[nodiscard]] std::string page(const fast::MethodOptions& options) const;
  [[nodiscard]] std::string contents(std::uint64_t allowed) const;

  std::string name_;
  Output output_;
  std::vector<view::ViewedQuery> queries_;
  nlohmann::json step_;
  bool is_cut_ = false;
  std::size_t elements_ = 0;  ///< queries about elements
};

}  // namespace touchstone::verify::cli
