// SPDX-License-Identifier: GPL-3.0-or-later
// The haptic server without its threads: receiving, ticks and publishing, each for a thread of its own.
#pragma once
#include <array>
#include <atomic>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "core/bus/arrival_order.h"
#include "core/bus/bus.h"
#include "core/bus/codec.h"
#include "core/haptics/haptic_update.h"
#include "haptic_server/clock.h"
#include "haptic_server/devices/make_device.h"
#include "haptic_server/devices/remark.h"
#include "haptic_server/force_output.h"
#include "haptic_server/hand_guide.h"
#include "haptic_server/passivity.h"
#include "haptic_server/safety_gate.h"
#include "haptic_server/sample_ring.h"
#include "haptic_server/scene_setup.h"
#include "haptic_server/servo.h"
#include "haptic_server/soft_guide.h"
#include "haptic_server/status.h"
#include "haptic_server/triple_buffer.h"

namespace insula {

struct ServerOptions {
  ServoSettings servo = ServoSettings::beyond_equation_7();
  double period_s = 1e-3;
  /// A motion in place of the scene's (empty motion: none).
  std::optional<Motion> motion;
  bool realtime = false;  ///< scheduling of the servo for HAPTIC_STATUS
  std::string advice;     ///< shown in HAPTIC_STATUS if there is nothing more urgent
};

/// Three threads work here without locks: `receive` in one, `tick` in the servo thread, `publish_*` in a third.
/// Messages: in HAPTIC_PROBLEM, SCENE_INFO, SIM_EVENT, SOFT_GUIDE, HAND_INPUT, USER_COMMAND; out DEVICE_STATE,
/// HAPTIC_STATUS.
///
/// A new engine (session), or a simulated time that goes back, puts simulated arms at the start of the motion or at
/// home, under control of the script. A server that joins a running scene starts its arms at the engine's tool poses
/// and moves to the motion from there.
class HapticServer {
 public:
  HapticServer(Bus& bus, std::array<DeviceChoice, 2> devices, const Clock& clock, ServerOptions options = {});

  /// Receiving thread: handles the messages that have arrived. Waits at most timeout_ms for a first one.
  int receive(int timeout_ms);

  /// Servo thread: one tick, due at `due_ns` of the clock; `missed` ticks were skipped before it.
  void tick(std::int64_t due_ns, std::int64_t missed = 0) noexcept;

  /// Publishing thread: the newest DEVICE_STATE, if there was a tick since the last one.
  bool publish_state();
  /// Publishing thread, once a second: HAPTIC_STATUS for the time since the last call.
  const insula_lcm::haptic_status_t& publish_status();
  /// Publishing thread, at least every 100 ms: collects the samples of the ticks.
  void collect();

  /// Any thread: from now on forces fade to zero and stay there.
  void begin_stop() { stopping_.store(true, std::memory_order_relaxed); }
  /// Any thread: the last forces sent were zero.
  bool quiet() const { return quiet_.load(std::memory_order_relaxed); }

  /// Servo thread, or any thread after its end.
  const Vec3& force(int hand) const { return hands_[std::size_t(hand)].gate.force(); }
  /// The part of it that a soft guide made.
  const Vec3& guided(int hand) const { return hands_[std::size_t(hand)].guided; }
  const DeviceReading& reading(int hand) const { return hands_[std::size_t(hand)].reading; }
  const ServoResult& last() const { return last_; }
  std::int64_t messages_refused() const { return refused_.load(std::memory_order_relaxed); }

  /// A message SERVO_TICKS has this many, so there are about twenty a second.
  static constexpr int ticks_of_message = 50;
  /// After this time without a session's SCENE_INFO, its arms start without it.
  static constexpr double setup_patience_s = 1.3;

