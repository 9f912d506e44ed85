// SPDX-License-Identifier: GPL-3.0-or-later
// A first look at a file, before a case is made of it: what it holds, what was repaired, and where the neck may be.
#pragma once
#include "tools/case_builder/case_folder.h"
#include "tools/case_builder/progress.h"

namespace insula::case_builder {

struct Inspection {
  TriMesh surface;  ///< mm, mended and closed, in the frame of the author's file
  Json facts;  ///< those of intake.json; also size_mm [x, y, z], neck: neck_json(), and problem, empty where a neck was
               ///< found
};

/// Throws InputError if the file is no vessel. One without openings is shown too, so that its ends can be cut.
Inspection inspect(const fs::path& input, const Options& options, Progress& progress);

/// Prints the facts as JSON, or writes inspect.json and surface.ply to a folder. Of a scan without a threshold or a
/// label: those of scan_look.h, or scan.json, scan.raw and the scan without its other tags, scan.mha.
void run_inspect(const fs::path& input, const fs::path& folder, const Options& options, std::FILE* out,
                 Progress& progress);

}  // namespace insula::case_builder
