// SPDX-License-Identifier: GPL-3.0-or-later
// What authors give by mistake: each kind of input gets an error that says what to do, or a repair that is told.
#include <gtest/gtest.h>

#include <cstring>
#include <numbers>

#include "core/base/input_error.h"
#include "tools/case_builder/intake.h"
#include "tools/case_builder/shapes_for_test.h"

namespace insula::case_builder {
namespace {

using test::tube_with_sac;

struct Given {
  std::string name, file;
  std::function<std::string()> text;  ///< the file's content; none: no file
  std::string says;                   ///< part of the error, or of a note
  bool taken = false;                 ///< it is taken in, with that repair
  std::function<void(Options&)> choose = nullptr;
};
void PrintTo(const Given& g, std::ostream* out) { *out << g.name; }

std::string stl(const TriMesh& m) { return test::stl_text(m); }

TriMesh ball(double radius, bool holed) {
  TriMesh m = artery::extract([=](const Vec3& p) { return p.norm() - radius; }, Vec3::Constant(-radius - 0.71),
                              Vec3::Constant(radius + 0.83), 0.5);
  return holed ? test::without(m, [=](const Vec3& p) { return p.z() > 0.8 * radius; }) : m;
}
TriMesh ring() {
  return artery::extract([](const Vec3& p) { return std::hypot(std::hypot(p.x(), p.y()) - 5, p.z()) - 1.4; },
                         Vec3(-7.1, -7.2, -2.3), Vec3(7.2, 7.1, 2.2), 0.5);
}
TriMesh sheet() {
  TriMesh m;
  for (int j = 0; j <= 10; ++j)
    for (int i = 0; i <= 10; ++i) m.vertices.emplace_back(i, j, 0);
  for (int j = 0; j < 10; ++j)
    for (int i = 0; i < 10; ++i) {
      const int a = 11 * j + i;
      for (const auto& t : {std::array{a, a + 1, a + 12}, std::array{a, a + 12, a + 11}, std::array{a, a + 12, a + 1},
                            std::array{a, a + 11, a + 12}})
        m.triangles.push_back(t);
    }
  return m;
}
TriMesh twisted_band() {
  TriMesh m;
  constexpr int n = 40;
  for (int k = 0; k < n; ++k) {
    const double a = 2 * std::numbers::pi * k / n;
    for (const double w : {-1.5, 1.5})
      m.vertices.emplace_back((6 + w * std::cos(a / 2)) * std::cos(a), (6 + w * std::cos(a / 2)) * std::sin(a),
                              w * std::sin(a / 2));
  }
  for (int k = 0; k < n; ++k) {
    const int a = 2 * k, b = 2 * k + 1, c = k + 1 < n ? a + 2 : 1, d = k + 1 < n ? b + 2 : 0;
    m.triangles.push_back({a, c, b}), m.triangles.push_back({b, c, d});
  }
  return m;
}
TriMesh with_fin() {
  TriMesh m = tube_with_sac();
  m.vertices.emplace_back(0, 0, 9);
  for (int k = 0; k < 6; ++k)
    m.triangles.push_back(
        {m.triangles[std::size_t(40 * k)][0], m.triangles[std::size_t(40 * k)][1], int(m.vertices.size()) - 1});
  return m;
}
TriMesh slanted() {
  return test::without(test::open_tube(),
                       [](const Vec3& p) { return p.x() > 7.2 + 0.5 * std::sin(3 * std::atan2(p.y(), p.z())); });
}
TriMesh finer(TriMesh m) {
  TriMesh out = m;
  out.triangles.clear();
  std::map<std::pair<int, int>, int> middles;
  const auto middle = [&](int a, int b) {
    const auto [at, fresh] = middles.emplace(std::minmax(a, b), int(out.vertices.size()));
    if (fresh) out.vertices.push_back(0.5 * (m.vertices[std::size_t(a)] + m.vertices[std::size_t(b)]));
    return at->second;
  };
  for (const auto& [a, b, c] : m.triangles) {
    const int ab = middle(a, b), bc = middle(b, c), ca = middle(c, a);
    for (const auto& t : {std::array{a, ab, ca}, std::array{b, bc, ab}, std::array{c, ca, bc}, std::array{ab, bc, ca}})
      out.triangles.push_back(t);
  }
  return out;
}
TriMesh turned(TriMesh m, int every) {
  for (std::size_t t = 0; t < m.triangles.size(); t += std::size_t(every))
    std::swap(m.triangles[t][1], m.triangles[t][2]);
  return m;
}
TriMesh doubled(TriMesh m) {
  for (int t = 0; t < 7; ++t) m.triangles.push_back(m.triangles[std::size_t(50 * t)]);
  return m;
}
std::string jittered() {
  // Each triangle has corners of its own that miss those of its neighbours by some nanometres.
  const TriMesh m = tube_with_sac();
  TriMesh apart;
  for (const auto& t : m.triangles) {
    const int first = int(apart.vertices.size());
    for (int k = 0; k < 3; ++k)
      apart.vertices.push_back(m.vertices[std::size_t(t[std::size_t(k)])] + 4e-6 * Vec3((first / 3) % 2, 0, 0));
    apart.triangles.push_back({first, first + 1, first + 2});
  }
  std::string s;
  char line[80];
  for (const Vec3& p : apart.vertices)
    std::snprintf(line, sizeof line, "v %.9f %.9f %.9f\n", p.x(), p.y(), p.z()), s += line;
  for (const auto& t : apart.triangles)
    s += "f " + std::to_string(t[0] + 1) + " " + std::to_string(t[1] + 1) + " " + std::to_string(t[2] + 1) + "\n";
  return s;
}
std::string labels(double spacing = 0.3, int times = 1, const std::function<int(int, int, int)>& also = nullptr) {
  return test::nifti_text(
      {54, 24, 32}, spacing, [&](int i, int j, int k) { return also ? also(i, j, k) : test::tube_label(i, j, k); },
      times);
}
std::string with_nan() {
  std::string s = stl(tube_with_sac());
  const float nan = std::nanf("");
  std::memcpy(s.data() + 84 + 12, &nan, 4);
  return s;
}

const auto label_1 = [](Options& o) { o.label = 1; };

const std::vector<Given> all = {
    // --- refused, with what to do
    // -------------------------------------------------------------------------------------
    {"no_file", "none.stl", nullptr, "does not exist"},
    {"empty_file", "a.stl", [] { return std::string(); }, "a.stl"},
    {"no_triangles", "a.stl", [] { return std::string(84, '\0'); }, "no triangles"},
    {"truncated_stl", "a.stl", [] { return stl(tube_with_sac()).substr(0, 20000); }, "announces"},
    {"garbage", "a.stl", [] { return std::string(500, 'x'); }, "a.stl"},
    {"unknown_kind", "a.xyz", [] { return std::string("1 2 3"); }, "is no known surface"},
    {"not_finite", "a.stl", with_nan, "not finite"},
    {"obj_index_out_of_range", "a.obj", [] { return std::string("v 0 0 0\nv 1 0 0\nv 0 1 0\nf 1 2 9\n"); }, "a.obj"},
    {"gltf_garbage", "a.gltf", [] { return std::string("{\"asset\":"); }, "a.gltf"},
    {"ply_truncated", "a.ply",
     [] {
       return std::string(
           "ply\nformat ascii 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float z\nelement "
           "face 1\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n");
     },
     "a.ply"},
    {"vtp_of_another_type", "a.vtp", [] { return std::string("<VTKFile type=\"UnstructuredGrid\"></VTKFile>"); },
     "not PolyData"},
    {"vtp_of_an_unknown_byte_order", "a.vtp",
     [] { return std::string("<VTKFile type=\"PolyData\" byte_order=\"MiddleEndian\"></VTKFile>"); },
     "byte_order \"MiddleEndian\" is unknown"},
    {"vtp_of_an_unknown_header", "a.vtp",
     [] { return std::string("<VTKFile type=\"PolyData\" header_type=\"UInt16\"></VTKFile>"); },
     "header_type \"UInt16\" is unknown"},
    {"vtp_with_points_twice", "a.vtp",
     [] {
       std::string s = test::vtp_text(tube_with_sac());
       return s.insert(s.find("<Points>") + 8,
                       "<DataArray type=\"Float32\" NumberOfComponents=\"3\">0 0 0</DataArray>");
     },
     "has the array \"Points\" twice"},
    {"vtp_truncated", "a.vtp", [] { return test::vtp_text(tube_with_sac()).substr(0, 4000); }, "ends early"},
    {"vtp_index_out_of_range", "a.vtp",
     [] {
       TriMesh m = tube_with_sac();
       m.triangles[3][1] = 999999;
       return test::vtp_text(m);
     },
     "names point 999999"},
    {"given_a_wrong_unit", "a.stl", [] { return stl(tube_with_sac()); }, "--unit", false,
     [](Options& o) { o.unit_mm = 1000; }},
    {"one_sided", "a.obj", [] { return test::obj_text(twisted_band()); }, "only one side"},
    {"two_vessels", "a.stl", [] { return stl(test::joined(tube_with_sac(), tube_with_sac(), Vec3(0, 20, 0))); },
     "--keep-largest"},
    {"sheet_without_thickness", "a.obj", [] { return test::obj_text(sheet()); }, "encloses next to nothing"},
    {"one_triangle", "a.obj", [] { return std::string("v 0 0 0\nv 9 0 0\nv 0 9 0\nf 1 2 3\n"); },
     "encloses next to nothing"},
    {"closed_ball", "a.stl", [] { return stl(ball(4, false)); }, "has 0 openings"},
    {"ball_with_one_hole", "a.stl", [] { return stl(ball(4, true)); }, "has 1 opening"},
    {"closed_ring", "a.stl", [] { return stl(ring()); }, "parted at their thinnest place", true},
    {"torn_wall", "a.stl",
     [] {
       return stl(test::without(tube_with_sac(),
                                [](const Vec3& p) { return p.y() > 0.2 && std::abs(p.x()) < 6 && p.z() < 1.2; }));
     },
     "neither an end of a vessel nor small"},
    {"label_for_a_surface", "a.stl", [] { return stl(tube_with_sac()); }, "is a surface", false, label_1},
    {"plane_beside_the_vessel", "a.stl", [] { return stl(tube_with_sac()); }, "does not meet the vessel", false,
     [](Options& o) {
       o.cuts = {{40, 0, 0, 1, 0, 0}};
     }},
    {"plane_without_direction", "a.stl", [] { return stl(tube_with_sac()); }, "has no length", false,
     [](Options& o) {
       o.cuts = {{0, 0, 0, 0, 0, 0}};
     }},
#ifdef INSULA_WITH_ITK
    {"volume_without_the_label", "a.nii", [] { return labels(); }, "there are: 1", false,
     [](Options& o) { o.label = 7; }},
    {"volume_and_nothing_said", "a.nii", [] { return labels(); }, "--label N"},
    {"volume_below_the_threshold", "a.nii", [] { return labels(); }, "nothing reaches the threshold", false,
     [](Options& o) { o.threshold = 300; }},
    {"label_and_threshold", "a.nii", [] { return labels(); }, "exclude each other", false,
     [](Options& o) { o.threshold = 1, o.label = 1; }},
    {"volume_with_a_unit", "a.nii", [] { return labels(); }, "--unit is for surfaces", false,
     [](Options& o) { o.label = 1, o.unit_mm = 10; }},
    {"picture_of_one_slice", "a.nii",
     [] {
       return test::nifti_text({54, 24, 1}, 0.3, [](int i, int j, int) { return test::tube_label(i, j, 8); });
     },
     "a.nii", false, label_1},
    {"volume_over_time", "a.nii", [] { return labels(0.3, 3); }, "4 dimensions", false, label_1},
    {"volume_truncated", "a.nii", [] { return labels().substr(0, 30000); }, "ends early", false, label_1},
    {"meta_image_truncated", "a.mha",
     [] {
       return "ObjectType = Image\nNDims = 3\nBinaryData = True\nDimSize = 54 24 32\nElementType = "
              "MET_UCHAR\nElementSpacing = 0.3 0.3 0.3\nElementDataFile = LOCAL\n" +
              labels().substr(352, 30000);
     },
     "ends early", false, label_1},
    {"volume_garbage", "a.nii", [] { return std::string(4000, 'q'); }, "a.nii", false, label_1},
    {"volume_in_metres", "a.nii", [] { return labels(3e-4); }, "unit in its header", false, label_1},
    {"meta_image_without_its_data", "a.mhd",
     [] {
       return std::string(
           "ObjectType = Image\nNDims = 3\nDimSize = 9 9 9\nElementType = MET_UCHAR\nElementSpacing = 1 1 "
           "1\nElementDataFile = gone.raw\n");
     },
     "a.mhd", false, label_1},
    {"dicom_that_is_none", "a.dcm", [] { return std::string(600, 'x'); }, "no DICOM images", false, label_1},
#endif
    // --- mended, and told
    // ---------------------------------------------------------------------------------------------
    {"in_metres", "a.stl", [] { return stl(test::scaled(tube_with_sac(), 1e-3)); }, "taken times 1000", true},
    {"in_centimetres", "a.stl", [] { return stl(test::scaled(tube_with_sac(), 0.1)); }, "taken times 10", true},
    {"in_micrometres", "a.stl", [] { return stl(test::scaled(tube_with_sac(), 1000)); }, "divided by 1000", true},
    {"ten_times_too_large", "a.stl", [] { return stl(test::scaled(tube_with_sac(), 10)); }, "divided by 10", true},
    {"three_walls_at_an_edge", "a.obj", [] { return test::obj_text(with_fin()); }, "made anew from a grid", true},
    {"open_ends", "a.stl", [] { return stl(test::open_tube()); }, "closed by flat caps", true},
    {"ends_cut_askew", "a.stl", [] { return stl(slanted()); }, "cut straight", true},
    {"inside_out", "a.stl", [] { return stl(turned(tube_with_sac(), 1)); }, "inside out", true},
    {"some_triangles_turned", "a.stl", [] { return stl(turned(tube_with_sac(), 9)); }, "faced the wrong way", true},
    {"triangles_twice", "a.obj", [] { return test::obj_text(doubled(tube_with_sac())); },
     "7 triangles that were there twice", true},
    {"vertices_apart", "a.obj", jittered, "were joined", true},
    {"small_hole", "a.stl",
     [] {
       return stl(test::without(test::open_tube(), [](const Vec3& p) { return (p - Vec3(4, 0, 1.4)).norm() < 0.25; }));
     },
     "small hole", true},
    {"speck_beside", "a.stl", [] { return stl(test::joined(tube_with_sac(), ball(4, false), Vec3(0, 9, 0), 0.15)); },
     "in 2 pieces", true},
    {"three_walls_and_a_grid", "a.obj", [] { return test::obj_text(with_fin()); }, "made anew from a grid", true,
     [](Options& o) {
       o.rebuild = 0.3, o.cuts = {{-7.5, 0, 0, -1, 0, 0}, {7.5, 0, 0, 1, 0, 0}};
     }},
    {"far_too_many_triangles", "a.obj", [] { return test::obj_text(finer(finer(finer(tube_with_sac(0.5))))); },
     "far more than its shape needs", true,
     [](Options& o) {
       o.cuts = {{-7.5, 0, 0, -1, 0, 0}, {7.5, 0, 0, 1, 0, 0}};
     }},
    {"centimetres_and_said_so", "a.vtp", [] { return test::vtp_text(test::scaled(test::open_tube(), 0.1)); },
     "closed by flat caps", true, [](Options& o) { o.unit_mm = 10; }},
#ifdef INSULA_WITH_ITK
    {"volume_with_specks", "a.nii",
     [] {
       return labels(
           0.3, 1, [](int i, int j, int k) { return int(test::tube_label(i, j, k) || (i > 50 && j > 21 && k > 29)); });
     },
     "several pieces", true, label_1},
    {"volume_with_a_void", "a.nii",
     [] {
       return labels(0.3, 1, [](int i, int j, int k) {
         return int(test::tube_label(i, j, k) && !(i == 26 && j == 12 && k == 19));
       });
     },
     "Voids", true, label_1},
#endif
};

class BadInput : public testing::TestWithParam<Given> {};

TEST_P(BadInput, IsRefusedWithAdviceOrMendedAndTold) {
  const Given& g = GetParam();
  insula::test::SceneFolder folder;
  const fs::path file = folder.path() / "given" / g.file;
  if (g.text) folder.write("given/" + g.file, g.text());
  Options o;
  if (g.choose) g.choose(o);
  Progress quiet;
  std::string heard;
  bool taken = false;
  try {
    const Intake in = take_in(file, o, quiet);
    taken = true;
    for (const Note& n : in.notes) heard += n.text + "\n";
    EXPECT_GE(in.surface.caps.size(), 2u);
    EXPECT_GT(signed_volume(in.surface.mesh), 0);
    EXPECT_TRUE(border_loops(in.surface.mesh).empty());
  } catch (const InputError& e) {
    heard = e.what();
  }
  EXPECT_EQ(taken, g.taken) << heard;
  EXPECT_NE(heard.find(g.says), std::string::npos) << "said: " << heard;
}

INSTANTIATE_TEST_SUITE_P(Each, BadInput, testing::ValuesIn(all), [](const auto& p) { return p.param.name; });

TEST(BadInput, FiveMillionTrianglesAreRefusedBeforeTheyAreRead) {
  insula::test::SceneFolder folder;
  folder.write("big.stl", std::string(84, '\0'));
  const fs::path file = folder.path() / "big.stl";
  fs::resize_file(file, 84 + 50ull * 5'000'000);  // sparse: takes no room
  Progress quiet;
  try {
    take_in(file, {}, quiet);
    FAIL();
  } catch (const InputError& e) {
    EXPECT_NE(std::string(e.what()).find("5000000 triangles"), std::string::npos) << e.what();
    EXPECT_NE(std::string(e.what()).find("decimate"), std::string::npos);
  }
}

TEST(BadInput, EmptyFolderIsNoSeries) {
  insula::test::SceneFolder folder;
  Progress quiet;
  EXPECT_THROW(take_in(folder.path(), {}, quiet), InputError);
}

}  // namespace
}  // namespace insula::case_builder
