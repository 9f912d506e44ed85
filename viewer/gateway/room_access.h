// SPDX-License-Identifier: GPL-3.0-or-later
// What admits other machines, as pages on this machine see it and make it. Used on the network thread.
#pragma once
#include <filesystem>
#include <functional>
#include <string>

#include "viewer/gateway/api_answer.h"
#include "viewer/gateway/secrets.h"

namespace insula::gateway {

class RoomAccess {
 public:
  /// kept: file for a key that is made or taken here; empty: none can be. changed: gets the secrets after a change.
  RoomAccess(Secrets secrets, std::filesystem::path kept, std::function<void(const Secrets&)> changed);

  void set_reachable(bool reachable) { reachable_ = reachable; }

  /// {pin, observer_pin, key: empty where there is none; key_kept: the key may be made or taken here; reachable: other
  /// machines reach this station}
  ApiAnswer state() const;
  /// json: {"make": "pins"}, until this program ends; {"make": "key"}; or {"key": the one of another station}. The
  /// state, or why nothing was changed. Only a taken key replaces another one.
  ApiAnswer change(const std::string& json);

 private:
  ApiAnswer make_pins();
  ApiAnswer keep(const std::string& key);

  Secrets secrets_;
  std::filesystem::path kept_;
  std::function<void(const Secrets&)> changed_;
  bool reachable_ = false;
};

}  // namespace insula::gateway
