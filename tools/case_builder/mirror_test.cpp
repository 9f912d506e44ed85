// SPDX-License-Identifier: GPL-3.0-or-later
// Left for right: mirroring twice gives the same bits, and a left-sided vessel and brain become the case of their
// right-sided twins.
#include "tools/case_builder/mirror.h"

#include <gtest/gtest.h>

#include "core/base/input_error.h"
#include "core/model/formats/file_bytes.h"
#include "tools/case_builder/brain_for_test.h"
#include "tools/case_builder/commands.h"
#include "tools/case_builder/intake.h"
#include "tools/case_builder/measured_scene.h"
#include "tools/case_builder/project.h"
#include "tools/case_builder/scenes.h"
#ifdef INSULA_WITH_ITK
#include "tools/case_builder/volume_reader.h"
#endif

namespace insula::case_builder {
namespace {

/// As an author's program would: vertex by vertex, each triangle read backwards.
TriMesh left_of(TriMesh m) {
  for (Vec3& p : m.vertices) p.x() *= -1;
  for (auto& t : m.triangles) std::swap(t[1], t[2]);
  return m;
}

/// What the command line says of a mistake; its status in `status`.
std::string said(const std::vector<std::string>& words, int& status) {
  std::FILE *out = std::tmpfile(), *err = std::tmpfile();
  status = run_command(words, out, err);
  std::string text(8192, '\0');
  std::rewind(err);
  text.resize(std::fread(text.data(), 1, text.size(), err));
  std::fclose(out), std::fclose(err);
  return text;
}

/// Of a case, but for what was asked for and the report, which holds measured times.
std::map<std::string, std::string> texts_of(const fs::path& folder) {
  std::map<std::string, std::string> out;
  for (const auto& f : fs::recursive_directory_iterator(folder))
    if (f.is_regular_file() && f.path().stem() != "report" && f.path().filename() != "case.json" &&
        f.path().string().find("/meshes/") == std::string::npos)
      out[f.path().lexically_relative(folder).string()] = read_file_bytes(f.path());
  return out;
}

TEST(Mirror, TwiceIsTheSameAndOutwardStaysOutward) {
  const TriMesh m = test::tube_with_sac();
  TriMesh once = m;
  mirror(once);
  EXPECT_NEAR(signed_volume(once), signed_volume(m), 1e-9 * signed_volume(m));
  EXPECT_EQ(once.vertices[7], Vec3(-m.vertices[7].x(), m.vertices[7].y(), m.vertices[7].z()));
  TriMesh twice = once;
  mirror(twice);
  EXPECT_EQ(twice.vertices, m.vertices);
  EXPECT_EQ(twice.triangles, m.triangles);
  TriMesh middle = box({0, 0, 0}, {1, 1, 1});
  mirror(middle);
  for (const Vec3& p : middle.vertices)
    EXPECT_FALSE(p.x() == 0 && std::signbit(p.x())) << "a zero with a sign shows in a file";
}

TEST(Mirror, PositionsOfTheFilesGoWithThem) {
  Options o;
  o.seed = Point{1, 2, 3};
  o.inlet = Point{-4, 5, 6};
  o.cuts = {{1, 2, 3, 4, 5, 6}, {-7, 8, 9, -10, 11, 12}};
  o.neck = Plane{1, 2, 3, -0.6, 0, 0.8};
  o.neck_points = std::array<double, 6>{1, 2, 3, 4, 5, 6};
  o.turn = 5;
  EXPECT_EQ(to_json(as_read(o)), to_json(o)) << "without --mirror nothing changes";
  o.mirror = true;
  const Options m = as_read(o);
  EXPECT_EQ(*m.seed, (Point{-1, 2, 3}));
  EXPECT_EQ(*m.inlet, (Point{4, 5, 6}));
  EXPECT_EQ(m.cuts, (std::vector<Plane>{{-1, 2, 3, -4, 5, 6}, {7, 8, 9, 10, 11, 12}}));
  EXPECT_EQ(*m.neck, (Plane{-1, 2, 3, 0.6, 0, 0.8}));
  EXPECT_EQ(*m.neck_points, (std::array<double, 6>{-1, 2, 3, -4, 5, 6}));
  EXPECT_EQ(*m.turn, 5) << "of the blades, in the case";
  EXPECT_EQ(to_json(as_read(m)), to_json(o));
  EXPECT_TRUE(options_from_json(to_json(o)).mirror);
}

TEST(Mirror, MessagesSayThatTheirPositionsAreMirrored) {
  insula::test::SceneFolder folder;
  TriMesh fin = test::tube_with_sac();
  // A sheet that hangs on an edge of the wall at x > 0.
  for (const auto& t : fin.triangles)
    if (fin.vertices[std::size_t(t[0])].x() > 3 && fin.vertices[std::size_t(t[1])].x() > 3) {
      fin.vertices.emplace_back(5, 0, -6);
      fin.triangles.push_back({t[0], t[1], int(fin.vertices.size()) - 1});
      break;
    }
  folder.write("fin.stl", test::stl_text(fin));
  Options o;
  o.mirror = true;
  Progress quiet;
  const Intake in = take_in(folder.path() / "fin.stl", o, quiet);
  const std::string said = "fin.stl (mirrored): 1 edge belongs to three or more triangles (the first at (-";
  EXPECT_TRUE(std::any_of(in.notes.begin(), in.notes.end(),
                          [&](const Note& n) { return n.text.find(said) != std::string::npos; }));
}

/// Both folders hold the same files, byte for byte.
void expect_same(const fs::path& right, const fs::path& left, std::size_t least) {
  const auto twin = texts_of(right), files = texts_of(left);
  EXPECT_GE(twin.size(), least);
  EXPECT_EQ(files.size(), twin.size());
  for (const auto& [file, text] : files) {
    ASSERT_TRUE(twin.contains(file)) << file;
    EXPECT_TRUE(text == twin.at(file)) << file << " differs";
  }
}

TEST_F(OwnBrain, OfTheLeftSideBecomesThatOfItsRightSidedTwin) {
  for (const char* side : {"right", "left"}) {
    const bool is_left = side[0] == 'l';
    for (int k = 0; k < 3; ++k)
      folder.write(std::string(lobe_names[std::size_t(k)]) + ".stl",
                   test::stl_text(is_left ? left_of(block(k)) : block(k)));
    Options o = by_lobe();
    o.mirror = is_left, o.brain_nodes = 450, o.brain_in_place = true;
    Progress quiet;
    run_brain({folder.path() / side, side}, find_project(INSULA_SOURCE_DIR), o, quiet);
  }
  expect_same(folder.path() / "right", folder.path() / "left", 6);
  // As it is, a left-sided brain is refused, with what to do.
  Options o = by_lobe();
  o.brain_in_place = true;
  Progress quiet;
  try {
    run_brain({folder.path() / "as_it_is", "as_it_is"}, find_project(INSULA_SOURCE_DIR), o, quiet);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("One of the left side needs --mirror."), std::string::npos) << e.what();
  }
}

TEST(MirroredCase, IsTheCaseOfItsTwinAndPassesItsCheck) {
  insula::test::SceneFolder folder;
  const auto path = [&](const std::string& name) { return (folder.path() / name).string(); };
  // The same names in two folders; the neck and the inlet are given, so that positions of the author's files are a part
  // of it.
  const TriMesh vessel = test::open_tube();
  for (const char* side : {"right", "left"}) {
    const bool is_left = side[0] == 'l';
    const std::string in = std::string(side) + "_files/vessel.stl";
    folder.write(in, test::stl_text(is_left ? left_of(vessel) : vessel));
    std::vector<std::string> words{"new",      "own",
                                   path(in),   "--out",
                                   path(side), "--vertices",
                                   "900",      "--no-rehearse",
                                   "--neck",   is_left ? "-0.1 0 2.2 mm -0.05 0 1" : "0.1 0 2.2 mm 0.05 0 1",
                                   "--inlet",  is_left ? "-8 0 0 mm" : "8 0 0 mm"};
    if (is_left) words.push_back("--mirror");
    int status = 0;
    const std::string text = said(words, status);
    ASSERT_EQ(status, 0) << text;
  }
  const CaseFolder right{folder.path() / "right/own", "own"}, left{folder.path() / "left/own", "own"};
  expect_same(right.path, left.path, 15);
  EXPECT_TRUE(read_json(left.options_file()).at("options").at("mirror").get<bool>());
  EXPECT_NE(read_file_bytes(left.path / "report.html").find("mirrored at x = 0"), std::string::npos);
  EXPECT_EQ(read_file_bytes(right.path / "report.html").find("mirrored at x = 0"), std::string::npos);
  for (const fs::path& file : exercise_files(left)) {
    const MeasuredScene m = measure_scene(file, 5);
    EXPECT_EQ(m.message, "") << file;
    EXPECT_TRUE(m.finite) << file;
  }
}

#ifdef INSULA_WITH_ITK
/// A NIfTI file whose first axis runs the other way: what it holds lies mirrored at x = 0.
std::string other_side(std::string nifti) {
  for (const std::size_t at : {std::size_t(280), std::size_t(292)}) {
    float x;
    std::memcpy(&x, nifti.data() + at, 4);
    x = -x;
    std::memcpy(nifti.data() + at, &x, 4);
  }
  return nifti;
}

TEST(Mirror, LabelsOfTheLeftSideLieWhereThoseOfTheRightDo) {
  insula::test::SceneFolder folder;
  const std::string right = test::nifti_text(
      {30, 20, 24}, 0.7, [](int i, int j, int k) { return (i * 7 + j * 3 + k) % 5; }, 1, Vec3(31, -4, 2.5));
  folder.write("right.nii", right);
  folder.write("left.nii", other_side(right));
  const mesh_tool::NiftiVolume a = read_volume(folder.path() / "right.nii");
  mesh_tool::NiftiVolume b = read_volume(folder.path() / "left.nii");
  EXPECT_NE(a.to_world, b.to_world);
  const mesh_tool::NiftiVolume before = b;
  mirror(b);
  for (int i = 0; i < 30; ++i)
    for (int k = 0; k < 24; ++k) {
      const mesh_tool::Vec3 p{31 + 0.7 * i, 1.6, 2.5 + 0.7 * k};
      ASSERT_EQ(a.nearest(p), b.nearest(p)) << i << " " << k;
      ASSERT_EQ(b.nearest(p), before.nearest({-p[0], p[1], p[2]}));
    }
  mirror(b);
  EXPECT_EQ(b.to_world, before.to_world);
  EXPECT_EQ(b.from_world, before.from_world);
}

TEST(Mirror, AVesselOfLabelsKeepsItsShape) {
  insula::test::SceneFolder folder;
  const std::string right = test::nifti_text(
      {54, 25, 33}, 0.3, [](int i, int j, int k) { return test::tube_label(i, j, k); }, 1, Vec3(40, -3.6, -2.4));
  folder.write("right.nii", right);
  folder.write("left.nii", other_side(right));
  Options o;
  o.label = 1;
  o.seed = Point{48, 0, 0};
  Progress quiet;
  const Intake a = take_in(folder.path() / "right.nii", o, quiet);
  o.mirror = true;
  o.seed = Point{-48, 0, 0};
  const Intake b = take_in(folder.path() / "left.nii", o, quiet);
  EXPECT_NEAR(signed_volume(a.surface.mesh), signed_volume(b.surface.mesh), 1e-3 * signed_volume(a.surface.mesh));
  ASSERT_EQ(a.surface.caps.size(), 2u);
  ASSERT_EQ(b.surface.caps.size(), 2u);
  for (const auto& cap : b.surface.caps) {
    double nearest = 1e9;
    for (const auto& other : a.surface.caps) nearest = std::min(nearest, (cap.centre - other.centre).norm());
    EXPECT_LT(nearest, 0.05) << cap.centre.transpose();
  }
}
#endif

}  // namespace
}  // namespace insula::case_builder
