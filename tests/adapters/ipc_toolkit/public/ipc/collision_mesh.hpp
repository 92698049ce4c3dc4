#pragma once

/// \file
/// The collision mesh of the public IPC Toolkit, as far as the adapter reads it: the same names and
/// meanings, to compile against.

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstddef>
#include <functional>
#include <ipc/ccd/narrow_phase_ccd.hpp>
#include <utility>
#include <vector>

namespace ipc {

class CollisionMesh {
 public:
  CollisionMesh(Eigen::MatrixXd rest_positions, Eigen::MatrixXi edges, Eigen::MatrixXi faces)
      : rest_positions_(std::move(rest_positions)),
        edges_(std::move(edges)),
        faces_(std::move(faces)) {
    std::vector<bool> has_edge(num_vertices(), false);
    for (const int i : edges_.reshaped()) has_edge[static_cast<std::size_t>(i)] = true;
    std::vector<int> without;
    for (std::size_t i = 0; i < num_vertices(); ++i) {
      if (!has_edge[i]) without.push_back(static_cast<int>(i));
    }
    codim_vertices_ =
        Eigen::Map<Eigen::VectorXi>(without.data(), static_cast<Eigen::Index>(without.size()));
  }

  [[nodiscard]] std::size_t num_vertices() const {
    return static_cast<std::size_t>(rest_positions_.rows());
  }
  [[nodiscard]] std::size_t dim() const { return static_cast<std::size_t>(rest_positions_.cols()); }
  [[nodiscard]] const Eigen::VectorXi& codim_vertices() const { return codim_vertices_; }
  [[nodiscard]] const Eigen::MatrixXi& edges() const { return edges_; }
  [[nodiscard]] const Eigen::MatrixXi& faces() const { return faces_; }

  std::function<bool(std::size_t, std::size_t)> can_collide = [](std::size_t, std::size_t) {
    return true;
  };
  std::vector<Eigen::Hyperplane<double, 3>> planes;

 private:
  Eigen::MatrixXd rest_positions_;
  Eigen::MatrixXi edges_;
  Eigen::MatrixXi faces_;
  Eigen::VectorXi codim_vertices_;
};

}  // namespace ipc
