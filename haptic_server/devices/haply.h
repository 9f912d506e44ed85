// SPDX-License-Identifier: GPL-3.0-or-later
// Haply's Inverse3 through its local service.
#pragma once
#include <atomic>
#include <string>
#include <thread>

#include "haptic_server/devices/haply_messages.h"
#include "haptic_server/devices/streamed_device.h"

namespace insula {

class WebSocketClient;

/// Exchanges JSON over a WebSocket in its own thread. The service answers each force with the state of all arms and
/// grips. Haply frame: right-handed, x right, y away from the person, z up; metres.
class HaplyDevice final : public StreamedDevice {
 public:
  /// `which`: empty, the arm's id, or "arm+grip". Empty: the arm that is configured for this hand (0 left, 1 right),
  /// else the first for the left and the last for the right hand.
  HaplyDevice(const std::string& which, int hand, DeviceCalibration calibration = default_calibration());
  ~HaplyDevice() override;
  /// Waits for a missing service or arm in the background.
  void start() override;
  void stop() override;
  /// Number of messages of the service that could not be read.
  std::int64_t messages_refused() const { return messages_refused_.load(std::memory_order_relaxed); }

  static DeviceCalibration default_calibration();
  /// $INSULA_HAPLY_URL or ws://localhost:10001.
  static std::string url();

 private:
  void serve();
  void session(WebSocketClient& service);
  const HaplyArm* choose_arm(const HaplyState& state) const;
  const HaplyGrip* choose_grip(const HaplyState& state, const HaplyArm& arm) const;
  void deliver(const HaplyArm& arm, const HaplyGrip* grip);
  void say(const std::string& text);

  std::string arm_id_, grip_id_;
  int hand_;
  std::string title_;
  std::thread thread_;
  std::atomic<bool> stopping_{false};
  std::atomic<bool> tried_{false};
  std::atomic<std::int64_t> messages_refused_{0};
};

const char* how_to_get_haply();

}  // namespace insula
