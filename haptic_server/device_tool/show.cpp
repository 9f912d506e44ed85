// SPDX-License-Identifier: GPL-3.0-or-later
// Lists devices, shows one live, tests its force.
#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <filesystem>
#include <ostream>

#include "core/base/input_error.h"
#include "haptic_server/device_tool/device_session.h"
#include "haptic_server/devices/device_kinds.h"

namespace insula {
namespace {

/// The test ends if the arm moves too far or too fast.
constexpr double farthest_m = 0.08, fastest_m_s = 0.6;
constexpr double push_s = 1.5, pause_s = 0.5;

std::string calibrated(const DeviceKind& kind, const DeviceWish& wish) {
  std::string text;
  std::vector<std::string> names;
  if (wish.which.empty()) names = {wish.calibration_name(0), wish.calibration_name(1)};
  else names = {wish.calibration_name(0)};
  for (const std::string& name : names) {
    std::error_code error;
    if (!std::filesystem::exists(calibration_file(name), error)) continue;
    try {
      load_calibration(name, kind.calibration);
      text += ", calibrated" + (names.size() > 1 ? " (" + name + ")" : std::string());
    } catch (const InputError& e) {
      text += std::string(", calibration unusable: ") + e.what();
    }
  }
  return text;
}

int not_there(const DeviceSession& session, std::ostream& out) {
  out << "error: " << (session.remark().empty() ? session.name() + " gives no data" : session.remark()) << '\n';
  return 1;
}

}  // namespace

int list_devices(std::ostream& out) {
  for (const DeviceKind& kind : all_device_kinds()) {
    const DeviceSearch found = kind.search();
    out << fmt::format("{:<15} {}\n", kind.name, kind.summary);
    if (!kind.real) continue;
    if (!found.missing.empty())
      out << fmt::format("    not usable: {}\n    to get it: {}\n", found.missing, kind.how_to_get);
    else if (found.devices.empty()) out << "    none is plugged in\n";
    for (const FoundDevice& device : found.devices) {
      const DeviceWish wish{kind.name, device.which};
      out << fmt::format("    {:<28} {}{}\n", wish.text(), device.label, calibrated(kind, wish));
    }
  }
  return 0;
}

int show_device(const DeviceToolOptions& options) {
  std::ostream& out = *options.out;
  DeviceSession session(options);
  if (!session.wait_for_device(5)) return not_there(session, out);
  const DeviceProfile& p = session.profile();
  out << fmt::format("{}: up to {:.1f} N{}, workspace {:.0f} x {:.0f} x {:.0f} mm\n", session.name(), p.max_force_N,
                     p.max_torque_Nm > 0 ? fmt::format(" and {:.2f} N m", p.max_torque_Nm) : std::string(),
                     1e3 * p.workspace_m.x(), 1e3 * p.workspace_m.y(), 1e3 * p.workspace_m.z());
  bool there = true;
  for (double t = 0; options.seconds <= 0 || t < options.seconds; t += 0.1) {
    const DeviceSession::State s = session.state();
    there = s.reading.connected;
    const Vec3 x = 1e3 * s.reading.pose.p, r = rotation_vector(s.reading.pose.q) * (180 / 3.14159265358979);
    if (there)
      out << fmt::format(
          "right {:7.1f}  away {:7.1f}  up {:7.1f} mm   turned {:6.1f} {:6.1f} {:6.1f} deg   speed {:5.0f} mm/s   "
          "buttons {}{}   force {:.2f} N\n",
          x.x(), x.y(), x.z(), r.x(), r.y(), r.z(), 1e3 * s.reading.v.norm(), s.reading.button1 ? '1' : '-',
          s.reading.button2 ? '2' : '-', s.force.norm());
    else out << "not connected" << (session.remark().empty() ? "" : ": ") << session.remark() << '\n';
    out.flush();
    if (!session.wait(0.1)) break;
  }
  return there ? 0 : 1;
}

int test_device_force(const DeviceToolOptions& options) {
  std::ostream& out = *options.out;
  DeviceSession session(options);
  const DeviceKind* kind = find_device_kind(session.profile().name);
  if (kind == nullptr || !kind->force) {
    out << session.profile().name << " gives no forces to the hand\n";
    return 2;
  }
  if (!session.wait_for_device(5)) return not_there(session, out);
  const double most = std::min(session.profile().max_force_N, 3.0);
  if (!(options.newtons > 0) || options.newtons > most) {
    out << fmt::format("error: the force must be above 0 and at most {:.1f} N for this device\n", most);
    return 2;
  }
  if (!options.assume_yes) {
    const auto answer = session.ask(fmt::format(
        "The device will push with up to {:.1f} N: to the right and left, away and back, up and down. Hold it loosely, "
        "keep your face away.\n"
        "Enter here, or the device's first button: begin. Its first button while it pushes, or Ctrl-C: end.",
        options.newtons));
    if (answer != DeviceSession::Answer::yes) {
      out << (answer == DeviceSession::Answer::lost ? "error: the device was lost\n" : "nothing was done\n");
      return 1;
    }
    for (int i = 0; i < 300 && session.state().reading.button1; ++i) session.wait(0.01);
  }
  const std::array<const char*, 6> name{"right", "left", "away", "back", "up", "down"};
  for (std::size_t i = 0; i < 6; ++i) {
    const Vec3 start = session.state().reading.pose.p;
    Vec3 push = Vec3::Zero();
    push[Eigen::Index(i / 2)] = i % 2 == 0 ? options.newtons : -options.newtons;
    session.push(push);
    double strongest = 0, farthest = 0;
    for (double t = 0; t < push_s; t += 0.01) {
      const DeviceSession::State s = session.state();
      strongest = std::max(strongest, s.force.norm());
      farthest = std::max(farthest, (s.reading.pose.p - start).norm());
      const char* why = !s.reading.connected                                        ? "the device was lost"
                        : s.reading.button1                                         ? "its button was pressed"
                        : session.told_to_stop()                                    ? "it was told to stop"
                        : farthest > farthest_m || s.reading.v.norm() > fastest_m_s ? "it ran away from the hand"
                                                                                    : nullptr;
      if (why != nullptr) {
        session.push(Vec3::Zero());
        out << "ended: " << why << '\n';
        return 1;
      }
      session.wait(0.01);
    }
    session.push(Vec3::Zero());
    out << fmt::format("{:<6} {:.2f} N sent, moved {:.1f} mm\n", name[i], strongest, 1e3 * farthest) << std::flush;
    if (!session.wait(pause_s)) return 1;
  }
  out << "the force test is done\n";
  return 0;
}

}  // namespace insula
