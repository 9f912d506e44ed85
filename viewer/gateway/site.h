// SPDX-License-Identifier: GPL-3.0-or-later
// What the connections of a gateway share. Used on the network thread.
#pragma once
#include <filesystem>

#include "viewer/gateway/access.h"
#include "viewer/gateway/audit.h"
#include "viewer/gateway/hub.h"
#include "viewer/gateway/login_api.h"
#include "viewer/gateway/logins.h"
#include "viewer/gateway/room.h"
#include "viewer/gateway/room_access.h"
#include "viewer/gateway/sessions.h"
#include "viewer/gateway/station.h"
#include "viewer/gateway/studio.h"
#include "viewer/gateway/training_api.h"

namespace insula::gateway {

/// The built page.
struct PageFolder {
  std::filesystem::path folder;  ///< empty: it is not built
  bool start = false;            ///< "/" is the start page, else that of the exercise
};

struct Site {
  Hub& hub;
  const AllowedHosts& hosts;
  const PageFolder& page;
  const Sessions& sessions;
  TrainingApi& training;
  Logins& logins;
  LoginApi& login_api;
  Audit& audit;
  const IsHere& is_here;
  Station& station;
  Room& room;
  RoomAccess& room_access;
  Studio& studio;
};

}  // namespace insula::gateway
