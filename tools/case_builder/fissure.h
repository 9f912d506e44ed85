// SPDX-License-Identifier: GPL-3.0-or-later
// The fissure that a vessel is placed in: lobes with their tetrahedra, the insula, the retractors, as the part of the
// scenes has them.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core/model/mesh.h"
#include "tools/case_builder/approach.h"
#include "tools/case_builder/retractors.h"

namespace insula::case_builder {

/// A lobe at rest, mm.
struct Lobe {
  std::string name;  ///< as the approach calls it
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
  Approach approach;
  std::vector<Lobe> lobes;
  TriMesh floor;                      ///< rigid
  TriMesh retractors;                 ///< as they stand at home
  TriMesh blade;                      ///< of one, as at_place() takes it
  std::vector<RetractorAt> proposed;  ///< those of the approach
  struct Rigid {
    std::string name;  ///< of Approach::obstacles
    TriMesh mesh;
  };
  std::vector<Rigid> obstacles;  ///< bone, falx
};

/// `lobes`: a folder with NAME.msh and NAME_surface.ply of the approach's lobes, and its floor's surface, in the frame
/// of its meshes, mm; empty: those. Throws InputError.
Fissure read_fissure(const std::filesystem::path& project, const std::filesystem::path& lobes,
                     const Approach& approach);

/// The retractors of a case: the author's, if there are any, else those of the approach. Throws InputError.
std::vector<RetractorAt> retractors_of(const Options& options, const Fissure& fissure);
/// The fissure with those.
Fissure with_retractors(Fissure fissure, const Options& options);

}  // namespace insula::case_builder
