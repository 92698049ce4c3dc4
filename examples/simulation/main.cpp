// touchstone-simulate: a small simulator with a choice of collision detection.

#include <fmt/format.h>
#include <fmt/ranges.h>

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <exception>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "examples/simulation/collision_detector.hpp"
#include "examples/simulation/recorder.hpp"
#include "examples/simulation/simulated_scene.hpp"
#include "examples/simulation/simulator.hpp"
#include "examples/simulation/tumbling.hpp"
#include "examples/simulation/world.hpp"
#include "verify/io/json.hpp"
#include "verify/io/output_file.hpp"
#include "verify/io/terminal.hpp"
#include "verify/mesh/ply.hpp"
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
  RecorderOptions recorder;
  std::string out;
  std::string json_file;
};

/// Frames FOLDER/000000.ply and so on. A new run replaces those of an earlier one.
class FrameFiles {
 public:
  FrameFiles(const fs::path& folder, const World& world) : folder_(folder), world_(world) {
    if (folder_.empty()) return;
    fs::create_directories(folder_);
    for (const fs::directory_entry& entry : fs::directory_iterator(folder_)) {
      const std::string name = entry.path().filename().string();
      if (entry.path().extension() == ".ply" &&
          name.find_first_not_of("0123456789") == name.size() - 4) {
        fs::remove(entry.path());
      }
    }
  }

  void write(const Eigen::VectorXd& x) {
    const std::uint64_t number = count_++;
    if (folder_.empty()) return;
    const verify::mesh::Vertices vertices = x.reshaped<Eigen::RowMajor>(x.size() / 3, 3);
    verify::mesh::write_ply(folder_ / fmt::format("{:06}.ply", number), vertices, world_.faces());
  }

  [[nodiscard]] std::uint64_t count() const { return count_; }

 private:
  fs::path folder_;
  const World& world_;
  std::uint64_t count_ = 0;
};

nlohmann::json json_of(const Arguments& arguments, const Simulator& simulator,
                       const CollisionDetector& detector, const World& world, std::uint64_t frames,
                       const Recorder* recorder) {
  const SimulatorStatistics& run = simulator.statistics();
  const DetectorStatistics& detection = detector.statistics();
  nlohmann::json result{
      {"scene", arguments.scene},
      {"simulator", arguments.simulator},
      {"method", arguments.detector.method},
      {"tolerance", arguments.detector.tolerance},
      {"max_checks", arguments.detector.max_checks},
      {"missed_one_in", arguments.detector.missed_one_in},
      {"missed_limit", arguments.detector.missed_limit},
      {"vertices", world.coordinates() / 3},
      {"faces", world.faces().size()},
      {"frames", frames},
      {"time_steps", run.time_steps},
      {"iterations", run.iterations},
      {"unfinished", run.unfinished},
      {"stalled", run.stalled},
      {"shortened", run.shortened},
      {"contacts", run.contacts},
      {"calls", detection.calls},
      {"candidates", detection.candidates},
      {"missed", detection.missed},
      {"limited", detection.limited},
      {"steps_of_zero", detection.steps_of_zero},
      {"seconds",
       {{"total", run.total_seconds},
        {"detection", detection.seconds},
        {"linear", run.linear_seconds}}},
  };
  if (recorder != nullptr) {
    for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
      result["recorded"][std::string(to_string(kind))] = {
          {"queries", recorder->queries(kind)}, {"collisions", recorder->collisions(kind)}};
    }
  }
  return result;
}

std::string text_of(const nlohmann::json& result) {
  const auto number = [&](const char* key) { return result.at(key).get<std::uint64_t>(); };
  const nlohmann::json& seconds = result.at("seconds");
  const double total = seconds.at("total").get<double>();
  const auto share = [&](const char* key) { return 100.0 * seconds.at(key).get<double>() / total; };
  std::string text = fmt::format(
      "{}: {} vertices, {} faces; {} time steps in {} iterations, {} frames\n"
      "  seconds          {:.1f}, of them collision detection {:.1f} %, linear systems {:.1f} %\n"
      "  detection        {} calls, {} of them with a step size of 0\n"
      "  unfinished       {} time steps; {} line searches without a lower energy, {} steps "
      "shortened\n",
      result.at("scene").get<std::string>(), number("vertices"), number("faces"),
      number("time_steps"), number("iterations"), number("frames"), total, share("detection"),
      share("linear"), number("calls"), number("steps_of_zero"), number("unfinished"),
      number("stalled"), number("shortened"));
  if (number("missed_one_in") != 0 || number("missed_limit") != 0) {
    text += fmt::format("  missed           {} answers of {} turned into \"no\"\n",
                        number("missed"), number("candidates"));
  }
  if (result.contains("recorded")) {
    for (const auto& [kind, counts] : result.at("recorded").items()) {
      text += fmt::format("  recorded         {} {} queries, {} of them collide\n",
                          counts.at("queries").get<std::uint64_t>(), kind,
                          counts.at("collisions").get<std::uint64_t>());
    }
  }
  return text;
}

