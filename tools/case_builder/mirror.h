// SPDX-License-Identifier: GPL-3.0-or-later
// Mirrors an input at the plane x = 0, which separates the hemispheres of the MNI frame. The fissure, the arms and the
// microscope stand on the right. A left-sided input is therefore mirrored as it is read, and all stages see a
// right-sided one.
#pragma once
#include "core/model/mesh.h"
#include "tools/case_builder/options.h"
#include "tools/mesh_lobes/volume.h"

namespace insula::case_builder {

/// Triangles are turned round, so that those which faced outward still do. Twice gives the same mesh, bit for bit.
void mirror(TriMesh& mesh);
/// Voxels stay as they are stored; where they lie changes.
void mirror(mesh_tool::NiftiVolume& volume);

/// The options as the stages take them: positions are those of the author's file, so with `mirror` they go with what it
/// holds.
Options as_read(Options options);

}  // namespace insula::case_builder
