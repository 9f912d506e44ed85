// SPDX-License-Identifier: GPL-3.0-or-later
// The artery generator: the shipped files are what it makes, bit for bit; flat caps; real surfaces; bad tables.
#include <gtest/gtest.h>
#include <unistd.h>

#include <fstream>
#include <numbers>
#include <sstream>

#include "core/base/input_error.h"
#include "core/model/wall_model.h"
#include "import_parts.h"

namespace insula::artery {
namespace {

const std::filesystem::path source = INSULA_SOURCE_DIR;

std::string bytes(const std::filesystem::path& file) {
  std::ifstream in(file, std::ios::binary);
  std::ostringstream s;
  s << in.rdbuf();
  return s.str();
}

/// A folder that is removed in the end.
class TempFolder {
 public:
  TempFolder() : path_(std::filesystem::temp_directory_path() / ("insula_artery_" + std::to_string(getpid()))) {
    std::filesystem::create_directories(path_);
  }
  ~TempFolder() {
    std::error_code error;
    std::filesystem::remove_all(path_, error);
  }
  TempFolder(const TempFolder&) = delete;
  TempFolder& operator=(const TempFolder&) = delete;
  std::filesystem::path path() const { return path_; }
  std::filesystem::path write(const std::string& name, const std::string& text) const {
    std::ofstream(path_ / name, std::ios::binary) << text;
    return path_ / name;
  }

