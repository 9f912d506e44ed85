// SPDX-License-Identifier: GPL-3.0-or-later
// Messages of an engine while two plates press on soft tissue. They follow the received DEVICE_STATE, 60 times a
// second.
#pragma once
#include <functional>
#include <memory>
#include <string>

#include "core/bus/arrival_order.h"
#include "core/bus/codec.h"
#include "core/bus/mem_bus.h"
#include "core/haptics/haptic_update.h"
#include "haptic_server/problem_for_test.h"
#include "tests/faults/faulty_bus.h"

namespace insula::testing {

class EngineDouble {
 public:
  EngineDouble(Bus& bus, const Clock& clock, std::int64_t session, std::uint64_t seed)
      : link(bus, clock, seed), clock_(clock), session_(session) {
    for (int hand = 0; hand < 2; ++hand) tool_[hand].p = Vec3(hand == 0 ? -0.02 : 0.02, 0, 0.001);
    link.subscribe(channel::device_state, [this](Bytes b) {
      std::string why;
      insula_lcm::device_state_t state{};
      if (decode(b, state, why) && order_.take(state.session, state.sequence, clock_.now_ns())) state_ = state;
    });
  }

  FaultyBus link;
  std::function<void(HapticUpdate&)> spoil;  ///< changes what it says
  std::function<void(Buffer&)> damage;       ///< changes the bytes that say it
  bool stalled = false;
  std::int64_t sequence = 0;
  std::int64_t stamp_off_us = 0;  ///< its clock against the server's

  /// Called once a millisecond.
  void live() {
    link.poll(0);
    ++milliseconds_;
    if (stalled || milliseconds_ * 60 / 1000 == (milliseconds_ - 1) * 60 / 1000) return;
    HapticUpdate u = update();
    if (spoil) spoil(u);
    ASSERT_TRUE(encode_problem(u, bytes_));
    if (damage) damage(bytes_);
    link.publish(channel::haptic_problem, bytes_);
  }

 private:
  static constexpr int corners = 4, rows_a_hand = 3 * corners + 1;

  HapticUpdate update() {
    HapticUpdate u;
    u.session = session_;
    u.sequence = ++sequence;
    u.time_us = clock_.now_ns() / 1000 + stamp_off_us;
    u.step_s = 1.0 / 60;
    u.sim_time_s = double(milliseconds_) * 1e-3;
    ConstraintProblem& p = u.problem;
    p.resize(2 * rows_a_hand);
    for (int hand = 0; hand < 2; ++hand) add_hand(hand, p);
    MatX w = MatX::Zero(p.rows, p.rows);
    for (const ToolTerms& t : p.tools) w += t.jacobian * t.compliance * t.jacobian.transpose();
    for (int i = 0; i < p.rows; ++i) {
      w(i, i) += 4 / 900.0;  // tissue of 600 N/m under a plate, a part of it in common
      for (int j = 0; j < p.rows; ++j)
        p.w[std::size_t(i) * std::size_t(p.stride) + std::size_t(j)] = w(i, j) + ((i - j) % 3 == 0 ? 2e-4 : 0);
    }
    return u;
  }

  void add_hand(int hand, ConstraintProblem& p) {
    for (const auto& h : state_.hand)
      if (h.hand == hand && h.connected) {
        tool_[hand].p = Vec3(h.p_m[0], h.p_m[1], h.p_m[2]);
        tool_[hand].q = Quat(h.q[0], h.q[1], h.q[2], h.q[3]);
      }
    ToolTerms t = held_tool(hand, tool_[hand], p.rows);
    int row = hand * rows_a_hand;
    for (int c = 0; c < corners; ++c, row += 3) {
      const Vec3 arm = t.free.q * Vec3(c & 1 ? 0.006 : -0.002, c & 2 ? 0.003 : -0.003, 0);
      const Vec3 axes[3] = {Vec3::UnitZ(), Vec3::UnitX(), Vec3::UnitY()};
      for (int k = 0; k < 3; ++k) t.jacobian.row(row + k) << axes[k].transpose(), arm.cross(axes[k]).transpose();
      p.delta_free[std::size_t(row)] = t.free.p.z() + arm.z();
      Block b;
      b.id = std::uint64_t(10 * hand + c + 1);
      b.row = row;
      b.law = LawKind::friction;
      b.friction = 0.3;
      p.blocks.push_back(b);
    }
    t.jacobian(row, 0) = 1;  // a fibre that resists being drawn to the right
    p.delta_free[std::size_t(row)] = t.free.p.x() - (hand == 0 ? -0.02 : 0.02);
    Block fibre;
    fibre.id = std::uint64_t(10 * hand + 9);
    fibre.row = row;
    fibre.compliance = 1 / 50.0;
    fibre.upper = 0;
    p.blocks.push_back(fibre);
    p.tools.push_back(t);
  }

  const Clock& clock_;
  std::int64_t session_, milliseconds_ = 0;
  ArrivalOrder order_;
  insula_lcm::device_state_t state_{};
  Pose tool_[2];
  Buffer bytes_;
};

}  // namespace insula::testing
