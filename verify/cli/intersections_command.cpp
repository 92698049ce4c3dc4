// touchstone intersections: the elements of meshes at rest that meet other than in what they share.

#include <algorithm>
#include <filesystem>
#include <memory>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

#include "touchstone/intersections.hpp"
#include "touchstone/scene_certificate.hpp"
#include "touchstone/step.hpp"
#include "verify/cli/commands.hpp"
#include "verify/cli/files.hpp"
#include "verify/cli/option_table.hpp"
#include "verify/cli/options.hpp"
#include "verify/cli/result_files.hpp"
#include "verify/cli/sources.hpp"
#include "verify/io/json.hpp"
#include "verify/io/printable.hpp"
#include "verify/io/terminal.hpp"
#include "verify/jobs/work_time.hpp"
#include "verify/mesh/frames.hpp"
#include "verify/mesh/mesh_file.hpp"
#include "verify/report/step_report.hpp"
#include "verify/view/step_facts.hpp"

namespace touchstone::verify::cli::intersections_command {
namespace {

namespace fs = std::filesystem;

struct Arguments {
  std::vector<fs::path> meshes;
  GroupArguments groups;
  bool weld = false;
  std::size_t most = report::most_intersections;
  int threads = 0;
  std::string csv_file;
  std::string json_file;
  std::string proof_file;
  std::string view_file;
};

report::RestingMesh read(Files& files, const fs::path& path) {
  files.add_input(path);
  const bool is_archive = path.extension() == ".npz";
  report::RestingMesh result{
      .name = path.string(),
      .mesh = is_archive ? mesh::open_frames({path})->mesh() : mesh::read_mesh(path)};
  report_note(path, result.mesh.note);
  mesh::require_elements(result.mesh, path);
  result.defects = fast::mesh_defects(result.mesh.vertices, result.mesh);
  const fast::Step at_rest(result.mesh.vertices, result.mesh.vertices,
                           {.tetrahedra = result.mesh.tetrahedra});
  result.inversions = at_rest.inversions();
  return result;
}

std::string names_of(const report::IntersectionReport& report) {
  std::string names;
  for (const report::RestingMesh& mesh : report.meshes) {
    names += (names.empty() ? "" : " ") + io::printable(mesh.name);
  }
  return names;
}

/// Writes the certificate. \returns what is missing in the proof; empty if there is one.
std::string prove(Output& file, const mesh::Mesh& mesh, const fast::IntersectionOptions& search,
                  const report::IntersectionReport& report) {
  if (report.is_cut) {
    file.close_incomplete();
    return "more pairs intersect than are told (--most N)";
  }
  io::ProgressBar bar("prove");
  const exact::SceneProof proof =
      exact::prove_mesh(mesh.vertices, mesh, search,
                        {.label = names_of(report),
                         .max_threads = search.max_threads,
                         .on_text = [&file](std::string_view text) { file.write(text); },
                         .on_progress = [&bar](double fraction) { bar.update(fraction); },
                         .stop = search.stop});
  bar.clear();
  if (proof.is_complete()) {
    file.complete(exact::mesh_certificates_closing_line(1));
  } else {
    file.close_incomplete();
  }
  return proof.failure;
}

Status intersections(const Arguments& arguments) {
  Files files;
  Output json(files, arguments.json_file), csv(files, arguments.csv_file);
  Output certificate(files, arguments.proof_file, exact::mesh_certificates_header());
  ViewFile view(files, arguments.view_file);
  report::IntersectionReport report{
      .meshes = {}, .intersections = {}, .weld = arguments.weld, .apart = arguments.groups.apart};
  for (const fs::path& path : arguments.meshes) report.meshes.push_back(read(files, path));
  const mesh::Mesh all = report::joined(report.meshes);
  const fast::IntersectionOptions search{
      .groups = collision_groups(files, arguments.groups, all, Norm::l2, arguments.weld).rules,
      .weld = arguments.weld,
      .most = arguments.most + 1,
      .max_threads = arguments.threads,
      .stop = &io::interrupted()};
  std::string failure;
  report.interrupted = true;
  until_interrupted([&] {
    const jobs::WorkTime time = jobs::work_time_of(
        [&] { report.intersections = fast::intersections(all.vertices, all, search); });
    report.seconds = time.wall;
    report.is_cut = report.intersections.size() > arguments.most;
    if (report.is_cut) report.intersections.pop_back();
    report.interrupted = false;
  });
  json.complete_with([&] { return io::json_document(report::to_json(report)); });
  csv.complete_with([&] { return report::to_csv(report); });
  const auto has_results = [] { return true; };
  until_stopped(files, has_results, [&] {
    if (certificate && !report.interrupted) failure = prove(certificate, all, search, report);
  });
  if (report.interrupted) certificate.close_incomplete();
  until_stopped(files, has_results, [&] {
    if (!view) return;
    const std::string rules = report::rules_text(report);
    view.add(view::resting_facts(
        names_of(report) + (rules.empty() ? "" : " (" + rules + ")"), all, report.intersections,
        [&](const fast::Intersection& one) { return report::pair_text(report.meshes, one); }));
  });
  view.write();
  io::print(files.summary_stream(), report::to_text(report) + view.summary());
  if (!failure.empty()) report_error("no proof: " + failure);
  if (files.has_failed() || !failure.empty()) return Status::bad_input;
  if (io::interrupted()) return Status::interrupted;
  const bool is_well = report.intersections.empty() &&
                       std::ranges::all_of(report.meshes, [](const report::RestingMesh& mesh) {
                         return mesh.inversions.empty();
                       });
  return is_well ? Status::all_well : Status::wrong_answers;
}

void add_options(Command& command, Arguments& arguments) {
  begin_group(command, "Input");
  add_option(command, "meshes", arguments.meshes);
  add_group_options(command, arguments.groups);
  add_option(command, "--weld", arguments.weld);
  add_option(command, "--most", arguments.most);
  add_option(command, "--threads", arguments.threads);
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
      add_command(app, "intersections", "Find where a mesh intersects itself or others, exactly");
  add_options(*command, *arguments);
  set_help(*command,
           "touchstone intersections bunny.obj --csv pairs.csv --view pairs.html\n"
           "touchstone intersections bunny.obj --prove bunny.cert && touchstone-check bunny.cert\n"
           "touchstone intersections cloth.ply body.ply --apart body.ply body.ply",
           "Faces, edges of no face and points without an edge intersect if they have a common "
           "point beyond their common vertices, or are duplicates. With several meshes, each is a "
           "group with the name of its file. With --weld, elements are found after the vertices "
           "are one. Numbers begin at 0; edges are numbered by their "
           "larger vertex, then by the smaller.\n"
           "Of an archive, the first frame is taken, and flat and inverted tetrahedra are named.\n"
           "Exit status: 0 free of intersections, 1 an intersection or such a tetrahedron, 2 bad "
           "input or usage, 130 "
           "interrupted.");
  set_action(*command, [arguments, &status] { status = intersections(*arguments); });
}

}  // namespace touchstone::verify::cli::intersections_command
