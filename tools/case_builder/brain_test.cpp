// SPDX-License-Identifier: GPL-3.0-or-later
// An author's own brain: labels, a surface a lobe, one surface for all, and what is refused of them.
#include <gtest/gtest.h>

#include <cstring>

#include "core/base/input_error.h"
#include "core/registry/registry.h"
#include "core/sim/simulation.h"
#include "tools/case_builder/brain.h"
#include "tools/case_builder/commands.h"
#include "tools/case_builder/fissure.h"
#include "tools/case_builder/fissure_fit.h"
#include "tools/case_builder/project.h"
#include "tools/case_builder/report.h"
#include "tools/case_builder/scenes.h"
#include "tools/case_builder/test_shapes.h"
#include "tools/case_builder/topology.h"
#include "tools/mesh_lobes/labels.h"

namespace insula::case_builder {
namespace {

/// A box in twelve triangles, outward.
TriMesh box(const Vec3& low, const Vec3& high) {
  TriMesh m;
  for (int k = 0; k < 8; ++k) m.vertices.emplace_back(k & 1 ? high.x() : low.x(), k & 2 ? high.y() : low.y(), k & 4 ? high.z() : low.z());
  for (const auto& [a, b, c, d] : {std::array{0, 2, 3, 1}, std::array{4, 5, 7, 6}, std::array{0, 1, 5, 4}, std::array{2, 6, 7, 3}, std::array{0, 4, 6, 2}, std::array{1, 3, 7, 5}})
    m.triangles.push_back({a, b, c}), m.triangles.push_back({a, c, d});
  return m;
}

// Three blocks that meet at a fissure in the plane z = -2 and at a floor in the plane x = 40.
const Vec3 low_corner(15, -40, -45), high_corner(95, 45, 40);
TriMesh block(int lobe) {
  if (lobe == 0) return box({40, low_corner.y(), -2}, high_corner);
  if (lobe == 1) return box({40, low_corner.y(), low_corner.z()}, {high_corner.x(), high_corner.y(), -2});
  return box(low_corner, {40, high_corner.y(), high_corner.z()});
}
int lobe_at(const Vec3& p) { return p.x() < 40 ? 2 : p.z() > -2 ? 0 : 1; }

std::string refusal(const Options& o) {
  std::vector<Note> notes;
  try {
    read_brain(o, find_project(INSULA_SOURCE_DIR), notes);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

/// Checks that the labels of a ball about the fissure are those of the blocks, but for a layer where they meet.
void expect_blocks(const BrainLabels& b, double layer) {
  ASSERT_EQ(b.parts.size(), 3u);
  int wrong = 0, all = 0;
  for (double x = 25; x < 85; x += 3)
    for (double y = -25; y < 33; y += 7)
      for (double z = -30; z < 28; z += 3) {
        const Vec3 p(x, y, z);
        if ((p - fissure_centre).norm() > 30 || std::abs(x - 40) < layer || (x > 40 && std::abs(z + 2) < layer)) continue;
        ++all;
        const int label = int(b.volume.nearest({x, y, z}));
        wrong += b.parts[std::size_t(lobe_at(p))].labels.front() != label;
      }
  EXPECT_GT(all, 500);
  EXPECT_EQ(wrong, 0);
}

class OwnBrain : public testing::Test {
 protected:
  OwnBrain() {
    for (int k = 0; k < 3; ++k) folder.write(std::string(lobe_names[k]) + ".stl", test::stl_text(block(k)));
  }
  std::string path(const std::string& name) const { return (folder.path() / name).string(); }
  Options by_lobe() const {
    Options o;
    for (const char* name : lobe_names) o.brain.push_back(std::string(name) + "=" + path(std::string(name) + ".stl"));
    return o;
  }
  insula::test::SceneFolder folder;
  std::vector<Note> notes;
};

TEST(WritePly, FirstByteThatIsALinesEndIsReadBack) {
  // assimp swallows it: a coordinate whose lowest byte is one loses its last bit instead.
  insula::test::SceneFolder folder;
  for (const unsigned low : {0x0Au, 0x0Du}) {
    const std::uint32_t bits = 0x41200000u | low;  // 10 and a little
    float x;
    std::memcpy(&x, &bits, 4);
    TriMesh m = box({0, 0, 0}, {9, 8, 7});
    m.vertices[0].x() = double(x);
    write_ply(folder.path() / "a.ply", m, "a box");
    const TriMesh back = read_surface(folder.path() / "a.ply", 1.0);
    ASSERT_EQ(back.vertices.size(), 8u);
    EXPECT_EQ(back.triangles.size(), 12u);
    EXPECT_NEAR(back.vertices[0].x(), double(x), 2e-6);
  }
}

TEST_F(OwnBrain, SurfacesBecomeLabels) {
  expect_blocks(read_brain(by_lobe(), find_project(INSULA_SOURCE_DIR), notes), 1.0);
  EXPECT_TRUE(notes.empty());
}

TEST_F(OwnBrain, OneSurfaceIsSharedOutToTheNearestShippedLobe) {
  folder.write("brain.ply", "");
  write_ply(folder.path() / "brain.ply", box(low_corner, high_corner), "a block");
  Options o;
  o.brain = {path("brain.ply")};
  const fs::path project = find_project(INSULA_SOURCE_DIR);
  const BrainLabels b = read_brain(o, project, notes);
  const Fissure shipped = read_fissure(project, {});
  // Well inside of a shipped lobe there is no doubt.
  for (std::size_t k = 0; k < 2; ++k) {
    int checked = 0;
    for (const Vec3& p : shipped.lobes[k].tets.nodes) {
      if ((p - fissure_centre).norm() > 30) continue;
      double near = 1e9;
      for (const Vec3& q : shipped.lobes[1 - k].surface.vertices) near = std::min(near, (p - q).norm());
      for (const Vec3& q : shipped.insula.vertices) near = std::min(near, (p - q).norm());
      if (near < 10) continue;
      ++checked;
      const auto name = std::find(std::begin(lobe_names), std::end(lobe_names), shipped.lobes[k].name) - std::begin(lobe_names);
      EXPECT_EQ(int(b.volume.nearest({p.x(), p.y(), p.z()})), int(name) + 1) << p.transpose();
    }
    EXPECT_GT(checked, 5);
  }
  EXPECT_EQ(notes.size(), 1u);
}

TEST_F(OwnBrain, WhatCannotBeIsRefusedWithWhatToDo) {
  const auto with = [&](int k, const TriMesh& m) {
    Options o = by_lobe();
    folder.write("other.stl", test::stl_text(m));
    o.brain[std::size_t(k)] = std::string(lobe_names[k]) + "=" + path("other.stl");
    return refusal(o);
  };
  EXPECT_NE(with(0, test::scaled(block(0), 1e-3)).find("give --brain-unit m"), std::string::npos);
  EXPECT_NE(with(1, test::scaled(block(1), 1e3)).find("no part of a brain is (usual: 15 to 250 mm); as if its numbers were in um: give --brain-unit um"), std::string::npos);
  EXPECT_NE(with(1, test::scaled(block(1), 1e6)).find("give the millimetres of its unit, --brain-unit-mm 1e-06"), std::string::npos);
  TriMesh open = block(1);
  open.triangles.resize(10);
  EXPECT_NE(with(1, open).find("is not closed: it has 1 hole"), std::string::npos);
  EXPECT_NE(with(2, test::joined(block(2), block(2), Vec3(0, 100, 0))).find("is in 2 pieces"), std::string::npos);
  Options o = by_lobe();
  o.brain.pop_back();
  EXPECT_NE(refusal(o).find("there is no insula"), std::string::npos);
  o.brain.push_back("cerebellum=" + path("insula.stl"));
  EXPECT_NE(refusal(o).find("\"cerebellum\" is no lobe"), std::string::npos);
  o.brain.back() = "frontal=" + path("insula.stl");
  EXPECT_NE(refusal(o).find("the frontal is given twice"), std::string::npos);
  o.brain.back() = "insula=" + path("gone.stl");
  EXPECT_NE(refusal(o).find("does not exist"), std::string::npos);
  o.brain = {path("frontal.stl")};
  o.lobe_labels = {"frontal=1"};
  EXPECT_NE(refusal(o).find("--lobe is for volumes"), std::string::npos);
}

#ifdef INSULA_WITH_ITK
TEST_F(OwnBrain, LabelsAreChecked) {
  folder.write("labels.nii", test::nifti_text({20, 20, 20}, 4, [](int i, int, int k) { return i < 6 ? 30 : k < 10 ? 20 : 11; }));
  Options o;
  o.brain = {path("labels.nii")};
  EXPECT_NE(refusal(o).find("say which labels are the frontal"), std::string::npos);
  o.lobe_labels = {"frontal=10-12", "temporal=20", "insula=31"};
  EXPECT_NE(refusal(o).find("none of the labels of the insula is there; there are: 11, 20, 30"), std::string::npos) << refusal(o);
  o.lobe_labels[2] = "insula=3O";
  EXPECT_NE(refusal(o).find("--lobe insula: \"3O\" is neither a label"), std::string::npos) << refusal(o);
  o.lobe_labels[2] = "insula=12,30";
  EXPECT_NE(refusal(o).find("the label 12 is given to the frontal and to the insula"), std::string::npos) << refusal(o);
  o.lobe_labels[2] = "frontal=30";
  EXPECT_NE(refusal(o).find("the frontal is given twice"), std::string::npos) << refusal(o);
  o.lobe_labels[2] = "insula=30";
  const BrainLabels b = read_brain(o, find_project(INSULA_SOURCE_DIR), notes);
  EXPECT_EQ(b.parts[0].labels, (std::vector<int>{10, 11, 12}));
}
#endif

TEST(LabelList, IsReadWholeOrRefusedWithTheItem) {
  EXPECT_EQ(mesh_tool::label_list("7,2-4,1000000"), (std::vector<int>{7, 2, 3, 4, 1000000}));
  for (const char* bad : {"", "1,", ",1", "0", "-1", "+5", " 5", "5 ", "4-", "-4", "4-3", "1-2-3", "1000001", "99999999999", "2;3", "0x10"}) EXPECT_THROW(mesh_tool::label_list(bad), std::runtime_error) << bad;
}

/// Meshes of both lobes and the floor, closed, that fit into each other.
void expect_meshes(const CaseFolder& made, int most_nodes) {
  int nodes = 0;
  for (const char* name : {"frontal", "temporal"}) {
    const TetMesh tets = read_tet_mesh(made.brain() / (std::string(name) + ".msh"), 1.0);
    const TriMesh surface = read_ply(made.brain() / (std::string(name) + "_surface.ply"));
    nodes += int(tets.nodes.size());
    EXPECT_TRUE(border_loops(surface).empty());
    EXPECT_GT(signed_volume(surface), 5000);
    EXPECT_LT(embed(tets, surface.vertices).outside_m, 5);
  }
  EXPECT_TRUE(border_loops(read_ply(made.brain() / "insula_surface.ply")).empty());
  EXPECT_LE(nodes, most_nodes);
  EXPECT_GT(nodes, 150);
}

TEST_F(OwnBrain, BlocksAreMeshedWithinTheirNodes) {
  const CaseFolder made{folder.path() / "made", "made"};
  Options o = by_lobe();
  o.brain_nodes = 450;
  o.brain_in_place = true;
  Progress quiet;
  run_brain(made, find_project(INSULA_SOURCE_DIR), o, quiet);
  expect_meshes(made, 450);
  // The fine surfaces keep to the blocks, half the cleft of a millimetre off where these meet.
  for (int k = 0; k < 3; ++k) {
    double away = 0;
    for (const Vec3& p : read_ply(made.brain() / (std::string(lobe_names[k]) + "_surface.ply")).vertices) {
      if ((p - fissure_centre).norm() > 28) continue;
      const double to_floor = k == 2 ? 40 - p.x() : p.x() - 40, to_cleft = k == 0 ? p.z() + 2 : -2 - p.z();
      const double inside = k == 2 ? to_floor : std::min(to_floor, to_cleft);
      if (k == 2 || std::max(to_floor, to_cleft) > 4) away = std::max(away, std::abs(inside - 0.5));  // edges are rounded
    }
    EXPECT_LT(away, 0.6) << lobe_names[k];
  }
  EXPECT_TRUE(fs::exists(made.path / "brain.json"));
  // Without --brain the stage takes away what it made.
  run_brain(made, find_project(INSULA_SOURCE_DIR), {}, quiet);
  EXPECT_FALSE(fs::exists(made.brain()));
}

TEST_F(OwnBrain, ABrainElsewhereIsRefused) {
  Options o = by_lobe();
  for (int k = 0; k < 3; ++k) folder.write(std::string(lobe_names[k]) + ".stl", test::stl_text(test::joined({}, block(k), Vec3(0, 300, 0))));
  Progress quiet;
  try {
    run_brain({folder.path() / "made", "made"}, find_project(INSULA_SOURCE_DIR), o, quiet);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("is the brain in the MNI frame"), std::string::npos) << e.what();
  }
}

/// What the command line says when it makes the case `own` of a tube with a sac and this brain; the case's folder in `made`.
std::string make_case(const insula::test::SceneFolder& folder, const std::vector<std::string>& brain, CaseFolder& made, int expected = 0) {
  folder.write("vessel.stl", test::stl_text(test::open_tube()));
  std::vector<std::string> words{"new", "own", (folder.path() / "vessel.stl").string(), "--out", (folder.path() / "out").string(), "--vertices", "900", "--no-rehearse"};
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
  const Course wanted = shipped_course(find_project(INSULA_SOURCE_DIR));
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
  const Assets assets = link_assets(made, find_project(INSULA_SOURCE_DIR), {});
  const auto loaded = load_simulation_text("<scene><include file=\"" + assets.parts + "/retracted_fissure.xml\"><variable name=\"lobes\" value=\"../../brain\"/></include><settle time=\"3 s\"/></scene>", made.path / "held.xml", registry, 1);
  EXPECT_EQ(loaded.diagnostics.format(), "");
  if (!loaded.simulation) return {};
  loaded.simulation->step();
  return standing_of(*loaded.simulation);
}

TEST(Standing, ShippedExercisesBeginAsTheyShould) {
  for (const char* name : {"1_sylvian_fissure", "3_clipping"}) {
    const MeasuredScene m = measure_scene(find_project(INSULA_SOURCE_DIR) / "scenes/training" / (std::string(name) + ".xml"), 1);
    EXPECT_EQ(m.message, "");
    for (const Note& n : judged(m.standing)) EXPECT_NE(n.kind, Note::Kind::problem) << name << ": " << n.text;
    EXPECT_EQ(m.standing.arms.size(), name[0] == '1' ? 0u : 2u);
    for (const StandingArm& arm : m.standing.arms) EXPECT_LT(arm.deepest, 1) << arm.id << " presses with " << arm.force << " N";
    if (name[0] == '3') { EXPECT_GT(m.standing.seen, 0.8); }
  }
}

TEST(Standing, WhatIsWrongIsTold) {
  Standing s;
  s.arms = {{"left", "frontal", 0.1, 0.2}, {"right", "temporal", 0.2, 0}};
  s.has_sac = true, s.seen = 0.9;
  const auto count = [](const std::vector<Note>& notes) { return std::count_if(notes.begin(), notes.end(), [](const Note& n) { return n.kind == Note::Kind::problem; }); };
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
  EXPECT_EQ(with([](Standing& t) { t.seen = 0.2; }), 1);
  EXPECT_EQ(with([](Standing& t) { t.in_tissue = {"suction"}; }), 1);
}

int problems(const std::vector<Note>& notes) {
  return int(std::count_if(notes.begin(), notes.end(), [](const Note& n) { return n.kind == Note::Kind::problem; }));
}

TEST_F(OwnBrain, RealLobesAreMeshedAndHeldOpen) {
  const fs::path anatomy = fs::path(INSULA_SOURCE_DIR) / "../shared/anatomy";
  if (!fs::exists(anatomy / "colin27_insula_R.stl")) GTEST_SKIP() << "no anatomy here";
  Options o;
  for (const char* name : lobe_names) o.brain.push_back(std::string(name) + "=" + (anatomy / ("colin27_" + std::string(name) + "_R.stl")).string());
  const CaseFolder made{folder.path() / "made", "made"};
  Progress quiet;
  run_brain(made, find_project(INSULA_SOURCE_DIR), o, quiet);
  expect_meshes(made, 1000);
  const Standing there = settled(made);
  EXPECT_EQ(problems(judged(there)), 0);
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
  BrainLabels far = read_brain(o, project, notes);
  mesh_tool::PartFields fields = build_part_fields(far.volume, nullptr, far.parts, field_options());
  EXPECT_TRUE(settle_in(far, fields, project, notes).rotation.isIdentity(0));
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
  EXPECT_LT((brain_motion(made).apply(fissure_centre + off) - fissure_centre).norm(), 3);
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
