// SPDX-License-Identifier: GPL-3.0-or-later
// Scenes whose bodies are solved on an OpenCL device, and on machines without one; lobes of the exercises on it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cstdlib>

#include "core/linalg/direct_solver.h"
#include "core/linalg/opencl_solver.h"
#include "core/mechanics/deformable_body.h"
#include "core/scene/loader.h"
#include "core/testing/block_mesh.h"
#include "core/testing/example.h"
#include "core/testing/held.h"

namespace insula {
namespace {

/// For its lifetime only devices whose name contains the text are there.
class OnlyDevices {
 public:
  explicit OnlyDevices(const char* text) {
    if (const char* before = std::getenv(name)) before_ = before;
    ::setenv(name, text, 1);
  }
  ~OnlyDevices() {
    if (before_.empty()) ::unsetenv(name);
    else ::setenv(name, before_.c_str(), 1);
  }
  OnlyDevices(const OnlyDevices&) = delete;
  OnlyDevices& operator=(const OnlyDevices&) = delete;

 private:
  static constexpr const char* name = "INSULA_OPENCL_DEVICE";
  std::string before_;
};

/// A block of tissue on a fixed floor.
std::string block(const std::string& solver) {
  return fmt::format(R"(<scene time_step="10 ms">
<soft_body id="tissue" mesh="block.msh" mesh_unit="m" solver="{}"><corotational_fem young="3 kPa" density="1 g/cm3"/>
<fixed region="beyond" centre="0 0 -9.9 mm" normal="0 0 -1"/><surface id="skin"/></soft_body></scene>)",
                     solver);
}

LoadResult read(const test::SceneFolder& folder, const std::string& solver) {
  folder.write("block.msh",
               test::gmsh_text(test::block_mesh({6, 6, 4}, Vec3(-0.01, -0.01, -0.01), Vec3(0.01, 0.01, 0))));
  return load_scene_text(block(solver), folder.path() / "scene.xml", test::builtin());
}

/// Displacements after some steps under a load, m.
VecX fallen(const std::string& solver, std::string* device = nullptr) {
  const test::SceneFolder folder;
  LoadResult read_scene = read(folder, solver);
  if (!read_scene.scene) return {};
  Simulation simulation(std::move(read_scene.scene), read_scene.diagnostics, 1);
  EXPECT_TRUE(read_scene.diagnostics.ok()) << read_scene.diagnostics.format();
  auto* body = simulation.scene().all<DeformableBody>().front();
  body->external = VecX::LinSpaced(body->external.size(), -1e-3, 2e-3);
  const VecX rest = body->q();
  for (int k = 0; k < 20; ++k) simulation.step();
  if (device) *device = device_of(*body->solver());
  return body->q() - rest;
}

TEST(OpenclScene, MovesAsOnTheProcessor) {
  if (opencl_devices().empty()) GTEST_SKIP() << "there is no OpenCL device";
  std::string device;
  const VecX there = fallen("opencl", &device), here = fallen("direct");
  EXPECT_EQ(device, opencl_devices().front());
  ASSERT_EQ(there.size(), here.size());
  EXPECT_TRUE(
      test::held("a scene on a device = on the processor, m", (there - here).lpNorm<Eigen::Infinity>(), 1, 1e-12));
  EXPECT_GT(here.lpNorm<Eigen::Infinity>(), 1e-4) << "nothing moved";
}

TEST(OpenclScene, TheSameDeviceGivesTheSameBits) {
  if (opencl_devices().empty()) GTEST_SKIP() << "there is no OpenCL device";
  EXPECT_EQ(fallen("opencl"), fallen("opencl"));
}

TEST(OpenclScene, WithoutADeviceTheRequestIsAnErrorAndTheFasterIsTheProcessor) {
  const OnlyDevices none("no such device");
  EXPECT_TRUE(opencl_devices().empty());
  EXPECT_THROW(make_opencl_solver(), NoDevice);
  std::string device = "none";
  EXPECT_EQ(fallen("faster", &device), fallen("direct"));
  EXPECT_EQ(device, "");
  const test::SceneFolder folder;
  LoadResult read_scene = read(folder, "opencl");
  ASSERT_TRUE(read_scene.scene);
  const Simulation simulation(std::move(read_scene.scene), read_scene.diagnostics, 1);
  EXPECT_FALSE(read_scene.diagnostics.ok());
  EXPECT_NE(read_scene.diagnostics.format().find("OpenCL"), std::string::npos) << read_scene.diagnostics.format();
}

// The matrices and rows of an exercise: both lobes with their strands.
TEST(OpenclScene, LobesOfAnExerciseAgreeWithTheProcessor) {
  if (opencl_devices().empty()) GTEST_SKIP() << "there is no OpenCL device";
  const auto simulation =
      test::load(std::filesystem::path(INSULA_SOURCE_DIR) / "scenes/training/1_sylvian_fissure.xml");
  ASSERT_TRUE(simulation);
  simulation->step();
  int rows = 0;
  for (const DeformableBody* body : simulation->scene().all<DeformableBody>()) {
    const BlockMatrix& a = body->system();
    const int m = body->rows.count();
    if (a.nodes() == 0 || m == 0) continue;
    rows += m;
    MatX w[2];
    VecX x[2];
    for (int k = 0; k < 2; ++k) {
      const auto solver = k == 0 ? make_opencl_solver() : make_direct_solver(false);
      solver->analyse(a);
      ASSERT_TRUE(solver->factorise(a));
      BodyRows own = body->rows;
      for (int r = 0; r < m; ++r) own.row[std::size_t(r)] = r;
      solver->compute_compliance(own, body->free_of_node());
      w[k] = MatX::Zero(m, m);
      solver->add_compliance(own, w[k].data(), m);
      x[k] = VecX::LinSpaced(3 * a.nodes(), -1, 2);
      solver->solve(x[k].data());
      EXPECT_FALSE(device_lost(*solver));
    }
    EXPECT_TRUE(test::held("W of a lobe on a device", (w[0] - w[1]).lpNorm<Eigen::Infinity>(),
                           w[1].lpNorm<Eigen::Infinity>(), 1e-10))
        << body->id;
    EXPECT_TRUE(test::held("a solve of a lobe on a device", (x[0] - x[1]).lpNorm<Eigen::Infinity>(),
                           x[1].lpNorm<Eigen::Infinity>(), 1e-10))
        << body->id;
  }
  EXPECT_GT(rows, 20);
}

}  // namespace
}  // namespace insula
