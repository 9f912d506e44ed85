// SPDX-License-Identifier: GPL-3.0-or-later
// A separate bus for a test with real processes.
#pragma once
#include <string>

#include "core/bus/lcm_bus.h"
#include "core/testing/udp_ports.h"

namespace insula::testing {

inline std::string own_bus_url() { return "udpm://239.255.76.67:" + std::to_string(free_udp_port()) + "?ttl=0"; }

/// Whether messages of the bus return on this machine.
inline bool multicast_works() {
  LcmBus bus(own_bus_url());
  int seen = 0;
  bus.subscribe("PROBE", [&](Bytes) { ++seen; });
  for (int i = 0; i < 50 && bus.good() && seen == 0; ++i) {
    const std::uint8_t byte = 1;
    bus.publish("PROBE", Bytes(&byte, 1));
    bus.poll(20);
  }
  return seen > 0;
}

}  // namespace insula::testing
