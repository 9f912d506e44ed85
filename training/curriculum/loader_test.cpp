// SPDX-License-Identifier: GPL-3.0-or-later
// From text to data: what each element becomes, includes, the texts of gates, and hostile input. What is refused has
// its files in tests/curricula_bad.
#include "training/curriculum/loader.h"

#include <gtest/gtest.h>

#include <random>

#include "core/testing/temp_folder.h"
#include "training/curriculum/elements.h"

namespace insula {
namespace {

/// One scene for all files: a length of each hand, a time and a number without unit of both.
class OneScene final : public CurriculumSources {
 public:
  OneScene() {
    facts_.title = "Clipping";
    facts_.has_exercise = facts_.has_complications = true;
    facts_.faults = {{"torn", "A vein was torn"}, {"order", "The order"}};
    const auto add = [&](const char* id, Of of, Better better, auto quantity, const char* unit, double scale) {
      using Q = decltype(quantity);
      facts_.metrics.push_back(
          {id, "Text of " + std::string(id), of, better, std::string(Q::name), Q::units(), unit, scale});
    };
    add("path", Of::each_hand, Better::low, Length{}, "mm", 1000);
    add("time", Of::both_hands, Better::low, Duration{}, "s", 1);
    add("economy", Of::both_hands, Better::high, Scalar{}, "%", 100);
    add("balance", Of::both_hands, Better::none, Scalar{}, "", 1);
  }
  const SceneFacts& scene(const std::filesystem::path& file) override {
    seen_ = file;
    return facts_;
  }
  std::optional<BandFact> band(const std::filesystem::path& bands, const std::string& group, const SceneFacts&,
                               const MetricFact&, const std::string&, std::string& error) override {
    asked_ = bands.filename().string();
    if (group == "experts") return BandFact{8, 10, 12, 9};
    error = "no such group";
    return std::nullopt;
  }
  std::filesystem::path shipped_folder() const override { return shipped_; }
  std::string asked_;
  std::filesystem::path shipped_, seen_;

 private:
  SceneFacts facts_;
};

class LoadCurriculum : public testing::Test {
 protected:
  LoadCurriculum() {
    folder_.write("meshes/none.txt", "");
    folder_.write("scenes/clip.xml", "");
    folder_.write("scenes/clip_bands.json", "");
  }
  CurriculumResult load(const std::string& text) {
    return load_curriculum_text(text, folder_.path() / "curricula" / "c.xml", sources_);
  }
  /// A curriculum of one task with that content.
  static std::string one_task(const std::string& content, const std::string& attributes = "") {
    return R"(<curriculum title="C"><module id="m" title="M"><task id="t" title="T" scene="../scenes/clip.xml" )" +
           attributes + ">" + content + "</task></module></curriculum>";
  }
  Gate gate(const std::string& element) {
    auto result = load(one_task(element));
    EXPECT_EQ(result.diagnostics.format(), "");
    return result.curriculum ? result.curriculum->modules[0].tasks[0].gates.at(0) : Gate{};
  }
  test_files::TempFolder folder_;
  OneScene sources_;
};

TEST_F(LoadCurriculum, ElsewhereItMayNameFilesAsIfItLayAmongTheShippedOnes) {
  test_files::TempFolder data;
  data.write("curricula/own.xml", "");
  const auto load_there = [&](const std::string& scene) {
    const std::string text = R"(<curriculum title="C"><module id="m" title="M"><task id="t" title="T" scene=")" +
                             scene + R"("><gate_goals/></task></module></curriculum>)";
    return load_curriculum_text(text, data.path() / "curricula" / "c.xml", sources_).diagnostics.format();
  };
  EXPECT_NE(load_there("../scenes/clip.xml").find("leaves the scene's root folder"), std::string::npos);
  sources_.shipped_ = folder_.path() / "curricula";
  EXPECT_EQ(load_there("../scenes/clip.xml"), "");
  EXPECT_EQ(sources_.seen_, std::filesystem::canonical(folder_.path() / "scenes/clip.xml"));
  // What lies beside it comes first.
  folder_.write("curricula/own.xml", "");
  EXPECT_EQ(load_there("own.xml"), "");
  EXPECT_EQ(sources_.seen_, std::filesystem::canonical(data.path() / "curricula/own.xml"));
  // Neither may leave its folder, and the nearest name is of the place that was meant.
  EXPECT_NE(load_there("../../x.xml").find("leaves the scene's root folder"), std::string::npos);
  EXPECT_NE(load_there("../scenes/clp.xml").find("did you mean \"../scenes/clip.xml\"?"), std::string::npos);
  EXPECT_NE(load_there("owm.xml").find("did you mean \"own.xml\"?"), std::string::npos);
}

