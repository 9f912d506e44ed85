// SPDX-License-Identifier: GPL-3.0-or-later
// A stand-in for libspnav with its daemon: a deflected cap sends events all the time, a pressed button one, a device
// that comes or goes one, and a daemon that ends closes its socket.
#include <unistd.h>

#include <chrono>
#include <deque>
#include <mutex>
#include <thread>

#include "tests/devices/stub_board.h"

namespace {

using insula::testing::board;
using insula::testing::StubArm;

union Event {
  int type;
  struct {
    int type, x, y, z, rx, ry, rz;
    unsigned int period;
    int* data;
  } motion;
  struct {
    int type, press, bnum;
  } button;
  struct {
    int type, op, id, devtype, usbid[2];
  } dev;
};

std::mutex mutex;
std::deque<Event> events;
int pipe_ends[2] = {-1, -1};
std::thread daemon_thread;
std::atomic<bool> stop{false};

void send(const Event& e) {
  std::lock_guard lock(mutex);
  events.push_back(e);
  const char byte = 1;
  [[maybe_unused]] const auto n = ::write(pipe_ends[1], &byte, 1);
}

void run() {
  int plugged = board().arm[0].plugged, buttons = 0;
  bool deflected = false;
  while (!stop && board().daemon != 0) {
    const StubArm& a = board().arm[0];
    Event e{};
    if (a.plugged != plugged) {
      plugged = a.plugged;
      e.dev = {3, plugged != 0 ? 0 : 1, 0, 0, {0, 0}};
      send(e);
    }
    if (plugged != 0 && a.buttons != buttons) {
      for (int b = 0; b < 2; ++b)
        if (((a.buttons ^ buttons) >> b & 1) != 0) {
          e.button = {2, a.buttons >> b & 1, b};
          send(e);
        }
      buttons = a.buttons;
    }
    // p: translation, v: rotation, in counts.
    const bool now = a.p[0] != 0 || a.p[1] != 0 || a.p[2] != 0 || a.v[0] != 0 || a.v[1] != 0 || a.v[2] != 0;
    if (plugged != 0 && (now || deflected)) {
      e.motion = {1, int(a.p[0]), int(a.p[1]), int(a.p[2]), int(a.v[0]), int(a.v[1]), int(a.v[2]), 8, nullptr};
      send(e);
    }
    deflected = now;
    std::this_thread::sleep_for(std::chrono::milliseconds(5));
  }
  ::close(pipe_ends[1]);
  pipe_ends[1] = -1;
}

}  // namespace

extern "C" {

int spnav_open() {
  if (board().daemon == 0 || daemon_thread.joinable() || ::pipe(pipe_ends) != 0) return -1;
  stop = false;
  daemon_thread = std::thread(run);
  return 0;
}
int spnav_close() {
  if (!daemon_thread.joinable()) return -1;
  stop = true;
  daemon_thread.join();
  ::close(pipe_ends[0]);
  pipe_ends[0] = -1;
  events.clear();
  return 0;
}
int spnav_fd() { return pipe_ends[0]; }
int spnav_poll_event(Event* into) {
  std::lock_guard lock(mutex);
  if (events.empty()) return 0;
  char byte;
  [[maybe_unused]] const auto n = ::read(pipe_ends[0], &byte, 1);
  std::memcpy(into, &events.front(), sizeof(Event));
  events.pop_front();
  return into->type;
}
int spnav_dev_name(char* into, int size) {
  if (board().arm[0].plugged == 0) return -1;
  std::strncpy(into, board().arm[0].model, std::size_t(size));
  return int(std::strlen(board().arm[0].model));
}

}  // extern "C"
