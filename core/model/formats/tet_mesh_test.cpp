// SPDX-License-Identifier: GPL-3.0-or-later
// Tetrahedral meshes: the same mesh from every format, and what is refused.
#include <gtest/gtest.h>

#include <cstdint>
#include <cstring>
#include <fstream>
#include <iterator>
#include <limits>
#include <random>

#include "core/base/input_error.h"
#include "core/model/formats/mesh_files_for_test.h"
#include "core/model/formats/raw_tets.h"

namespace insula {
namespace {

using test_files::Format;

std::string mesh_error(const std::filesystem::path& file, double unit = 1) {
  try {
    read_tet_mesh(file, unit);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

std::string error_in(const std::string& name, const std::string& bytes) {
  try {
    tet_mesh_from_bytes(name, bytes, 1);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}

class EveryFormat : public testing::TestWithParam<Format> {
 protected:
  std::string error_with(const TetMesh& mesh) { return error_in(GetParam().file, GetParam().bytes(mesh)); }
  test_files::TempFolder folder_;
};

TEST_P(EveryFormat, GivesTheSameMesh) {
  const TetMesh mesh = test_files::box_mesh();
  const TetMesh read = read_tet_mesh(folder_.write(GetParam().file, GetParam().bytes(mesh)), 1e-3);
  ASSERT_EQ(read.nodes.size(), mesh.nodes.size());
  for (std::size_t i = 0; i < mesh.nodes.size(); ++i) EXPECT_EQ(read.nodes[i], Vec3(mesh.nodes[i] * 1e-3)) << i;
  EXPECT_EQ(read.tets, mesh.tets);
}

TEST_P(EveryFormat, RefusesEveryTruncation) {
  const std::string bytes = GetParam().bytes(test_files::box_mesh());
  std::size_t kept = bytes.size();
  while (kept > 0 && (bytes[kept - 1] == '\n' || bytes[kept - 1] == ' ')) --kept;
  for (std::size_t n = 0; n < kept; ++n) {
    const std::string error = error_in(GetParam().file, bytes.substr(0, n));
    ASSERT_NE(error, "") << "cut after " << n << " of " << bytes.size() << " bytes";
    ASSERT_NE(error.find(GetParam().file + ": "), std::string::npos) << error;
  }
}

TEST_P(EveryFormat, SurvivesDamage) {
  const std::string bytes = GetParam().bytes(test_files::box_mesh());
  std::mt19937 random(20);
  int refused = 0;
  for (int round = 0; round < 1000; ++round) {
    std::string damaged = bytes;
    for (int k = 0; k < 1 + round % 4; ++k) damaged[random() % damaged.size()] = char(random());
    if (round % 5 == 0) damaged.insert(random() % damaged.size(), bytes.substr(random() % bytes.size(), 9));
    try {
      const TetMesh mesh = tet_mesh_from_bytes(GetParam().file, damaged, 1);
      for (const auto& t : mesh.tets)
        for (int i : t) ASSERT_TRUE(i >= 0 && i < int(mesh.nodes.size()));
    } catch (const InputError&) {
      ++refused;
    }
  }
  EXPECT_GT(refused, 0);
}

TEST_P(EveryFormat, NamesAnInvertedTetrahedron) {
  TetMesh mesh = test_files::box_mesh();
  std::swap(mesh.tets[16][0], mesh.tets[16][1]);
  std::swap(mesh.tets[30][2], mesh.tets[30][3]);
  const std::string error = error_with(mesh);
  const std::string number = GetParam().file == "m.msh" ? "18" : GetParam().file == "m.mesh" ? "17" : "16";
  EXPECT_NE(error.find("tetrahedron " + number + " (and 1 more) is inverted"), std::string::npos) << error;
}

TEST_P(EveryFormat, NamesAFlatTetrahedron) {
  TetMesh mesh = test_files::box_mesh();
  mesh.tets[3][3] = mesh.tets[3][2];
  EXPECT_NE(error_with(mesh).find("is flat"), std::string::npos) << error_with(mesh);
}

TEST_P(EveryFormat, RefusesWhatIsNotFinite) {
  for (double bad : {std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()}) {
    TetMesh mesh = test_files::box_mesh();
    mesh.nodes[7].y() = bad;
    EXPECT_NE(error_with(mesh).find("is not finite"), std::string::npos) << error_with(mesh);
  }
}

TEST_P(EveryFormat, RefusesIndicesOutOfRange) {
  for (int bad : {1000000, -1000, 27}) {
    TetMesh mesh = test_files::box_mesh();
    mesh.tets[5][2] = bad;
    EXPECT_NE(error_with(mesh).find("names a node that does not exist"), std::string::npos) << error_with(mesh);
  }
}

TEST_P(EveryFormat, RefusesAMeshWithoutTetrahedra) {
  TetMesh mesh = test_files::box_mesh();
  mesh.tets.clear();
  EXPECT_NE(error_with(mesh), "");
}

INSTANTIATE_TEST_SUITE_P(Formats, EveryFormat, testing::ValuesIn(test_files::formats()),
                         [](const auto& one) { return one.param.name; });

TEST(TetMeshFile, RefusesOtherFiles) {
  const test_files::TempFolder folder;
  EXPECT_NE(mesh_error(folder.path() / "none.msh").find("no such file"), std::string::npos);
  EXPECT_NE(mesh_error(folder.path()).find("no known tetrahedral mesh"), std::string::npos);
  EXPECT_NE(mesh_error(folder.write("m.xyz", "x")).find("use .msh"), std::string::npos);
  EXPECT_NE(mesh_error(folder.write("m.msh", "")).find("is empty"), std::string::npos);
  std::filesystem::create_directory(folder.path() / "d.vtu");
  EXPECT_NE(mesh_error(folder.path() / "d.vtu").find("is not a file"), std::string::npos);
}

TEST(TetMeshFile, RefusesAnUnusableUnit) {
  const test_files::TempFolder folder;
  const auto format = test_files::formats()[0];
  const auto file = folder.write(format.file, format.bytes(test_files::box_mesh()));
  for (double unit : {0.0, -1.0, std::numeric_limits<double>::infinity(), std::numeric_limits<double>::quiet_NaN()})
    EXPECT_NE(mesh_error(file, unit).find("unit of length"), std::string::npos);
}

TEST(TetMeshFile, HostileCountsAllocateNothing) {
  const test_files::TempFolder folder;
  const std::string gmsh = "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n";
  EXPECT_NE(mesh_error(folder.write("a.msh", gmsh + "999999999999\n1 0 0 0\n")).find("ends early"), std::string::npos);
  EXPECT_NE(mesh_error(folder.write("b.msh", gmsh + "-3\n")).find("a count cannot be -3"), std::string::npos);
  const std::string vtk = "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\n";
  EXPECT_NE(mesh_error(folder.write("a.vtk", vtk + "POINTS 9000000000000000000 double\n0 0 0\n")).find("ends early"),
            std::string::npos);
  EXPECT_NE(
      mesh_error(folder.write("a.vtk", vtk + "FIELD f 1\nname 1000 9000000000000000000 int\n0\n")).find("ends early"),
      std::string::npos);
  EXPECT_NE(mesh_error(folder.write("a.mesh", "MeshVersionFormatted 1\nDimension 3\nVertices 88888888888\n1 1 1 0\n"))
                .find("ends early"),
            std::string::npos);
}

TEST(TetMeshFile, RefusesOtherVolumeElements) {
  const test_files::TempFolder folder;
  const std::string gmsh =
      "$MeshFormat\n2.2 0 8\n$EndMeshFormat\n$Nodes\n1\n1 0 0 0\n$EndNodes\n$Elements\n1\n1 5 0 1 1 1 1 1 1 1 "
      "1\n$EndElements\n";
  EXPECT_NE(mesh_error(folder.write("a.msh", gmsh)).find("only linear tetrahedra"), std::string::npos);
  const std::string medit =
      "MeshVersionFormatted 1\nDimension 3\nVertices 1\n1 1 1 0\nHexahedra 1\n1 1 1 1 1 1 1 1 0\nEnd\n";
  EXPECT_NE(mesh_error(folder.write("a.mesh", medit)).find("only tetrahedra"), std::string::npos);
  const std::string vtk =
      "# vtk DataFile Version 3.0\nx\nASCII\nDATASET UNSTRUCTURED_GRID\nPOINTS 1 float\n0 0 0\nCELLS 1 9\n8 0 0 0 0 0 "
      "0 0 0\nCELL_TYPES 1\n12\n";
  EXPECT_NE(mesh_error(folder.write("a.vtk", vtk)).find("only linear tetrahedra"), std::string::npos);
}

TEST(TetMeshFile, RefusesOldGmshAndHostileXml) {
  const test_files::TempFolder folder;
  EXPECT_NE(mesh_error(folder.write("a.msh", "$MeshFormat\n4 0 8\n$EndMeshFormat\n")).find("save it as 2.2 or 4.1"),
            std::string::npos);
  const std::string bomb =
      "<?xml version=\"1.0\"?><!DOCTYPE x [<!ENTITY a \"aaaa\">]><VTKFile type=\"UnstructuredGrid\">&a;</VTKFile>";
  EXPECT_NE(mesh_error(folder.write("a.vtu", bomb)).find("document type"), std::string::npos);
  std::string deep = "<VTKFile type=\"UnstructuredGrid\">";
  for (int i = 0; i < 100000; ++i) deep += "<a>";
  EXPECT_NE(mesh_error(folder.write("a.vtu", deep)).find("nested too deeply"), std::string::npos);
  EXPECT_NE(
      mesh_error(folder.write("a.vtu", "<VTKFile type=\"UnstructuredGrid\" compressor=\"vtkLZ4DataCompressor\"/>"))
          .find("compressor"),
      std::string::npos);
  EXPECT_NE(mesh_error(folder.write("a.vtu", "<VTKFile type=\"UnstructuredGrid\" byte_order=\"MiddleEndian\"/>"))
                .find("byte_order \"MiddleEndian\" is unknown"),
            std::string::npos);
  EXPECT_NE(mesh_error(folder.write("a.vtu", "<VTKFile type=\"UnstructuredGrid\" header_type=\"Float32\"/>"))
                .find("header_type \"Float32\" is unknown"),
            std::string::npos);
  std::string within =
      "<VTKFile type=\"UnstructuredGrid\"><Piece NumberOfPoints=\"1\" NumberOfCells=\"0\"><Points><DataArray "
      "NumberOfComponents=\"3\" type=\"Float64\">0 0 0";
  for (int i = 0; i < 9; ++i) within += "<Piece NumberOfPoints=\"1\" NumberOfCells=\"0\"/> 1 2 3";
  EXPECT_NE(mesh_error(folder.write("a.vtu", within + "</DataArray></Points></Piece></VTKFile>")).find("a.vtu"),
            std::string::npos);
}

TEST(WriteVtu, IsReadBackBitForBit) {
  const test_files::TempFolder folder;
  const TetMesh mesh = test_files::box_mesh();
  const auto file = folder.path() / "out.vtu";
  write_vtu(file, mesh.nodes, mesh.tets, std::vector<Vec3>(mesh.nodes.size(), Vec3(1, 2, 3)));
  const TetMesh read = read_tet_mesh(file, 1);
  EXPECT_EQ(read.nodes, mesh.nodes);
  EXPECT_EQ(read.tets, mesh.tets);
}

TEST(WriteVtu, OfASurfaceHasTrianglesAndKeepsEveryBit) {
  const test_files::TempFolder folder;
  const std::vector<Vec3> nodes{{0.1, 0, 0}, {1.0 / 3, 0, 0}, {0, 1, 0}, {0, 0, 1e-9}};
  const std::vector<std::array<int, 3>> triangles{{0, 1, 2}, {0, 2, 3}};
  const auto file = folder.path() / "shell.vtu";
  write_vtu(file, nodes, triangles, std::vector<Vec3>(4, Vec3(1, 2, 3)));
  std::ifstream in(file, std::ios::binary);
  const std::string text((std::istreambuf_iterator<char>(in)), {});
  EXPECT_NE(text.find("NumberOfPoints=\"4\" NumberOfCells=\"2\""), std::string::npos);
  // Appended arrays in order, each after its length: displacement, points, connectivity, offsets, types.
  std::size_t at = text.find("encoding=\"raw\">");
  ASSERT_NE(at, std::string::npos);
  at = text.find('_', at) + 1;
  const auto next = [&] {
    std::uint64_t n = 0;
    std::memcpy(&n, text.data() + at, sizeof n);
    const std::string bytes = text.substr(at + sizeof n, std::size_t(n));
    at += sizeof n + std::size_t(n);
    return bytes;
  };
  EXPECT_EQ(next().size(), 12 * sizeof(double));
  const std::string points = next();
  ASSERT_EQ(points.size(), 12 * sizeof(double));
  for (std::size_t i = 0; i < 4; ++i) EXPECT_EQ(std::memcmp(points.data() + 24 * i, nodes[i].data(), 24), 0);
  const std::string corners = next(), ends = next();
  ASSERT_EQ(corners.size(), 6 * sizeof(std::int64_t));
  for (std::size_t i = 0; i < 6; ++i) {
    std::int64_t v = 0;
    std::memcpy(&v, corners.data() + 8 * i, 8);
    EXPECT_EQ(v, triangles[i / 3][i % 3]);
  }
  std::int64_t end = 0;
  ASSERT_EQ(ends.size(), 16u);
  std::memcpy(&end, ends.data() + 8, 8);
  EXPECT_EQ(end, 6);
  EXPECT_EQ(next(), std::string(2, '\5'));  // VTK_TRIANGLE
  EXPECT_THROW(read_tet_mesh(file, 1), InputError);
}

TEST(WriteVtu, SaysWhenItCannot) {
  const test_files::TempFolder folder;
  const TetMesh mesh = test_files::box_mesh();
  EXPECT_THROW(write_vtu(folder.path() / "none" / "out.vtu", mesh.nodes, mesh.tets, {}), InputError);
  EXPECT_THROW(write_vtu(folder.path() / "out.vtu", mesh.nodes, mesh.tets, {Vec3::Zero()}), InputError);
}

}  // namespace
}  // namespace insula
