// SPDX-License-Identifier: GPL-3.0-or-later
// Laws that hold to a tolerance. The result is kept as a property of the running test (gtest's --gtest_output=json), so
// that the manual's figures can show it beside the tolerance.
#pragma once
#include <gtest/gtest.h>

#include <algorithm>
#include <cstdio>
#include <cstdlib>
#include <string>

namespace insula::test {

/// Whether error <= tolerance * size. The largest error / size of the test under this law is kept with the tolerance.
inline ::testing::AssertionResult held(const std::string& law, double error, double size, double tolerance) {
  const double found = error == 0 ? 0 : error / size;
  double most = found;
  const ::testing::TestResult& result = *::testing::UnitTest::GetInstance()->current_test_info()->result();
  for (int i = 0; i < result.test_property_count(); ++i)
    if (result.GetTestProperty(i).key() == law)
      most = std::max(most, std::strtod(result.GetTestProperty(i).value(), nullptr));
  char kept[64];
  std::snprintf(kept, sizeof kept, "%.3g of %g", most, tolerance);
  ::testing::Test::RecordProperty(law, kept);
  if (found <= tolerance) return ::testing::AssertionSuccess();
  return ::testing::AssertionFailure() << law << ": off by " << found << ", allowed " << tolerance << " (of " << size
                                       << ")";
}

}  // namespace insula::test
