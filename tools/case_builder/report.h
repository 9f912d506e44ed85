// SPDX-License-Identifier: GPL-3.0-or-later
// Stage 5: the quality report of a case, for persons (report.html, with pictures drawn here) and for programs
// (report.json). Step times are measured on this machine. These files are the only ones that differ from run to run.
#pragma once
#include "tools/case_builder/case_folder.h"
#include "tools/case_builder/progress.h"

namespace insula::case_builder {

/// Reads what all stages have written, runs the exercises, writes both reports; of the options it tells whether the
/// input was mirrored.
void run_report(const CaseFolder& folder, const fs::path& project, const Options& options, Progress& progress);

}  // namespace insula::case_builder
