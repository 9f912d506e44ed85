// SPDX-License-Identifier: GPL-3.0-or-later
// Reading and writing the Inverse Service's messages.
#include "haptic_server/devices/haply_messages.h"

#include <fmt/format.h>

#include <cmath>
#include <nlohmann/json.hpp>

namespace insula {
namespace {

using Json = nlohmann::json;

constexpr std::size_t max_devices = 16, longest_id = 64;

const Json* member(const Json& j, const char* name) {
  if (!j.is_object()) return nullptr;
  const auto found = j.find(name);
  return found == j.end() ? nullptr : &*found;
}

bool number(const Json& j, const char* name, double& into) {
  const Json* m = member(j, name);
  if (m == nullptr || !m->is_number()) return false;
  into = m->get<double>();
  return std::isfinite(into);
}

std::optional<Vec3> vector(const Json* j) {
  Vec3 v;
  if (j == nullptr || !number(*j, "x", v.x()) || !number(*j, "y", v.y()) || !number(*j, "z", v.z()))
    return std::nullopt;
  return v;
}

std::optional<Quat> quaternion(const Json* j) {
  Quat q;
  if (j == nullptr || !number(*j, "x", q.x()) || !number(*j, "y", q.y()) || !number(*j, "z", q.z()) ||
      !number(*j, "w", q.w()))
    return std::nullopt;
  const double length = q.norm();
  if (!(std::abs(length - 1) < 0.05)) return std::nullopt;
  q.normalize();
  return q;
}

std::string word(const Json* j) {
  if (j == nullptr || !j->is_string()) return {};
  const std::string& s = j->get_ref<const std::string&>();
  // Ids are used in commands, so quotes and control characters are refused.
  if (s.empty() || s.size() > longest_id) return {};
  for (const char c : s)
    if (c < ' ' || c == '"' || c == '\\' || c == 127) return {};
  return s;
}

bool flag(const Json* j, const char* name, bool fallback) {
  const Json* m = j != nullptr ? member(*j, name) : nullptr;
  return m != nullptr && m->is_boolean() ? m->get<bool>() : fallback;
}

void read_arm(const Json& j, HaplyState& state) {
  HaplyArm arm;
  arm.id = word(member(j, "device_id"));
  if (arm.id.empty()) return;
  if (const Json* config = member(j, "config")) {
    arm.handedness = word(member(*config, "handedness"));
    arm.type = word(member(*config, "type"));
  }
  const Json* status = member(j, "status");
  arm.ready = flag(status, "ready", true);
  if (const Json* s = member(j, "state")) {
    arm.p_m = vector(member(*s, "cursor_position"));
    arm.v_m_s = vector(member(*s, "cursor_velocity"));
  }
  state.arms.push_back(std::move(arm));
}

void read_grip(const Json& j, HaplyState& state) {
  HaplyGrip grip;
  grip.id = word(member(j, "device_id"));
  if (grip.id.empty()) return;
  if (const Json* s = member(j, "state")) {
    grip.q = quaternion(member(*s, "orientation"));
    const Json* buttons = member(*s, "buttons");
    grip.button1 = flag(buttons, "a", flag(s, "button", false));
    grip.button2 = flag(buttons, "b", false);
  }
  state.grips.push_back(std::move(grip));
}

}  // namespace

bool parse_haply(std::string_view text, HaplyState& state, std::string& why) {
  state = HaplyState{};
  const Json json = Json::parse(text.begin(), text.end(), nullptr, false);
  if (json.is_discarded() || !json.is_object()) {
    why = "not a JSON object";
    return false;
  }
  state.named_vector = member(json, "session_id") != nullptr;
  bool any = false;
  for (const char* list : {"inverse3", "verse_grip", "wireless_verse_grip"}) {
    const Json* devices = member(json, list);
    if (devices == nullptr) continue;
    if (!devices->is_array() || devices->size() > max_devices) {
      why = std::string(list) + " is no list of devices";
      return false;
    }
    any = true;
    for (const Json& device : *devices)
      std::string_view(list) == "inverse3" ? read_arm(device, state) : read_grip(device, state);
  }
  if (!any) why = "no list of devices";
  return any;
}

std::string haply_force(const std::string& arm, const Vec3& force_N, bool named_vector, bool introduce) {
  return fmt::format(
      R"({{{}"inverse3":[{{"device_id":"{}","commands":{{"set_cursor_force":{{"{}":{{"x":{:.5f},"y":{:.5f},"z":{:.5f}}}}}}}}}]}})",
      introduce ? R"("session":{"configure":{"profile":{"name":"org.insula:haptic_server"}}},)" : "", arm,
      named_vector ? "vector" : "values", force_N.x(), force_N.y(), force_N.z());
}

}  // namespace insula
