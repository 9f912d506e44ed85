// SPDX-License-Identifier: GPL-3.0-or-later
// Reads the scene's motion, homes and view.
#include "haptic_server/scene_setup.h"

#include <cmath>
#include <fstream>
#include <nlohmann/json.hpp>

#include "core/base/input_error.h"

namespace insula {
namespace {

constexpr std::uintmax_t largest_scene_json = 16u << 20;

void read_view(const nlohmann::json& view, SceneSetup& into) {
  const auto vector = [&](const char* name) {
    const auto v = view.at(name).get<std::array<double, 3>>();
    return Vec3(v[0], v[1], v[2]);
  };
  const Vec3 away = vector("target") - vector("eye"), right = away.cross(vector("up"));
  if (!away.allFinite() || !right.allFinite() || away.norm() < 1e-9 || right.norm() < 1e-9 * away.norm()) return;
  Mat3 axes;
  axes.col(0) = right.normalized();
  axes.col(1) = away.normalized();
  axes.col(2) = axes.col(0).cross(axes.col(1));
  into.person_to_scene = Quat(axes);
}

void read_bundle(const std::filesystem::path& file, SceneSetup& into) {
  std::error_code none;
  if (!std::filesystem::is_regular_file(file, none) || std::filesystem::file_size(file, none) > largest_scene_json)
    return;
  std::ifstream in(file);
  const auto json = nlohmann::json::parse(in);
  if (json.contains("view")) read_view(json.at("view"), into);
  if (json.contains("force_scale"))
    if (const double scale = json.at("force_scale").get<double>(); scale >= 0.1 && scale <= 10)
      into.force_scale = scale;
  if (!json.contains("hands")) return;
  for (const auto& hand : json.at("hands")) {
    const std::string name = hand.at("hand").get<std::string>();
    if (name != "left" && name != "right") continue;
    const std::size_t i = name == "right" ? 1 : 0;
    const auto p = hand.at("home_p_m").get<std::array<double, 3>>();
    const auto q = hand.at("home_q").get<std::array<double, 4>>();
    Pose pose{Vec3(p[0], p[1], p[2]), Quat(q[0], q[1], q[2], q[3])};
    const double length = pose.q.norm();
    if (!(pose.p.norm() < 10) || !(std::abs(length - 1) < 1e-2)) continue;
    pose.q.normalize();
    into.home[i] = pose;
    into.has_home[i] = true;
  }
}

}  // namespace

SceneSetup read_scene_setup(std::int64_t session, const std::string& motion_file, const std::filesystem::path& bundle) {
  SceneSetup setup;
  setup.session = session;
  try {
    if (!motion_file.empty()) setup.motion = load_motion(motion_file);
  } catch (const std::exception& e) {
    setup.problem = e.what();
  }
  try {
    if (!bundle.empty()) read_bundle(bundle / "scene.json", setup);
  } catch (const std::exception& e) {
    if (setup.problem.empty()) setup.problem = "scene.json of the bundle: " + std::string(e.what());
  }
  return setup;
}

void SetupExchange::give(std::unique_ptr<const SceneSetup> setup) {
  // When the servo uses the newest setup, the others are no longer in use.
  if (!owned_.empty() && in_use_.load(std::memory_order_acquire) == owned_.back().get())
    owned_.erase(owned_.begin(), owned_.end() - 1);
  owned_.push_back(std::move(setup));
  next_.store(owned_.back().get(), std::memory_order_release);
}

}  // namespace insula
