// SPDX-License-Identifier: GPL-3.0-or-later
// Closed triangle meshes of the URDF primitives, centred on the origin; lengths in metres.
#pragma once
#include "core/model/mesh.h"

namespace insula {

TriMesh box_mesh(const Vec3& size);
/// Axis z, flat ends.
TriMesh cylinder_mesh(double radius, double length);
TriMesh sphere_mesh(double radius);

}  // namespace insula
