// SPDX-License-Identifier: GPL-3.0-or-later
// Recorded metrics and channels; scoring again by the same and by other rules; tables for other programs.
#include "engine/session/score.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/base/input_error.h"
#include "core/bus/event_log.h"
#include "core/testing/example.h"
#include "core/testing/temp_folder.h"
#include "engine/session/session_export.h"
#include "engine/session/session_format.h"
#include "engine/session/session_recorder.h"

namespace insula {
namespace {

namespace fs = std::filesystem;
const fs::path example = fs::path(INSULA_SOURCE_DIR) / "plugins/motion_metrics/example.xml";

class Score : public testing::Test {
 protected:
  fs::path file() const { return folder_.path() / "run.insula"; }

  /// Records 2.5 s of the example, with a reset after 1.3 s. Returns the metrics at the end.
  std::vector<MetricValue> record() {
    const auto s = test::load(example);
    if (!s) return {};
    SessionRecorder recorder(file(), *s, {example, "", "practice", {{"level", "expert"}}});
    const auto steps = std::int64_t(2.5 / s->h());
    for (std::int64_t k = 0; k < steps; ++k) {
      test::drive(*s);
      s->step();
      recorder.step(*s);
      if (k != std::int64_t(1.3 / s->h())) continue;
      recorder.end_pass(*s);
      s->reset();
    }
    recorder.close(*s);
    return s->exercise()->metrics();
  }
  /// A recording of the same scene with these metrics, one a second.
  fs::path with_metrics(const std::vector<std::string>& messages) {
    record();
    const fs::path other = folder_.path() / "other.insula";
    SessionReader in(file());
    McapWriter out(other, session::profile, "test");
    out.describe("session", in.container().descriptions().at("session"));
    const auto channel = out.add_channel(session::metrics_topic, 0, "json");
    std::uint64_t time_ns = 0;
    for (const std::string& text : messages) {
      out.write(channel, time_ns, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
      time_ns += 1'000'000'000;
    }
    out.close();
    return other;
  }
  fs::path rules(const std::string& exercise) {
    return folder_.write("rules/rules.xml", "<scene>" + exercise + "</scene>");
  }

  test_files::TempFolder folder_;
};

double value_of(const std::vector<MetricValue>& all, const std::string& id, int hand) {
  for (const MetricValue& m : all)
    if (m.id == id && m.hand == hand) return m.value;
  ADD_FAILURE() << "no metric " << id;
  return 0;
}

TEST_F(Score, RecordedMetricsHaveTheSameBitsAgain) {
  const auto live = record();
  SessionReader session(file());
  const ScoreResult r = score(session, test::builtin(), {});
  EXPECT_TRUE(r.good()) << r.rerun.broken << r.first_different;
  EXPECT_GT(r.metrics_compared, 100);
  ASSERT_TRUE(r.exercise);
  ASSERT_EQ(r.exercise->metrics.size(), live.size());
  for (std::size_t i = 0; i < live.size(); ++i) EXPECT_EQ(r.exercise->metrics[i].value, live[i].value) << live[i].id;
}

TEST_F(Score, EachPassEndsWithItsMetrics) {
  const auto live = record();
  SessionReader session(file());
  const auto passes = session.passes();
  ASSERT_EQ(passes.size(), 2u);
  for (const auto& pass : passes) {
    EXPECT_TRUE(pass.last_of_pass);
    EXPECT_EQ(pass.mode, "practice");
    EXPECT_EQ(pass.state, "running");
  }
  EXPECT_NEAR(passes[0].time_s, 1.3, 0.02);
  EXPECT_EQ(session.field("level"), "expert");
  EXPECT_EQ(session.field("title"), "Metrics of motion") << "what the recording says of itself is a field too";
}

TEST_F(Score, OtherRulesScoreTheSameRun) {
  const auto live = record();
  SessionReader session(file());
  RerunSettings settings;
  settings.rules = rules(R"(<exercise id="new" title="New rules">
      <hand_metrics id="slow" speed="40 mm/s"/><fault_force id="f" on="lower" limit="0.001 N" grace="0 s"/>
      <goal_channel id="g" text="never" channel="both.none" limit="1"/></exercise>)");
  try {
    score(session, test::builtin(), settings);
    FAIL() << "a rule of a channel that the scene has not";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("rules.xml:3"), std::string::npos) << e.what();
  }
  settings.rules = rules(R"(<exercise id="new" title="New rules">
      <hand_metrics id="slow" speed="40 mm/s"/><fault_force id="f" on="lower" limit="0.001 N" grace="0 s"/>
      <motion id="steady" file="gone.csv"/></exercise>)");
  const ScoreResult r = score(session, test::builtin(), settings);
  EXPECT_TRUE(r.rerun.good()) << "rules do not change the run";
  EXPECT_EQ(r.metrics_compared, 0);
  ASSERT_TRUE(r.exercise);
  EXPECT_EQ(r.exercise->title, "New rules");
  EXPECT_GT(r.exercise->log.faults().at(0).count, 0);
  EXPECT_EQ(value_of(r.exercise->metrics, "path_length", right_hand), value_of(live, "path_length", right_hand));
  EXPECT_LT(value_of(r.exercise->metrics, "active_time", right_hand), value_of(live, "active_time", right_hand));
  settings.rules = rules("");
  EXPECT_THROW(score(session, test::builtin(), settings), InputError) << "no exercise";
}

TEST_F(Score, AMetricWithOtherBitsIsFound) {
  record();
  SessionReader in(file());
  const fs::path other = folder_.path() / "other.insula";
  {
    McapReader& from = in.container();
    McapWriter out(other, session::profile, "test");
    for (const auto& [name, text] : from.descriptions()) out.describe(name, text);
    for (const auto& a : from.attachments()) out.attach(a.name, a.media_type, 0, *from.data(a));
    std::map<std::uint16_t, std::uint16_t> channels;
    std::set<std::uint16_t> all;
    for (const auto& [number, c] : from.channels()) {
      channels[number] = out.add_channel(c.topic, 0, c.encoding);
      all.insert(number);
    }
    const std::uint16_t metrics = *from.channel(session::metrics_topic);
    from.read(all, 0, UINT64_MAX, [&](const McapReader::Message& m) {
      if (m.channel != metrics) {
        out.write(channels[m.channel], m.time_ns, m.data);
        return true;
      }
      auto json = nlohmann::json::parse(m.data.begin(), m.data.end());
      for (auto& v : json["metrics"])
        if (v["id"] == "path_length" && v["hand"] == "right") v["value"] = std::nextafter(double(v["value"]), 1e9);
      const std::string text = json.dump();
      out.write(channels[m.channel], m.time_ns, {reinterpret_cast<const std::uint8_t*>(text.data()), text.size()});
      return true;
    });
    out.close();
  }
  SessionReader session(other);
  const ScoreResult r = score(session, test::builtin(), {});
  EXPECT_TRUE(r.rerun.good()) << r.rerun.broken << r.rerun.first_different_s;
  EXPECT_FALSE(r.good());
  EXPECT_GT(r.metrics_different, 1);
  EXPECT_NE(r.first_different.find("path_length (right)"), std::string::npos) << r.first_different;
}

TEST_F(Score, MetricsThatAreNoneAreCountedAsDamage) {
  SessionReader session(with_metrics({"{\"metrics\": 3}", "[", "{}"}));
  EXPECT_TRUE(session.passes().empty());
  EXPECT_EQ(session.damaged(), 3);
}

// As a report: a trainee who looks at the field for a while afterwards does not change the result.
TEST_F(Score, APassEndsWithItsExercise) {
  // Its instructor asks for more after the first end.
  std::vector<std::string> moments;
  for (const char* state : {"running", "done", "done", "running", "done", "done"})
    moments.push_back(fmt::format(
        R"({{"number": {0}, "pass": 1, "time_s": {0}, "mode": "test", "state": "{1}", "last_of_pass": false, "metrics": []}})",
        moments.size(), state));
  SessionReader session(with_metrics(moments));
  const auto passes = session.passes();
  ASSERT_EQ(passes.size(), 1u);
  EXPECT_EQ(passes[0].state, "done");
  EXPECT_EQ(passes[0].time_s, 4);
}

std::vector<std::string> lines_of(const fs::path& file) {
  std::ifstream in(file);
  std::vector<std::string> out;
  for (std::string line; std::getline(in, line);) out.push_back(line);
  return out;
}

TEST_F(Score, TablesHoldWhatWasRecorded) {
  record();
  SessionReader session(file());
  const auto files = export_tables(session, folder_.path() / "tables", "csv");
  ASSERT_EQ(files.size(), 5u);
  const auto metrics = lines_of(folder_.path() / "tables/metrics.csv");
  EXPECT_EQ(metrics.at(0), "number,pass,time_s,mode,state,last_of_pass,id,hand,value,unit,better");
  EXPECT_GT(metrics.size(), 100u);
  const auto channels = lines_of(folder_.path() / "tables/channels.csv");
  EXPECT_EQ(channels.size(), 1u + 24u) << "ten a second";
  EXPECT_EQ(channels.at(0), "recorded_s,time_s") << "the example has no channel";
  export_tables(session, folder_.path() / "tables", "json");
  std::ifstream in(folder_.path() / "tables/metrics.json");
  const auto json = nlohmann::json::parse(in);
  EXPECT_EQ(json.size() + 1, metrics.size());
  EXPECT_TRUE(json.back().at("last_of_pass"));
  folder_.write("tables/blocked/metrics.csv/x", "");
  EXPECT_THROW(export_tables(session, folder_.path() / "tables/blocked", "csv"), InputError);
}

/// Publishes a plain number and a force.
class Gauge final : public Component {
 public:
  Channel<Scalar> count{this, {.name = "count", .doc = "for tests"}};
  Channel<Vec<Force>> pull{this, {.name = "pull", .doc = "for tests"}};
  void publish() override {
    count.set(7);
    pull.set(Vec3(1, 2, 3));
  }
};

TEST_F(Score, ChannelsHaveANameForEachNumber) {
  Registry registry;
  register_builtin(registry);
  registry.add<Gauge>("gauge", Kind::settings, "for tests");
  const fs::path scene = folder_.write("scene.xml", R"(<scene time_step="50 ms"><gauge id="g"/></scene>)");
  auto loaded = load_simulation(scene, registry, 1);
  ASSERT_TRUE(loaded.simulation) << loaded.diagnostics.format();
  {
    SessionRecorder recorder(file(), *loaded.simulation, {scene, "", ""});
    for (int k = 0; k < 2; ++k) {
      loaded.simulation->step();
      recorder.step(*loaded.simulation);
    }
    recorder.close(*loaded.simulation);
  }
  SessionReader session(file());
  export_tables(session, folder_.path(), "csv");
  const auto channels = lines_of(folder_.path() / "channels.csv");
  ASSERT_EQ(channels.size(), 2u);
  EXPECT_EQ(channels[0], "recorded_s,time_s,g.count,g.pull.x N,g.pull.y N,g.pull.z N");
  EXPECT_EQ(channels[1], "0.1,0.1,7,1,2,3");
}

TEST_F(Score, AnLcmLogHoldsEventsAndHands) {
  const auto s = test::load(example);
  ASSERT_TRUE(s);
  {
    SessionRecorder recorder(file(), *s, {example, "", "practice"});
    recorder.note({{"mode", "practice", "", 0, 0}, {"message", "message", "well done", 0, 0}});
    recorder.close(*s);
  }
  SessionReader session(file());
  const fs::path log = folder_.path() / "run.lcmlog";
  EXPECT_EQ(export_lcm_log(session, log), 2);
  EventLog reader(log);
  LogEvent event;
  int events = 0;
  while (reader.next(event)) events += event.channel == "SIM_EVENT";
  EXPECT_EQ(events, 2);
}

TEST(Fields, AreChecked) {
  EXPECT_EQ(session::parse_field("level=expert"), (std::pair<std::string, std::string>("level", "expert")));
  EXPECT_EQ(session::parse_field("note=a = b").second, "a = b");
  for (const char* bad : {"level", "=x", "level=", "Level=x", "a b=c", "note=a\nb", "note=\xff"})
    EXPECT_THROW(session::parse_field(bad), InputError) << bad;
}

}  // namespace
}  // namespace insula
