#include "verify/report/step_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <iterator>
#include <map>
#include <nlohmann/json.hpp>
#include <span>
#include <tuple>
#include <utility>

#include "exact/checker/summary.hpp"
#include "verify/io/csv.hpp"
#include "verify/io/json.hpp"
#include "verify/io/printable.hpp"
#include "verify/io/text_table.hpp"
#include "verify/judge/separation_inference.hpp"

namespace touchstone::verify::report {
namespace {

/// The number of pairs that a text shows of a list.
constexpr std::size_t most_pairs = 10;

/// "  ... and 5 more (WHERE)" about a list of 15 pairs; empty if all are shown.
std::string rest_text(std::size_t all, std::string_view where) {
  if (all <= most_pairs) return "";
  return fmt::format("  ... and {} more ({})\n", all - most_pairs, where);
}

std::uint64_t count_of(const jobs::PairCounts& counts, ContactKind kind) {
  return counts.at(static_cast<std::size_t>(kind));
}

/// Those that touch and are known: all, or those of the earliest impact.
std::vector<fast::StepCollision> known_collisions(const StepRecord& step) {
  if (step.collisions) return *step.collisions;
  return step.earliest ? step.earliest->pairs : std::vector<fast::StepCollision>();
}

/// Likewise the cells that invert.
std::vector<fast::StepInversion> known_inversions(const StepRecord& step) {
  if (step.inversions) return *step.inversions;
  return step.earliest ? step.earliest->inversions : std::vector<fast::StepInversion>();
}

/// The elements of a pair.
auto pair_of(const fast::Intersection& one) {
  return std::tuple(one.elements[0], one.numbers[0], one.elements[1], one.numbers[1]);
}

/// "12", or "> 200000".
std::string intersecting_text(std::size_t pairs) {
  return pairs > most_intersections ? fmt::format("> {}", most_intersections)
                                    : std::to_string(pairs);
}

/// The number of pairs that intersect in one of the two frames or both, if they were searched for.
std::optional<std::size_t> intersecting_in(const StepReport& report, std::size_t step) {
  const auto& before = report.frames.at(step).intersections;
  const auto& after = report.frames.at(step + 1).intersections;
  if (!before || !after) return std::nullopt;
  std::vector<fast::Intersection> all;
  std::ranges::set_union(*before, *after, std::back_inserter(all), {}, pair_of, pair_of);
  return all.size();
}

/// Of a row of step_csv_rows.
constexpr std::size_t step_csv_columns = 23;

std::string_view name_of(jobs::StepQuestion question) {
  switch (question) {
    case jobs::StepQuestion::all:
      return "all";
    case jobs::StepQuestion::earliest:
      return "earliest";
    case jobs::StepQuestion::free:
      return "free";
  }
  return "";
}

// ---- Text ---------------------------------------------------------------------------------------

/// Kinds that have a candidate in some step, and the two of every mesh; none if candidates were not
/// counted.
std::vector<ContactKind> kinds_in(const StepReport& report) {
  std::vector<ContactKind> kinds;
  const auto is_counted = [](const StepRecord& step) { return step.candidates.has_value(); };
  if (!std::ranges::all_of(report.steps, is_counted)) return kinds;
  std::ranges::copy_if(jobs::pair_kinds, std::back_inserter(kinds), [&](ContactKind kind) {
    return kind == ContactKind::vertex_face || kind == ContactKind::edge_edge ||
           std::ranges::any_of(report.steps, [kind](const StepRecord& step) {
             return count_of(*step.candidates, kind) != 0;
           });
  });
  return kinds;
}

std::string step_name(const StepReport& report, std::size_t i) {
  return io::printable(report.frames.at(i).name) + " - " +
         io::printable(report.frames.at(i + 1).name);
}

std::string earliest_text(const StepReport& report, const StepRecord& step) {
  if (step.is_free) return "free";
  if (report.question == jobs::StepQuestion::free) return "not free";
  return fmt::format("{:.6g}", step.earliest->toi_lower);
}

bool has_intersections(const StepReport& report) {
  return std::ranges::all_of(
      report.frames, [](const FrameRecord& frame) { return frame.intersections.has_value(); });
}

io::TextTable table_of(const StepReport& report) {
  const std::vector<ContactKind> kinds = kinds_in(report);
  const bool has_counts = report.question == jobs::StepQuestion::all;
  std::vector<io::TextColumn> columns{io::word_column("step", 10)};
  for (const ContactKind kind : kinds) {
    columns.push_back({std::string(to_string(kind)), 11});
    if (has_counts) columns.push_back({"collide", 7});
  }
  const bool has_inversions = has_counts && !report.tetrahedra.empty();
  if (has_inversions) columns.push_back({"invert", 7});
  columns.push_back({"earliest", 11});
  if (report.alpha) columns.push_back({"free alpha", 20});
  if (has_intersections(report)) columns.push_back({"intersect", 9});
  columns.push_back({"seconds", 8});
  io::TextTable table(std::move(columns));
  for (std::size_t i = 0; i < report.steps.size(); ++i) {
    const StepRecord& step = report.steps[i];
    io::TextRow row{step_name(report, i)};
    const jobs::PairCounts colliding =
        has_counts ? jobs::counts_of(*step.collisions) : jobs::PairCounts{};
    for (const ContactKind kind : kinds) {
      row.push_back(std::to_string(count_of(*step.candidates, kind)));
      if (has_counts) row.push_back(std::to_string(count_of(colliding, kind)));
    }
    if (has_inversions) row.push_back(std::to_string(step.inversions->size()));
    row.push_back(earliest_text(report, step));
    if (report.alpha) row.push_back(io::number_text(step.free_alpha, "{}"));
    if (const auto pairs = intersecting_in(report, i)) row.push_back(intersecting_text(*pairs));
    row.push_back(io::number_text((step.broad_phase + step.narrow_phase).wall, "{:.3f}"));
    table.add(std::move(row));
  }
  return table;
}

template <class Element>
std::string vertices_text(std::span<const Element> elements, std::int32_t i) {
  return fmt::format("{}", fmt::join(elements[static_cast<std::size_t>(i)], " "));
}

/// "vertex 4, face 7 (1 2 3)".
std::string pair_text(const StepReport& report, const fast::StepCollision& collision) {
  const auto [a, b] = collision.pair;
  const auto edge = [&](std::int32_t i) {
    return fmt::format("edge {} ({})", i, vertices_text(report.edges, i));
  };
  switch (collision.kind) {
    case ContactKind::vertex_face:
      return fmt::format("vertex {}, face {} ({})", a, b, vertices_text(report.faces, b));
    case ContactKind::edge_edge:
      return edge(a) + ", " + edge(b);
    case ContactKind::vertex_edge:
      return fmt::format("vertex {}, ", a) + edge(b);
    case ContactKind::vertex_vertex:
      return fmt::format("vertices {} and {}", a, b);
  }
  return "";
}

void append_collisions(std::string& text, const StepReport& report, std::size_t i) {
  std::vector<fast::StepCollision> pairs = known_collisions(report.steps[i]);
  if (pairs.empty()) return;
  std::ranges::stable_sort(pairs, {}, &fast::StepCollision::toi_lower);
  text += fmt::format("\n{}: pairs that collide{}\n", step_name(report, i),
                      report.question == jobs::StepQuestion::earliest ? " first" : "");
  io::TextTable table(
      {io::word_column("  pair", 30), {"from t", 24}, {"to", 24}, {"u", 10}, {"v", 10}});
  for (const fast::StepCollision& pair :
       std::span(pairs).first(std::min(pairs.size(), most_pairs))) {
    table.add({"  " + pair_text(report, pair), fmt::format("{}", pair.toi_lower),
               fmt::format("{}", pair.toi_upper), fmt::format("{:.6g}", pair.u),
               fmt::format("{:.6g}", pair.v)});
  }
  text += table.text() + rest_text(pairs.size(), "--csv FILE");
}

void append_inversions(std::string& text, const StepReport& report, std::size_t i) {
  std::vector<fast::StepInversion> cells = known_inversions(report.steps[i]);
  if (cells.empty()) return;
  std::ranges::stable_sort(cells, {}, &fast::StepInversion::toi_lower);
  text += fmt::format("\n{}: cells that invert{}\n", step_name(report, i),
                      report.question == jobs::StepQuestion::earliest ? " first" : "");
  io::TextTable table(
      {io::word_column("  cell", 30), {"from t", 24}, {"to", 24}, io::word_column("start", 8)});
  constexpr std::array<std::string_view, 3> starts{"inverted", "flat", "positive"};
  for (const fast::StepInversion& one :
       std::span(cells).first(std::min(cells.size(), most_pairs))) {
    table.add({fmt::format("  {} {} ({})", to_string(one.kind), one.cell,
                           vertices_text(report.tetrahedra, one.cell)),
               fmt::format("{}", one.toi_lower), fmt::format("{}", one.toi_upper),
               std::string(starts.at(static_cast<std::size_t>(one.start + 1)))});
  }
  text += table.text() + rest_text(cells.size(), "--csv FILE");
}

/// "face 7 (1 2 3)".
std::string element_text(std::span<const fast::Face> faces, std::span<const fast::Edge> edges,
                         fast::PrimitiveKind kind, std::int32_t number) {
  std::string name = fmt::format("{} {}", to_string(kind), number);
  if (kind == fast::PrimitiveKind::point) return name;
  return fmt::format("{} ({})", name,
                     kind == fast::PrimitiveKind::face ? vertices_text(faces, number)
                                                       : vertices_text(edges, number));
}

std::string element_text(const StepReport& report, const fast::Intersection& one, std::size_t i) {
  return element_text(report.faces, report.edges, one.elements[i], one.numbers[i]);
}

void append_intersections(std::string& text, const StepReport& report, const FrameRecord& frame) {
  if (!frame.intersections || frame.intersections->empty()) return;
  text += fmt::format("\n{}: the mesh intersects itself; pairs: {}\n", io::printable(frame.name),
                      intersecting_text(frame.intersections->size()));
  const std::size_t printed = std::min(frame.intersections->size(), most_pairs);
  for (const fast::Intersection& one : std::span(*frame.intersections).first(printed)) {
    text += fmt::format("  {}, {}: {}\n", element_text(report, one, 0),
                        element_text(report, one, 1), fast::to_string(one.kind));
  }
  text += rest_text(frame.intersections->size(), "touchstone intersections");
}

void append_proof(std::string& text, const StepReport& report, std::size_t i) {
  const auto& proof = report.steps[i].proof;
  if (!proof) return;
  text += fmt::format("\n{}: ", step_name(report, i));
  if (!proof->is_complete()) {
    text += fmt::format("no proof: {}\n", proof->interrupted ? "interrupted" : proof->failure);
    return;
  }
  text += fmt::format("proved: {}; pairs by a direction: {}, by subintervals: {}; {} bytes\n",
                      proof->claim, proof->directions, proof->certificates, proof->bytes);
}

/// What touchstone-check says of all; empty if a step has no proof.
std::string summary_of(const StepReport& report) {
  checker::Summary summary(checker::Time::step);
  bool does_follow = true;
  for (const StepRecord& step : report.steps) {
    if (!step.proof || !step.proof->is_complete()) return "";
    summary.add({.is_free = step.proof->claim == "no_contact 1",
                 .contact = step.proof->contact,
                 .rules = step.proof->rules},
                does_follow);
    does_follow = step.ends_at_frame;
  }
  return report.interrupted ? "" : summary.text();
}

std::string name_of(const StepReport& report, std::int32_t group) {
  return io::printable(report.group_names[static_cast<std::size_t>(group)]);
}

/// The radii that are not 0, by the names of their groups.
std::map<std::string, double> radii_of(const StepReport& report) {
  std::map<std::string, double> radii;
  for (std::size_t i = 0; i < report.groups.radii.size(); ++i) {
    if (report.groups.radii[i] == 0.0) continue;
    radii[name_of(report, static_cast<std::int32_t>(i))] = report.groups.radii[i];
  }
  return radii;
}

/// The separation if there is one or a thickness: ", minimum separation 0 (l2)"; and lines of the
/// thick groups: "radii: ball 0.5, wall 0.1", and the distances of pairs.
std::array<std::string, 2> separation_texts(const StepReport& report) {
  std::vector<std::string> radii, separations;
  for (const auto& [name, radius] : radii_of(report)) {
    radii.push_back(fmt::format("{} {}", name, radius));
  }
  for (const auto& [two, distance] : report.groups.separations) {
    separations.push_back(
        fmt::format("{} and {} {}", name_of(report, two[0]), name_of(report, two[1]), distance));
  }
  std::string lines;
  for (const auto& [title, all] :
       {std::pair("radii", &radii), std::pair("separations", &separations)}) {
    if (all->empty()) continue;
    const std::span shown = std::span(*all).first(std::min(most_pairs, all->size()));
    lines += fmt::format("{}: {}{}\n", title, fmt::join(shown, ", "),
                         shown.size() < all->size() ? ", ..." : "");
  }
  if (is_zero(report.separation) && lines.empty()) return {};
  return {", minimum separation " + judge::to_text(report.separation), lines};
}

std::string heading(const StepReport& report) {
  std::string text = fmt::format("{} vertices, {} edges, {} faces", report.vertices,
                                 report.edges.size(), report.faces.size());
  if (!report.tetrahedra.empty()) text += fmt::format(", {} tetrahedra", report.tetrahedra.size());
  const auto [separation, thickness] = separation_texts(report);
  text += separation;
  if (report.alpha) text += fmt::format(", alpha {}", *report.alpha);
  return text + (report.interrupted ? " (interrupted)\n" : "\n") + thickness;
}

// ---- JSON and CSV -------------------------------------------------------------------------------

/// "vertex_face": names in JSON.
std::string key_of(ContactKind kind) {
  std::string key(to_string(kind));
  std::ranges::replace(key, '-', '_');
  return key;
}

nlohmann::json json_of(const jobs::PairCounts& counts) {
  nlohmann::json json = nlohmann::json::object();
  for (const ContactKind kind : jobs::pair_kinds) json[key_of(kind)] = count_of(counts, kind);
  return json;
}

nlohmann::json json_of(const Eigen::Vector3d& x) { return {x[0], x[1], x[2]}; }

nlohmann::json json_of(const fast::ActiveContact& contact) {
  return {{"kind", to_string(contact.kind)},
          {"first", contact.pair[0]},
          {"second", contact.pair[1]},
          {"toi_lower", contact.toi_lower},
          {"toi_upper", contact.toi_upper},
          {"u", contact.u},
          {"v", contact.v},
          {"points", {json_of(contact.first), json_of(contact.second)}},
          {"normal", json_of(contact.normal)},
          {"point_error", io::number_to_json(contact.point_error)},
          {"normal_error", io::number_to_json(contact.normal_error)},
          {"has_side", contact.has_side}};
}

/// The contacts of the pairs of the earliest impact, in their order, and its inversions.
nlohmann::json earliest_contacts(const StepRecord& step) {
  nlohmann::json contacts = nlohmann::json::array();
  if (!step.earliest) return contacts;
  for (const fast::ActiveContact& contact : step.contacts) {
    if (contact.toi_lower <= step.earliest->toi_upper) contacts.push_back(json_of(contact));
  }
  for (const fast::StepInversion& one : step.earliest->inversions) {
    contacts.push_back({{"kind", to_string(one.kind)},
                        {"cell", one.cell},
                        {"start", one.start},
                        {"toi_lower", one.toi_lower},
                        {"toi_upper", one.toi_upper}});
  }
  return contacts;
}

nlohmann::json seconds_of(const StepRecord& step, double jobs::WorkTime::*time) {
  return {{"broad_phase", step.broad_phase.*time},
          {"narrow_phase", step.narrow_phase.*time},
          {"total", (step.broad_phase + step.narrow_phase).*time}};
}

nlohmann::json json_of(const FrameRecord& frame) {
  nlohmann::json json{
      {"name", io::printable(frame.name)}, {"intersecting", nullptr}, {"intersections", nullptr}};
  if (!frame.intersections) return json;
  json["intersecting"] = frame.intersections->size();
  json["intersections"] = nlohmann::json::array();
  for (const fast::Intersection& one : *frame.intersections) {
    json["intersections"].push_back({fast::to_string(one.kind), fast::to_string(one.elements[0]),
                                     one.numbers[0], fast::to_string(one.elements[1]),
                                     one.numbers[1]});
  }
  return json;
}

nlohmann::json json_of(const StepReport& report, std::size_t i) {
  const StepRecord& step = report.steps[i];
  const auto toi = [&](double fast::StepImpact::*bound) {
    return step.earliest ? nlohmann::json((*step.earliest).*bound) : nlohmann::json();
  };
  const auto intersecting = intersecting_in(report, i);
  nlohmann::json json{
      {"frames",
       {io::printable(report.frames.at(i).name), io::printable(report.frames.at(i + 1).name)}},
      {"candidates", step.candidates ? json_of(*step.candidates) : nlohmann::json()},
      {"collisions",
       step.collisions ? json_of(jobs::counts_of(*step.collisions)) : nlohmann::json()},
      {"inversions", step.inversions ? nlohmann::json(step.inversions->size()) : nlohmann::json()},
      {"toi_lower", toi(&fast::StepImpact::toi_lower)},
      {"toi_upper", toi(&fast::StepImpact::toi_upper)},
      {"earliest", earliest_contacts(step)},
      {"free", step.is_free},
      {"intersecting", intersecting ? nlohmann::json(*intersecting) : nlohmann::json()},
      {"seconds", seconds_of(step, &jobs::WorkTime::wall)},
      {"processor_seconds", seconds_of(step, &jobs::WorkTime::processor)}};
  if (report.alpha) json["free_alpha"] = io::number_to_json(step.free_alpha);
  if (step.proof) {
    json["proof"] = {
        {"claim", step.proof->claim},           {"rules", step.proof->rules},
        {"directions", step.proof->directions}, {"certificates", step.proof->certificates},
        {"bytes", step.proof->bytes},           {"complete", step.proof->is_complete()}};
  }
  return json;
}

}  // namespace

bool has_collisions(const StepReport& report) {
  return !std::ranges::all_of(report.steps, &StepRecord::is_free) ||
         !std::ranges::all_of(report.frames, [](const FrameRecord& frame) {
           return !frame.intersections || frame.intersections->empty();
         });
}

std::string to_text(const StepReport& report) {
  std::string text = heading(report) + table_of(report).text();
  for (std::size_t i = 0; i < report.steps.size(); ++i) {
    append_collisions(text, report, i);
    append_inversions(text, report, i);
  }
  for (const FrameRecord& frame : report.frames) append_intersections(text, report, frame);
  for (std::size_t i = 0; i < report.steps.size(); ++i) append_proof(text, report, i);
  const std::string summary = summary_of(report);
  if (!summary.empty()) text += '\n' + summary + '\n';
  return text;
}

nlohmann::json to_json(const StepReport& report) {
  nlohmann::json frames = nlohmann::json::array();
  for (const FrameRecord& frame : report.frames) frames.push_back(json_of(frame));
  nlohmann::json steps = nlohmann::json::array();
  for (std::size_t i = 0; i < report.steps.size(); ++i) steps.push_back(json_of(report, i));
  nlohmann::json separations = nlohmann::json::array();
  for (const auto& [two, distance] : report.groups.separations) {
    separations.push_back({name_of(report, two[0]), name_of(report, two[1]), distance});
  }
  return {{"separation", judge::to_json(report.separation)},
          {"radii", radii_of(report)},
          {"separations", std::move(separations)},
          {"alpha", report.alpha ? nlohmann::json(*report.alpha) : nlohmann::json()},
          {"question", name_of(report.question)},
          {"vertices", report.vertices},
          {"edges", report.edges.size()},
          {"faces", report.faces.size()},
          {"tetrahedra", report.tetrahedra.size()},
          {"interrupted", report.interrupted},
          {"frames", std::move(frames)},
          {"steps", std::move(steps)},
          {"proved", summary_of(report)}};
}

std::string step_csv_header() {
  return io::csv_row({"step",         "frame0",    "frame1",    "kind",     "first",
                      "second",       "toi_lower", "toi_upper", "u",        "v",
                      "first_x",      "first_y",   "first_z",   "second_x", "second_y",
                      "second_z",     "normal_x",  "normal_y",  "normal_z", "point_error",
                      "normal_error", "has_side",  "start"});
}

std::string step_csv_rows(const StepReport& report, std::size_t i) {
  std::string rows;
  for (const fast::ActiveContact& contact : report.steps.at(i).contacts) {
    std::vector<std::string> row{std::to_string(i),
                                 report.frames.at(i).name,
                                 report.frames.at(i + 1).name,
                                 std::string(to_string(contact.kind)),
                                 std::to_string(contact.pair[0]),
                                 std::to_string(contact.pair[1])};
    const auto add = [&row](double number) { row.push_back(io::csv_number(number)); };
    for (const double x : {contact.toi_lower, contact.toi_upper, contact.u, contact.v}) add(x);
    for (const Eigen::Vector3d& x : {contact.first, contact.second, contact.normal}) {
      for (const double component : x) add(component);
    }
    add(contact.point_error);
    add(contact.normal_error);
    row.emplace_back(contact.has_side ? "1" : "0");
    row.resize(step_csv_columns);
    rows += io::csv_row(row);
  }
  for (const fast::StepInversion& one : known_inversions(report.steps.at(i))) {
    std::vector<std::string> row{std::to_string(i),
                                 report.frames.at(i).name,
                                 report.frames.at(i + 1).name,
                                 std::string(to_string(one.kind)),
                                 std::to_string(one.cell),
                                 "",
                                 io::csv_number(one.toi_lower),
                                 io::csv_number(one.toi_upper)};
    row.resize(step_csv_columns);
    row.back() = std::to_string(one.start);
    rows += io::csv_row(row);
  }
  return rows;
}

namespace {

/// An element by its mesh and its number there.
struct NamedElement {
  std::size_t mesh = 0;
  std::int32_t number = 0;
};

std::size_t count_of(const mesh::Mesh& mesh, fast::PrimitiveKind kind) {
  if (kind == fast::PrimitiveKind::face) return mesh.faces.size();
  if (kind == fast::PrimitiveKind::edge) return mesh.edges.size();
  return static_cast<std::size_t>(mesh.vertices.rows());
}

/// The element of one of the meshes that has a number in the joined one.
NamedElement named(const std::vector<RestingMesh>& meshes, fast::PrimitiveKind kind,
                   std::int32_t number) {
  NamedElement result{0, number};
  while (std::cmp_greater_equal(result.number, count_of(meshes.at(result.mesh).mesh, kind))) {
    result.number -= static_cast<std::int32_t>(count_of(meshes[result.mesh].mesh, kind));
    ++result.mesh;
  }
  return result;
}

std::string element_text(const std::vector<RestingMesh>& meshes, fast::PrimitiveKind kind,
                         std::int32_t number) {
  const auto [mesh, own] = named(meshes, kind, number);
  const auto& [name, of, defects, inversions] = meshes[mesh];
  return (meshes.size() > 1 ? io::printable(name) + ": " : "") +
         element_text(of.faces, of.edges, kind, own);
}

std::array<std::size_t, fast::intersection_kinds> counts_of(const IntersectionReport& report) {
  std::array<std::size_t, fast::intersection_kinds> counts{};
  for (const fast::Intersection& one : report.intersections) {
    ++counts.at(static_cast<std::size_t>(one.kind));
  }
  return counts;
}

std::string_view name_of(std::size_t kind) {
  return fast::to_string(static_cast<fast::IntersectionKind>(kind));
}

// ---- Text ---------------------------------------------------------------------------------------

std::string point_text(const fast::PointEnclosure& point) {
  const auto& [x, y, z] = point.lower;
  return fmt::format("{:.6g} {:.6g} {:.6g}", x, y, z);
}

std::string counts_text(const IntersectionReport& report) {
  const std::string rules = rules_text(report);
  if (report.intersections.empty()) {
    return (report.interrupted ? "interrupted" : "no intersections") +
           (rules.empty() ? "" : "; " + rules) + '\n';
  }
  io::TextTable table({io::word_column("intersections", 18), {"pairs", 10}});
  const auto counts = counts_of(report);
  for (std::size_t kind = 0; kind < counts.size(); ++kind) {
    if (counts[kind] == 0) continue;
    table.add({std::string(name_of(kind)), std::to_string(counts[kind])});
  }
  table.add({"total", std::to_string(report.intersections.size())});
  return table.text() +
         (report.is_cut ? "more pairs intersect; these are the first ones (--most N; --apart, or "
                          "fewer meshes, ask for a part)\n"
                        : "") +
         (rules.empty() ? "" : rules + '\n');
}

std::string pairs_text(const IntersectionReport& report) {
  if (report.intersections.empty()) return "";
  io::TextTable table(
      {io::word_column("pair", 30), io::word_column("kind", 17), {"from", 24}, {"to", 24}});
  const std::span shown(report.intersections.data(),
                        std::min(most_pairs, report.intersections.size()));
  for (const fast::Intersection& one : shown) {
    table.add({pair_text(report.meshes, one), std::string(fast::to_string(one.kind)),
               point_text(one.place[0]), point_text(one.place[1])});
  }
  return "\n" + table.text() + rest_text(report.intersections.size(), "--csv FILE");
}

template <class Item>
std::string numbers_text(std::string_view name, const std::vector<Item>& numbers) {
  if (numbers.empty()) return "";
  std::string text = fmt::format("{}: {} (", name, numbers.size());
  for (std::size_t i = 0; i < std::min(most_pairs, numbers.size()); ++i) {
    if (i > 0) text += ", ";
    if constexpr (std::is_same_v<Item, fast::IndexPair>) {
      text += fmt::format("{} as {}", numbers[i][0], numbers[i][1]);
    } else {
      text += std::to_string(numbers[i]);
    }
  }
  return text + (numbers.size() > most_pairs ? ", ...)\n" : ")\n");
}

/// The tetrahedra whose volume has this sign at rest.
std::vector<std::int32_t> tetrahedra_with(const RestingMesh& mesh, int sign) {
  std::vector<std::int32_t> result;
  for (const fast::StepInversion& one : mesh.inversions) {
    if (one.start == sign) result.push_back(one.cell);
  }
  return result;
}

std::string defects_text(const IntersectionReport& report, const RestingMesh& mesh) {
  const fast::MeshDefects& defects = mesh.defects;
  std::string text = numbers_text("faces without an area", defects.degenerate_faces) +
                     numbers_text("edges without a length", defects.degenerate_edges) +
                     numbers_text("vertices at the place of another", defects.duplicated_vertices) +
                     numbers_text("vertices of no element", defects.unreferenced_vertices) +
                     numbers_text("tetrahedra without a volume", tetrahedra_with(mesh, 0)) +
                     numbers_text("inverted tetrahedra", tetrahedra_with(mesh, -1));
  if (!defects.duplicated_vertices.empty() && !report.weld) {
    text +=
        "Elements that meet at vertices at one place intersect. With --weld those of one group "
        "are one vertex.\n";
  }
  if (text.empty()) return text;
  return "\n" + (report.meshes.size() > 1 ? io::printable(mesh.name) + ":\n" : "") + text;
}

// ---- JSON and CSV -------------------------------------------------------------------------------

nlohmann::json json_of(const RestingMesh& mesh) {
  return {{"name", io::printable(mesh.name)},
          {"vertices", mesh.mesh.vertices.rows()},
          {"edges", mesh.mesh.edges.size()},
          {"faces", mesh.mesh.faces.size()},
          {"degenerate_faces", mesh.defects.degenerate_faces},
          {"degenerate_edges", mesh.defects.degenerate_edges},
          {"duplicated_vertices", mesh.defects.duplicated_vertices},
          {"unreferenced_vertices", mesh.defects.unreferenced_vertices},
          {"tetrahedra", mesh.mesh.tetrahedra.size()},
          {"flat_tetrahedra", tetrahedra_with(mesh, 0)},
          {"inverted_tetrahedra", tetrahedra_with(mesh, -1)}};
}

nlohmann::json json_of(const fast::PointEnclosure& point) {
  nlohmann::json json = nlohmann::json::array();
  for (std::size_t axis = 0; axis < 3; ++axis)
    json.push_back({point.lower[axis], point.upper[axis]});
  return json;
}

nlohmann::json json_of(const std::vector<RestingMesh>& meshes, const fast::Intersection& one) {
  const auto element = [&](std::size_t i) {
    const auto [mesh, number] = named(meshes, one.elements[i], one.numbers[i]);
    return nlohmann::json{
        {"mesh", mesh}, {"element", fast::to_string(one.elements[i])}, {"number", number}};
  };
  return {{"kind", fast::to_string(one.kind)},
          {"first", element(0)},
          {"second", element(1)},
          {"place", {json_of(one.place[0]), json_of(one.place[1])}}};
}

}  // namespace

mesh::Mesh joined(const std::vector<RestingMesh>& meshes) {
  if (meshes.size() == 1) return meshes.front().mesh;
  mesh::Mesh result;
  for (const auto& [name, mesh, defects, inversions] : meshes) {
    const auto first = static_cast<std::int32_t>(result.vertices.rows());
    result.vertices.conservativeResize(result.vertices.rows() + mesh.vertices.rows(), 3);
    result.vertices.bottomRows(mesh.vertices.rows()) = mesh.vertices;
    for (const auto& [a, b, c] : mesh.faces)
      result.faces.push_back({a + first, b + first, c + first});
    for (const auto& [a, b] : mesh.edges) result.edges.push_back({a + first, b + first});
    for (const std::int32_t point : mesh.points) result.points.push_back(point + first);
    result.groups.of_vertex.resize(static_cast<std::size_t>(result.vertices.rows()),
                                   static_cast<std::int32_t>(result.groups.names.size()));
    result.groups.names.push_back(name);
  }
  return result;
}

std::string pair_text(const std::vector<RestingMesh>& meshes,
                      const fast::Intersection& intersection) {
  const auto& [elements, numbers, kind, place] = intersection;
  return element_text(meshes, elements[0], numbers[0]) + ", " +
         element_text(meshes, elements[1], numbers[1]);
}

std::string rules_text(const IntersectionReport& report) {
  std::vector<std::string> pairs, rules;
  for (const auto& [a, b] : report.apart) {
    pairs.push_back(io::printable(a) + " with " + io::printable(b));
  }
  if (!pairs.empty()) rules.push_back(fmt::format("left out: {}", fmt::join(pairs, ", ")));
  if (report.weld) rules.emplace_back("vertices at one place, of one group, are one");
  return fmt::format("{}", fmt::join(rules, "; "));
}

std::string to_text(const IntersectionReport& report) {
  std::string text;
  for (const RestingMesh& mesh : report.meshes) {
    text += fmt::format("{}: {} vertices, {} edges, {} faces\n", io::printable(mesh.name),
                        mesh.mesh.vertices.rows(), mesh.mesh.edges.size(), mesh.mesh.faces.size());
  }
  text += counts_text(report) + pairs_text(report);
  for (const RestingMesh& mesh : report.meshes) text += defects_text(report, mesh);
  return text;
}

nlohmann::json to_json(const IntersectionReport& report) {
  nlohmann::json meshes = nlohmann::json::array(), found = nlohmann::json::array(), counts;
  for (const RestingMesh& mesh : report.meshes) meshes.push_back(json_of(mesh));
  for (const fast::Intersection& one : report.intersections) {
    found.push_back(json_of(report.meshes, one));
  }
  const auto numbers = counts_of(report);
  for (std::size_t kind = 0; kind < numbers.size(); ++kind) {
    counts[std::string(name_of(kind))] = numbers[kind];
  }
  return {{"meshes", std::move(meshes)}, {"intersections", std::move(found)},
          {"counts", std::move(counts)}, {"weld", report.weld},
          {"apart", report.apart},       {"is_cut", report.is_cut},
          {"seconds", report.seconds},   {"interrupted", report.interrupted}};
}

std::string to_csv(const IntersectionReport& report) {
  std::string text =
      "kind,first_mesh,first_element,first,second_mesh,second_element,second,x0_lower,x0_upper,"
      "y0_lower,y0_upper,z0_lower,z0_upper,x1_lower,x1_upper,y1_lower,y1_upper,z1_lower,z1_upper\n";
  for (const fast::Intersection& one : report.intersections) {
    std::vector<std::string> row{std::string(fast::to_string(one.kind))};
    for (std::size_t i = 0; i < 2; ++i) {
      const auto [mesh, number] = named(report.meshes, one.elements[i], one.numbers[i]);
      row.push_back(report.meshes[mesh].name);
      row.emplace_back(fast::to_string(one.elements[i]));
      row.push_back(std::to_string(number));
    }
    for (const fast::PointEnclosure& point : one.place) {
      for (std::size_t axis = 0; axis < 3; ++axis) {
        row.push_back(io::csv_number(point.lower[axis]));
        row.push_back(io::csv_number(point.upper[axis]));
      }
    }
    text += io::csv_row(row);
  }
  return text;
}

}  // namespace touchstone::verify::report
