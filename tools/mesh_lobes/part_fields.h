// SPDX-License-Identifier: GPL-3.0-or-later
// From a label volume to level functions of the chosen parts: one fine, one coarse, positive inside, millimetres.
#pragma once

#include <string>
#include <vector>

#include "volume.h"

namespace insula::mesh_tool {

struct Part {
  std::string name;
  std::vector<int> labels;
};

struct FieldOptions {
  double spacing = 0.5;           // working grid, mm
  Vec3 centre{};                  // region of interest: a sphere, RAS mm
  double radius = 0;              // <= 0: the whole volume
  double tissue = 0;              // intensity at which tissue begins (with an intensity volume)
  double tissue_slope = 25;       // change of intensity a millimetre across that border
  double seed_depth = 1.5;        // labels claim their voxels only this far (mm) from labels of other parts
  double gap = 1;                 // free space left between the fine surfaces of two parts, mm
  double smoothing = 0.6;         // Gaussian on the fine level, mm
  double border_smoothing = 1.2;  // Gaussian on the borders between parts, mm
  double fine_closing = 1;        // radius of sulci filled in the fine surface, mm
  double fine_opening = 1;        // radius of specks and threads (vessel remains) taken off the fine surface, mm
  double coarse_closing = 2.5;    // the same for the coarse shape
  double coarse_smoothing = 1.5;  // Gaussian on the coarse level, mm
  double coarse_outset = 0.6;     // the coarse shape is grown by this, mm, so that it holds the fine surface
  double coarse_gap = 0.35;       // free space wanted between the tetrahedra of two parts, mm
};

struct PartFields {
  Grid grid;
  std::vector<Field> fine;    // a part each; the positive sets are disjoint and `gap` apart
  std::vector<Field> coarse;  // a part each; the positive sets are disjoint and about twice `coarse_gap` apart
  std::vector<Field> others;  // distance (mm) to the fine sets of all other parts
};

// Writes labels of another volume into the voxels of `labels`: its label N becomes 1000 + N wherever a part has that
// one.
void add_labels(NiftiVolume& labels, const NiftiVolume& more, const std::vector<Part>& parts);

// Gives every voxel of tissue to a part (or to "anything else") by growth from the labels along bright tissue, and then
// builds the levels. Borders therefore follow the dark sulci, and white matter without a label joins the gyrus above
// it. `intensity` may be null: then every labelled voxel is tissue. Throws std::runtime_error when a part is empty.
PartFields build_part_fields(const NiftiVolume& labels, const NiftiVolume* intensity, const std::vector<Part>& parts,
                             const FieldOptions& options);

}  // namespace insula::mesh_tool
