/// \file
/// The checker's mathematics on certificates made by hand: every claim, feature and form of contact
/// is accepted where it is proved, and every rule rejects what breaks it. Then at random, against
/// the oracle.

#include "exact/checker/proof.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cstddef>
#include <map>
#include <random>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exact/checker/checker.hpp"
#include "exact/contact/corner_motion.hpp"
#include "tests/support/checker_outcome.hpp"
#include "tests/support/trials.hpp"
#include "touchstone/oracle.hpp"

namespace touchstone::checker::proof_test {
namespace {

using namespace std::string_literals;
using tests::outcome;
using tests::query_text;

/// Four points that move.
std::string vertex_face(const std::array<std::string, 4>& start,
                        const std::array<std::string, 4>& end) {
  return query_text("vertex_face",
                    {start[0], start[1], start[2], start[3], end[0], end[1], end[2], end[3]});
}
std::string edge_edge(const std::array<std::string, 4>& start,
                      const std::array<std::string, 4>& end) {
  return query_text("edge_edge",
                    {start[0], start[1], start[2], start[3], end[0], end[1], end[2], end[3]});
}

/// A vertex that moves over the triangle (0,0,0), (4,0,0), (0,4,0), which is at rest.
std::string over_triangle(const std::string& start, const std::string& end) {
  const std::string f0 = "0 0 0", f1 = "4 0 0", f2 = "0 4 0";
  return vertex_face({start, f0, f1, f2}, {end, f0, f1, f2});
}

/// The edge from (0,−1,0) to (0,1,0), at rest, and one along x above its middle at these heights.
std::string crossing(std::string_view start, std::string_view end) {
  const std::string a0 = "-1 0 "s + std::string(start), a1 = "1 0 "s + std::string(start);
  const std::string b0 = "-1 0 "s + std::string(end), b1 = "1 0 "s + std::string(end);
  return edge_edge({a0, a1, "0 -1 0", "0 1 0"}, {b0, b1, "0 -1 0", "0 1 0"});
}

/// The triangle (0,0,0), (2,2t,0), (0,0,1) and the vertex (t,1/2,1/4): det = ±(2t²−1), so the toi
/// is √½ with (u,v) = (√½/2, 1/4).
std::string turning() {
  return vertex_face({"0 1/2 1/4", "0 0 0", "2 0 0", "0 0 1"},
                     {"1 1/2 1/4", "0 0 0", "2 2 0", "0 0 1"});
}

/// The same vertex and triangle as turning(), in the plane z=0 for all time: every det is 0.
std::string flat() { return over_triangle("1 -1 0", "1 1 0"); }

std::string no_collision(std::string_view subintervals) {
  return "claim no_collision\n" + std::string(subintervals) + "\nend\n";
}
std::string collision(std::string_view contact, std::string_view place) {
  return "claim collision\ncontact " + std::string(contact) + "\nat " + std::string(place) +
         "\nend\n";
}

// ---- Separation ---------------------------------------------------------------------------------

TEST(Separation, ByAVertex) {
  const auto proved = [](std::string_view at, int vertex) {
    const std::string place(at);
    return outcome(over_triangle(place + " 1", place + " 2") +
                   no_collision("separate 0 1 vertex " + std::to_string(vertex)));
  };
  EXPECT_EQ(proved("0 0", 0), "no_collision");
  EXPECT_EQ(proved("5 0", 1), "no_collision");
  EXPECT_EQ(proved("0 5", 2), "no_collision");
  for (const int vertex : {0, 1, 2}) {
    EXPECT_EQ(proved("4/3 4/3", vertex), "12: a polynomial is not positive at a point");
  }
}

TEST(Separation, ByAnEdge) {
  const std::string beside = over_triangle("2 -1 1", "2 -2 1");
  for (const std::string_view edge : {"0 1", "1 0"}) {
    EXPECT_EQ(outcome(beside + no_collision("separate 0 1 edge "s + std::string(edge))),
              "no_collision");
  }
  for (const std::string_view other : {"edge 1 2", "edge 0 0", "vertex 0", "vertex 1"}) {
    EXPECT_EQ(outcome(beside + no_collision("separate 0 1 "s + std::string(other))),
              "12: a polynomial is not positive at a point")
        << other;
  }
}

TEST(Separation, ByAFace) {
  const std::string above = over_triangle("1 1 1", "1 1 2"),
                    below = over_triangle("1 1 -1", "1 1 -2");
  EXPECT_EQ(outcome(above + no_collision("separate 0 1 face +")), "no_collision");
  EXPECT_EQ(outcome(below + no_collision("separate 0 1 face -")), "no_collision");
  EXPECT_EQ(outcome(above + no_collision("separate 0 1 face -")),
            "12: a polynomial is not positive at a point");
  EXPECT_EQ(outcome(below + no_collision("separate 0 1 face +")),
            "12: a polynomial is not positive at a point");
}

TEST(Separation, OfEdges) {
  // N points down: ea × eb = (2,0,0) × (0,−2,0).
  EXPECT_EQ(outcome(crossing("1", "2") + no_collision("separate 0 1 face -")), "no_collision");
  EXPECT_EQ(outcome(crossing("-1", "-2") + no_collision("separate 0 1 face +")), "no_collision");
  // ea is beside eb's end: the nearest features are eb1's edge w_2 w_3, ea's end its vertices.
  const std::string beside =
      edge_edge({"-1 2 0", "1 2 0", "0 -1 0", "0 1 0"}, {"-1 3 0", "1 3 0", "0 -1 0", "0 1 0"});
  EXPECT_EQ(outcome(beside + no_collision("separate 0 1 edge 2 3")), "no_collision");
  EXPECT_EQ(outcome(beside + no_collision("separate 0 1 edge 3 2")), "no_collision");
  EXPECT_EQ(outcome(beside + no_collision("separate 0 1 vertex 3")),
            "12: a polynomial is not positive at a point");
  const std::string apart =
      edge_edge({"1 2 0", "3 2 0", "0 -1 0", "0 1 0"}, {"1 3 0", "3 3 0", "0 -1 0", "0 1 0"});
  EXPECT_EQ(outcome(apart + no_collision("separate 0 1 vertex 3")), "no_collision");
}

TEST(Separation, MustHoldForEveryCorner) {
  // Of the corners (1,0,0), (2,−1,0), (−3,0,0) the last is on the other side of the first; in every
  // order.
  const std::string v = "0 0 0";
  const std::array<std::string, 3> face{"-1 0 0", "-2 1 0", "3 0 0"};
  for (const auto& [order, good] :
       {std::pair(std::array{0, 1, 2}, "vertex 0"), std::pair(std::array{0, 2, 1}, "vertex 0"),
        std::pair(std::array{2, 0, 1}, "vertex 1")}) {
    const auto f = [&, o = order](std::size_t n) {
      return face.at(static_cast<std::size_t>(o.at(n)));
    };
    EXPECT_EQ(outcome(vertex_face({v, f(0), f(1), f(2)}, {v, f(0), f(1), f(2)}) +
                      no_collision("separate 0 1 "s + good)),
              "12: a polynomial is not positive at a point");
  }
  // The corners are (1,1,0), (3,1,0), (1,1,0), (−1,1,0): the last alone is behind the second.
  const std::string fourth =
      edge_edge({"0 1 0", "2 1 0", "-1 0 0", "1 0 0"}, {"0 1 0", "2 1 0", "-1 0 0", "1 0 0"});
  EXPECT_EQ(outcome(fourth + no_collision("separate 0 1 vertex 1")),
            "12: a polynomial is not positive at a point");
}

TEST(Separation, IsStrict) {
  // In contact by a hair, at t=1 only: every feature has a value 0.
  const std::string colliding = over_triangle("1 1 1", "1 1 0");
  EXPECT_EQ(outcome(colliding + no_collision("separate 0 1 face +")),
            "12: a polynomial is not positive at a point");
  EXPECT_EQ(outcome(over_triangle("1 1 0", "1 1 1") + no_collision("separate 0 1 face +")),
            "12: a polynomial is not positive at a point");
  EXPECT_EQ(outcome(over_triangle("1 1 1", "1 1 0x1p-1074") + no_collision("separate 0 1 face +")),
            "no_collision");
}

TEST(Separation, IsSeenByHalves) {
  // The vertex's own squared distance to f0, f1 and f2, all at the same place: (1−3t)² + h².
  const auto passing = [](const std::string& h) {
    return vertex_face({"1 " + h + " 0", "0 0 0", "0 0 0", "0 0 0"},
                       {"-2 " + h + " 0", "0 0 0", "0 0 0", "0 0 0"});
  };
  EXPECT_EQ(outcome(passing("1") + no_collision("separate 0 1 vertex 0")), "no_collision");
  EXPECT_EQ(outcome(passing("1/1000") + no_collision("separate 0 1 vertex 0")), "no_collision");
  EXPECT_EQ(outcome(passing("0") + no_collision("separate 0 1 vertex 0")),
            "12: a polynomial is not seen to be positive within 128 bisections");
}

/// Each has (1−2t)² + h² as its value, times a constant: halved as a form of degree 3 and of
/// degree 4.
TEST(Separation, IsSeenByHalvesWhateverTheDegree) {
  const auto turning_face = [](const std::string& h) {
    return vertex_face({"0 0 1", "0 0 0", "1 " + h + " 0", "-" + h + " 1 0"},
                       {"0 0 1", "0 0 0", "-1 " + h + " 0", "-" + h + " -1 0"}) +
           no_collision("separate 0 1 face +");
  };
  const auto passing_edge = [](const std::string& h) {
    return vertex_face({"2 1 " + h, "0 0 0", "4 0 0", "0 0 0"},
                       {"2 -1 " + h, "0 0 0", "4 0 0", "0 0 0"}) +
           no_collision("separate 0 1 edge 0 1");
  };
  for (const std::string h : {"1/3", "1/100"}) {
    EXPECT_EQ(outcome(turning_face(h)), "no_collision");
    EXPECT_EQ(outcome(passing_edge(h)), "no_collision");
  }
  EXPECT_EQ(outcome(turning_face("0x0p+0")), "12: a polynomial is not positive at a point");
  EXPECT_EQ(outcome(passing_edge("0")), "12: a polynomial is not positive at a point");
}

/// After 128 halvings 1/3 is at one or two thirds of an interval of width 2^−128, on which the
/// middle coefficient of (1−3t)² + h² is h² − 2·4^−128: h = 2^−127 is enough, h = 2^−128 is not.
TEST(Separation, HasALimitOfBisections) {
  const auto passing = [](int power) {
    const std::string h = "0x1p-" + std::to_string(power);
    return vertex_face({"1 " + h + " 0", "0 0 0", "0 0 0", "0 0 0"},
                       {"-2 " + h + " 0", "0 0 0", "0 0 0", "0 0 0"}) +
           no_collision("separate 0 1 vertex 0");
  };
  EXPECT_EQ(outcome(passing(127)), "no_collision");
  EXPECT_EQ(outcome(passing(128)),
            "12: a polynomial is not seen to be positive within 128 bisections");
}

TEST(Subintervals, CoverTheWholeTime) {
  // The vertex passes over the triangle's edge f0 f1: first the edge is nearest, then the face.
  const std::string over = over_triangle("1 -1 1", "1 1 1");
  EXPECT_EQ(outcome(over + no_collision("separate 0 1/2 edge 0 1\nseparate 1/2 1 face +")),
            "no_collision");
  EXPECT_EQ(outcome(over + no_collision("separate 0x0p+0 0x1p-1 face +\nseparate 2/4 4/4 face +")),
            "no_collision");
  EXPECT_EQ(outcome(over + no_collision("separate 0 1/2 face +\nseparate 1/2 1/2 edge 0 1\n"
                                        "separate 1/2 1 face +")),
            "no_collision");
  const std::string begin = ": the subinterval does not begin where it should";
  EXPECT_EQ(outcome(over + no_collision("separate 1/4 1 face +")), "12" + begin);
  EXPECT_EQ(outcome(over + no_collision("separate -1 1 face +")), "12" + begin);
  EXPECT_EQ(outcome(over + no_collision("separate 0 1/2 face +\nseparate 3/4 1 face +")),
            "13" + begin);
  EXPECT_EQ(outcome(over + no_collision("separate 0 1/2 face +\nseparate 1/4 1 face +")),
            "13" + begin);
  EXPECT_EQ(outcome(over + no_collision("separate 1/2 1 face +\nseparate 0 1/2 face +")),
            "12" + begin);
  EXPECT_EQ(outcome(over + no_collision("separate 0 1 face +\nseparate 1 1/2 face +")),
            "13: the subinterval ends before it begins");
  EXPECT_EQ(outcome(over + no_collision("separate 0 1/2 face +")),
            "12: the last subinterval does not end where it should");
  EXPECT_EQ(outcome(over + no_collision("separate 0 2 face +")),
            "12: the last subinterval does not end where it should");
  EXPECT_EQ(outcome(over + "claim no_collision\nend\n"), "11: there is no subinterval");
}

TEST(Subintervals, EachIsProved) {
  // Through the triangle between 1/4 and 3/4 only.
  const std::string through = over_triangle("1 1 1", "1 1 -1");
  EXPECT_EQ(outcome(through + no_collision("separate 0 1/4 face +\nseparate 1/4 3/4 face +\n"
                                           "separate 3/4 1 face -")),
            "13: a polynomial is not positive at a point");
  EXPECT_EQ(outcome(through + no_collision("separate 0 1/4 face +\nseparate 1/4 1/4 face -\n"
                                           "separate 1/4 1 face +")),
            "13: a polynomial is not positive at a point");
  EXPECT_EQ(outcome(through + no_collision("separate 0 1/4 face +\nseparate 1/4 1 face -")),
            "13: a polynomial is not positive at a point");
}

TEST(Subintervals, MayBeSinglePoints) {
  const std::string above = over_triangle("1 1 1", "1 1 2");
  EXPECT_EQ(outcome(above +
                    no_collision("separate 0 0 face +\nseparate 0 1 face +\nseparate 1 1 face +")),
            "no_collision");
}

// ---- Contact ------------------------------------------------------------------------------------

TEST(Contact, InATriangle) {
  const std::string through = over_triangle("1 1 1", "1 1 -1");
  EXPECT_EQ(outcome(through + collision("time 1/2", "triangle 0 1 2 z")), "collision");
  EXPECT_EQ(outcome(through + collision("time 0x1p-1", "triangle 2 0 1 z")), "collision");
  EXPECT_EQ(outcome(through + collision("time 2/4", "triangle 1 0 2 z")), "collision");
  EXPECT_EQ(outcome(through + collision("root 0 1 -1 2", "triangle 0 1 2 z")), "collision");
  EXPECT_EQ(outcome(through + collision("root 0 1 3 -6", "triangle 0 1 2 z")), "collision");
  EXPECT_EQ(outcome(through + collision("time 1/3", "triangle 0 1 2 z")),
            "12: the origin is not in the triangle's plane");
  EXPECT_EQ(outcome(through + collision("time 1/2", "triangle 0 1 2 x")),
            "12: the triangle's normal is 0 on this axis");
  EXPECT_EQ(outcome(through + collision("root 0 1 -1 2", "triangle 0 1 2 y")),
            "12: the triangle's normal is 0 on this axis");
  EXPECT_EQ(outcome(through + collision("time 1/2", "triangle 0 1 1 z")),
            "12: the triangle's normal is 0 on this axis");
}

/// A triangle that stands in the plane of two axes, for each of the three.
TEST(Contact, OnEachAxis) {
  const std::string in_yz =
      vertex_face({"1 1 1", "0 0 0", "0 4 0", "0 0 4"}, {"-1 1 1", "0 0 0", "0 4 0", "0 0 4"});
  EXPECT_EQ(outcome(in_yz + collision("time 1/2", "triangle 0 1 2 x")), "collision");
  EXPECT_EQ(outcome(in_yz + collision("time 1/2", "triangle 0 1 2 y")),
            "12: the triangle's normal is 0 on this axis");
  const std::string in_zx =
      vertex_face({"1 1 1", "0 0 0", "4 0 0", "0 0 4"}, {"1 -1 1", "0 0 0", "4 0 0", "0 0 4"});
  EXPECT_EQ(outcome(in_zx + collision("time 1/2", "triangle 0 1 2 y")), "collision");
  EXPECT_EQ(outcome(in_zx + collision("time 1/2", "triangle 0 1 2 z")),
            "12: the triangle's normal is 0 on this axis");
}

TEST(Contact, OutsideOfEachSideOfATriangle) {
  for (const std::string_view beside : {"-1 1", "1 -1", "3 3"}) {
    const std::string place(beside);
    EXPECT_EQ(outcome(over_triangle(place + " 1", place + " -1") +
                      collision("time 1/2", "triangle 0 1 2 z")),
              "12: the origin is not in the triangle");
    EXPECT_EQ(outcome(over_triangle(place + " 1", place + " -1") +
                      collision("root 0 1 -1 2", "triangle 1 0 2 z")),
              "12: the origin is not in the triangle");
  }
}

TEST(Contact, OnTheBoundaryOfATriangle) {
  for (const std::string_view on : {"0 1", "1 0", "2 2", "0 0", "4 0", "0 4"}) {
    const std::string place(on);
    const std::string onto = over_triangle(place + " 1", place + " -1");
    EXPECT_EQ(outcome(onto + collision("time 1/2", "triangle 0 1 2 z")), "collision") << on;
    EXPECT_EQ(outcome(onto + collision("root 0 1 -1 2", "triangle 0 1 2 z")), "collision") << on;
  }
}

TEST(Contact, AtTheEnds) {
  EXPECT_EQ(outcome(over_triangle("1 1 0", "1 1 1") + collision("time 0", "triangle 0 1 2 z")),
            "collision");
  EXPECT_EQ(outcome(over_triangle("1 1 1", "1 1 0") + collision("time 1", "triangle 0 1 2 z")),
            "collision");
  EXPECT_EQ(outcome(over_triangle("0 0 0", "1 1 1") + collision("time 0", "segment 0 0")),
            "collision");
  EXPECT_EQ(outcome(over_triangle("5 5 1", "0 4 0") + collision("time 1", "segment 2 2")),
            "collision");
}

TEST(Contact, OnASegment) {
  // v passes the middle of f0 f1.
  const std::string onto = over_triangle("2 -1 -1", "2 1 1");
  EXPECT_EQ(outcome(onto + collision("time 1/2", "segment 0 1")), "collision");
  EXPECT_EQ(outcome(onto + collision("root 1/4 3/4 -1 2", "segment 1 0")), "collision");
  EXPECT_EQ(outcome(onto + collision("time 1/2", "segment 0 2")),
            "12: the origin is not on the segment's line");
  EXPECT_EQ(outcome(onto + collision("time 1/4", "segment 0 1")),
            "12: the origin is not on the segment's line");
  EXPECT_EQ(outcome(onto + collision("root 1/4 3/4 -1 3", "segment 1 0")).substr(0, 3), "12:");
  // On the line of f0 f1, but beyond f1.
  const std::string beyond = over_triangle("5 -1 -1", "5 1 1");
  EXPECT_EQ(outcome(beyond + collision("time 1/2", "segment 0 1")),
            "12: the origin is not on the segment");
  EXPECT_EQ(outcome(beyond + collision("root 1/4 3/4 -1 2", "segment 0 1")),
            "12: the origin is not on the segment");
  // A corner that is not the origin is no contact.
  EXPECT_EQ(outcome(onto + collision("time 1/2", "segment 0 0")),
            "12: the origin is not on the segment");
}

/// The corners are not parallel, and point away from each other: w_0×w_1 is 0 on two axes, not on
/// the third, which is z, x, y.
TEST(Contact, OnASegmentNeedsAllAxes) {
  for (const auto& [v, f1] : {std::pair("1 0 0"s, "2 -1 0"s), std::pair("0 1 0"s, "0 2 -1"s),
                              std::pair("0 0 1"s, "-1 0 2"s)}) {
    const std::string apart = vertex_face({v, "0 0 0", f1, "9 9 9"}, {v, "0 0 0", f1, "9 9 9"});
    EXPECT_EQ(outcome(apart + collision("time 0", "segment 0 1")),
              "12: the origin is not on the segment's line");
  }
}

TEST(Contact, OfEdges) {
  const std::string through = crossing("1", "-1");
  for (const std::string_view place : {"triangle 0 1 2 z", "triangle 1 2 3 z", "triangle 0 3 2 z",
                                       "segment 0 2", "segment 1 3", "segment 3 1"}) {
    EXPECT_EQ(outcome(through + collision("time 1/2", place)), "collision") << place;
  }
  EXPECT_EQ(outcome(through + collision("time 1/2", "segment 0 1")),
            "12: the origin is not on the segment's line");
  EXPECT_EQ(outcome(through + collision("time 0", "triangle 0 1 2 z")),
            "12: the origin is not in the triangle's plane");
  // Nearer to one end: in one half of the parallelogram only.
  const std::string off =
      edge_edge({"-1 0 1", "3 0 1", "0 -1 0", "0 2 0"}, {"-1 0 -1", "3 0 -1", "0 -1 0", "0 2 0"});
  EXPECT_EQ(outcome(off + collision("time 1/2", "triangle 0 1 3 z")), "collision");
  EXPECT_EQ(outcome(off + collision("time 1/2", "triangle 1 2 3 z")),
            "12: the origin is not in the triangle");
  // Collinear edges that meet end to end at t=1/2.
  const std::string collinear =
      edge_edge({"0 0 0", "1 0 0", "2 0 0", "3 0 0"}, {"2 0 0", "3 0 0", "2 0 0", "3 0 0"});
  EXPECT_EQ(outcome(collinear + collision("time 1/2", "segment 1 1")), "collision");
  EXPECT_EQ(outcome(collinear + collision("time 3/4", "segment 0 1")), "collision");
  EXPECT_EQ(outcome(collinear + collision("root 1/4 3/4 -1 2", "segment 0 1")), "collision");
  EXPECT_EQ(outcome(collinear + collision("time 1/4", "segment 0 1")),
            "12: the origin is not on the segment");
}

TEST(Contact, AtAnIrrationalTime) {
  EXPECT_EQ(outcome(turning() + collision("root 1/2 1 -1 0 2", "triangle 0 1 2 x")), "collision");
  EXPECT_EQ(outcome(turning() + collision("root 1/2 1 -1 0 2", "triangle 0 1 2 y")), "collision");
  EXPECT_EQ(outcome(turning() + collision("root 0x1p-1 0x1.8p-1 5 0 -10", "triangle 2 1 0 y")),
            "collision");
  // N'_x = 2t has no strict sign on [0,1], though at the root.
  EXPECT_EQ(outcome(turning() + collision("root 0 1 -1 0 2", "triangle 0 1 2 x")),
            "12: a polynomial is not positive at a point");
  EXPECT_EQ(outcome(turning() + collision("root 1/4 1 -1 0 2", "triangle 0 1 2 y")), "collision");
}

TEST(Contact, NeedsAPolynomialThatDivides) {
  const auto with = [](const std::string& root) {
    return outcome(turning() + collision("root " + root, "triangle 0 1 2 y"));
  };
  // Near √½, and equal to it where floating point looks.
  EXPECT_EQ(with("1/2 1 -70710678118654752 100000000000000000"),
            "12: a polynomial is not positive at a point");
  EXPECT_EQ(with("1/2 1 -1 0 0 3"), "12: a polynomial is not positive at a point");
  // (2t²−1)(t+5) has the root but does not divide, (2t²−1)² has no change of sign.
  EXPECT_EQ(with("1/2 1 -5 -1 10 2"), "12: a polynomial is not positive at a point");
  EXPECT_EQ(with("1/2 1 1 0 -4 0 4"),
            "12: the polynomial does not change its sign in the interval");
  // A root, but at the end of the interval; none in it; two.
  EXPECT_EQ(
      outcome(over_triangle("1 1 1", "1 1 -1") + collision("root 1/2 1 -1 2", "triangle 0 1 2 z")),
      "12: the polynomial does not change its sign in the interval");
  EXPECT_EQ(
      outcome(over_triangle("1 1 1", "1 1 -1") + collision("root 0 1/2 -1 2", "triangle 0 1 2 z")),
      "12: the polynomial does not change its sign in the interval");
  EXPECT_EQ(with("3/4 1 -1 0 2"), "12: the polynomial does not change its sign in the interval");
  EXPECT_EQ(with("1 1/2 -1 0 2"), "12: the root's interval is empty");
  EXPECT_EQ(with("1/2 1/2 -1 0 2"), "12: the root's interval is empty");
}

TEST(Contact, WhereADeterminantIsZeroForAllTime) {
  EXPECT_EQ(outcome(flat() + collision("time 1/2", "triangle 0 1 2 z")), "collision");
  EXPECT_EQ(outcome(flat() + collision("time 1/2", "segment 0 1")), "collision");
  EXPECT_EQ(outcome(flat() + collision("root 1/4 3/4 -1 2", "triangle 0 1 2 z")), "collision");
  EXPECT_EQ(outcome(flat() + collision("time 3/4", "triangle 0 1 2 z")), "collision");
  EXPECT_EQ(outcome(flat() + collision("time 1/4", "triangle 0 1 2 z")),
            "12: the origin is not in the triangle");
  EXPECT_EQ(outcome(flat() + collision("root 1/2 1 -3 4", "triangle 0 1 2 z")),
            "12: a polynomial is not positive at a point");
  // Any polynomial divides 0, also one of degree 8: t^8 − 1/2.
  EXPECT_EQ(outcome(flat() + collision("root 3/4 1 -1 0 0 0 0 0 0 0 2", "triangle 0 1 2 z")),
            "collision");
}

TEST(Contact, IsInTheTimeOfTheQuery) {
  // Before and after [0,1] the points would touch.
  const std::string after = over_triangle("1 1 2", "1 1 1"),
                    before = over_triangle("1 1 1", "1 1 2");
  const std::string reason = "12: the contact is not in the interval of the claim";
  EXPECT_EQ(outcome(after + collision("time 2", "triangle 0 1 2 z")), reason);
  EXPECT_EQ(outcome(after + collision("root 1/2 3 2 -1", "triangle 0 1 2 z")), reason);
  EXPECT_EQ(outcome(before + collision("time -1", "triangle 0 1 2 z")), reason);
  EXPECT_EQ(outcome(before + collision("root -2 1 1 1", "triangle 0 1 2 z")), reason);
}

// ---- Time of impact -----------------------------------------------------------------------------

std::string time_of_impact(std::string_view bounds, std::string_view subintervals,
                           std::string_view contact, std::string_view place) {
  return "claim time_of_impact " + std::string(bounds) + "\n" + std::string(subintervals) +
         "contact " + std::string(contact) + "\nat " + std::string(place) + "\nend\n";
}

TEST(TimeOfImpact, IsEnclosed) {
  const std::string through = over_triangle("1 1 1", "1 1 -1"), place = "triangle 0 1 2 z";
  EXPECT_EQ(
      outcome(through + time_of_impact("1/4 1/2", "separate 0 1/4 face +\n", "time 1/2", place)),
      "time_of_impact");
  EXPECT_EQ(
      outcome(through + time_of_impact("0 1", "separate 0 0 face +\n", "root 0 1 -1 2", place)),
      "time_of_impact");
  EXPECT_EQ(outcome(through + time_of_impact("0x1.fffffffffffffp-2 0x1p-1",
                                             "separate 0 0x1.fffffffffffffp-2 face +\n", "time 1/2",
                                             place)),
            "time_of_impact");
  EXPECT_EQ(
      outcome(turning() + time_of_impact("0x1.6a09e667f3bccp-1 0x1.6a09e667f3bcdp-1",
                                         "separate 0 0x1.6a09e667f3bccp-1 face -\n",
                                         "root 0x1.6a09e667f3bccp-1 0x1.6a09e667f3bcdp-1 -1 0 2",
                                         place.substr(0, 15) + "y")),
      "time_of_impact");
  EXPECT_EQ(
      outcome(turning() + time_of_impact("0x1.6a09e667f3bcdp-1 0x1.6a09e667f3bcep-1",
                                         "separate 0 0x1.6a09e667f3bcdp-1 face -\n",
                                         "root 0x1.6a09e667f3bcdp-1 0x1.6a09e667f3bcep-1 -1 0 2",
                                         "triangle 0 1 2 y")),
      "12: a polynomial is not positive at a point");
}

TEST(TimeOfImpact, MayBeZero) {
  const std::string on = over_triangle("1 1 0", "1 1 -1"), place = "triangle 0 1 2 z";
  EXPECT_EQ(outcome(on + time_of_impact("0 0", "", "time 0", place)), "time_of_impact");
  EXPECT_EQ(outcome(on + time_of_impact("0/7 0x0p+0", "", "time -0x0p+0", place)),
            "time_of_impact");
  EXPECT_EQ(outcome(on + time_of_impact("0 0", "separate 0 0 face +\n", "time 0", place)),
            "12: expected 'contact', found 'separate'");
  EXPECT_EQ(outcome(on + time_of_impact("0 1/2", "", "time 0", place)),
            "11: there is no subinterval");
  EXPECT_EQ(outcome(on + time_of_impact("0 1/2", "separate 0 0 face +\n", "time 0", place)),
            "12: a polynomial is not positive at a point");
}

TEST(TimeOfImpact, HasBoundsInOrder) {
  const std::string through = over_triangle("1 1 1", "1 1 -1"), place = "triangle 0 1 2 z";
  const std::string reason = "11: a time of impact is 0 0, or LO HI with 0 <= LO < HI <= 1";
  for (const std::string_view bounds :
       {"1/2 1/2", "1/2 1/4", "-1 1/2", "1/4 2", "1/4 0x1.0000000000001p+0", "1 1", "-1 -1", "0 -1",
        "-1 0"}) {
    EXPECT_EQ(
        outcome(through + time_of_impact(bounds, "separate 0 1/4 face +\n", "time 1/2", place)),
        reason)
        << bounds;
  }
}

TEST(TimeOfImpact, NeedsBothProofs) {
  const std::string through = over_triangle("1 1 1", "1 1 -1"), place = "triangle 0 1 2 z";
  // The contact is not in the interval, or not wholly.
  const std::string outside = "13: the contact is not in the interval of the claim";
  EXPECT_EQ(
      outcome(through + time_of_impact("1/4 3/8", "separate 0 1/4 face +\n", "time 1/2", place)),
      outside);
  EXPECT_EQ(outcome(through + time_of_impact("1/4 3/4", "separate 0 1/4 face +\n",
                                             "root 1/8 3/4 -1 2", place)),
            outside);
  EXPECT_EQ(outcome(through +
                    time_of_impact("1/4 3/4", "separate 0 1/4 face +\n", "root 1/4 1 -1 2", place)),
            outside);
  EXPECT_EQ(
      outcome(through + time_of_impact("3/8 3/4", "separate 0 1/4 face +\n", "time 1/2", place)),
      "12: the last subinterval does not end where it should");
  EXPECT_EQ(
      outcome(through + time_of_impact("1/4 3/4", "separate 0 1/2 face +\n", "time 1/2", place))
          .substr(0, 3),
      "12:");
  EXPECT_EQ(
      outcome(through + time_of_impact("1/4 3/4", "separate 0 1/4 face -\n", "time 1/2", place)),
      "12: a polynomial is not positive at a point");
  EXPECT_EQ(
      outcome(through + time_of_impact("1/4 3/4", "separate 0 1/4 face +\n", "time 5/8", place)),
      "13: the origin is not in the triangle's plane");
  // A later contact is no first one: v passes the edge at 1/4, and stays on the plane.
  EXPECT_EQ(outcome(over_triangle("1 -1 0", "1 3 0") +
                    time_of_impact("1/2 3/4", "separate 0 1/2 edge 0 1\n", "time 3/4", place)),
            "12: a polynomial is not positive at a point");
}

// ---- At a distance ------------------------------------------------------------------------------

/// The line between the points and the claim; what follows is a line further down.
std::string separation(std::string_view distance, std::string_view norm) {
  return "separation " + std::string(distance) + " " + std::string(norm) + "\n";
}

const std::string not_positive = "13: a polynomial is not positive at a point";

TEST(Distance, IsKeptStrictly) {
  // From height 2 to 3.
  const std::string above = over_triangle("1 1 2", "1 1 3");
  for (const std::string_view feature : {"face +", "axis z +"}) {
    const std::string proof = no_collision("separate 0 1 " + std::string(feature));
    for (const std::string_view norm : {"linf", "l2"}) {
      EXPECT_EQ(outcome(above + separation("0", norm) + proof), "no_collision");
      EXPECT_EQ(outcome(above + separation("1", norm) + proof), "no_collision");
      EXPECT_EQ(outcome(above + separation("0x1.fffffffffffffp+0", norm) + proof), "no_collision");
      EXPECT_EQ(outcome(above + separation("2", norm) + proof), not_positive);
      EXPECT_EQ(outcome(above + separation("3", norm) + proof), not_positive);
      EXPECT_EQ(outcome(above + separation("1000", norm) + proof), not_positive);
    }
  }
}

TEST(Distance, IsANumberThatIsNotNegativeWithANorm) {
  const std::string above = over_triangle("1 1 2", "1 1 3"),
                    proof = no_collision("separate 0 1 face +");
  EXPECT_EQ(outcome(above + separation("-1", "l2") + proof), "11: a distance below 0");
  EXPECT_EQ(outcome(above + separation("-1/1000", "linf") + proof), "11: a distance below 0");
  EXPECT_EQ(outcome(above + separation("-0x0p+0", "l2") + proof), "no_collision");
  EXPECT_EQ(outcome(above + separation("1", "l1") + proof), "11: unknown word: 'l1'");
  EXPECT_EQ(outcome(above + "separation 1\n" + proof), "11: the line has too few words");
  EXPECT_EQ(outcome(above + "separation l2\n" + proof), "11: not a number: 'l2'");
  EXPECT_EQ(outcome(above + separation("1", "l2 l2") + proof), "11: the line has too many words");
  EXPECT_EQ(outcome(above + separation("1", "l2") + separation("0", "l2") + proof),
            "12: expected 'claim', found 'separation'");
}

/// The coordinates' denominators are 3, the distance's 7.
TEST(Distance, IsEnlargedWithTheCoordinates) {
  const std::string above = over_triangle("1 1 1/3", "1 1 2/3");
  for (const std::string_view norm : {"linf", "l2"}) {
    for (const std::string_view feature : {"face +", "axis z +"}) {
      const std::string proof = no_collision("separate 0 1 " + std::string(feature));
      EXPECT_EQ(outcome(above + separation("2/7", norm) + proof), "no_collision");
      EXPECT_EQ(outcome(above + separation("3/7", norm) + proof), not_positive);
    }
  }
}

TEST(Distance, InL2IsThatOfTheDirectionsLength) {
  // (−3,−4,12) is 13 from the corner: its own direction; the others are farther.
  const std::string beside = over_triangle("-3 -4 12", "-3 -4 12");
  const std::string vertex = no_collision("separate 0 1 vertex 0");
  EXPECT_EQ(outcome(beside + separation("12.9", "l2") + vertex).substr(0, 2), "11");
  EXPECT_EQ(outcome(beside + separation("129/10", "l2") + vertex), "no_collision");
  EXPECT_EQ(outcome(beside + separation("13", "l2") + vertex), not_positive);
  EXPECT_EQ(outcome(beside + separation("129/10", "l2") + no_collision("separate 0 1 axis z +")),
            not_positive);
  EXPECT_EQ(outcome(beside + separation("119/10", "l2") + no_collision("separate 0 1 axis z +")),
            "no_collision");
  // (2,−3,4) is 5 from the side.
  const std::string side = over_triangle("2 -3 4", "2 -3 4");
  const std::string edge = no_collision("separate 0 1 edge 0 1");
  EXPECT_EQ(outcome(side + separation("49/10", "l2") + edge), "no_collision");
  EXPECT_EQ(outcome(side + separation("5", "l2") + edge), not_positive);
}

TEST(Distance, InLinfIsThatOfTheSumOfComponents) {
  // From (1,1,1) to a point at the origin: 1 in linf, though the corner's direction reaches √3.
  const std::string corner =
      vertex_face({"1 1 1", "0 0 0", "0 0 0", "0 0 0"}, {"1 1 1", "0 0 0", "0 0 0", "0 0 0"});
  for (const std::string_view feature : {"vertex 0", "axis x +", "axis y +", "axis z +"}) {
    const std::string proof = no_collision("separate 0 1 " + std::string(feature));
    EXPECT_EQ(outcome(corner + separation("99/100", "linf") + proof), "no_collision");
    EXPECT_EQ(outcome(corner + separation("1", "linf") + proof), not_positive);
  }
  EXPECT_EQ(outcome(corner + separation("17/10", "l2") + no_collision("separate 0 1 vertex 0")),
            "no_collision");
  // Every sign counts: (±1,±1,±1).
  for (const std::string_view at :
       {"-1 1 1", "1 -1 1", "1 1 -1", "-1 -1 1", "1 -1 -1", "-1 1 -1", "-1 -1 -1"}) {
    const std::string v(at);
    const std::string other =
        vertex_face({v, "0 0 0", "0 0 0", "0 0 0"}, {v, "0 0 0", "0 0 0", "0 0 0"});
    const std::string proof = no_collision("separate 0 1 vertex 0");
    EXPECT_EQ(outcome(other + separation("99/100", "linf") + proof), "no_collision");
    EXPECT_EQ(outcome(other + separation("1", "linf") + proof), not_positive);
  }
}

TEST(Distance, AxesAndCrossesHaveTheirSign) {
  const std::string above = over_triangle("1 1 2", "1 1 3");
  for (const std::string_view wrong : {"axis z -", "axis x +", "axis y -", "cross x 0 1",
                                       "cross x 1 0", "cross y 1 0", "cross z 0 1"}) {
    EXPECT_EQ(outcome(above + separation("1", "linf") +
                      no_collision("separate 0 1 " + std::string(wrong))),
              not_positive)
        << wrong;
  }
  // e_y × (w_1 − w_0) = e_y × (−4,0,0) = (0,0,4).
  const std::string one = separation("1", "linf");
  EXPECT_EQ(outcome(above + one + no_collision("separate 0 1 cross y 0 1")), "no_collision");
}

TEST(Distance, ACrossOfACornerWithItselfProvesNothing) {
  const std::string far = over_triangle("100 100 100", "100 100 200");
  for (const std::string_view feature : {"cross x 0 0", "cross y 1 1", "cross z 2 2", "edge 0 0"}) {
    for (const std::string& line : {separation("1", "linf"), separation("0", "linf")}) {
      EXPECT_EQ(outcome(far + line + no_collision("separate 0 1 " + std::string(feature))),
                not_positive);
    }
  }
}

TEST(Distance, MustBeKeptFromEveryCorner) {
  // Two corners 2 and more away, the third 1.
  const std::string leaning =
      vertex_face({"0 0 2", "0 0 0", "4 0 0", "0 4 1"}, {"0 0 2", "0 0 0", "4 0 0", "0 4 1"});
  for (const std::string_view norm : {"linf", "l2"}) {
    EXPECT_EQ(outcome(leaning + separation("1", norm) + no_collision("separate 0 1 axis z +")),
              not_positive);
    EXPECT_EQ(outcome(leaning + separation("3/4", norm) + no_collision("separate 0 1 axis z +")),
              "no_collision");
    // The nearest corner's own direction, which the other ones are not beyond.
    EXPECT_EQ(outcome(leaning + separation("3/2", norm) + no_collision("separate 0 1 vertex 0")),
              not_positive);
  }
}

TEST(Near, AVertex) {
  const std::string beside = over_triangle("-3 -4 16", "-3 -4 8");  // (−3,−4,12) at 1/2
  const auto at = [&](std::string_view distance, const std::string& contact,
                      const std::string& place) {
    return outcome(beside + separation(distance, "l2") + collision(contact, place));
  };
  EXPECT_EQ(at("13", "time 1/2", "vertex 0"), "collision");
  EXPECT_EQ(at("13", "root 1/4 3/4 -1 2", "vertex 0"), "collision");
  EXPECT_EQ(at("13", "time 1/4", "vertex 0"), "13: the place is farther than the distance");
  EXPECT_EQ(at("0x1.9ffffffffffffp+3", "time 1/2", "vertex 0"),
            "13: the place is farther than the distance");
  EXPECT_EQ(at("13", "time 1/2", "vertex 1"), "13: the place is farther than the distance");
  EXPECT_EQ(at("13", "time 1/2", "edge 0 1"), "13: the nearest point is not inside");
  EXPECT_EQ(at("13", "time 1/2", "edge 0 0"), "13: the edge's or the face's direction is 0");
  EXPECT_EQ(at("13", "time 1/2", "face"), "13: the nearest point is not inside");
  // A root that does not belong to it.
  EXPECT_EQ(at("13", "root 1/4 3/4 -3 5", "vertex 0"), not_positive);
  // What is near in l2 is so in linf, and may be proved by the same.
  EXPECT_EQ(outcome(beside + separation("13", "linf") + collision("time 1/2", "vertex 0")),
            "collision");
}

TEST(Near, AnEdge) {
  const std::string beside = over_triangle("2 -3 8", "2 -3 0");  // (2,−3,4) at 1/2
  const auto at = [&](std::string_view distance, const std::string& place) {
    return outcome(beside + separation(distance, "l2") + collision("time 1/2", place));
  };
  EXPECT_EQ(at("5", "edge 0 1"), "collision");
  EXPECT_EQ(at("5", "edge 1 0"), "collision");
  EXPECT_EQ(at("499/100", "edge 0 1"), "13: the place is farther than the distance");
  EXPECT_EQ(at("5", "edge 0 2"), "13: the nearest point is not inside");
  EXPECT_EQ(at("5", "edge 1 2"), "13: the nearest point is not inside");
  // Beyond either end of the side's line.
  for (const std::string_view beyond : {"-1 -3 4", "5 -3 4"}) {
    const std::string v(beyond);
    EXPECT_EQ(
        outcome(over_triangle(v, v) + separation("5", "l2") + collision("time 1/2", "edge 0 1")),
        "13: the nearest point is not inside");
  }
}

TEST(Near, AFace) {
  const std::string falling = over_triangle("1 1 3", "1 1 -1");  // height 1 at 1/2
  const auto at = [&](std::string_view distance, const std::string& contact) {
    return outcome(falling + separation(distance, "l2") + collision(contact, "face"));
  };
  EXPECT_EQ(at("1", "time 1/2"), "collision");
  EXPECT_EQ(at("1", "root 1/4 3/4 -1 2"), "collision");
  EXPECT_EQ(at("1", "time 1/4"), "13: the place is farther than the distance");
  EXPECT_EQ(at("99/100", "time 1/2"), "13: the place is farther than the distance");
  for (const std::string_view beside : {"-1 1 1/2", "1 -1 1/2", "3 3 1/2"}) {
    const std::string v(beside);
    EXPECT_EQ(outcome(over_triangle(v, v) + separation("1", "l2") + collision("time 0", "face")),
              "13: the nearest point is not inside");
  }
  // Without area there is no face, however near.
  const std::string needle =
      vertex_face({"1 0 9", "0 0 0", "4 0 0", "2 0 0"}, {"1 0 9", "0 0 0", "4 0 0", "2 0 0"});
  EXPECT_EQ(outcome(needle + separation("1", "l2") + collision("time 0", "face")),
            "13: the edge's or the face's direction is 0");
  // All four sides of a parallelogram.
  EXPECT_EQ(outcome(crossing("1", "1") + separation("1", "l2") + collision("time 0", "face")),
            "collision");
  const std::array<std::string, 4> past{"2 0 1", "4 0 1", "0 -1 0", "0 1 0"};
  EXPECT_EQ(outcome(edge_edge(past, past) + separation("1", "l2") + collision("time 0", "face")),
            "13: the nearest point is not inside");
}

TEST(Near, AllAxes) {
  const std::string reason = "13: an axis separates, or is not seen not to";
  const std::string falling = over_triangle("1 1 3", "1 1 -1");
  const auto at = [&](std::string_view distance, std::string_view norm, const std::string& time) {
    return outcome(falling + separation(distance, norm) + collision(time, "axes"));
  };
  EXPECT_EQ(at("1", "linf", "time 1/2"), "collision");
  EXPECT_EQ(at("1", "linf", "root 1/4 3/4 -1 2"), "collision");
  EXPECT_EQ(at("1", "linf", "time 3/4"), "collision");
  EXPECT_EQ(at("1", "linf", "time 1/4"), reason);
  EXPECT_EQ(at("99/100", "linf", "time 1/2"), reason);
  EXPECT_EQ(at("1", "linf", "root 1/4 3/4 -3 5"), reason);
  EXPECT_EQ(at("1", "l2", "time 1/2"), "13: axes prove nothing of the distance in l2");
  EXPECT_EQ(at("100", "l2", "time 1/2"), "13: axes prove nothing of the distance in l2");
}

/// One kind of axis alone separates; without it each of these would be accepted.
TEST(Near, NoAxisMayBeLeftOut) {
  const std::string reason = "13: an axis separates, or is not seen not to";
  const auto at_rest = [](const std::array<std::string, 4>& points, std::string_view distance) {
    return outcome(vertex_face(points, points) + separation(distance, "linf") +
                   collision("time 0", "axes"));
  };
  for (const std::string_view beside : {"-2 1 0", "1 -2 0", "1 1 2", "1 1 -2"}) {
    EXPECT_EQ(at_rest({std::string(beside), "0 0 0", "4 0 0", "0 4 0"}, "19/10"), reason);
    EXPECT_EQ(at_rest({std::string(beside), "0 0 0", "4 0 0", "0 4 0"}, "2"), "collision");
  }
  // The plane x + y + z = 0 through a large triangle; (1,1,1) is 1 from it.
  const std::array<std::string, 4> plane{"1 1 1", "20 -10 -10", "-10 20 -10", "-10 -10 20"};
  EXPECT_EQ(at_rest(plane, "99/100"), reason);
  EXPECT_EQ(at_rest(plane, "1"), "collision");
  // A side in x = y of a triangle that leans; (6,2) is 2 from it. For each pair of axes.
  EXPECT_EQ(at_rest({"6 2 -1/4", "0 0 0", "8 8 0", "2 6 -8"}, "19/10"), reason);
  EXPECT_EQ(at_rest({"6 2 -1/4", "0 0 0", "8 8 0", "2 6 -8"}, "2"), "collision");
  EXPECT_EQ(at_rest({"-1/4 6 2", "-8 2 6", "0 0 0", "0 8 8"}, "19/10"), reason);
  EXPECT_EQ(at_rest({"2 -1/4 6", "8 0 8", "6 -8 2", "0 0 0"}, "19/10"), reason);
}

TEST(Near, DistanceZeroIsContact) {
  const std::string through = over_triangle("1 1 1", "1 1 -1");
  for (const std::string& line : {""s, separation("0", "linf")}) {
    const std::string at = line.empty() ? "12" : "13";
    EXPECT_EQ(outcome(through + line + collision("time 1/2", "axes")), "collision");
    EXPECT_EQ(outcome(through + line + collision("time 1/2", "face")), "collision");
    EXPECT_EQ(outcome(through + line + collision("time 1/4", "face")),
              at + ": the place is farther than the distance");
  }
  // And a contact is one at any distance.
  for (const std::string_view norm : {"linf", "l2"}) {
    EXPECT_EQ(outcome(through + separation("1", norm) + collision("time 1/2", "triangle 0 1 2 z")),
              "collision");
  }
}

TEST(Near, ATimeOfImpactNeedsTheSubintervalsAtTheDistance) {
  const std::string falling = over_triangle("1 1 3", "1 1 -1") + separation("1", "l2");
  EXPECT_EQ(
      outcome(falling + time_of_impact("1/4 1/2", "separate 0 1/4 face +\n", "time 1/2", "face")),
      "time_of_impact");
  EXPECT_EQ(
      outcome(falling + time_of_impact("5/8 3/4", "separate 0 5/8 face +\n", "time 3/4", "face")),
      not_positive);
}

// ---- At random, against the oracle --------------------------------------------------------------

/// Certificates whose every part is drawn at random from few small values, so that many prove their
/// claim, most do not, and nearly all cases are degenerate.
class RandomCertificate {
 public:
  explicit RandomCertificate(unsigned seed) : random_(seed) { draw_points(); }

