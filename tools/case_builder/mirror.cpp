// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/mirror.h"

#include "tools/case_builder/topology.h"

namespace insula::case_builder {
namespace {

/// No zero gets a sign: a file would show it.
void flip(double& x) { x = 0.0 - x; }

}  // namespace

void mirror(TriMesh& mesh) {
  for (Vec3& p : mesh.vertices) flip(p.x());
  turn_inside_out(mesh);
}

void mirror(mesh_tool::NiftiVolume& volume) {
  for (std::size_t c = 0; c < 4; ++c) flip(volume.to_world[c]);
  for (std::size_t r = 0; r < 3; ++r) flip(volume.from_world[4 * r]);
}

Options as_read(Options o) {
  if (!o.mirror) return o;
  if (o.seed) flip((*o.seed)[0]);
  if (o.inlet) flip((*o.inlet)[0]);
  // Both numbers of x: of a point and its normal, or of two points.
  const auto both = [](std::array<double, 6>& a) { flip(a[0]), flip(a[3]); };
  for (Plane& cut : o.cuts) both(cut);
  for (Stroke& stroke : o.paint)
    for (Point& p : stroke.points) flip(p[0]);
  for (WallPatch& patch : o.wall_patches)
    for (Point& p : patch.points) flip(p[0]);
  if (o.neck) both(*o.neck);
  if (o.neck_points) both(*o.neck_points);
  return o;
}

}  // namespace insula::case_builder
