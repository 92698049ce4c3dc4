#include "verify/report/intersection_report.hpp"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <nlohmann/json.hpp>
#include <span>
#include <string_view>
#include <utility>

#include "verify/io/csv.hpp"
#include "verify/io/printable.hpp"
#include "verify/io/text_table.hpp"

namespace touchstone::verify::report {
namespace {

/// An element by its mesh and its number there.
struct NamedElement {
  std::size_t mesh = 0;
  std::int32_t number = 0;
};

std::size_t count_of(const mesh::Mesh& mesh, fast::ElementKind kind) {
  if (kind == fast::ElementKind::face) return mesh.faces.size();
  if (kind == fast::ElementKind::edge) return mesh.edges.size();
  return static_cast<std::size_t>(mesh.vertices.rows());
}

/// The element of one of the meshes that has a number in the joined one.
NamedElement named(const std::vector<RestingMesh>& meshes, fast::ElementKind kind,
                   std::int32_t number) {
  NamedElement result{0, number};
  while (std::cmp_greater_equal(result.number, count_of(meshes.at(result.mesh).mesh, kind))) {
    result.number -= static_cast<std::int32_t>(count_of(meshes[result.mesh].mesh, kind));
    ++result.mesh;
  }
  return result;
}

std::string element_text(const std::vector<RestingMesh>& meshes, fast::ElementKind kind,
                         std::int32_t number) {
  const auto [mesh, own] = named(meshes, kind, number);
  const auto i = static_cast<std::size_t>(own);
  std::string text = meshes.size() > 1 ? io::printable(meshes[mesh].name) + ": " : "";
  text += fmt::format("{} {}", fast::to_string(kind), own);
  if (kind == fast::ElementKind::face) {
    text += fmt::format(" ({})", fmt::join(meshes[mesh].mesh.faces[i], " "));
  } else if (kind == fast::ElementKind::edge) {
    text += fmt::format(" ({})", fmt::join(meshes[mesh].mesh.edges[i], " "));
  }
  return text;
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
  if (report.intersections.empty()) {
    return report.interrupted ? "interrupted\n" : "no intersections\n";
  }
  io::TextTable table({io::word_column("intersections", 18), {"pairs", 10}});
  const auto counts = counts_of(report);
  for (std::size_t kind = 0; kind < counts.size(); ++kind) {
    if (counts[kind] == 0) continue;
    table.add({std::string(name_of(kind)), std::to_string(counts[kind])});
  }
  table.add({"total", std::to_string(report.intersections.size())});
  return table.text();
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
std::vector<std::size_t> tetrahedra_with(const RestingMesh& mesh, int sign) {
  std::vector<std::size_t> result;
  for (const fast::Inversion& one : mesh.inversions) {
    if (one.result.start == sign) result.push_back(one.element);
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
        "Elements that meet at vertices at one place intersect. With --weld these are one "
        "vertex.\n";
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

std::string rest_text(std::size_t all, std::string_view where) {
  if (all <= most_pairs) return "";
  return fmt::format("  ... and {} more ({})\n", all - most_pairs, where);
}

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
