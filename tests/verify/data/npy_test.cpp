#include "verify/data/npy.hpp"

#include <gtest/gtest.h>

#include <cstdint>
#include <string>
#include <vector>

#include "tests/support/npz_files.hpp"
#include "tests/verify/data/dataset_fixture.hpp"

namespace touchstone::verify::data::npy_test {
namespace {

using test::contents;
using test::error_of;
using test::numbered_query;
using test::TemporaryFolder;

constexpr const char* good_dictionary =
    "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 8, 3), }";

/// The magic, version, length and dictionary, padded so that the data begins at a multiple of
/// `align`.
std::string header(const std::string& dictionary, char version = 1, std::size_t align = 64) {
  const std::size_t prefix = version == 1 ? 10 : 12;
  const std::size_t total = (prefix + dictionary.size() + 1 + align - 1) / align * align;
  const std::size_t length = total - prefix;
  std::string text = "\x93NUMPY";
  text += version;
  text += '\0';
  text += static_cast<char>(length % 256);
  text += static_cast<char>(length / 256);
  if (version != 1) text += std::string(2, '\0');
  text += dictionary;
  text.resize(total - 1, ' ');
  return text + "\n";
}

std::string bytes_of(const std::vector<Query>& queries) {
  std::string bytes(queries.size() * sizeof(Query), '\0');
  std::memcpy(bytes.data(), queries.data(), bytes.size());
  return bytes;
}

std::vector<Query> two_queries() { return {numbered_query(0), numbered_query(1)}; }

std::string open_error(const std::string& file) {
  const TemporaryFolder folder;
  const auto path = folder.file("a.npy", file);
  return error_of(folder.path(), [&] { NpyArray npy(path); });
}

std::string header_error(const std::string& dictionary) {
  return open_error(header(dictionary) + bytes_of(two_queries()));
}

void expect_two_queries(const std::string& file) {
  const TemporaryFolder folder;
  NpyArray array(folder.file("a.npy", file));
  std::vector<Query> queries(array.shape()[0]);
  for (Query& query : queries) array.take_numbers(query.coordinates);
  EXPECT_EQ(queries, two_queries());
}

TEST(NpyArray, ReadsVersions1To3AndHeadersThatOthersWrite) {
  const std::string data = bytes_of(two_queries());
  for (const char version : {'\1', '\2', '\3'}) {
    expect_two_queries(header(good_dictionary, version) + data);
  }
  for (const std::string dictionary :
       {R"({"shape":(2,8,3),"fortran_order":False,"descr":"<f8"})",
        " { 'fortran_order' : False , 'descr' : '<f8' , 'shape' : ( 2 , 8 , 3 , ) } "}) {
    expect_two_queries(header(dictionary) + data);
  }
  expect_two_queries(header(good_dictionary, 1, 8) + data);
  expect_two_queries(header(good_dictionary, 1, 77) + data);
  expect_two_queries(header(good_dictionary + std::string(60000, ' '), 2) + data);
}

TEST(NpyArray, NamesUnknownVersionsAndTruncatedHeaders) {
  EXPECT_EQ(open_error(header(good_dictionary, 4)),
            "a.npy: version 4 of the NumPy format, expected 1, 2 or 3");
  EXPECT_EQ(open_error(header(good_dictionary, 0)),
            "a.npy: version 0 of the NumPy format, expected 1, 2 or 3");
  EXPECT_EQ(open_error("1,1,1,1,1,1\n"), "a.npy: not a NumPy file");
  const std::string whole = header(good_dictionary, 2);
  for (std::size_t size = 0; size < whole.size(); ++size) {
    EXPECT_EQ(open_error(whole.substr(0, size)),
              size < 10 ? "a.npy: not a NumPy file" : "a.npy: truncated header")
        << size;
  }
}

TEST(NpyArray, NamesEveryOtherKindOfNumber) {
  for (const std::string dtype : {">f8", "=f8", "|f8", "<i8", "<f16", "f8", "float64", ""}) {
    const TemporaryFolder folder;
    NpyArray array(folder.file(
        "a.npy", header("{'descr': '" + dtype + "', 'fortran_order': False, 'shape': (0, 3), }")));
    EXPECT_EQ(error_of(folder.path(), [&] { array.take_numbers({}); }),
              "a.npy: dtype \"" + dtype + "\", expected <f4 or <f8");
  }
  EXPECT_EQ(header_error("{'descr': [('x', '<f8')], 'fortran_order': False, 'shape': (2, 8, 3), }"),
            "a.npy: the array has named fields, expected numbers");
}

TEST(NpyArray, NamesHeadersThatAreNoDictionaryOfTheseThree) {
  for (const std::string dictionary :
       {"", "{", "[]", "{'descr': '<f8'", "{'descr'; '<f8'}", "{descr: '<f8'}",
        "{'descr': '<f8, 'fortran_order': False, 'shape': (2, 8, 3), }",
        "{'descr': '<f8', 'fortran_order': 0, 'shape': (2, 8, 3), }",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 8, x), }",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (-2, 8, 3), }",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (99999999999999999999, 8, 3), }",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (2 8 3), }",
        "{'descr': '<f8', 'fortran_order': False, 'shape': (2, 8, 3), } x",
        "{'descr': '<f8' 'fortran_order': False, 'shape': (2, 8, 3)}"}) {
    EXPECT_EQ(header_error(dictionary), "a.npy: malformed header") << dictionary;
  }
  for (const char* const dictionary :
       {"{'descr': '<f8', 'fortran_order': False}", "{'descr': '<f8', 'descr': '<f8'}",
        "{'version': 1}", "{'descr': '<f8', 'fortran_order': False, 'shape': (), 'version': 1}"}) {
    EXPECT_EQ(header_error(dictionary),
              "a.npy: the header must have descr, fortran_order and shape, and nothing else");
  }
}