TEST_F(LoadCurriculum, EverythingBecomesData) {
  const auto result = load(R"(<curriculum title="Year" text="For residents">
    <module id="a" title="A"><task id="a1" title="A one" scene="../scenes/clip.xml"><gate_goals/></task></module>
    <module id="b" title="B" text="Then" requires="a" in_order="false">
      <task id="b1" title="B one" text="Look" scene="../scenes/clip.xml" mode="test" seeds="3 1 2">
        <gate_goals in_a_row="3" within="2 week"/>
        <gate_faults faults="torn order" at_most="1"/>
        <repetition after="1 3 7 day" grace="36 h" keep_on="true"/>
      </task>
    </module>
    <warm_up task="a1" times="2" text="Slowly"/>
    <warm_up scene="../scenes/clip.xml"/>
  </curriculum>)");
  EXPECT_EQ(result.diagnostics.format(), "");
  ASSERT_TRUE(result.curriculum);
  const Curriculum& c = *result.curriculum;
  EXPECT_EQ(c.title, "Year");
  EXPECT_NE(c.content_hash, 0u);
  ASSERT_EQ(c.modules.size(), 2u);
  EXPECT_TRUE(c.modules[0].in_order && c.modules[0].needs.empty());
  EXPECT_EQ(c.modules[1].needs, std::vector<std::string>{"a"});
  EXPECT_FALSE(c.modules[1].in_order);
  const Task& t = c.modules[1].tasks.at(0);
  EXPECT_EQ(t.scene, "scenes/clip.xml");
  EXPECT_EQ(t.mode, TaskMode::test);
  EXPECT_EQ(t.seeds, (std::vector<int>{3, 1, 2}));
  ASSERT_EQ(t.gates.size(), 2u);
  EXPECT_EQ(t.gates[0].in_a_row, 3);
  EXPECT_EQ(t.gates[0].within_ms, 14 * 86'400'000ll);
  EXPECT_EQ(t.gates[1].faults, (std::vector<std::string>{"torn", "order"}));
  EXPECT_EQ(t.gates[1].text, "At most 1 faults of these: A vein was torn, The order");
  ASSERT_TRUE(t.repetition);
  EXPECT_EQ(t.repetition->after_ms, (std::vector<std::int64_t>{86'400'000, 3 * 86'400'000ll, 7 * 86'400'000ll}));
  EXPECT_EQ(t.repetition->grace_ms, 36 * 3'600'000ll);
  EXPECT_TRUE(t.repetition->keep_on);
  ASSERT_EQ(c.warm_ups.size(), 2u);
  EXPECT_EQ(c.warm_ups[0].task, "a1");
  EXPECT_EQ(c.warm_ups[0].scene, "scenes/clip.xml");
  EXPECT_EQ(c.warm_ups[0].times, 2);
  EXPECT_EQ(c.warm_ups[1].task, "");
  EXPECT_EQ(find_task(c, "b1"), &t);
  EXPECT_EQ(find_task(c, "none"), nullptr);
}

TEST_F(LoadCurriculum, LimitsAreInTheUnitThatIsShown) {
  Gate g = gate(R"(<gate_metric metric="path" hand="left" at_most="0.9 m"/>)");
  EXPECT_EQ(g.hand, "left");
  EXPECT_EQ(g.unit, "mm");
  EXPECT_DOUBLE_EQ(g.at_most.value(), 900);
  EXPECT_FALSE(g.at_least);
  EXPECT_EQ(g.text, "Text of path, left hand: at most 900 mm");
  g = gate(R"(<gate_metric metric="economy" at_least="0.4" at_most="0.9"/>)");
  EXPECT_EQ(g.hand, "both");
  EXPECT_DOUBLE_EQ(g.at_least.value(), 40);
  EXPECT_EQ(g.text, "Text of economy: at least 40 % and at most 90 %");
}

TEST_F(LoadCurriculum, BandsLimitTheSideOfLessSkill) {
  const auto of = [&](const char* metric, const char* level) {
    return gate("<gate_metric metric=\"" + std::string(metric) + "\" group=\"experts\" level=\"" + level + "\"/>");
  };
  Gate g = of("time", "middle_half");
  EXPECT_EQ(g.at_most, 12);
  EXPECT_FALSE(g.at_least);
  EXPECT_EQ(g.text, "Text of time: at most 12 s, from the group \"experts\"");
  EXPECT_EQ(sources_.asked_, "clip_bands.json");
  g = of("economy", "middle_half");
  EXPECT_EQ(g.at_least, 8);
  EXPECT_FALSE(g.at_most);
  g = of("balance", "middle_half");
  EXPECT_EQ(g.at_least, 8);
  EXPECT_EQ(g.at_most, 12);
  EXPECT_EQ(of("time", "median").at_most, 10);
  EXPECT_EQ(of("time", "pass_mark").at_most, 9);
}

TEST_F(LoadCurriculum, PartsAreIncludedWithPrefixes) {
  folder_.write("curricula/part.xml", R"(<part><variable name="row" value="2"/>
    <module id="first" title="First">
      <task id="t" title="T" scene="../scenes/clip.xml"><gate_goals in_a_row="$row"/></task></module>
    <module id="second" title="Second" requires="first">
      <task id="u" title="U" scene="../scenes/clip.xml"><gate_goals/></task></module></part>)");
  const auto result = load(R"(<curriculum title="C"><include file="part.xml" prefix="x."/>
    <include file="part.xml" prefix="y."><variable name="row" value="5"/></include></curriculum>)");
  EXPECT_EQ(result.diagnostics.format(), "");
  ASSERT_TRUE(result.curriculum);
  const auto& modules = result.curriculum->modules;
  ASSERT_EQ(modules.size(), 4u);
  EXPECT_EQ(modules[3].id, "y.second");
  EXPECT_EQ(modules[3].needs, std::vector<std::string>{"y.first"});
  EXPECT_EQ(modules[0].tasks[0].gates[0].in_a_row, 2);
  EXPECT_EQ(modules[2].tasks[0].gates[0].in_a_row, 5);
}

