// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/cell_surface.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>

#include "core/base/input_error.h"
#include "tools/case_builder/intake.h"
#include "tools/case_builder/shapes_for_test.h"
#include "tools/case_builder/surface_input.h"
#ifdef INSULA_WITH_HDF5
#define H5_USE_110_API
#include <hdf5.h>
#endif

namespace insula::case_builder {
namespace {

using insula::test::SceneFolder;

double volume_of(const TetMesh& m) {
  double sum = 0;
  for (const auto& t : m.tets) {
    const auto at = [&](int k) -> const Vec3& { return m.nodes[std::size_t(t[std::size_t(k)])]; };
    sum += std::abs((at(1) - at(0)).cross(at(2) - at(0)).dot(at(3) - at(0))) / 6;
  }
  return sum;
}

/// A closed surface around the volume, looking outwards.
void expect_around(const TriMesh& surface, const TetMesh& m) {
  EXPECT_TRUE(border_loops(surface).empty());
  EXPECT_NEAR(signed_volume(surface), volume_of(m), 1e-6 * volume_of(m));
  EXPECT_LT(surface.vertices.size(), m.nodes.size()) << "inner points are left out";
}

/// The top of the sac, which has steps, is flat too.
void expect_both_ends(const fs::path& file) {
  Progress quiet;
  const Intake in = take_in(file, {}, quiet);
  EXPECT_EQ(std::count_if(in.surface.caps.begin(), in.surface.caps.end(),
                          [](const artery::CapPlane& c) { return std::abs(c.centre.x()) > 7.9; }),
            2);
}

std::string refusal(const fs::path& file) {
  try {
    read_any_surface(file, 1);
  } catch (const InputError& e) {
    return e.what();
  }
  return {};
}

TEST(CellSurface, OfEveryLinearCellLooksOutwards) {
  const std::vector<Vec3> cube{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0, 0, 1}, {1, 0, 1}, {1, 1, 1}, {0, 1, 1}};
  const std::vector<Vec3> wedge{{0, 0, 0}, {0, 1, 0}, {1, 0, 0}, {0, 0, 1}, {0, 1, 1}, {1, 0, 1}};
  const std::vector<Vec3> pyramid{{0, 0, 0}, {1, 0, 0}, {1, 1, 0}, {0, 1, 0}, {0.5, 0.5, 1}};
  for (const auto& [points, volume] : {std::pair{cube, 1.0}, {wedge, 0.5}, {pyramid, 1.0 / 3}}) {
    CellSurface cells("a.vtu", points);
    const std::int64_t corners[] = {0, 1, 2, 3, 4, 5, 6, 7};
    cells.add_volume(corners, int(points.size()));
    const TriMesh m = cells.surface();
    EXPECT_TRUE(border_loops(m).empty()) << points.size();
    EXPECT_NEAR(signed_volume(m), volume, 1e-12) << points.size();
  }
}

TEST(CellSurface, OfAVtuVolumeIsAVesselWithItsEnds) {
  SceneFolder folder;
  const TetMesh m = test::filled_tube();
  folder.write("mesh.vtu", test::vtu_text(m, {{0, 1, 2}}));  // with a face on its own, as VMTK adds them
  expect_around(read_any_surface(folder.path() / "mesh.vtu", 1), m);
  expect_both_ends(folder.path() / "mesh.vtu");
}

TEST(CellSurface, OfAVtuWithFacesAloneIsTheseFaces) {
  SceneFolder folder;
  const TriMesh tube = test::tube_with_sac();
  folder.write("wall.vtu", test::vtu_text({tube.vertices, {}}, tube.triangles));
  const TriMesh read = read_any_surface(folder.path() / "wall.vtu", 1);
  EXPECT_EQ(read.triangles.size(), tube.triangles.size());
  EXPECT_NEAR(signed_volume(read), signed_volume(tube), 1e-4);
}

TEST(CellSurface, BadVtuIsRefused) {
  SceneFolder folder;
  const std::string good = test::vtu_text(test::filled_tube(0.8));
  const auto says = [&](const std::string& text) {
    folder.write("a.vtu", text);
    return refusal(folder.path() / "a.vtu");
  };
  EXPECT_NE(says(good.substr(0, good.size() / 2)).find("ends early"), std::string::npos);
  std::string other = good;
  other.replace(other.find(">10 ") + 1, 2, "11");
  EXPECT_NE(says(other).find("VTK type 11 is not read"), std::string::npos) << says(other);
  TetMesh m = test::filled_tube(0.8);
  m.tets[5][2] = 100'000;
  EXPECT_NE(says(test::vtu_text(m)).find("names point -1"), std::string::npos) << says(test::vtu_text(m));
  m = test::filled_tube(0.8);
  m.tets.push_back(m.tets[0]), m.tets.push_back(m.tets[0]);
  EXPECT_NE(says(test::vtu_text(m)).find("a face between 3 cells"), std::string::npos);
}

#ifdef INSULA_WITH_HDF5

/// A mesh as DOLFIN writes it. `as`: name of the points. external: its points lie in another file.
void write_h5(const fs::path& file, const TetMesh& m, const std::string& group, const char* as, bool external = false) {
  const hid_t f = H5Fcreate(file.c_str(), H5F_ACC_TRUNC, H5P_DEFAULT, H5P_DEFAULT);
  const hid_t links = H5Pcreate(H5P_LINK_CREATE), made = H5Pcreate(H5P_DATASET_CREATE);
  H5Pset_create_intermediate_group(links, 1);
  if (external) H5Pset_external(made, "/etc/hostname", 0, H5F_UNLIMITED);
  const auto put = [&](const std::string& name, hsize_t rows, hsize_t columns, hid_t type, const void* values,
                       hid_t how) {
    const hsize_t size[] = {rows, columns};
    const hid_t space = H5Screate_simple(2, size, nullptr);
    const hid_t set = H5Dcreate2(f, (group + "/" + name).c_str(), type, space, links, how, H5P_DEFAULT);
    if (!external || how == H5P_DEFAULT) H5Dwrite(set, type, H5S_ALL, H5S_ALL, H5P_DEFAULT, values);
    H5Dclose(set), H5Sclose(space);
  };
  std::vector<std::uint64_t> cells;
  for (const auto& t : m.tets) cells.insert(cells.end(), t.begin(), t.end());
  put(as, m.nodes.size(), 3, H5T_NATIVE_DOUBLE, m.nodes.data(), external ? made : H5P_DEFAULT);
  put("topology", m.tets.size(), 4, H5T_NATIVE_UINT64, cells.data(), H5P_DEFAULT);
  H5Pclose(links), H5Pclose(made), H5Fclose(f);
}

TEST(CellSurface, OfAnHdf5MeshIsAVesselWithItsEnds) {
  SceneFolder folder;
  const TetMesh m = test::filled_tube();
  const fs::path file = folder.path() / "mesh.h5";
  for (const auto& [group, points] :
       {std::pair{"mesh", "coordinates"}, {"Mesh", "coordinates"}, {"Mesh/0/mesh", "geometry"}}) {
    write_h5(file, m, group, points);
    expect_around(read_any_surface(file, 1), m);
  }
  expect_both_ends(file);
}

TEST(CellSurface, BadHdf5IsRefused) {
  SceneFolder folder;
  const fs::path file = folder.path() / "mesh.h5";
  folder.write("mesh.h5", "\x89HDF\r\n\x1a\n and then nothing");
  EXPECT_NE(refusal(file).find("is no HDF5 file"), std::string::npos) << refusal(file);
  TetMesh m = test::filled_tube(0.8);
  write_h5(file, m, "results", "velocity");
  EXPECT_NE(refusal(file).find("holds no mesh"), std::string::npos) << refusal(file);
  write_h5(file, m, "mesh", "coordinates", true);
  EXPECT_NE(refusal(file).find("lies in another file"), std::string::npos) << refusal(file);
  m.nodes[7].y() = std::nan("");
  write_h5(file, m, "mesh", "coordinates");
  EXPECT_NE(refusal(file).find("point 7 is not finite"), std::string::npos) << refusal(file);
  m = test::filled_tube(0.8), m.tets[3][0] = 1 << 30;
  write_h5(file, m, "mesh", "coordinates");
  EXPECT_NE(refusal(file).find("names point 1073741824"), std::string::npos) << refusal(file);
  m = test::filled_tube(0.8);
  write_h5(file, m, "mesh", "coordinates");
  fs::resize_file(file, fs::file_size(file) / 2);
  EXPECT_NE(refusal(file), "");
}

#endif

}  // namespace
}  // namespace insula::case_builder
