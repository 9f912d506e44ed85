// SPDX-License-Identifier: GPL-3.0-or-later
// Each mistake is caught by the contracts of its kind, in one line that says what is wrong; what has none passes them
// all.
#include <gtest/gtest-spi.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <ostream>
#include <string>
#include <vector>

#include "core/testing/block_mesh.h"
#include "core/testing/contracts.h"
#include "core/testing/example.h"
#include "tests/contracts/mistakes.h"

namespace insula {
namespace {

struct Case {
  const char* element;
  const char* line;  ///< part of the line that is expected; empty: no failure at all
};

void PrintTo(const Case& c, std::ostream* out) { *out << c.element; }

const Case cases[] = {
    {"thread", ""},
    {"thread_reeled", ""},
    {"thread_wrong_sign", "broken law: row = derivative of its violation"},
    {"thread_wrong_lever_arm", "broken law: row = derivative of its violation"},
    {"thread_missing_body", "broken law: row = derivative of its violation"},
    {"thread_unstable_ids", "row ids change although nothing moves"},
    {"thread_foreign_ids", "the id of a row is not made by row_id(*this, key)"},
    {"thread_rows_twice", "two of its rows have one id"},
    {"thread_force_twice", "its rows' force is not that of its stated law"},
    {"thread_pointer_order", "its memory in another order) has other rows"},
    {"thread_load_order", "a second run (loaded after the first"},
    {"thread_forgets_reset", "after reset() its rows are not those of the start"},
    {"thread_state_not_in_hash", "its rows change with something that append_state() does not tell"},
    {"thread_not_finite", "a row is not made of finite numbers"},
    {"thread_bounds_swapped", "bounds are swapped: lower is above upper"},
    {"thread_negative_compliance", "compliance of a row is negative, expected 0 or more"},
    {"thread_length_off", "as if the violation were off by 1 mm"},
    {"thread_pushes", "its rows push where its stated law pulls"},
    {"thread_no_bound", "its rows push where its stated law has no force"},
    {"thread_stale_direction", "broken law: row = derivative of its violation"},
    {"thread_allocates", "a step allocates memory, expected none"},
    {"thread_not_reproducible", "a second run"},
    {"thread_wrong_rate", "a row moves by itself at another rate than it declares with moves()"},
    {"thread_stiffness_inverse", "its rows' force is not that of its stated law"},
    {"thread_adds_free_motion", "its rows' force is not that of its stated law"},
    {"thread_no_law", "adds rows with bounds or compliance and states no law"},
    {"thread_says_no_rows", "adds rows, but adds_rows() says it does not"},
    {"ball", ""},
    {"ball_with_friction", ""},
    {"ball_stale_direction", "broken law: row = derivative of its violation"},
    {"ball_stale_direction_far", "a gap opens when a body moves along its row to close it"},
    {"ball_negative_friction", "friction coefficient is negative"},
    {"ball_attracts", "its stated law only pushes"},
    {"ball_pulls", "its stated law only pushes"},
    {"ball_wrong_sign", "a gap opens when a body moves along its row to close it"},
    {"ball_wrong_side", "its rows push things apart that are 10 m apart already"},
    {"springs", ""},
    {"springs_wrong_energy", "broken law: force = minus energy gradient"},
    {"springs_wrong_stiffness", "broken law: exact stiffness = force gradient"},
    {"springs_say_internal", "broken law: forces add up to nothing"},
    {"springs_forget_damping", "broken law: the step's tangent has the promised damping"},
    {"springs_forget_reset", "reset() does not undo what finish() changed"},
    {"springs_state_not_in_hash", "its law changes with something that append_state() does not tell"},
    {"springs_not_finite", "its force is not finite"},
    {"springs_allocate", "a step allocates memory, expected none"},
    {"springs_soften", "the step's tangent has a negative eigenvalue"},
    {"springs_wrong_stress", "broken law: stress times volume = virial of the forces"},
    {"hold", ""},
    {"hold_nothing", "it holds nothing"},
    {"hold_lets_go", "it lets go what another support holds"},
    {"keep", ""},
    {"keep_everything", "it excludes no node of its support"},
    {"keep_more", "it adds a node that its support does not select"},
    {"rule", ""},
    {"rule_one_id", "two goals or faults have one id"},
    {"rule_forgets_reset", "after reset() the same run is judged otherwise"},
    {"rule_writes", "the exercise changes the simulation's state"},
    {"metric", ""},
    {"metric_forgets_reset", "reset() leaves something of the run"},
    {"metric_changes_by_evaluation", "evaluate() twice gives other values"},
    {"metric_one_id", "two metrics have one id"},
    {"probe", ""},
    {"probe_busy", "its activity is not within 0 and 1"},
    {"probe_follows_badly", "it does not come to rest at the hand"},
    {"probe_forgets_reset", "reset() does not lead back to the start"},
    {"probe_weak_law", "its rows' force is not that of its stated law"},
};

/// A block of tissue under a tool, and the element where its kind stands.
std::string scene_with(const std::string& element) {
  const auto is = [&](const char* prefix) { return element.starts_with(prefix); };
  const std::string one = "<" + element + "/>", joins = "<" + element + R"( surface="skin" tool="tool"/>)";
  return R"(<scene>
  <soft_body id="block" mesh="meshes/block.msh" mesh_unit="m"><corotational_fem/>)" +
         (is("hold") ? one
                     : R"(<fixed region="beyond" centre="0 0 -9 mm" normal="0 0 -1">)" + (is("keep") ? one : "") +
                           "</fixed>") +
         (is("springs") ? one : "") +
         R"(<surface id="skin"/></soft_body>
  <)" + (is("probe") ? element : std::string("retractor")) +
         R"( id="tool" model="meshes/tool/tool.urdf" hand="right" home=")" +
         (is("thread") || is("ball") || is("probe") ? "3 1 6 mm" : "3 1 3 mm") + R"(" shaft="0 0 1" flat="1 0 0"/>)" +
         (is("thread") || is("ball") ? joins : std::string()) +
         (is("rule") || is("metric") || is("springs") || is("hold") ? R"(<contact between="block tool"/>)" : "") +
         (is("rule") || is("metric") ? "<exercise title=\"wait\">" + one + "</exercise>" : "") + "</scene>";
}

