// SPDX-License-Identifier: GPL-3.0-or-later
// Stage 4: the placed vessel and its lobes become the four exercises, as scene files that an author can go on editing.
#pragma once
#include "tools/case_builder/approach.h"
#include "tools/case_builder/progress.h"

namespace insula::case_builder {

/// How files of the case name those of the project. Outside of the project what they need is copied into the case.
struct Assets {
  std::string meshes;  ///< from a file in the case's folder
  std::string parts;   ///< the same
  std::string lobes;   ///< the case's lobes, from a file in the parts' folder
  bool copied = false;
};
Assets link_assets(const CaseFolder& folder, const fs::path& project, const std::vector<std::string>& clips,
                   const Approach& approach);

/// The file of an exercise: 1 opens the fissure, 2 frees the aneurysm, 3 clips it, 4 is its rupture.
fs::path exercise_file(const CaseFolder& folder, int number);
/// The files of all exercises that a case has, in order. Some approaches have no exercise 1.
std::vector<fs::path> exercise_files(const CaseFolder& folder);

/// Writes exercise 3 with the clip that seems to fit best, laid as its geometry says, and returns its file. Nothing has
/// been played. Throws InputError.
fs::path write_draft(const CaseFolder& folder, const fs::path& project, const Options& options);

/// The stage: reads artery/, lobes/ and wall/notes.json, writes *.xml and *.csv. Throws InputError.
void run_scenes(const CaseFolder& folder, const fs::path& project, const Options& options, Progress& progress);

}  // namespace insula::case_builder
