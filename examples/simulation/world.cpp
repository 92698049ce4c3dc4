#include "examples/simulation/world.hpp"

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>

#include <cmath>
#include <map>

namespace touchstone::simulation {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The stiffness of pins, in N/m.
constexpr double pin_stiffness = 1e4;
constexpr double poissons_ratio = 0.4;
/// The bending stiffness of cloth, in N m.
constexpr double bending_stiffness = 1e-5;

/// Density and derivatives of an element's energy, as functions of F's columns one below the other.
template <int Columns>
struct Density {
  static constexpr int size = 3 * Columns;
  double value = 0.0;
  Eigen::Matrix<double, size, 1> gradient;
  Eigen::Matrix<double, size, size> hessian;
};

template <class Matrix>
void drop_negative_eigenvalues(Matrix& matrix) {
  const Eigen::SelfAdjointEigenSolver<Matrix> solver(matrix);
  if (solver.eigenvalues()[0] >= 0.0) return;
  matrix = solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).asDiagonal() *
           solver.eigenvectors().transpose();
}

Matrix3d cross_matrix(const Vector3d& a) {
  return (Matrix3d() << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0).finished();
}

Density<3> density(const Matrix3d& f, double mu, double lambda, bool with_derivatives) {
  Density<3> result;
  const double change = f.determinant() - 1.0;
  result.value = mu / 2.0 * (f.squaredNorm() - 3.0) - mu * change + lambda / 2.0 * change * change;
  if (!with_derivatives) return result;
  const double slope = lambda * change - mu;
  Eigen::Matrix<double, 9, 1> cofactors;
  cofactors << f.col(1).cross(f.col(2)), f.col(2).cross(f.col(0)), f.col(0).cross(f.col(1));
  result.gradient = mu * f.reshaped() + slope * cofactors;
  result.hessian =
      mu * Eigen::Matrix<double, 9, 9>::Identity() + lambda * cofactors * cofactors.transpose();
  // The second derivatives of the determinant.
  for (int i = 0; i < 3; ++i) {
    const int next = (i + 1) % 3, other = (i + 2) % 3;
    const Matrix3d cross = slope * cross_matrix(f.col(other));
    result.hessian.block<3, 3>(3 * i, 3 * next) -= cross;
    result.hessian.block<3, 3>(3 * next, 3 * i) += cross;
  }
  drop_negative_eigenvalues(result.hessian);
  return result;
}

Density<2> density(const Eigen::Matrix<double, 3, 2>& f, double mu, double lambda,
                   bool with_derivatives) {
  using Small = Eigen::Matrix2d;
  Density<2> result;
  const Small strain = (f.transpose() * f - Small::Identity()) / 2.0;
  const double trace = strain.trace();
  result.value = mu * strain.squaredNorm() + lambda / 2.0 * trace * trace;
  if (!with_derivatives) return result;
  const Small stress = 2.0 * mu * strain + lambda * trace * Small::Identity();
  result.gradient = (f * stress).reshaped();
  for (int i = 0; i < 6; ++i) {
    Eigen::Matrix<double, 3, 2> df = Eigen::Matrix<double, 3, 2>::Zero();
    df.reshaped()[i] = 1.0;
    const Small dstrain = (df.transpose() * f + f.transpose() * df) / 2.0;
    const Small dstress = 2.0 * mu * dstrain + lambda * dstrain.trace() * Small::Identity();
    result.hessian.col(i) = (df * stress + f * dstress).reshaped();
  }
  drop_negative_eigenvalues(result.hessian);
  return result;
}

template <int Columns>
double element_energy(const Element<Columns>& element, const Eigen::VectorXd& x,
                      Derivatives* derivatives) {
  constexpr int points = Columns + 1;
  Eigen::Matrix<double, 3, points> places;
  for (int a = 0; a < points; ++a) {
    places.col(a) = x.segment<3>(3 * Index{element.vertices[static_cast<std::size_t>(a)]});
  }
  const Eigen::Matrix<double, 3, Columns> f = places * element.b.transpose();
  const Density<Columns> at = density(f, element.mu, element.lambda, derivatives != nullptr);
  if (derivatives != nullptr) {
    // F's columns from the coordinates: dF_j / dx_a = b_ja I.
    Eigen::Matrix<double, 3 * Columns, 3 * points> map;
    for (int j = 0; j < Columns; ++j) {
      for (int a = 0; a < points; ++a)
        map.template block<3, 3>(3 * j, 3 * a) = element.b(j, a) * Matrix3d::Identity();
    }
    derivatives->add(element.vertices, element.measure * map.transpose() * at.gradient,
                     element.measure * map.transpose() * at.hessian * map);
  }
  return element.measure * at.value;
}