 private:
  std::filesystem::path path_;
};

TEST(ArteryTool, ShippedArteriesAreMadeAgainBitForBit) {
  const TempFolder folder;
  const auto cases = read_case_table(source / "tools/artery/arteries.json");
  ASSERT_EQ(cases.size(), 4u);
  for (const CaseSpec& c : cases) {
    write_vessel(make_case(c), folder.path() / c.name);
    for (const char* file : {"wall.ply", "picture.ply", "vessel.json"}) {
      const std::string made = bytes(folder.path() / c.name / file);
      ASSERT_FALSE(made.empty());
      EXPECT_TRUE(made == bytes(source / "meshes/arteries" / c.name / file)) << c.name << "/" << file;
    }
  }
}

/// A straight tube of radius 1 along z from 0 to 10, by the extraction and cutting of the tool.
Surface tube() {
  Surface s;
  s.mesh = extract(
      [](const Vec3& p) {
        const double z = std::clamp(p.z(), -1.0, 11.0);
        return (p - Vec3(0, 0, z)).norm() - 1;
      },
      Vec3(-1.5, -1.5, -2.5), Vec3(1.5, 1.5, 12.5), 0.2);
  s.patch.assign(s.mesh.triangles.size(), -1);
  cut_and_close(s, {"low", Vec3::Zero(), -Vec3::UnitZ(), 1}, 2.5);
  cut_and_close(s, {"high", Vec3(0, 0, 10), Vec3::UnitZ(), 1}, 2.5);
  return s;
}

TEST(ArteryTool, ATubeIsCutFlatAndClosed) {
  const Surface s = tube();
  double volume = 0, cap_area[2] = {0, 0};
  for (std::size_t t = 0; t < s.patch.size(); ++t) {
    const Vec3 &a = s.mesh.vertices[std::size_t(s.mesh.triangles[t][0])],
               &b = s.mesh.vertices[std::size_t(s.mesh.triangles[t][1])],
               &c = s.mesh.vertices[std::size_t(s.mesh.triangles[t][2])];
    volume += a.dot(b.cross(c)) / 6;
    if (s.patch[t] >= 0) {
      cap_area[s.patch[t]] += 0.5 * (b - a).cross(c - a).norm();
      for (const Vec3& p : {a, b, c}) EXPECT_NEAR(p.z(), s.patch[t] == 0 ? 0 : 10, 1e-12);
    }
  }
  const Quality q = quality(s.mesh);
  EXPECT_TRUE(q.closed);
  EXPECT_EQ(q.euler, 2);
  EXPECT_NEAR(volume, 10 * std::numbers::pi,
              0.03 * 10 * std::numbers::pi);  // chords of a grid of a fifth of the radius
  for (const double a : cap_area) EXPECT_NEAR(a, std::numbers::pi, 0.03 * std::numbers::pi);
  EXPECT_NEAR(section_diameter(s.mesh, Vec3(0.1, 0.2, 5.03), Vec3::UnitZ(), 3), 2, 0.04);
  EXPECT_EQ(section_diameter(s.mesh, Vec3(3, 0, 5), Vec3::UnitZ(), 1), 0);  // no loop about a point outside
}

TEST(ArteryTool, ATubesCapsAndCentrelineAreFound) {
  ImportOptions options;
  options.edge_length = 0.25;
  options.inlet = Vec3(0, 0, 10);
  const Vessel v = import_surface(tube().mesh, options);
  ASSERT_EQ(v.wall.caps.size(), 2u);
  EXPECT_EQ(v.wall.caps[0].name, "inlet");
  EXPECT_NEAR((v.wall.caps[0].centre - Vec3(0, 0, 10)).norm(), 0, 0.02);  // the cap nearest to the point given
  EXPECT_NEAR(v.wall.caps[0].normal.z(), 1, 1e-9);
  EXPECT_NEAR(v.wall.caps[1].normal.z(), -1, 1e-9);
  EXPECT_NEAR(v.wall.caps[0].radius, 1, 0.02);
  ASSERT_EQ(v.centrelines.size(), 1u);
  EXPECT_FALSE(v.neck.has_value());
  const NamedCurve& c = v.centrelines[0];
  EXPECT_EQ(c.from + c.to, "inletoutlet_1");
  EXPECT_NEAR(c.curve.length(), 10, 0.2);
  for (std::size_t k = 0; k < c.curve.size(); ++k) {
    EXPECT_LT(c.curve.points[k].head<2>().norm(), 0.15);
    EXPECT_NEAR(c.curve.radius[k], 1, 0.2);
  }
  EXPECT_NEAR(v.dimensions.at("parent_diameter"), 2, 0.06);
  EXPECT_GT(v.dimensions.at("min_angle_deg"), 20);
}

TEST(ArteryTool, ABallHasNoCaps) {
  const TriMesh ball =
      extract([](const Vec3& p) { return p.norm() - 1; }, Vec3::Constant(-1.5), Vec3::Constant(1.5), 0.13);
  EXPECT_TRUE(with_flat_caps(ball).caps.empty());
  EXPECT_THROW(import_surface(ball, {}), std::runtime_error);
}

struct Real {
  const char* file;
  std::size_t caps;
};
class RealSurface : public testing::TestWithParam<Real> {};

TEST_P(RealSurface, BecomesAVesselThatTheProductReads) {
  const auto file = source / "../shared/anatomy" / GetParam().file;
  if (!std::filesystem::exists(file)) GTEST_SKIP() << "no anatomy here";
  const Vessel v = import_surface(read_surface(file, 1.0), {});
  EXPECT_EQ(v.wall.caps.size(), GetParam().caps);
  const Quality q = quality(v.wall.mesh);
  EXPECT_TRUE(q.closed);
  EXPECT_FALSE(q.self_intersecting);
  EXPECT_EQ(q.euler, 2);
  EXPECT_GE(q.min_angle_deg, 20);
  EXPECT_GE(v.wall.mesh.vertices.size(), 1400u);
  EXPECT_LE(v.wall.mesh.vertices.size(), 2000u);
  EXPECT_TRUE(v.neck.has_value());
  const TempFolder folder;
  write_vessel(v, folder.path());
  const WallModel read = read_wall(folder.path() / "vessel.json");
  EXPECT_EQ(read.wall.vertices.size(), v.wall.mesh.vertices.size());
  EXPECT_EQ(read.caps.size(), GetParam().caps);
  for (const char* region : {"parent", "neck", "sac", "ends"}) EXPECT_GE(read.region(region), 0) << region;
}

INSTANTIATE_TEST_SUITE_P(Anatomy, RealSurface,
                         testing::Values(Real{"dolfin_aneurysm_closed.stl", 3}, Real{"aneumo_aneux4_closed.stl", 2}));

TEST(ArteryTool, BadTablesAreRefused) {
  const TempFolder folder;
  const std::string good = bytes(source / "tools/artery/arteries.json");
  EXPECT_EQ(read_case_table(folder.write("t.json", good)).size(), 4u);
  const auto refused = [&](const std::string& from, const std::string& to, const char* message) {
    std::string text = good;
    ASSERT_NE(text.find(from), std::string::npos) << from;
    text.replace(text.find(from), from.size(), to);
    try {
      read_case_table(folder.write("t.json", text));
      ADD_FAILURE() << "accepted: " << to;
    } catch (const InputError& e) {
      EXPECT_NE(std::string(e.what()).find(message), std::string::npos) << e.what();
    }
  };
  refused("\"cases\"", "\"case\"", "cases is missing");
  refused("\"neck\": 3.5", "\"neck\": \"3.5\"", "sac.neck must be a number");
  refused("\"neck\": 3.5", "\"neck\": 4.45", "sac.width must exceed");
  refused("\"neck\": 3.5", "\"neck\": -3.5", "sac.neck must lie between");
  refused("\"wide_neck\"", "\"narrow_neck\"", "two cases are called");
  refused("\"wide_neck\"", "\"../wide\"", "must be made of a-z");
  refused("[[47.0, 15.5, -9.5], [46.1", "[[47.0, 15.5, -9.0], [46.1", "must start where the parent ends");
  refused("\"towards\": [0.16, 0.96, -0.22]", "\"towards\": [0.86, -0.03, 0.50]", "must lie across the projection");
  refused("]}", "", "is no valid JSON");
}

}  // namespace
}  // namespace insula::artery