  [[nodiscard]] Kind kind() const { return kind_; }
  [[nodiscard]] const touchstone::Query& points() const { return points_; }
  /// The bounds of a time of impact, in eighths.
  [[nodiscard]] std::array<int, 2> bounds() const { return bounds_; }

  [[nodiscard]] std::string text() {
    std::string result = std::string(tests::certificate_header) + "query " +
                         (kind_ == Kind::vertex_face ? "vertex_face\n" : "edge_edge\n");
    for (std::size_t n = 0; n < 24; ++n) {
      if (n % 3 == 0) result += "point";
      result += " " + std::to_string(static_cast<int>(points_.coordinates.at(n)));
      if (n % 3 == 2) result += "\n";
    }
    const int claim = below(4);
    if (claim == 0) return result + "claim no_collision\n" + subintervals(8) + "end\n";
    if (claim == 1) return result + "claim collision\n" + contact(0, 8) + "end\n";
    bounds_ = {below(4), 0};
    bounds_[1] = bounds_[0] + 1 + below(8 - bounds_[0]);
    if (below(8) == 0) bounds_ = {0, 0};
    result += "claim time_of_impact " + eighths(bounds_[0]) + " " + eighths(bounds_[1]) + "\n";
    if (bounds_[1] > 0) result += subintervals(bounds_[0]);
    return result + contact(bounds_[0], bounds_[1]) + "end\n";
  }

