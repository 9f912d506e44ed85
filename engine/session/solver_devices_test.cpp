// SPDX-License-Identifier: GPL-3.0-or-later
// A recording says on what each body was solved. A rerun takes the same device, or says that it is not there.
#include "engine/session/solver_devices.h"

#include <gtest/gtest.h>

#include <cstdlib>

#include "core/linalg/opencl_solver.h"
#include "core/testing/block_mesh.h"
#include "core/testing/example.h"
#include "engine/session/rerun.h"
#include "engine/session/session_recorder.h"

namespace insula {
namespace {

namespace fs = std::filesystem;

class SolverDevices : public testing::Test {
 protected:
  void TearDown() override { only("", false); }

  /// Leaves only devices whose name contains the text.
  static void only(const char* text, bool set = true) {
    if (set) ::setenv("INSULA_OPENCL_DEVICE", text, 1);
    else ::unsetenv("INSULA_OPENCL_DEVICE");
  }

  /// Records two seconds of a block that swings from a start out of balance.
  void record(const std::string& solver) {
    folder_.write("block.msh",
                  test::gmsh_text(test::block_mesh({4, 4, 3}, Vec3(-0.01, -0.01, -0.01), Vec3(0.01, 0.01, 0))));
    folder_.write("scene.xml", R"(<scene title="Block" time_step="20 ms" gravity="0.5 0 -2 m/s2">
<soft_body id="block" mesh="block.msh" mesh_unit="m" solver=")" +
                                   solver +
                                   R"("><corotational_fem young="3 kPa" density="1 g/cm3"/>
<fixed region="beyond" centre="0 0 -9.9 mm" normal="0 0 -1"/><surface id="skin"/></soft_body></scene>)");
    const auto simulation = test::load(folder_.path() / "scene.xml");
    ASSERT_TRUE(simulation);
    SessionRecorder recorder(file(), *simulation, {folder_.path() / "scene.xml", "", "headless"});
    for (int k = 0; k < 100; ++k) {
      simulation->step();
      recorder.step(*simulation);
    }
    recorder.close(*simulation);
  }
  RerunResult again(double tolerance = 1e-3) const {
    SessionReader session(file());
    return rerun(session, test::builtin(), {.tolerance = tolerance});
  }
  std::string recorded() const { return SessionReader(file()).about("solver.block"); }
  fs::path file() const { return folder_.path() / "run.insula"; }

  test::SceneFolder folder_;
};

TEST_F(SolverDevices, TheSameDeviceGivesTheRecordedBits) {
  if (opencl_devices().empty()) GTEST_SKIP() << "there is no OpenCL device";
  record("opencl");
  EXPECT_EQ(recorded(), opencl_devices().front());
  const RerunResult r = again();
  EXPECT_TRUE(r.good()) << r.broken;
  EXPECT_TRUE(r.same_instructions);
  EXPECT_TRUE(r.missing_devices.empty());
  EXPECT_GE(r.compared, 2);
}

TEST_F(SolverDevices, WithoutTheDeviceValuesAreComparedInPlaceOfBits) {
  if (opencl_devices().empty()) GTEST_SKIP() << "there is no OpenCL device";
  record("opencl");
  const std::string device = recorded();
  only("no such device");
  const RerunResult r = again(1e-9);
  EXPECT_EQ(r.missing_devices, (std::vector<std::string>{"block: " + device}));
  EXPECT_FALSE(r.same_instructions);
  EXPECT_TRUE(r.good()) << r.broken << ' ' << r.largest_change;
  EXPECT_GE(r.compared, 2);
}

// A device that came later, or is faster on this day, does not change a recorded choice.
TEST_F(SolverDevices, ARecordedChoiceOfTheProcessorIsKept) {
  only("no such device");
  record("faster");
  EXPECT_EQ(recorded(), "processor");
  only("", false);
  const RerunResult r = again();
  EXPECT_TRUE(r.good()) << r.broken;
  EXPECT_TRUE(r.same_instructions);
}

TEST_F(SolverDevices, OtherSolversAreNotNamed) {
  record("direct");
  EXPECT_EQ(recorded(), "");
  EXPECT_TRUE(session::repeat_solvers({{"title", "Block"}}).edits.empty());
}

}  // namespace
}  // namespace insula