/// Texts of the failures in all contracts that a plugin's test runs.
std::vector<std::string> failures(const std::filesystem::path& scene, const std::string& element) {
  ::testing::TestPartResultArray results;
  {
    ::testing::ScopedFakeTestPartResultReporter reporter(
        ::testing::ScopedFakeTestPartResultReporter::INTERCEPT_ONLY_CURRENT_THREAD, &results);
    test::check_element(scene, element);
    test::check_deterministic(scene);
    test::check_allocations(scene);
  }
  std::vector<std::string> out;
  for (int i = 0; i < results.size(); ++i) {
    std::string text = results.GetTestPartResult(i).message();
    if (text.starts_with("Failed\n")) text.erase(0, 7);
    while (!text.empty() && text.back() == '\n') text.pop_back();
    out.push_back(text);
  }
  return out;
}

class Mistakes : public ::testing::TestWithParam<Case> {};

TEST_P(Mistakes, AreCaughtInOneLine) {
  [[maybe_unused]] static const bool added = [] {
    for (const auto add : {mistakes::add_threads, mistakes::add_balls, mistakes::add_springs, mistakes::add_others})
      test::add_elements(add);
    return true;
  }();
  test::SceneFolder folder;
  folder.write("meshes/block.msh",
               test::gmsh_text(test::block_mesh({3, 3, 2}, Vec3(-0.01, -0.01, -0.01), Vec3(0.01, 0.01, 0))));
  folder.write("meshes/tool/tool.urdf", test::test_tool_urdf(1e-3));
  folder.write("meshes/tool/tool.json", test::test_tool_json(0, 0));
  folder.write("scene.xml", scene_with(GetParam().element));
  const std::vector<std::string> lines = failures(folder.path() / "scene.xml", GetParam().element);
  std::string all;
  for (const std::string& line : lines) {
    EXPECT_EQ(line.find('\n'), std::string::npos) << "not one line: " << line;
    all += line + "\n";
  }
  const std::string expected = GetParam().line;
  if (expected.empty()) {
    EXPECT_EQ(all, "");
  } else {
    EXPECT_NE(all.find(expected), std::string::npos) << "expected: " << expected << "\nfound:\n" << all;
  }
  if (!lines.empty()) RecordProperty("first", lines.front());
}

std::string name(const ::testing::TestParamInfo<Case>& info) { return info.param.element; }
INSTANTIATE_TEST_SUITE_P(Contracts, Mistakes, ::testing::ValuesIn(cases), name);

}  // namespace
}  // namespace insula
