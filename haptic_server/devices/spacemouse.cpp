// SPDX-License-Identifier: GPL-3.0-or-later
// Receives the daemon's events.
#include "haptic_server/devices/spacemouse.h"

#include <poll.h>
#include <spdlog/spdlog.h>

#include <chrono>
#include <mutex>

#include "core/base/input_error.h"

namespace insula {
namespace {

using namespace std::chrono_literals;

constexpr double full_counts = 350;
/// A deflected cap sends events all the time. After this silence its last event is dropped.
constexpr double silence_s = 0.5;
constexpr unsigned int motion_button_device = 0x01 | 0x02 | 0x04;  // SPNAV_EVMASK_MOTION, _BUTTON, _DEV

}  // namespace

spnav::Api::Api() : library("INSULA_LIBSPNAV", {"libspnav.so.0", "libspnav.so"}) {
  library.find(open, "spnav_open");
  library.find(close, "spnav_close");
  library.find(descriptor, "spnav_fd");
  library.find(poll_event, "spnav_poll_event");
  library.find(event_mask, "spnav_evmask", false);
  library.find(device_name, "spnav_dev_name", false);
}

std::shared_ptr<spnav::Api> spnav::Api::shared() { return shared_while_used<Api>(); }

const char* spnav::how_to_get() { return "sudo apt install spacenavd libspnav0"; }

SpaceMouseDevice::SpaceMouseDevice(int hand, const DeviceCalibration& calibration)
    : RateDevice("spacemouse", hand, calibration) {}

SpaceMouseDevice::~SpaceMouseDevice() { stop(); }

void SpaceMouseDevice::start() {
  if (thread_.joinable()) return;
  api_ = spnav::Api::shared();
  if (!api_->library.loaded()) throw InputError("spacemouse: " + api_->library.error() + "; " + spnav::how_to_get());
  if (api_->in_use.exchange(true))
    throw InputError(
        "spacemouse: one hand only; the daemon merges all that are plugged in, so two cannot be told apart");
  mine_ = true;
  stopping_ = false;
  thread_ = std::thread([this] { serve(); });
}

void SpaceMouseDevice::stop() {
  stopping_ = true;
  if (thread_.joinable()) thread_.join();
  if (mine_) api_->in_use = false;
  mine_ = false;
}

bool SpaceMouseDevice::take(const spnav::Event& e) {
  if (e.type == spnav::motion) {
    // libspnav: x right, y up, z away from the person, which is left-handed; rotations about the same axes.
    const auto& m = e.motion;
    sample_.v = Vec3(m.x, m.z, m.y) / full_counts;
    sample_.w = Vec3(m.rx, m.rz, m.ry) / full_counts;
    moved_ns_ = MonotonicClock().now_ns();
    device_there_ = true;
  } else if (e.type == spnav::button) {
    if (e.button.number == 0) sample_.button1 = e.button.press != 0;
    if (e.button.number == 1) sample_.button2 = e.button.press != 0;
  } else if (e.type == spnav::device) {
    device_there_ = e.device.operation != spnav::device_removed;
    sample_ = RateSample{};
  }
  return device_there_;
}

bool SpaceMouseDevice::listen() {
  pollfd p{api_->descriptor(), POLLIN, 0};
  if (p.fd < 0) return false;
  const int ready = ::poll(&p, 1, 10);
  if (ready < 0 || (p.revents & (POLLERR | POLLNVAL)) != 0) return false;
  spnav::Event event;
  bool any = false;
  for (int i = 0; i < 256 && api_->poll_event(&event) != 0; ++i) {
    any = true;
    take(event);
  }
  // Readable without data: the daemon has ended.
  if (ready > 0 && !any) return false;
  if (double(MonotonicClock().now_ns() - moved_ns_) * 1e-9 > silence_s) sample_.v = sample_.w = Vec3::Zero();
  if (device_there_) deliver(sample_);
  else lost();
  return true;
}

void SpaceMouseDevice::serve() {
  while (!stopping_) {
    if (!open_) {
      open_ = api_->open() != -1;
      if (open_) {
        if (api_->event_mask != nullptr) api_->event_mask(motion_button_device);
        sample_ = RateSample{};
        device_there_ = true;
        set_remark("");
        continue;
      }
      if (remark().empty()) {
        set_remark(std::string("spacemouse: the daemon spacenavd does not answer; start it (sudo systemctl start "
                               "spacenavd) or get it: ") +
                   spnav::how_to_get());
        spdlog::warn("{}", remark());
      }
      for (auto waited = 0ms; waited < reopen_after && !stopping_; waited += 20ms) std::this_thread::sleep_for(20ms);
      continue;
    }
    if (!listen()) {
      lost();
      api_->close();
      open_ = false;
    }
  }
  if (open_) api_->close();
  open_ = false;
  lost();
}

}  // namespace insula
