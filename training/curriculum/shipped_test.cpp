// SPDX-License-Identifier: GPL-3.0-or-later
// The curricula that are shipped, with their scenes: what they promise, and that their gates ask for metrics as reports
// write them.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>
#include <string>
#include <vector>

#include "core/scene/loader.h"
#include "core/sim/settings.h"
#include "core/sim/simulation.h"
#include "engine/authoring/curriculum_sources.h"
#include "training/curriculum/evaluate.h"
#include "training/curriculum/loader.h"

namespace insula {
namespace {
namespace fs = std::filesystem;

const fs::path source = INSULA_SOURCE_DIR;

std::vector<std::string> shipped_names() {
  std::vector<std::string> names;
  for (const auto& entry : fs::directory_iterator(source / "curricula"))
    if (entry.path().extension() == ".xml") names.push_back(entry.path().stem().string());
  std::sort(names.begin(), names.end());
  return names;
}

class Shipped : public testing::Test {
 protected:
  Shipped() { register_builtin(registry_); }
  Registry registry_;
};

class ShippedCurriculum : public Shipped, public testing::WithParamInterface<std::string> {
 protected:
  Curriculum load() {
    CurriculumFiles files(registry_);
    auto result = load_curriculum(source / "curricula" / (GetParam() + ".xml"), files);
    EXPECT_EQ(result.diagnostics.format(), "");
    return result.curriculum.value_or(Curriculum{});
  }
};

TEST_F(Shipped, FactsAreThoseOfReports) {
  const fs::path file = source / "scenes/training/4_rupture.xml";
  CurriculumFiles files(registry_);
  const SceneFacts& facts = files.scene(file);
  ASSERT_TRUE(facts.diagnostics.ok()) << facts.diagnostics.format();
  EXPECT_TRUE(facts.has_complications);
  EXPECT_EQ(&files.scene(file), &facts) << "read once";
  auto loaded = load_scene(file, registry_);
  ASSERT_TRUE(loaded.ok());
  for (SettleSettings* s : loaded.scene->all<SettleSettings>()) s->time.set(0);
  Simulation simulation(std::move(loaded.scene), loaded.diagnostics);
  std::set<std::string> reported, known;
  for (const MetricValue& m : simulation.exercise()->metrics())
    reported.insert(m.id + " " + (m.hand == both_hands ? "both" : "each") + " " + m.unit);
  for (const MetricFact& m : facts.metrics)
    known.insert(m.id + " " + (m.of == Of::both_hands ? "both" : "each") + " " + m.unit);
  EXPECT_EQ(known, reported);
}

TEST_F(Shipped, BandsAreRead) {
  CurriculumFiles files(registry_);
  const fs::path scene = source / "scenes/training/1_sylvian_fissure.xml";
  const SceneFacts& facts = files.scene(scene);
  const auto metric = std::find_if(facts.metrics.begin(), facts.metrics.end(),
                                   [](const MetricFact& m) { return m.id == "path_length"; });
  ASSERT_NE(metric, facts.metrics.end());
  std::string why;
  const fs::path bands = source / "scenes/training/1_sylvian_fissure_bands.json";
  const auto band = files.band(bands, "scripted hands", facts, *metric, "right", why);
  ASSERT_TRUE(band) << why;
  EXPECT_LT(band->low, band->high);
  EXPECT_FALSE(files.band(bands, "surgeons", facts, *metric, "right", why));
  EXPECT_NE(why.find("has no group \"surgeons\""), std::string::npos) << why;
}

TEST_P(ShippedCurriculum, PractisesBeforeItTestsAndAsksForNoFiguresOfGroups) {
  const Curriculum c = load();
  ASSERT_FALSE(c.modules.empty());
  for (const Module& m : c.modules) {
    ASSERT_FALSE(m.tasks.empty());
    EXPECT_EQ(m.tasks.front().mode, TaskMode::practice) << m.id;
    for (const Task& t : m.tasks)
      for (const Gate& g : t.gates) {
        EXPECT_EQ(g.text.find("group"), std::string::npos) << "none are of persons";
        EXPECT_LE(g.in_a_row, t.seeds.empty() ? 100 : int(t.seeds.size())) << t.id << ": a row needs as many seeds";
      }
  }
  EXPECT_EQ(evaluate(c, {}, 0, std::chrono::minutes{0}).next.task, c.modules.front().tasks.front().id);
}

/// A good attempt at what is recommended.
Attempt attempt_at(const Recommendation& next, const Curriculum& curriculum, std::int64_t now_ms) {
  const std::string mode = next.mode == TaskMode::test ? "test" : "practice";
  Attempt out{next.scene, now_ms, mode, true, {}, {}, next.seed, next.guide};
  for (const Module& m : curriculum.modules)
    for (const Task& t : m.tasks)
      for (const Gate& g : t.gates)
        if (g.kind == Gate::Kind::metric) out.metrics[{g.metric, g.hand}] = g.at_most.value_or(g.at_least.value_or(0));
  return out;
}

TEST_P(ShippedCurriculum, IsPassedByWhoeverDoesWhatIsNext) {
  const Curriculum c = load();
  std::vector<Attempt> attempts;
  std::int64_t now_ms = 1'770'000'000'000;
  bool passed = false;
  for (int i = 0; i < 200; ++i) {
    const Progress p = evaluate(c, attempts, now_ms, std::chrono::minutes{60});
    passed = p.passed;
    if (p.next.kind != Recommendation::Kind::nothing) attempts.push_back(attempt_at(p.next, c, now_ms));
    now_ms += 8 * 3'600'000;
  }
  EXPECT_TRUE(passed);
  EXPECT_GT(attempts.size(), 10u);
  EXPECT_LT(attempts.size(), 200u) << "in the end there is nothing to do on most days";
}

INSTANTIATE_TEST_SUITE_P(Shipped, ShippedCurriculum, testing::ValuesIn(shipped_names()),
                         [](const auto& curriculum) { return curriculum.param; });

}  // namespace
}  // namespace insula
