// SPDX-License-Identifier: GPL-3.0-or-later
// Threads lie where they are told, and only a cut through an unmarked one is told as wrong.
#include "plugins/marked_threads/marked_threads.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <map>

#include "core/model/formats/file_bytes.h"
#include "core/testing/example.h"

namespace insula {
namespace {

const std::filesystem::path example = std::filesystem::path(INSULA_SOURCE_DIR) / "plugins/marked_threads/example.xml";

/// Sweeps the example's knife along y, through the threads between these places.
std::map<std::string, int> sweep(Simulation& s, double from, double to) {
  std::map<std::string, int> events;
  HandState hand;
  hand.present = true;
  hand.device = s.instruments().front()->home_pose();
  const int n = 120;
  for (int i = 0; i <= n; ++i) {
    hand.device.p = Vec3(0.003, from + (to - from) * i / n, 0.001);
    s.set_hand(1, hand);
    s.step();
    for (const Event& e : s.events()) ++events[e.kind];
  }
  return events;
}

TEST(MarkedThreads, LieEvenlyApartBetweenTheNearestVertices) {
  const auto s = test::load(example);
  ASSERT_TRUE(s);
  const auto* threads = s->scene().find_as<MarkedThreads>("threads");
  ASSERT_EQ(threads->count(), 5);
  for (int i = 0; i < 5; ++i) {
    EXPECT_LT((threads->strand(i).a - Vec3(0.005, 0.005 * i - 0.01, 0)).norm(), 1e-9);
    EXPECT_LT((threads->strand(i).b - Vec3(0.005, 0.005 * i - 0.01, 0.002)).norm(), 1e-9);
    EXPECT_EQ(threads->is_marked(i), i == 1 || i == 3);
  }
  EXPECT_EQ(s->channel("threads.marked_standing"), 2);
}

TEST(MarkedThreads, OnlyACutThroughAnUnmarkedOneIsWrong) {
  const auto s = test::load(example);
  ASSERT_TRUE(s);
  auto events = sweep(*s, -0.008, -0.002);  // through the second one
  EXPECT_EQ(events["strand_cut"], 1);
  EXPECT_EQ(events["unmarked_thread_cut"], 0);
  EXPECT_EQ(s->channel("threads.marked_standing"), 1);
  events = sweep(*s, -0.002, 0.008);  // through the third and the fourth one
  EXPECT_EQ(events["strand_cut"], 2);
  EXPECT_EQ(events["unmarked_thread_cut"], 1);
  EXPECT_EQ(s->channel("threads.marked_standing"), 0);
  EXPECT_EQ(s->channel("threads.standing"), 2);
}

TEST(MarkedThreads, AMarkThatIsNoThreadIsAnError) {
  std::string text = read_file_bytes(example);
  const std::pair<const char*, const char*> wrong[] = {{"2 6", "6 is no thread; there are the threads 1 to 5"},
                                                       {"0", "0 is outside the allowed range 1 to 200"},
                                                       {"two", "\"two\" is not a whole number"}};
  for (const auto& [marks, message] : wrong) {
    std::string changed = text;
    changed.replace(changed.find("marked=\"2 4\""), 12, std::string("marked=\"") + marks + "\"");
    const auto loaded = load_simulation_text(changed, example, test::builtin());
    EXPECT_FALSE(loaded.simulation);
    EXPECT_NE(loaded.diagnostics.format().find(message), std::string::npos) << loaded.diagnostics.format();
  }
}

}  // namespace
}  // namespace insula