 private:
  int below(int limit) { return std::uniform_int_distribution(0, limit - 1)(random_); }
  static std::string eighths(int n) { return std::to_string(n) + "/8"; }
  std::string corner() { return " " + std::to_string(below(kind_ == Kind::vertex_face ? 3 : 4)); }

  void draw_points() {
    kind_ = below(2) == 0 ? Kind::vertex_face : Kind::edge_edge;
    const int range = 2 + below(3);
    for (double& x : points_.coordinates) x = below(2 * range + 1) - range;
    for (std::size_t n = 0; n < 12; ++n) {
      if (below(3) != 0) points_.coordinates.at(12 + n) = points_.coordinates.at(n);
    }
    if (below(4) == 0) {
      for (std::size_t n = 2; n < 24; n += 3) points_.coordinates.at(n) = 0;
    }
  }

  std::string subintervals(int end) {
    std::string result;
    for (int from = 0; from < end || result.empty();) {
      const int to = below(2) == 0 ? end : from + below(end - from + 1);
      result += "separate " + eighths(from) + " " + eighths(to) + feature() + "\n";
      if (from == to && below(2) == 0) break;
      from = to;
    }
    return result;
  }

  std::string feature() {
    switch (below(3)) {
      case 0:
        return " vertex" + corner();
      case 1:
        return " edge" + corner() + corner();
      default:
        return below(2) == 0 ? " face +" : " face -";
    }
  }

