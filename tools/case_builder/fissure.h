// SPDX-License-Identifier: GPL-3.0-or-later
// The fissure that a vessel is placed in: lobes with their tetrahedra, the insula, the retractors, as the part of the
// scenes has them.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core/model/mesh.h"

namespace insula::case_builder {

/// A lobe at rest, mm.
struct Lobe {
  std::string name;  ///< frontal, temporal
  TetMesh tets;
  std::vector<char> fixed;  ///< nodes at the cut face of the ball
  TriMesh surface;
  struct EmbeddedVertex {
    int count = 0;
    std::array<int, 4> node{};
    std::array<double, 4> weight{};
    Vec3 offset = Vec3::Zero();
  };
  std::vector<EmbeddedVertex> embedded_vertices;  ///< where each surface vertex is: weighted nodes plus an offset
};

struct Fissure {
  std::vector<Lobe> lobes;
  TriMesh insula;
  TriMesh retractors;  ///< as they stand at home
};

/// `lobes`: a folder with frontal.msh, frontal_surface.ply, temporal..., insula_surface.ply in the frame of
/// meshes/lobes, mm; empty: those. Throws InputError.
Fissure read_fissure(const std::filesystem::path& project, const std::filesystem::path& lobes);

}  // namespace insula::case_builder
