#include "touchstone/certificate_text.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cstdio>
#include <limits>
#include <string>
#include <utility>

#include "tests/support/certificates.hpp"
#include "tests/support/random.hpp"

namespace touchstone::exact::certificate_text_test {
namespace {

using tests::written;
using Limits = std::numeric_limits<double>;

std::string hexadecimal(double value) {
  std::string text;
  write_hexadecimal(text, value);
  return text;
}

std::string printf_a(double value) {
  std::array<char, 64> buffer{};
  // NOLINTNEXTLINE(cppcoreguidelines-pro-type-vararg)
  const int length = std::snprintf(buffer.data(), buffer.size(), "%a", value);
  return {buffer.data(), static_cast<std::size_t>(length)};
}

TEST(WriteHexadecimal, IsWhatPrintfWrites) {
  for (const double x :
       {0.0, -0.0, 1.0, -1.5, 0.1, 1e300, Limits::max(), Limits::lowest(), Limits::min(),
        Limits::denorm_min(), -3 * Limits::denorm_min(), 0x1p-1023}) {
    EXPECT_EQ(hexadecimal(x), printf_a(x));
  }
  tests::Random random(1);
  for (int repetition = 0; repetition < 20000; ++repetition) {
    const double x = random.finite_double();
    ASSERT_EQ(hexadecimal(x), printf_a(x));
  }
}

TEST(WriteNumber, TakesTheShortestForm) {
  EXPECT_EQ(written(0), "0");
  EXPECT_EQ(written(-7), "-7");
  EXPECT_EQ(written(Rational(1, 2)), "1/2");
  EXPECT_EQ(written(Rational(1, 3)), "1/3");
  EXPECT_EQ(written(Rational(0.1)), "0x1.999999999999ap-4");
  EXPECT_EQ(written(power_of_two(-1074)), "0x0.0000000000001p-1022");
  EXPECT_EQ(written(power_of_two(1023)), "0x1p+1023");
  // Numbers that are not doubles: too many bits, or too small.
  EXPECT_EQ(written(power_of_two(-60) + 1), "1152921504606846977/1152921504606846976");
  EXPECT_EQ(written(power_of_two(-1075)), "1/" + Integer(Integer(1) << 1075U).get_str());
}

TEST(WriteNumber, LosesNothing) {
  tests::Random random(2);
  for (int repetition = 0; repetition < 5000; ++repetition) {
    const Rational x(std::abs(random.finite_double()));
    ASSERT_EQ(tests::read_number(written(x)), x);
  }
}

/// The text of a certificate, from the last point on.
std::string end_of(const Certificate& certificate) {
  std::string text;
  write(text, certificate);
  return text.substr(text.find('\n', text.rfind("point")) + 1);
}

TEST(WriteCertificate, NamesEveryPlaceOfContactAndDistancesAboveZero) {
  const RootTime root{{Rational(1, 2), 1}, Polynomial(Integer(-1), Integer(0), Integer(2))};
  Certificate certificate;
  certificate.claim = Claim::collision;
  certificate.contact = {root, SegmentContact{{1, 2}}};
  EXPECT_EQ(end_of(certificate),
            "claim collision\ncontact root 1/2 1 -1 0 2\nat segment 1 2\nend\n");
  for (const auto& [distance, line] : {std::pair(0.125, "separation 0x1p-3 l2\n"),
                                       {0x1p-1074, "separation 0x0.0000000000001p-1022 l2\n"},
                                       {0.0, ""},
                                       {-0.0, ""}}) {
    certificate.separation = {.distance = distance, .norm = Norm::l2};
    for (const auto& [place, text] :
         {std::pair<ContactPlace, const char*>(VertexContact{2}, "at vertex 2"),
          {EdgeContact{{1, 2}}, "at edge 1 2"},
          {FaceContact{}, "at face"},
          {AxesContact{}, "at axes"},
          {PlaneContact{}, "at plane"}}) {
      certificate.contact = {Rational(1, 2), place};
      EXPECT_EQ(end_of(certificate),
                line + std::string("claim collision\ncontact time 1/2\n") + text + "\nend\n");
    }
  }
}

TEST(CertificateStream, BeginsWithItsHeaderAndEndsWithItsCount) {
  Certificate certificate;
  certificate.subintervals = {{0, 1, {.sort = Feature::Sort::positive_face}}};
  std::string text;
  write(text, certificate, "x:1");
  EXPECT_EQ(certificate_stream(certificate, "x:1"),
            std::string(certificates_header()) + text + "certificates 1\n");
  EXPECT_EQ(certificates_closing_line(18446744073709551615U),
            "certificates 18446744073709551615\n");
  EXPECT_TRUE(tests::check(std::string(certificates_header()) + certificates_closing_line(0))
                  .all_accepted());
}

TEST(WriteCertificate, KeepsLabelsToOneLineAndTheirLimit) {
  std::string text;
  write(text, Certificate{}, "a\nquery b\r\x7f");
  EXPECT_NE(text.find("\nlabel a?query b??\npoint"), std::string::npos);
  text.clear();
  write(text, Certificate{}, std::string(2000, 'x') + "end");
  EXPECT_NE(text.find("\nlabel " + std::string(label_limit - 3, 'x') + "end\n"), std::string::npos);
}

TEST(WriteCertificate, CutsALabelBetweenCharacters) {
  // Characters of two, three and four bytes.
  for (const std::string character : {"\u00e9", "\u20ac", "\U0001d11e"}) {
    std::string label;
    while (label.size() <= label_limit) label += character;
    for (const std::string end : {"", "a", "ab", "abc"}) {
      const std::string text = label_text(label + end);
      EXPECT_LE(text.size(), label_limit);
      EXPECT_GT(text.size() + character.size(), label_limit);
      EXPECT_EQ((text.size() - end.size()) % character.size(), 0U);
      EXPECT_TRUE(text.starts_with(character));
      EXPECT_TRUE(text.ends_with(end));
    }
  }
  EXPECT_EQ(label_text(std::string(2000, '\x80')).size(), label_limit - 3) << "no UTF-8";
}

}  // namespace
}  // namespace touchstone::exact::certificate_text_test
