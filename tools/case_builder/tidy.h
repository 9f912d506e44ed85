// SPDX-License-Identifier: GPL-3.0-or-later
// Triangles as they come from other programs become one sound surface: repaired one by one, or made anew from a grid.
#pragma once
#include "tools/artery/surface.h"
#include "tools/case_builder/case_folder.h"

namespace insula::case_builder {

/// Triangles that agree, in one piece, without doubles. Walls that meet inside of the vessel are replaced by those of a
/// grid; ends are then to be found again. Every repair is noted. Throws InputError; `what` names the input.
void tidy_or_rebuild(TriMesh& mesh, const std::string& what, const Options& options, std::vector<Note>& notes);

/// The spacing of a grid that gives a surface some 20,000 triangles, mm.
double usual_spacing(const TriMesh& mesh);
/// Makes a surface anew from a grid. Its ends do not change. `why` begins the note. Throws InputError.
void make_anew(artery::Surface& surface, const std::string& why, const std::string& what, const Options& options,
               std::vector<Note>& notes);

/// The ending of a plural.
inline const char* ending(int n) { return n == 1 ? "" : "s"; }

}  // namespace insula::case_builder
