// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/motion_script.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

namespace insula::case_builder {

ApplierPose drawn_back(ApplierPose pose, double mm) {
  pose.tip += mm * pose.shaft;
  return pose;
}

void MotionScript::key(bool right, double seconds, const ApplierPose& pose, bool button1, bool button2) {
  double& t = time_[right];
  t = std::round((t + seconds) * 1e4) / 1e4;
  const Eigen::Quaterniond q(pose.rotation());
  const double sign = q.w() < 0 ? -1 : 1;
  rows_.push_back(
      {t, fmt::format("{:g},{},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{:.6f},{},{}", t, right ? "right" : "left",
                      pose.tip.x() / 1000, pose.tip.y() / 1000, pose.tip.z() / 1000, sign * q.w(), sign * q.x(),
                      sign * q.y(), sign * q.z(), int(button1), int(button2))});
}

void MotionScript::command(double time, const std::string& text) {
  rows_.push_back({time, fmt::format("{:g},command,ask,{}", time, text)});
}

void MotionScript::place_clip(const ApplierPose& at, double open_at, double approach) {
  const ApplierPose outside = drawn_back(at, out_of_field), opened = drawn_back(at, open_at);
  key(true, 0.3, outside);
  if (open_at < out_of_field) key(true, approach, opened);
  key(true, 0.05, opened, true);
  key(true, 0.5, opened, true);
  key(true, open_at < out_of_field ? 0.6 : approach, drawn_back(at, 3), true);
  key(true, 0.8, at, true);
  key(true, 0.3, at, true);
  key(true, 0.02, at);
  key(true, 1.6, at);
  key(true, 0.02, at, false, true);
  key(true, 0.2, at, false, true);
  key(true, 0.02, at);
  key(true, 0.6, at);
  key(true, 0.8, drawn_back(at, 4));
  key(true, 1.5, outside);
}

void MotionScript::take_clip(const ApplierPose& at) {
  const ApplierPose outside = drawn_back(at, out_of_field);
  key(true, 0.3, outside);
  key(true, 2.5, drawn_back(at, 2));
  key(true, 0.6, at);
  key(true, 0.3, at);
  key(true, 0.02, at, false, true);
  key(true, 0.2, at, false, true);
  key(true, 0.02, at);
  key(true, 0.4, at);
  key(true, 0.02, at, true);
  key(true, 0.5, at, true);
  key(true, 0.8, drawn_back(at, 6), true);
  key(true, 1.2, outside, true);
  key(true, 0.02, outside);
}

std::string MotionScript::csv() const {
  std::vector<Row> rows = rows_;
  std::stable_sort(rows.begin(), rows.end(), [](const Row& a, const Row& b) { return a.time < b.time; });
  std::string out = "time_s,hand,px_m,py_m,pz_m,qw,qx,qy,qz,button1,button2\n";
  for (const Row& r : rows) out += r.text + "\n";
  return out;
}

}  // namespace insula::case_builder
