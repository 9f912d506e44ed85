// SPDX-License-Identifier: GPL-3.0-or-later
// What the report of a case says, as data: report.html and report.json are written from it.
#pragma once
#include <string>
#include <vector>

#include "tools/artery/vessel.h"
#include "tools/case_builder/case_folder.h"
#include "tools/case_builder/intake.h"
#include "tools/case_builder/measured_scene.h"

namespace insula::case_builder {

/// One line of the report. Where it is bad, `advice` says what to do, and `id` names the problem whatever its numbers.
struct Finding {
  enum class Judged { fact, good, mended, bad };
  std::string what, value;
  Judged judged = Judged::fact;
  std::string advice = {}, id = {};
};

struct FindingSection {
  std::string title;
  std::vector<Finding> findings;
};

FindingSection input_findings(const Intake& intake, const Options& options);
/// `wall`: wall/notes.json.
FindingSection wall_findings(const artery::Vessel& vessel, const Json& wall);
/// `brain`: brain.json. `place`: place.json.
FindingSection brain_findings(const Json& brain);
FindingSection fissure_findings(const Json& place);
/// `scenes`: scenes.json. The third exercise also with its scripted hands.
FindingSection exercise_findings(const Json& scenes, const std::vector<MeasuredScene>& exercises,
                                 const MeasuredMotion& clipping);

}  // namespace insula::case_builder
