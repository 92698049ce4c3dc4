#include "exact/checker/step.hpp"

#include <gtest/gtest.h>

#include <algorithm>
#include <cstddef>
#include <cstdint>
#include <fstream>
#include <iterator>
#include <sstream>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "exact/checker/checker.hpp"
#include "tests/faults/planted_faults.hpp"
#include "tests/support/built_files.hpp"

// Certificates of steps: what is accepted, and that every falsehood in one is refused.

namespace touchstone::checker::step_test {
namespace {

using Lines = std::vector<std::string>;

/// A triangle that falls towards another, tilted one, and stays above it.
const std::string scene =
    "vertices 6\n0 0 0 0 0 0\n4 0 4 4 0 4\n0 4 0 0 4 0\n1 1 2 1 1 0x1.8p+0\n2 1 3 2 1 "
    "0x1.4p+1\n1 2 2 1 2 0x1.8p+0\nfaces 2\n0 1 2\n3 4 5\nedges 0\npoints 0\ngroups 0\napart 0\n";
const std::string arguments =
    "sweep x\nvertex_face\n3 0 -1 0 1\n4 0\nseparate 0 1 face +\n5 0 -1 0 1\nedge_edge\n2 3 1 0 "
    "-1\n2 4 1 0 -1\n2 5 1 0 -1\nvertex_edge\nvertex_vertex\nend\n";

std::string stream(const std::string& steps, std::size_t count = 1) {
  return "touchstone-steps 1\n" + steps + "steps " + std::to_string(count) + "\n";
}

std::string step(const std::string& of = scene, const std::string& rest = arguments) {
  return "step a label\n" + of + "separation 0 linf\nclaim no_contact 1\n" + rest;
}

/// Why the stream is refused; empty if it is not.
std::string refusal(const std::string& text, const std::string* scenes = nullptr) {
  std::istringstream in(text), given(scenes != nullptr ? *scenes : "");
  const Report report = check(in, {.scenes = scenes != nullptr ? &given : nullptr});
  EXPECT_EQ(report.rejections.size(), report.rejected);
  return report.all_accepted() ? "" : report.rejections.at(0).reason;
}

std::string replaced(std::string text, std::string_view what, std::string_view by) {
  const std::size_t place = text.find(what);
  EXPECT_NE(place, std::string::npos) << what;
  return text.replace(place, what.size(), by);
}

TEST(Step, SaysWhatItProves) {
  std::istringstream in(stream(step()));
  const Report report = check(in);
  ASSERT_EQ(report.steps.size(), 1U);
  EXPECT_EQ(report.steps[0],
            "step a label\n6 vertices, 6 edges, 2 faces\nseparation 0\nclaim no_contact 1\n");
  EXPECT_EQ(report.accepted(), 1U);
}

TEST(Step, MayHaveAnArgumentMoreThanNeeded) {
  EXPECT_EQ(refusal(stream(replaced(step(), "2 4 1 0 -1\n", "2 4 1 0 -1\n0 3 0 -1 0\n"))), "");
}

/// What is altered in the honest certificate, and why the checker then refuses it.
struct Falsehood {
  std::string_view truth, lie, reason;
};

const std::vector<Falsehood>& falsehoods() {
  static const std::string_view apart_not = "the direction separates not",
                                off_range = "not an integer, or out of range: ",
                                no_double = "a number that is not a double";
  static const std::vector<Falsehood> all{
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
      {"faces 2", "faces 4194299", "the scene has too many items"},
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
      // The order of the parts.
      {"sweep x\n", "", "expected 'sweep', found 'vertex_face'"},
      {"vertex_edge\n", "", "expected 'vertex_edge', found 'vertex_vertex'"},
      {"end\n", "", "expected 'end', found 'steps'"},
      {"\nsteps 1", "\nsteps 2", "expected the closing line 'steps 1', found 'steps 2'"}};
  return all;
}

TEST(Step, RefusesEveryFalsehoodWithItsReason) {
  ASSERT_EQ(refusal(stream(step())), "");
  for (const auto& [truth, lie, reason] : falsehoods()) {
    EXPECT_EQ(refusal(replaced(stream(step()), truth, lie)).substr(0, reason.size()), reason)
        << truth << " -> " << lie;
  }
}

/// A vertex that falls along the x axis, from 1, to the side of a face that touches the plane x = 0
/// from below.
std::string of_falling_vertex(std::string_view x_at_end, std::string_view argument) {
  return stream("step falling\nvertices 4\n0 -1 0 0 -1 0\n0 1 0 0 1 0\n-1 0 1 -1 0 1\n1 0 0 " +
                std::string(x_at_end) +
                " 0 0\nfaces 1\n0 1 2\nedges 0\npoints 1\n3\ngroups 0\napart 0\nseparation 0 "
                "linf\nclaim no_contact 1\nsweep x\nvertex_face\n" +
                std::string(argument) + "edge_edge\nvertex_edge\nvertex_vertex\nend\n");
}

TEST(Step, RefusesAContactAtTheEnd) {
  const std::string x = "3 0 1 0 0\n";
  EXPECT_EQ(refusal(of_falling_vertex("0x1p-40", "")), "") << "an axis keeps it apart";
  EXPECT_EQ(refusal(of_falling_vertex("1", x)), "");
  for (const std::string_view end : {"0", "-1"}) {
    EXPECT_EQ(refusal(of_falling_vertex(end, "")), "no argument for vertex_face 3 0");
    EXPECT_EQ(refusal(of_falling_vertex(end, x)), "the direction separates not");
  }
}

/// All certificates of this file that have to be refused.
std::vector<std::string> false_streams() {
  std::vector<std::string> streams;
  for (const auto& [truth, lie, reason] : falsehoods()) {
    streams.push_back(replaced(stream(step()), truth, lie));
  }
  for (const std::string_view end : {"0", "-1"}) {
    streams.push_back(of_falling_vertex(end, ""));
    streams.push_back(of_falling_vertex(end, "3 0 1 0 0\n"));
  }
  return streams;
}

// A checker with a fault accepts what is false: these tests would see it.
TEST(Step, PlantedFaultsAreFound) {
  for (const auto& fault : tests::planted_faults().checker) {
    const auto accepts = [&](const std::string& stream) {
      std::istringstream in(stream);
      return fault.part(in, {}).all_accepted();
    };
    EXPECT_TRUE(accepts(stream(step()))) << fault.name;
    EXPECT_TRUE(std::ranges::any_of(false_streams(), accepts)) << fault.name;
  }
}

TEST(Step, HoldsGroupsApart) {
  const std::string none = "sweep x\nvertex_face\nedge_edge\nvertex_edge\nvertex_vertex\nend\n";
  const std::string groups = "groups 6\n4\n4\n4\n7\n7\n7\napart 1\n7 4\n";
  const std::string apart = replaced(scene, "groups 0\napart 0\n", groups);
  EXPECT_EQ(refusal(stream(step(scene, none))), "no argument for vertex_face 3 0");
  EXPECT_EQ(refusal(stream(step(apart, none))), "");
  EXPECT_NE(refusal(stream(step(replaced(apart, "7 4\n", "7 7\n"), none))), "");
}

// Whoever has the scene can tell that the certificate is about another.
TEST(Step, IsHeldAgainstAScene) {
  const std::string text = stream(step() + step(), 2), twice = scene + scene;
  EXPECT_EQ(refusal(text, &twice), "");
  const std::string in_decimal = replaced(twice, "0x1.8p+0", "3/2");
  EXPECT_EQ(refusal(text, &in_decimal), "") << "the same numbers in other words";
  const std::string once = scene, more = twice + scene;
  EXPECT_NE(refusal(text, &once), "");
  EXPECT_EQ(refusal(text, &more), "not all scenes are proved");
  for (const auto& [truth, other] :
       {std::pair("0x1.8p+0", "0x1.8000000000001p+0"), std::pair("3 4 5", "3 5 4"),
        std::pair("faces 2\n0 1 2\n3 4 5", "faces 3\n0 1 2\n3 4 5\n0 1 5"),
        std::pair("points 0", "points 1\n0"), std::pair("groups 0", "groups 6\n0\n0\n0\n0\n0\n0"),
        std::pair("apart 0", "apart 1\n0 0")}) {
    const std::string another = replaced(twice, truth, other);
    EXPECT_EQ(refusal(text, &another), "the scene is not the one given") << other;
  }
  // A certificate that is true of fewer faces, and accepted without the scene.
  const std::string fewer = replaced(scene, "faces 2\n0 1 2\n3 4 5", "faces 1\n0 1 2");
  const std::string proof =
      step(fewer, "sweep x\nvertex_face\nedge_edge\nvertex_edge\nvertex_vertex\nend\n");
  EXPECT_EQ(refusal(stream(proof)), "");
  EXPECT_EQ(refusal(stream(proof), &scene), "the scene is not the one given");
}

/// The second step of the corpus: the earliest contact, at 1/2.
std::string earliest() {
  std::ifstream file(tests::source_folder() + "/tests/exact/checker/corpus/steps.cert");
  const std::string text{std::istreambuf_iterator<char>(file), {}};
  const std::size_t first = text.find("step and"), last = text.find("step at once");
  return stream(text.substr(first, last - first));
}

TEST(Step, ProvesTheEarliestContact) {
  const std::string text = earliest();
  ASSERT_EQ(refusal(text), "");
  const std::string lower = "0x1.fffffffffffffp-2", below = "0x1.ffffffffffffep-2",
                    above = "0x1.0000000000001p-1";
  const auto with_interval = [&](const std::string& low, const std::string& high) {
    return replaced(text, "claim earliest " + lower + " 1/2", "claim earliest " + low + ' ' + high);
  };
  EXPECT_NE(refusal(with_interval("1/2", above)), "") << "a little later";
  EXPECT_NE(refusal(with_interval(below, lower)), "") << "a little earlier";
  EXPECT_NE(refusal(with_interval(lower, lower)), "");
  EXPECT_NE(refusal(with_interval("0", "0")), "");
  for (const auto& [truth, falsehood] :
       {// These two have a vertex in common, those are held apart: no contacts of the step.
        std::pair("pair vertex_face 3 0", "pair vertex_face 3 1"),
        std::pair("pair vertex_face 3 0\ncontact time 1/2\nat triangle 0 1 2 z",
                  "pair vertex_edge 8 6\ncontact time 1/2\nat vertex 0"),
        std::pair("pair vertex_face 3 0", "pair vertex_face 0 0"),
        std::pair("contact time 1/2", "contact time 1"),
        std::pair("at triangle 0 1 2 z", "at segment 0 1"),
        // Where the groups meet, a point and an edge touch all the time.
        std::pair("apart 1\n0 2", "apart 0")}) {
    EXPECT_NE(refusal(replaced(text, truth, falsehood)), "") << falsehood;
  }
}

// Any line left out, doubled or exchanged with the next: what is accepted still says the same.
TEST(Step, OfWhichALineIsAlteredIsRefused) {
  const std::string text = earliest();
  Lines lines;
  std::istringstream in(text);
  for (std::string line; std::getline(in, line);) lines.push_back(line);
  const auto joined = [](const Lines& some) {
    std::string result;
    for (const std::string& line : some) result += line + '\n';
    return result;
  };
  for (std::size_t i = 0; i < lines.size(); ++i) {
    Lines without = lines, doubled = lines;
    without.erase(without.begin() + std::ptrdiff_t(i));
    doubled.insert(doubled.begin() + std::ptrdiff_t(i), lines[i]);
    EXPECT_NE(refusal(joined(without)), "") << lines[i];
    EXPECT_NE(refusal(joined(doubled)), "") << lines[i];
  }
}

/// Why the stream is refused within limits.
std::string refusal_within(const Options& limits, const std::string& text) {
  std::istringstream in(text);
  const Report report = check(in, limits);
  return report.all_accepted() ? "" : report.rejections.at(0).reason;
}

TEST(Step, LimitsTheComparisonsByItsBytes) {
  const std::string text = stream(step());
  EXPECT_EQ(refusal_within({.max_comparisons_per_byte = 1}, text), "");
  const std::string too_many = "the search for pairs takes too many comparisons";
  EXPECT_EQ(refusal_within({.max_comparisons_per_byte = 0}, text), too_many);
  // 60 points in one place, of groups that are held apart: 60 · 59 / 2 pairs are met, and more
  // nodes.
  std::string vertices, points, groups;
  for (int n = 0; n < 60; ++n) {
    vertices += "0 0 0 0 0 0\n";
    points += std::to_string(n) + '\n';
    groups += "0\n";
  }
  const std::string crowd = "step crowd\nvertices 60\n" + vertices +
                            "faces 0\nedges 0\npoints 60\n" + points + "groups 60\n" + groups +
                            "apart 1\n0 0\nseparation 0 linf\nclaim no_contact 1\nsweep x\n"
                            "vertex_face\nedge_edge\nvertex_edge\nvertex_vertex\nend\n";
  EXPECT_EQ(refusal_within({.max_comparisons_per_byte = 3}, stream(crowd)), "");
  EXPECT_EQ(refusal_within({.max_comparisons_per_byte = 1}, stream(crowd)), too_many);
  // Bytes before the certificate are no bytes of it.
  const std::string before = "# " + std::string(10'000, ' ') + '\n';
  EXPECT_EQ(refusal_within({.max_comparisons_per_byte = 1}, stream(before + crowd)), too_many);
}

TEST(Step, LimitsTheWorkByItsBytes) {
  const std::string too_much = "the proof takes too much work";
  const auto refusal_of = [](const std::string& text, std::int64_t bits, std::int64_t per_byte) {
    return refusal_within({.max_work_bits = bits, .max_step_work_bits_per_byte = per_byte}, text);
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
  const std::string longer = replaced(text, argument, repeated);
  EXPECT_EQ(refusal_of(longer, 10 * bits, 0), too_much);
  EXPECT_EQ(refusal_of(longer, 0, bits), "");
}

TEST(Step, LimitsItsItemsAndArguments) {
  // 6 vertices and 2 faces.
  const std::string text = stream(step()), more = replaced(text, "points 0", "points 1\n0"),
                    too_many = "the scene has too many items";
  EXPECT_EQ(refusal_within({.max_items = 8}, text), "");
  EXPECT_EQ(refusal_within({.max_items = 7}, text), too_many);
  EXPECT_EQ(refusal_within({.max_items = 9}, more), "");
  EXPECT_EQ(refusal_within({.max_items = 8}, more), too_many);
  EXPECT_EQ(refusal_within({.max_arguments = 6}, text), "");
  EXPECT_EQ(refusal_within({.max_arguments = 5}, text), "more than 5 arguments");
}

// ---- Demands ------------------------------------------------------------------------------------

TEST(Step, IsPrintedInOneForm) {
  const std::string zeros(1'100, '0');
  const auto printed = [](const std::string& text) {
    std::istringstream in(text);
    const Report report = check(in);
    return report.steps.empty() ? report.rejections.at(0).reason : report.steps[0];
  };
  const std::string original = stream(step());
  const auto with = [&](const std::string& from, const std::string& to) {
    std::string text = original;
    return text.replace(text.find(from), from.size(), to);
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
    return refusal(replaced(stream(step()), "step a label", "step " + std::string(bytes, 'a')));
  };
  EXPECT_EQ(with_label(1'024), "");
  EXPECT_EQ(with_label(1'025), "more than 1024 bytes in a label");
  EXPECT_EQ(refusal(replaced(stream(step()), "step a label", "step")), "");
}

TEST(Step, ProvesWhatIsDemandedAndNothingElse) {
  const auto refusal_of = [](const std::string& claim, const std::string& separation) {
    std::istringstream in(stream(step()));
    const Report report = check(in, {.claim = claim, .separation = separation});
    return report.all_accepted() ? "" : report.rejections.at(0).reason;
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
  for (const char* const nonsense :
       {"", "free 1", "no_contact", "earliest 1", "collision 0", "no_contact x"}) {
    EXPECT_THROW(static_cast<void>(demanded_claim(nonsense)), Rejection) << nonsense;
  }
  EXPECT_THROW(static_cast<void>(demanded_separation("1", "l1")), Rejection);
  EXPECT_THROW(static_cast<void>(demanded_separation("-1", "l2")), Rejection);
  EXPECT_THROW(static_cast<void>(demanded_separation("nan", "l2")), Rejection);
}

TEST(Step, IsThereWhereItIsDemanded) {
  const std::string none = "touchstone-steps 1\nsteps 0\n";
  std::istringstream any(none), demanded(none);
  EXPECT_TRUE(check(any).all_accepted());
  EXPECT_EQ(check(demanded, {.claim = demanded_claim("free")}).rejections.at(0).reason,
            "there is no certificate of what is demanded");
}

// Who names scenes is told nothing of queries.
TEST(Step, IsNoStreamOfQueriesWhereScenesAreNamed) {
  std::istringstream in("touchstone-certificates 2\ncertificates 0\n"), scenes("");
  const Report report = check(in, {.scenes = &scenes});
  EXPECT_EQ(report.rejected, 1U);
  EXPECT_EQ(report.rejections.at(0).reason,
            "the first line is not 'touchstone-steps 1', as for scenes");
}

}  // namespace
}  // namespace touchstone::checker::step_test
