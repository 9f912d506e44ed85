// SPDX-License-Identifier: GPL-3.0-or-later
// Stage 1: a file becomes one closed surface in millimetres whose openings are flat caps, with everything that was
// repaired written down.
#pragma once
#include "tools/artery/surface.h"
#include "tools/case_builder/case_folder.h"
#include "tools/case_builder/progress.h"

namespace insula::case_builder {

/// What the surface of a vessel looks like before anything is made of it.
struct Intake {
  artery::Surface surface;  ///< mm, closed, outward; caps from the widest down
  std::vector<Note> notes;
  Json facts;  ///< counts and sizes, for the report
};

/// A vessel has two openings at least. Before its ends are cut, it may have fewer.
enum class Openings { two, any };

/// Mends a surface (mm) or says why it cannot be mended. Throws InputError; `what` names the input in messages.
Intake mended(TriMesh mesh, const std::string& what, const Options& options, std::vector<Note> notes,
              Openings needed = Openings::two);

/// Reads a surface or a volume and mends it. Throws InputError.
Intake take_in(const fs::path& input, const Options& options, Progress& progress, Openings needed = Openings::two);

/// The stage: writes intake/surface.ply and intake/intake.json.
void run_intake(const CaseFolder& folder, const fs::path& input, const Options& options, Progress& progress);
/// What the stage wrote.
Intake read_intake(const CaseFolder& folder);

}  // namespace insula::case_builder
