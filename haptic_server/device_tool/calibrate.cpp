// SPDX-License-Identifier: GPL-3.0-or-later
// Calibration from four positions.
#include "haptic_server/device_tool/calibrate.h"

#include <fmt/format.h>

#include <Eigen/SVD>
#include <array>
#include <cmath>
#include <ostream>

#include "core/base/input_error.h"
#include "haptic_server/device_tool/device_session.h"

namespace insula {
namespace {

constexpr double min_stroke_m = 0.02;
constexpr double largest_error_rad = 0.44;  // 25 degrees, since a hand is not exact
constexpr double steady_s = 0.3, steady_m = 0.003;

/// The device's mean pose over a short time at rest.
Pose held_pose(DeviceSession& session) {
  Vec3 sum = Vec3::Zero(), low = Vec3::Constant(1e9), high = -low;
  Quat q = Quat::Identity();
  int n = 0;
  for (double t = 0; t < steady_s; t += 0.005) {
    const DeviceSample s = session.state().raw;
    if (!s.valid) throw InputError("the device was lost");
    sum += s.pose.p;
    low = low.cwiseMin(s.pose.p);
    high = high.cwiseMax(s.pose.p);
    q = s.pose.q;
    ++n;
    session.wait(0.005);
  }
  if ((high - low).norm() > steady_m)
    throw InputError("the device moved; hold it still for a third of a second after the answer");
  return {sum / n, q};
}

}  // namespace

DeviceCalibration fit_calibration(const Pose& rest, const Vec3& right, const Vec3& away, const Vec3& up, double scale) {
  const std::array<Vec3, 3> to{right, away, up};
  const std::array<const char*, 3> name{"right", "away", "up"};
  Mat3 strokes;  // row i: direction of the person's axis i in the device's frame
  for (std::size_t i = 0; i < 3; ++i) {
    const Vec3 stroke = to[i] - rest.p;
    if (!(stroke.norm() >= min_stroke_m))
      throw InputError(fmt::format("the movement {} was {:.0f} mm, less than {:.0f} mm", name[i], 1e3 * stroke.norm(),
                                   1e3 * min_stroke_m));
    strokes.row(Eigen::Index(i)) = stroke.normalized();
  }
  const Eigen::JacobiSVD<Mat3> svd(strokes, Eigen::ComputeFullU | Eigen::ComputeFullV);
  Mat3 sign = Mat3::Identity();
  sign(2, 2) = (svd.matrixU() * svd.matrixV().transpose()).determinant() < 0 ? -1 : 1;
  DeviceCalibration c;
  c.axes = svd.matrixU() * sign * svd.matrixV().transpose();
  c.rest = rest;
  c.scale = scale;
  for (Eigen::Index i = 0; i < 3; ++i) {
    const double off = std::acos(std::clamp(c.axes.row(i).dot(strokes.row(i)), -1.0, 1.0));
    if (off > largest_error_rad)
      throw InputError(
          fmt::format("the movements are not at right angles, or two were exchanged ({} is off by {:.0f} degrees)",
                      name[std::size_t(i)], off * 180 / 3.14159265358979));
  }
  if (const std::string why = calibration_error(c); !why.empty()) throw InputError(why);
  return c;
}

int calibrate_device(const DeviceToolOptions& options) {
  std::ostream& out = *options.out;
  // The old calibration may be invalid and must not prevent a new one.
  DeviceSession session(options, false);
  if (!session.streamed()) {
    out << session.profile().name << " needs no calibration: it moves a simulated arm\n";
    return 0;
  }
  if (!session.wait_for_device(5)) {
    out << "error: " << (session.remark().empty() ? session.name() + " gives no data" : session.remark()) << '\n';
    return 1;
  }
  out << "Each answer: Enter here, or the device's first button.\n";
  const std::array<const char*, 4> requests{
      "1 of 4: hold the device in the middle of where you want to work, as you would hold the instrument.",
      "2 of 4: move it 5 cm to the right.", "3 of 4: back to the middle, then 5 cm away from you, towards the screen.",
      "4 of 4: back to the middle, then 5 cm up."};
  std::array<Pose, 4> at;
  for (std::size_t i = 0; i < 4; ++i) {
    switch (session.ask(requests[i])) {
      case DeviceSession::Answer::yes: break;
      case DeviceSession::Answer::stopped: out << "nothing was changed\n"; return 1;
      case DeviceSession::Answer::lost: out << "error: the device was lost; nothing was changed\n"; return 1;
      case DeviceSession::Answer::no_answer: out << "error: no answer; nothing was changed\n"; return 1;
    }
    at[i] = held_pose(session);
  }
  const DeviceCalibration c = fit_calibration(at[0], at[1].p, at[2].p, at[3].p, options.scale);
  out << "calibration of " << session.name() << " saved in " << save_calibration(session.name(), c).string() << '\n';
  return 0;
}

}  // namespace insula
