// touchstone-simulate: a small simulator with a choice of collision detection.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <utility>
#include <vector>

#include "examples/simulation/collision_detector.hpp"
#include "examples/simulation/recorder.hpp"
#include "examples/simulation/simulated_scene.hpp"
#include "examples/simulation/simulator.hpp"
#include "examples/simulation/world.hpp"
#include "verify/io/json.hpp"
#include "verify/io/terminal.hpp"
#include "verify/mesh/ply.hpp"
#include "verify/solvers/published.hpp"
#include "verify/solvers/registry.hpp"

namespace touchstone::simulation {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::string scene;
  std::string simulator = "barrier";
  int steps = 0;
  std::optional<double> distance;
  DetectorOptions detector;
  fs::path record, out;
};

/// Removes the frames FOLDER/000000.ply and so on of an earlier run.
void remove_frames(const fs::path& folder) {
  for (const fs::directory_entry& entry : fs::directory_iterator(folder)) {
    const std::string name = entry.path().filename().string();
    if (entry.path().extension() == ".ply" &&
        name.find_first_not_of("0123456789") == name.size() - 4) {
      fs::remove(entry.path());
    }
  }
}

nlohmann::json json_of(const Arguments& arguments, const Simulator& simulator,
                       const CollisionDetector& detector, std::uint64_t frames) {
  const SimulatorStatistics& run = simulator.statistics();
  const DetectorStatistics& detection = detector.statistics();
  nlohmann::json result{
      {"scene", arguments.scene},
      {"simulator", arguments.simulator},
      {"method", arguments.detector.method},
      {"tolerance", arguments.detector.tolerance},
      {"missed_one_in", arguments.detector.missed_one_in},
      {"missed_limit", arguments.detector.missed_limit},
      {"vertices", simulator.world().coordinates() / 3},
      {"faces", simulator.world().faces().size()},
      {"frames", frames},
      {"time_steps", run.time_steps},
      {"unfinished", run.unfinished},
      {"contacts", run.contacts},
      {"calls", detection.calls},
      {"candidates", detection.candidates},
      {"missed", detection.missed},
      {"limited", detection.limited},
      {"steps_of_zero", detection.steps_of_zero},
      {"seconds", {{"total", run.seconds}, {"detection", detection.seconds}}},
  };
  if (const Recorder* recorder = arguments.detector.recorder; recorder != nullptr) {
    for (const ContactKind kind : {ContactKind::vertex_face, ContactKind::edge_edge}) {
      result["recorded"][std::string(to_string(kind))] = {
          {"queries", recorder->queries(kind)}, {"collisions", recorder->collisions(kind)}};
    }
  }
  return result;
}

/// Runs a scene of the list.
void simulate(Arguments arguments) {
  Scene scene = std::ranges::find(scenes(), arguments.scene, &SceneDescription::name)->make();
  if (arguments.distance) scene.activation_distance = *arguments.distance;
  const int steps = arguments.steps > 0 ? arguments.steps : scene.steps;
  std::optional<Recorder> recorder;
  if (!arguments.record.empty())
    arguments.detector.recorder = &recorder.emplace(arguments.record, arguments.scene);
  CollisionDetector detector(arguments.detector);
  Simulator simulator(
      std::move(scene), detector,
      arguments.simulator == "barrier" ? ContactModel::barrier : ContactModel::constraint);
  if (!arguments.out.empty()) {
    fs::create_directories(arguments.out);
    remove_frames(arguments.out);
  }
  std::uint64_t frames = 0;
  const auto write = [&](const Eigen::VectorXd& x) {
    const std::string name = fmt::format("{:06}.ply", frames++);
    if (arguments.out.empty()) return;
    const verify::mesh::Vertices vertices = x.reshaped<Eigen::RowMajor>(x.size() / 3, 3);
    verify::mesh::write_ply(arguments.out / name, vertices, simulator.world().faces());
  };
  write(simulator.world().start());
  verify::io::ProgressBar progress("simulate");
  for (int i = 0; i < steps && !verify::io::interrupted(); ++i) {
    simulator.take_time_step(write);
    progress.update(static_cast<double>(i + 1) / steps);
  }
  progress.clear();
  if (recorder) recorder->close();
  verify::io::print(stdout,
                    verify::io::json_document(json_of(arguments, simulator, detector, frames)));
}

/// The methods that answer what a simulator asks.
std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (std::string& name : verify::solvers::all_names()) {
    const fast::MethodInfo* const info = verify::solvers::find_info(name);
    if (info == nullptr || info->terms.answers(AnyShape{})) names.push_back(std::move(name));
  }
  return names;
}

std::string scene_list() {
  std::string text = "Scenes:\n";
  for (const SceneDescription& scene : scenes())
    text += fmt::format("  {:<16} {}\n", scene.name, scene.what);
  return text;
}

int run(int argc, char** argv) {
  CLI::App app(
      "Simulates a scene with the collision detection of one's choice, writes each straight "
      "motion, "
      "and prints the result as JSON.",
      "simulate");
  Arguments arguments;
  std::vector<std::string> names;
  for (const SceneDescription& scene : scenes()) names.emplace_back(scene.name);
  app.add_option("scene", arguments.scene, "Which scene")
      ->required()
      ->check(CLI::IsMember(names))
      ->type_name("SCENE");
  app.add_option("--simulator", arguments.simulator, "barrier or constraint (default barrier)")
      ->check(CLI::IsMember({"barrier", "constraint"}))
      ->type_name("NAME");
  const std::vector<std::string> methods = method_names();
  app.add_option(
         "--method", arguments.detector.method,
         fmt::format("Collision detection (default certified): {}", fmt::join(methods, ", ")))
      ->check(CLI::IsMember(methods))
      ->type_name("NAME");
  app.add_option("--tolerance", arguments.detector.tolerance,
                 "Of methods that have one (default 1e-6)")
      ->check(CLI::PositiveNumber);
  app.add_option("--distance", arguments.distance,
                 "Where barriers and constraints begin, in metres")
      ->check(CLI::PositiveNumber);
  app.add_option("--steps", arguments.steps, "Time steps (default: the scene's)")
      ->check(CLI::PositiveNumber);
  app.add_option("--miss", arguments.detector.missed_one_in,
                 "Answer \"no\" to one query in N, on purpose")
      ->type_name("N");
  app.add_option("--miss-limit", arguments.detector.missed_limit,
                 "Answer \"no\" once, on purpose: to the query that limits the N-th step that one "
                 "limits")
      ->type_name("N");
  app.add_option("--out", arguments.out,
                 "Folder of the frames, a PLY file each, for touchstone step")
      ->type_name("FOLDER");
  app.add_option("--record", arguments.record,
                 "Write all queries with the oracle's truth to a folder, as NumPy arrays")
      ->type_name("FOLDER");
  app.add_option("--record-limit", arguments.detector.record_limit,
                 "Of each motion no more queries of each kind than that, evenly spread")
      ->check(CLI::PositiveNumber);
  app.footer(scene_list() +
             "\nExit status: 0 all is well, 2 bad input or usage\n\nExample: ./run simulate "
             "torus-on-cone --out /tmp/torus && ./run step /tmp/torus");
  try {
    app.parse(argc, argv);
    simulate(std::move(arguments));
    return 0;
  } catch (const CLI::ParseError& error) {
    return app.exit(error) == 0 ? 0 : 2;
  } catch (const std::exception& error) {
    fmt::print(stderr, "simulate: {}\n", error.what());
    return 2;
  }
}

}  // namespace
}  // namespace touchstone::simulation

int main(int argc, char** argv) { return touchstone::simulation::run(argc, argv); }
