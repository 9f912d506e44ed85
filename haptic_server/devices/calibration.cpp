// SPDX-License-Identifier: GPL-3.0-or-later
// Reading, checking and writing calibrations.
#include "haptic_server/devices/calibration.h"

#include <array>
#include <cctype>
#include <cmath>
#include <cstdlib>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/base/input_error.h"

namespace fs = std::filesystem;

namespace insula {
namespace {

constexpr std::uintmax_t largest_file = 64u << 10;

DeviceCalibration parse(std::istream& in) {
  const auto json = nlohmann::json::parse(in);
  const auto axes = json.at("axes").get<std::array<std::array<double, 3>, 3>>();
  const auto p = json.at("rest_p_m").get<std::array<double, 3>>();
  const auto q = json.at("rest_q").get<std::array<double, 4>>();
  DeviceCalibration c;
  for (std::size_t row = 0; row < 3; ++row)
    for (std::size_t column = 0; column < 3; ++column)
      c.axes(Eigen::Index(row), Eigen::Index(column)) = axes[row][column];
  c.rest.p = Vec3(p[0], p[1], p[2]);
  c.rest.q = Quat(q[0], q[1], q[2], q[3]);
  c.scale = json.at("scale").get<double>();
  return c;
}

}  // namespace

std::string calibration_error(const DeviceCalibration& c) {
  if (!c.axes.allFinite() || !c.rest.p.allFinite() || !c.rest.q.coeffs().allFinite() || !std::isfinite(c.scale))
    return "a number is not finite";
  if (!(c.axes * c.axes.transpose()).isIdentity(1e-6) || c.axes.determinant() < 0)
    return "axes: not a rotation (three rows of length 1, at right angles, right-handed)";
  if (c.rest.p.norm() > 2) return "rest_p_m: farther than 2 m from the device's origin";
  if (std::abs(c.rest.q.norm() - 1) > 1e-6) return "rest_q: not a unit quaternion";
  if (c.scale < DeviceCalibration::min_scale || c.scale > DeviceCalibration::largest_scale)
    return "scale: outside 0.05 to 5";
  return {};
}

fs::path calibration_folder() {
  const char* config = std::getenv("XDG_CONFIG_HOME");
  if (config != nullptr && *config == '/') return fs::path(config) / "insula" / "devices";
  const char* home = std::getenv("HOME");
  return fs::path(home != nullptr ? home : "/") / ".config" / "insula" / "devices";
}

fs::path calibration_file(const std::string& device) {
  std::string name;
  for (const char c : device) name += std::isalnum(static_cast<unsigned char>(c)) != 0 ? c : '_';
  return calibration_folder() / (name + ".json");
}

DeviceCalibration load_calibration(const std::string& device, const DeviceCalibration& fallback) {
  const fs::path file = calibration_file(device);
  std::error_code error;
  if (!fs::exists(file, error)) return fallback;
  std::string why;
  try {
    if (!fs::is_regular_file(file, error) || fs::file_size(file, error) > largest_file || error)
      throw InputError("not a file of this kind");
    std::ifstream in(file);
    const DeviceCalibration c = parse(in);
    why = calibration_error(c);
    if (why.empty()) return c;
  } catch (const std::exception& e) {
    why = e.what();
  }
  throw InputError(file.string() + ": " + why +
                   "; calibrate again with insula devices --calibrate, or delete the file");
}

fs::path save_calibration(const std::string& device, const DeviceCalibration& c) {
  if (const std::string why = calibration_error(c); !why.empty())
    throw InputError("calibration of " + device + ": " + why);
  nlohmann::json json;
  json["device"] = device;
  for (Eigen::Index row = 0; row < 3; ++row) json["axes"].push_back({c.axes(row, 0), c.axes(row, 1), c.axes(row, 2)});
  json["rest_p_m"] = {c.rest.p.x(), c.rest.p.y(), c.rest.p.z()};
  json["rest_q"] = {c.rest.q.w(), c.rest.q.x(), c.rest.q.y(), c.rest.q.z()};
  json["scale"] = c.scale;
  const fs::path file = calibration_file(device), part = file.string() + ".part";
  std::error_code error;
  fs::create_directories(file.parent_path(), error);
  std::ofstream out(part);
  out << json.dump(2) << '\n';
  out.close();
  // Renamed only when complete, so that a full disk does not leave an incomplete calibration.
  if (out) fs::rename(part, file, error);
  if (!out || error) throw InputError(file.string() + ": cannot be written");
  return file;
}

}  // namespace insula
