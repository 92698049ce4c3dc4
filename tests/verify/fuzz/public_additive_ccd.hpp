#pragma once

/// \file
/// Declarations of the public IPC Toolkit that a standalone program calls, with the same
/// signatures, to compile against.

#include <Eigen/Core>

namespace ipc {

class AdditiveCCD {
 public:
  explicit AdditiveCCD(long max_iterations = -1, double conservative_rescaling = 0.9);

  bool point_triangle_ccd(const Eigen::Vector3d& p_t0, const Eigen::Vector3d& t0_t0,
                          const Eigen::Vector3d& t1_t0, const Eigen::Vector3d& t2_t0,
                          const Eigen::Vector3d& p_t1, const Eigen::Vector3d& t0_t1,
                          const Eigen::Vector3d& t1_t1, const Eigen::Vector3d& t2_t1, double& toi,
                          double min_distance = 0.0, double tmax = 1.0) const;

  bool edge_edge_ccd(const Eigen::Vector3d& ea0_t0, const Eigen::Vector3d& ea1_t0,
                     const Eigen::Vector3d& eb0_t0, const Eigen::Vector3d& eb1_t0,
                     const Eigen::Vector3d& ea0_t1, const Eigen::Vector3d& ea1_t1,
                     const Eigen::Vector3d& eb0_t1, const Eigen::Vector3d& eb1_t1, double& toi,
                     double min_distance = 0.0, double tmax = 1.0) const;
};

}  // namespace ipc
