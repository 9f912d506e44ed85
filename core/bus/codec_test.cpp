// SPDX-License-Identifier: GPL-3.0-or-later
// The decoders of the generated message types: round trips, truncation, damage, and each rule of plausibility.
#include "core/bus/codec.h"

#include <gtest/gtest.h>

#include <cmath>
#include <functional>
#include <limits>

#include "core/bus/mutate_for_test.h"

namespace insula {
namespace {

using Buffer = std::vector<std::uint8_t>;

template <class T>
T sample();

void set_quaternion(double* q) {
  q[0] = 0.6;
  q[1] = 0;
  q[2] = -0.8;
  q[3] = 0;
}

template <>
insula_lcm::device_state_t sample() {
  insula_lcm::device_state_t m{};
  m.session = 5;
  m.sequence = 6;
  m.time_us = 7;
  m.hands = 2;
  for (int i = 0; i < 2; ++i) {
    insula_lcm::hand_state_t h{};
    h.hand = int8_t(i);
    h.device = "simulated";
    h.connected = 1;
    h.p_m[0] = 0.01 * i;
    set_quaternion(h.q);
    h.button1 = 1;
    h.force_N[2] = 1.5;
    m.hand.push_back(h);
  }
  return m;
}
template <>
insula_lcm::hand_input_t sample() {
  insula_lcm::hand_input_t m{};
  m.time_us = 9;
  m.hand = 1;
  m.p_m[1] = 0.02;
  set_quaternion(m.q);
  m.button2 = 1;
  return m;
}
template <>
insula_lcm::haptic_status_t sample() {
  insula_lcm::haptic_status_t m{};
  m.sequence = 3;
  m.ticks_per_s = 1000;
  m.fresh_forces_per_s[0] = 999;
  m.lateness_us_max = 120;
  m.rows = 130;
  m.problem_age_ms = -1;
  m.given_mJ[1] = 0.2;
  m.force_scale = 2;
  m.note = "no real-time priority";
  return m;
}
template <>
insula_lcm::render_frame_t sample() {
  insula_lcm::render_frame_t m{};
  m.session = 1;
  m.sequence = 2;
  m.sim_time_s = 0.5;
  m.bodies = 2;
  for (int i = 0; i < 2; ++i) {
    insula_lcm::render_body_t b{};
    b.index = i;
    b.nodes = 3;
    b.x_m = {{0.f, 0.f, 0.f}, {0.01f, 0.f, 0.f}, {0.f, 0.01f, float(i)}};
    m.body.push_back(b);
    m.body_force_N.push_back(0.2 * i);
  }
  m.channels = 3;
  m.channel = {0.05f, std::nanf(""), -2.f};
  m.drawables = 2;
  m.drawable.resize(2);
  m.drawable[0].floats = 8;
  m.drawable[0].data.assign(8, 0.1f);
  m.drawable[1].index = 1;
  m.tools = 1;
  insula_lcm::render_tool_t t{};
  t.index = 0;
  t.hand = 1;
  set_quaternion(t.q);
  t.activity = 0.5f;
  t.state = 2;
  t.opening_rad = 0.25f;
  m.tool.push_back(t);
  m.contacts = 1;
  m.contact_x_m = {{0.f, 0.f, 0.1f}};
  m.contact_N = {0.3f};
  m.contact_side = {{2, -1}};
  m.step_ms = 5;
  m.step_period_ms = 16.7;
  m.hud_json = R"({"goals":[],"state":"running"})";
  return m;
}
template <>
insula_lcm::metrics_t sample() {
  insula_lcm::metrics_t m{};
  m.session = 11;
  m.time_us = 4'711;
  m.sim_time_s = 12.5;
  m.at_end = 1;
  m.json = R"([{"id":"path_length","hand":"left","unit":"mm","value":12.5,"better":"low"}])";
  return m;
}
template <>
insula_lcm::scene_info_t sample() {
  insula_lcm::scene_info_t m{};
  m.session = 11;
  m.scene = "scenes/training/1_sylvian_fissure.xml";
  m.title = "Sylvian fissure";
  m.state = "running";
  return m;
}
template <>
insula_lcm::servo_ticks_t sample() {
  insula_lcm::servo_ticks_t m{};
  m.session = 11;
  m.time_us = 4'711;
  m.ticks = 2;
  m.numbers = 2 * numbers_of_tick;
  m.after_us = {0, 1'003};
  for (int k = 0; k < 4; ++k)
    for (const float v : {0.01f, -0.02f, 0.03f, 0.6f, 0.f, 0.8f, 0.f, 0.1f, -0.2f, 1.5f}) m.hands.push_back(v);
  return m;
}
template <>
insula_lcm::session_step_t sample() {
  insula_lcm::session_step_t m{};
  m.number = 61;
  m.sim_time_s = 1.0167;
  m.hashed = 1;
  m.state_hash = -4711;
  m.energy_J = 2e-6;
  m.bodies = 2;
  m.body_sum = {0.25, -3};
  m.inputs = 2;
  m.input.resize(2);
  m.input[0].index = 1;
  m.input[0].present = 1;
  m.input[0].p_m[2] = 0.07;
  set_quaternion(m.input[0].q);
  m.input[1].kind = 1;
  set_quaternion(m.input[1].q);
  m.input[1].verb = "exchange";
  m.input[1].argument = "right applier";
  return m;
}
template <>
insula_lcm::sim_event_t sample() {
  insula_lcm::sim_event_t m{};
  m.session = 11;
  m.kind = "goal";
  m.id = "open";
  m.text = "Fissure open";
  m.value = 3;
  m.hand = -1;
  return m;
}
template <>
insula_lcm::soft_guide_t sample() {
  insula_lcm::soft_guide_t m{};
  m.session = 11;
  m.sequence = 3;
  m.time_us = 4'711;
  m.number = 2;
  m.hand = 1;
  m.direction[0] = 0.6;
  m.direction[2] = -0.8;
  m.force_N = 0.3;
  m.duration_s = 1.2;
  return m;
}
template <>
insula_lcm::user_command_t sample() {
  insula_lcm::user_command_t m{};
  m.sender = "viewer-1";
  m.command = "pause";
  return m;
}

template <class T>
Buffer encoded(const T& m) {
  Buffer out;
  EXPECT_TRUE(encode(m, out));
  return out;
}

template <class T>
class Codec : public ::testing::Test {};
using Types = ::testing::Types<insula_lcm::device_state_t, insula_lcm::hand_input_t, insula_lcm::haptic_status_t,
                               insula_lcm::metrics_t, insula_lcm::render_frame_t, insula_lcm::scene_info_t,
                               insula_lcm::servo_ticks_t, insula_lcm::session_step_t, insula_lcm::sim_event_t,
                               insula_lcm::soft_guide_t, insula_lcm::user_command_t>;
TYPED_TEST_SUITE(Codec, Types);

TYPED_TEST(Codec, RoundTrip) {
  const Buffer bytes = encoded(sample<TypeParam>());
  TypeParam got;
  std::string why;
  ASSERT_TRUE(decode(bytes, got, why)) << why;
  EXPECT_EQ(encoded(got), bytes);
  ASSERT_TRUE(decode(bytes, got, why)) << "again, into the same object: " << why;
  EXPECT_EQ(encoded(got), bytes);
}

TYPED_TEST(Codec, EveryTruncationIsRefused) {
  const Buffer whole = encoded(sample<TypeParam>());
  for (std::size_t n = 0; n < whole.size(); ++n) {
    const Buffer cut(whole.begin(), whole.begin() + std::ptrdiff_t(n));
    TypeParam got;
    std::string why;
    ASSERT_FALSE(decode(Bytes(cut), got, why)) << n;
    ASSERT_FALSE(why.empty());
  }
  Buffer longer = whole;
  longer.push_back(0);
  EXPECT_FALSE(decode<TypeParam>(longer).has_value());
  EXPECT_FALSE(decode<TypeParam>(Buffer(max_message_bytes + 1)).has_value());
}

TYPED_TEST(Codec, RandomDamage) {
  const Buffer whole = encoded(sample<TypeParam>());
  testing::Mutator mutate(4711);
  TypeParam got = sample<TypeParam>();
  std::string why;
  int refused = 0;
  for (int i = 0; i < 1'000'000; ++i) {
    const Buffer damaged = mutate(whole);
    if (decode(Bytes(damaged), got, why)) {
      ASSERT_TRUE(plausible(got, why));
      // What was accepted is what was said, byte for byte.
      ASSERT_EQ(encoded(got), damaged);
    } else {
      ++refused;
    }
  }
  EXPECT_GT(refused, 250'000);
}

TYPED_TEST(Codec, OtherTypesAreRefused) {
  const Buffer bytes = encoded(sample<TypeParam>());
  int taken = 0;
  taken += decode<insula_lcm::device_state_t>(bytes).has_value();
  taken += decode<insula_lcm::hand_input_t>(bytes).has_value();
  taken += decode<insula_lcm::haptic_status_t>(bytes).has_value();
  taken += decode<insula_lcm::metrics_t>(bytes).has_value();
  taken += decode<insula_lcm::render_frame_t>(bytes).has_value();
  taken += decode<insula_lcm::scene_info_t>(bytes).has_value();
  taken += decode<insula_lcm::servo_ticks_t>(bytes).has_value();
  taken += decode<insula_lcm::session_step_t>(bytes).has_value();
  taken += decode<insula_lcm::sim_event_t>(bytes).has_value();
  taken += decode<insula_lcm::soft_guide_t>(bytes).has_value();
  taken += decode<insula_lcm::user_command_t>(bytes).has_value();
  EXPECT_EQ(taken, 1);
}

template <class T>
void expect_refused(const char* name, const std::function<void(T&)>& make) {
  T m = sample<T>();
  std::string why;
  ASSERT_TRUE(plausible(m, why)) << why;
  make(m);
  EXPECT_FALSE(plausible(m, why)) << name;
  EXPECT_FALSE(why.empty());
}

TEST(Plausible, DeviceState) {
  using T = insula_lcm::device_state_t;
  expect_refused<T>("nan force", [](T& m) { m.hand[1].force_N[0] = std::nan(""); });
  expect_refused<T>("force", [](T& m) { m.hand[0].force_N[0] = 1000; });
  expect_refused<T>("same hand", [](T& m) { m.hand[1].hand = 0; });
  expect_refused<T>("hand 3", [](T& m) { m.hand[1].hand = 3; });
  expect_refused<T>("quaternion", [](T& m) { m.hand[0].q[0] = 0; });
  expect_refused<T>("count", [](T& m) { m.hands = 1; });
  expect_refused<T>("flag", [](T& m) { m.hand[0].button1 = 2; });
}

TEST(Plausible, HandInput) {
  using T = insula_lcm::hand_input_t;
  expect_refused<T>("nan", [](T& m) { m.p_m[2] = std::nan(""); });
  expect_refused<T>("infinite", [](T& m) { m.p_m[2] = INFINITY; });
  expect_refused<T>("far", [](T& m) { m.p_m[0] = 50; });
  expect_refused<T>("quaternion", [](T& m) { m.q[2] = 0.8001 * 2; });
  expect_refused<T>("hand", [](T& m) { m.hand = -1; });
}

TEST(Plausible, SoftGuide) {
  using T = insula_lcm::soft_guide_t;
  expect_refused<T>("force", [](T& m) { m.force_N = 0.501; });
  expect_refused<T>("against its direction", [](T& m) { m.force_N = -0.1; });
  expect_refused<T>("nan force", [](T& m) { m.force_N = NAN; });
  expect_refused<T>("direction", [](T& m) { m.direction[1] = 0.1; });
  expect_refused<T>("no direction", [](T& m) { m.direction[0] = m.direction[2] = 0; });
  expect_refused<T>("nan direction", [](T& m) { m.direction[1] = NAN; });
  expect_refused<T>("long", [](T& m) { m.duration_s = 1.6; });
  expect_refused<T>("short", [](T& m) { m.duration_s = 0.5; });
  expect_refused<T>("nan duration", [](T& m) { m.duration_s = NAN; });
  expect_refused<T>("hand", [](T& m) { m.hand = -1; });
  expect_refused<T>("number", [](T& m) { m.number = 0; });
}

TEST(Plausible, RenderFrame) {
  using T = insula_lcm::render_frame_t;
  expect_refused<T>("nan node", [](T& m) { m.body[0].x_m[2][1] = NAN; });
  expect_refused<T>("body twice", [](T& m) { m.body[1].index = 0; });
  expect_refused<T>("nodes", [](T& m) { m.body[1].nodes = 4; });
  expect_refused<T>("channel", [](T& m) { m.channel[0] = INFINITY; });
  expect_refused<T>("drawable twice", [](T& m) { m.drawable[1].index = 0; });
  expect_refused<T>("drawable", [](T& m) { m.drawable[0].data[3] = NAN; });
  expect_refused<T>("json", [](T& m) { m.hud_json = "{"; });
  for (const int s : {-1, 3, 127}) expect_refused<T>("state", [s](T& m) { m.tool[0].state = std::int8_t(s); });
  for (const float o : {4.f, -4.f, std::numeric_limits<float>::quiet_NaN(), std::numeric_limits<float>::infinity()})
    expect_refused<T>("opening", [o](T& m) { m.tool[0].opening_rad = o; });
  expect_refused<T>("too many", [](T& m) {
    m.tools = 101;
    m.tool.resize(101, m.tool[0]);
  });
  expect_refused<T>("tool", [](T& m) { m.tool[0].activity = 2; });
  expect_refused<T>("contact", [](T& m) { m.contact_N[0] = INFINITY; });
  expect_refused<T>("side", [](T& m) { m.contact_side[0][1] = -2; });
}

TEST(Plausible, Others) {
  expect_refused<insula_lcm::haptic_status_t>("nan", [](auto& m) { m.sweeps_mean = NAN; });
  expect_refused<insula_lcm::haptic_status_t>("energy", [](auto& m) { m.given_mJ[0] = NAN; });
  expect_refused<insula_lcm::haptic_status_t>("scale", [](auto& m) { m.force_scale = -1; });
  expect_refused<insula_lcm::haptic_status_t>("negative", [](auto& m) { m.missed_ticks = -1; });
  expect_refused<insula_lcm::metrics_t>("json", [](auto& m) { m.json = "[{"; });
  expect_refused<insula_lcm::metrics_t>("time", [](auto& m) { m.sim_time_s = NAN; });
  expect_refused<insula_lcm::metrics_t>("flag", [](auto& m) { m.at_end = 2; });
  expect_refused<insula_lcm::scene_info_t>("state", [](auto& m) { m.state = "lost"; });
  expect_refused<insula_lcm::scene_info_t>("NUL", [](auto& m) { m.bundle = std::string("a\0b", 3); });
  expect_refused<insula_lcm::servo_ticks_t>("order", [](auto& m) { m.after_us[1] = -1; });
  expect_refused<insula_lcm::servo_ticks_t>("position", [](auto& m) { m.hands[11] = 11; });
  expect_refused<insula_lcm::servo_ticks_t>("turn", [](auto& m) { m.hands[3] = 2; });
  expect_refused<insula_lcm::servo_ticks_t>("force", [](auto& m) { m.hands[39] = NAN; });
  expect_refused<insula_lcm::session_step_t>("number", [](auto& m) { m.number = 0; });
  expect_refused<insula_lcm::session_step_t>("sum", [](auto& m) { m.body_sum[1] = NAN; });
  expect_refused<insula_lcm::session_step_t>("kind", [](auto& m) { m.input[0].kind = 6; });
  expect_refused<insula_lcm::session_step_t>("hand", [](auto& m) { m.input[0].index = 2; });
  expect_refused<insula_lcm::session_step_t>("pose", [](auto& m) { m.input[0].q[0] = 2; });
  expect_refused<insula_lcm::session_step_t>("inputs", [](auto& m) { m.inputs = 3; });
  expect_refused<insula_lcm::sim_event_t>("kind", [](auto& m) { m.kind = ""; });
  expect_refused<insula_lcm::sim_event_t>("value", [](auto& m) { m.value = NAN; });
  expect_refused<insula_lcm::sim_event_t>("hand", [](auto& m) { m.hand = 2; });
  expect_refused<insula_lcm::user_command_t>("command", [](auto& m) { m.command = "rm -rf"; });
  expect_refused<insula_lcm::user_command_t>("argument", [](auto& m) { m.argument = "two\nlines"; });
  expect_refused<insula_lcm::user_command_t>("argument", [](auto& m) { m.argument = "a\x7f"; });
  expect_refused<insula_lcm::user_command_t>("sender", [](auto& m) { m.sender = std::string(65, 'a'); });
}

TEST(Codec, CountsAndVectorsMustAgreeBeforeEncoding) {
  auto frame = sample<insula_lcm::render_frame_t>();
  frame.contacts = 5;
  Buffer out;
  EXPECT_FALSE(encode(frame, out));
  EXPECT_TRUE(out.empty());
}

TEST(Codec, EmptyFrameIntoAUsedObject) {
  insula_lcm::render_frame_t used = sample<insula_lcm::render_frame_t>(), empty{};
  std::string why;
  ASSERT_TRUE(decode(encoded(empty), used, why)) << why;
  EXPECT_TRUE(used.drawable.empty());
  EXPECT_TRUE(used.contact_x_m.empty());
  EXPECT_TRUE(used.contact_side.empty());
}

}  // namespace
}  // namespace insula
