// SPDX-License-Identifier: GPL-3.0-or-later
// A recorded run has the same bits when its inputs are given again; damaged and foreign recordings are told apart.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cmath>
#include <csignal>
#include <fstream>
#include <iterator>

#include "core/base/input_error.h"
#include "core/bus/codec.h"
#include "core/testing/block_mesh.h"
#include "core/testing/example.h"
#include "engine/live/frame.h"
#include "engine/live/headless.h"
#include "engine/session/picture_codec.h"
#include "engine/session/rerun.h"
#include "engine/session/session_files.h"
#include "engine/session/session_format.h"
#include "engine/session/session_recorder.h"

namespace insula {
namespace {

namespace fs = std::filesystem;

/// A block under two probes of the right hand and one of the left.
class Session : public testing::Test {
 protected:
  void SetUp() override { write_scene(""); }

  void write_scene(const std::string& solver) {
    scene_.write("case/meshes/block.msh",
                 test::gmsh_text(test::block_mesh({6, 6, 3}, {-0.02, -0.02, -0.02}, {0.02, 0.02, 0})));
    for (const char* name : {"thin", "thick"}) {
      scene_.write(std::string("case/meshes/") + name + "/probe.urdf", test::test_tool_urdf(0.002));
      scene_.write(std::string("case/meshes/") + name + "/tool.json", test::test_tool_json(0, 0));
    }
    scene_.write("case/part.xml", R"(<part><contact between="thin thick left block"/></part>)");
    scene_.write("case/scene.xml", R"(<scene title="Block" time_step="10 ms">
  <soft_body id="block" mesh="meshes/block.msh" mesh_unit="m" )" +
                                       solver + R"(><corotational_fem young="20 kPa"/>
    <fixed region="beyond" centre="0 0 -19 mm" normal="0 0 -1"/><surface id="skin"/></soft_body>
  <retractor id="thin" hand="right" model="meshes/thin/probe.urdf" home="5 0 20 mm" shaft="0 0 1" flat="1 0 0"/>
  <retractor id="thick" hand="right" model="meshes/thick/probe.urdf" home="5 0 20 mm" shaft="0 0 1" flat="1 0 0"/>
  <retractor id="left" hand="left" model="meshes/thick/probe.urdf" home="-8 0 20 mm" shaft="0 0 1" flat="1 0 0"/>
  <include file="part.xml"/>
</scene>)");
  }
  fs::path scene() const { return scene_.path() / "case/scene.xml"; }
  fs::path file() const { return scene_.path() / "run.insula"; }

  /// Hands press into the block; a tool is exchanged on the way.
  static Motion motion() {
    return parse_motion(
        "time_s,hand,px_m,py_m,pz_m,qw,qx,qy,qz,button1,button2\n"
        "0,right,0.005,0,0.02,1,0,0,0,0,0\n0.5,right,0.005,0,-0.003,1,0,0,0,1,0\n1,right,0.005,0.002,0.02,1,0,0,0,0,0\n"
        "1.2,command,exchange,right thick\n1.3,command,exchange,right thumb\n"
        "2,right,0.004,0,-0.004,1,0,0,0,0,0\n4,right,0.004,0.004,-0.004,1,0,0,0,0,0\n"
        "0,left,-0.008,0,0.02,1,0,0,0,0,0\n1.5,left,-0.008,0,-0.002,1,0,0,0,0,1\n4,left,-0.006,0,-0.003,1,0,0,0,0,1\n",
        "m.csv");
  }

  /// Records `seconds` of it, with a reset after `reset_s` (0: none). Returns the hash at its end.
  std::uint64_t record(double seconds, double reset_s = 0, bool waits = true) {
    const auto simulation = test::load(scene());
    if (!simulation) return 0;
    simulation->set_deterministic(waits);
    simulation->set_collision_horizon(waits ? 0 : 2 * simulation->h());
    SessionRecorder recorder(file(), *simulation, {scene(), "motion", "headless"});
    HeadlessRun run(*simulation, motion());
    const auto steps = std::int64_t(std::lround(seconds / simulation->h()));
    for (std::int64_t k = 1; k <= steps; ++k) {
      run.step();
      recorder.step(*simulation);
      if (reset_s > 0 && k == std::lround(reset_s / simulation->h())) run.reset();
    }
    recorder.close(*simulation);
    EXPECT_EQ(recorder.failure(), "");
    return simulation->state_hash();
  }