/// Runs a scene. \returns the exit status.
int simulate(Arguments arguments) {
  const Scene scene = make_scene(arguments.scene);
  const World world(scene);
  std::unique_ptr<Recorder> recorder;
  if (!arguments.recorder.folder.empty()) {
    arguments.recorder.name = arguments.scene;
    recorder = std::make_unique<Recorder>(arguments.recorder);
    arguments.detector.recorder = recorder.get();
  }
  CollisionDetector detector(arguments.detector);
  const SimulatorOptions options{
      .gravity = scene.gravity,
      .time_step = scene.time_step,
      .activation_distance = arguments.distance.value_or(scene.activation_distance)};
  std::unique_ptr<Simulator> simulator;
  if (arguments.simulator == "barrier") {
    simulator = std::make_unique<BarrierSimulator>(world, detector, options);
  } else {
    simulator = std::make_unique<ConstraintSimulator>(world, detector, options);
  }
  FrameFiles frames(arguments.out, world);
  frames.write(world.start());
  const int steps = arguments.steps > 0 ? arguments.steps : scene.steps;
  verify::io::ProgressBar progress("simulate");
  for (int i = 0; i < steps && !verify::io::interrupted(); ++i) {
    simulator->take_time_step([&](const Eigen::VectorXd& x) { frames.write(x); });
    progress.update(static_cast<double>(i + 1) / steps);
  }
  progress.clear();
  if (recorder) recorder->close();
  const nlohmann::json result =
      json_of(arguments, *simulator, detector, world, frames.count(), recorder.get());
  verify::io::print(stdout, text_of(result));
  if (!arguments.json_file.empty()) {
    verify::io::OutputFile file(arguments.json_file);
    file.write(verify::io::json_document(result));
    file.close();
  }
  return 0;
}

constexpr std::string_view tumbling = "tumbling-cubes";

/// The scene whose motion is curved. \returns the exit status.
int simulate_tumbling(const Arguments& arguments) {
  TumblingOptions options{.folder = arguments.recorder.folder};
  if (arguments.steps > 0) options.steps = arguments.steps;
  const TumblingResult result = tumble(options);
  std::string text =
      fmt::format("{}: {} steps, {} impacts\n", tumbling, options.steps, result.impacts);
  for (const Kind kind : {Kind::vertex_face, Kind::edge_edge}) {
    const auto index = static_cast<std::size_t>(kind);
    text += fmt::format("  {} {} queries on curves, {} of them collide\n", result.queries.at(index),
                        to_string(kind), result.collisions.at(index));
  }
  verify::io::print(stdout, text);
  return 0;
}

/// The methods that answer what a simulator asks.
std::vector<std::string> method_names() {
  std::vector<std::string> names;
  for (const auto& method : verify::solvers::methods()) {
    if (method->info().terms.answers(QueryShape{})) names.emplace_back(method->name());
  }
  return names;
}

std::string scene_list() {
  std::string text = fmt::format(
      "Scenes:\n  {:<16} two rigid cubes on curves; only --steps and --record apply\n", tumbling);
  for (const SceneDescription& scene : scenes())
    text += fmt::format("  {:<16} {}\n", scene.name, scene.what);
  return text;
}

int run(int argc, char** argv) {
  CLI::App app(
      "Simulates a scene with the collision detection of one's choice, and writes each straight "
      "motion.",
      "simulate");
  Arguments arguments;
  std::vector<std::string> names;
  for (const SceneDescription& scene : scenes()) names.emplace_back(scene.name);
  names.emplace_back(tumbling);
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
  app.add_option("--max-checks", arguments.detector.max_checks,
                 "Of methods that search (default 1000000)");
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
  app.add_option("--record", arguments.recorder.folder,
                 "Write all queries with the oracle's truth to a folder")
      ->type_name("FOLDER");
  app.add_option("--record-limit", arguments.detector.record_limit,
                 "Of each motion no more queries of each kind than that, evenly spread")
      ->check(CLI::PositiveNumber);
  app.add_flag("--npy", arguments.recorder.as_npy, "Record as NumPy arrays instead of CSV");
  app.add_option("--json", arguments.json_file, "Write the result as JSON")->type_name("FILE");
  app.footer(scene_list() +
             "\nExit status: 0 all is well, 2 bad input or usage\n\nExample: ./run simulate "
             "torus-on-cone --out /tmp/torus && ./run step /tmp/torus");
  try {
    app.parse(argc, argv);
    if (arguments.scene == tumbling) return simulate_tumbling(arguments);
    return simulate(std::move(arguments));
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
