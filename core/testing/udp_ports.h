// SPDX-License-Identifier: GPL-3.0-or-later
// The machine's network as tests with real processes need it. The implementation belongs to the operating system
// (platform/).
#pragma once

namespace insula::testing {

/// A UDP port that was free a moment ago.
int free_udp_port();
/// Whether LCM's own library and tools have the multicast route that they need. As root, this adds a missing route.
bool lcm_tools_work();

}  // namespace insula::testing
