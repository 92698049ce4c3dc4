#include "verify/data/ground_truth_files.hpp"

#include <gtest/gtest.h>

#include <random>
#include <stdexcept>
#include <string>

#include "tests/verify/data/dataset_fixture.hpp"

namespace touchstone::verify::data::toi_writer_test {
namespace {

using exact::Integer;
using exact::Rational;
using test::contents;
using test::TemporaryFolder;

Rational ratio(const Integer& numerator, const Integer& denominator) {
  Rational value(numerator, denominator);
  value.canonicalize();
  return value;
}

TEST(ToDecimal, WritesAllDigitsOfDyadicNumbers) {
  EXPECT_EQ(to_decimal(0), "0");
  EXPECT_EQ(to_decimal(1), "1E0");
  EXPECT_EQ(to_decimal(100), "1E2");
  EXPECT_EQ(to_decimal(ratio(1, 4)), "2.5E-1");
  EXPECT_EQ(to_decimal(ratio(-3, 1024)), "-2.9296875E-3");
  EXPECT_EQ(to_decimal(Rational(0.1)),
            "1.000000000000000055511151231257827021181583404541015625E-1");
  std::mt19937_64 random(3);
  for (int i = 0; i < 500; ++i) {
    const Rational value = Rational(Integer(static_cast<long>(random()))) *
                           exact::power_of_two(-static_cast<long>(random() % 1100));
    EXPECT_EQ(exact::rational_from_decimal(to_decimal(value)), value);
  }
}

TEST(ToDecimal, RoundsOtherNumbersToTheNearestOf60Digits) {
  EXPECT_EQ(to_decimal(ratio(1, 3)), "3." + std::string(59, '3') + "E-1");
  EXPECT_EQ(to_decimal(ratio(2, 3)), "6." + std::string(58, '6') + "7E-1");
  EXPECT_EQ(to_decimal(ratio(-200, 3)), "-6." + std::string(58, '6') + "7E1");
  EXPECT_EQ(to_decimal(ratio(1, 5)), "2E-1");
  const Integer nines("3" + std::string(70, '0'), 10);
  EXPECT_EQ(to_decimal(ratio(nines - 1, nines)), "1E0") << "carries into a new digit";
  EXPECT_EQ(to_decimal(ratio(nines + 1, 3)), "1E70");
}

TEST(ToDecimal, IsWithinHalfAUnitOfTheLastDigit) {
  std::mt19937_64 random(4);
  for (int i = 0; i < 2000; ++i) {
    const Integer n = Integer(static_cast<unsigned long>(random())) + 1;
    const Integer d = 3 * Integer(static_cast<unsigned long>(random() >> (random() % 60))) + 3;
    const Rational value = ratio(n, d);
    const Rational relative = abs(exact::rational_from_decimal(to_decimal(value)) - value) / value;
    EXPECT_LE(relative, exact::rational_from_decimal("5E-60")) << value;
  }
}

TEST(ToiWriter, RefusesQueriesOutOfOrder) {
  const TemporaryFolder folder;
  ToiWriter writer(folder.path() / "a_toi.csv");
  writer.write(4, 1);
  EXPECT_THROW(writer.write(4, 1), std::invalid_argument);
  EXPECT_THROW(writer.write(3, 1), std::invalid_argument);
  writer.write(5, 1);
  writer.close();
  EXPECT_EQ(contents(folder.path() / "a_toi.csv"), "query,toi\n4,1E0\n5,1E0\n");
}

}  // namespace
}  // namespace touchstone::verify::data::toi_writer_test
