// SPDX-License-Identifier: GPL-3.0-or-later
// Every fault of the campaign: what happens, what the manual promises, and what the test requires. The table in
// docs/haptics-and-safety.md is this one, word for word.
#pragma once
#include <cmath>
#include <string_view>

#include "core/haptics/haptic_update.h"
#include "tests/faults/fault_rig.h"

namespace insula::testing {

/// In all cases, forces and torques are finite and within the device's limit and slew at every tick. A second after the
/// end of the cause they are those of a run without the fault.
struct FaultCase {
  const char* name;
  const char* cause;
  const char* promise;
  LinkFaults link{};  ///< in both directions, while the fault lasts
  void (*set)(FaultRig&, bool on) = nullptr;
  double lasts_s = 0.6;
  double zero_after_s = -1;  ///< forces exactly 0 from so long after its begin to its end; negative: not promised
  double min_share = 0;      ///< of the undisturbed force, on average while it lasts; 1: the same to the last bit
  bool one_hand = false;     ///< the left hand's alone: the right hand's stays what it is
};

inline void PrintTo(const FaultCase& fault, std::ostream* out) { *out << fault.cause; }

/// 50 ms until a problem is too old, 50 ms of fade-out, and the tick that detects it.
inline constexpr double untrusted_s = 0.102;
inline constexpr const char* to_zero = "0 within 102 ms";
/// Only the gate's fade-out.
inline constexpr double ramp_s = 0.052;

namespace fault {

template <auto change>
void spoil(FaultRig& rig, bool on) {
  rig.engine().spoil = on ? std::function<void(HapticUpdate&)>(change) : nullptr;
}
template <auto change>
void damage(FaultRig& rig, bool on) {
  rig.engine().damage = on ? std::function<void(Buffer&)>(change) : nullptr;
}
template <DeviceError error>
void device(FaultRig& rig, bool on) {
  rig.device[0]->error = on ? error : DeviceError::none;
}
inline void engine_stall(FaultRig& rig, bool on) { rig.engine().stalled = on; }
inline void servo_stall(FaultRig& rig, bool on) { rig.servo_stalled = on; }
template <int off_s>
void stamps(FaultRig& rig, bool on) {
  rig.engine().stamp_off_us = on ? off_s * 1'000'000LL : 0;
}
template <int by_s>
void clock_jump(FaultRig& rig, bool on) {
  if (on) rig.clock.advance_ns(by_s * 1'000'000'000LL);
}
inline void clock_back(FaultRig& rig, bool on) {
  clock_jump<-10>(rig, on);
  engine_stall(rig, on);
}
inline void sequence_back(FaultRig& rig, bool on) { rig.engine().sequence += on ? -1000 : 1000; }
inline void sequence_ahead(FaultRig& rig, bool on) {
  // Only one message. The engine then continues its numbers.
  if (!on) return;
  rig.engine().spoil = [&rig](HapticUpdate& u) {
    u.sequence += 1'000'000'000'000;
    rig.engine().spoil = nullptr;
  };
}
inline void second_engine(FaultRig& rig, bool on) {
  if (on) rig.start_engine();
  else rig.engines.pop_back();
}
inline void replayed(FaultRig& rig, bool on) {
  // Messages of an older engine, 300 a second, in the running session.
  static constexpr auto again = [](FaultRig& r) {
    HapticUpdate u;
    Buffer bytes;
    u.session = FaultRig::first_session - 1;
    u.time_us = r.clock.now_ns() / 1000 - 3'600'000'000;
    u.step_s = 1.0 / 60;
    for (int k = 0; k < 3; ++k) {
      u.sequence = std::int64_t(r.trace.size()) * 3 + k;
      if (encode_problem(u, bytes)) r.engine().link.publish(channel::haptic_problem, bytes);
    }
  };
  rig.each_millisecond = on ? std::function<void(FaultRig&)>(again) : nullptr;
}

inline void nan_w(HapticUpdate& u) { u.problem.w[0] = std::nan(""); }
inline void nan_everywhere(HapticUpdate& u) {
  const double nan = std::nan("");
  switch (u.sequence % 6) {
    case 0: u.problem.delta_free[3] = nan; break;
    case 1: u.problem.lambda[1] = nan; break;
    case 2: u.problem.tools[0].jacobian(2, 2) = nan; break;
    case 3: u.problem.tools[1].stiffness(4, 4) = nan; break;
    case 4: u.problem.tools[0].device.q.x() = nan; break;
    default: u.sim_time_s = nan;
  }
}
template <int times>
void scale_w(HapticUpdate& u) {
  for (double& w : u.problem.w) w *= times;
}
inline void indefinite(HapticUpdate& u) {
  ConstraintProblem& p = u.problem;
  for (int i = 0; i < p.rows; ++i)
    for (int j = 0; j < p.rows; ++j)
      if (i != j) p.w[std::size_t(i) * std::size_t(p.stride) + std::size_t(j)] *= 20;
}
inline void lopsided(HapticUpdate& u) {
  u.problem.tools[0].compliance(0, 4) += 1;
  u.problem.tools[1].stiffness(1, 2) -= 900;
}
inline void very_stiff(HapticUpdate& u) {
  for (ToolTerms& t : u.problem.tools) t.stiffness *= 1e5;
}
inline void wrong_size(Buffer& b) {
  static int turn = 0;
  switch (turn++ % 4) {
    case 0: b.resize(b.size() / 2); break;
    case 1: b.insert(b.end(), 8, 0); break;
    case 2: b[59] += 1; break;  // rows
    default: b.clear(); break;
  }
  seal_problem(b);
}

}  // namespace fault

inline constexpr FaultCase fault_cases[] = {
    {.name = "loss",
     .cause = "20 % of all messages are lost, in both directions",
     .promise = "the force continues: at least 80 % on average",
     .link = {.lose = 0.2},
     .lasts_s = 2,
     .min_share = 0.8},
    {.name = "reordering",
     .cause = "each message is 0 to 40 ms late, so that messages overtake one another",
     .promise = "an older message after a newer one is ignored; at least 80 %",
     .link = {.late_most_s = 0.04},
     .lasts_s = 2,
     .min_share = 0.8},
    {.name = "duplicates",
     .cause = "every second message arrives twice",
     .promise = "no bit of the forces differs",
     .link = {.duplicate = 0.5},
     .lasts_s = 1,
     .min_share = 1},
    {.name = "delay",
     .cause = "each message is 0 to 200 ms late",
     .promise = "a force while a message is younger than 50 ms, else a ramp to 0",
     .link = {.late_most_s = 0.2},
     .lasts_s = 2},
    {.name = "delay_200ms",
     .cause = "every message is 200 ms late",
     .promise = to_zero,
     .link = {.late_least_s = 0.2, .late_most_s = 0.2},
     .zero_after_s = untrusted_s},
    {.name = "bit_flips",
     .cause = "one to eight bits are flipped in 20 % of all messages",
     .promise = "the checksum refuses them; at least 80 %",
     .link = {.flip = 0.2},
     .lasts_s = 2,
     .min_share = 0.8},
    {.name = "bit_flips_in_all",
     .cause = "one to eight bits are flipped in every message",
     .promise = to_zero,
     .link = {.flip = 1},
     .zero_after_s = untrusted_s},
    {.name = "engine_stall_50ms",
     .cause = "the engine stands still for 50 ms",
     .promise = "the force continues: at least 80 %",
     .set = fault::engine_stall,
     .lasts_s = 0.05,
     .min_share = 0.8},
    {.name = "engine_stall_200ms",
     .cause = "the engine stands still for 200 ms",
     .promise = to_zero,
     .set = fault::engine_stall,
     .lasts_s = 0.2,
     .zero_after_s = untrusted_s},
    {.name = "engine_stall_500ms",
     .cause = "the engine stands still for 500 ms",
     .promise = to_zero,
     .set = fault::engine_stall,
     .lasts_s = 0.5,
     .zero_after_s = untrusted_s},
    {.name = "link_stall_500ms",
     .cause = "nothing passes for 500 ms, then all of it at once",
     .promise = to_zero,
     .link = {.hold = true},
     .lasts_s = 0.5,
     .zero_after_s = untrusted_s},
    {.name = "servo_stall_50ms",
     .cause = "the servo does not run for 50 ms",
     .promise = "missed ticks are counted and skipped; slew as of 5 ms",
     .set = fault::servo_stall,
     .lasts_s = 0.05},
    {.name = "servo_stall_500ms",
     .cause = "the servo does not run for 500 ms",
     .promise = "the same; the device holds the last force, or releases it by its own watchdog",
     .set = fault::servo_stall,
     .lasts_s = 0.5},
    {.name = "nan",
     .cause = "NaN in W",
     .promise = to_zero,
     .set = fault::spoil<&fault::nan_w>,
     .zero_after_s = untrusted_s},
    {.name = "nan_everywhere",
     .cause = "NaN in any other part of the problem",
     .promise = to_zero,
     .set = fault::spoil<&fault::nan_everywhere>,
     .zero_after_s = untrusted_s},
    {.name = "huge_w",
     .cause = "W ten million times too large",
     .promise = to_zero,
     .set = fault::spoil<&fault::scale_w<10'000'000>>,
     .zero_after_s = untrusted_s},
    {.name = "large_w",
     .cause = "W a thousand times too large, which is plausible",
     .promise = "limits hold",
     .set = fault::spoil<&fault::scale_w<1000>>},
    {.name = "indefinite_w",
     .cause = "W that is no compliance: its solution diverges",
     .promise = "limits hold",
     .set = fault::spoil<&fault::indefinite>},
    {.name = "asymmetric",
     .cause = "compliance and stiffness of a tool are not symmetric (W travels as one half)",
     .promise = to_zero,
     .set = fault::spoil<&fault::lopsided>,
     .zero_after_s = untrusted_s},
    {.name = "very_stiff",
     .cause = "couplings a hundred thousand times too stiff",
     .promise = "limits hold",
     .set = fault::spoil<&fault::very_stiff>},
    {.name = "wrong_sizes",
     .cause = "messages are cut short, too long or empty, or have wrong counts",
     .promise = to_zero,
     .set = fault::damage<&fault::wrong_size>,
     .zero_after_s = untrusted_s},
    {.name = "sequence_back",
     .cause = "the engine's sequence numbers go back by 1000",
     .promise = "0 within 102 ms, accepted after 0.5 s of silence",
     .set = fault::sequence_back,
     .lasts_s = 0.45,
     .zero_after_s = untrusted_s},
    {.name = "sequence_far_ahead",
     .cause = "one message has a sequence number far ahead",
     .promise = "that message is ignored: at least 80 %",
     .set = fault::sequence_ahead,
     .lasts_s = 0.1,
     .min_share = 0.8},
    {.name = "two_engines",
     .cause = "a second engine on the same channel",
     .promise = "the one that started last counts: at least 80 %",
     .set = fault::second_engine,
     .lasts_s = 1,
     .min_share = 0.8},
    {.name = "replayed_log",
     .cause = "messages of another session are replayed into this one",
     .promise = "no bit of the forces differs",
     .set = fault::replayed,
     .lasts_s = 1,
     .min_share = 1},
    {.name = "stamps_ahead",
     .cause = "the engine's clock is an hour ahead",
     .promise = to_zero,
     .set = fault::stamps<3600>,
     .zero_after_s = untrusted_s},
    {.name = "stamps_behind",
     .cause = "the engine's clock is an hour behind",
     .promise = to_zero,
     .set = fault::stamps<-3600>,
     .zero_after_s = untrusted_s},
    {.name = "clock_forward",
     .cause = "the machine's clock jumps 10 s ahead",
     .promise = "one tick of 5 ms; the force continues within a second",
     .set = fault::clock_jump<10>,
     .lasts_s = 0.02},
    {.name = "clock_back",
     .cause = "the machine's clock jumps 10 s back and the engine stands still for 300 ms",
     .promise = "no problem from before the jump counts as fresh: 0 within 52 ms",
     .set = fault::clock_back,
     .lasts_s = 0.3,
     .zero_after_s = ramp_s},
    {.name = "device_gone",
     .cause = "a device is unplugged during contact",
     .promise = "its force is 0 within 52 ms, and the other hand continues",
     .set = fault::device<DeviceError::gone>,
     .zero_after_s = ramp_s,
     .one_hand = true},
    {.name = "device_nan",
     .cause = "a device reports NaN",
     .promise = "the same",
     .set = fault::device<DeviceError::nan_pose>,
     .zero_after_s = ramp_s,
     .one_hand = true},
    {.name = "device_nan_speed",
     .cause = "a device reports NaN as its speed",
     .promise = "the same",
     .set = fault::device<DeviceError::nan_speed>,
     .zero_after_s = ramp_s,
     .one_hand = true},
    {.name = "device_far",
     .cause = "a device reports a position a million metres away",
     .promise = "the same",
     .set = fault::device<DeviceError::far_pose>,
     .zero_after_s = ramp_s,
     .one_hand = true},
    {.name = "device_crooked",
     .cause = "a device's orientation is no unit quaternion",
     .promise = "the same",
     .set = fault::device<DeviceError::crooked>,
     .zero_after_s = ramp_s,
     .one_hand = true},
    {.name = "device_jumps",
     .cause = "a device's position jumps by 1 cm each tick",
     .promise = "limits hold, and the other hand continues",
     .set = fault::device<DeviceError::jumps>,
     .one_hand = true},
    {.name = "device_stuck",
     .cause = "a device reports the same position forever",
     .promise = "limits hold, and the other hand continues",
     .set = fault::device<DeviceError::stuck>,
     .one_hand = true},
};

}  // namespace insula::testing
