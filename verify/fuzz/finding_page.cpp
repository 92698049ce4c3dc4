#include "verify/fuzz/finding_page.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <cstddef>
#include <string_view>

#include "verify/fuzz/diagnosis.hpp"
#include "verify/io/json.hpp"
#include "verify/io/output_file.hpp"
#include "verify/io/printable.hpp"
#include "verify/judge/separation_inference.hpp"

namespace touchstone::verify::fuzz {
namespace {

std::string code_block(std::string_view language, std::string_view text) {
  return fmt::format("```{}\n{}```\n", language, text);
}

std::string facts(const FuzzReport& report, const FindingGroup& group, const Finding& finding) {
  const fast::MethodOptions& options = report.solver.options;
  std::string result = "| | |\n|---|---|\n";
  const auto add = [&result](std::string_view name, const std::string& value) {
    std::string cell = value;
    std::ranges::replace(cell, '|', '/');
    result += fmt::format("| {} | {} |\n", name, cell);
  };
  add("answer", finding.simplest.detail);
  add("truth", finding.simplest.truth);
  add("query", fmt::format("{}, from t=0 to t=1", to_text(finding.simplest.query.shape())));
  add("asked with",
      fmt::format("tolerance {}, at most {} checks, minimum separation {}", options.tolerance,
                  options.max_checks,
                  is_zero(options.separation) ? "0" : judge::to_text(options.separation)));
  add("times powers of two", scale_text(finding, report.solver));
  add("findings of this sort", std::to_string(group.count));
  return result;
}

void write_file(const std::filesystem::path& path, std::string_view text) {
  io::OutputFile file(path);
  file.write(text);
  file.close();
}

}  // namespace

std::string as_page(const FuzzReport& report, const FindingGroup& group, CallInterface interface,
                    const std::string& name) {
  const Finding& finding = report.result.findings.at(group.best);
  const Reproduction found = reproduction_of(finding, report.solver);
  const FailingCase& failing = finding.simplest;
  std::string page = fmt::format("# {} {}\n\n{}\n## The points\n\n", io::printable(finding.method),
                                 judge::to_phrase(finding.what), facts(report, group, finding));
  page += "Each line gives the same doubles twice, in decimal and in hexadecimal.\n\n";
  page += code_block("", as_points(failing.query));
  page += fmt::format(
      "\n## See it\n\n`{}.cpp` needs nothing but the solver. It ends with 1 if the answer is wrong "
      "as "
      "above, and with 0 if it is not.\n\n",
      name);
  page += code_block("cpp", as_main(found, interface));
  page += "\n## Check the truth\n\n";
  if (failing.certificate.empty()) {
    page += "The proof is beyond the limits of certificates.\n";
  } else {
    page += fmt::format(
        "This certificate (`{0}.cert`) proves the truth in integer arithmetic. `touchstone-check "
        "{0}.cert` checks it; that program is a few hundred lines, needs only GMP, and shares no "
        "code "
        "with the one that wrote the certificate.\n\n",
        name);
    page += code_block("", failing.certificate);
  }
  return page + "\n## Ask again\n\n" + code_block("sh", as_command(found));
}

std::vector<std::filesystem::path> write_pages(const FuzzReport& report, CallInterface interface,
                                               const std::filesystem::path& folder) {
  std::filesystem::create_directories(folder);
  std::vector<std::filesystem::path> pages;
  for (std::size_t i = 0; i < report.result.groups.size(); ++i) {
    const FindingGroup& group = report.result.groups[i];
    const Finding& finding = report.result.findings.at(group.best);
    const Reproduction found = reproduction_of(finding, report.solver);
    const std::string name = fmt::format("{}-{}", i + 1, to_string(finding.what));
    pages.push_back(folder / (name + ".md"));
    write_file(pages.back(), as_page(report, group, interface, name));
    write_file(folder / (name + ".cpp"), as_main(found, interface));
    if (!finding.simplest.certificate.empty()) {
      write_file(folder / (name + ".cert"), finding.simplest.certificate);
    }
  }
  write_file(folder / "findings.json", io::json_document(to_json(report)));
  return pages;
}

}  // namespace touchstone::verify::fuzz
