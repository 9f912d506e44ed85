// SPDX-License-Identifier: GPL-3.0-or-later
// Every plugin's elements against the contract of their kind, found through the registry; every plugin has an example
// scene and a test of its own.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>
#include <sstream>

#include "core/testing/contracts.h"
#include "core/testing/example.h"

namespace insula {
namespace {

namespace fs = std::filesystem;

const fs::path source = INSULA_SOURCE_DIR;
fs::path example_of(const std::string& plugin) { return source / "plugins" / plugin / "example.xml"; }

std::vector<std::string> plugins() {
  std::vector<std::string> out;
  for (const auto& entry : fs::directory_iterator(source / "plugins"))
    if (entry.is_directory() && fs::exists(entry.path() / (entry.path().filename().string() + ".cpp")))
      out.push_back(entry.path().filename().string());
  std::sort(out.begin(), out.end());
  return out;
}

std::vector<std::string> elements() {
  std::vector<std::string> out;
  for (const ComponentInfo* info : test::builtin().all())
    if (info->plugin != "core") out.push_back(info->element);
  return out;
}

class EveryPlugin : public ::testing::TestWithParam<std::string> {};
class EveryElement : public ::testing::TestWithParam<std::string> {};

TEST_P(EveryPlugin, HasAnExampleATestAndElements) {
  EXPECT_TRUE(fs::exists(example_of(GetParam()))) << "plugins/" << GetParam() << "/example.xml is missing";
  bool tested = false;
  for (const auto& f : fs::directory_iterator(source / "plugins" / GetParam())) {
    if (!f.path().filename().string().ends_with("_test.cpp")) continue;
    std::stringstream text;
    text << std::ifstream(f.path()).rdbuf();
    tested = tested || text.str().find("TEST") != std::string::npos;
  }
  EXPECT_TRUE(tested) << "plugins/" << GetParam() << "/" << GetParam() << "_test.cpp is missing or holds no test";
  int count = 0;
  for (const ComponentInfo* info : test::builtin().all()) count += info->plugin == GetParam();
  EXPECT_GT(count, 0) << "the plugin registers nothing";
}

TEST_P(EveryPlugin, ExampleRunsAndStaysBounded) { test::check_example(example_of(GetParam())); }
TEST_P(EveryPlugin, ExampleIsDeterministic) { test::check_deterministic(example_of(GetParam())); }
TEST_P(EveryPlugin, StepsOfTheExampleAllocateNothing) { test::check_allocations(example_of(GetParam())); }
TEST_P(EveryPlugin, ExampleSurfacesFollowTheirBodies) { test::check_surfaces(example_of(GetParam())); }

TEST_P(EveryElement, HoldsTheContractOfItsKind) {
  const ComponentInfo* info = test::builtin().find(GetParam());
  ASSERT_TRUE(info);
  test::check_element(example_of(info->plugin), GetParam());
}

std::string plain(const ::testing::TestParamInfo<std::string>& info) { return info.param; }
INSTANTIATE_TEST_SUITE_P(Plugins, EveryPlugin, ::testing::ValuesIn(plugins()), plain);
INSTANTIATE_TEST_SUITE_P(Elements, EveryElement, ::testing::ValuesIn(elements()), plain);

}  // namespace
}  // namespace insula
