// SPDX-License-Identifier: GPL-3.0-or-later
// Metrics that a scene declares, on reports made by hand.
#include <gtest/gtest.h>

#include <cmath>

#include "core/testing/example.h"

namespace insula {
namespace {

const std::filesystem::path example = std::filesystem::path(INSULA_SOURCE_DIR) / "plugins/task_metrics/example.xml";

class TaskMetrics : public ::testing::Test {
 protected:
  void SetUp() override {
    s = test::load(example);
    ASSERT_TRUE(s);
    s->reset();
    report.h = 0.1;
    report.structures = s->report().structures;
    report.channels = s->report().channels;
  }
  void show() {
    report.time += report.h;
    s->exercise()->observe(report);
    s->exercise()->observe_metrics(report);
    report.events.clear();
  }
  void tension(double newtons) {
    const ChannelEntry* entry = s->channels().find("strands.tension");
    ASSERT_TRUE(entry);
    report.channels[entry->offset] = newtons;
  }
  MetricValue metric(const std::string& id, int hand = both_hands) {
    for (const MetricValue& v : s->exercise()->metrics())
      if (v.id == id && v.hand == hand) return v;
    ADD_FAILURE() << "no metric " << id;
    return {};
  }
  std::unique_ptr<Simulation> s;
  StepReport report;
};

TEST_F(TaskMetrics, EventsAreCountedForEachHandAndForBoth) {
  report.events = {{"strand_cut", "strands", "", 0.03, 0, right_hand},
                   {"strand_torn", "strands", "", 0.05, 0},
                   {"strand_cut", "strands", "", 0.03, 0, left_hand}};
  show();
  report.events = {{"strand_cut", "strands", "", 0.03, 0, right_hand}};
  show();
  EXPECT_EQ(metric("strands_cut", left_hand).value, 1);
  EXPECT_EQ(metric("strands_cut", right_hand).value, 2);
  EXPECT_EQ(metric("strands_torn").value, 1);
  EXPECT_EQ(metric("strands_torn").better, Better::low);
  EXPECT_EQ(metric("faults.torn").value, 1);
  EXPECT_EQ(metric("fault_count").value, 1);
}

TEST_F(TaskMetrics, StatisticsOfAChannelAreInItsUnit) {
  tension(std::nan(""));
  show();
  EXPECT_FALSE(metric("tension").known);
  for (const double n : {0.02, 0.08, 0.06, 0.03}) {
    tension(n);
    show();
  }
  EXPECT_NEAR(metric("tension").value, 80, 1e-9);
  EXPECT_EQ(metric("tension").unit, "mN");
  EXPECT_NEAR(metric("taut").value, 0.2, 1e-12);
  EXPECT_EQ(metric("taut").unit, "s");
}

TEST_F(TaskMetrics, APhaseBeginsAtTheGoalBefore) {
  for (int k = 0; k < 25; ++k) show();
  EXPECT_FALSE(metric("phase_time.divide").known);
  EXPECT_NEAR(metric("time").value, 2.5, 1e-9);
  s->exercise()->log().goal(0, report.time);
  EXPECT_NEAR(metric("phase_time.divide").value, 2.5, 1e-9);
  show();
  EXPECT_NEAR(metric("time").value, 2.5, 1e-9) << "the exercise has ended";
}

TEST_F(TaskMetrics, TouchOfARegionCountsOnlyWhatPressesIt) {
  const auto* tube = s->scene().find_as<ShellBody>("tube");
  const auto* block = s->scene().find_as<SoftBody>("lower");
  ASSERT_TRUE(tube && block);
  ContactPoint touch;
  touch.a = s->instrument_of(right_hand);
  touch.b = tube;
  touch.position = tube->q().segment<3>(0);
  touch.normal_force = 0.3;
  report.contacts = {touch};
  show();
  std::swap(touch.a, touch.b);
  report.contacts = {touch, touch};
  show();
  touch.normal_force = 0;  // near, but carries nothing
  report.contacts = {touch};
  show();
  touch.normal_force = 0.3;
  touch.a = block;
  report.contacts = {touch};
  show();
  EXPECT_NEAR(metric("tube_touched_time", right_hand).value, 0.2, 1e-12);
  EXPECT_EQ(metric("tube_touched_time", left_hand).value, 0);
}

TEST(MetricsOfAScene, NamesOfEventsAndChannelsAreChecked) {
  const auto messages = [](const std::string& element) {
    return load_simulation_text(
               "<scene><obstacle id=\"floor\"/><exercise id=\"e\" title=\"t\">" + element + "</exercise></scene>",
               example, test::builtin())
        .diagnostics.format();
  };
  EXPECT_NE(messages(R"(<event_metric id="m" text="t" event="cut"/>)").find("no component of the scene has the event"),
            std::string::npos);
  EXPECT_NE(messages(R"(<channel_metric id="m" text="t" channel="a.b"/>)").find("no component publishes the channel"),
            std::string::npos);
  const auto with_tube = load_simulation_text(
      R"(<scene><shell_body id="tube" mesh="../../meshes/examples/tube.obj" mesh_unit="mm"><membrane/></shell_body>
         <exercise id="e" title="t"><region_touch_metric on="tube" regions="wal"/></exercise></scene>)",
      example, test::builtin());
  EXPECT_NE(with_tube.diagnostics.format().find("did you mean \"wall\""), std::string::npos);
  EXPECT_NE(messages(R"(<channel_metric id="m" text="t" channel="a.b" statistic="time_above"/>)")
                .find("must be stated for a time"),
            std::string::npos);
}

TEST(MetricDeclarations, AreChecked) {
  class Set final : public MetricSet {
   public:
    void observe(const StepReport&) override {}
    void evaluate() override {}
    void reset() override {}
  };
  Set set;
  const auto declares = [&](MetricSpec spec) { Metric<Length>(&set, std::move(spec)); };
  EXPECT_THROW(declares({.name = "a b", .doc = "d", .source = "s"}), std::logic_error);
  EXPECT_THROW(declares({.name = "a", .doc = "", .source = "s"}), std::logic_error);
  EXPECT_THROW(declares({.name = "a", .doc = "d", .source = ""}), std::logic_error);
  EXPECT_THROW(declares({.name = "a", .doc = "d", .source = "s", .display = "N"}), std::logic_error);
}

}  // namespace
}  // namespace insula
