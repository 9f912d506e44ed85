// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/room_access.h"

#include <utility>

#include "core/base/pin.h"
#include "viewer/gateway/json_input.h"
#include "viewer/gateway/replace_file.h"

namespace insula::gateway {

RoomAccess::RoomAccess(Secrets secrets, std::filesystem::path kept, std::function<void(const Secrets&)> changed)
    : secrets_(std::move(secrets)), kept_(std::move(kept)), changed_(std::move(changed)) {}

ApiAnswer RoomAccess::state() const {
  return answer_with(nlohmann::ordered_json{{"pin", secrets_.pin},
                                            {"observer_pin", secrets_.observer_pin},
                                            {"key", secrets_.key},
                                            {"key_kept", !kept_.empty()},
                                            {"reachable", reachable_}});
}

ApiAnswer RoomAccess::make_pins() {
  if (!secrets_.pin.empty()) return refusal(409, "there are PINs already");
  secrets_.pin = new_pin();
  secrets_.observer_pin = new_pin(secrets_.pin);
  changed_(secrets_);
  return state();
}

ApiAnswer RoomAccess::keep(const std::string& key) {
  if (kept_.empty()) return refusal(409, "this gateway was started with its key");
  if (!is_key(key)) return refusal(400, "a key is one line of 32 to 128 letters, digits, - and _");
  if (!replace_file(kept_, key + "\n", true)) return refusal(500, "the key cannot be kept");
  secrets_.key = key;
  changed_(secrets_);
  return state();
}

ApiAnswer RoomAccess::change(const std::string& text) {
  const auto json = nlohmann::json::parse(text, nullptr, false);
  const std::string make = text_of(json, "make");
  if (make == "pins") return make_pins();
  if (make == "key") return secrets_.key.empty() ? keep(new_key()) : refusal(409, "there is a key already");
  return keep(text_of(json, "key"));
}

}  // namespace insula::gateway
