// SPDX-License-Identifier: GPL-3.0-or-later
// The devices that the stub libraries show as connected, in a file that the test and the stubs of all processes map
// into memory.
#pragma once
#include <fcntl.h>
#include <sys/mman.h>
#include <unistd.h>

#include <atomic>
#include <cstdlib>
#include <cstring>

namespace insula::testing {

/// One arm, in the frame and units of its library (mm for libHD, m for libdhd). Zeros are a valid state: not connected.
struct StubArm {
  char name[32];
  char model[32];
  std::atomic<int> plugged, serial, type, buttons, calibration_state;
  std::atomic<double> max_force, p[3], q[4], v[3];  // q: w x y z
  std::atomic<double> force[3], torque[3];          // what the driver sent last
  std::atomic<long> frames;                         // exchanges with the driver
  std::atomic<int> open;                            // opened and not closed
};

struct StubBoard {
  StubArm arm[4];
  std::atomic<int> daemon;  ///< of libspnav: running
};

inline StubBoard* map_board(const char* file) {
  const int f = ::open(file, O_RDWR | O_CREAT | O_CLOEXEC, 0600);
  if (f < 0 || ::ftruncate(f, sizeof(StubBoard)) != 0) return nullptr;
  void* memory = ::mmap(nullptr, sizeof(StubBoard), PROT_READ | PROT_WRITE, MAP_SHARED, f, 0);
  ::close(f);
  return memory == MAP_FAILED ? nullptr : static_cast<StubBoard*>(memory);
}

/// The board of this process, given by INSULA_STUB_BOARD, for the stubs.
inline StubBoard& board() {
  static StubBoard* const mapped = [] {
    const char* file = std::getenv("INSULA_STUB_BOARD");
    StubBoard* b = file != nullptr ? map_board(file) : nullptr;
    if (b == nullptr) std::abort();
    return b;
  }();
  return *mapped;
}

}  // namespace insula::testing