/// The element of these vertices at rest; `frame` has the coordinates of their edges from the first
/// one as columns.
template <int Columns>
Element<Columns> element_of(
    const std::array<std::int32_t, static_cast<std::size_t>(Columns + 1)>& vertices,
    const Eigen::Matrix<double, Columns, Columns>& frame, double youngs_modulus) {
  Element<Columns> result;
  result.vertices = vertices;
  const Eigen::Matrix<double, Columns, Columns> inverse = frame.inverse();
  result.b.template rightCols<Columns>() = inverse.transpose();
  result.b.col(0) = -inverse.transpose().rowwise().sum();
  result.measure = std::abs(frame.determinant()) / (Columns == 3 ? 6.0 : 2.0);
  result.mu = youngs_modulus / (2.0 * (1.0 + poissons_ratio));
  result.lambda =
      youngs_modulus * poissons_ratio / ((1.0 + poissons_ratio) * (1.0 - 2.0 * poissons_ratio));
  return result;
}

double cotangent(const Vector3d& a, const Vector3d& b) { return a.dot(b) / a.cross(b).norm(); }

/// The weights of [bergou2006] for the edge from a to b between the triangles (a, b, c) and (b, a,
/// d).
Eigen::Vector4d hinge_weights(const Vector3d& a, const Vector3d& b, const Vector3d& c,
                              const Vector3d& d) {
  const double ac = cotangent(b - a, c - a), ad = cotangent(b - a, d - a);
  const double bc = cotangent(a - b, c - b), bd = cotangent(a - b, d - b);
  const double areas = ((b - a).cross(c - a).norm() + (b - a).cross(d - a).norm()) / 2.0;
  const double scale = std::sqrt(3.0 * bending_stiffness / areas);
  return scale * Eigen::Vector4d(bc + bd, ac + ad, -ac - bc, -ad - bd);
}

void append(Eigen::VectorXd& all, const Eigen::VectorXd& added) {
  all.conservativeResize(all.size() + added.size());
  all.tail(added.size()) = added;
}

}  // namespace

void Derivatives::add(std::span<const std::int32_t> vertices,
                      const Eigen::Ref<const Eigen::VectorXd>& gradient_of,
                      const Eigen::Ref<const Eigen::MatrixXd>& hessian_of) {
  for (std::size_t a = 0; a < vertices.size(); ++a) {
    const auto local = 3 * static_cast<Index>(a);
    gradient.segment<3>(3 * Index{vertices[a]}) += gradient_of.segment<3>(local);
    for (Index i = 0; i < 3; ++i) {
      for (Index column = 0; column < hessian_of.cols(); ++column) {
        hessian.emplace_back(3 * vertices[a] + i,
                             3 * vertices[static_cast<std::size_t>(column / 3)] + column % 3,
                             hessian_of(local + i, column));
      }
    }
  }
}

World::World(const Scene& scene) : pins_(scene.pins) {
  std::vector<std::int32_t> first_vertices;
  for (const Body& body : scene.bodies) {
    first_vertices.push_back(static_cast<std::int32_t>(coordinates() / 3));
    add(body);
  }
  for (Pin& pin : pins_) pin.vertex += first_vertices.at(static_cast<std::size_t>(pin.body));
}

