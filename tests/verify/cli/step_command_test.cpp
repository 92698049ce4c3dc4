#include <gtest/gtest.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <span>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/built_files.hpp"
#include "tests/support/simulation_steps.hpp"
#include "tests/support/tool_test.hpp"
#include "touchstone/step.hpp"

// Tests of `touchstone step` that run the tool.

namespace touchstone::verify::cli::step_command_test {
namespace {

using Json = nlohmann::json;
using tests::contains;
using tests::Outcome;
using tests::read_file;

/// A resting triangle in the plane z=0, and another above it at height `z`.
std::string two_triangles(const std::string& z) {
  return "o floor\nv 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\no falling\nv 1 1 " + z + "\nv 2 1 " + z +
         "\nv 1 2 " + z + "\nf 4 5 6\n";
}

class StepCommand : public tests::ToolTest {
 protected:
  [[nodiscard]] Outcome step(std::vector<std::string> arguments) const {
    arguments.insert(arguments.begin(), "step");
    return run(arguments);
  }

  /// Expects the time of impact of a step in its enclosure, which is small.
  static void expect_toi(const Json& step, double toi) {
    EXPECT_LE(step["toi_lower"], toi);
    EXPECT_GE(step["toi_upper"], toi);
    EXPECT_LE(step["toi_upper"].get<double>() - step["toi_lower"].get<double>(), 1e-11);
  }

  /// The JSON of a run, and its status.
  [[nodiscard]] Json result(std::vector<std::string> arguments, int status) const {
    arguments.insert(arguments.end(), {"--json", path("result.json")});
    const Outcome outcome = step(arguments);
    EXPECT_EQ(outcome.status, status) << outcome.out << outcome.err;
    return Json::parse(read_file(path("result.json")));
  }

