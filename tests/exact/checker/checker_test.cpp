/// \file
/// The checker on streams: what it counts, how it goes on after a rejection, what it does with
/// bytes that are no certificates; and the examples of the manual.

#include "exact/checker/checker.hpp"

#include <gtest/gtest.h>

#include <cstddef>
#include <cstdint>
#include <fstream>
#include <locale>
#include <sstream>
#include <stdexcept>
#include <string>
#include <string_view>
#include <vector>

#include "tests/support/built_files.hpp"
#include "tests/support/checker_outcome.hpp"
#include "tests/support/folder_test.hpp"
#include "tests/support/rows.hpp"

namespace touchstone::checker::checker_test {
namespace {

using namespace std::string_literals;
using tests::check_text;
using tests::outcome;

const std::string header(tests::certificate_header);

/// A query and the proofs of what it does, without the header: 11 to 13 lines each.
const std::string points_of_no_collision =
    "point 1 1 1\npoint 0 0 0\npoint 4 0 0\npoint 0 4 0\npoint 1 1 2\npoint 0 0 0\npoint 4 0 "
    "0\npoint 0 4 0\n";
const std::string points_of_collision =
    "point 1 1 1\npoint 0 0 0\npoint 4 0 0\npoint 0 4 0\npoint 1 1 -1\npoint 0 0 0\npoint 4 0 "
    "0\npoint 0 4 0\n";
const std::string apart = "query vertex_face\n" + points_of_no_collision +
                          "claim no_collision\nseparate 0 1 face +\nend\n";
const std::string colliding = "query vertex_face\n" + points_of_collision +
                              "claim collision\ncontact time 1/2\nat triangle 0 1 2 z\nend\n";
const std::string impact = "query vertex_face\n" + points_of_collision +
                           "claim time_of_impact 1/4 1/2\nseparate 0 1/4 face +\ncontact time 1/2\n"
                           "at triangle 0 1 2 z\nend\n";
const std::string lie =
    "query vertex_face\n" + points_of_collision + "claim no_collision\nseparate 0 1 face +\nend\n";

/// "LINE LABEL: REASON" of each rejection.
std::vector<std::string> rejections(const Report& report) {
  std::vector<std::string> result;
  for (const auto& [line, label, reason] : report.rejections) {
    std::ostringstream text;
    text << line << ' ' << label << ": " << reason;
    result.push_back(text.str());
  }
  return result;
}

using Texts = std::vector<std::string>;

/// The report on certificates behind which the closing line stands.
Report check_closed(const std::string& text, const Options& options = {}) {
  return check_text(tests::closed(text), options);
}

/// A stream, how many certificates of it are accepted, and what is told of the others.
struct Told {
  std::string stream;
  std::uint64_t accepted;
  Texts rejections;
};

TEST(Check, TellsWhatItAcceptsAndRejects) {
  const std::string begin = header + apart,
                    no_closing = "the stream is cut: it has no closing line";
  const std::string broken = "query vertex_face\nlabel one\npoint 1 1 x\nclaim no_collision\nend\n",
                    endless = "query vertex_face\nlabel two\n" + points_of_no_collision +
                              "claim no_collision\nseparate 0 1 face +\n",
                    labelled = "query vertex_face\nlabel first\n" + apart.substr(18),
                    without_proof = "query vertex_face\n" + points_of_no_collision +
                                    "claim no_collision\nend\n",
                    not_positive = "a polynomial is not positive at a point";
  std::string lie_among_truths = header;
  for (int n = 0; n < 101; ++n) lie_among_truths += n < 50 ? apart : n == 50 ? lie : impact;
  const std::vector<Told> all{
      {header + "\n# nothing\ncertificates 0\n", 0, {}},
      {begin + "certificates 1\n\n# the end\n", 1, {}},
      {header, 0, {"1 : " + no_closing + " 'certificates 0'"}},
      {header + "\n# nothing\n", 0, {"3 : " + no_closing + " 'certificates 0'"}},
      {header + apart + colliding, 2, {"26 : " + no_closing + " 'certificates 2'"}},
      {begin + "certificates 1", 1, {"14 : the last line is not ended by a newline"}},
      {begin.substr(0, begin.size() - 1),
       0,
       {"13 : the last line is not ended by a newline",
        "13 : " + no_closing + " 'certificates 1'"}},
      {begin + "certificate 1\n",
       1,
       {"14 : expected 'query', found 'certificate'", "14 : " + no_closing + " 'certificates 1'"}},
      // A rejected certificate is one of those that the closing line counts.
      {begin + "query x\ncertificates 2\n", 1, {"14 : unknown word: 'x'"}},
      {begin + "query x\ncertificates 1\n",
       1,
       {"14 : unknown word: 'x'",
        "15 : expected the closing line 'certificates 2', found 'certificates 1'"}},
      {tests::closed(begin) + apart + header + lie, 1, {"15 : a line after the closing line"}},
      {tests::closed(header + broken + apart + endless + colliding + "stray 1\nstray 2\n" +
                     "query\n" + apart + "query x\nquery y\n" + impact),
       4,
       {"4 one: not a number: 'x'", "31 two: expected 'end', found 'query'",
        "44 : expected 'query', found 'stray'", "46 : the line has too few words",
        "59 : unknown word: 'x'", "60 : unknown word: 'y'"}},
      {tests::closed(lie_among_truths), 100, {"612 : " + not_positive}},
      // A proof of one query is none of the next; nor is its label.
      {tests::closed(begin + without_proof), 1, {"23 : there is no subinterval"}},
      {tests::closed(header + labelled + lie), 1, {"25 : " + not_positive}},
      {tests::closed(header + "query vertex_face\nlabel a \x1b[2Jb\t\xc3\xa9\0\r\n"s +
                     "point x\nend\n"),
       0,
       {"4 a \\x1b[2Jb\\x09\\xc3\\xa9\\x00\\x0d: not a number: 'x'"}}};
  for (const auto& [stream, accepted, expected] : all) {
    const Report report = check_text(stream);
    EXPECT_EQ(report.accepted(), accepted) << stream;
    EXPECT_EQ(rejections(report), expected) << stream;
    EXPECT_EQ(report.rejected, expected.size());
    EXPECT_EQ(report.all_accepted(), expected.empty());
  }
}

TEST(Check, HoldsTheClosingLineToTheNumberOfCertificates) {
  for (const std::string_view number :
       {" 0", " 2", " 01", " -1", " 1 ", " 1\r", "  1", "", " 1 1", " 18446744073709551617"}) {
    const std::string closing = "certificates" + std::string(number);
    const Report report = check_text(header + apart + closing + "\n");
    EXPECT_EQ(report.accepted(), 1U) << number;
    ASSERT_EQ(report.rejected, 1U) << number;
    EXPECT_TRUE(report.rejections[0].reason.starts_with(
        "expected the closing line 'certificates 1', found 'certificates"))
        << report.rejections[0].reason;
  }
}

TEST(Check, RejectsAStreamOfAnotherKindAsAWhole) {
  for (const std::string& first :
       {""s, "\n"s, "touchstone-certificates 2"s, "touchstone-certificates 2\r\n"s,
        "touchstone-certificates 1\n"s, "touchstone-certificates 2 \n"s,
        " touchstone-certificates 2\n"s, "touchstone-certificates\n"s,
        "Touchstone-certificates 2\n"s, "\xef\xbb\xbftouchstone-certificates 2\n"s,
        "# comment\n" + header, "\n" + header, "touchstone-certificates 2\0\n"s,
        std::string(70'000, 'x') + "\n"}) {
    const Report report = check_text(std::string(first).append(apart).append(lie));
    EXPECT_EQ(report.accepted(), 0U) << first;
    EXPECT_EQ(rejections(report), Texts{"1 : the first line is not 'touchstone-certificates 2'"})
        << first;
  }
}

/// Cut anywhere, a stream is not accepted, and proves at most what was complete.
TEST(Check, AcceptsNoCutStream) {
  const std::string text = tests::closed(header + apart + colliding);
  for (std::size_t length = 0; length < text.size(); ++length) {
    const Report report = check_text(text.substr(0, length));
    const std::uint64_t complete =
        (length >= header.size() + apart.size() ? 1U : 0U) +
        (length >= header.size() + apart.size() + colliding.size() ? 1U : 0U);
    EXPECT_EQ(report.accepted(), complete) << length;
    EXPECT_FALSE(report.all_accepted()) << length;
  }
  EXPECT_TRUE(check_text(text).all_accepted());
}

/// Any byte in the place of any byte: where it is accepted, nothing but a label or the way of
/// writing changed, or the claim is still true. The query: v moves from (1,1,1) to (1,1,2).
TEST(Check, SurvivesEveryByte) {
  const std::string text = tests::closed(header + apart);
  for (std::size_t at = 0; at < text.size(); ++at) {
    for (int byte = 0; byte < 256; ++byte) {
      std::string altered = text;
      altered[at] = static_cast<char>(byte);
      const Report report = check_text(altered);
      ASSERT_LE(report.accepted(), 1U);
      // The subinterval, the claim and the frame admit no change that is still accepted.
      const bool is_point = text.compare(text.rfind('\n', at) + 1, 5, "point") == 0;
      if (altered != text && !is_point) {
        ASSERT_FALSE(report.all_accepted()) << altered;
        ASSERT_EQ(report.accepted(), at < header.size() + apart.size() ? 0U : 1U) << altered;
      }
    }
  }
}

TEST(Check, DoesNotDependOnTheLocale) {
  struct Punctuation : std::numpunct<char> {
    [[nodiscard]] char do_decimal_point() const override { return ','; }
    [[nodiscard]] char do_thousands_sep() const override { return '0'; }
    [[nodiscard]] std::string do_grouping() const override { return "\1"; }
  };
  const std::locale before =
      std::locale::global(std::locale(std::locale::classic(), new Punctuation));
  const Report report = check_closed(header + apart + colliding + impact + lie);
  std::locale::global(before);
  EXPECT_EQ(report.accepted(), 3U);
  EXPECT_EQ(rejections(report), Texts{"51 : a polynomial is not positive at a point"});
}

TEST(Check, TellsAnErrorFromTheEnd) {
  std::ifstream directory("/");
  EXPECT_THROW((void)check(directory), std::runtime_error);
  std::ifstream missing("/does/not/exist");
  EXPECT_THROW((void)check(missing), std::runtime_error);
}

// ---- Files --------------------------------------------------------------------------------------

/// The blocks of the manual that hold certificates: all are accepted, and every claim is among
/// them.
TEST(Manual, HasExamplesThatAreAccepted) {
  const std::string manual = tests::read_file(tests::source_folder() + "/exact/CERTIFICATES.md"),
                    fence = "```\n";
  Report sum;
  for (std::size_t at = 0; (at = manual.find(fence + header, at)) != std::string::npos;) {
    const std::size_t begin = at + fence.size(), end = manual.find("\n```", begin) + 1;
    const Report report = check_text(manual.substr(begin, end - begin));
    EXPECT_EQ(rejections(report), Texts{});
    sum.no_collision += report.no_collision;
    sum.collision += report.collision;
    sum.time_of_impact += report.time_of_impact;
    sum.time_of_inversion += report.time_of_inversion;
    at = end;
  }
  EXPECT_EQ(sum.no_collision, 2U);
  EXPECT_EQ(sum.collision, 1U);
  EXPECT_EQ(sum.time_of_impact, 3U);
  EXPECT_EQ(sum.time_of_inversion, 1U);
  for (const std::string first_line : {"touchstone-steps 2\n", "touchstone-meshes 1\n"}) {
    const std::size_t begin = manual.find(fence + first_line) + fence.size();
    const Report report = check_text(manual.substr(begin, manual.find("\n```", begin) + 1 - begin));
    EXPECT_EQ(rejections(report), Texts{});
    EXPECT_EQ(report.steps.size() + report.meshes.size(), 1U);
  }
}

}  // namespace
}  // namespace touchstone::checker::checker_test
