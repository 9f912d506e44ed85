// SPDX-License-Identifier: GPL-3.0-or-later
// The tables of a session as files for other programs.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "engine/session/session_reader.h"

namespace insula {

/// Writes hands, every tick of the servo, channels, metrics and events as .csv or .json files into a folder, which is
/// created. Times are simulated seconds since the recording began, except for time_s of metrics and channels, which
/// begins again with each pass. format: "csv" or "json". Returns the files. Throws InputError if one cannot be written.
std::vector<std::filesystem::path> export_tables(SessionReader& session, const std::filesystem::path& folder,
                                                 const std::string& format);

/// Writes the messages on hands, on the servo's ticks and the events as a log that lcm-logplayer plays. Returns their
/// number. Throws InputError if it cannot be written.
std::int64_t export_lcm_log(SessionReader& session, const std::filesystem::path& file);

}  // namespace insula
