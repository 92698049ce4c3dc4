#include "exact/checker/step.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exact/checker/checker.hpp"
#include "exact/checker/summary.hpp"
#include "tests/faults/planted_faults.hpp"
#include "tests/support/built_files.hpp"
#include "tests/support/checker_outcome.hpp"
#include "tests/support/folder_test.hpp"
#include "tests/support/rows.hpp"

// Certificates of steps: what is accepted, and that every falsehood in one is refused.

namespace touchstone::checker::step_test {
namespace {

using tests::altered;
using tests::check_text;
using tests::refusal;
using tests::refusal_about;

/// A triangle that falls towards another, tilted one, and stays above it.
const std::string scene =
    "vertices 6\n0 0 0 0 0 0\n4 0 4 4 0 4\n0 4 0 0 4 0\n1 1 2 1 1 0x1.8p+0\n2 1 3 2 1 "
    "0x1.4p+1\n1 2 2 1 2 0x1.8p+0\nfaces 2\n0 1 2\n3 4 5\nedges 0\npoints 0\ngroups 0\napart "
    "0\nradii 0\nseparations 0\n";
const std::string arguments =
    "sweep x\nvertex_face\n3 0 -1 0 1\n4 0\nseparate 0 1 face +\n5 0 -1 0 1\nedge_edge\n2 3 1 0 "
    "-1\n2 4 1 0 -1\n2 5 1 0 -1\nvertex_edge\nvertex_vertex\nend\n";

const std::string no_arguments =
    "sweep x\nvertex_face\nedge_edge\nvertex_edge\nvertex_vertex\nend\n";

std::string stream(const std::string& steps, std::size_t count = 1) {
  return "touchstone-steps 2\n" + steps + "steps " + std::to_string(count) + "\n";
}

std::string step(const std::string& of = scene, const std::string& rest = arguments) {
  return "step a label\n" + of + "separation 0 linf\nclaim no_contact 1\n" + rest;
}

/// A vertex that falls along the x axis, from 1, to the side of a face that touches the plane x = 0
/// from below.
std::string of_falling_vertex(std::string_view x_at_end, std::string_view argument) {
  return stream("step falling\nvertices 4\n0 -1 0 0 -1 0\n0 1 0 0 1 0\n-1 0 1 -1 0 1\n1 0 0 " +
                std::string(x_at_end) +
                " 0 0\nfaces 1\n0 1 2\nedges 0\npoints 1\n3\ngroups 0\napart 0\nradii "
                "0\nseparations 0\nseparation 0 "
                "linf\nclaim no_contact 1\nsweep x\nvertex_face\n" +
                std::string(argument) + "edge_edge\nvertex_edge\nvertex_vertex\nend\n");
}

/// What is altered in an honest certificate, and why the checker then refuses it; empty if not.
struct Alteration {
  std::string_view truth, other, reason;
};

const std::vector<Alteration>& of_triangles() {
  static const std::string_view apart_not = "the direction separates not",
                                off_range = "not an integer, or out of range: ",
                                no_double = "a number that is not a double";
  static const std::vector<Alteration> all{
      // A direction that separates not, or only at one end.
      {"3 0 -1 0 1", "3 0 1 0 -1", apart_not},
      {"3 0 -1 0 1", "3 0 0 0 1", apart_not},
      {"3 0 -1 0 1", "3 0 0 0 0", apart_not},
      {"separate 0 1 face +", "separate 0 1 face -", "a polynomial is not positive at a point"},
      {"separate 0 1 face +", "separate 0 1/2 face +",
       "the last subinterval does not end where it should"},
      {"separate 0 1 face +", "separate 1/2 1 face +",
       "the subinterval does not begin where it should"},
      // A vertex that moves elsewhere, so that it is where no box of the honest one was.
      {"1 1 2 1 1 0x1.8p+0", "1 1 2 1 1 0", apart_not},
      {"1 1 2 1 1 0x1.8p+0", "1 1 0 1 1 0x1.8p+0", apart_not},
      // Two vertices of different triangles exchanged.
      {"0 0 0 0 0 0\n4 0 4 4 0 4\n0 4 0 0 4 0\n1 1 2 1 1 0x1.8p+0\n",
       "1 1 2 1 1 0x1.8p+0\n4 0 4 4 0 4\n0 4 0 0 4 0\n0 0 0 0 0 0\n", apart_not},
      // Another mesh.
      {"faces 2\n0 1 2\n3 4 5", "faces 1\n0 1 2", "there is no such element"},
      {"faces 2\n0 1 2\n3 4 5", "faces 2\n0 1 5\n3 4 2", apart_not},
      {"edges 0", "edges 1\n1 4", apart_not},
      {"points 0", "points 1\n6", off_range},
      {"groups 0", "groups 1\n0", "not a group for each vertex"},
      // A separation that is not kept; a claim that is none.
      {"separation 0 linf", "separation 1 linf", apart_not},
      {"separation 0 linf", "separation 1 l2", apart_not},
      {"separation 0 linf", "separation -1 linf", "a distance below 0"},
      {"separation 0 linf", "separation 1/3 linf", no_double},
      {"claim no_contact 1", "claim no_contact 2", "a time is from 0 to 1"},
      {"claim no_contact 1", "claim no_contact -1", "a time is from 0 to 1"},
      {"claim no_contact 1", "claim no_contact", "the line has too few words"},
      {"claim no_contact 1", "claim earliest 1/2 1", "expected 'pair', found 'sweep'"},
      {"claim no_contact 1", "claim earliest 1 1", "a time of impact is 0 0, or LO HI"},
      // Numbers out of range.
      {"3 4 5", "3 4 6", off_range},
      {"3 4 5", "3 4 -1", off_range},
      {"2 3 1 0 -1", "2 6 1 0 -1", "there is no such element"},
      {"2 3 1 0 -1", "2 3 1024 0 -1", off_range},
      {"2 3 1 0 -1", "2 3 1 0", "the line has too few words"},
      {"2 3 1 0 -1", "2 3 1 0 -1 0", "the line has too many words"},
      {"vertices 6", "vertices 7", "not a number: 'faces'"},
      {"vertices 6", "vertices 99999999999", off_range},
      {"faces 2", "faces 4194299", "more than 4194304 items in the lists of a scene"},
      {"vertices 6", "vertices 4194304", "not a number: 'faces'"},
      {"0x1.4p+1", "1/3", no_double},
      {"0x1.4p+1", "0x1p+2000", no_double},
      // A pair without an argument.
      {"3 0 -1 0 1\n", "", "no argument for vertex_face 3 0"},
      {"4 0\nseparate 0 1 face +\n", "", "no argument for vertex_face 4 0"},
      {"2 3 1 0 -1\n", "", "no argument for edge_edge 2 3"},
      {"2 4 1 0 -1\n", "", "no argument for edge_edge 2 4"},
      // Integers have one form.
      {"\n0 1 2\n", "\n00 1 2\n", off_range},
      {"\n0 1 2\n", "\n-0 1 2\n", off_range},
      {"\nvertices 6\n", "\nvertices 06\n", off_range},
      {"no_contact 1\n", "no_contact 01\n", "an integer with leading zeros: '01'"},
      {"no_contact 1\n", "no_contact 01/1\n", "an integer with leading zeros: '01/1'"},
      {"separation 0 ", "separation -0 ", "a zero with a sign: '-0'"},
      // An argument more than needed.
      {"2 4 1 0 -1\n", "2 4 1 0 -1\n0 3 0 -1 0\n", ""},
      {"\nsteps 1", "\nsteps 2", "expected the closing line 'steps 1', found 'steps 2'"}};
  return all;
}

/// Two spheres of radii 1 and 2, whose centres come 4.33 near. On each axis they are 2.5 apart.
const std::string spheres =
    "step spheres\nvertices 2\n0 0 0 0 0 0\n3 3 3 0x1.4p+1 0x1.4p+1 0x1.4p+1\nfaces 0\nedges "
    "0\npoints 2\n0\n1\ngroups 2\n1\n0\napart 0\nradii 2\n2\n1\nseparations 0\nseparation 0 "
    "l2\nclaim no_contact 1\nsweep x\nvertex_face\nedge_edge\nvertex_edge\nvertex_vertex\n0 "
    "1\nseparate 0 1 vertex 0\nend\n";

/// Others that are true of the spheres, and some that are not.
const std::vector<Alteration>& of_spheres() {
  static const std::string_view too_near = "a polynomial is not positive";
  static const std::vector<Alteration> all{
      {"radii 2\n2\n1", "radii 2\n2\n0x1.27p+1", ""},
      {"radii 2\n2\n1", "radii 2\n2\n0x1.3p+1", too_near},
      {"radii 2\n2\n1", "radii 1\n2", "not a radius for each group"},
      {"radii 2\n2\n1", "radii 2\n2\n-1", "a distance below 0"},
      {"radii 2\n2\n1", "radii 2\n2\n1/3", "a number that is not a double"},
      {"radii 2\n2\n1", "radii 2\n2\n0x1p+1023", "the distances are too large"},
      {"separation 0 l2", "separation 0x1.5p+0 l2", ""},
      {"separation 0 l2", "separation 0x1.6p+0 l2", too_near},
      {"separations 0", "separations 1\n1 0 0x1.15p+2", ""},
      {"separations 0", "separations 1\n0 1 0x1.16p+2", too_near},
      {"separations 0", "separations 1\n1 1 9", ""},
      {"separations 0", "separations 2\n1 0 1\n0 1 1", "two groups are listed twice"},
      {"separations 0", "separations 1\n1 0 -1", "a distance below 0"},
      {"0 1\nseparate 0 1 vertex 0\n", "0 1 -1 -1 -1\n", "the direction separates not"},
      {"0 1\nseparate 0 1 vertex 0\n", "", "no argument for vertex_vertex 0 1"}};
  return all;
}

/// A tetrahedron whose volume is 1 - t/2, and a triangle in the plane whose area is that of
/// (1-3t)² + 2^-258, which needs three subintervals.
const std::string cells =
    "step cells\nvertices 7\n0 0 0 0 0 0\n1 0 0 1 0 0\n0 1 0 0 1 0\n0 0 1 0 0 1/2\n"
    "0 0 7 0 0 -9\n1 0x1p-129 0 -2 0x1p-129 3\n-0x1p-129 1 2 -0x1p-129 -2 0\nfaces 0\nedges "
    "0\npoints 0\ngroups 0\napart 0\nradii 0\nseparations 0\ntetrahedra 1\n0 1 2 3\n"
    "plane_triangles 1\n4 5 6\nseparation 0 l2\nclaim no_contact 1\n" +
    no_arguments.substr(0, no_arguments.size() - 4) +
    "tetrahedron\nplane_triangle\n0\nseparate 0 1/4 face -\nseparate 1/4 3/8 face -\n"
    "separate 3/8 1 face -\nend\n";

/// Others that are true of the cells, and some that are not.
const std::vector<Alteration>& of_cells() {
  static const std::string_view flat = "tetrahedron 0: a polynomial is not positive at a point",
                                proof =
                                    "0\nseparate 0 1/4 face -\nseparate 1/4 3/8 face -\n"
                                    "separate 3/8 1 face -\n",
                                claim = "no_contact 1\nsweep", range = "not an integer, or out";
  static const std::vector<Alteration> all{
      {"0 0 1 0 0 1/2", "0 0 1 0 0 0x1p-1074", ""},
      {"0 0 1 0 0 1/2", "0 0 1 0 0 0", flat},
      {"0 0 1 0 0 1/2", "0 0 0 0 0 1/2", flat},
      {"0 0 1 0 0 1/2", "0 0 -1 0 0 -1/2", flat},
      {"\n0 1 2 3\n", "\n0 2 1 3\n", flat},
      {"\n0 1 2 3\n", "\n1 2 0 3\n", ""},
      {"\n0 1 2 3\n", "\n0 1 2 7\n", range},
      {"\n0 1 2 3\n", "\n0 1 2\n", "the line has too few words"},
      {"\n4 5 6\n", "\n4 6 5\n", "plane_triangle 0: a polynomial is not positive at a point"},
      {"\n4 5 6\n", "\n4 5 5\n", "plane_triangle 0: a polynomial is not positive at a point"},
      {"tetrahedra 1\n0 1 2 3\n", "tetrahedra 0\n", "expected 'plane_triangle', found 'tetra"},
      {"tetrahedra 1\n0 1 2 3\n", "tetrahedra 2\n0 1 2 3\n3 1 2 0\n", "tetrahedron 1: a polyn"},
      {proof, "", "plane_triangle 0: a polynomial is not seen to be positive"},
      {proof, "0\n", "plane_triangle 0: there is no subinterval"},
      {"separate 3/8 1 face -\n", "", "plane_triangle 0: the last subinterval does not end"},
      {"tetrahedron\nplane", "tetrahedron\n0\nseparate 0 1 face -\nplane", ""},
      {"tetrahedron\nplane", "tetrahedron\n0\nseparate 0 1/2 face -\nplane",
       "tetrahedron 0: the l"},
      {"tetrahedron\nplane", "tetrahedron\n1\nplane", "expected 'plane_triangle', found '1'"},
      {"tetrahedron\nplane", "plane", "expected 'tetrahedron', found 'plane_triangle'"},
      // A claim up to a time that a cell does not reach, and one that it does.
      {"0 0 1 0 0 1/2", "0 0 1 0 0 -1", flat},
      {claim, "earliest 0 0\nelement tetrahedron 0\ncontact time 0\nat plane\nend\nsweep",
       "the volume is positive"},
      {claim, "earliest 0 0\nelement tetrahedron 1\ncontact time 0\nat plane\nend\nsweep", range},
      {claim, "earliest 0 0\nelement edge 0\ncontact time 0\nat plane\nend\nsweep",
       "unknown word: 'edge'"},
      {claim, "earliest 0 0\nelement plane_triangle 0\ncontact time 1/3\nat plane\nend\nsweep",
       "the contact is not in the interval of the claim"}};
  return all;
}

/// The first time at which the volume of the tetrahedron is 0, before the triangle is nearly flat.
std::string of_first_inversion() {
  return stream(
      altered(altered(altered(cells, "0 0 1 0 0 1/2", "0 0 1 0 0 -4"), "no_contact 1\n",
                      "earliest 1/8 1/5\nelement tetrahedron 0\ncontact time 1/5\nat plane\n"),
              "0\nseparate 0 1/4 face -\nseparate 1/4 3/8 face -\nseparate 3/8 1 face -\n", ""));
}

/// Three steps.
std::string corpus() {
  return tests::read_file(tests::source_folder() + "/tests/exact/checker/corpus/steps.cert");
}

/// The second of them: the earliest contact, at 1/2.
std::string earliest() {
  const std::string text = corpus();
  const std::size_t first = text.find("step and"), last = text.find("step at once");
  return stream(text.substr(first, last - first));
}

const std::vector<Alteration>& of_earliest() {
  static const std::string_view claim = "claim earliest 0x1.fffffffffffffp-2 1/2",
                                pair = "pair vertex_face 3 0", no_pair = "these two cannot collide",
                                outside = "the contact is not in the interval of the claim";
  static const std::vector<Alteration> all{
      // A little later, a little earlier, at one time, and from the start.
      {claim, "claim earliest 1/2 0x1.0000000000001p-1", "the last subinterval does not end"},
      {claim, "claim earliest 0x1.ffffffffffffep-2 0x1.fffffffffffffp-2", outside},
      {claim, "claim earliest 0x1.fffffffffffffp-2 0x1.fffffffffffffp-2", "a time of impact is"},
      {claim, "claim earliest 0 0", outside},
      // These two have a vertex in common, those are held apart: no contacts of the step.
      {pair, "pair vertex_face 3 1", no_pair},
      {"pair vertex_face 3 0\ncontact time 1/2\nat triangle 0 1 2 z",
       "pair vertex_edge 8 6\ncontact time 1/2\nat vertex 0", no_pair},
      {pair, "pair vertex_face 0 0", no_pair},
      {"contact time 1/2", "contact time 1", outside},
      {"at triangle 0 1 2 z", "at segment 0 1", "the origin is not on the segment's line"},
      // Where the groups meet, a point and an edge touch all the time.
      {"apart 1\n0 2", "apart 0", "no argument for vertex_edge 8 6"}};
  return all;
}

/// Honest certificates with what is altered in them.
std::vector<std::pair<std::string, std::vector<Alteration>>> tables() {
  static constexpr std::string_view not_apart = "the direction separates not";
  return {
      {stream(step()), of_triangles()},
      {stream(spheres), of_spheres()},
      {stream(cells), of_cells()},
      {of_first_inversion(),
       {{"contact time 1/5", "contact time 1/6", "the volume is positive"},
        {"earliest 1/8 1/5", "earliest 1/5 1/4", "tetrahedron 0: a polynomial is not positive"}}},
      {of_falling_vertex("1", "3 0 1 0 0\n"),
       {{"1 0 0 1 0 0", "1 0 0 0 0 0", not_apart}, {"1 0 0 1 0 0", "1 0 0 -1 0 0", not_apart}}},
      // An axis keeps it apart.
      {of_falling_vertex("0x1p-40", ""),
       {{"0x1p-40", "0", "no argument for vertex_face 3 0"},
        {"0x1p-40", "-1", "no argument for vertex_face 3 0"}}},
      {corpus(), {}},
      {earliest(), of_earliest()}};
}

TEST(Step, SaysWhatItProves) {
  const Report report = check_text(stream(step()));
  ASSERT_EQ(report.steps.size(), 1U);
  EXPECT_EQ(report.steps[0],
            "step a label\n6 vertices, 6 edges, 2 faces\nseparation 0\nclaim no_contact 1\n");
  EXPECT_EQ(report.accepted(), 1U);
  const Report of_inversion = check_text(of_first_inversion());
  ASSERT_EQ(of_inversion.steps.size(), 1U);
  EXPECT_EQ(of_inversion.steps[0],
            "step cells\n0 of 7 vertices, 0 edges, 0 faces\n1 tetrahedra, 1 plane "
            "triangles\nrules 7 vertices left out\nseparation 0\nclaim earliest 1/8 1/5\nelement "
            "tetrahedron 0\n");
  EXPECT_EQ(check_text(corpus()).steps.size(), 3U);
}

TEST(Step, RefusesEveryFalsehoodWithItsReason) {
  for (const auto& [text, alterations] : tables()) {
    ASSERT_EQ(refusal(text), "");
    for (const auto& [truth, other, reason] : alterations) {
      const std::string found = refusal(altered(text, truth, other));
      EXPECT_TRUE(reason.empty() ? found.empty() : found.starts_with(reason))
          << other << ": " << found;
    }
  }
}

// A checker with a fault accepts what is false: these tests would see it.
TEST(Step, PlantedFaultsAreFound) {
  for (const auto& fault : tests::planted_faults().checker) {
    const auto accepts = [&](const std::string& text) {
      std::istringstream in(text);
      return fault.part(in, {}).all_accepted();
    };
    EXPECT_TRUE(accepts(stream(step()))) << fault.name;
    bool is_found = false;
    for (const auto& [text, alterations] : tables()) {
      for (const auto& [truth, lie, reason] : alterations) {
        is_found = is_found || (!reason.empty() && accepts(altered(text, truth, lie)));
      }
    }
    EXPECT_TRUE(is_found) << fault.name;
  }
}

TEST(Step, HoldsGroupsApart) {
  const std::string groups = "groups 6\n4\n4\n4\n7\n7\n7\napart 1\n7 4\n";
  const std::string apart = altered(scene, "groups 0\napart 0\n", groups);
  EXPECT_EQ(refusal(stream(step(scene, no_arguments))), "no argument for vertex_face 3 0");
  EXPECT_EQ(refusal(stream(step(apart, no_arguments))), "");
  EXPECT_NE(refusal(stream(step(altered(apart, "7 4\n", "7 7\n"), no_arguments))), "");
}

// Whoever has the scene can tell that the certificate is about another.
TEST(Step, IsHeldAgainstAScene) {
  const std::string text = stream(step() + step(), 2), twice = scene + scene;
  EXPECT_EQ(refusal_about(twice, text), "");
  EXPECT_EQ(refusal_about(tests::replaced(twice, "0x1.8p+0", "3/2"), text), "")
      << "the same numbers in other words";
  EXPECT_NE(refusal_about(scene, text), "");
  EXPECT_EQ(refusal_about(twice + scene, text), "not all scenes are proved");
  EXPECT_TRUE(refusal_about("", "touchstone-certificates 2\ncertificates 0\n")
                  .starts_with("the first line is not 'touchstone-steps 2' or "));
  for (const auto& [truth, other] :
       {std::pair("0x1.8p+0", "0x1.8000000000001p+0"), std::pair("3 4 5", "3 5 4"),
        std::pair("faces 2\n0 1 2\n3 4 5", "faces 3\n0 1 2\n3 4 5\n0 1 5"),
        std::pair("points 0", "points 1\n0"), std::pair("groups 0", "groups 6\n0\n0\n0\n0\n0\n0"),
        std::pair("apart 0", "apart 1\n0 0"), std::pair("radii 0", "radii 1\n0"),
        std::pair("separations 0", "separations 1\n0 0 0"),
        std::pair("separations 0\n", "separations 0\ntetrahedra 1\n0 1 2 3\n"),
        std::pair("separations 0\n", "separations 0\nplane_triangles 1\n0 1 2\n")}) {
    EXPECT_EQ(refusal_about(altered(twice, truth, other), text), "the scene is not the one given")
        << other;
  }
  // A certificate that is true of fewer faces, and accepted without the scene.
  const std::string fewer = altered(scene, "faces 2\n0 1 2\n3 4 5", "faces 1\n0 1 2");
  const std::string proof = stream(step(fewer, no_arguments));
  EXPECT_EQ(refusal(proof), "");
  EXPECT_EQ(refusal_about(scene, proof), "the scene is not the one given");
}

// Any line left out or doubled.
TEST(Step, OfWhichALineIsAlteredIsRefused) {
  const std::string text = earliest();
  const std::vector<std::string> lines = tests::split(text, "\n");
  for (std::size_t i = 0; i + 1 < lines.size(); ++i) {
    std::vector<std::string> without = lines, doubled = lines;
    without.erase(without.begin() + std::ptrdiff_t(i));
    doubled.insert(doubled.begin() + std::ptrdiff_t(i), lines[i]);
    EXPECT_NE(refusal(tests::joined(without, "\n")), "") << lines[i];
    EXPECT_NE(refusal(tests::joined(doubled, "\n")), "") << lines[i];
  }
}

// ---- Limits -------------------------------------------------------------------------------------

TEST(Step, LimitsComparisonsItemsAndArguments) {
  // 60 points in one place, of groups that are held apart: 60 · 59 / 2 pairs are met, and more
  // nodes.
  std::string vertices, points, groups;
  for (int n = 0; n < 60; ++n) {
    vertices += "0 0 0 0 0 0\n";
    points += std::to_string(n) + '\n';
    groups += "0\n";
  }
  const std::string crowd =
      "step crowd\nvertices 60\n" + vertices + "faces 0\nedges 0\npoints 60\n" + points +
      "groups 60\n" + groups +
      "apart 1\n0 0\nradii 0\nseparations 0\nseparation 0 linf\nclaim no_contact 1\n" +
      no_arguments;
  // Bytes before the certificate are no bytes of it.
  const std::string before = "# " + std::string(10'000, ' ') + '\n';
  const std::string compares = "the search for pairs takes too many comparisons",
                    items = " items in the lists of a scene";
  // 6 vertices and 2 faces.
  const std::string text = stream(step()), more = altered(text, "points 0", "points 1\n0");
  struct Row {
    Options limits;
    std::string text, reason;
  };
  for (const auto& [limits, stream, reason] :
       std::vector<Row>{{{.max_comparisons_per_byte = 1}, text, ""},
                        {{.max_comparisons_per_byte = 0}, text, compares},
                        {{.max_comparisons_per_byte = 3}, stream(crowd), ""},
                        {{.max_comparisons_per_byte = 1}, stream(crowd), compares},
                        {{.max_comparisons_per_byte = 1}, stream(before + crowd), compares},
                        {{.max_items = 8}, text, ""},
                        {{.max_items = 7}, text, "more than 7" + items},
                        {{.max_items = 9}, more, ""},
                        {{.max_items = 8}, more, "more than 8" + items},
                        {{.max_arguments = 6}, text, ""},
                        {{.max_arguments = 5}, text, "more than 5 arguments"}}) {
    EXPECT_EQ(refusal(stream, limits), reason) << stream;
  }
}

TEST(Step, LimitsTheWorkByItsBytes) {
  const std::string too_much = "the proof takes too much work";
  const auto refusal_of = [](const std::string& text, std::int64_t bits, std::int64_t per_byte) {
    return refusal(text, {.max_work_bits = bits, .max_step_work_bits_per_byte = per_byte});
  };
  const std::string text = stream(step());
  // The least limit within which the step is accepted.
  std::int64_t bits = 0;
  while (!refusal_of(text, bits, 0).empty()) ++bits;
  EXPECT_GT(bits, 0);
  EXPECT_EQ(refusal_of(text, bits - 1, 0), too_much);
  EXPECT_EQ(refusal_of(stream(step() + step(), 2), bits, 0), "")
      << "the limit is of a step, not of a stream";
  EXPECT_EQ(refusal_of(text, 0, 1), "");
  // The same argument again and again takes work by the same measure as it takes bytes.
  const std::string argument = "4 0\nseparate 0 1 face +\n";
  std::string repeated;
  for (int n = 0; n < 1'000; ++n) repeated += argument;
  const std::string longer = altered(text, argument, repeated);
  EXPECT_EQ(refusal_of(longer, 10 * bits, 0), too_much);
  EXPECT_EQ(refusal_of(longer, 0, bits), "");
}

// ---- Rules and sequences ------------------------------------------------------------------------

/// The step that follows the honest one: its triangle rests where that one ended.
std::string next_step() {
  return step(altered(altered(altered(scene, "1 1 2 ", "1 1 0x1.8p+0 "), "2 1 3 ", "2 1 0x1.4p+1 "),
                      "1 2 2 ", "1 2 0x1.8p+0 "));
}

// What weakens a claim stands in the report of a certificate and in the sentence about all, and
// `free` demands that there is nothing of the kind, unless it is named or the scene is given.
TEST(Step, NamesWhatItsClaimLeavesOut) {
  const auto with = [](std::string_view from, std::string_view to) {
    return stream(altered(step(), from, to));
  };
  const std::string one = "1 step: no two primitives ", can = one + "that can collide ";
  struct Row {
    std::string text, size, rules, sentence;
  };
  for (const auto& [text, size, rules, sentence] : std::vector<Row>{
           {stream(step()), "6", "", one + "touch"},
           {with("apart 0", "apart 4\n0 0\n1 0\n0 1\n2 2"), "6",
            "1 pair of groups held apart, 2 groups held apart from themselves", can + "touch; "},
           {with("apart 0", "apart 3\n0 1\n0 2\n1 0"), "6", "2 pairs of groups held apart",
            can + "touch; "},
           // A face left out, of which one vertex and one edge take part by other lists.
           {stream(step(
                altered(scene, "faces 2\n0 1 2\n3 4 5\nedges 0\npoints 0",
                        "faces 1\n0 1 2\nedges 1\n3 4\npoints 0"),
                altered(altered(arguments, "5 0 -1 0 1\n", ""), "2 4 1 0 -1\n2 5 1 0 -1\n", ""))),
            "5 of 6", "1 vertex left out", can + "touch; "},
           {with("separation 0 linf", "separation 0x1p-9 l2"), "6", "",
            one + "come within 1/512 (l2)"},
           {with("radii 0", "radii 1\n0x1p-9"), "6", "",
            one + "come within their thickness (linf)"},
           {altered(with("separations 0", "separations 1\n0 0 0x1p-9"), "separation 0 linf",
                    "separation 0x1p-9 l2"),
            "6", "", one + "come within their thickness + 1/512 (l2)"}}) {
    const Report report = check_text(text);
    ASSERT_EQ(report.steps.size(), 1U) << report.rejections.at(0).reason;
    EXPECT_TRUE(report.steps[0].starts_with("step a label\n" + size + " vertices, "));
    EXPECT_NE(report.steps[0].find(rules.empty() ? " faces\n" : "\nrules " + rules + "\n"),
              std::string::npos);
    EXPECT_EQ(report.steps[0].find("rules") == std::string::npos, rules.empty());
    EXPECT_EQ(report.summary, sentence + rules);
    // `free`, by itself, with the rules named, with others, and with the scene.
    const std::string refused = "the rules are not those demanded: ";
    EXPECT_EQ(refusal(text, {.claim = "free"}), rules.empty() ? "" : refused + rules);
    EXPECT_EQ(refusal(text, {.claim = "no_contact 1"}), "");
    EXPECT_EQ(refusal(text, {.claim = "free", .rules = rules}), "");
    EXPECT_EQ(refusal(text, {.claim = "free", .rules = "1 vertex"}),
              refused + (rules.empty() ? "none" : rules));
    const std::size_t begin = text.find("vertices"), end = text.find("separation ");
    std::istringstream given(text.substr(begin, end - begin));
    EXPECT_EQ(refusal(text, {.scenes = &given, .claim = "free"}), "");
  }
}

// Steps follow one another if each begins where the last one ended, with the same lists.
TEST(Step, SaysWhetherStepsFollowOneAnother) {
  const std::string first = step(), next = next_step(),
                    gap = "the step does not begin where the last one ended",
                    by_itself = ", each by itself: no two primitives ",
                    second = "step 2 does not begin where step 1 ended",
                    follow = ", each from where the last one ended";
  const auto next_with = [&](std::string_view from, std::string_view to) {
    return altered(next, from, to);
  };
  const auto until_half = [](const std::string& of) {
    return altered(altered(of, "no_contact 1\n", "no_contact 1/2\n"), "separate 0 1 ",
                   "separate 0 1/2 ");
  };
  const std::string in_part = until_half(next);
  struct Row {
    std::vector<std::string> steps;
    std::string sentence, refused;
  };
  for (const auto& [steps, sentence, refused] : std::vector<Row>{
           {{first}, "1 step: no two primitives touch", ""},
           {{first, next}, "2 steps" + follow + ": no two primitives touch", ""},
           {{first, next, next}, "3 steps" + follow + ": no two primitives touch", ""},
           // -0 is 0.
           {{first, next_with("0 0 0 0 0 0", "-0x0p+0 0/1 0 0 0 0")},
            "2 steps" + follow + ": no two primitives touch",
            ""},
           {{first, first}, "2 steps" + by_itself + "touch; " + second, gap},
           {{next, first, first, next, first},
            "5 steps" + by_itself + "touch; " + second + ", nor do 2 others",
            gap},
           {{first, next, first, next, first, first},
            "6 steps" + by_itself +
                "touch; step 3 does not begin where step 2 ended, nor do 2 others",
            gap},
           {{first, next_with("1 1 0x1.8p+0 1", "1 1 0x1.8000000000001p+0 1")},
            "2 steps" + by_itself + "touch; " + second,
            gap},
           {{first, next_with("3 4 5", "4 5 3")}, "2 steps" + by_itself + "touch; " + second, gap},
           {{first, next_with("points 0", "points 1\n0")},
            "2 steps" + by_itself + "touch; " + second,
            gap},
           {{first, next_with("groups 0", "groups 6\n0\n0\n0\n0\n0\n0")},
            "2 steps" + by_itself + "touch; " + second,
            gap},
           {{first, next_with("radii 0", "radii 1\n0x1p-9")},
            "2 steps" + by_itself + "touch; " + second,
            gap},
           {{first, next_with("apart 0", "apart 1\n0 1")},
            "2 steps" + by_itself + "that can collide touch; the rules differ; " + second,
            "the rules are not those demanded: 1 pair of groups held apart"},
           {{first, next_with("separation 0 linf", "separation 0x1p-9 l2")},
            "2 steps" + follow + ": no two primitives touch",
            ""},
           {{first, in_part},
            "2 steps" + follow,
            "the claim is not the one demanded: no_contact 1/2"},
           {{in_part}, "", "the claim is not the one demanded: no_contact 1/2"},
           {{first, until_half(first)},
            "2 steps, each by itself; " + second,
            "the claim is not the one demanded: no_contact 1/2"}}) {
    const std::string text = stream(tests::joined(steps, ""), steps.size());
    const Report report = check_text(text);
    EXPECT_EQ(refusal(text), "");
    EXPECT_EQ(report.summary, sentence);
    EXPECT_EQ(refusal(text, {.claim = demanded_claim("sequence")}), refused) << sentence;
  }
  EXPECT_EQ(check_text(stream(first + next, 3)).summary, "") << "of a stream that is not accepted";
}

// ---- Demands ------------------------------------------------------------------------------------

TEST(Step, IsPrintedInOneForm) {
  const std::string zeros(1'100, '0');
  const auto printed = [](const std::string& text) {
    const Report report = check_text(text);
    return report.steps.empty() ? report.rejections.at(0).reason : report.steps[0];
  };
  const auto with = [](const std::string& from, const std::string& to) {
    return altered(stream(step()), from, to);
  };
  // 0x1.00…0p-90 is 2^-90; a reader of its first digits would take it for 1.
  EXPECT_NE(printed(with("separation 0", "separation 0x1." + zeros + "p-90"))
                .find("\nseparation 0x1p-90 linf\n"),
            std::string::npos);
  EXPECT_NE(printed(with("claim no_contact 1", "claim no_contact 0x1." + zeros + "p+0"))
                .find("\nclaim no_contact 1\n"),
            std::string::npos);
}

// The word `step` is no part of it.
TEST(Step, HasALabelOfTheSameLimitAsAQuery) {
  const auto with_label = [](std::size_t bytes) {
    return refusal(altered(stream(step()), "step a label", "step " + std::string(bytes, 'a')));
  };
  EXPECT_EQ(with_label(1'024), "");
  EXPECT_EQ(with_label(1'025), "more than 1024 bytes in a label");
  EXPECT_EQ(refusal(altered(stream(step()), "step a label", "step")), "");
}

TEST(Step, ProvesWhatIsDemandedAndNothingElse) {
  const auto refusal_of = [](const std::string& claim, const std::string& separation) {
    return refusal(stream(step()), {.claim = claim, .separation = separation});
  };
  EXPECT_EQ(refusal_of(demanded_claim("free"), demanded_separation("0", "l2")), "");
  EXPECT_EQ(refusal_of(demanded_claim("no_contact 0x1p+0"), demanded_separation("0.0", "linf")),
            "");
  const std::string other_claim = "the claim is not the one demanded: no_contact 1";
  for (const char* const claim :
       {"earliest", "earliest 1/2 1", "no_contact 1/2", "no_collision", "time_of_impact"}) {
    EXPECT_EQ(refusal_of(demanded_claim(claim), ""), other_claim) << claim;
  }
  const std::string other_separation = "the separation is not the one demanded: 0";
  EXPECT_EQ(refusal_of("", demanded_separation("1e-8", "l2")), other_separation);
  // The norm of 0 matters where primitives are thick.
  EXPECT_EQ(refusal(stream(spheres), {.separation = demanded_separation("0", "l2")}), "");
  EXPECT_EQ(refusal(stream(spheres), {.separation = demanded_separation("0", "linf")}),
            other_separation + " l2");
  for (const char* const nonsense :
       {"", "free 1", "no_contact", "earliest 1", "collision 0", "no_contact x"}) {
    EXPECT_THROW(static_cast<void>(demanded_claim(nonsense)), Rejection) << nonsense;
  }
  const std::string none = "touchstone-steps 2\nsteps 0\n";
  EXPECT_EQ(refusal(none), "");
  for (const Options& demand : {Options{.claim = "free"}, Options{.rules = "1 vertex left out"}}) {
    EXPECT_EQ(refusal(none, demand), "there is no certificate of what is demanded");
  }
  EXPECT_THROW(static_cast<void>(demanded_separation("1", "l1")), Rejection);
  EXPECT_THROW(static_cast<void>(demanded_separation("-1", "l2")), Rejection);
  EXPECT_THROW(static_cast<void>(demanded_separation("nan", "l2")), Rejection);
}

}  // namespace
}  // namespace touchstone::checker::step_test
