// SPDX-License-Identifier: GPL-3.0-or-later
// The curricula that are shipped, with their scenes: what they promise, and that their gates ask for metrics as reports
// write them.
#include <gtest/gtest.h>

#include <algorithm>
#include <filesystem>
#include <set>

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

class Shipped : public testing::Test {
 protected:
  Shipped() { register_builtin(registry_); }
  Curriculum load(const std::string& name) {
    CurriculumFiles files(registry_);
    auto result = load_curriculum(source / "curricula" / name, files);
    EXPECT_EQ(result.diagnostics.format(), "");
    return result.curriculum.value_or(Curriculum{});
  }
  Registry registry_;
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

TEST_F(Shipped, TestsAreWithoutHelpAndComeAfterPractice) {
  for (const char* name : {"residency_year.xml", "rupture_drill.xml"}) {
    SCOPED_TRACE(name);
    const Curriculum c = load(name);
    ASSERT_FALSE(c.modules.empty());
    for (const Module& m : c.modules) {
      EXPECT_EQ(m.tasks.front().mode, TaskMode::practice) << m.id;
      for (const Task& t : m.tasks)
        for (const Gate& g : t.gates) {
          EXPECT_EQ(g.text.find("group"), std::string::npos) << "no figures of groups: none are of persons";
          EXPECT_LE(g.in_a_row, t.seeds.empty() ? 100 : int(t.seeds.size())) << t.id << ": a row needs as many seeds";
        }
    }
    const Progress p = evaluate(c, {}, 0, std::chrono::minutes{0});
    EXPECT_EQ(p.next.task, c.modules.front().tasks.front().id);
  }
}

/// Somebody who succeeds each time and follows each recommendation gets through, and keeps it by the repetitions.
TEST_F(Shipped, CanBePassedByDoingWhatIsNext) {
  for (const char* name : {"residency_year.xml", "rupture_drill.xml"}) {
    SCOPED_TRACE(name);
    const Curriculum c = load(name);
    std::vector<Attempt> attempts;
    std::int64_t now = 1'770'000'000'000;
    bool passed = false;
    for (int i = 0; i < 200; ++i) {
      const Progress p = evaluate(c, attempts, now, std::chrono::minutes{60});
      passed = p.passed;
      if (p.next.kind != Recommendation::Kind::nothing) {
        Attempt a{p.next.scene, now,         p.next.mode == TaskMode::test ? "test" : "practice", true, {}, {},
                  p.next.seed,  p.next.guide};
        for (const Module& m : c.modules)
          for (const Task& t : m.tasks)
            for (const Gate& g : t.gates)
              if (g.kind == Gate::Kind::metric) a.metrics[{g.metric, g.hand}] = g.at_most.value_or(1);
        attempts.push_back(a);
      }
      now += 8 * 3'600'000;
    }
    EXPECT_TRUE(passed);
    EXPECT_GT(attempts.size(), 10u);
    EXPECT_LT(attempts.size(), 200u) << "in the end there is nothing to do on most days";
  }
}

}  // namespace
}  // namespace insula
