// SPDX-License-Identifier: GPL-3.0-or-later
// The structure of each message type, walked without decoding. Mirrors lcm_types/*.lcm field by field.
#include "core/bus/codec.h"

#include "core/bus/byte_io.h"

namespace insula {
namespace {

constexpr std::size_t size_i8 = 1, size_i16 = 2, size_i32 = 4, size_i64 = 8, size_f32 = 4, size_f64 = 8;

template <class Message>
bool starts_as(ByteReader& in, const Message*) {
  return in.i64() == Message::getHash() && in.ok();
}

void walk_hand_state(ByteReader& in) {
  in.take(size_i8);        // hand
  in.skip_string();        // device
  in.take(size_i8);        // connected
  in.take(13 * size_f64);  // p, q, v, w
  in.take(2 * size_i8);    // buttons
  in.take(6 * size_f64);   // force, torque
}

void walk_render_body(ByteReader& in) {
  in.take(size_i32);  // index
  in.take_array(in.i32(), 3 * size_f32);
}

void walk_step_input(ByteReader& in) {
  in.take(size_i8 + size_i32);   // kind, index
  in.take(3 * size_i8);          // present, buttons
  in.take(7 * size_f64);         // p, q
  in.skip_string();              // verb
  in.skip_string();              // argument
  in.take(size_i64 + size_f64);  // seed, seconds
}

constexpr std::size_t render_tool_bytes =
    size_i32 + 2 * size_i8 + (3 + 4 + 3 + 3) * size_f64 + 2 * size_i8 + 2 * size_f32;

}  // namespace

bool well_formed(const insula_lcm::device_state_t* type, Bytes bytes) {
  ByteReader in(bytes);
  if (!starts_as(in, type)) return false;
  in.take(3 * size_i64);
  const int hands = in.i8();
  if (hands < 0) return false;
  for (int i = 0; i < hands && in.ok(); ++i) walk_hand_state(in);
  return in.at_end();
}

bool well_formed(const insula_lcm::hand_input_t* type, Bytes bytes) {
  ByteReader in(bytes);
  if (!starts_as(in, type)) return false;
  in.take(size_i64 + size_i8 + 7 * size_f64 + 2 * size_i8);
  return in.at_end();
}

bool well_formed(const insula_lcm::haptic_status_t* type, Bytes bytes) {
  ByteReader in(bytes);
  if (!starts_as(in, type)) return false;
  in.take(3 * size_i64);                        // session, sequence, time
  in.take(3 * size_f64);                        // ticks, fresh forces
  in.take(size_i64);                            // missed ticks
  in.take(7 * size_f64 + 12 * size_i32);        // lateness and its histogram, solve, sweeps, residual
  in.take(size_i32 + size_f64 + 2 * size_i64);  // rows, age, counts
  in.take(3 * size_f64 + size_i8);              // energies, force scale, real time
  in.skip_string();
  return in.at_end();
}

bool well_formed(const insula_lcm::metrics_t* type, Bytes bytes) {
  ByteReader in(bytes);
  if (!starts_as(in, type)) return false;
  in.take(2 * size_i64 + size_f64 + size_i8);
  in.skip_string();
  return in.at_end();
}

bool well_formed(const insula_lcm::render_frame_t* type, Bytes bytes) {
  ByteReader in(bytes);
  if (!starts_as(in, type)) return false;
  in.take(3 * size_i64 + size_f64 + size_i8);
  const int bodies = in.i32();
  if (bodies < 0) return false;
  for (int i = 0; i < bodies && in.ok(); ++i) walk_render_body(in);
  in.take_array(in.i32(), size_f32);  // channels
  const int drawables = in.i32();
  if (drawables < 0) return false;
  for (int i = 0; i < drawables && in.ok(); ++i) {
    in.take(size_i32);  // index
    in.take_array(in.i32(), size_f32);
  }
  const int tools = in.i8();
  in.take_array(tools, render_tool_bytes);
  const int contacts = in.i32();
  in.take_array(contacts, 4 * size_f32 + 2 * size_i16);  // position, force, both sides
  in.take(2 * size_f64 + 2 * size_i32);
  in.take_array(bodies, size_f64);
  in.skip_string();
  return in.at_end();
}

bool well_formed(const insula_lcm::scene_info_t* type, Bytes bytes) {
  ByteReader in(bytes);
  if (!starts_as(in, type)) return false;
  in.take(2 * size_i64);
  for (int i = 0; i < 6; ++i) in.skip_string();
  return in.at_end();
}

bool well_formed(const insula_lcm::servo_ticks_t* type, Bytes bytes) {
  ByteReader in(bytes);
  if (!starts_as(in, type)) return false;
  in.take(3 * size_i64);
  const int ticks = in.i32(), numbers = in.i32();
  in.take_array(ticks, size_i32);
  in.take_array(numbers, size_f32);
  return in.at_end();
}

bool well_formed(const insula_lcm::session_step_t* type, Bytes bytes) {
  ByteReader in(bytes);
  if (!starts_as(in, type)) return false;
  in.take(size_i64 + size_f64 + size_i8);  // number, time, hashed
  in.take(size_i64 + size_f64);            // hash, energy
  in.take_array(in.i32(), size_f64);       // body sums
  const int inputs = in.i32();
  if (inputs < 0) return false;
  for (int i = 0; i < inputs && in.ok(); ++i) walk_step_input(in);
  return in.at_end();
}

bool well_formed(const insula_lcm::sim_event_t* type, Bytes bytes) {
  ByteReader in(bytes);
  if (!starts_as(in, type)) return false;
  in.take(3 * size_i64 + size_f64);
  for (int i = 0; i < 3; ++i) in.skip_string();
  in.take(size_f64 + size_i8);
  return in.at_end();
}

bool well_formed(const insula_lcm::soft_guide_t* type, Bytes bytes) {
  ByteReader in(bytes);
  if (!starts_as(in, type)) return false;
  in.take(4 * size_i64 + size_i8 + 5 * size_f64);
  return in.at_end();
}

bool well_formed(const insula_lcm::user_command_t* type, Bytes bytes) {
  ByteReader in(bytes);
  if (!starts_as(in, type)) return false;
  in.take(size_i64);
  for (int i = 0; i < 3; ++i) in.skip_string();
  return in.at_end();
}

void drop_stale(insula_lcm::render_frame_t& m) {
  for (auto& b : m.body)
    if (b.nodes == 0) b.x_m.clear();
  if (m.bodies == 0) m.body_force_N.clear();
  if (m.channels == 0) m.channel.clear();
  for (auto& d : m.drawable)
    if (d.floats == 0) d.data.clear();
  if (m.drawables == 0) m.drawable.clear();
  if (m.contacts == 0) {
    m.contact_x_m.clear();
    m.contact_N.clear();
    m.contact_side.clear();
  }
}

void drop_stale(insula_lcm::servo_ticks_t& m) {
  if (m.ticks == 0) m.after_us.clear();
  if (m.numbers == 0) m.hands.clear();
}

void drop_stale(insula_lcm::session_step_t& m) {
  if (m.bodies == 0) m.body_sum.clear();
  if (m.inputs == 0) m.input.clear();
}

}  // namespace insula
