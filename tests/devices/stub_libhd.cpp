// SPDX-License-Identifier: GPL-3.0-or-later
// A stand-in for OpenHaptics' libHD.so: the functions that the driver uses, with the library's habits (a stack of
// errors, frames, one scheduler for all devices, forces above the limit refused).
#include <array>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <mutex>
#include <thread>
#include <vector>

#include "tests/devices/stub_board.h"

namespace {

using insula::testing::board;
using insula::testing::StubArm;

struct Error {
  unsigned int code;
  int internal_code;
  unsigned int device;
};
struct Job {
  unsigned long id;
  unsigned int (*callback)(void*);
  void* data;
};

constexpr unsigned int none = 0xFFFFFFFF;
std::mutex mutex;  // of errors and jobs
std::vector<Error> errors;
std::vector<Job> jobs;
std::atomic<bool> running{false};
std::thread scheduler;
unsigned long last_id = 0;
thread_local unsigned int current = none;
thread_local bool in_frame = false;
std::array<double, 3> pending[4];
std::atomic<bool> output[4];

void fail(unsigned int code) {
  std::lock_guard lock(mutex);
  errors.push_back({code, 0, current});
}

StubArm* arm() { return current < 4 ? &board().arm[current] : nullptr; }

void run() {
  while (running) {
    std::vector<Job> now;
    {
      std::lock_guard lock(mutex);
      now = jobs;
    }
    for (const Job& job : now) {
      if (job.callback(job.data) != 0) continue;
      std::lock_guard lock(mutex);
      std::erase_if(jobs, [&](const Job& j) { return j.id == job.id; });
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(1));
  }
}

}  // namespace

extern "C" {

unsigned int hdInitDevice(const char* name) {
  for (unsigned int i = 0; i < 4; ++i) {
    StubArm& a = board().arm[i];
    if (name != nullptr && std::strcmp(name, a.name) != 0) continue;
    current = i;
    if (a.plugged == 0) break;
    if (a.open.exchange(1) != 0) {
      fail(0x0301);
      return none;
    }
    output[i] = false;
    return i;
  }
  fail(0x0302);
  return none;
}
void hdDisableDevice(unsigned int handle) {
  if (handle < 4) board().arm[handle].open = 0;
}
void hdMakeCurrentDevice(unsigned int handle) { current = handle; }
void hdBeginFrame(unsigned int handle) {
  if (in_frame) fail(0x0400);
  in_frame = true;
  current = handle;
  if (arm() != nullptr) pending[current] = {0, 0, 0};
}
void hdEndFrame(unsigned int handle) {
  if (!in_frame || handle != current) fail(0x0401);
  in_frame = false;
  StubArm* a = arm();
  if (a == nullptr) return;
  a->frames++;
  if (a->plugged == 0) {
    for (auto& f : a->force) f = 0;
    fail(0x0302);
    return;
  }
  const auto& f = pending[current];
  const bool allowed = std::sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]) <= a->max_force * 1.0001;
  if (!allowed) fail(0x0201);
  for (std::size_t i = 0; i < 3; ++i) a->force[i] = allowed && output[current] ? f[i] : 0;
}
void hdGetIntegerv(unsigned int what, int* into) {
  if (what == 0x2000 && arm() != nullptr) *into = arm()->buttons;
  else if (what == 0x2555) *into = 1 << 2;
  else fail(0x0100);
}
void hdGetDoublev(unsigned int what, double* into) {
  StubArm* a = arm();
  if (a == nullptr) return fail(0x0104);
  if (what == 0x2051) {
    for (int i = 0; i < 3; ++i) into[i] = a->v[i];
  } else if (what == 0x2052) {
    if (!in_frame) fail(0x0402);
    const double w = a->q[0], x = a->q[1], y = a->q[2], z = a->q[3];
    const double rows[3][3] = {{1 - 2 * (y * y + z * z), 2 * (x * y - z * w), 2 * (x * z + y * w)},
                               {2 * (x * y + z * w), 1 - 2 * (x * x + z * z), 2 * (y * z - x * w)},
                               {2 * (x * z - y * w), 2 * (y * z + x * w), 1 - 2 * (x * x + y * y)}};
    for (int c = 0; c < 3; ++c) {
      for (int r = 0; r < 3; ++r) into[4 * c + r] = rows[r][c];
      into[4 * c + 3] = 0;
      into[12 + c] = a->p[c];
    }
    into[15] = 1;
  } else if (what == 0x2603) {
    *into = a->max_force;
  } else if (what == 0x2551) {
    const double box[6] = {-80, -60, -35, 80, 60, 35};
    std::memcpy(into, box, sizeof box);
  } else {
    fail(0x0100);
  }
}
const char* hdGetString(unsigned int what) {
  static thread_local char serial[16];
  if (arm() == nullptr) return nullptr;
  if (what == 0x2501) return arm()->model;
  if (what != 0x2504) return nullptr;
  std::snprintf(serial, sizeof serial, "%d", arm()->serial.load());
  return serial;
}
void hdSetDoublev(unsigned int what, const double* from) {
  if (what == 0x2700 && in_frame && arm() != nullptr) pending[current] = {from[0], from[1], from[2]};
  else fail(0x0102);
}
void hdEnable(unsigned int what) {
  if (what == 0x4000 && current < 4) output[current] = true;
}
Error hdGetError() {
  std::lock_guard lock(mutex);
  if (errors.empty()) return {0, 0, none};
  const Error e = errors.back();
  errors.pop_back();
  return e;
}
const char* hdGetErrorString(unsigned int code) { return code == 0x0302 ? "HD_COMM_ERROR" : "HD_OTHER_ERROR"; }
unsigned int hdCheckCalibration() {
  return arm() != nullptr && arm()->calibration_state != 0 ? unsigned(arm()->calibration_state.load()) : 0x5000u;
}
void hdUpdateCalibration(unsigned int) {
  if (arm() != nullptr) arm()->calibration_state = 0x5000;
}
void hdStartScheduler() {
  if (!running.exchange(true)) scheduler = std::thread(run);
}
void hdStopScheduler() {
  if (running.exchange(false)) scheduler.join();
}
unsigned long hdScheduleAsynchronous(unsigned int (*callback)(void*), void* data, unsigned short) {
  std::lock_guard lock(mutex);
  jobs.push_back({++last_id, callback, data});
  return last_id;
}
void hdUnschedule(unsigned long id) {
  std::lock_guard lock(mutex);
  std::erase_if(jobs, [&](const Job& j) { return j.id == id; });
}

}  // extern "C"
