// SPDX-License-Identifier: GPL-3.0-or-later
// The stage between wall and place: an author's own brain becomes lobes with tetrahedra and fine surfaces, as those of
// meshes/lobes. It must lie in their frame (MNI, mm). What the part of the scenes looks at is a ball about the fissure:
// the rest is left out.
#pragma once
#include "tools/case_builder/approach.h"
#include "tools/case_builder/place.h"
#include "tools/case_builder/progress.h"
#include "tools/mesh_lobes/part_fields.h"

namespace insula::case_builder {

/// What was given, as labels.
struct BrainLabels {
  mesh_tool::NiftiVolume volume;
  std::vector<mesh_tool::Part> parts;  ///< in the order of Approach::parts
  bool own_fissure = true;             ///< false: its lobes are told apart by the shipped ones
};
/// Reads labels, one surface a lobe, or one closed surface that is shared out to the nearest shipped lobe. Throws
/// InputError: what cannot be read, surfaces that are open, in pieces, or of a size that no lobe has, labels that do
/// not exist, lobes that are missing.
BrainLabels read_brain(const Options& options, const fs::path& project, const Approach& approach,
                       std::vector<Note>& notes);

/// How far the stage may move a brain so that its fissure lies where the arms, the hands and the microscope stand: its
/// field by so much, mm, and turned by so much, degrees. More than that is no matter of persons but of frames.
inline constexpr double farthest_move = 12, widest_turn = 20;
/// Lays the fissure of the brain, whose levels are `fields`, over the shipped one, and finds the levels again; the
/// motion that was made. What is too far away stays where it is, with a note.
Placement settle_in(BrainLabels& brain, mesh_tool::PartFields& fields, const Approach& approach,
                    std::vector<Note>& notes);
/// How the levels are found.
mesh_tool::FieldOptions field_options(const Approach& approach);
/// The motion that the stage found for the brain, for vessels in its frame; the identity when it stayed where it was.
Placement brain_motion(const CaseFolder& folder);

/// The stage: reads the files named by the options, writes brain/ and brain.json; without --brain it takes both away.
/// Throws InputError.
void run_brain(const CaseFolder& folder, const fs::path& project, const Options& options, Progress& progress);

}  // namespace insula::case_builder
