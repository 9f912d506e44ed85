// SPDX-License-Identifier: GPL-3.0-or-later
// Volumes as input. Without ITK there is a plain message instead.
#pragma once
#include "core/model/mesh.h"
#include "tools/case_builder/case_folder.h"
#include "tools/mesh_lobes/volume.h"

namespace insula::case_builder {

bool is_volume_input(const fs::path& input);
/// Reads a volume, a DICOM series also from a .zip. Throws InputError, also if the program was built without ITK.
mesh_tool::NiftiVolume read_any_volume(const fs::path& input);
/// Reads a volume and takes the vessel's surface out of it, mm, mirrored where the options say so; their positions are
/// as_read. `ends`: where it is to be cut straight. Throws InputError.
TriMesh read_volume_surface(const fs::path& input, const Options& options, std::vector<Note>& notes,
                            std::vector<Plane>& ends);

}  // namespace insula::case_builder
