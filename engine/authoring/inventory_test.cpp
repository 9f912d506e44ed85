// SPDX-License-Identifier: GPL-3.0-or-later
// The inventory of an example against what is known of it.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/testing/example.h"
#include "engine/authoring/inventory.h"
#include "engine/command_line/play.h"

namespace insula {
namespace {

const std::filesystem::path project = INSULA_SOURCE_DIR;

const InventoryItem* find(const std::vector<InventoryItem>& items, const std::string& group, const std::string& name) {
  for (const InventoryItem& i : items)
    if (i.group == group && i.name == name) return &i;
  return nullptr;
}

std::string value(const InventoryItem& item, const std::string& name) {
  for (const auto& [n, v] : item.values)
    if (n == name) return v;
  return "none";
}

TEST(Inventory, OfTheRulesExample) {
  const auto s = test::load(project / "plugins/exercise_rules/example.xml");
  ASSERT_TRUE(s);
  const auto items = inventory(*s);
  const auto* lower = find(items, "body", "lower");
  ASSERT_TRUE(lower);
  EXPECT_NE(lower->size.find("20.0 x 20.0 x 20.0 mm"), std::string::npos) << lower->size;
  EXPECT_NE(lower->size.find("file in mm"), std::string::npos) << lower->size;
  EXPECT_FALSE(lower->lines.empty());
  EXPECT_EQ(lower->lines.size() % 2, 0u);
  EXPECT_TRUE(find(items, "surface", "lower_surface"));
  const auto* strands = find(items, "drawable", "strands.fibres");
  ASSERT_TRUE(strands);
  EXPECT_EQ(double(strands->lines.size()), 2 * s->channel("strands.total"));
  ASSERT_TRUE(find(items, "constraint", "strands"));
  EXPECT_EQ(value(*find(items, "constraint", "strands"), "max_length"), "6 mm");
  int pairs = 0, anchors = 0;
  for (const InventoryItem& i : items) {
    pairs += i.group == "contact pair";
    if (i.group != "anchor") continue;
    ++anchors;
    EXPECT_FALSE(i.points.empty());
  }
  EXPECT_EQ(pairs, 3);
  EXPECT_EQ(anchors, 2);
  ASSERT_TRUE(find(items, "contact pair", "lower - upper"));
  const auto* knife = find(items, "tool", "knife");
  ASSERT_TRUE(knife);
  EXPECT_NE(knife->size.find("right hand"), std::string::npos) << knife->size;
}

TEST(Inventory, RegionsOfAVesselHaveTheirAreas) {
  const auto s = test::load(project / "plugins/membrane/example.xml");
  ASSERT_TRUE(s);
  double sum = 0, wall = 0;
  for (const InventoryItem& i : inventory(*s))
    if (i.group == "region") sum += std::atof(i.size.c_str() + i.size.rfind(", ") + 2);
  for (const ShellBody* shell : s->scene().all<ShellBody>())
    for (const auto& t : shell->wall_triangles()) {
      const auto& v = shell->rest().vertices;
      wall += 0.5e6 *
              (v[std::size_t(t[1])] - v[std::size_t(t[0])]).cross(v[std::size_t(t[2])] - v[std::size_t(t[0])]).norm();
    }
  ASSERT_GT(wall, 0);
  EXPECT_NEAR(sum, wall, 0.01 * wall);
}

TEST(Texts, EveryTextOfAScenesExerciseComesOnce) {
  std::ostringstream out, err;
  const std::filesystem::path scene = project / "scenes/training/3_clipping.xml";
  ASSERT_EQ(cmd_texts({test::builtin(), out, err}, {scene, scene}), 0) << err.str();
  const auto texts = nlohmann::json::parse(out.str());
  const auto count = [&](const std::string& text, const std::string& kind) {
    return std::count(texts.begin(), texts.end(), nlohmann::json{{"text", text}, {"kind", kind}});
  };
  EXPECT_EQ(count("Close the neck and keep both branches open", "goal"), 1);
  EXPECT_EQ(count("The dome has ruptured", "fault"), 1);
  EXPECT_EQ(count("Open the blades wide enough to pass the dome, and never press on it", "advice"), 1);
  std::ostringstream none, errors;
  EXPECT_EQ(cmd_texts({test::builtin(), none, errors}, {"nowhere.xml"}), 2);
  EXPECT_EQ(nlohmann::json::parse(none.str()), nlohmann::json::array());
}

TEST(Inventory, ListNamesEverything) {
  std::ostringstream out, err;
  EXPECT_EQ(cmd_view_list({test::builtin(), out, err}, project / "plugins/exercise_rules/example.xml"), 0) << err.str();
  for (const char* text : {"body:", "anchor:", "contact pair:", " mm"})
    EXPECT_NE(out.str().find(text), std::string::npos) << text << "\n" << out.str();
  EXPECT_EQ(cmd_view_list({test::builtin(), out, err}, "nowhere.xml"), 2);
}

}  // namespace
}  // namespace insula
