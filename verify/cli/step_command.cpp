// touchstone step: the collisions in the steps of a simulation.

#include <fmt/format.h>

#include <algorithm>
#include <filesystem>
#include <functional>
#include <memory>
#include <nlohmann/json.hpp>
#include <optional>
#include <stdexcept>
#include <string>
#include <string_view>
#include <utility>
#include <vector>

#include "touchstone/intersections.hpp"
#include "verify/cli/commands.hpp"
#include "verify/cli/files.hpp"
#include "verify/cli/option_table.hpp"
#include "verify/cli/options.hpp"
#include "verify/cli/result_files.hpp"
#include "verify/cli/sources.hpp"
#include "verify/io/json.hpp"
#include "verify/io/printable.hpp"
#include "verify/io/terminal.hpp"
#include "verify/jobs/check_step.hpp"
#include "verify/mesh/frames.hpp"
#include "verify/report/step_report.hpp"

namespace touchstone::verify::cli::step_command {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::vector<fs::path> frames;
  SeparationArguments separation;
  jobs::StepCheckOptions check;
  GroupArguments groups;
  bool no_intersections = false;
  std::string json_file;
  std::string csv_file;
  std::string proof_file;
  std::string view_file;
};

/// A run: the steps in order.
class StepRun {
 public:
  explicit StepRun(const Arguments& arguments)
      : json_(files_, arguments.json_file),
        csv_(files_, arguments.csv_file, report::step_csv_header()),
        proof_(files_, arguments.proof_file, exact::step_certificates_header()),
        view_(files_, arguments.view_file),
        find_intersections_(!arguments.no_intersections),
        options_(arguments.check),
        frames_(open_frames(files_, arguments.frames)) {
    if (frames_->count() < 2) {
      throw std::runtime_error(arguments.frames.front().string() +
                               ": one frame only; a step needs two (touchstone intersections: does "
                               "a mesh intersect itself?)");
    }
    const mesh::Mesh& mesh = frames_->mesh();
    options_.step.solve.separation = arguments.separation.given();
    NamedGroups groups =
        collision_groups(files_, arguments.groups, mesh, arguments.separation.given().norm);
    options_.step.groups = std::move(groups.rules);
    options_.step.stop = &io::interrupted();
    options_.find_contacts = json_ || csv_;
    report_ = {.separation = options_.step.solve.separation,
               .group_names = std::move(groups.names),
               .groups = options_.step.groups,
               .question = options_.question,
               .alpha = options_.alpha,
               .vertices = static_cast<std::size_t>(mesh.vertices.rows()),
               .edges = mesh.edges,
               .faces = mesh.faces,
               .tetrahedra = mesh.tetrahedra,
               .frames = {},
               .steps = {}};
  }

  Status run() {
    io::ProgressBar bar("step");
    const std::size_t count = frames_->count();
    mesh::Vertices before;
    const auto has_results = [this] { return !report_.steps.empty(); };
    until_stopped(files_, has_results, [&] {
      for (std::size_t i = 0; i < count && !is_stopped(); ++i) {
        mesh::Vertices after = frames_->next();
        check_frame(i, after);
        const auto progress = [&](double fraction) {
          bar.update((static_cast<double>(i) + 0.5 + 0.5 * fraction) / static_cast<double>(count));
        };
        progress(0.0);
        if (i > 0) check_step(i, before, after, progress);
        before = std::move(after);
        progress(1.0);
      }
    });
    bar.clear();
    report_.interrupted = report_.steps.size() + 1 < count;
    return finish();
  }

 private:
  void check_frame(std::size_t i, const mesh::Vertices& vertices) {
    report::FrameRecord frame{.name = frames_->name(i), .intersections = {}, .time = {}};
    if (find_intersections_)
      frame.time = jobs::work_time_of([&] { frame.intersections = intersections_of(vertices); });
    report_.frames.push_back(std::move(frame));
  }

  [[nodiscard]] std::vector<fast::Intersection> intersections_of(
      const mesh::Vertices& vertices) const {
    const mesh::Mesh& mesh = frames_->mesh();
    return fast::intersections(vertices, mesh,
                               {.groups = options_.step.groups,
                                .most = report::most_intersections + 1,
                                .places = false,
                                .max_threads = options_.step.solve.max_threads,
                                .stop = options_.step.stop});
  }

  void check_step(std::size_t i, const mesh::Vertices& before, const mesh::Vertices& after,
                  const std::function<void(double)>& progress) {
    if (proof_) ask_for_proof(i, progress);
    report_.steps.push_back(jobs::check_step(step_, frames_->mesh(), before, after, options_));
    if (csv_) csv_.write(report::step_csv_rows(report_, i - 1));
    view_step(i, before, after);
  }

