// SPDX-License-Identifier: GPL-3.0-or-later
// Part of the contract of rows: compares the law that a component states with the rows that it builds.
#pragma once
#include <cstdint>

#include "core/testing/findings.h"
#include "core/testing/row_bench.h"

namespace insula::test {

/// Whether the component states a unilateral law. The direction of its rows may then change with an open gap.
bool is_unilateral(const Component& c, const RowData& row);

/// Moves the bodies along rows, through the point where the law begins to act, and compares the rows' force with that
/// of the stated law. Bodies with a unilateral law are also moved far apart, where no force may act. The bodies then
/// return.
void check_stated_law(Findings& findings, Simulation& s, Component& c, std::uint64_t seed);

}  // namespace insula::test
