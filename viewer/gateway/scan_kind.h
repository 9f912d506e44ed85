// SPDX-License-Identifier: GPL-3.0-or-later
// Which scan format a file has, by its content.
#pragma once
#include <cstdint>
#include <string_view>

#include "viewer/gateway/surface_kind.h"

namespace insula::gateway {

/// Large scans have some 80 million voxels of two bytes, and few are compressed.
inline constexpr std::uint64_t most_scan_bytes = 700'000'000;
inline constexpr const char* too_large_scan = "this file is too large: 700 MB are taken";
/// So much of a file's beginning tells its kind.
inline constexpr std::size_t scan_head_bytes = 65536;

/// head: the beginning of a file. Both texts of the answer are empty if it is no scan.
SurfaceKind scan_kind(std::string_view head);

}  // namespace insula::gateway
