// SPDX-License-Identifier: GPL-3.0-or-later
// Force models that couple nodes without declaring it, or nodes of another body, are errors of the scene.
#include <gtest/gtest.h>

#include "core/mechanics/soft_body.h"
#include "core/registry/registry.h"
#include "core/sim/simulation.h"
#include "core/testing/block_mesh.h"
#include "core/testing/example.h"

namespace insula {
namespace {

/// A spring between two nodes.
class Pair final : public ForceModel {
 public:
  Param<int> first{this, {.name = "first", .fallback = "0", .min = "-100", .max = "1000", .doc = "node"}};
  Param<int> second{this, {.name = "second", .fallback = "1", .min = "-100", .max = "1000", .doc = "node"}};
  Param<bool> declared{this, {.name = "declared", .fallback = "true", .doc = "whether couplings() tells"}};
  Param<bool> by_block{
      this, {.name = "by_block", .fallback = "false", .doc = "whether bind() asks for the blocks by these numbers"}};

  void couplings(std::vector<std::pair<int, int>>& pairs, Tangent) const override {
    if (declared()) pairs.emplace_back(first(), second());
  }
  void bind(const BlockMatrix& a, const std::vector<int>& free_of_node) override {
    const int i = by_block() ? first() : free_of_node[std::size_t(first())],
              j = by_block() ? second() : free_of_node[std::size_t(second())];
    a.slot(std::max(i, j), std::min(i, j));
  }
  void linearise(const double*, double*, BlockMatrix*, double, Tangent) override {}
  double energy(const double*) override { return 0; }
};

std::string messages(const std::string& pair) {
  Registry registry;
  register_builtin(registry);
  registry.add<Pair>("pair", Kind::force_model, "a spring between two nodes");
  test::SceneFolder folder;
  folder.write("meshes/bar.msh", test::gmsh_text(test::block_mesh({4, 1, 1}, Vec3::Zero(), Vec3(0.04, 0.01, 0.01))));
  return load_simulation_text(R"(<scene><soft_body id="bar" mesh="meshes/bar.msh" mesh_unit="m"><corotational_fem/>)" +
                                  pair + "</soft_body></scene>",
                              folder.path() / "bar.xml", registry, 1)
      .diagnostics.format();
}

TEST(ForceCouplings, WhatIsDeclaredIsTaken) { EXPECT_EQ(messages(R"(<pair first="0" second="19"/>)"), ""); }

TEST(ForceCouplings, WhatIsNotDeclaredIsAnError) {
  const std::string said = messages(R"(<pair first="0" second="19" declared="false"/>)");
  EXPECT_NE(said.find("couples the nodes 0 and 19 of \"bar\" without declaring it in couplings()"), std::string::npos)
      << said;
}

TEST(ForceCouplings, NodesThatTheBodyDoesNotHaveAreAnError) {
  for (const char* node : {"20", "-1", "999"}) {
    const std::string said = messages(std::string(R"(<pair first="0" by_block="true" second=")") + node + "\"/>");
    EXPECT_NE(said.find(std::string("couples node ") + node + " of \"bar\", which has the nodes 0 to 19"),
              std::string::npos)
        << said;
  }
  const std::string said = messages(R"(<pair first="0" second="400" declared="false" by_block="true"/>)");
  EXPECT_NE(said.find("asks for a block (400, 0) of the matrix of \"bar\", which has 20 free nodes"), std::string::npos)
      << said;
}

}  // namespace
}  // namespace insula
