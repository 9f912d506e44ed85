// SPDX-License-Identifier: GPL-3.0-or-later
// insula run --export: every deformable body, tetrahedra or wall, as a file of its own.
#include <gtest/gtest.h>
#include <unistd.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/model/mesh.h"
#include "core/testing/example.h"
#include "engine/command_line/run.h"

namespace insula {
namespace {
namespace fs = std::filesystem;

const fs::path source = INSULA_SOURCE_DIR;

class Export : public testing::Test {
 protected:
  void SetUp() override { folder_ = fs::path(testing::TempDir()) / ("insula_export_" + std::to_string(::getpid())); }
  void TearDown() override { fs::remove_all(folder_); }
  std::string run(const fs::path& scene) {
    RunOptions options;
    options.scene = scene;
    options.duration = 0.05;
    options.export_folder = folder_;
    options.threads = 1;
    options.quiet = true;
    std::ostringstream out, err;
    EXPECT_EQ(cmd_run({test::builtin(), out, err}, options), 0) << err.str();
    return err.str();
  }
  fs::path folder_;
};

TEST_F(Export, SoftBodiesAsTetrahedra) {
  EXPECT_EQ(run(source / "plugins/corotational_fem/example.xml"), "");
  auto s = test::load(source / "plugins/corotational_fem/example.xml");
  ASSERT_TRUE(s);
  int files = 0;
  for (const Body* b : s->bodies()) {
    const auto* soft = dynamic_cast<const SoftBody*>(b);
    if (!soft) continue;
    const TetMesh mesh = read_tet_mesh(folder_ / (b->id + ".vtu"), 1);
    EXPECT_EQ(mesh.nodes.size(), soft->rest().nodes.size());
    EXPECT_EQ(mesh.tets, soft->rest().tets);
    ++files;
  }
  EXPECT_GT(files, 0);
}

TEST_F(Export, ShellsAsTriangles) {
  EXPECT_EQ(run(source / "plugins/membrane/example.xml"), "");
  auto s = test::load(source / "plugins/membrane/example.xml");
  ASSERT_TRUE(s);
  const auto* tube = dynamic_cast<const ShellBody*>(s->scene().find("tube"));
  ASSERT_TRUE(tube);
  std::ifstream in(folder_ / "tube.vtu", std::ios::binary);
  std::stringstream text;
  text << in.rdbuf();
  const std::string wanted = "NumberOfPoints=\"" + std::to_string(tube->nodes()) + "\" NumberOfCells=\"" +
                             std::to_string(tube->rest().triangles.size()) + "\"";
  EXPECT_NE(text.str().find(wanted), std::string::npos);
}

}  // namespace
}  // namespace insula
