// SPDX-License-Identifier: GPL-3.0-or-later
#include "core/base/nearest_rotation.h"

#include <gtest/gtest.h>

#include "core/base/random.h"

namespace insula {
namespace {

TEST(NearestRotation, FollowsARotationUnderAnyStretch) {
  Random random(3);
  const auto any = [&] { return Vec3(random.uniform(-1, 1), random.uniform(-1, 1), random.uniform(-1, 1)); };
  for (int trial = 0; trial < 500; ++trial) {
    const Mat3 axes = from_rotation_vector(any()).toRotationMatrix();
    const Mat3 stretch = axes * (Vec3::Constant(1.3) + any()).asDiagonal() * axes.transpose();
    Quat q = Quat::Identity();
    Mat3 found = Mat3::Identity();
    // A body that turns by a tenth a step.
    const Vec3 rate = 0.1 * any();
    Mat3 turn = Mat3::Identity();
    for (int step = 0; step < 20; ++step) {
      turn = from_rotation_vector(rate).toRotationMatrix() * turn;
      found = nearest_rotation(turn * stretch, q);
    }
    for (int step = 0; step < 20; ++step) found = nearest_rotation(turn * stretch, q);
    EXPECT_LT((found - turn).norm(), 1e-6) << trial;
    EXPECT_LT((found * found.transpose() - Mat3::Identity()).norm(), 1e-12);
  }
}

TEST(NearestRotation, OfNothingIsTheGuess) {
  Quat q = from_rotation_vector(Vec3(0.1, 0.2, 0.3));
  const Mat3 before = q.toRotationMatrix();
  EXPECT_EQ(nearest_rotation(Mat3::Zero(), q), before);
}

}  // namespace
}  // namespace insula