  /// A polynomial of the query.
  exact::Polynomial polynomial() {
    const exact::Motion motion = exact::scale_to_integers(kind_, points_);
    const auto axis = static_cast<std::size_t>(below(3));
    const auto any = [&] {
      return static_cast<std::size_t>(below(static_cast<int>(motion.corner_count)));
    };
    switch (below(4)) {
      case 0:
        return exact::to_polynomial(exact::normal_component(motion, axis));
      case 1:
        return exact::to_polynomial(exact::cross_component(motion, any(), any(), axis));
      default:
        return exact::to_polynomial(exact::determinant(motion));
    }
  }

  /// An interval of eighths in [from, to]; if one is found, one at whose ends g has opposite signs.
  std::array<int, 2> interval(const exact::Polynomial& g, int from, int to) {
    std::array<int, 2> result{};
    for (int trial = 0; trial < 8; ++trial) {
      result[0] = from + below(to - from + 1);
      result[1] = result[0] + below(to - result[0] + 1);
      const auto sign = [&](int n) {
        return exact::AlgebraicNumber(exact::Rational(n, 8)).sign_of(g);
      };
      if (sign(result[0]) * sign(result[1]) < 0) break;
    }
    return result;
  }

  std::string contact(int from, int to) {
    std::string result = "contact time " + eighths(from + below(to - from + 1));
    const exact::Polynomial g = polynomial();
    if (g.degree() > 0 && below(3) != 0) {
      const auto [a, b] = interval(g, from, to);
      result = "contact root " + eighths(a) + " " + eighths(b);
      for (const exact::Integer& x : g.coefficients()) result += " " + x.get_str();
    }
    return result + "\n" + place() + "\n";
  }

