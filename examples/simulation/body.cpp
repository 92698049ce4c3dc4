#include "examples/simulation/body.hpp"

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <map>

namespace touchstone::simulation {
namespace {

using Eigen::Vector3d;

/// The cell's corner (i, j, k) is corner i + 2j + 4k. Each tetrahedron is a path from corner 0 to
/// corner 7 along the axes in one of their six orders, so that neighbouring cells cut their common
/// square along the same diagonal.
constexpr std::array<std::array<std::size_t, 4>, 6> cell_tetrahedra{
    {{0, 1, 3, 7}, {0, 3, 2, 7}, {0, 2, 6, 7}, {0, 6, 4, 7}, {0, 4, 5, 7}, {0, 5, 1, 7}}};

/// The faces of one tetrahedron alone, outside to the front.
std::vector<fast::Face> surface_of(const std::vector<Tetrahedron>& tetrahedra) {
  std::map<fast::Face, std::pair<fast::Face, int>> seen;
  for (const auto& [a, b, c, d] : tetrahedra) {
    for (const fast::Face& face : {fast::Face{a, c, b}, {a, b, d}, {b, c, d}, {a, d, c}}) {
      fast::Face key = face;
      std::ranges::sort(key);
      const auto entry = seen.try_emplace(key, face, 0).first;
      ++entry->second.second;
    }
  }
  std::vector<fast::Face> result;
  for (const auto& [key, face] : seen) {
    if (face.second == 1) result.push_back(face.first);
  }
  return result;
}

Vertices rows(const std::vector<Vector3d>& points) {
  Vertices result(static_cast<Eigen::Index>(points.size()), 3);
  for (std::size_t i = 0; i < points.size(); ++i) {
    result.row(static_cast<Eigen::Index>(i)) = points[i].transpose();
  }
  return result;
}

Body grid(const std::array<int, 3>& cells, const Map& map, bool is_closed) {
  const int layers = is_closed ? cells[0] : cells[0] + 1;
  const auto number = [&](int i, int j, int k) {
    return ((i % layers) * (cells[1] + 1) + j) * (cells[2] + 1) + k;
  };
  Body body;
  std::vector<Vector3d> points;
  const auto coordinate = [](int i, int of) { return 2.0 * i / of - 1.0; };
  for (int i = 0; i < layers; ++i) {
    for (int j = 0; j <= cells[1]; ++j) {
      for (int k = 0; k <= cells[2]; ++k) {
        points.push_back(
            map({coordinate(i, cells[0]), coordinate(j, cells[1]), coordinate(k, cells[2])}));
      }
    }
  }
  body.vertices = rows(points);
  for (int i = 0; i < cells[0]; ++i) {
    for (int j = 0; j < cells[1]; ++j) {
      for (int k = 0; k < cells[2]; ++k) {
        for (const auto& corners : cell_tetrahedra) {
          Tetrahedron& added = body.tetrahedra.emplace_back();
          std::ranges::transform(corners, added.begin(), [&](std::size_t corner) {
            const int c = static_cast<int>(corner);
            return number(i + (c & 1), j + ((c >> 1) & 1), k + ((c >> 2) & 1));
          });
        }
      }
    }
  }
  body.faces = surface_of(body.tetrahedra);
  return body;
}

}  // namespace

Body block(const std::array<int, 3>& cells, const Map& map) { return grid(cells, map, false); }
Body ring(const std::array<int, 3>& cells, const Map& map) { return grid(cells, map, true); }

Body cloth(const std::array<int, 2>& cells, const Map& map) {
  Body body;
  body.kind = BodyKind::cloth;
  body.density = 0.3;
  body.youngs_modulus = 500.0;
  std::vector<Vector3d> points;
  for (int i = 0; i <= cells[0]; ++i) {
    for (int j = 0; j <= cells[1]; ++j) {
      points.push_back(map({2.0 * i / cells[0] - 1.0, 2.0 * j / cells[1] - 1.0, 0.0}));
    }
  }
  body.vertices = rows(points);
  const auto number = [&](int i, int j) { return i * (cells[1] + 1) + j; };
  for (int i = 0; i < cells[0]; ++i) {
    for (int j = 0; j < cells[1]; ++j) {
      const std::int32_t a = number(i, j), b = number(i + 1, j), c = number(i + 1, j + 1),
                         d = number(i, j + 1);
      // Diagonals in turns, so that no direction is stiffer than its mirror image.
      if ((i + j) % 2 == 0) {
        body.faces.insert(body.faces.end(), {{a, b, c}, {a, c, d}});
      } else {
        body.faces.insert(body.faces.end(), {{a, b, d}, {b, c, d}});
      }
    }
  }
  return body;
}

Body obstacle(const std::vector<Vector3d>& vertices, std::vector<fast::Face> faces) {
  Body body;
  body.kind = BodyKind::obstacle;
  body.vertices = rows(vertices);
  body.faces = std::move(faces);
  return body;
}

Body extruded(const std::vector<std::array<double, 2>>& profile, double width, int strips) {
  std::vector<Vector3d> points;
  for (const auto& [x, z] : profile) {
    for (int j = 0; j <= strips; ++j) points.emplace_back(x, width * j / strips - width / 2.0, z);
  }
  std::vector<fast::Face> faces;
  const auto number = [&](std::size_t i, int j) {
    return static_cast<std::int32_t>(i) * (strips + 1) + j;
  };
  for (std::size_t i = 0; i + 1 < profile.size(); ++i) {
    for (int j = 0; j < strips; ++j) {
      faces.push_back({number(i, j), number(i + 1, j), number(i + 1, j + 1)});
      faces.push_back({number(i, j), number(i + 1, j + 1), number(i, j + 1)});
    }
  }
  return obstacle(points, std::move(faces));
}

Body fan(const Vector3d& tip, const std::vector<Vector3d>& rim) {
  std::vector<Vector3d> points{tip};
  points.insert(points.end(), rim.begin(), rim.end());
  std::vector<fast::Face> faces;
  const auto count = static_cast<std::int32_t>(rim.size());
  for (std::int32_t i = 0; i < count; ++i) faces.push_back({0, 1 + i, 1 + (i + 1) % count});
  return obstacle(points, std::move(faces));
}

Vector3d rounded_cube(const Vector3d& point) {
  const Vector3d s = point.cwiseAbs2();
  const auto stretch = [](double a, double b) {
    return std::sqrt(1.0 - a / 2.0 - b / 2.0 + a * b / 3.0);
  };
  const Vector3d ball{point.x() * stretch(s.y(), s.z()), point.y() * stretch(s.z(), s.x()),
                      point.z() * stretch(s.x(), s.y())};
  return 0.65 * ball + 0.3 * point;
}

Body moved(Body body, const Vector3d& translation) {
  body.vertices.rowwise() += translation.transpose();
  return body;
}

}  // namespace touchstone::simulation
