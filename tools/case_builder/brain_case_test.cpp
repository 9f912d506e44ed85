// SPDX-License-Identifier: GPL-3.0-or-later
// Brains of authors in the exercises: moved to where the arms stand, held open by them, and whole cases.
#include <gtest/gtest.h>

#include "core/base/input_error.h"
#include "core/registry/registry.h"
#include "core/sim/simulation.h"
#include "tools/case_builder/brain_for_test.h"
#include "tools/case_builder/commands.h"
#include "tools/case_builder/fissure_fit.h"
#include "tools/case_builder/measured_scene.h"
#include "tools/case_builder/project.h"
#include "tools/case_builder/scenes.h"

namespace insula::case_builder {
namespace {

/// What the command line says when it makes the case `own` of a tube with a sac and this brain; the case's folder in
/// `made`.
std::string make_case(const insula::test::SceneFolder& folder, const std::vector<std::string>& brain, CaseFolder& made,
                      int expected = 0) {
  folder.write("vessel.stl", test::stl_text(test::open_tube()));
  std::vector<std::string> words{"new",
                                 "own",
                                 (folder.path() / "vessel.stl").string(),
                                 "--out",
                                 (folder.path() / "out").string(),
                                 "--vertices",
                                 "900",
                                 "--no-rehearse"};
  words.insert(words.end(), brain.begin(), brain.end());
  std::FILE *said = std::tmpfile(), *err = std::tmpfile();
  const int status = run_command(words, said, err);
  std::string text(8192, '\0');
  std::rewind(err);
  text.resize(std::fread(text.data(), 1, text.size(), err));
  std::fclose(said), std::fclose(err);
  EXPECT_EQ(status, expected) << text;
  made = {folder.path() / "out/own", "own"};
  return text;
}

TEST(FissureFit, UndoesAMotion) {
  const Course wanted = shipped_course(sylvian);
  ASSERT_GE(wanted.superficial.size(), 5u);
  EXPECT_NEAR(distance(wanted, wanted), 0, 1e-12);
  const Placement away{Eigen::AngleAxisd(0.15, Vec3(0.6, -0.48, 0.64)).toRotationMatrix(), Vec3(3, -4, 5)};
  const Course moved_away = moved(wanted, away);
  EXPECT_GT(distance(wanted, moved_away), 3);
  const Placement back = fit(wanted, moved_away);
  // Along the lines the points may slide a little; the lines themselves lie on each other.
  EXPECT_LT(distance(wanted, moved(moved_away, back)), 0.1);
  EXPECT_LT((back.rotation * away.rotation - Mat3::Identity()).norm(), 0.05);
}

/// How the fissure stands, held open by the arms, with the lobes of the case's own brain and no vessel.
Standing settled(const CaseFolder& made) {
  Registry registry;
  register_builtin(registry);
  const Assets assets = link_assets(made, find_project(INSULA_SOURCE_DIR), {}, sylvian);
  const auto loaded = load_simulation_text("<scene><include file=\"" + assets.parts +
                                               "/retracted_fissure.xml\"><variable name=\"lobes\" "
                                               "value=\"../../brain\"/></include><settle time=\"3 s\"/></scene>",
                                           made.path / "held.xml", registry, 1);
  EXPECT_EQ(loaded.diagnostics.format(), "");
  if (!loaded.simulation) return {};
  loaded.simulation->step();
  return standing_of(*loaded.simulation);
}

TEST(Standing, ShippedExercisesBeginAsTheyShould) {
  for (const char* name : {"1_sylvian_fissure", "3_clipping"}) {
    const MeasuredScene m =
        measure_scene(find_project(INSULA_SOURCE_DIR) / "scenes/training" / (std::string(name) + ".xml"), 1);
    EXPECT_EQ(m.message, "");
    for (const Note& n : judged(m.standing)) EXPECT_NE(n.kind, Note::Kind::problem) << name << ": " << n.text;
    EXPECT_EQ(m.standing.arms.size(), name[0] == '1' ? 0u : 2u);
    for (const StandingArm& arm : m.standing.arms)
      EXPECT_LT(arm.deepest, 1) << arm.id << " presses with " << arm.force << " N";
    if (name[0] == '3') {
      EXPECT_GT(m.standing.seen, 0.8);
    }
  }
}

TEST(Standing, WhatIsWrongIsTold) {
  Standing s;
  s.arms = {{"left", "frontal", 0.1, 0.2}, {"right", "temporal", 0.2, 0}};
  s.has_sac = true, s.seen = 0.9;
  const auto count = [](const std::vector<Note>& notes) {
    return std::count_if(notes.begin(), notes.end(), [](const Note& n) { return n.kind == Note::Kind::problem; });
  };
  EXPECT_EQ(count(judged(s)), 0);
  const auto with = [&](const auto& change) {
    Standing t = s;
    change(t);
    return count(judged(t));
  };
  EXPECT_EQ(with([](Standing& t) { t.arms[0].lobe = "", t.arms[0].force = 0; }), 1);
  EXPECT_EQ(with([](Standing& t) { t.arms[0].force = 1e-3; }), 1);
  EXPECT_EQ(with([](Standing& t) { t.arms[0].force = 5; }), 1);
  EXPECT_EQ(with([](Standing& t) { t.arms[1].deepest = 4; }), 1);
  EXPECT_EQ(with([](Standing& t) { t.arms[1].lobe = "frontal"; }), 1);
  EXPECT_EQ(with([](Standing& t) { t.arms[1].lobe = "frontal", t.arms_chosen = true; }), 0);
  EXPECT_EQ(with([](Standing& t) { t.seen = 0.2; }), 1);
  EXPECT_EQ(with([](Standing& t) { t.in_tissue = {"suction"}; }), 1);
  EXPECT_EQ(with([](Standing& t) { t.restless = {{"temporal", 300}}; }), 1);
}

int problems(const std::vector<Note>& notes) {
  return int(std::count_if(notes.begin(), notes.end(), [](const Note& n) { return n.kind == Note::Kind::problem; }));
}

TEST_F(OwnBrain, RealLobesAreMeshedAndHeldOpen) {
  const fs::path anatomy = fs::path(INSULA_SOURCE_DIR) / "../shared/anatomy";
  if (!fs::exists(anatomy / "colin27_insula_R.stl")) GTEST_SKIP() << "no anatomy here";
  Options o;
  for (const std::string& name : lobe_names)
    o.brain.push_back(std::string(name) + "=" + (anatomy / ("colin27_" + std::string(name) + "_R.stl")).string());
  const CaseFolder made{folder.path() / "made", "made"};
  Progress quiet;
  run_brain(made, find_project(INSULA_SOURCE_DIR), o, quiet);
  expect_meshes(made, 1000);
  const Standing there = settled(made);
  for (const Note& n : judged(there)) EXPECT_NE(n.kind, Note::Kind::problem) << n.text;
  ASSERT_EQ(there.arms.size(), 2u);
  EXPECT_EQ(there.arms[0].lobe, "temporal");
  EXPECT_EQ(there.arms[1].lobe, "frontal");
}

#ifdef INSULA_WITH_ITK
const std::vector<std::string> head_lobes{"frontal=2,4-6", "temporal=81", "insula=30"};

TEST_F(OwnBrain, ThatStandsElsewhereIsTold) {
  folder.write("head.nii", test::head_text(Vec3(1, -4, 7)));
  Options o;
  o.brain = {path("head.nii")}, o.lobe_labels = head_lobes, o.brain_in_place = true;
  Progress quiet;
  const fs::path project = find_project(INSULA_SOURCE_DIR);
  const CaseFolder made{folder.path() / "made", "made"};
  run_brain(made, project, o, quiet);
  EXPECT_TRUE(brain_motion(made).rotation.isIdentity(0));
  EXPECT_GT(problems(judged(settled(made))), 0) << "left where it is, its fissure runs past the arms";

  folder.write("head.nii", test::head_text(Vec3(0, 8, -24)));
  BrainLabels far = read_brain(o, project, sylvian, notes);
  mesh_tool::PartFields fields = build_part_fields(far.volume, nullptr, far.parts, field_options(sylvian));
  EXPECT_TRUE(settle_in(far, fields, sylvian, notes).rotation.isIdentity(0));
  ASSERT_EQ(problems(notes), 1);
  EXPECT_NE(notes[0].advice.find("Bring the brain to the MNI frame"), std::string::npos);
}
#endif

#ifdef INSULA_WITH_ITK
TEST_F(OwnBrain, LabelsOfAVolumeBecomeACaseWhoseExercisesRun) {
  const Vec3 off(1, -4, 7);
  folder.write("head.nii", test::head_text(off));
  CaseFolder made;
  std::vector<std::string> words{"--brain", path("head.nii")};
  for (const std::string& lobe : head_lobes) words.insert(words.end(), {"--lobe", lobe});
  make_case(folder, words, made);
  ASSERT_FALSE(HasFailure());
  expect_meshes(made, 1000);
  // Moved to where the arms stand.
  EXPECT_LT((brain_motion(made).apply(sylvian.centre + off) - sylvian.centre).norm(), 3);
  for (const fs::path& file : exercise_files(made)) {
    const MeasuredScene m = measure_scene(file, 100);
    EXPECT_EQ(m.message, "") << file;
    EXPECT_TRUE(m.finite) << file;
    EXPECT_GT(m.nodes, 150) << file;
    for (const Note& n : judged(m.standing)) EXPECT_NE(n.kind, Note::Kind::problem) << file << ": " << n.text;
  }
}
#endif

}  // namespace
}  // namespace insula::case_builder
