// SPDX-License-Identifier: GPL-3.0-or-later
// Whole cases: a made vessel through all stages, stages done again alone, and both real aneurysms clipped with the
// motion made for them.
#include <gtest/gtest.h>

#include <chrono>
#include <cstring>

#include "core/base/input_error.h"
#include "core/model/formats/file_bytes.h"
#include "core/registry/registry.h"
#include "core/sim/channel_sum.h"
#include "engine/live/headless.h"
#include "tools/case_builder/commands.h"
#include "tools/case_builder/intake.h"
#include "tools/case_builder/measured_scene.h"
#include "tools/case_builder/report.h"
#include "tools/case_builder/scenes.h"
#include "tools/case_builder/shapes_for_test.h"
#include "tools/case_builder/wall.h"

namespace insula::case_builder {
namespace {

/// The command line without its prints; what went wrong as text.
int command(const std::vector<std::string>& words, std::string* said = nullptr) {
  std::FILE *out = std::tmpfile(), *err = std::tmpfile();
  const int status = run_command(words, out, err);
  if (said) {
    std::rewind(err);
    char buffer[4096];
    for (std::size_t n; (n = std::fread(buffer, 1, sizeof buffer, err)) > 0;) said->append(buffer, n);
  }
  std::fclose(out), std::fclose(err);
  return status;
}

std::map<std::string, std::string> files_of(const fs::path& folder) {
  std::map<std::string, std::string> out;
  for (const auto& f : fs::recursive_directory_iterator(folder))
    if (f.is_regular_file() && f.path().stem() != "report" && f.path().string().find("/meshes/") == std::string::npos)
      out[f.path().lexically_relative(folder).string()] = read_file_bytes(f.path());
  return out;
}

/// Plays an exercise with its first motion as `insula run` does, until it is over.
struct Played {
  bool loaded = false, finite = true;
  double end = 0;  ///< s
  int strands = 0, left = 0;
  ExerciseState state = ExerciseState::running;
  std::map<std::string, double> measures;
  std::map<std::string, int> faults;
};
Played play(const fs::path& scene, double longest) {
  Played out;
  Registry registry;
  register_builtin(registry);
  SimulationResult loaded = load_simulation(scene, registry, 1);  // the same bits, and no waiting on a busy machine
  EXPECT_EQ(loaded.diagnostics.format(), "");
  if (!loaded.simulation) return out;
  out.loaded = true;
  Simulation& s = *loaded.simulation;
  const Motion motion = load_motion(s.exercise()->motions().front()->file());
  HeadlessRun run(s, motion);
  while (s.time() < longest && s.exercise()->log().state() == ExerciseState::running) {
    run.step();
    out.finite = out.finite && s.report().finite;
  }
  out.state = s.exercise()->log().state(), out.end = s.time();
  out.strands = int(channel_sum(s, "total")), out.left = int(channel_sum(s, "standing"));
  for (const MeasureState& m : s.exercise()->log().measures())
    if (m.known) out.measures[m.id] = m.value;
  for (const FaultState& f : s.exercise()->log().faults()) out.faults[f.id] = f.count;
  return out;
}

/// A generated motion knows the neck, but not how hard the floor behind it may be pressed. The report tells the forces.
void expect_no_fault_but_forces(const std::map<std::string, int>& faults) {
  for (const auto& [id, count] : faults)
    if (!id.ends_with("_force")) {
      EXPECT_EQ(count, 0) << id;
    }
}

bool expects_a_remnant(const Json& scenes) {
  for (const Json& note : scenes.at("notes"))
    if (note.value("advice", std::string()).starts_with("Expect a remnant")) return true;
  return false;
}

class RealCase : public testing::TestWithParam<const char*> {};

TEST_P(RealCase, BecomesACaseWhoseExercisesTheMotionsMadeForItFinish) {
  const fs::path input = fs::path(INSULA_SOURCE_DIR) / "../shared/anatomy" / GetParam();
  if (!fs::exists(input)) GTEST_SKIP() << "no anatomy here";
  const bool volume = input.extension() == ".gz";
  insula::test::SceneFolder folder;
  std::vector<std::string> words{"new", "real", input.string(), "--out", (folder.path() / "out").string()};
  if (volume) words.insert(words.end(), {"--label", "1"});
  std::string said;
  ASSERT_EQ(command(words, &said), 0) << said;
  const CaseFolder made{folder.path() / "out/real", "real"};
  const Json place = read_json(made.path / "place.json");
  for (const Json& r : place.at("rooms")) EXPECT_GT(r.at("after_mm").get<double>(), 0.3) << r.at("what");
  const artery::Vessel v = read_wall(made.artery());
  ASSERT_TRUE(v.neck);
  // Sizes as the notes beside the anatomy have them, and sound triangles.
  EXPECT_NEAR(v.neck->diameter, std::string(GetParam()).starts_with("aneumo") ? 3.1 : 6.6, 0.5);
  EXPECT_NEAR(v.dome_height, std::string(GetParam()).starts_with("aneumo") ? 4.3 : 7.2, 0.6);
  EXPECT_GT(artery::quality(v.wall.mesh).min_angle_deg, 20);

  const Played c = play(made.path / "3_clipping.xml", 15);
  ASSERT_TRUE(c.loaded);
  EXPECT_TRUE(c.finite);
  // The case tells what its rehearsal came to, and the written motion does just that.
  const Json written = read_json(made.path / "scenes.json"), claimed = written.at("clipping");
  EXPECT_EQ(c.state == ExerciseState::done, claimed.at("goal").get<bool>());
  ASSERT_TRUE(c.measures.contains("grade") && c.measures.contains("remnant_pct")) << "no clip was judged";
  EXPECT_EQ(c.measures.at("grade"), claimed.at("grade").get<int>());
  EXPECT_NEAR(c.measures.at("remnant_pct"), claimed.at("remnant_pct").get<double>(), 1e-3);
  const bool sound = claimed.at("goal").get<bool>() && claimed.at("faults") == 0 && claimed.at("grade") <= 1 &&
                     claimed.at("remnant_pct") < 25;
  EXPECT_NE(sound, expects_a_remnant(written));
  // One clip seldom shuts a neck as wide as that of the first one.
  EXPECT_TRUE(sound || v.neck->diameter > 5.5);
  // Blades that never closed leave no slit to be measured.
  if (c.measures.contains("slit")) {
    EXPECT_LT(c.measures.at("slit"), 1.2);
  }
  expect_no_fault_but_forces(c.faults);
  for (const auto& [id, value] : c.measures)
    if (id.ends_with(".flow_pct")) {
      EXPECT_GT(value, 75) << id;
    }
  EXPECT_TRUE(fs::exists(made.path / "report.html"));

  const Played d = play(made.path / "2_aneurysm_dissection.xml", 60);
  ASSERT_TRUE(d.loaded);
  EXPECT_TRUE(d.finite);
  EXPECT_EQ(d.state, ExerciseState::done) << d.left << " of " << d.strands << " strands stand";
  EXPECT_GE(d.strands, 8);
  for (const auto& [id, count] : d.faults) EXPECT_EQ(count, 0) << id;

  const Played r = play(made.path / "4_rupture.xml", 40);
  ASSERT_TRUE(r.loaded);
  EXPECT_TRUE(r.finite);
  if (sound) {
    EXPECT_EQ(r.state, ExerciseState::done);
    EXPECT_LE(r.measures.at("grade"), 2);
  }
  expect_no_fault_but_forces(r.faults);
}

#ifdef INSULA_WITH_ITK
constexpr const char* second = "aneumo_aneux4_label.nii.gz";
#else
constexpr const char* second = "aneumo_aneux4_closed.stl";
#endif
INSTANTIATE_TEST_SUITE_P(Anatomy, RealCase, testing::Values("dolfin_aneurysm_closed.stl", second),
                         [](const auto& p) { return std::string(p.param).substr(0, 6); });

/// One that lies on no tray, over the neck of the tube. The case stays as it is.
void expect_a_clip_is_tried(const CaseFolder& made) {
  const fs::path out = made.path.parent_path() / "clip.json";
  const auto before = files_of(made.path);
  std::string said;
  ASSERT_EQ(
      command({"clip", made.path.string(), "--clip", "angled_30_10", "--turn", "15", "deg", "--out", out.string()},
              &said),
      0)
      << said;
  const Json clip = read_json(out);
  EXPECT_EQ(clip.at("clip"), "angled_30_10");
  EXPECT_EQ(clip.at("turn_deg"), 15);
  EXPECT_GE(clip.at("remnant_pct").get<double>(), 0);
  EXPECT_LE(clip.at("grade").get<int>(), 5);
  EXPECT_EQ(clip.at("flows_pct").size(), 1u);
  const Vec3 from = vec3_from(clip.at("blades").at(0).at(0)), to = vec3_from(clip.at("blades").at(0).at(1));
  EXPECT_NEAR((to - from).norm(), 10, 0.7);
  EXPECT_LT((0.5 * (from + to) - Vec3(0, 0, 2)).norm(), 8) << "near the neck, in the frame of the author's file";
  EXPECT_EQ(before, files_of(made.path));
}

void expect_its_report(const CaseFolder& made) {
  const std::string report = read_file_bytes(made.path / "report.html");
  for (const char* part : {"<svg", "worst angle", "dome to neck", "room to the frontal", "closed by flat caps",
                           "a step takes", "3_clipping.xml"})
    EXPECT_NE(report.find(part), std::string::npos) << part;

  const Json numbers = read_json(made.path / "report.json");
  EXPECT_NEAR(numbers.at("neck").at("diameter_mm").get<double>(), read_wall(made.artery()).neck->diameter, 1e-3);
  EXPECT_GT(numbers.at("neck").at("confidence").get<double>(), 0.8);
  for (const char* lobe : {"frontal", "temporal", "insula"}) EXPECT_EQ(numbers.at("overlap_mm").at(lobe), 0) << lobe;
  EXPECT_GE(numbers.at("step_ms").at("p95").get<double>(), numbers.at("step_ms").at("p50").get<double>());
  EXPECT_EQ(numbers.at("clipping"), read_json(made.path / "scenes.json").at("clipping"));
}

TEST(MadeCase, GivesTheSameFilesTwiceAndStagesCanBeDoneAgainAlone) {
  insula::test::SceneFolder folder;
  folder.write("vessel.stl", test::stl_text(test::open_tube()));
  const std::string input = (folder.path() / "vessel.stl").string();
  std::string said;
  for (const char* out : {"a", "b"})
    ASSERT_EQ(command({"new", "tube", input, "--out", (folder.path() / out).string(), "--vertices", "900", "--plays",
                       "4", "--site", "basilar tip", "--difficulty", "4", "--wall-patch",
                       "0 0 6 mm, radius=0.8 mm, thickness=0.4 mm, young=2 MPa"},
                      &said),
              0)
        << said;
  const CaseFolder made{folder.path() / "a/tube", "tube"};
  const auto first = files_of(made.path);
  EXPECT_GT(first.size(), 15u);
  EXPECT_EQ(first, files_of(folder.path() / "b/tube"));

  // The four exercises load without a warning and step.
  for (const fs::path& file : exercise_files(made)) {
    const MeasuredScene m = measure_scene(file, 5);
    EXPECT_EQ(m.message, "") << file;
    EXPECT_TRUE(m.finite);
    EXPECT_GT(m.step_ms, 0);
    EXPECT_NE(read_file_bytes(file).find("<exercise site=\"basilar tip\" difficulty=\"4\""), std::string::npos) << file;
  }
  // The scene would be refused if the painted part were not on the placed wall.
  EXPECT_NE(
      read_file_bytes(made.path / "artery.xml").find("spot_radius=\"0.8 mm\" thickness=\"0.4 mm\" young=\"2 MPa\""),
      std::string::npos);
  expect_its_report(made);
  expect_a_clip_is_tried(made);
  // A stage again with nothing new changes nothing; with a neck of one's own it moves the neck there and keeps the
  // other choices.
  ASSERT_EQ(command({"wall", made.path.string()}, &said), 0) << said;
  ASSERT_EQ(command({"place", made.path.string()}, &said), 0) << said;
  EXPECT_EQ(first, files_of(made.path));
  ASSERT_EQ(command({"wall", made.path.string(), "--neck", "0 0 2.2 mm 0 0 1"}, &said), 0) << said;
  const artery::Vessel v = read_wall(made.wall());
  EXPECT_NEAR(v.neck->centre.z(), 2.2, 0.05);
  EXPECT_NEAR(v.neck->normal.z(), 1, 1e-6);
  EXPECT_NEAR(v.neck->diameter, 2 * std::sqrt(2.4 * 2.4 - 1.4 * 1.4), 0.5);  // a section of the ball
  EXPECT_NEAR(double(v.wall.mesh.vertices.size()), 900, 200);
  std::string why;
  EXPECT_EQ(command({"wall", made.path.string(), "--neck", "0", "0", "0", "mm", "1", "0", "0"}, &why), 2);
  EXPECT_NE(why.find("an opening lies on its dome side"), std::string::npos) << why;
  EXPECT_EQ(command({"place", folder.path().string()}, &why), 2);
  EXPECT_NE(why.find("is no case"), std::string::npos);
  EXPECT_EQ(command({"new", "tube", input, "--out", (folder.path() / "a").string()}, &why), 2);
  EXPECT_NE(why.find("exists already"), std::string::npos);
  EXPECT_EQ(command({"new", "../tube", input}, &why), 2);
  EXPECT_EQ(command({"wall"}, &why), 2);
  EXPECT_EQ(command({"scenes", made.path.string(), "--site", "left leg"}, &why), 2);
  EXPECT_NE(why.find("basilar tip"), std::string::npos) << why;
}

TEST(MadeCase, NeckByTwoPoints) {
  Progress quiet;
  std::vector<Note> notes;
  Options o;
  o.vertices = 900;
  const Intake in = mended(test::tube_with_sac(), "tube", o, {});
  const double z = 2.0, r = std::sqrt(2.4 * 2.4 - 1.6 * 1.6);
  o.neck_points = {-r, 0, z, r, 0, z};
  const artery::Vessel v = make_wall(in.surface, o, notes, quiet);
  ASSERT_TRUE(v.neck);
  EXPECT_NEAR((v.neck->centre - Vec3(0, 0, z)).norm(), 0, 0.35);
  EXPECT_GT(v.neck->normal.z(), 0.9);
  // Openings in the order of their calibre, a sac over the neck, its weak tip on top.
  EXPECT_GE(in.surface.caps[0].radius, in.surface.caps[1].radius);
  EXPECT_GT(v.bleb->first.z(), 5);
}

/// Five vessels that meet in three forks, with a ball of radius 2.7 at the middle fork. Their ends are round.
struct Tree {
  struct Tube {
    Vec3 a, b;
    double radius;
  };
  std::vector<Tube> tubes{{Vec3(-20, -1.5, -5.5), Vec3::Zero(), 1.5},
                          {Vec3::Zero(), Vec3(18, 8.3, -4.2), 1.15},
                          {Vec3::Zero(), Vec3(17, -11.3, -2.8), 1.0},
                          {Vec3(8, 3.7, -1.8), Vec3(14, 19, 5), 0.8},
                          {Vec3(-10, -0.7, -2.7), Vec3(-6, -19, -10), 0.6}};
  TriMesh mesh() const {
    const auto value = [&](const Vec3& p) {
      double tube = 1e300;
      for (const Tube& t : tubes) {
        const Vec3 d = t.b - t.a;
        tube =
            std::min(tube, (p - t.a - std::clamp((p - t.a).dot(d) / d.squaredNorm(), 0.0, 1.0) * d).norm() - t.radius);
      }
      const double ball = (p - Vec3(0.5, 0.3, 4.2)).norm() - 2.7, k = 0.6,
                   w = std::max(k - std::abs(tube - ball), 0.0) / k;
      return std::min(tube, ball) - 0.25 * w * w * k;
    };
    return artery::extract(value, Vec3(-22.03, -21.01, -12.02), Vec3(20.07, 21.05, 8.1), 0.4);
  }
  /// Each end cut off 1.5 mm before it.
  std::vector<Plane> cuts() const {
    std::vector<Plane> out;
    for (std::size_t i = 0; i < tubes.size(); ++i) {
      const Vec3 out_of = (i == 0 ? tubes[i].a - tubes[i].b : tubes[i].b - tubes[i].a).normalized(),
                 at = (i == 0 ? tubes[i].a : tubes[i].b) - 1.5 * out_of;
      out.push_back({at.x(), at.y(), at.z(), out_of.x(), out_of.y(), out_of.z()});
    }
    return out;
  }
};

TEST(MadeCase, ATreeIsCutPastItsForksAndKeepsItsNeck) {
  const Tree tree;
  Options whole;
  whole.cuts = tree.cuts();
  const Intake in = mended(tree.mesh(), "tree", whole, {});
  ASSERT_EQ(in.surface.caps.size(), 5u);
  Progress quiet;
  for (const double keep : {7.0, 10.0, 13.0, 0.0}) {
    std::vector<Note> notes;
    Options o;
    o.keep = keep;
    const artery::Vessel v = make_wall(in.surface, o, notes, quiet);
    ASSERT_TRUE(v.neck) << keep;
    EXPECT_LT((v.neck->centre - Vec3(0.2, 0.1, 1.5)).norm(), 0.8) << keep;
    EXPECT_GT(v.neck->normal.z(), 0.9) << keep;
    EXPECT_NEAR(v.dome_height, 5.1, 0.5) << keep;
    EXPECT_GT(artery::quality(v.wall.mesh).min_angle_deg, 20) << keep;
    EXPECT_GE(v.wall.caps.size(), keep == 7 ? 3u : 4u) << keep;
    for (const Note& n : notes) EXPECT_NE(n.kind, Note::Kind::problem) << keep << ": " << n.text;
  }
}

TEST(MadeCase, VesselTooThinForAWayIsNamed) {
  // A thread hangs the outlet's half on that of the inlet.
  artery::Surface s;
  s.mesh = artery::extract([](const Vec3& p) { return std::hypot(p.y(), p.z()) - (std::abs(p.x()) < 3 ? 0.09 : 0.8); },
                           Vec3(-9.03, -2.01, -2.02), Vec3(9.07, 2.05, 2.1), 0.12);
  s.patch.assign(s.mesh.triangles.size(), -1);
  artery::cut_and_close(s, {"inlet", Vec3(-8, 0, 0), Vec3(-1, 0, 0), 0.8}, 3.0);
  artery::cut_and_close(s, {"outlet_1", Vec3(8, 0, 0), Vec3(1, 0, 0), 0.8}, 3.0);
  for (Vec3& p : s.mesh.vertices)
    p.y() += p.x() > 0 ? 0.31 * std::clamp(p.x() / 3, 0.0, 1.0) : 0, p.z() += 0.2 * std::abs(p.x()) * 0.01;
  Progress quiet;
  std::vector<Note> notes;
  try {
    make_wall(mended(s.mesh, "thread", {}, {}).surface, {}, notes, quiet);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("no way leads from the inlet to outlet_1"), std::string::npos) << e.what();
  }
}

TEST(MadeCase, VesselWithoutASacIsRefused) {
  const TriMesh tube = [] {
    artery::Surface s;
    s.mesh = artery::extract([](const Vec3& p) { return std::hypot(p.y(), p.z()) - 1.4; }, Vec3(-9.03, -2.01, -2.02),
                             Vec3(9.07, 2.05, 2.1), 0.4);
    s.patch.assign(s.mesh.triangles.size(), -1);
    artery::cut_and_close(s, {"a", Vec3(-8, 0, 0), Vec3(-1, 0, 0), 1.4}, 3.0);
    artery::cut_and_close(s, {"b", Vec3(8, 0, 0), Vec3(1, 0, 0), 1.4}, 3.0);
    return s.mesh;
  }();
  Progress quiet;
  std::vector<Note> notes;
  const Intake in = mended(tube, "tube", {}, {});
  try {
    make_wall(in.surface, {}, notes, quiet);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("no sac was found"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace insula::case_builder
