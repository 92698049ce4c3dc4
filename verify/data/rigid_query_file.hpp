#pragma once

/// \file
/// Queries of rigid bodies in JSON, as rigid-ipc writes them: `type` is "fv" or "ee"; below `face`
/// and `vertex`, or `edge0` and `edge1`, are `pose_t0` and `pose_t1`, each with `position` and
/// `rotation` (a rotation vector in radians), and the points of the body: `vertex`, or `vertex0`,
/// `vertex1` and `vertex2`.

#include <filesystem>

#include "touchstone/rigid_motion.hpp"

namespace touchstone::verify::data {

struct KindOfRigidQuery {
  Kind kind = Kind::vertex_face;
  exact::RigidQuery query;
};

/// \throws io::DatasetError, which names the file and the member, for anything else.
[[nodiscard]] KindOfRigidQuery read_rigid_query(const std::filesystem::path& file);

}  // namespace touchstone::verify::data
