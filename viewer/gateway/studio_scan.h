// SPDX-License-Identifier: GPL-3.0-or-later
// Scans in projects of the case builder's page. The author's file is read once. What is kept has its voxels and their
// places, and no other tags. The file itself goes, since it may name a person.
#pragma once
#include <filesystem>
#include <string>

#include "viewer/gateway/scan_kind.h"
#include "viewer/gateway/studio_projects.h"

namespace insula::gateway {

struct UploadKind : SurfaceKind {
  bool scan = false;
  unsigned status = 415;  ///< of a refusal
  /// Where its project keeps it.
  std::string input() const { return (scan ? "upload/scan" : "input") + extension; }
};

/// By its content. Throws InputError if it cannot be read.
UploadKind kind_of_upload(const std::filesystem::path& content);

bool is_scan(const StudioProject& project);
bool scan_is_read(const StudioProject& project);
/// Whether the author has said what in the scan is vessel.
bool has_level(const StudioProject& project);
/// The words of a command, for the program: with the strokes in a file of the folder. Throws InputError.
std::vector<std::string> with_strokes(std::vector<std::string> words, const StudioProject& project,
                                      const std::filesystem::path& project_folder);
/// Of what the page sees of the scan, ".json" and ".raw".
std::filesystem::path scan_file(const std::filesystem::path& project_folder, const char* extension);

}  // namespace insula::gateway
