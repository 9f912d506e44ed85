// SPDX-License-Identifier: GPL-3.0-or-later
// An author's own brain: labels, a surface a lobe, one surface for all, what is refused of them, and meshes of it.
#include <gtest/gtest.h>

#include <cstring>

#include "core/base/input_error.h"
#include "tools/case_builder/brain_for_test.h"
#include "tools/case_builder/fissure.h"
#include "tools/case_builder/project.h"
#include "tools/mesh_lobes/labels.h"

namespace insula::case_builder {
namespace {

int lobe_at(const Vec3& p) { return p.x() < 40 ? 2 : p.z() > -2 ? 0 : 1; }

std::string refusal(const Options& o) {
  std::vector<Note> notes;
  try {
    read_brain(o, find_project(INSULA_SOURCE_DIR), sylvian, notes);
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
        if ((p - sylvian.centre).norm() > 30 || std::abs(x - 40) < layer || (x > 40 && std::abs(z + 2) < layer))
          continue;
        ++all;
        const int label = int(b.volume.nearest({x, y, z}));
        wrong += b.parts[std::size_t(lobe_at(p))].labels.front() != label;
      }
  EXPECT_GT(all, 500);
  EXPECT_EQ(wrong, 0);
}

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
  expect_blocks(read_brain(by_lobe(), find_project(INSULA_SOURCE_DIR), sylvian, notes), 1.0);
  EXPECT_TRUE(notes.empty());
}

TEST_F(OwnBrain, OneSurfaceIsSharedOutToTheNearestShippedLobe) {
  folder.write("brain.ply", "");
  write_ply(folder.path() / "brain.ply", box(low_corner, high_corner), "a block");
  Options o;
  o.brain = {path("brain.ply")};
  const fs::path project = find_project(INSULA_SOURCE_DIR);
  const BrainLabels b = read_brain(o, project, sylvian, notes);
  const Fissure shipped = read_fissure(project, {}, sylvian);
  // Well inside of a shipped lobe there is no doubt.
  for (std::size_t k = 0; k < 2; ++k) {
    int checked = 0;
    for (const Vec3& p : shipped.lobes[k].tets.nodes) {
      if ((p - sylvian.centre).norm() > 30) continue;
      double near = 1e9;
      for (const Vec3& q : shipped.lobes[1 - k].surface.vertices) near = std::min(near, (p - q).norm());
      for (const Vec3& q : shipped.floor.vertices) near = std::min(near, (p - q).norm());
      if (near < 10) continue;
      ++checked;
      const auto name = std::find(lobe_names.begin(), lobe_names.end(), shipped.lobes[k].name) - lobe_names.begin();
      EXPECT_EQ(int(b.volume.nearest({p.x(), p.y(), p.z()})), int(name) + 1) << p.transpose();
    }
    EXPECT_GT(checked, 5);
  }
  EXPECT_EQ(notes.size(), 1u);
  EXPECT_FALSE(b.own_fissure);
}

TEST_F(OwnBrain, WhatCannotBeIsRefusedWithWhatToDo) {
  const auto with = [&](int k, const TriMesh& m) {
    Options o = by_lobe();
    folder.write("other.stl", test::stl_text(m));
    o.brain[std::size_t(k)] = std::string(lobe_names[std::size_t(k)]) + "=" + path("other.stl");
    return refusal(o);
  };
  EXPECT_NE(with(0, test::scaled(block(0), 1e-3)).find("give --brain-unit m"), std::string::npos);
  EXPECT_NE(
      with(1, test::scaled(block(1), 1e3))
          .find("no part of a brain is (usual: 15 to 250 mm); as if its numbers were in um: give --brain-unit um"),
      std::string::npos);
  EXPECT_NE(with(1, test::scaled(block(1), 1e6)).find("give its unit as a length, --brain-unit \"1e-06 mm\""),
            std::string::npos);
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
  folder.write("labels.nii", test::nifti_text({20, 20, 20}, 4, [](int i, int, int k) {
                 return i < 6 ? 30 : k < 10 ? 20 : 11;
               }));
  Options o;
  o.brain = {path("labels.nii")};
  EXPECT_NE(refusal(o).find("say which labels are the frontal"), std::string::npos);
  o.lobe_labels = {"frontal=10-12", "temporal=20", "insula=31"};
  EXPECT_NE(refusal(o).find("none of the labels of the insula is there; there are: 11, 20, 30"), std::string::npos)
      << refusal(o);
  o.lobe_labels[2] = "insula=3O";
  EXPECT_NE(refusal(o).find("--lobe insula: \"3O\" is neither a label"), std::string::npos) << refusal(o);
  o.lobe_labels[2] = "insula=12,30";
  EXPECT_NE(refusal(o).find("the label 12 is given to the frontal and to the insula"), std::string::npos) << refusal(o);
  o.lobe_labels[2] = "frontal=30";
  EXPECT_NE(refusal(o).find("the frontal is given twice"), std::string::npos) << refusal(o);
  o.lobe_labels[2] = "insula=30";
  const BrainLabels b = read_brain(o, find_project(INSULA_SOURCE_DIR), sylvian, notes);
  EXPECT_EQ(b.parts[0].labels, (std::vector<int>{10, 11, 12}));
}
#endif

TEST(LabelList, IsReadWholeOrRefusedWithTheItem) {
  EXPECT_EQ(mesh_tool::label_list("7,2-4,1000000"), (std::vector<int>{7, 2, 3, 4, 1000000}));
  for (const char* bad : {"", "1,", ",1", "0", "-1", "+5", " 5", "5 ", "4-", "-4", "4-3", "1-2-3", "1000001",
                          "99999999999", "2;3", "0x10"})
    EXPECT_THROW(mesh_tool::label_list(bad), std::runtime_error) << bad;
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
    for (const Vec3& p : read_ply(made.brain() / (std::string(lobe_names[std::size_t(k)]) + "_surface.ply")).vertices) {
      if ((p - sylvian.centre).norm() > 28) continue;
      const double to_floor = k == 2 ? 40 - p.x() : p.x() - 40, to_cleft = k == 0 ? p.z() + 2 : -2 - p.z();
      const double inside = k == 2 ? to_floor : std::min(to_floor, to_cleft);
      if (k == 2 || std::max(to_floor, to_cleft) > 4)
        away = std::max(away, std::abs(inside - 0.5));  // edges are rounded
    }
    EXPECT_LT(away, 0.6) << lobe_names[std::size_t(k)];
  }
  EXPECT_TRUE(fs::exists(made.path / "brain.json"));
  // Without --brain the stage takes away what it made.
  run_brain(made, find_project(INSULA_SOURCE_DIR), {}, quiet);
  EXPECT_FALSE(fs::exists(made.brain()));
}

TEST_F(OwnBrain, ABrainElsewhereIsRefused) {
  Options o = by_lobe();
  for (int k = 0; k < 3; ++k)
    folder.write(std::string(lobe_names[std::size_t(k)]) + ".stl",
                 test::stl_text(test::joined({}, block(k), Vec3(0, 300, 0))));
  Progress quiet;
  try {
    run_brain({folder.path() / "made", "made"}, find_project(INSULA_SOURCE_DIR), o, quiet);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("is the brain in the MNI frame"), std::string::npos) << e.what();
  }
}

}  // namespace
}  // namespace insula::case_builder
