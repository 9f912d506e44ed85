// SPDX-License-Identifier: GPL-3.0-or-later
// A report's run as the training store keeps it.
#pragma once
#include "engine/reports/report_writer.h"
#include "training/store/records.h"

namespace insula {

/// Of a scene with an exercise. report: file of the report's page. The run gets a new uuid.
training::Run stored_run(const RunRecorder& recorder, const RunSummary& summary, const std::string& report);

}  // namespace insula
