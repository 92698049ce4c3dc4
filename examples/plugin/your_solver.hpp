#pragma once

/// \file
/// Stands for a solver of your own, with the calls that solvers of others have. A template needs
/// one pair of these functions; put your own header in place of this one.

namespace yours {

/// Four points, x, y and z each: v, f0, f1, f2 or ea0, ea1, eb0, eb1.
using Points = double[4][3];
using FloatPoints = float[4][3];
/// Of each point its place at t=0, then at t=1.
using Trajectories = double[4][2][3];

/// Do they collide?
bool vertex_face(const Points& start, const Points& end);
bool edge_edge(const Points& start, const Points& end);

/// Do they collide, and about when? `toi` is set if they do.
bool vertex_face(const Points& start, const Points& end, double& toi);
bool edge_edge(const Points& start, const Points& end, double& toi);

/// The same in single precision.
bool vertex_face(const FloatPoints& start, const FloatPoints& end, float& toi);
bool edge_edge(const FloatPoints& start, const FloatPoints& end, float& toi);

/// The same with both ends of a point beside each other. `toi` is a lower bound.
bool vertex_face(const Trajectories& points, double& toi);
bool edge_edge(const Trajectories& points, double& toi);

/// Does the volume, or the area of the first three points in the plane, become 0 or negative?
/// `toi` is a lower bound of the first time if it does.
bool tetrahedron(const Points& start, const Points& end, double& toi);
bool plane_triangle(const Points& start, const Points& end, double& toi);

}  // namespace yours
