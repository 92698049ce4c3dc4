#include "verify/data/curved_query_file.hpp"

#include <gtest/gtest.h>

#include <array>
#include <cmath>
#include <cstdint>
#include <fstream>
#include <string>
#include <vector>

#include "tests/support/folder_test.hpp"
#include "tests/verify/data/dataset_fixture.hpp"
#include "verify/data/npy_header.hpp"

namespace touchstone::verify::data::curved_query_file_test {
namespace {

class CurvedQueryFileTest : public tests::FolderTest {
 protected:
  [[nodiscard]] CurvedQueryFile read(const std::string& name, const std::string& text) const {
    std::ofstream(path(name), std::ios::binary) << text;
    return read_curved_queries(path(name));
  }
  [[nodiscard]] std::string fault(const std::string& name, const std::string& text) const {
    return test::error_of(folder(), [&] { (void)read(name, text); });
  }

  static std::string npy(const std::vector<std::uint64_t>& extents, std::uint64_t count,
                         const std::vector<double>& numbers) {
    std::string text = npy_header_text("<f8", count, extents);
    const void* const bytes = numbers.data();
    return text.append(static_cast<const char*>(bytes), numbers.size() * sizeof(double));
  }
};

TEST_F(CurvedQueryFileTest, OfNumbersIsReadInAllShapes) {
  std::vector<double> numbers;
  for (int i = 0; i < 2 * 3 * 4 * 4; ++i) numbers.push_back(i + 0.5);
  const CurvedQueryFile curves = read("a.npy", npy({4, 4, 3}, 2, numbers));
  EXPECT_EQ(curves.degree, 3U);
  EXPECT_FALSE(curves.is_rational);
  EXPECT_EQ(curves.numbers, numbers);
  const CurvedQueryFile rational = read("b.npy", npy({3, 4, 4}, 2, numbers));
  EXPECT_EQ(rational.degree, 2U);
  EXPECT_TRUE(rational.is_rational);
  const CurvedQuery second = rational.queries().query(1);
  EXPECT_EQ(second[1].control[0][0], 52.5);
  EXPECT_EQ(second[1].weights[0], 55.5);
  EXPECT_EQ(second[3].weights[2], 95.5);
  const CurvedQueryFile lines = read("c.npy", npy({8, 3}, 4, numbers));
  EXPECT_EQ(lines.degree, 1U);
  EXPECT_EQ(lines.queries().query(0)[2].control[1][1], 19.5);
}

TEST_F(CurvedQueryFileTest, IsToldFromOthersByItsHeader) {
  const auto is_curved = [this](const std::string& name, const std::string& text) {
    std::ofstream(path(name), std::ios::binary) << text;
    return is_curved_query_file(path(name));
  };
  const std::vector<double> numbers(96, 1.0);
  EXPECT_TRUE(is_curved("a.npy", npy({4, 4, 3}, 2, numbers)));
  EXPECT_TRUE(is_curved("a.npy", npy({1, 4, 4}, 6, numbers)));
  EXPECT_TRUE(is_curved("a.npy", npy({2, 5, 3}, 3, numbers))) << "its reader says what is wrong";
  EXPECT_FALSE(is_curved("a.npy", npy({8, 3}, 4, numbers)));
  EXPECT_FALSE(is_curved("a.npy", "no array"));
  EXPECT_TRUE(is_curved("a.csv", "degree,2\n"));
  EXPECT_TRUE(is_curved("a.csv", "rational,x\n"));
  EXPECT_FALSE(is_curved("a.csv", "1,2,3\n"));
  EXPECT_FALSE(is_curved("a.csv", ""));
  EXPECT_FALSE(is_curved_query_file(path("missing.csv")));
  EXPECT_FALSE(is_curved_query_file(path("")));
}

TEST_F(CurvedQueryFileTest, OfTextIsReadAsNumbersOrFractions) {
  std::string text = "degree,1\n", fractions = "rational,0\r\n";
  for (int row = 0; row < 8; ++row) text += std::to_string(row) + ",-0.25,1e3\n";
  for (int row = 0; row < 4; ++row)
    fractions += "1,2,-3,4,5,1," + std::to_string(row + 1) + ",8\r\n";
  const CurvedQueryFile lines = read("a.csv", text);
  ASSERT_EQ(lines.queries().size(), 1U);
  EXPECT_EQ(lines.queries().query(0)[3].control[1], (std::array{7.0, -0.25, 1000.0}));
  const CurvedQueryFile rest = read("b.csv", fractions);
  EXPECT_EQ(rest.queries().query(0)[2].control[0], (std::array{0.5, -0.75, 5.0}));
  EXPECT_EQ(rest.queries().query(0)[2].weights[0], 0.375);
}

TEST_F(CurvedQueryFileTest, ThatIsNoneIsRefusedWithItsPlace) {
  for (const std::string text :
       {"", "1,2,3\n", "degree,9\n", "degree,-1\n", "degree\n", "rational,x\n"}) {
    EXPECT_TRUE(fault("a.csv", text).starts_with("a.csv:")) << text;
  }
  EXPECT_EQ(fault("a.csv", "degree,9\n"),
            "a.csv:1: the first line must be degree,K or rational,K with K from 0 to 8");
  EXPECT_EQ(fault("a.csv", "degree,0\n1,2\n"),
            "a.csv:2: 3 numbers are expected, or 3 numerators and denominators");
  EXPECT_EQ(fault("a.csv", "degree,0\n1,2,0.1\n"), "a.csv:2: number 3 is no double");
  EXPECT_EQ(fault("a.csv", "degree,0\n1,2,x\n").substr(0, 18), "a.csv:2: number 3:");
  EXPECT_EQ(fault("a.csv", "degree,0\n1,2,3\n"),
            "a.csv:2: the file ends within a query, which has 4 rows");
  EXPECT_EQ(fault("a.csv", "rational,0\n1,2,3,1\n1,2,3,1\n1,2,3,0\n1,2,3,1\n"),
            "a.csv: query 0 has a weight that is not positive and finite");
  const std::vector<double> numbers(12, 1.0);
  EXPECT_EQ(fault("a.npy", npy({1, 4, 3}, 2, numbers)),
            "a.npy: 96 bytes of data do not fit shape (2, 1, 4, 3) of dtype \"<f8\"");
  EXPECT_EQ(fault("a.npy", npy({4, 3}, 1, numbers)),
            "a.npy: shape (1, 4, 3), expected (N, K+1, 4, 3), (N, K+1, 4, 4) with weights, K up to "
            "8, or (N, 8, 3)");
  std::vector<double> infinite = numbers;
  infinite[5] = HUGE_VAL;
  EXPECT_EQ(fault("a.npy", npy({1, 4, 3}, 1, infinite)),
            "a.npy: query 0 has a coordinate that is not finite");
}

}  // namespace
}  // namespace touchstone::verify::data::curved_query_file_test
