#include "examples/simulation/world.hpp"

#include <Eigen/Dense>
#include <Eigen/Eigenvalues>

#include <cmath>
#include <cstddef>

namespace touchstone::simulation {
namespace {

using Eigen::Index;
using Eigen::Matrix3d;
using Eigen::Vector3d;

/// The stiffness of pins, in N/m.
constexpr double pin_stiffness = 1e4;
constexpr double poissons_ratio = 0.4;

/// Density and derivatives of an element's energy, as functions of F's columns one below the other.
struct Density {
  double value = 0.0;
  Eigen::Matrix<double, 9, 1> gradient;
  Eigen::Matrix<double, 9, 9> hessian;
};

void drop_negative_eigenvalues(Eigen::Matrix<double, 9, 9>& matrix) {
  const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 9, 9>> solver(matrix);
  if (solver.eigenvalues()[0] >= 0.0) return;
  matrix = solver.eigenvectors() * solver.eigenvalues().cwiseMax(0.0).asDiagonal() *
           solver.eigenvectors().transpose();
}

Matrix3d cross_matrix(const Vector3d& a) {
  return (Matrix3d() << 0.0, -a.z(), a.y(), a.z(), 0.0, -a.x(), -a.y(), a.x(), 0.0).finished();
}

Density density(const Matrix3d& f, double mu, double lambda, bool with_derivatives) {
  Density result;
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

double element_energy(const Element& element, const Eigen::VectorXd& x, Derivatives* derivatives) {
  Eigen::Matrix<double, 3, 4> places;
  for (std::size_t a = 0; a < 4; ++a)
    places.col(static_cast<Index>(a)) = x.segment<3>(3 * Index{element.vertices[a]});
  const Matrix3d f = places * element.b.transpose();
  const Density at = density(f, element.mu, element.lambda, derivatives != nullptr);
  if (derivatives != nullptr) {
    // F's columns from the coordinates: dF_j / dx_a = b_ja I.
    Eigen::Matrix<double, 9, 12> map;
    for (int j = 0; j < 3; ++j) {
      for (int a = 0; a < 4; ++a)
        map.block<3, 3>(3 * j, 3 * a) = element.b(j, a) * Matrix3d::Identity();
    }
    derivatives->add(element.vertices, element.volume * map.transpose() * at.gradient,
                     element.volume * map.transpose() * at.hessian * map);
  }
  return element.volume * at.value;
}

/// The element of a tetrahedron of a body at rest.
Element element_of(const Body& body, const Tetrahedron& vertices) {
  Matrix3d edges;
  for (std::size_t k = 0; k < 3; ++k) {
    edges.col(static_cast<Index>(k)) =
        (body.vertices.row(vertices[k + 1]) - body.vertices.row(vertices[0])).transpose();
  }
  Element result;
  result.vertices = vertices;
  const Matrix3d inverse = edges.inverse();
  result.b.rightCols<3>() = inverse.transpose();
  result.b.col(0) = -inverse.transpose().rowwise().sum();
  result.volume = std::abs(edges.determinant()) / 6.0;
  result.mu = body.youngs_modulus / (2.0 * (1.0 + poissons_ratio));
  result.lambda = body.youngs_modulus * poissons_ratio /
                  ((1.0 + poissons_ratio) * (1.0 - 2.0 * poissons_ratio));
  return result;
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
  for (const Body& body : scene.bodies) add(body);
}

void World::add(const Body& body) {
  const auto first = static_cast<std::int32_t>(coordinates() / 3);
  const Index vertices = body.vertices.rows();
  append(start_, body.vertices.reshaped<Eigen::RowMajor>());
  append(velocity_, body.velocity.replicate(vertices, 1));
  append(masses_, Eigen::VectorXd::Zero(3 * vertices));
  groups_.insert(groups_.end(), static_cast<std::size_t>(vertices), body.is_obstacle() ? 0 : 1);
  if (body.is_obstacle()) obstacles_apart_ = {{0, 0}};
  for (fast::Face face : body.faces) {
    for (std::int32_t& vertex : face) vertex += first;
    faces_.push_back(face);
  }
  for (const Tetrahedron& tetrahedron : body.tetrahedra) {
    Element& element = elements_.emplace_back(element_of(body, tetrahedron));
    for (std::int32_t& vertex : element.vertices) {
      vertex += first;
      masses_.segment<3>(3 * Index{vertex}).array() += body.density * element.volume / 4.0;
    }
  }
}

double World::energy(const Eigen::VectorXd& x, double time, Derivatives* derivatives) const {
  double result = 0.0;
  for (const Element& element : elements_) result += element_energy(element, x, derivatives);
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
  return {span(x0),
          span(x1),
          {.faces = faces_},
          {.solve = {.separation = separation},
           .groups = {.of_vertices = groups_, .apart = obstacles_apart_}}};
}

}  // namespace touchstone::simulation
