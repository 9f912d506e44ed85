// SPDX-License-Identifier: GPL-3.0-or-later
// The example scene of the manual's plugin against the contracts that every plugin's example is held to.
#include <gtest/gtest.h>

#include "core/testing/contracts.h"

namespace insula {
namespace {

TEST(ManualPlugin, HoldsTheContracts) {
  test::check_example(MANUAL_EXAMPLE);
  test::check_deterministic(MANUAL_EXAMPLE);
  test::check_rows(MANUAL_EXAMPLE, "tether", true);
}

}  // namespace
}  // namespace insula