  [[nodiscard]] std::string above(const std::string& name, const std::string& z) const {
    return write(name, two_triangles(z));
  }
};

TEST_F(StepCommand, FindsContactsAndTheirTimes) {
  const std::string before = above("0.obj", "1"), after = above("1.obj", "-3");
  const Outcome outcome = step({before, after, "--csv", path("pairs.csv")});
  EXPECT_EQ(outcome.status, 1) << outcome.err;
  EXPECT_TRUE(contains(outcome.out, "0.obj - 1.obj")) << outcome.out;
  EXPECT_TRUE(contains(outcome.out, "vertex 3, face 0 (0 1 2)")) << outcome.out;
  std::istringstream rows(read_file(path("pairs.csv")));
  std::string row;
  std::getline(rows, row);
  EXPECT_EQ(row, "step,frame0,frame1,kind,first,second,toi_lower,toi_upper,u,v");
  std::vector<std::string> found;
  while (std::getline(rows, row)) found.push_back(row);
  // The three vertices fall through the face; the edge between two of them ends on an edge of the
  // floor.
  ASSERT_GE(found.size(), 3U);
  EXPECT_TRUE(found[0].starts_with("0,0.obj,1.obj,vertex-face,3,0,0.2")) << found[0];
  EXPECT_TRUE(found[0].ends_with(",0.25,0.25")) << found[0];
  EXPECT_TRUE(found[1].starts_with("0,0.obj,1.obj,vertex-face,4,0,0.2")) << found[1];
  EXPECT_TRUE(found[1].ends_with(",0.5,0.25")) << found[1];
  EXPECT_TRUE(found[2].ends_with(",0.25,0.5")) << found[2];
}

TEST_F(StepCommand, WritesEachStepAsJson) {
  const Json all = result({above("0.obj", "1"), above("1.obj", "0.5"), above("2.obj", "-3.5")}, 1);
  ASSERT_EQ(all["steps"].size(), 2U);
  const Json& first = all["steps"][0];
  EXPECT_EQ(first["frames"], (Json{"0.obj", "1.obj"}));
  EXPECT_EQ(first["free"], true);
  EXPECT_EQ(first["candidates"]["vertex_face"], 0);
  EXPECT_EQ(first["collisions"]["edge_edge"], 0);
  EXPECT_TRUE(first["toi_lower"].is_null());
  EXPECT_EQ(first["pierced"], 0);
  const Json& second = all["steps"][1];
  EXPECT_EQ(second["free"], false);
  EXPECT_EQ(second["candidates"]["vertex_face"], 3);
  EXPECT_EQ(second["collisions"]["vertex_face"], 3);
  expect_toi(second, 0.125);
  for (const char* const clock : {"seconds", "processor_seconds"}) {
    const double broad = second[clock]["broad_phase"], narrow = second[clock]["narrow_phase"];
    EXPECT_GT(broad, 0.0);
    EXPECT_EQ(second[clock]["total"], broad + narrow);
  }
}

TEST_F(StepCommand, AnswersWhatIsAsked) {
  const std::string before = above("0.obj", "1"), after = above("1.obj", "-3");
  const Json earliest = result({before, after, "--earliest"}, 1)["steps"][0];
  expect_toi(earliest, 0.25);
  EXPECT_TRUE(earliest["collisions"].is_null());
  EXPECT_TRUE(earliest["candidates"].is_null());
  const Json counted = result({before, after, "--earliest", "--candidates"}, 1)["steps"][0];
  EXPECT_EQ(counted["candidates"]["vertex_face"], 3);
  EXPECT_GE(earliest["earliest"].size(), 3U);
  const Json free = result({before, after, "--free"}, 1)["steps"][0];
  EXPECT_EQ(free["free"], false);
  EXPECT_TRUE(free["toi_lower"].is_null());
  EXPECT_EQ(result({before, above("up.obj", "1.5"), "--free"}, 0)["steps"][0]["free"], true);
  EXPECT_EQ(result({before, after, "--t-max", "0.2"}, 0)["steps"][0]["free"], true);
  const Json near = result({before, after, "--t-max", "0.2", "--min-separation", "0.5"}, 1);
  expect_toi(near["steps"][0], 0.125);
  EXPECT_EQ(step({before, after, "--free", "--earliest"}).status, 2);
}

// The face is at z=0 and the triangle at 1 - 4 alpha, which is exact in doubles.
TEST_F(StepCommand, JudgesTheStepThatIsTaken) {
  const std::string before = above("0.obj", "1"), after = above("1.obj", "-3");
  const Json free = result({before, after, "--alpha", "0.2"}, 0);
  EXPECT_EQ(free["alpha"], 0.2);
  EXPECT_EQ(free["steps"][0]["free"], true);
  EXPECT_EQ(free["steps"][0]["free_alpha"], std::nextafter(0.25, 0.0));
  const Json colliding = result({before, after, "--alpha", "0.25"}, 1);
  expect_toi(colliding["steps"][0], 1.0);
  EXPECT_EQ(colliding["steps"][0]["free_alpha"], std::nextafter(0.25, 0.0));
  EXPECT_EQ(step({before, after, "--alpha", "1.5"}).status, 2);
}

// A face of one vertex, or an edge from a vertex to itself, is a point of the mesh.
TEST_F(StepCommand, FacesAndEdgesOfOneVertexArePoints) {
  const std::string face = write("face.obj", "v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 1 1\nl 1 2\n");
  EXPECT_EQ(step({face, face}).status, 0);
  for (const std::string point : {"l 4 4", "p 4", "f 4 4 4"}) {
    const auto at = [&](const std::string& name, const std::string& z) {
      return write(name,
                   "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0.25 0.25 " + z + "\nf 1 2 3\n" + point + "\n");
    };
    const std::string proof = path("steps.cert");
    expect_toi(result({at("0.obj", "1"), at("1.obj", "-3"), "--prove", proof}, 1)["steps"][0],
               0.25);
    EXPECT_EQ(finish(start({proof}, to_file, tests::checker_program())).status, 0) << point;
  }
  // The library finds the contact of the vertex as an edge and as a point.
  const std::array<double, 12> before{0, 0, 0, 1, 0, 0, 0, 1, 0, 0.25, 0.25, 1};
  std::array<double, 12> after = before;
  after.back() = -3;
  const std::vector<fast::Face> faces{{0, 1, 2}};
  const std::vector<fast::Edge> edges{{0, 1}, {0, 2}, {1, 2}, {3, 3}};
  const std::vector<std::int32_t> points{3};
  const auto earliest = [&](const fast::MeshElements& elements) {
    return fast::Step(std::span<const double>(before), std::span<const double>(after), elements)
        .earliest();
  };
  const auto by_edge = earliest({.edges = edges, .faces = faces, .points = {}});
  ASSERT_TRUE(by_edge);
  EXPECT_EQ(by_edge, earliest({.edges = {}, .faces = faces, .points = points}));
}

// Names are looked up, not searched for.
TEST_F(StepCommand, ReadsManyGroups) {
  std::string text = "v 0 0 0\nv 1 0 0\nv 0 1 0\n";
  for (int i = 0; i < 100'000; ++i) text += "g n" + std::to_string(i) + "\n";
  const std::string mesh = write("groups.obj", text + "f 1 2 3\n");
  EXPECT_EQ(step({mesh, mesh, "--apart", "n99999", "n99999"}).status, 0);
}

TEST_F(StepCommand, LeavesOutGroupsThatAreApart) {
  const std::string before = above("0.obj", "1"), after = above("1.obj", "-3");
  EXPECT_EQ(step({before, after, "--apart", "floor", "falling"}).status, 0);
  EXPECT_EQ(step({before, after, "--apart", "floor", "floor"}).status, 1);
  const std::string groups = write("groups.txt", "a\na\na\nb\nb\nb\n");
  EXPECT_EQ(step({before, after, "--groups", groups, "--apart", "b", "a"}).status, 0);
  const Outcome unknown = step({before, after, "--apart", "floor", "wall"});
  EXPECT_EQ(unknown.status, 2);
  EXPECT_TRUE(contains(unknown.err, R"(no group "wall"; there are: "floor", "falling")"))
      << unknown.err;
}

// The edge is in the face from the start to the end: no contact begins on the way.
TEST_F(StepCommand, FindsAnEdgeThatPiercesAFaceInTheFrames) {
  const auto pierced = [](const std::string& x) {
    return "v 0 0 0\nv 4 0 0\nv 0 4 0\nf 1 2 3\nv " + x + " 1 -1\nv " + x + " 1 1\nl 4 5\n";
  };
  const std::string before = write("0.obj", pierced("1")), after = write("1.obj", pierced("1.5"));
  const Json found = result({before, after}, 1);
  EXPECT_EQ(found["steps"][0]["free"], true);
  EXPECT_EQ(found["steps"][0]["pierced"], 1);
  EXPECT_EQ(found["frames"][0]["pierced"], 1);
  EXPECT_EQ(found["frames"][1]["piercings"], (Json{{3, 0}}));
  const Outcome outcome = step({before, after});
  EXPECT_TRUE(contains(outcome.out, "0.obj: the mesh intersects itself")) << outcome.out;
  EXPECT_TRUE(contains(outcome.out, "edge 3 (3 4), face 0 (0 1 2)")) << outcome.out;
}

TEST_F(StepCommand, KnowsOfCodimensionalParts) {
  const auto scene = [](const std::string& z) {
    return "v 0 0 0\nv 2 0 0\nl 1 2\nv 1 0 " + z + "\nv 2 0 " + z + "\np 3 4\n";
  };
  const Json found =
      result({write("0.obj", scene("1")), write("1.obj", scene("-1"))}, 1)["steps"][0];
  EXPECT_EQ(found["collisions"]["vertex_edge"], 2);
  expect_toi(found, 0.5);
}

TEST_F(StepCommand, RefusesWhatIsNoStep) {
  const std::string frame = above("0.obj", "1");
  const Outcome one = step({frame});
  EXPECT_EQ(one.status, 2);
  EXPECT_TRUE(contains(one.err, "0.obj: one frame only; a step needs two")) << one.err;
  const Outcome other = step({frame, write("1.obj", two_triangles("0") + "f 1 2 4\n")});
  EXPECT_EQ(other.status, 2);
  EXPECT_TRUE(contains(other.err, "is not the same mesh as")) << other.err;
  const Outcome overwritten = step({frame, frame, "--csv", frame});
  EXPECT_EQ(overwritten.status, 2);
  EXPECT_TRUE(contains(overwritten.err, "named for input and output")) << overwritten.err;
}

TEST_F(StepCommand, SaysWhatAVerdictOnFramesMeans) {
  const Outcome outcome = step({above("0.obj", "1"), above("1.obj", "2")});
  EXPECT_EQ(outcome.status, 0);
  EXPECT_TRUE(contains(outcome.out, "substeps")) << outcome.out;
  EXPECT_TRUE(contains(outcome.out, "free")) << outcome.out;
}

TEST_F(StepCommand, ProvesItsStepsToTheChecker) {
  const std::string first = above("0.obj", "2"), second = above("1.obj", "1"),
                    third = above("2.obj", "-3");
  const std::string proof = path("steps.cert");
  const Json steps = result({first, second, third, "--prove", proof}, 1)["steps"];
  EXPECT_EQ(steps[0]["proof"]["claim"], "no_contact 1");
  EXPECT_EQ(steps[1]["proof"]["claim"], "earliest 0x1.fffffffffffffp-3 1/4");
  EXPECT_EQ(steps[1]["proof"]["complete"], true);
  const auto checked = [&](std::vector<std::string> arguments) {
    return finish(start(std::move(arguments), to_file, tests::checker_program()));
  };
  const Outcome accepted = checked({proof});
  EXPECT_EQ(accepted.status, 0) << accepted.out;
  EXPECT_TRUE(contains(accepted.out,
                       "0.obj 1.obj\n6 vertices, 6 edges, 2 faces\nseparation "
                       "0\nclaim no_contact 1\n"))
      << accepted.out;
  // A proof holds for its step only.
  const std::string text = read_file(proof);
  const std::size_t vertices = text.find("vertices"), separation = text.find("separation");
  const std::string scene = write("scene", text.substr(vertices, separation - vertices));
  EXPECT_TRUE(contains(checked({proof, scene}).out, "line"));
  EXPECT_EQ(result({first, second, "--free", "--prove", proof}, 0)["free"], Json());
  EXPECT_EQ(checked({proof, scene}).status, 0);
  ASSERT_EQ(step({first, third, "--t-max", "0.25", "--prove", proof}).status, 0);
  EXPECT_TRUE(contains(checked({proof}).out, "claim no_contact 1/4\n"));
  EXPECT_EQ(checked({proof, scene}).status, 1);
}

// A proof that is interrupted before its first step would prove nothing.
TEST_F(StepCommand, AnInterruptedProofReplacesNone) {
  std::string points;
  for (int i = 0; i < 200'000; ++i)
    points += "v " + std::to_string(i) + " 0 0\np " + std::to_string(i + 1) + "\n";
  const std::string frame = write("points.obj", points),
                    proof = write("steps.cert", "an older proof");
  const Outcome outcome =
      run_interrupted({"step", frame, frame, frame, "--free", "--prove", proof});
  EXPECT_EQ(outcome.status, 130) << outcome.err;
  EXPECT_EQ(read_file(proof), "an older proof");
  EXPECT_FALSE(contains(read_file(proof + ".incomplete"), "\nsteps "));
}

TEST_F(StepCommand, ProvesAtASeparationAndBetweenGroups) {
  const std::string before = above("0.obj", "2"), after = above("1.obj", "-3");
  const std::string proof = path("steps.cert.zst");
  const Outcome apart = step({before, after, "--apart", "floor", "falling", "--prove", proof});
  EXPECT_EQ(apart.status, 0) << apart.err;
  EXPECT_TRUE(contains(apart.out, "proved: no_contact 1")) << apart.out;
  const Outcome near =
      step({before, after, "--min-separation", "0.5", "--norm", "l2", "--prove", proof});
  EXPECT_EQ(near.status, 1) << near.err;
  EXPECT_TRUE(contains(near.out, "proved: earliest 0x1.3333333333333p-2 0x1.3333333333334p-2"))
      << near.out;
  EXPECT_TRUE(read_file(proof).starts_with("\x28\xb5\x2f\xfd"));
  EXPECT_EQ(step({before, after, "--prove", before}).status, 2);
  EXPECT_EQ(step({before, after, "--prove", proof, "--json", proof}).status, 2);
  EXPECT_EQ(step({before, after, "--prove", proof, "--csv", proof}).status, 2);
}

// The published labels determine the whole step: no other pair collides.
TEST_F(StepCommand, FindsExactlyThePublishedCollisions) {
  const std::filesystem::path data = tests::simulation_folder();
  if (data.empty()) GTEST_SKIP() << "public data are missing";
  for (const std::string_view scene : tests::simulation_scenes) {
    const tests::SimulationStep labelled = tests::load_simulation_step(data, scene);
    const auto frames = tests::files_ending(data / scene / "frames", ".ply");
    ASSERT_EQ(frames.size(), 2U);
    const Outcome outcome = step({frames[0], frames[1], "--csv", path("pairs.csv")});
    ASSERT_EQ(outcome.status, 1) << outcome.err;
    std::vector<std::string> expected, found;
    const auto expect = [&](const tests::LabelledPairs& pairs, const std::string& kind) {
      for (std::size_t i = 0; i < pairs.pairs.size(); ++i) {
        const auto [a, b] = pairs.pairs[i];
        if (pairs.collides[i]) {
          expected.push_back(kind + "," + std::to_string(a) + "," + std::to_string(b));
        }
      }
    };
    expect(labelled.vertex_face, "vertex-face");
    expect(labelled.edge_edge, "edge-edge");
    std::istringstream rows(read_file(path("pairs.csv")));
    std::string row;
    std::getline(rows, row);
    while (std::getline(rows, row)) {
      std::istringstream fields(row);
      std::array<std::string, 6> first;
      for (std::string& field : first) std::getline(fields, field, ',');
      found.push_back(first[3] + "," + first[4] + "," + first[5]);
    }
    std::ranges::sort(expected);
    std::ranges::sort(found);
    EXPECT_EQ(found, expected) << scene;
  }
}

}  // namespace
}  // namespace touchstone::verify::cli::step_command_test
