// SPDX-License-Identifier: GPL-3.0-or-later
// Contracts for the elements of a shared plugin, in addition to its author's tests.
#include "core/testing/plugin_main.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <iostream>
#include <set>

#include "core/testing/contracts.h"
#include "core/testing/example.h"

namespace insula::test {
namespace {

void add(const std::string& name, const std::string& file, std::function<void()> check) {
  class Case : public ::testing::Test {
   public:
    explicit Case(std::function<void()> c) : check_(std::move(c)) {}
    void TestBody() override { check_(); }

   private:
    std::function<void()> check_;
  };
  ::testing::RegisterTest("Contract", name.c_str(), nullptr, nullptr, file.c_str(), 1,
                          [check = std::move(check)]() -> ::testing::Test* { return new Case(check); });
}

}  // namespace

int run_plugin_tests(int argc, char** argv, const char* library, const char* example) {
  ::testing::InitGoogleTest(&argc, argv);
  std::set<std::string> before;
  for (const ComponentInfo* info : builtin().all()) before.insert(info->element);
  if (const std::string error = add_plugin(library); !error.empty()) {
    std::cerr << "error: " << error << '\n';
    return 2;
  }
  const std::filesystem::path scene = example;
  int brought = 0;
  for (const ComponentInfo* info : builtin().all()) {
    if (before.contains(info->element)) continue;
    ++brought;
    add("OfElement_" + info->element, example, [=, element = info->element] { check_element(scene, element); });
  }
  if (brought == 0) {
    std::cerr << "error: " << library << " registers no element\n";
    return 2;
  }
  add("ExampleRunsAndStaysBounded", example, [=] { check_example(scene); });
  add("ExampleIsDeterministic", example, [=] { check_deterministic(scene); });
  add("StepsOfTheExampleAllocateNothing", example, [=] { check_allocations(scene); });
  add("ExampleSurfacesFollowTheirBodies", example, [=] { check_surfaces(scene); });
  return RUN_ALL_TESTS();
}

}  // namespace insula::test
