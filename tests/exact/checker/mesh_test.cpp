#include "exact/checker/mesh.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exact/checker/checker.hpp"
#include "exact/checker/resting_mesh.hpp"
#include "exact/checker/resting_pair.hpp"
#include "tests/faults/planted_faults.hpp"
#include "tests/support/built_files.hpp"
#include "tests/support/checker_outcome.hpp"
#include "tests/support/folder_test.hpp"
#include "tests/support/rows.hpp"

// Certificates of meshes at rest: what is accepted, and that every falsehood in one is refused.

namespace touchstone::checker::mesh_test {
namespace {

using tests::altered;
using tests::refusal;
using tests::refusal_about;

/// A mesh in the words of a certificate; its lists end with /.
std::string mesh(std::string_view vertices, std::string_view faces, std::string_view edges = "",
                 std::string_view points = "", std::string_view groups = "",
                 std::string_view apart = "") {
  std::string text;
  for (const auto& [name, items] :
       {std::pair("vertices", vertices), std::pair("faces", faces), std::pair("edges", edges),
        std::pair("points", points), std::pair("groups", groups), std::pair("apart", apart)}) {
    std::string lines(items);
    std::ranges::replace(lines, '/', '\n');
    text += std::string(name) + ' ' + std::to_string(std::ranges::count(items, '/')) + '\n' + lines;
  }
  return text;
}

/// The certificate of a mesh, whose lines from the claim on end with /.
std::string certificate(const std::string& of, std::string_view lines) {
  std::string text = "mesh a label\n" + of + "claim " + std::string(lines) + "end/";
  std::ranges::replace(text, '/', '\n');
  return text;
}

std::string stream(const std::string& certificates, std::size_t count = 1) {
  return "touchstone-meshes 1\n" + certificates + "meshes " + std::to_string(count) + "\n";
}

// ---- Truths -------------------------------------------------------------------------------------

/// A mesh, what can be said of it, and what cannot.
struct Row {
  std::string name, mesh;
  std::vector<std::string_view> truths;
  /// With the reasons.
  std::vector<std::pair<std::string_view, std::string_view>> lies;
};

constexpr std::string_view apart_not = "the argument separates not",
                           no_point = "not a common point outside what is shared",
                           none = "no argument for 0 1";

const std::vector<Row>& rows() {
  static const std::vector<Row> all{
      {"a fold over an edge",
       mesh("0 0 0/2 0 0/0 2 0/1 -1 1/", "0 1 2/1 0 3/"),
       {"intersections 0/separations/0 1 plane/", "intersections 0/separations/1 0 plane/",
        "intersections 0/separations/0 1 0 1 0/", "intersections 0/separations/1 0 0 -1 0/",
        "intersections 0/separations/0 1 0 1 -1/0 1 0 1 0/"},
       {{"intersections 0/separations/", none},
        {"intersections 0/separations/0 1 0 0 1/", apart_not},
        {"intersections 0/separations/0 1 0 -1 0/", apart_not},
        {"intersections 0/separations/0 1 0x1p-1074 1 0/", "not an integer: '0x1p-1074'"},
        {"intersections 0/separations/0 1 1 1 0/", apart_not},
        {"intersections 0/separations/0 1 0 0 0/", apart_not},
        {"intersections 0/separations/0 1 line/", apart_not},
        {"intersections 1/0 1/separations/", "the two have not the same vertices"},
        {"intersections 1/0 1 1 1 0 1 1 0/separations/", no_point},
        {"intersections 1/0 1 0 0 1 0 0 1/separations/", no_point}}},
      {"neighbours in a plane",
       mesh("0 0 0/1 0 0/0 1 0/1 1 0/", "0 1 2/2 1 3/"),
       {"intersections 0/separations/1 0 1 1 0/", "intersections 0/separations/0 1 -1 -1 7/"},
       {{"intersections 0/separations/0 1 plane/", apart_not},
        {"intersections 0/separations/0 1 1 1 0/", apart_not},
        {"intersections 0/separations/1 0 10000000000 10000000001 0/", apart_not}}},
      {"faces folded onto each other",
       mesh("0 0 0/4 0 0/0 4 0/1 1 0/", "0 1 2/1 0 3/"),
       {"intersections 1/0 1 2 1 1 0 0 1/separations/"},
       {{"intersections 0/separations/", none},
        {"intersections 0/separations/0 1 plane/", apart_not},
        {"intersections 0/separations/0 1 0 1 0/", apart_not},
        {"intersections 0/separations/0 1 0 0 1/", apart_not},
        {"intersections 1/0 1 2 1 1 0 0 2 0/separations/", "the line has too many words"},
        {"intersections 1/0 1 2 1 1 0 0/separations/", "the line has too few words"},
        {"intersections 1/0 1 1 1 1 0 0 1/separations/", no_point},
        {"intersections 1/0 1 1 1 0 1 1 0/separations/", no_point},
        {"intersections 1/0 1 0 0 0 0 0 0/separations/", no_point},
        {"intersections 1/0 1 2 1 1 0 0 0/separations/", no_point},
        {"intersections 1/0 1 -2 -1 -1 0 0 -1/separations/", no_point},
        {"intersections 1/0 0 2 1 1 0 0 1/separations/", "a pair of an element and itself"},
        {"intersections 1/1 0 0 0 1 2 1 1/separations/", "the pairs are not in order"},
        {"intersections 2/0 1 2 1 1 0 0 1/0 1 2 1 1 0 0 1/separations/",
         "the pairs are not in order"},
        {"intersections 1/0 2 2 1 1 0 0 1/separations/", "not an integer, or out of range: '2'"},
        {"intersections 0/0 1 2 1 1 0 0 1/separations/", "expected 'separations', found '0'"},
        {"intersections 1/separations/", "not an integer, or out of range: 'separations'"}}},
      {"a common vertex, and nothing else",
       mesh("0 0 0/4 0 0/0 4 0/-1 0 0/0 -1 1/", "0 1 2/0 3 4/"),
       {"intersections 0/separations/0 1 1 1 0/", "intersections 0/separations/0 1 4 3 2/"},
       {{"intersections 0/separations/0 1 -1 -1 0/", apart_not},
        {"intersections 0/separations/0 1 plane/", apart_not},
        {"intersections 0/separations/1 0 plane/", apart_not},
        {"intersections 0/separations/", none}}},
      {"a common vertex, and a segment from it",
       mesh("0 0 0/4 0 0/0 4 0/2 0 0/0 0 3/", "0 1 2/0 3 4/"),
       {"intersections 1/0 1 1 1 0 0 1 0/separations/"},
       {{"intersections 0/separations/0 1 0 1 0/", apart_not},
        {"intersections 1/0 1 1 0 0 1 0 0/separations/", no_point}}},
      {"an edge through a face, near its side",
       mesh("0 0 0/4 0 0/0 4 0/1 0x1p-40 -1/1 0x1p-40 1/", "0 1 2/", "3 4/"),
       {"intersections 1/0 1 3298534883327 1099511627776 1 1 1/separations/"},
       {{"intersections 1/0 1 3298534883328 1099511627776 1 1 1/separations/", no_point}}},
      {"an edge beside a face by the least double",
       mesh("0 0 0/4 0 0/0 4 0/1 -0x1p-1074 -1/1 -0x1p-1074 1/", "0 1 2/", "3 4/"),
       {"intersections 0/separations/0 1 0 1 0/"},
       {{"intersections 0/separations/", none},
        {"intersections 0/separations/0 1 1 1 0/", apart_not}}},
      {"an edge beside a face by one bit, and planes between them, tilted by one bit and by two",
       mesh("0 0 0/1 1 0/1 0 0/0x1p-1 0x1.0000000000001p-1 -1/0x1p-1 0x1.0000000000001p-1 1/",
            "0 1 2/", "3 4/"),
       {"intersections 0/separations/0 1 1 -1 0/",
        "intersections 0/separations/0 1 9007199254740993 -9007199254740992 0/"},
       {{"intersections 0/separations/0 1 9007199254740994 -9007199254740992 0/", apart_not},
        {"intersections 0/separations/0 1 1 -1 1/", apart_not}}},
      {"the same face twice",
       mesh("0 0 0/1 0 0/0 1 0/", "0 1 2/2 0 1/"),
       {"intersections 1/0 1/separations/"},
       {{"intersections 0/separations/", none},
        {"intersections 0/separations/0 1 plane/", apart_not},
        {"intersections 0/separations/0 1 0 0 0/", apart_not}}},
      {"a face without an area on a side of another, its third vertex inside",
       mesh("0 0 0/2 0 0/0 2 0/1 0 0/", "0 1 2/0 3 1/"),
       {"intersections 0/separations/0 1 0 0 0/", "intersections 0/separations/0 1 0 1 0/"},
       {{"intersections 0/separations/", none}}},
      {"faces without an area that cross in their middle vertex",
       mesh("0 0 0/-1 0 0/1 0 0/0 -1 0/0 1 0/", "1 0 2/3 0 4/"),
       {"intersections 0/separations/0 1 line/"},
       {{"intersections 0/separations/0 1 0 0 1/", apart_not},
        {"intersections 0/separations/0 1 1 0 0/", apart_not}}},
      {"faces without an area on one line",
       mesh("0 0 0/1 0 0/2 0 0/3 0 0/", "0 1 2/1 2 3/"),
       {"intersections 0/separations/0 1 line/"},
       {}},
      {"faces without an area that overlap beyond their vertex",
       mesh("0 0 0/1 0 0/2 0 0/3 0 0/", "0 1 3/1 2 2/"),
       {"intersections 1/0 1 1 0 1 1 1 0/separations/"},
       {{"intersections 0/separations/0 1 line/", apart_not}}},
      {"a part of another, which is all shared",
       mesh("0 0 0/2 0 0/0 2 0/", "0 1 2/0 1 1/0 0 0/"),
       {"intersections 0/separations/"},
       {}},
      {"points at one place, and beside it",
       mesh("0 0 0/-0x0p+0 0 0/0 0 0x1p-1074/", "", "", "0/1/2/"),
       {"intersections 1/0 1 1 1/separations/", "welded_intersections 1/0 1/separations/"},
       {{"intersections 1/0 1/separations/", "the two have not the same vertices"},
        {"intersections 0/separations/0 1 0 0 1/", apart_not}}},
      {"a soup of two faces that touch",
       mesh("0 0 0/1 0 0/0 1 0/1 0 0/1 1 0/0 1 0/", "0 1 2/3 4 5/"),
       {"welded_intersections 0/separations/1 0 1 1 0/",
        "intersections 1/0 1 0 1 0 1 0 0/separations/"},
       {{"intersections 0/separations/1 0 1 1 0/", apart_not},
        {"welded_intersections 1/0 1 0 1 0 1 0 0/separations/", no_point}}},
      {"groups that are held apart",
       mesh("0 0 0/0 0 0/", "", "", "0/1/", "7/8/", "8 7/"),
       {"intersections 0/separations/", "welded_intersections 0/separations/"},
       {{"intersections 1/0 1 1 1/separations/", "these two cannot meet"}}},
      {"groups that are not",
       mesh("0 0 0/0 0 0/", "", "", "0/1/", "7/8/", "7 7/"),
       {"intersections 1/0 1 1 1/separations/", "welded_intersections 1/0 1 1 1/separations/"},
       {{"intersections 0/separations/", none},
        {"welded_intersections 1/0 1/separations/", "the two have not the same vertices"}}},
      {"an edge of a face, and a point of an edge, which are no elements",
       mesh("0 0 0/1 0 0/0 1 0/", "0 1 2/", "1 0/", "2/"),
       {"intersections 0/separations/"},
       {{"intersections 0/separations/0 1 plane/", "not an integer, or out of range: '1'"}}}};
  return all;
}

// A number of a mesh has one form, and its lists are as those of a step.
const std::string tent = mesh("0 0 0/2 0 0/0 2 0/1 -1 1/", "0 1 2/1 0 3/");
const std::string proved = stream(certificate(tent, "intersections 0/separations/0 1 plane/"));

/// The honest certificate altered elsewhere than in its argument.
const std::vector<std::array<std::string_view, 3>>& alterations() {
  static const std::vector<std::array<std::string_view, 3>> all{
      // Another mesh: a face dropped, turned, or with another vertex; a vertex elsewhere, by one
      // bit; a point or an edge more.
      {"faces 2\n0 1 2\n1 0 3\n", "faces 1\n0 1 2\n", "not an integer, or out of range: '1'"},
      {"1 0 3\n", "1 2 3\n", ""},
      {"1 0 3\n", "0 1 2\n", apart_not},
      {"1 -1 1\n", "1 1 0\n", apart_not},
      {"1 -1 1\n", "1 1 0x1p-1074\n", ""},
      {"1 -1 1\n", "1 -1 0\n", apart_not},
      {"1 -1 1\n", "1/2 -1 1\n", ""},
      {"1 -1 1\n", "1/3 -1 1\n", "a number that is not a double"},
      {"1 -1 1\n", "1 -1 1 1 -1 1\n", "the line has too many words"},
      {"edges 0\n", "edges 1\n2 3\n", "no argument for 0 2"},
      {"points 0\n", "points 1\n4\n", "not an integer, or out of range: '4'"},
      {"points 0\n", "points 1\n3\n", ""},
      {"groups 0\n", "groups 1\n0\n", "not a group for each vertex"},
      // Another claim; parts left out.
      {"intersections 0\n", "intersections 1\n", "not an integer, or out of range: 'separations'"},
      {"intersections 0\n", "intersections 00\n", "not an integer, or out of range: '00'"},
      {"intersections 0\n", "welded_intersections 0\n", ""},
      {"claim intersections 0\n", "claim no_contact 1\n", "unknown word: 'no_contact'"},
      {"claim intersections 0\n", "", "expected 'claim', found 'separations'"},
      {"separations\n", "", "expected 'separations', found '0'"},
      {"0 1 plane\n", "", "no argument for 0 1"},
      {"0 1 plane\n", "0 1\n", "the line has too few words"},
      {"0 1 plane\n", "0 1 plane 0\n", "the line has too many words"},
      {"0 1 plane\n", "0 1 plain\n", "not a number: 'plain'"},
      {"0 1 plane\n", "0 1 1 2\n", "the line has too few words"},
      {"0 1 plane\n", "0 2 plane\n", "not an integer, or out of range: '2'"},
      {"end\n", "", "expected 'end', found 'meshes'"},
      {"\nmeshes 1\n", "\nmeshes 2\n", "expected the closing line 'meshes 1', found 'meshes 2'"},
      {"\nmeshes 1\n", "\nsteps 1\n", "expected 'meshes', found 'steps'"},
      {"\nmeshes 1\n", "\n", "the stream is cut: it has no closing line 'meshes 1'"},
      {"touchstone-meshes 1\n", "touchstone-steps 2\n", "expected 'steps', found 'mesh'"},
      {"touchstone-meshes 1\n", "touchstone-meshes 2\n",
       "the first line is not 'touchstone-certificates 2'"},
      {"mesh a label\n", "step a label\n", "expected 'meshes', found 'step'"}};
  return all;
}

TEST(MeshCertificate, WithOneAlterationIsRefused) {
  ASSERT_EQ(refusal(proved), "");
  ASSERT_EQ(
      refusal(tests::read_file(tests::source_folder() + "/tests/exact/checker/corpus/meshes.cert")),
      "");
  for (const auto& [truth, lie, reason] : alterations()) {
    EXPECT_EQ(refusal(altered(proved, truth, lie)), reason) << lie;
  }
}

TEST(MeshCertificate, AcceptsTruthsAndRefusesLiesWithTheirReasons) {
  for (const auto& [name, of, truths, lies] : rows()) {
    for (const std::string_view truth : truths) {
      EXPECT_EQ(refusal(stream(certificate(of, truth))), "") << name << ": " << truth;
    }
    for (const auto& [lie, reason] : lies) {
      EXPECT_EQ(refusal(stream(certificate(of, lie))), reason) << name << ": " << lie;
    }
  }
}

// A checker with a fault refuses a truth or accepts a lie: these tests would see it.
TEST(MeshCertificate, PlantedFaultsAreFound) {
  for (const auto& fault : tests::planted_faults().mesh_checker) {
    const auto accepts = [&](const std::string& of, std::string_view lines) {
      std::istringstream in(stream(certificate(of, lines)));
      return fault.part(in, {}).all_accepted();
    };
    EXPECT_TRUE(std::ranges::any_of(rows(), [&](const Row& row) {
      return std::ranges::any_of(row.truths,
                                 [&](auto lines) { return !accepts(row.mesh, lines); }) ||
             std::ranges::any_of(row.lies, [&](auto lie) { return accepts(row.mesh, lie.first); });
    })) << fault.name;
  }
}

TEST(MeshCertificate, IsHeldAgainstAMesh) {
  EXPECT_EQ(refusal_about(tent, proved), "");
  EXPECT_EQ(refusal_about(altered(tent, "1 -1 1", "0x1p0 -1 3/3"), proved), "");
  EXPECT_EQ(refusal_about(altered(tent, "1 -1 1", "0x1.0000000000001p+0 -1 1"), proved),
            "the scene is not the one given");
  EXPECT_EQ(refusal_about(altered(tent, "1 0 3", "0 3 1"), proved),
            "the scene is not the one given");
  EXPECT_EQ(refusal_about(tent + tent, proved), "not all scenes are proved");
}

TEST(MeshCertificate, ProvesWhatIsDemandedAndNothingElse) {
  const auto with = [](const std::string& claim, const std::string& of) {
    return refusal(of,
                   {.claim = demanded_claim(claim), .separation = demanded_separation("0", "l2")});
  };
  const std::string other = "the claim is not the one demanded: ",
                    welded = altered(proved, "intersections", "welded_intersections"),
                    one = stream(certificate(mesh("0 0 0/0 0 0/", "", "", "0/1/"),
                                             "intersections 1/0 1 1 1/separations/"));
  for (const char* const claim :
       {"free", "intersections", "intersections 0", "intersections 0x0p0"}) {
    EXPECT_EQ(with(claim, proved), "") << claim;
    const bool is_free = claim == std::string_view("free");
    EXPECT_EQ(
        with(claim, welded),
        other + "welded_intersections 0" +
            (is_free ? "; --claim 'welded_intersections 0' counts vertices at one place as one"
                     : ""));
  }
  EXPECT_EQ(with("welded_intersections", welded), "");
  EXPECT_EQ(with("intersections", one), "");
  for (const char* const claim : {"free", "intersections 0", "intersections 2", "no_contact 1"}) {
    EXPECT_EQ(with(claim, one), other + "intersections 1") << claim;
  }
  EXPECT_EQ(refusal(proved, {.separation = demanded_separation("1e-3", "l2")}),
            "the separation is not the one demanded: 0");
  EXPECT_EQ(with("free", "touchstone-meshes 1\nmeshes 0\n"),
            "there is no certificate of what is demanded");
}

// As of steps: what is left out stands in the report, and `free` demands that it is named.
TEST(MeshCertificate, NamesWhatItsClaimLeavesOut) {
  const std::string free = "intersections 0/separations/", one = "1 mesh: no two elements ",
                    can = one + "that can meet intersect; ", triangle = "0 0 0/1 0 0/0 1 0/";
  struct LeftOut {
    std::string mesh, size, rules, sentence;
  };
  for (const auto& [of, size, rules, sentence] : std::vector<LeftOut>{
           {mesh(triangle, "0 1 2/"), "3", "", one + "intersect"},
           {mesh(triangle + "5 5 5/6 6 6/", "0 1 2/"), "3 of 5", "2 vertices left out", can},
           {mesh(triangle, "0 1 2/", "", "", "", "0 0/"), "3", "1 group held apart from itself",
            can}}) {
    const std::string text = stream(certificate(of, free));
    const Report report = tests::check_text(text);
    EXPECT_EQ(report.summary, sentence + rules);
    EXPECT_EQ(report.meshes.at(0),
              "mesh a label\n" + size + " vertices, 1 faces, 0 edges of no face, 0 points\n" +
                  (rules.empty() ? "" : "rules " + rules + '\n') + "claim intersections 0\n");
    EXPECT_EQ(refusal(text, {.claim = "free"}),
              rules.empty() ? "" : "the rules are not those demanded: " + rules);
    EXPECT_EQ(refusal(text, {.claim = "free", .rules = rules}), "");
    EXPECT_EQ(refusal(text, {.claim = "sequence"}),
              "the claim is not the one demanded: intersections 0");
  }
  const std::string some = certificate(mesh(triangle, "0 1 2/"), free);
  EXPECT_EQ(tests::check_text(stream(some + some, 2)).summary,
            "2 meshes: no two elements intersect");
  EXPECT_EQ(tests::check_text(altered(proved, "intersections", "welded_intersections")).summary,
            "");
}

TEST(MeshCertificate, LimitsItemsArgumentsAndComparisons) {
  const std::string many = "more than 0 arguments",
                    items = "more than 5 items in the lists of a scene",
                    compares = "the search for pairs takes too many comparisons";
  for (const auto& [limits, reason] :
       {std::pair(Options{.max_arguments = 1}, std::string()),
        std::pair(Options{.max_arguments = 0}, many),
        std::pair(Options{.max_items = 6}, std::string()),
        std::pair(Options{.max_items = 5}, items),
        std::pair(Options{.max_comparisons_per_byte = 1}, std::string()),
        std::pair(Options{.max_comparisons_per_byte = 0}, compares)}) {
    EXPECT_EQ(refusal(proved, limits), reason);
  }
}

}  // namespace
}  // namespace touchstone::checker::mesh_test