TEST(NpyArray, NamesDataOfAnotherSize) {
  const std::string data = bytes_of(two_queries());
  const auto size_error = [](std::size_t bytes, const std::string& count) {
    return "a.npy: " + std::to_string(bytes) + " bytes of data do not fit shape (" + count +
           ", 8, 3) of dtype \"<f8\"";
  };
  EXPECT_EQ(open_error(header(good_dictionary)), size_error(0, "2"));
  EXPECT_EQ(open_error(header(good_dictionary) + data.substr(1)), size_error(383, "2"));
  EXPECT_EQ(open_error(header(good_dictionary) + data.substr(192)), size_error(192, "2"));
  EXPECT_EQ(open_error(header(good_dictionary) + data + "x"), size_error(385, "2"));
  // 2 + 2^61 times 192 is 384 again in 64 bits.
  const std::string overflowing = "2305843009213693954";
  EXPECT_EQ(header_error("{'descr': '<f8', 'fortran_order': False, 'shape': (" + overflowing +
                         ", 8, 3), }"),
            size_error(384, overflowing));
}

TEST(NpyArray, BoundsTheHeader) {
  std::string length{"\0\0\x10\0", 4};
  const std::string begin = std::string("\x93NUMPY\2\0", 8), room(std::size_t{1} << 21U, ' ');
  EXPECT_EQ(open_error(begin + length + room), "a.npy: malformed header");
  length[0] = '\1';
  EXPECT_EQ(open_error(begin + length + room), "a.npy: header longer than 1 MiB");
}

TEST(NpyWriter, WritesAHeaderThatNumpyReads) {
  const TemporaryFolder folder;
  NpyWriter writer(folder.path() / "a.npy");
  for (const Query& query : two_queries()) writer.write(query);
  writer.close();
  std::string expected = std::string("\x93NUMPY\x01\x00\x76\x00", 10) + good_dictionary;
  expected.resize(127, ' ');
  EXPECT_EQ(contents(folder.path() / "a.npy"), expected + "\n" + bytes_of(two_queries()));
}

TEST(Npz, GivesItsArraysByName) {
  const TemporaryFolder folder;
  const auto path = tests::archive(
      folder.path() / "a.npz", {{"x.npy", tests::array<double>("<f8", {3, 1}, {1.0, -2.0, 0.5})}});
  const Npz archive(path);
  EXPECT_TRUE(archive.has("x"));
  EXPECT_FALSE(archive.has("y"));
  EXPECT_EQ(archive.names(), std::vector<std::string>{"x"});
  NpyArray array(archive, "x");
  EXPECT_EQ(array.shape(), (std::vector<std::uint64_t>{3, 1}));
  std::vector<double> numbers(2);
  array.take_numbers(numbers);
  EXPECT_EQ(numbers, (std::vector<double>{1.0, -2.0}));
  EXPECT_EQ(error_of(folder.path(), [&] { array.take<double, float>(numbers, {"<f4"}); }),
            "a.npz: x: dtype \"<f8\", expected <f4");
  EXPECT_EQ(error_of(folder.path(), [&] { (void)NpyArray(archive, "y"); }),
            "a.npz: y: no such array; the archive has: x");
}

}  // namespace
}  // namespace touchstone::verify::data::npy_test
