// SPDX-License-Identifier: GPL-3.0-or-later
// What is wrong with a case has a name and a remedy in both reports.
#include <gtest/gtest.h>

#include "tools/case_builder/findings.h"

namespace insula::case_builder {
namespace {

const Finding* bad(const FindingSection& section, const std::string& id) {
  for (const Finding& f : section.findings)
    if (f.judged == Finding::Judged::bad && f.id == id) return &f;
  return nullptr;
}

TEST(Findings, AProblemKeepsItsNameAndRemedyThroughTheFilesOfTheStages) {
  const std::vector<Note> notes{problem("end_not_cut", "branch_1 could not be cut off.", "Cut it with --cut."),
                                {Note::Kind::fact, "A fact.", ""}};
  const std::vector<Note> read = notes_from_json(to_json(notes));
  ASSERT_EQ(read.size(), 2u);
  EXPECT_EQ(read[0].id, "end_not_cut");
  EXPECT_EQ(read[1].id, "");
  const FindingSection s = fissure_findings({{"rooms", Json::array()}, {"notes", to_json(notes)}});
  const Finding* f = bad(s, "end_not_cut");
  ASSERT_TRUE(f);
  EXPECT_EQ(f->advice, "Cut it with --cut.");
}

TEST(Findings, AnOverlapIsBadAndRoomIsGood) {
  const auto place = [](double after) {
    return Json{{"rooms", {{{"what", "frontal"}, {"before_mm", -1.0}, {"after_mm", after}}}}, {"notes", Json::array()}};
  };
  EXPECT_TRUE(bad(fissure_findings(place(-0.2)), "overlap"));
  EXPECT_FALSE(bad(fissure_findings(place(0.2)), "overlap"));
}

TEST(Findings, AnExerciseThatIsRefusedOrTooSlowIsNamed) {
  const Json scenes{{"clip", {{"name", "straight_7"}, {"blade_mm", 7}, {"needed_mm", 6}, {"off_view_deg", 10}}},
                    {"notes", Json::array()}};
  MeasuredScene refused, slow, right;
  refused.file = "1.xml", refused.message = "no such file";
  slow.file = "2.xml", slow.step_ms = 20, slow.budget_ms = 16;
  right.file = "3.xml", right.step_ms = 4, right.budget_ms = 16;
  MeasuredMotion clipping;
  clipping.step_ms = 17, clipping.steps = 5;
  const FindingSection s = exercise_findings(scenes, {refused, slow, right}, clipping);
  EXPECT_TRUE(bad(s, "scene_refused"));
  EXPECT_TRUE(bad(s, "too_slow"));
  EXPECT_TRUE(bad(s, "too_slow_while_clipped"));
  for (const Finding& f : s.findings)
    if (f.judged == Finding::Judged::bad) {
      EXPECT_FALSE(f.id.empty()) << f.what;
      EXPECT_FALSE(f.advice.empty()) << f.what;
    }
  EXPECT_TRUE(bad(exercise_findings(scenes, {right, right, right}, {}), "clip_touches_nothing"));
}

}  // namespace
}  // namespace insula::case_builder
