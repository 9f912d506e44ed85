// SPDX-License-Identifier: GPL-3.0-or-later
// Part of the contract of rows: what a component states about its law against the rows that it builds.
#pragma once
#include <cstdint>

#include "core/testing/findings.h"
#include "core/testing/row_bench.h"

namespace insula::test {

/// Whether the rows keep things apart, by what the component states: then their direction may turn with an open gap.
bool is_unilateral(const Component& c, const RowData& row);

/// Moves the bodies along rows, through the place where the law begins to act, and compares the rows' force with the
/// stated law's. Bodies that a unilateral law holds apart are moved far apart: nothing may act then. The bodies are
/// brought back.
void check_stated_law(Findings& findings, Simulation& s, Component& c, std::uint64_t seed);

}  // namespace insula::test
