// SPDX-License-Identifier: GPL-3.0-or-later
// Messages of the Haply service, whole and damaged.
#include "haptic_server/devices/haply_messages.h"

#include <gtest/gtest.h>

#include <array>
#include <nlohmann/json.hpp>

#include "haptic_server/devices/device_sample.h"
#include "haptic_server/problem_for_test.h"

namespace insula {
namespace {

const std::string inventory =
    R"({"session_id":7,"inverse3":[{"device_id":"04BA","config":{"type":"inverse3","handedness":"right"},"state":{"cursor_position":{"x":0.078,"y":-0.148,"z":0.143},)"
    R"("cursor_velocity":{"x":-0.01,"y":0.001,"z":-0.04},"mode":"idle"},"status":{"calibrated":false,"ready":true}}],"verse_grip":[{"device_id":"61548","state":)"
    R"({"button":true,"hall":0,"orientation":{"x":-0.5019531,"y":0.8632202,"z":-0.048095703,"w":-0.022338867}}}],"wireless_verse_grip":[]})";

TEST(HaplyMessages, AnInventoryIsRead) {
  HaplyState s;
  std::string why;
  ASSERT_TRUE(parse_haply(inventory, s, why)) << why;
  EXPECT_TRUE(s.named_vector);
  ASSERT_EQ(s.arms.size(), 1u);
  EXPECT_EQ(s.arms[0].id, "04BA");
  EXPECT_EQ(s.arms[0].handedness, "right");
  EXPECT_EQ(*s.arms[0].p_m, Vec3(0.078, -0.148, 0.143));
  EXPECT_EQ(*s.arms[0].v_m_s, Vec3(-0.01, 0.001, -0.04));
  ASSERT_EQ(s.grips.size(), 1u);
  EXPECT_NEAR(s.grips[0].q->norm(), 1, 1e-12);
  EXPECT_TRUE(s.grips[0].button1);
}

TEST(HaplyMessages, CommandsAreJson) {
  for (const bool introduce : {false, true})
    for (const bool vector : {false, true}) {
      const auto json = nlohmann::json::parse(haply_force("04BA", Vec3(1.5, -0.25, 1e-7), vector, introduce));
      const auto& f = json["inverse3"][0]["commands"]["set_cursor_force"][vector ? "vector" : "values"];
      EXPECT_EQ(f["x"], 1.5);
      EXPECT_EQ(f["y"], -0.25);
      EXPECT_EQ(f["z"], 0);
      EXPECT_EQ(json["inverse3"][0]["device_id"], "04BA");
      EXPECT_EQ(json.contains("session"), introduce);
    }
}

TEST(HaplyMessages, AnIdThatWouldBreakACommandIsNone) {
  for (const char* id : {R"(a\"b)", R"(a\\b)", R"(a\u0007b)", ""}) {
    HaplyState s;
    std::string why;
    ASSERT_TRUE(parse_haply(std::string(R"({"inverse3":[{"device_id":")") + id + R"("}]})", s, why));
    EXPECT_TRUE(s.arms.empty()) << id;
  }
}

TEST(HaplyMessages, AMillionDamagedOnesGiveNothingThatCannotBe) {
  testing::Random random(31);
  const auto pick = [&](std::size_t n) { return std::size_t(0.5 * (random.next() + 1) * double(n)) % n; };
  const std::array<std::string, 12> words{
      "1e999", "-1e308", "null", "\"x\"", "{", "}", "[", "]", "9999999999999999999999", "\\u0000", "true", ","};
  long read = 0;
  for (int k = 0; k < 1'000'000; ++k) {
    std::string text = inventory;
    for (std::size_t n = 1 + pick(3); n > 0 && !text.empty(); --n) {
      const std::size_t at = pick(text.size());
      switch (pick(5)) {
        case 0: text[at] = char(pick(256)); break;
        case 1: text[at] = char(text[at] ^ (1 << pick(8))); break;
        case 2: text.erase(at, 1 + pick(20)); break;
        case 3: text.insert(at, words[pick(words.size())]); break;
        default: text.resize(at + 1); break;
      }
    }
    HaplyState s;
    std::string why;
    if (!parse_haply(text, s, why)) {
      ASSERT_FALSE(why.empty());
      continue;
    }
    ++read;
    for (const HaplyArm& arm : s.arms) {
      ASSERT_FALSE(arm.id.empty());
      ASSERT_TRUE(!arm.p_m || arm.p_m->allFinite()) << text;
      ASSERT_TRUE(!arm.v_m_s || arm.v_m_s->allFinite()) << text;
    }
    for (const HaplyGrip& grip : s.grips) ASSERT_TRUE(!grip.q || std::abs(grip.q->norm() - 1) < 1e-9) << text;
  }
  EXPECT_GT(read, 10'000);  // enough of the damaged messages are still readable
}

}  // namespace
}  // namespace insula
