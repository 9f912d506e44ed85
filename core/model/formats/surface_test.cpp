// SPDX-License-Identifier: GPL-3.0-or-later
// Surfaces: the same one from every format, what is refused, and the real anatomy where it lies at hand.
#include <gtest/gtest.h>

#include <array>
#include <bit>
#include <cmath>
#include <limits>
#include <map>
#include <random>

#include "core/base/input_error.h"
#include "core/model/formats/mesh_files_for_test.h"

namespace insula {
namespace {

using test_files::SurfaceFormat;

std::string surface_error(const std::filesystem::path& file) {
  try {
    read_surface(file, 1);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

bool closed(const TriMesh& mesh) {
  std::map<std::pair<int, int>, int> edges;
  for (const auto& t : mesh.triangles)
    for (int k = 0; k < 3; ++k) ++edges[{t[k], t[(k + 1) % 3]}];
  for (const auto& [edge, n] : edges)
    if (n != 1 || edges.count({edge.second, edge.first}) != 1) return false;
  return !edges.empty();
}

double volume(const TriMesh& mesh) {
  double six = 0;
  for (const auto& t : mesh.triangles) six += mesh.vertices[t[0]].cross(mesh.vertices[t[1]]).dot(mesh.vertices[t[2]]);
  return six / 6;
}

class EverySurface : public testing::TestWithParam<SurfaceFormat> {
 protected:
  test_files::TempFolder folder_;
};

TEST_P(EverySurface, GivesTheSameTriangles) {
  const TriMesh surface = test_files::small_surface();
  const TriMesh read = read_surface(folder_.write(GetParam().file, GetParam().bytes(surface)), 1e-3);
  ASSERT_EQ(read.vertices.size(), 4u);
  ASSERT_EQ(read.triangles.size(), 4u);
  for (std::size_t t = 0; t < 4; ++t)
    for (int k = 0; k < 3; ++k)
      EXPECT_LT((read.vertices[std::size_t(read.triangles[t][k])] -
                 1e-3 * surface.vertices[std::size_t(surface.triangles[t][k])])
                    .norm(),
                1e-9)
          << "triangle " << t << " corner " << k;
  EXPECT_TRUE(closed(read));
  EXPECT_NEAR(volume(read), 4e-9, 1e-15);  // 2 x 3 / 2 x 4 / 3 mm3, positive: outward
}

TEST_P(EverySurface, RefusesTruncation) {
  const std::string bytes = GetParam().bytes(test_files::small_surface());
  std::size_t kept = bytes.size();
  while (kept > 0 && (bytes[kept - 1] == '\n' || bytes[kept - 1] == ' ')) --kept;
  // The last number of a text may lose digits unseen; so may a binary STL's last attribute when it happens to be blank.
  if (GetParam().file == "s.stl" && GetParam().name == "stl_binary") kept = bytes.size();
  for (std::size_t n = 0; n < kept; ++n) {
    const std::string error = surface_error(folder_.write(GetParam().file, bytes.substr(0, n)));
    if (GetParam().truncation_shows) {
      ASSERT_NE(error, "") << "cut after " << n << " of " << bytes.size() << " bytes";
    }
  }
}

TEST_P(EverySurface, SurvivesDamage) {
  const std::string bytes = GetParam().bytes(test_files::small_surface());
  std::mt19937 random(4);
  for (int round = 0; round < 300; ++round) {
    std::string damaged = bytes;
    for (int k = 0; k < 1 + round % 3; ++k) damaged[random() % damaged.size()] = char(random());
    try {
      const TriMesh mesh = read_surface(folder_.write(GetParam().file, damaged), 1);
      for (const auto& t : mesh.triangles)
        for (int i : t) ASSERT_TRUE(i >= 0 && i < int(mesh.vertices.size()));
      for (const Vec3& v : mesh.vertices) ASSERT_TRUE(v.allFinite());
    } catch (const InputError&) {
    }
  }
}

TEST_P(EverySurface, RefusesWhatIsNotFinite) {
  TriMesh surface = test_files::small_surface();
  surface.vertices[3].y() = std::numeric_limits<double>::quiet_NaN();
  EXPECT_NE(surface_error(folder_.write(GetParam().file, GetParam().bytes(surface))), "");
}

TEST_P(EverySurface, RefusesIndicesOutOfRange) {
  if (GetParam().file == "s.stl") GTEST_SKIP() << "STL has no indices";
  TriMesh surface = test_files::small_surface();
  const auto good = surface.vertices;
  surface.triangles[2][1] = 77;
  EXPECT_NE(surface_error(folder_.write(GetParam().file, GetParam().bytes(surface))), "");
}

INSTANTIATE_TEST_SUITE_P(Formats, EverySurface, testing::ValuesIn(test_files::surface_formats()),
                         [](const auto& one) { return one.param.name; });

TEST(SurfaceFile, DropsFlatTrianglesAndMergesEqualVertices) {
  const test_files::TempFolder folder;
  const std::string obj =
      "v 0 0 0\nv 1 0 0\nv 0 1 0\nv 0 0 0\nv 1 0 0\nv 0 0 1\nv 2 0 0\n"
      "f 1 3 2\nf 4 5 6\nf 1 2 7\nf 1 1 2\n";  // the last two are flat
  const TriMesh mesh = read_surface(folder.write("a.obj", obj), 1);
  EXPECT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.vertices.size(), 4u);
}

// Data may begin with any byte, also with one that would end a line.
TEST(SurfaceFile, BinaryPlyMayBeginWithAnyByte) {
  const test_files::TempFolder folder;
  for (int byte = 0; byte < 256; ++byte) {
    const float first = std::bit_cast<float>(0x3f800a00u | unsigned(byte));
    const std::array<float, 9> corners{first, 0, 0, 3, 0, 0, 0, 2, 0};
    const std::array<std::int32_t, 3> triangle{0, 1, 2};
    std::string ply =
        "ply\nformat binary_little_endian 1.0\nelement vertex 3\nproperty float x\nproperty float y\nproperty float "
        "z\nelement face 1\nproperty list uchar int vertex_indices\nend_header\n";
    ply.append(reinterpret_cast<const char*>(corners.data()), sizeof corners).push_back('\3');
    ply.append(reinterpret_cast<const char*>(triangle.data()), sizeof triangle);
    const TriMesh mesh = read_surface(folder.write("a.ply", ply), 1);
    ASSERT_EQ(mesh.vertices.size(), 3u) << byte;
    EXPECT_EQ(mesh.vertices[0].x(), double(first));
  }
}

TEST(SurfaceFile, SplitsQuads) {
  const test_files::TempFolder folder;
  const TriMesh mesh = read_surface(folder.write("a.obj", "v 0 0 0\nv 1 0 0\nv 1 1 0\nv 0 1 0\nf 1 2 3 4\n"), 1);
  EXPECT_EQ(mesh.triangles.size(), 2u);
  EXPECT_EQ(mesh.vertices.size(), 4u);
}

TEST(SurfaceFile, RefusesOtherFiles) {
  const test_files::TempFolder folder;
  EXPECT_NE(surface_error(folder.path() / "none.stl").find("no such file"), std::string::npos);
  EXPECT_NE(surface_error(folder.write("a.txt", "x")).find("use .stl"), std::string::npos);
  EXPECT_NE(surface_error(folder.write("a.obj", "v 0 0 0\n")), "");
  EXPECT_NE(surface_error(folder.write("a.obj", "no mesh at all")), "");
}

TEST(SurfaceFile, ReadsNothingOutsideItsFolder) {
  const test_files::TempFolder folder;
  const TriMesh surface = test_files::small_surface();
  for (const auto& format : test_files::surface_formats()) {
    if (format.name != "gltf") continue;
    std::string json = format.bytes(surface);
    // The buffer as a file of its own, beside the glTF and above it.
    const std::size_t begin = json.find("data:application"), end = json.find('"', begin);
    std::string glb;
    for (const auto& other : test_files::surface_formats())
      if (other.name == "glb") glb = other.bytes(surface);
    const std::string buffer = glb.substr(glb.size() - (4 * 3 * 4 + 4 * 3 * 4));
    folder.write("in/buffer.bin", buffer);
    folder.write("outer.bin", buffer);
    const auto with = [&](const std::string& uri) {
      return folder.write("in/s.gltf", json.substr(0, begin) + uri + json.substr(end));
    };
    EXPECT_EQ(surface_error(with("buffer.bin")), "");
    EXPECT_NE(surface_error(with("../outer.bin")), "");
    EXPECT_NE(surface_error(with((folder.path() / "outer.bin").string())), "");
  }
}

TEST(RealAnatomy, IsWatertight) {
  const std::filesystem::path folder = std::filesystem::path(INSULA_SOURCE_DIR) / ".." / "shared" / "anatomy";
  if (!std::filesystem::exists(folder)) GTEST_SKIP() << "no anatomy beside the project";
  struct Known {
    const char* file;
    std::size_t triangles;
  };
  for (const auto& [file, triangles] : {Known{"colin27_frontal_R.stl", 24000}, Known{"colin27_temporal_R.stl", 23998},
                                        Known{"colin27_insula_R.stl", 24000}, Known{"dolfin_aneurysm_closed.stl", 3226},
                                        Known{"aneumo_aneux4_closed.stl", 19092}}) {
    const TriMesh mesh = read_surface(folder / file, 1e-3);
    EXPECT_EQ(mesh.triangles.size(), triangles) << file;
    EXPECT_TRUE(closed(mesh)) << file;
    EXPECT_GT(volume(mesh), 0) << file;
  }
}

}  // namespace
}  // namespace insula