  /// The page shows the first step with a collision, or else the first step.
  void view_step(std::size_t i, const mesh::Vertices& before, const mesh::Vertices& after) {
    const bool is_free = report_.steps.back().is_free;
    if (!view_ || shows_contact_ || (is_free && i > 1)) return;
    shows_contact_ = !is_free;
    std::string label = fmt::format("{} to {}", frames_->name(i - 1), frames_->name(i));
    if (const auto& earliest = report_.steps.back().earliest) {
      for (const fast::StepInversion& one : earliest->inversions) {
        label += fmt::format("; {} {} inverts at t = {:.6g}", to_string(one.kind), one.cell,
                             one.toi_upper);
      }
    }
    view_.add(view::find_collisions(std::move(label), frames_->mesh(), before, after, options_.step,
                                    options_.alpha));
  }

  void ask_for_proof(std::size_t i, const std::function<void(double)>& progress) {
    options_.proof = {
        .label = io::printable(frames_->name(i - 1)) + ' ' + io::printable(frames_->name(i)),
        .max_threads = options_.step.solve.max_threads,
        .on_text =
            [this](std::string_view text) {
              proof_.write(text);
              // An exception ends the proof immediately; the failure was already reported.
              if (proof_.failed()) throw std::runtime_error("the proof cannot be written");
            },
        .on_progress = progress,
        .stop = &io::interrupted()};
  }

  /// A failed proof of a step ends the run, because the later proofs would not be read.
  [[nodiscard]] bool is_stopped() const { return io::interrupted() || lacks_proof(); }
  [[nodiscard]] bool lacks_proof() const {
    return !report_.steps.empty() && report_.steps.back().proof &&
           !report_.steps.back().proof->is_complete();
  }

  Status finish() {
    if (proof_) {
      if (lacks_proof() || report_.interrupted) {
        proof_.close_incomplete();
      } else {
        proof_.complete(exact::step_certificates_closing_line(report_.steps.size()));
      }
    }
    json_.complete_with([this] { return io::json_document(report::to_json(report_)); });
    csv_.close();
    view_.write();
    io::print(files_.summary_stream(), report::to_text(report_) + view_.summary());
    if (io::interrupted()) return Status::interrupted;
    if (lacks_proof() || files_.has_failed()) return Status::bad_input;
    return report::has_collisions(report_) ? Status::wrong_answers : Status::all_well;
  }

  Files files_;
  Output json_;
  Output csv_;
  Output proof_;
  ViewFile view_;
  bool shows_contact_ = false;
  bool find_intersections_;
  jobs::StepCheckOptions options_;
  std::unique_ptr<mesh::Frames> frames_;
  std::optional<fast::Step> step_;  ///< the last one
  report::StepReport report_;
};

void add_input_options(Command& command, Arguments& arguments) {
  begin_group(command, "Input");
  add_option(command, "frames", arguments.frames);
  add_separation_options(command, arguments.separation);
  add_group_options(command, arguments.groups);
  add_thickness_options(command, arguments.groups);
}

void add_step_options(Command& command, Arguments& arguments) {
  begin_group(command, "Question");
  jobs::StepQuestion& question = arguments.check.question;
  const auto asks = [&question](jobs::StepQuestion asked) {
    return std::function<void()>([&question, asked] { question = asked; });
  };
  add_option(command, "--all", asks(jobs::StepQuestion::all));
  add_option(command, "--earliest", asks(jobs::StepQuestion::earliest));
  add_option(command, "--free", asks(jobs::StepQuestion::free));
  add_option(command, "--candidates", arguments.check.count_candidates);
  add_option(command, "--no-intersections", arguments.no_intersections);
  add_option(command, "--t-max", arguments.check.step.solve.t_max);
  add_option(command, "--alpha", arguments.check.alpha);
  add_option(command, "--threads", arguments.check.step.solve.max_threads);
  begin_group(command, "Output");
  add_option(command, "--csv", arguments.csv_file);
  add_option(command, "--prove", arguments.proof_file);
  add_option(command, "--json", arguments.json_file);
  add_option(command, "--view", arguments.view_file);
}

}  // namespace

void add(Command& app, Status& status) {
  const auto arguments = std::make_shared<Arguments>();
  Command* command =
      add_command(app, "step", "Find the collisions in the steps of a simulation, exactly");
  add_input_options(*command, *arguments);
  add_step_options(*command, *arguments);
  set_help(
      *command,
      "touchstone step frames/92.ply frames/93.ply --csv pairs.csv\n"
      "touchstone step frames/ --earliest --json steps.json\n"
      "touchstone step frames/ --free --prove steps.cert && touchstone-check steps.cert",
      "A step is the straight motion of every vertex from one frame to the next; a simulator "
      "with substeps should write each of them. Each frame is also searched for intersections "
      "(unless --no-intersections is given). Pairs that share a vertex are ignored. The volumes of "
      "tetrahedra (T of an archive) must stay positive. "
      "Numbers begin at 0; edges are numbered by their larger vertex, then by the smaller.\n"
      "Exit status: 0 free of collisions and inversions, 1 one of these or a frame that intersects "
      "itself, 2 "
      "bad input or usage, 130 interrupted (results so far are written).");
  set_action(*command, [arguments, &status] { status = StepRun(*arguments).run(); });
}

}  // namespace touchstone::verify::cli::step_command
