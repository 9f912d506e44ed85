// SPDX-License-Identifier: GPL-3.0-or-later
// The bytes of a history: a letter for each operation, then its values.
#include "python/src/history.h"

#include <algorithm>
#include <array>

#include "python/src/byte_stream.h"

namespace insula::python {
namespace {

constexpr char hand_op = 'h', command_op = 'c', seed_op = 'r', motion_op = 'm', step_op = 's';

void put_pose(std::string& to, const Pose& pose) {
  const std::array<double, 7> v{pose.p.x(), pose.p.y(), pose.p.z(), pose.q.w(), pose.q.x(), pose.q.y(), pose.q.z()};
  put(to, v);
}

Pose take_pose(ByteReader& from) {
  const auto v = from.take<std::array<double, 7>>();
  return {{v[0], v[1], v[2]}, {v[3], v[4], v[5], v[6]}};
}

HandState take_hand(ByteReader& from) {
  HandState state;
  const auto bits = from.take<std::uint8_t>();
  state.present = bits & 1;
  state.button1 = bits & 2;
  state.button2 = bits & 4;
  state.device = take_pose(from);
  return state;
}

void put_motion(std::string& to, const Motion& motion) {
  for (int hand = 0; hand < 2; ++hand) {
    put(to, std::uint32_t(motion.keys(hand).size()));
    for (const Motion::Key& k : motion.keys(hand)) {
      put(to, k.time_s);
      put_pose(to, k.sample.pose);
      put(to, std::uint8_t(k.sample.button1 | k.sample.button2 << 1));
    }
  }
  put(to, std::uint32_t(motion.commands().size()));
  for (const MotionCommand& c : motion.commands()) {
    put(to, c.time_s);
    put_text(to, c.verb);
    put_text(to, c.argument);
  }
}

Motion take_motion(ByteReader& from) {
  Motion motion;
  for (int hand = 0; hand < 2; ++hand)
    for (auto n = from.take<std::uint32_t>(); n > 0; --n) {
      Motion::Key k;
      k.time_s = from.take<double>();
      k.sample.pose = take_pose(from);
      const auto bits = from.take<std::uint8_t>();
      k.sample.button1 = bits & 1;
      k.sample.button2 = bits & 2;
      motion.add(hand, k);
    }
  for (auto n = from.take<std::uint32_t>(); n > 0; --n) {
    MotionCommand c;
    c.time_s = from.take<double>();
    c.verb = from.text();
    c.argument = from.text();
    motion.add(std::move(c));
  }
  return motion;
}

}  // namespace

void History::set_hand(int hand, const HandState& state) {
  put(bytes_, hand_op);
  put(bytes_, std::int8_t(hand));
  put(bytes_, std::uint8_t(state.present | state.button1 << 1 | state.button2 << 2));
  put_pose(bytes_, state.device);
}

void History::command(std::string_view verb, std::string_view argument) {
  put(bytes_, command_op);
  put_text(bytes_, verb);
  put_text(bytes_, argument);
}

void History::draw_complications(std::uint64_t seed) {
  put(bytes_, seed_op);
  put(bytes_, seed);
}

void History::follow(const Motion& motion) {
  put(bytes_, motion_op);
  put_motion(bytes_, motion);
}

void History::step() { put(bytes_, step_op); }

void History::replay(const Replay& to, std::size_t from) const {
  ByteReader in(std::string_view(bytes_).substr(std::min(from, bytes_.size())));
  while (!in.at_end()) switch (in.take<char>()) {
      case hand_op: {
        const int hand = in.take<std::int8_t>();
        if (hand < 0 || hand > 1) throw InputError("the state is damaged");
        to.set_hand(hand, take_hand(in));
        break;
      }
      case command_op: {
        std::string verb = in.text();
        to.command(std::move(verb), in.text());
        break;
      }
      case seed_op: to.draw_complications(in.take<std::uint64_t>()); break;
      case motion_op: to.follow(take_motion(in)); break;
      case step_op: to.step(); break;
      default: throw InputError("the state is damaged");
    }
}

}  // namespace insula::python