  RerunResult again(const RerunSettings& settings = {}, std::uint64_t* hash = nullptr) const {
    SessionReader session(file());
    return rerun(session, test::builtin(), settings, [&](const Simulation& s) {
      if (hash) *hash = s.state_hash();
    });
  }

  test::SceneFolder scene_;
};

TEST_F(Session, HasTheSameBitsWhenItsInputsAreGivenAgain) {
  const std::uint64_t recorded = record(3.01, 1.7);
  std::uint64_t repeated = 0;
  const RerunResult r = again({}, &repeated);
  EXPECT_TRUE(r.good()) << r.broken;
  EXPECT_EQ(r.steps, 301);
  EXPECT_EQ(r.compared, 4) << "each second, and the last step";
  EXPECT_EQ(r.different, 0);
  EXPECT_EQ(repeated, recorded);
}

TEST_F(Session, HasTheSameBitsWithAnyNumberOfThreads) {
  record(2);
  EXPECT_TRUE(again({.threads = 3}).good());
}

TEST_F(Session, HasPicturesOfItsStepsAndTheirScene) {
  // What the frames of the same steps were.
  std::vector<insula_lcm::render_frame_t> frames;
  {
    const auto simulation = test::load(scene());
    SessionRecorder recorder(file(), *simulation, {scene(), "motion", "headless"});
    HeadlessRun run(*simulation, motion());
    for (int k = 1; k <= 500; ++k) {
      run.step();
      recorder.step(*simulation);
      if ((k - 1) % 10 == 0) fill_frame(*simulation, frames.emplace_back());
    }
    recorder.close(*simulation);
  }
  SessionReader session(file());
  McapReader& container = session.container();
  const auto frame = container.channel(session::frame_topic), geometry = container.channel(session::geometry_topic);
  ASSERT_TRUE(frame && geometry);
  PictureDecoder decoder;
  insula_lcm::render_frame_t got{};
  std::string why;
  std::size_t n = 0;
  container.read({*frame, *geometry}, 0, UINT64_MAX, [&](const McapReader::Message& m) {
    if (m.channel == *frame) return decode(m.data, got, why);
    EXPECT_TRUE(decoder.decode(m.data, got, why)) << why;
    const insula_lcm::render_frame_t& wanted = frames.at(n++);
    EXPECT_EQ(got.sim_time_s, wanted.sim_time_s);
    EXPECT_EQ(got.channel, wanted.channel);
    EXPECT_EQ(got.tool.size(), wanted.tool.size());
    EXPECT_EQ(got.tool.at(0).p_m[0], wanted.tool.at(0).p_m[0]);
    double worst = 0;
    for (std::size_t i = 0; i < wanted.body.at(0).x_m.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k)
        worst = std::max(worst, std::abs(double(got.body.at(0).x_m.at(i).at(k)) - wanted.body[0].x_m[i][k]));
    EXPECT_LT(worst, picture::unit / 2 + 1e-9);
    return true;
  });
  EXPECT_EQ(n, frames.size()) << why;
  EXPECT_EQ(n, 50U) << "ten a second";
  const auto has = [&](const std::string& name) {
    return std::any_of(container.attachments().begin(), container.attachments().end(),
                       [&](const auto& a) { return a.name == session::bundle_prefix + name; });
  };
  EXPECT_TRUE(has("scene.json.zst"));
}

// Steps that did not wait for a factor took it when a thread was done with it, at another step in every run.
TEST_F(Session, FactorsOfTheBackgroundComeAtTheRecordedSteps) {
  write_scene(R"(solver="asynchronous")");
  record(3, 1.1, false);
  int factors = 0;
  SessionReader session(file());
  session.steps([&](const insula_lcm::session_step_t& step) {
    for (const auto& input : step.input) factors += input.kind == std::int8_t(SimulationInput::Kind::factor);
    return true;
  });
  EXPECT_GT(factors, 0) << "nothing was tested";
  const RerunResult r = again();
  EXPECT_TRUE(r.good()) << r.broken << r.first_different_s;
}

TEST_F(Session, TellsItsSceneStepsAndEvents) {
  record(2);
  SessionReader session(file());
  EXPECT_EQ(session.about("title"), "Block");
  EXPECT_EQ(session.about("scene_file"), "scene.xml");
  EXPECT_EQ(session.about("instruction_set"), session::instruction_set());
  std::vector<std::string> kinds;
  session.events([&](const insula_lcm::sim_event_t& e) {
    kinds.push_back(e.kind);
    return true;
  });
  EXPECT_EQ(kinds, (std::vector<std::string>{"command", "refused"}));
  std::int64_t steps = 0;
  session.steps([&](const insula_lcm::session_step_t& step) {
    steps = std::max(steps, step.number);
    return true;
  });
  EXPECT_EQ(steps, 200);
}

TEST_F(Session, IsRerunWhereTheSceneHasMoved) {
  record(1);
  fs::rename(scene_.path() / "case", scene_.path() / "elsewhere");
  try {
    again();
    FAIL() << "reran without meshes";
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("meshes/block.msh"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("--files"), std::string::npos);
  }
  EXPECT_TRUE(again({.places = {scene_.path() / "elsewhere"}}).good());
  EXPECT_TRUE(again({.places = {scene_.path()}}).good()) << "found by its name";
}

TEST_F(Session, AChangedMeshIsNotTaken) {
  record(1);
  std::ofstream(scene_.path() / "case/meshes/block.msh", std::ios::app) << "\n";
  EXPECT_THROW(again(), InputError);
}

TEST_F(Session, AChangedSceneIsRerunAsItWas) {
  record(1);
  scene_.write("case/part.xml", "<part/>");
  EXPECT_TRUE(again().good());
}

/// Copies the recording with changed steps. change: false leaves the step out.
void rewrite(const fs::path& from, const fs::path& to, const std::function<bool(insula_lcm::session_step_t&)>& change) {
  SessionReader session(from);
  McapReader& in = session.container();
  McapWriter out(to, session::profile, "test");
  for (const auto& [name, text] : in.descriptions()) out.describe(name, text);
  for (const auto& a : in.attachments()) out.attach(a.name, a.media_type, 0, *in.data(a));
  const auto channel = out.add_channel(session::step_topic, 0, "lcm");
  std::vector<std::uint8_t> bytes;
  session.steps([&](insula_lcm::session_step_t step) {
    if (change(step) && encode(step, bytes)) out.write(channel, std::uint64_t(step.number), bytes);
    return true;
  });
  out.close();
}

TEST_F(Session, AnotherInputGivesOtherBits) {
  record(3);
  const fs::path other = scene_.path() / "other.insula";
  rewrite(file(), other, [](insula_lcm::session_step_t& step) {
    if (step.number == 130)
      for (auto& input : step.input) input.p_m[0] += 1e-12;
    return true;
  });
  SessionReader session(other);
  const RerunResult r = rerun(session, test::builtin(), {});
  EXPECT_FALSE(r.good());
  EXPECT_EQ(r.compared, 3);
  EXPECT_EQ(r.different, 2);
  EXPECT_NEAR(r.first_different_s, 2, 1e-9);
}

TEST_F(Session, MissingStepsAreSaid) {
  record(3);
  const fs::path other = scene_.path() / "other.insula";
  rewrite(file(), other, [](insula_lcm::session_step_t& step) { return step.number < 120 || step.number > 130; });
  SessionReader session(other);
  const RerunResult r = rerun(session, test::builtin(), {});
  EXPECT_FALSE(r.good());
  EXPECT_EQ(r.steps, 119);
  EXPECT_EQ(r.broken, "steps 120 to 130 are missing in the recording");
}

TEST_F(Session, WithOtherInstructionsValuesAreCompared) {
  record(2);
  const fs::path other = scene_.path() / "other.insula";
  rewrite(file(), other, [](insula_lcm::session_step_t& step) {
    step.state_hash ^= 1;
    for (double& sum : step.body_sum) sum *= 1 + 1e-6;
    return true;
  });
  SessionReader with_same(other);
  EXPECT_EQ(rerun(with_same, test::builtin(), {}).different, 2);
  // The same recording, as if another processor had made it.
  McapReader in(other);
  mcap::Text text = in.descriptions().at("session");
  text["instruction_set"] = "other";
  const fs::path foreign = scene_.path() / "foreign.insula";
  {
    McapWriter out(foreign, session::profile, "test");
    out.describe("session", text);
    out.describe("files", in.descriptions().at("files"));
    for (const auto& a : in.attachments()) out.attach(a.name, a.media_type, 0, *in.data(a));
    const auto channel = out.add_channel(session::step_topic, 0, "lcm");
    in.read({*in.channel(session::step_topic)}, 0, UINT64_MAX, [&](const McapReader::Message& m) {
      out.write(channel, m.time_ns, m.data);
      return true;
    });
  }
  SessionReader session(foreign);
  const RerunResult r = rerun(session, test::builtin(), {});
  EXPECT_FALSE(r.same_instructions);
  EXPECT_TRUE(r.good());
  EXPECT_NEAR(r.largest_change, 1e-6, 1e-8);
  SessionReader strict(foreign);
  EXPECT_FALSE(rerun(strict, test::builtin(), {.tolerance = 1e-7}).good());
}

TEST_F(Session, ARecordingThatStopsInTheMiddleGivesItsBeginning) {
  record(4);
  const McapReader::Chunk last = McapReader(file()).chunks().back();
  fs::resize_file(file(), last.start + last.length / 2);
  const RerunResult r = again();
  EXPECT_FALSE(r.good());
  EXPECT_EQ(r.different, 0);
}

TEST_F(Session, PathsOutsideOfTheSceneAreRefused) {
  record(1);
  McapReader in(file());
  mcap::Text files = in.descriptions().at("files");
  files["../../stolen.xml"] = "0";
  const fs::path hostile = scene_.path() / "hostile.insula";
  {
    McapWriter out(hostile, session::profile, "test");
    out.describe("session", in.descriptions().at("session"));
    out.describe("files", files);
  }
  SessionReader session(hostile);
  EXPECT_THROW(rerun(session, test::builtin(), {}), InputError);
}

TEST_F(Session, OtherFilesAreRefused) {
  EXPECT_THROW(SessionReader{scene()}, InputError);
  const fs::path other = scene_.path() / "robot.mcap";
  { McapWriter out(other, "ros2", "robot"); }
  EXPECT_THROW(SessionReader{other}, InputError);
}

TEST_F(Session, AFullDiskEndsTheRecordingAndNotTheRun) {
  const auto simulation = test::load(scene());
  ASSERT_TRUE(simulation);
  std::signal(SIGXFSZ, SIG_IGN);
  rlimit before{};
  ASSERT_EQ(getrlimit(RLIMIT_FSIZE, &before), 0);
  SessionRecorder recorder(file(), *simulation, {scene(), "", ""});
  const rlimit full{fs::file_size(file()) + 100, before.rlim_max};
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &full), 0);
  for (int k = 0; k < 100; ++k) {
    test::drive(*simulation);
    simulation->step();
    recorder.step(*simulation);
  }
  recorder.close(*simulation);
  ASSERT_EQ(setrlimit(RLIMIT_FSIZE, &before), 0);
  EXPECT_NE(recorder.failure().find("cannot be written"), std::string::npos) << recorder.failure();
  EXPECT_EQ(simulation->steps(), 100);
  EXPECT_TRUE(SessionReader(file()).about("title") == "Block") << "what was written before is whole";
}

TEST(Sha256, IsThatOfTheStandard) {
  const std::string abc = "abc";
  EXPECT_EQ(sha256({reinterpret_cast<const std::uint8_t*>(abc.data()), abc.size()}),
            "ba7816bf8f01cfea414140de5dae2223b00361a396177a9cb410ff61f20015ad");
  EXPECT_EQ(sha256({}), "e3b0c44298fc1c149afbf4c8996fb92427ae41e4649b934ca495991b7852b855");
}

}  // namespace
}  // namespace insula