  std::string place() {
    if (below(3) == 0) return "at segment" + corner() + corner();
    std::array<int, 4> order{0, 1, 2, 3};
    std::shuffle(order.begin(), order.begin() + (kind_ == Kind::vertex_face ? 3 : 4), random_);
    std::string result = "at triangle";
    for (const std::size_t n : {0U, 1U, 2U}) result += " " + std::to_string(order.at(n));
    return result + std::array{" x", " y", " z"}.at(static_cast<std::size_t>(below(3)));
  }

  std::mt19937 random_;
  Kind kind_ = Kind::vertex_face;
  touchstone::Query points_{};
  std::array<int, 2> bounds_{};
};

/// The sign of toi − n/8.
int compare(exact::AlgebraicNumber toi, int n) {
  return toi.sign_of(exact::Polynomial(exact::Integer(-n), exact::Integer(8)));
}

/// Is an accepted claim true?
bool is_true(const std::string& claim, const RandomCertificate& certificate) {
  const exact::Decision verdict = exact::decide(certificate.kind(), certificate.points());
  if (claim == "no_collision") return !verdict.collides();
  if (!verdict.collides() || claim == "collision") return verdict.collides();
  const auto [lower, upper] = certificate.bounds();
  if (upper == 0) return compare(*verdict.toi, 0) == 0;
  return compare(*verdict.toi, lower) > 0 && compare(*verdict.toi, upper) <= 0;
}

TEST(AtRandom, NoFalseClaimIsAccepted) {
  const unsigned trials = tests::is_soak() ? 2'000'000 : tests::trials(120'000U);
  std::map<std::string, int> accepted;
  for (unsigned seed = 0; seed < trials; ++seed) {
    RandomCertificate certificate(seed);
    const std::string text = certificate.text();
    const std::string result = outcome(text);
    if (result.find(':') != std::string::npos) {
      // Refuted, not misspelt.
      ASSERT_GT(std::stoi(result), 10) << text << result;
      ASSERT_EQ(result.find("expected"), std::string::npos) << text << result;
      continue;
    }
    ++accepted[result + (text.find("root") != std::string::npos ? " at a root" : "")];
    ASSERT_TRUE(is_true(result, certificate)) << text << result;
  }
  // As many as make a wrong rule show itself.
  for (const auto& [claim, least] :
       {std::pair("no_collision", 1'000), std::pair("collision", 200),
        std::pair("collision at a root", 50), std::pair("time_of_impact", 100),
        std::pair("time_of_impact at a root", 10)}) {
    EXPECT_GE(accepted[claim], tests::trials(least)) << claim;
    RecordProperty(claim, accepted[claim]);
  }
}

}  // namespace
}  // namespace touchstone::checker::proof_test
