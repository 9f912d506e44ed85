// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/reports/hints_report.h"

#include <gtest/gtest.h>

namespace insula {
namespace {

TEST(HintsReport, SaysInWordsWhatWasWatched) {
  EXPECT_EQ(cues_html({}, true), "");
  Cue cue;
  cue.cause.text = "Ease off";
  cue.cause.watched = "vessel_force.right.force";
  cue.cause.value = "160 mN";
  cue.cause.limit = "200 mN";
  cue.cause.share = 0.8;
  const std::string html = cues_html({cue}, true);
  EXPECT_NE(html.find("<td>vessel force, right, force</td>"), std::string::npos) << html;
  EXPECT_EQ(cues_json({cue})[0]["watched"], "vessel_force.right.force") << "programs read the id";
}

}  // namespace
}  // namespace insula
