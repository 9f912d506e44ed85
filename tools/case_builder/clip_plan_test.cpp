// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/clip_plan.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "tools/case_builder/intake.h"
#include "tools/case_builder/progress.h"
#include "tools/case_builder/shapes_for_test.h"
#include "tools/case_builder/wall.h"

namespace insula::case_builder {
namespace {

bool is_large(const ClipShape& clip) { return clip.name.starts_with("large_"); }

TEST(ClipPlans, LargeClipsAreThoseWhoseTipsOpenWide) {
  int large = 0;
  for (const ClipShape& clip : read_clips(INSULA_SOURCE_DIR)) {
    EXPECT_EQ(clip.tips_open() > 10, is_large(clip)) << clip.name << ": " << clip.tips_open();
    large += is_large(clip);
  }
  EXPECT_EQ(large, 4);
}

TEST(ClipPlans, LargeClipsAreTriedWithMoreCareOnlyOrWhenAskedFor) {
  Options o;
  std::vector<Note> notes;
  Progress quiet;
  const artery::Vessel v = make_wall(mended(test::tube_with_sac(), "tube", o, {}).surface, o, notes, quiet);
  const Solid floor(test::joined(test::tube_with_sac(), {}, Vec3(0, 0, -60)));
  const std::vector<ClipShape> clips = read_clips(INSULA_SOURCE_DIR);
  const Approach approach = read_approach(INSULA_SOURCE_DIR, o.approach);
  const auto has_large = [&](Care care) {
    const std::vector<ClipPlan> plans = clip_plans(v, floor, clips, o, approach, care);
    return std::any_of(plans.begin(), plans.end(), [](const ClipPlan& p) { return is_large(p.clip); });
  };
  EXPECT_FALSE(has_large(Care::usual));
  EXPECT_TRUE(has_large(Care::more));
  o.clip = "large_straight_12";
  EXPECT_TRUE(has_large(Care::usual));
}

}  // namespace
}  // namespace insula::case_builder