TEST_F(LoadCurriculum, WhatHasNoEffectIsAWarning) {
  auto result = load(one_task(R"(<gate_goals within="3 day"/>)"));
  EXPECT_TRUE(result.curriculum);
  EXPECT_NE(result.diagnostics.format().find("warning: within: it has no effect on one attempt"), std::string::npos);
}

TEST_F(LoadCurriculum, TheRootDecidesWhatAFileIs) {
  const auto is = [&](const std::string& text) { return is_curriculum_file(folder_.write("file.xml", text)); };
  EXPECT_TRUE(is("<curriculum title=\"C\"/>"));
  EXPECT_TRUE(is("\xEF\xBB\xBF<?xml version=\"1.0\"?>\n<!-- a < b --><curriculum"));
  EXPECT_TRUE(is("<curiculum>")) << "a misspelt one";
  EXPECT_FALSE(is("<scene/>"));
  EXPECT_FALSE(is("<sceen/>"));
  EXPECT_FALSE(is("<"));
  EXPECT_FALSE(is("<!-- <curriculum> -->"));
  EXPECT_FALSE(is(""));
  EXPECT_FALSE(is_curriculum_file(folder_.path() / "none.xml"));
}

TEST(CurriculumElements, AreDeclaredWell) {
  for (const auto& info : curriculum_elements()) {
    SCOPED_TRACE(info.name);
    EXPECT_FALSE(info.doc.empty());
    const auto element = info.create();
    for (const ParamBase* p : element->params()) {
      EXPECT_FALSE(p->spec().doc.empty()) << p->name();
      EXPECT_EQ(element->find_param(p->name()), p);
    }
    for (const std::string& parent : info.parents) EXPECT_NE(find_curriculum_element(parent), nullptr);
  }
  EXPECT_EQ(curriculum_elements().front().name, "curriculum");
}

// --- hostile input --------------------------------------------------------------------------------------------------

const char* const whole = R"(<curriculum title="C">
  <module id="a" title="A"><task id="t" title="T" scene="../scenes/clip.xml" seeds="1 2">
    <gate_metric metric="path" hand="left" at_most="900 mm" in_a_row="2" within="7 day"/>
    <gate_faults faults="torn"/><repetition after="1 3 day"/></task></module>
  <module id="b" title="B" requires="a"><task id="u" title="U" scene="../scenes/clip.xml"><gate_goals/></task></module>
  <warm_up task="t"/>
</curriculum>)";

TEST_F(LoadCurriculum, CutAnywhere) {
  const std::string text = whole;
  for (std::size_t n = 0; n < text.size(); ++n) {
    const auto result = load(text.substr(0, n));
    EXPECT_FALSE(result.curriculum) << n;
    EXPECT_FALSE(result.diagnostics.ok()) << n;
  }
  EXPECT_EQ(load(text).diagnostics.format(), "");
}

TEST_F(LoadCurriculum, ChangedAnywhere) {
  const std::string alphabet = "<>\"'/=& \n$0129.-abcmday_";
  std::mt19937 random(1);
  const auto pick = [&](std::size_t n) { return std::size_t(random() % n); };
  for (int i = 0; i < 3000; ++i) {
    std::string text = whole;
    for (std::size_t changes = 1 + pick(4); changes > 0; --changes) {
      const std::size_t at = pick(text.size());
      if (pick(3) == 0) text.erase(at, 1 + pick(20));
      else if (pick(2) == 0) text.insert(at, text.substr(pick(text.size()), pick(60)));
      else text[at] = alphabet[pick(alphabet.size())];
      if (text.empty()) text = " ";
    }
    const auto result = load(text);
    EXPECT_EQ(result.curriculum.has_value(), result.diagnostics.ok()) << text;
  }
}

TEST_F(LoadCurriculum, ManyOfEach) {
  std::string text = "<curriculum title=\"C\">", wrong = text;
  for (int i = 0; i < 10'000; ++i) {
    const std::string n = std::to_string(i);
    text += "<module id=\"m" + n + "\" title=\"M\" requires=\"m" + std::to_string((i + 1) % 10'000) + "\"/>";
    wrong += "<modul id=\"m" + n + "\"/>";
  }
  const auto result = load(text + "</curriculum>");
  EXPECT_FALSE(result.curriculum);
  EXPECT_EQ(result.diagnostics.all().size(), 101u);
  EXPECT_EQ(load(wrong + "</curriculum>").diagnostics.all().back().text, "and 9900 more errors");
}

}  // namespace
}  // namespace insula