 private:
  struct Received {
    HapticUpdate update;
    std::int64_t receive_ns = 0;
  };
  struct Wish {
    HandSample sample;
    bool released = false;  ///< the viewer has let the hand go
    std::int64_t count = 0;
  };
  struct Hand {
    explicit Hand(DeviceChoice choice);
    std::unique_ptr<Device> device;
    HandSource source;
    SafetyGate gate;
    ForceOutput force_output;
    Onset onset;
    PassivityObserver energy;
    int severed_seen = 0, shut_seen = 0;  ///< numbers of events that already had a transient of this hand
    HandGuide guide;
    DeviceReading reading;
    HandSample home;
    bool placed = false;
    bool to_be_laid = true;  ///< since the start of the session; a real arm keeps its frame until the new one is known
    std::int64_t wishes_seen = 0;
    Vec3 last_force = Vec3::Zero();
    SoftGuide soft_guide;
    Vec3 guided = Vec3::Zero();  ///< part of the last force that the guide made, N
  };
  struct Snapshot {
    std::int64_t time_ns = 0;
    std::int64_t receive_ns = 0;  ///< of the newest problem, 0: none
    std::array<DeviceReading, 2> reading;
    std::array<Vec3, 2> force{Vec3::Zero(), Vec3::Zero()}, torque{Vec3::Zero(), Vec3::Zero()};
    std::array<bool, 2> in_range{true, true};
    double force_scale = 1;
  };

  // Receiving thread.
  void on_problem(Bytes bytes);
  void on_scene(Bytes bytes);
  void on_input(Bytes bytes);
  void on_event(Bytes bytes);
  void on_guide(Bytes bytes);
  void on_command(Bytes bytes);
  void refuse(const std::string& channel, const std::string& why);
  // Servo thread.
  void take_problem(std::int64_t now) noexcept;
  void take_wishes() noexcept;
  void place_hands(std::int64_t now) noexcept;
  const Motion* motion() const noexcept;
  bool live(const ServoHand& hand, std::int64_t now) const noexcept;
  Vec3 force_output(std::size_t hand, double dt, bool alive) noexcept;
  Vec3 soft_guide(std::size_t hand, double dt, bool alive, std::int64_t now) noexcept;
  bool send_forces(double dt, std::int64_t now, TickSample& sample) noexcept;
  void leave_snapshot(std::int64_t now) noexcept;
  // Publishing thread.
  void add_tick(const TickSample& sample);
  std::string note(double age_ms) const;

  Bus& bus_;
  const Clock& clock_;
  ServerOptions options_;
  std::int64_t run_ = 0;

  // Receiving thread's own.
  ArrivalOrder order_;
  std::string setup_key_;
  std::array<Wish, 2> wishes_{};
  insula_lcm::scene_info_t scene_info_{};
  insula_lcm::hand_input_t hand_input_{};
  insula_lcm::sim_event_t event_{};
  insula_lcm::soft_guide_t guide_{};
  ArrivalOrder guide_order_;
  std::array<GuideWish, 2> guide_wishes_{};
  insula_lcm::user_command_t command_{};
  std::string why_;

  // Across threads.
  TripleBuffer<Received> problems_;
  TripleBuffer<std::array<Wish, 2>> inputs_;
  TripleBuffer<std::array<GuideWish, 2>> guides_;
  TripleBuffer<Snapshot> snapshots_;
  SampleRing<TickSample, 8192> samples_;
  SetupExchange setups_;
  std::atomic<std::int64_t> received_{0}, refused_{0}, missed_{0};
  std::atomic<bool> stopping_{false}, quiet_{true};
  /// Number of events of a hand's tool that have a transient.
  std::array<std::atomic<int>, 2> severed_{}, shut_{};
  Remark remark_;

  // Servo thread's own.
  Servo servo_;
  std::array<Hand, 2> hands_;
  const SceneSetup* setup_ = nullptr;
  MotionClock motion_clock_;
  ServoResult last_;
  std::int64_t session_ = 0, session_start_ns_ = 0, last_tick_ns_ = 0;
  double last_sim_time_ = 0;
  bool has_problem_ = false, fresh_start_ = false;

  // Publishing thread's own.
  StatusCollector collector_;
  insula_lcm::haptic_status_t status_{};
  insula_lcm::device_state_t state_{};
  insula_lcm::servo_ticks_t ticks_{};
  std::int64_t missed_now_ = 0;  ///< missed ticks since the last status
  std::int64_t status_start_ns_ = 0, status_sequence_ = 0, state_sequence_ = 0, ticks_sequence_ = 0;
  std::vector<std::uint8_t> scratch_;
};

}  // namespace insula
