// SPDX-License-Identifier: GPL-3.0-or-later
// Moves and their CSV.
#include "tools/motions/hands.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "core/base/input_error.h"

namespace insula {

Hands::Hands(Simulation& simulation) : simulation_(simulation) {
  for (int h = 0; h < 2; ++h)
    if (const Instrument* tool = simulation.instrument_of(h)) now_[h].pose = tool->home_pose();
  key();
}

void Hands::key() {
  const char* names[] = {"left", "right"};
  for (int h = 0; h < 2; ++h) {
    Quat q = now_[h].pose.q;
    if (q.w() < 0) q.coeffs() *= -1;
    const Vec3& p = now_[h].pose.p;
    rows_.push_back(fmt::format("{:.4f},{},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f},{:.5f},{},0", simulation_.time(),
                                names[h], p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z(), int(now_[h].button1)));
  }
}

void Hands::move(double seconds, const Wish& left, const Wish& right) {
  const int steps = 3 * std::max(1, int(std::lround(seconds / simulation_.h() / 3)));
  const Wish from[2] = {now_[0], now_[1]}, to[2] = {left, right};
  for (int i = 1; i <= steps; ++i) {
    const double u = double(i) / steps, s = u * u * u * (10 - 15 * u + 6 * u * u);
    for (int h = 0; h < 2; ++h) {
      now_[h].pose.p = from[h].pose.p + s * (to[h].pose.p - from[h].pose.p);
      now_[h].pose.q = from[h].pose.q.slerp(s, to[h].pose.q).normalized();
      now_[h].button1 = to[h].button1;
      simulation_.set_hand(h, {true, now_[h].pose, now_[h].button1, false});
    }
    simulation_.step();
    if (!simulation_.report().finite) throw InputError("the simulation has left the finite numbers");
    if (i % 3 == 0) key();
  }
}

void Hands::write(const std::filesystem::path& file) const {
  std::ofstream out(file, std::ios::binary);
  out << "time_s,hand,px_m,py_m,pz_m,qw,qx,qy,qz,button1,button2\n";
  for (const std::string& r : rows_) out << r << '\n';
  if (!out.flush()) throw InputError(file.string() + ": cannot be written");
}

Pose tool_pose(const Vec3& p, const Vec3& shaft, const Vec3& across) {
  const Vec3 z = shaft.normalized(), y = (across - across.dot(z) * z).normalized();
  Mat3 m;
  m << y.cross(z), y, z;
  return {p, Quat(m).normalized()};
}

}  // namespace insula
