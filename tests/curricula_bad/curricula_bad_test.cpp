// SPDX-License-Identifier: GPL-3.0-or-later
// Every curriculum of this folder is wrong (expected_messages.h). The scenes in scenes/ are small, so that a check is
// quick.
#include <gtest/gtest.h>

#include "tests/scenes_bad/expected_messages.h"

namespace insula {
namespace {
namespace fs = std::filesystem;

const fs::path folder = fs::path(INSULA_SOURCE_DIR) / "tests" / "curricula_bad";

class BadCurriculum : public testing::TestWithParam<std::string> {};

TEST_P(BadCurriculum, IsReportedAsExpected) { test::expect_reported(folder, GetParam()); }

INSTANTIATE_TEST_SUITE_P(Curricula, BadCurriculum, testing::ValuesIn(test::xml_names(folder)),
                         [](const auto& curriculum) { return curriculum.param; });

TEST(BadCurricula, ThereAreManyAndNoExpectationWithoutCurriculum) {
  EXPECT_GE(test::xml_names(folder).size(), 50u);
  test::expect_a_file_for_each_expectation(folder);
}

}  // namespace
}  // namespace insula
