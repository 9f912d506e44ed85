// SPDX-License-Identifier: GPL-3.0-or-later
// Recorded geometry comes back within half a unit; bytes that are none give a reason.
#include "engine/session/picture_codec.h"

#include <gtest/gtest.h>

#include <cmath>
#include <random>

namespace insula {
namespace {

using insula_lcm::render_frame_t;

/// Two bodies and a drawable whose length depends on the time.
render_frame_t frame_at(double t, int points = 5) {
  render_frame_t f{};
  for (int b = 0; b < 2; ++b) {
    insula_lcm::render_body_t body{};
    body.index = b;
    body.nodes = 40;
    for (int i = 0; i < body.nodes; ++i)
      body.x_m.push_back({float(0.01 * i + 1e-4 * std::sin(t + i)), float(-0.05 + 1e-3 * b * t), float(0.3)});
    f.body.push_back(std::move(body));
  }
  insula_lcm::render_drawable_t d{};
  d.index = 3;
  d.floats = 4 * points;
  for (int i = 0; i < d.floats; ++i) d.data.push_back(float(std::cos(t + i)));
  f.drawable.push_back(std::move(d));
  f.bodies = 2;
  f.drawables = 1;
  return f;
}

double largest_error(const render_frame_t& a, const render_frame_t& b) {
  double worst = a.body.size() == b.body.size() && a.drawable.size() == b.drawable.size() ? 0 : INFINITY;
  for (std::size_t n = 0; std::isfinite(worst) && n < a.body.size(); ++n) {
    if (a.body[n].index != b.body[n].index || a.body[n].x_m.size() != b.body[n].x_m.size()) return INFINITY;
    for (std::size_t i = 0; i < a.body[n].x_m.size(); ++i)
      for (std::size_t k = 0; k < 3; ++k)
        worst = std::max(worst, std::abs(double(a.body[n].x_m[i][k]) - b.body[n].x_m[i][k]));
  }
  for (std::size_t n = 0; std::isfinite(worst) && n < a.drawable.size(); ++n) {
    if (a.drawable[n].index != b.drawable[n].index || a.drawable[n].data.size() != b.drawable[n].data.size())
      return INFINITY;
    for (std::size_t i = 0; i < a.drawable[n].data.size(); ++i)
      worst = std::max(worst, std::abs(double(a.drawable[n].data[i]) - b.drawable[n].data[i]));
  }
  return worst;
}

// Half a unit of rounding, and that of a float near 1.
constexpr double tolerance = picture::unit / 2 + 6e-8;

TEST(PictureCodec, GivesPicturesBackWithinHalfAUnit) {
  PictureEncoder encoder;
  PictureDecoder decoder;
  mcap::Buffer bytes;
  std::string why;
  for (int k = 0; k < 50; ++k) {
    // Lists whose length changes have no differences to the picture before.
    const render_frame_t in = frame_at(0.1 * k, k % 7 == 3 ? 9 : 5);
    encoder.encode(in, k % 20 == 0, bytes);
    render_frame_t out{};
    ASSERT_TRUE(decoder.decode(bytes, out, why)) << why;
    ASSERT_LE(largest_error(in, out), tolerance) << "picture " << k;
  }
}

TEST(PictureCodec, WhatDoesNotMoveTakesNoBytes) {
  PictureEncoder encoder;
  mcap::Buffer key, again;
  encoder.encode(frame_at(1), true, key);
  encoder.encode(frame_at(1), false, again);
  EXPECT_GT(key.size(), 500U);
  EXPECT_EQ(again.size(), 5U + 3 * 10U) << "heads alone";
}

TEST(PictureCodec, NumbersOutOfRangeAndUnknownOnesStay) {
  render_frame_t in = frame_at(0);
  in.drawable[0].data = {NAN, INFINITY, 8e3F, -8e3F};
  in.drawable[0].floats = 4;
  PictureEncoder encoder;
  PictureDecoder decoder;
  mcap::Buffer bytes;
  std::string why;
  for (const float large : {8e3F, -8e3F}) {  // their difference is beyond 31 bits
    in.drawable[0].data[2] = large;
    in.drawable[0].data[3] = -large;
    encoder.encode(in, large > 0, bytes);
    render_frame_t out{};
    ASSERT_TRUE(decoder.decode(bytes, out, why)) << why;
    EXPECT_TRUE(std::isnan(out.drawable[0].data[0]));
    EXPECT_TRUE(std::isnan(out.drawable[0].data[1]));
    EXPECT_NEAR(double(out.drawable[0].data[2]), double(large), 1e-3);
    EXPECT_NEAR(double(out.drawable[0].data[3]), -double(large), 1e-3);
  }
}

TEST(PictureCodec, NeedsACompletePictureFirst) {
  PictureEncoder encoder;
  mcap::Buffer key, next;
  encoder.encode(frame_at(0), true, key);
  encoder.encode(frame_at(1), false, next);
  PictureDecoder decoder;
  render_frame_t out{};
  std::string why;
  EXPECT_FALSE(decoder.decode(next, out, why));
  EXPECT_EQ(why, "the picture before is missing");
  EXPECT_TRUE(decoder.decode(key, out, why));
  EXPECT_TRUE(decoder.decode(next, out, why));
}

TEST(PictureCodec, DamagedBytesGiveAReasonOrAPicture) {
  PictureEncoder encoder;
  mcap::Buffer good;
  encoder.encode(frame_at(0.3), true, good);
  std::mt19937 random(7);
  int refused = 0;
  for (int n = 0; n < 10'000; ++n) {
    mcap::Buffer bytes = good;
    if (n % 2 == 0) bytes.resize(random() % bytes.size());
    for (int k = 0; k < 3 && !bytes.empty(); ++k) bytes[random() % bytes.size()] = std::uint8_t(random());
    PictureDecoder decoder;
    render_frame_t out{};
    std::string why;
    if (!decoder.decode(bytes, out, why)) {
      EXPECT_NE(why, "");
      ++refused;
    }
  }
  EXPECT_GT(refused, 4000);
}

}  // namespace
}  // namespace insula
