// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/rules.h"

#include <gtest/gtest.h>

#include "core/base/input_error.h"
#include "core/testing/block_mesh.h"

namespace insula::case_builder {
namespace {

constexpr const char* scene = R"(<scene title="a">
  <complications id="chance">
    <complication id="pressure_rises" command="heart set_systolic 150" probability="0.3" from="20 s" to="120 s"/>
  </complications>
  <exercise id="clipping" title="Clipping">
    <goal_clipped id="clip" text="Close the neck" on="artery" branches="a b" max_grade="2"
      hold="3 s"/>
    <fault_stenosis id="stenosis" text="Narrow" on="artery" branches="a b"/>
    <include file="parts/limits.xml"/>
    <time_limit id="time" limit="900 s"/>
  </exercise>
</scene>
)";
constexpr const char* part = R"(<?xml version="1.0"?>
<!-- What it bears. -->
<part>
  <variable name="vessel" value="artery"/>
  <fault_force id="force" text="Too much" on="$vessel" limit="0.3 N" grace="200 ms"/>
</part>
)";

class Rules : public testing::Test {
 protected:
  Rules() { folder_.write("parts/limits.xml", part); }
  std::string changed(const std::vector<std::string>& changes, int number = 3) const {
    Options o;
    o.rules = changes;
    return with_rules(scene, number, rule_changes(o), folder_.path());
  }
  std::string refusal(const std::string& change) const {
    try {
      changed({change});
    } catch (const InputError& e) {
      return e.what();
    }
    return {};
  }
  insula::test::SceneFolder folder_;
};

std::string replaced(std::string text, const std::string& what, const std::string& by) {
  return text.replace(text.find(what), what.size(), by);
}

TEST_F(Rules, ChangeTheirValuesAndNothingElse) {
  EXPECT_EQ(changed({"3.clip.max_grade=1"}), replaced(scene, "max_grade=\"2\"", "max_grade=\"1\""));
  EXPECT_EQ(changed({"3.time.limit=10 min"}), replaced(scene, "900 s", "10 min"));
  EXPECT_EQ(changed({"3.pressure_rises.probability=0"}), replaced(scene, "0.3", "0"));
  EXPECT_EQ(changed({"3.stenosis.grace=4 s"}), replaced(scene, "\"a b\"/>", "\"a b\" grace=\"4 s\"/>"));
  EXPECT_EQ(changed({"3.clip.text=Clip \"it\" & look"}),
            replaced(scene, "Close the neck", "Clip &quot;it&quot; &amp; look"));
  EXPECT_EQ(changed({"4.clip.max_grade=1"}), scene) << "is of another exercise";
}

TEST_F(Rules, AreLeftOut) {
  EXPECT_EQ(changed({"3.time=off", "3.time.limit=10 min"}),
            replaced(scene, "    <time_limit id=\"time\" limit=\"900 s\"/>\n", ""));
}

TEST_F(Rules, OfAPartAreWrittenOut) {
  EXPECT_EQ(
      changed({"3.force.limit=0.5 N"}),
      replaced(scene, "    <include file=\"parts/limits.xml\"/>\n",
               "  <fault_force id=\"force\" text=\"Too much\" on=\"artery\" limit=\"0.5 N\" grace=\"200 ms\"/>\n"));
}

TEST_F(Rules, ThatTheirDeclarationsDoNotAllowAreRefused) {
  EXPECT_NE(refusal("3.clip.max_grade=9").find("--rule 3.clip.max_grade=9: 9 is outside the allowed range 0 to 5"),
            std::string::npos)
      << refusal("3.clip.max_grade=9");
  EXPECT_NE(refusal("3.time.limit=10").find("unit"), std::string::npos) << refusal("3.time.limit=10");
  EXPECT_NE(refusal("3.clip.size=1").find("has no parameter \"size\"; it has"), std::string::npos);
  EXPECT_NE(refusal("3.neck.max_grade=1").find("no rule of that id"), std::string::npos);
  EXPECT_NE(refusal("3.clipping=off").find("is no goal, fault, clock or complication"), std::string::npos);
  for (const char* none : {"clip.max_grade=1", "5.clip.max_grade=1", "3.clip", "3.clip=on", "3.a b.c=1", "3..c=1", ""})
    EXPECT_THROW(read_rule_change(none), InputError) << none;
}

constexpr const char* tied = R"(<scene title="a">
  <strand_springs id="to_frontal" from="artery_wall" to="frontal_surface" density="24 1/cm2" max_length="5 mm"
    stiffness="40 N/m"/>
  <arachnoid_membrane id="membrane_to_frontal" strands="to_frontal" stiffness="8 N/m"/>
  <strand_springs id="to_branches" from="artery_wall" to="artery_wall" density="40 1/cm2"/>
  <exercise id="e"><goal_two_hands id="together" remaining="to_branches.standing"/></exercise>
</scene>
)";

TEST_F(Rules, StrandsAreChangedAndLeftOut) {
  const auto changed = [&](const std::vector<std::string>& changes) {
    Options o;
    o.rules = changes;
    return with_rules(tied, 2, rule_changes(o), folder_.path());
  };
  EXPECT_EQ(changed({"2.to_frontal.density=60 1/cm2", "2.to_frontal.stiffness=0.1 N/mm"}),
            replaced(replaced(tied, "24 1/cm2", "60 1/cm2"), "40 N/m", "0.1 N/mm"));
  EXPECT_EQ(changed({"2.membrane_to_frontal.stiffness=2 N/m"}), replaced(tied, "8 N/m", "2 N/m"));
  const std::string without = changed({"2.to_frontal=off"});
  EXPECT_EQ(without.find("to_frontal"), std::string::npos) << "its membrane goes with it: " << without;
  EXPECT_NE(without.find("to_branches"), std::string::npos);
  const auto refusal = [&](const std::string& change) -> std::string {
    try {
      changed({change});
    } catch (const InputError& e) {
      return e.what();
    }
    return {};
  };
  EXPECT_NE(refusal("2.to_branches=off").find("another part of the exercise needs it"), std::string::npos);
  EXPECT_NE(refusal("2.to_frontal.density=24").find("unit"), std::string::npos) << refusal("2.to_frontal.density=24");
  EXPECT_NE(refusal("2.to_frontal.stiffness=-1 N/m").find("range"), std::string::npos);

  folder_.write("a.xml", tied);
  const Json all = strands_of(tied, folder_.path() / "a.xml");
  ASSERT_EQ(all.size(), 3u) << all.dump(1);
  EXPECT_EQ(all[0]["id"], "to_frontal");
  EXPECT_EQ(all[0]["values"]["density"], "24 1/cm2");
  EXPECT_EQ(all[1]["element"], "arachnoid_membrane");
}

TEST_F(Rules, AreListedWithThoseOfParts) {
  folder_.write("a.xml", scene);
  const Json all = rules_of(scene, folder_.path() / "a.xml");
  ASSERT_EQ(all.size(), 5u) << all.dump(1);
  EXPECT_EQ(all[0]["id"], "pressure_rises");
  EXPECT_EQ(all[1]["element"], "goal_clipped");
  EXPECT_EQ(all[1]["values"]["max_grade"], "2");
  EXPECT_EQ(all[3]["values"]["on"], "artery");
  EXPECT_EQ(all[4]["text"], "");
}

}  // namespace
}  // namespace insula::case_builder
