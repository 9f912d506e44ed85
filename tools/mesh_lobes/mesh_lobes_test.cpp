// SPDX-License-Identifier: GPL-3.0-or-later
// Tests of the mesh generator on small synthetic volumes.
#include <gtest/gtest.h>
#include <zlib.h>

#include <cstring>
#include <filesystem>
#include <fstream>
#include <numbers>
#include <sstream>

#include "cleft.h"
#include "grid_ops.h"
#include "mesh_data.h"
#include "meshing.h"
#include "part_fields.h"
#include "separate.h"

namespace insula::mesh_tool {
namespace {

namespace fs = std::filesystem;

std::string temp(const std::string& name) { return (fs::path(testing::TempDir()) / ("insula_" + name)).string(); }

std::string slurp(const std::string& path) {
  std::ifstream in(path, std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  return text.str();
}

// A NIfTI-1 image of int16 with a given sform; what read_nifti() is to understand.
std::string nifti_bytes(int nx, int ny, int nz, const std::vector<std::int16_t>& values, const float (&rows)[12],
                        bool swap) {
  std::string head(352, '\0');
  const auto put = [&](std::size_t offset, auto value) {
    char raw[sizeof value];
    std::memcpy(raw, &value, sizeof value);
    if (swap) std::reverse(raw, raw + sizeof value);
    head.replace(offset, sizeof value, raw, sizeof value);
  };
  put(0, std::int32_t{348});
  const std::int16_t dims[] = {3, std::int16_t(nx), std::int16_t(ny), std::int16_t(nz), 1, 1, 1, 1};
  for (std::size_t i = 0; i < 8; ++i) put(40 + 2 * i, dims[i]);
  put(70, std::int16_t{4});
  put(72, std::int16_t{16});
  for (std::size_t i = 0; i < 4; ++i) put(76 + 4 * i, 1.0f);
  put(108, 352.0f);
  put(112, 2.0f);   // slope
  put(116, -1.0f);  // intercept
  head[123] = 2;    // millimetres
  put(254, std::int16_t{1});
  for (std::size_t i = 0; i < 12; ++i) put(280 + 4 * i, rows[i]);
  std::memcpy(head.data() + 344, "n+1", 4);
  for (std::int16_t v : values) {
    char raw[2];
    std::memcpy(raw, &v, 2);
    if (swap) std::swap(raw[0], raw[1]);
    head.append(raw, 2);
  }
  return head;
}

constexpr float shear[12] = {0, -2, 0, 10, 3, 0, 0, -5, 0, 0, 1.5f, 7};  // x = 10 - 2 j, y = 3 i - 5, z = 1.5 k + 7

TEST(Nifti, ReadsAffineScaleAndBothByteOrdersPlainAndCompressed) {
  std::vector<std::int16_t> values(24);
  for (std::size_t i = 0; i < 24; ++i) values[i] = static_cast<std::int16_t>(i);
  for (const bool swap : {false, true})
    for (const bool compressed : {false, true}) {
      const std::string bytes = nifti_bytes(2, 3, 4, values, shear, swap),
                        path = temp(compressed ? "a.nii.gz" : "a.nii");
      if (compressed) {
        const gzFile file = gzopen(path.c_str(), "wb");
        gzwrite(file, bytes.data(), static_cast<unsigned>(bytes.size()));
        gzclose(file);
      } else {
        std::ofstream(path, std::ios::binary) << bytes;
      }
      const NiftiVolume v = read_nifti(path);
      EXPECT_EQ(v.size, (std::array<int, 3>{2, 3, 4}));
      // Voxel (1, 2, 3) is number 1 + 2 (2 + 3 * 3) = 23 and lies at (10 - 4, 3 - 5, 4.5 + 7).
      EXPECT_FLOAT_EQ(v.nearest({6, -2, 11.5}), 2 * 23 - 1);
      EXPECT_FLOAT_EQ(v.linear({6, -2, 11.5}), 2 * 23 - 1);
      // Half-way between k = 0 and k = 1 at i = j = 0: values 0 and 6.
      EXPECT_FLOAT_EQ(v.linear({10, -5, 7.75}), 2 * 3 - 1);
      EXPECT_FLOAT_EQ(v.nearest({100, 0, 0}), 0);
      EXPECT_FLOAT_EQ(v.linear({100, 0, 0}), 0);
    }
}

TEST(Nifti, RefusesWhatItCannotRead) {
  const std::vector<std::int16_t> values(24, 1);
  const std::string good = nifti_bytes(2, 3, 4, values, shear, false), path = temp("bad.nii");
  const auto message = [&](const std::string& bytes) {
    std::ofstream(path, std::ios::binary) << bytes;
    try {
      read_nifti(path);
    } catch (const std::runtime_error& e) {
      return std::string(e.what());
    }
    return std::string("nothing thrown");
  };
  EXPECT_EQ(message(good), "nothing thrown");
  EXPECT_NE(message(good.substr(0, 300)).find("too short"), std::string::npos);
  EXPECT_NE(message(good.substr(0, good.size() - 1)).find("truncated"), std::string::npos);
  std::string bad = good;
  bad[0] = 1;
  EXPECT_NE(message(bad).find("no NIfTI-1 file"), std::string::npos);
  bad = good;
  bad[344] = 'x';
  EXPECT_NE(message(bad).find("magic"), std::string::npos);
  bad = good;
  bad[70] = 32;  // complex
  EXPECT_NE(message(bad).find("unsupported data type 32"), std::string::npos);
  const float flat[12] = {1, 0, 0, 0, 0, 1, 0, 0, 1, 0, 0, 0};
  EXPECT_NE(message(nifti_bytes(2, 3, 4, values, flat, false)).find("inverted"), std::string::npos);
  EXPECT_THROW(read_nifti(temp("missing.nii")), std::runtime_error);
}

TEST(GridOps, DistanceIsExact) {
  Grid grid{{13, 9, 11}, {0, 0, 0}, 0.5};
  Mask set(grid.count(), 0);
  const int seeds[][3] = {{2, 3, 4}, {11, 7, 9}, {6, 0, 10}, {12, 8, 0}};
  for (const auto& s : seeds) set[grid.index(s[0], s[1], s[2])] = 1;
  const Field d = distance_to(grid, set);
  for (int k = 0; k < 11; ++k)
    for (int j = 0; j < 9; ++j)
      for (int i = 0; i < 13; ++i) {
        double best = 1e9;
        for (const auto& s : seeds) best = std::min(best, norm(grid.point(i, j, k) - grid.point(s[0], s[1], s[2])));
        EXPECT_NEAR(d[grid.index(i, j, k)], best, 1e-6);
      }
}

TEST(GridOps, ClosingFillsNarrowSlitsOnly) {
  Grid grid{{40, 20, 20}, {0, 0, 0}, 0.5};
  Mask mask(grid.count(), 1);
  for (int k = 0; k < 20; ++k)
    for (int j = 0; j < 20; ++j)
      for (int i = 0; i < 40; ++i) {
        if (i >= 8 && i < 10) mask[grid.index(i, j, k)] = 0;   // 1 mm wide
        if (i >= 20 && i < 32) mask[grid.index(i, j, k)] = 0;  // 6 mm wide
      }
  const Field level = closing_level(grid, mask, 1.0);
  EXPECT_GT(level[grid.index(8, 10, 10)], 0);
  EXPECT_LT(level[grid.index(25, 10, 10)], 0);
  EXPECT_GT(level[grid.index(15, 10, 10)], 0);
}

TEST(GridOps, GrowthAvoidsExpensiveTissue) {
  Grid grid{{30, 30, 3}, {0, 0, 0}, 1};
  std::vector<unsigned char> seeds(grid.count(), 0);
  Field cost(grid.count(), 1);
  seeds[grid.index(1, 15, 1)] = 1;
  seeds[grid.index(28, 15, 1)] = 2;
  for (int k = 0; k < 3; ++k)
    for (int j = 0; j < 30; ++j) cost[grid.index(20, j, k)] = 100;  // a wall nearer to the second seed
  const auto owner = grow(grid, seeds, cost);
  for (int j = 0; j < 30; ++j) {
    EXPECT_EQ(owner[grid.index(19, j, 1)], 1);
    EXPECT_EQ(owner[grid.index(21, j, 1)], 2);
  }
}

TEST(Dihedral, KnownTetrahedra) {
  const DihedralRange regular = dihedral_range({1, 1, 1}, {-1, 1, -1}, {1, -1, -1}, {-1, -1, 1});
  EXPECT_NEAR(regular.min_deg, std::acos(1.0 / 3) * 180 / std::numbers::pi, 1e-9);
  EXPECT_NEAR(regular.max_deg, regular.min_deg, 1e-9);
  const DihedralRange corner = dihedral_range({0, 0, 0}, {1, 0, 0}, {0, 1, 0}, {0, 0, 1});
  EXPECT_NEAR(corner.max_deg, 90, 1e-9);
  EXPECT_NEAR(corner.min_deg, std::acos(1 / std::sqrt(3.0)) * 180 / std::numbers::pi, 1e-9);
  EXPECT_LT(dihedral_range({0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}).min_deg, 0);  // inverted
}

// Two half balls of radius 10 mm about (5, 0, 0), labels 3 and 7, that touch in the plane z = 0.
NiftiVolume half_balls() {
  NiftiVolume v;
  v.size = {30, 30, 30};
  v.value.resize(27000);
  v.to_world = {1, 0, 0, -9.5, 0, 1, 0, -14.5, 0, 0, 1, -14.5};
  v.from_world = {1, 0, 0, 9.5, 0, 1, 0, 14.5, 0, 0, 1, 14.5};
  for (int k = 0; k < 30; ++k)
    for (int j = 0; j < 30; ++j)
      for (int i = 0; i < 30; ++i) {
        const double x = i - 14.5, y = j - 14.5, z = k - 14.5;
        if (x * x + y * y + z * z < 100) v.value[static_cast<std::size_t>(i + 30 * (j + 30 * k))] = z > 0 ? 3 : 7;
      }
  return v;
}

class HalfBalls : public testing::Test {
 protected:
  static PartFields fields() {
    FieldOptions options;
    options.gap = 1;
    options.coarse_closing = 0;
    options.coarse_smoothing = 0.5;
    options.seed_depth = 0.4;
    options.coarse_outset = 0.3;
    return build_part_fields(half_balls(), nullptr, {{"upper", {3}}, {"lower", {7}}}, options);
  }
};

TEST_F(HalfBalls, SurfacesAreClosedOutwardAndApart) {
  const PartFields f = fields();
  std::vector<TriangleMesh> meshes;
  for (std::size_t a = 0; a < 2; ++a) {
    meshes.push_back(mesh_surface(
        f.grid, f.fine[a], [](const Vec3&) { return 1.0; }, 0.05));
    EXPECT_TRUE(is_closed(meshes[a].triangles));
    // A half ball less half the gap under its flat face; edges are rounded by the smoothing.
    const double expected = std::numbers::pi * (2000.0 / 3 - 0.5 * 100);
    EXPECT_NEAR(signed_volume(meshes[a]), expected, 0.05 * expected);
  }
  const Clearance c = clearance(meshes[0], meshes[1]);
  EXPECT_FALSE(c.intersect);
  EXPECT_NEAR(c.distance, 1, 0.15);
}

TEST_F(HalfBalls, TetrahedraAreGoodApartAndHoldTheSurface) {
  const PartFields f = fields();
  std::vector<TetMesh> meshes;
  for (std::size_t a = 0; a < 2; ++a) {
    meshes.push_back(mesh_volume(
        f.grid, f.coarse[a], [](const Vec3&) { return 4.0; }, [](const Vec3&) { return 0.4; }));
    EXPECT_GE(improve_dihedral(meshes[a], 12, 0.5), 10);
    EXPECT_TRUE(is_closed(boundary_triangles(meshes[a])));
    EXPECT_NEAR(volume(meshes[a]), signed_volume(boundary_mesh(meshes[a])), 1e-6 * volume(meshes[a]));
    const TriangleMesh fine = mesh_surface(
        f.grid, f.fine[a], [](const Vec3&) { return 1.5; }, 0.1);
    reach_out(meshes[a], fine.points, 0.3, 10);
    EXPECT_LT(embedding(fine, meshes[a]).furthest, 0.8);
  }
  EXPECT_GE(separate_parts(meshes, 0.5, 20), 0.45);
  const Clearance c = clearance(boundary_mesh(meshes[0]), boundary_mesh(meshes[1]));
  EXPECT_FALSE(c.intersect);
  EXPECT_GE(c.distance, 0.4);
}

TEST_F(HalfBalls, OverlappingPartsAreSeenAndPushedApart) {
  const PartFields f = fields();
  std::vector<TetMesh> meshes;
  for (std::size_t a = 0; a < 2; ++a)
    meshes.push_back(mesh_volume(
        f.grid, f.coarse[a], [](const Vec3&) { return 3.0; }, [](const Vec3&) { return 0.3; }));
  for (Vec3& p : meshes[1].points) p[2] += 1.2;  // into the upper half
  EXPECT_TRUE(clearance(boundary_mesh(meshes[0]), boundary_mesh(meshes[1])).intersect);
  separate_parts(meshes, 0.3, 40);
  EXPECT_FALSE(clearance(boundary_mesh(meshes[0]), boundary_mesh(meshes[1])).intersect);
}

TEST_F(HalfBalls, ASinglePartNeedsNoSeparation) {
  const PartFields f = fields();
  std::vector<TetMesh> one{mesh_volume(
      f.grid, f.coarse[0], [](const Vec3&) { return 5.0; }, [](const Vec3&) { return 0.6; })};
  const std::vector<Vec3> before = one[0].points;
  EXPECT_GT(separate_parts(one, 0.5, 5), 1e6);
  EXPECT_TRUE(one[0].points == before);
}

TEST_F(HalfBalls, SameInputSameBytes) {
  std::string first;
  for (int run = 0; run < 2; ++run) {
    const PartFields f = fields();
    TetMesh tets = mesh_volume(
        f.grid, f.coarse[0], [](const Vec3&) { return 4.0; }, [](const Vec3&) { return 0.5; });
    improve_dihedral(tets, 12, 0.5);
    write_msh(temp("same.msh"), tets, MshFormat::v4_ascii);
    write_ply(temp("same.ply"), mesh_surface(
                                    f.grid, f.fine[1], [](const Vec3&) { return 2.0; }, 0.2));
    const std::string bytes = slurp(temp("same.msh")) + slurp(temp("same.ply"));
    if (run) {
      EXPECT_TRUE(bytes == first);
    }
    first = bytes;
  }
}

TEST_F(HalfBalls, CleftLiesBetweenTheHalves) {
  const PartFields f = fields();
  FieldOptions options;
  const Cleft cleft = describe_cleft(f, 0, 1, options, {1, 0, 0});
  ASSERT_GE(cleft.stations.size(), 3u);
  for (const CleftStation& s : cleft.stations) {
    EXPECT_NEAR(s.superficial[2], 0, 0.5);  // half a voxel of the volume
    EXPECT_NEAR(s.deep[2], 0, 0.5);
    EXPECT_LT(s.inward[0], -0.8);
  }
  EXPECT_NEAR(cleft.centre[1], 0, 0.6);
  EXPECT_GT(cleft.outward[0], 0.95);
}

TEST_F(HalfBalls, EmptyPartAndRegionAreRefused) {
  EXPECT_THROW(build_part_fields(half_balls(), nullptr, {{"none", {99}}}, {}), std::runtime_error);
  FieldOptions away;
  away.centre = {500, 0, 0};
  away.radius = 5;
  EXPECT_THROW(build_part_fields(half_balls(), nullptr, {{"upper", {3}}}, away), std::runtime_error);
}

TEST(MoreLabels, ReplaceOnlyWhereAPartHasThem) {
  NiftiVolume labels = half_balls(), more = labels;
  for (float& v : more.value) v = v == 3 ? 4.0f : v == 7 ? 5.0f : 0.0f;
  const NiftiVolume before = labels;
  add_labels(labels, more, {{"deep", {1004}}, {"lower", {7}}});
  std::size_t replaced = 0;
  for (std::size_t i = 0; i < labels.value.size(); ++i) {
    EXPECT_EQ(labels.value[i], before.value[i] == 3 ? 1004.0f : before.value[i]);
    replaced += labels.value[i] == 1004.0f;
  }
  EXPECT_GT(replaced, 100u);
}

}  // namespace
}  // namespace insula::mesh_tool
