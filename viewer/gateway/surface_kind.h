// SPDX-License-Identifier: GPL-3.0-or-later
// Which surface format bytes are, by their content. The name of a file says nothing about it.
#pragma once
#include <string>
#include <string_view>

namespace insula::gateway {

struct SurfaceKind {
  std::string extension;  ///< as the case builder reads it, such as ".stl"; empty: refused
  std::string refused;    ///< why, for the author
};

SurfaceKind surface_kind(std::string_view bytes);

}  // namespace insula::gateway
