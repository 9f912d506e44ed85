// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/clip_trial.h"

#include <gtest/gtest.h>

#include "core/base/input_error.h"

namespace insula::case_builder {
namespace {

TEST(ClipTrial, PutsTheClipInPlaceOfTheFirstOfTheTray) {
  const std::string part =
      "<part>\n  <clip id=\"straight\" model=\"meshes/clips/straight/straight.urdf\"/>\n"
      "  <clip id=\"temporary_straight\" model=\"meshes/clips/temporary_straight/temporary_straight.urdf\"/>\n"
      "  <contact between=\"artery straight temporary_straight\"/>\n</part>\n";
  EXPECT_EQ(with_clip(part, "curved_12"),
            "<part>\n  <clip id=\"curved_12\" model=\"meshes/clips/curved_12/curved_12.urdf\"/>\n"
            "  <clip id=\"temporary_straight\" model=\"meshes/clips/temporary_straight/temporary_straight.urdf\"/>\n"
            "  <contact between=\"artery curved_12 temporary_straight\"/>\n</part>\n");
  EXPECT_EQ(with_clip(part, "temporary_straight"), part) << "it lies there";
  EXPECT_THROW(with_clip("<part/>", "curved_12"), InputError);
}

}  // namespace
}  // namespace insula::case_builder