void World::add(const Body& body) {
  const auto first = static_cast<std::int32_t>(coordinates() / 3);
  const bool is_held = body.kind == BodyKind::obstacle;
  const Index vertices = body.vertices.rows();
  append(start_, body.vertices.reshaped<Eigen::RowMajor>());
  append(velocity_, body.velocity.replicate(vertices, 1));
  append(masses_, Eigen::VectorXd::Zero(3 * vertices));
  is_held_.insert(is_held_.end(), static_cast<std::size_t>(vertices), is_held);
  groups_.insert(groups_.end(), static_cast<std::size_t>(vertices), is_held ? 0 : 1);
  if (is_held) obstacles_apart_ = {{0, 0}};
  for (fast::Face face : body.faces) {
    for (std::int32_t& vertex : face) vertex += first;
    faces_.push_back(face);
  }
  const auto place = [&](std::int32_t vertex) -> Vector3d {
    return body.vertices.row(vertex).transpose();
  };
  const auto spread = [&](auto& element) {
    for (std::int32_t& vertex : element.vertices) {
      vertex += first;
      masses_.segment<3>(3 * Index{vertex}).array() +=
          body.density * element.measure / static_cast<double>(element.vertices.size());
    }
  };
  for (const Tetrahedron& vertices_of : body.tetrahedra) {
    Matrix3d frame;
    for (std::size_t k = 0; k < 3; ++k) {
      frame.col(static_cast<Index>(k)) = place(vertices_of[k + 1]) - place(vertices_of[0]);
    }
    spread(tetrahedra_.emplace_back(element_of<3>(vertices_of, frame, body.youngs_modulus)));
  }
  if (body.kind != BodyKind::cloth) return;
  for (const fast::Face& face : body.faces) {
    // In the triangle's plane.
    const Vector3d along = place(face[1]) - place(face[0]), other = place(face[2]) - place(face[0]);
    const Vector3d x = along.normalized(), y = along.cross(other).cross(along).normalized();
    const Eigen::Matrix2d frame{{along.norm(), other.dot(x)}, {0.0, other.dot(y)}};
    spread(triangles_.emplace_back(element_of<2>(face, frame, body.youngs_modulus)));
  }
  add_hinges(body, first);
}

void World::add_hinges(const Body& body, std::int32_t first) {
  // The vertex across each edge, from the first triangle that has it.
  std::map<std::array<std::int32_t, 2>, std::int32_t> across;
  const auto place = [&](std::int32_t vertex) -> Vector3d {
    return body.vertices.row(vertex).transpose();
  };
  for (const fast::Face& face : body.faces) {
    for (std::size_t i = 0; i < 3; ++i) {
      const std::int32_t a = face[i], b = face[(i + 1) % 3], c = face[(i + 2) % 3];
      const auto [entry, is_first] = across.try_emplace({std::min(a, b), std::max(a, b)}, c);
      if (is_first) continue;
      const std::int32_t d = entry->second;
      hinges_.push_back({{first + a, first + b, first + c, first + d},
                         hinge_weights(place(a), place(b), place(c), place(d))});
    }
  }
}

double World::energy(const Eigen::VectorXd& x, double time, Derivatives* derivatives) const {
  double result = 0.0;
  for (const Element<3>& element : tetrahedra_) result += element_energy(element, x, derivatives);
  for (const Element<2>& element : triangles_) result += element_energy(element, x, derivatives);
  for (const Hinge& hinge : hinges_) {
    Eigen::Matrix<double, 3, 12> map;
    Vector3d sum = Vector3d::Zero();
    for (Index a = 0; a < 4; ++a) {
      map.block<3, 3>(0, 3 * a) = hinge.weights[a] * Matrix3d::Identity();
      sum +=
          hinge.weights[a] * x.segment<3>(3 * Index{hinge.vertices[static_cast<std::size_t>(a)]});
    }
    result += sum.squaredNorm() / 2.0;
    if (derivatives != nullptr)
      derivatives->add(hinge.vertices, map.transpose() * sum, map.transpose() * map);
  }
  for (const Pin& pin : pins_) {
    const Vector3d stretch = x.segment<3>(3 * Index{pin.vertex}) - pin.place(time);
    result += pin_stiffness * stretch.squaredNorm() / 2.0;
    if (derivatives != nullptr) {
      derivatives->add({&pin.vertex, 1}, pin_stiffness * stretch,
                       pin_stiffness * Matrix3d::Identity());
    }
  }
  return result;
}

fast::Step World::step(const Eigen::VectorXd& x0, const Eigen::VectorXd& x1,
                       const Separation& separation) const {
  const auto span = [](const Eigen::VectorXd& x) {
    return std::span<const double>(x.data(), static_cast<std::size_t>(x.size()));
  };
  return {
      span(x0),
      span(x1),
      {.faces = faces_},
      {.separation = separation, .groups = {.of_vertices = groups_, .apart = obstacles_apart_}}};
}

}  // namespace touchstone::simulation
