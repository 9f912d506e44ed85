// SPDX-License-Identifier: GPL-3.0-or-later
// Lengths and points of a JSON file that counts in millimetres. `what` names the value in the message of an InputError.
#pragma once
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>

#include "core/base/math.h"
#include "core/model/formats/file_bytes.h"

namespace insula {

inline constexpr double json_millimetre = 1e-3;  ///< m

/// A finite number of millimetres, in m.
inline double length_mm(const std::filesystem::path& file, const nlohmann::json& value, const std::string& what) {
  if (!value.is_number() || !std::isfinite(value.get<double>())) fail(file, what + " must be a number (mm)");
  return value.get<double>() * json_millimetre;
}

/// Three of them, in m.
inline Vec3 point_mm(const std::filesystem::path& file, const nlohmann::json& value, const std::string& what) {
  if (!value.is_array() || value.size() != 3) fail(file, what + " must be three numbers (mm)");
  return {length_mm(file, value[0], what), length_mm(file, value[1], what), length_mm(file, value[2], what)};
}

}  // namespace insula
