// SPDX-License-Identifier: GPL-3.0-or-later
#include "viewer/gateway/surface_kind.h"

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <nlohmann/json.hpp>

#include "core/base/text.h"

namespace insula::gateway {
namespace {

using Json = nlohmann::json;

constexpr const char* no_surface = "this file is no surface: STL, OBJ, PLY, OFF, glTF, VTP, VTU and HDF5 are taken";

/// A header of 80 bytes, a count, and 50 bytes for each triangle.
bool is_binary_stl(std::string_view bytes) {
  if (bytes.size() < 84) return false;
  std::uint32_t triangles = 0;
  std::memcpy(&triangles, bytes.data() + 80, 4);
  return triangles > 0 && bytes.size() == 84 + 50 * std::uint64_t(triangles);
}

/// A text whose first statement that is neither blank nor a comment is one of OBJ.
bool is_obj(std::string_view bytes) {
  static constexpr std::string_view begins[] = {"v ", "vn ", "vt ", "o ", "g ", "mtllib ", "s ", "usemtl "};
  bytes = bytes.substr(0, 64 * 1024);
  if (bytes.find('\0') != std::string_view::npos) return false;
  while (!bytes.empty()) {
    const std::size_t end = std::min(bytes.find('\n'), bytes.size());
    const std::string_view line = trim(bytes.substr(0, end));
    bytes.remove_prefix(std::min(end + 1, bytes.size()));
    if (line.empty() || line.front() == '#') continue;
    return std::any_of(std::begin(begins), std::end(begins), [&](std::string_view b) { return line.starts_with(b); });
  }
  return false;
}

/// Whether nothing in it names another file.
bool stands_alone(const Json& gltf) {
  for (const char* list : {"buffers", "images"}) {
    if (!gltf.contains(list) || !gltf[list].is_array()) continue;
    for (const Json& one : gltf[list])
      if (one.is_object() && one.contains("uri") &&
          (!one["uri"].is_string() || !one["uri"].get_ref<const std::string&>().starts_with("data:")))
        return false;
  }
  return true;
}

SurfaceKind gltf_kind(std::string_view text, const char* extension) {
  const Json json = Json::parse(text, nullptr, false);
  if (!json.is_object() || !json.contains("asset")) return {"", no_surface};
  if (!stands_alone(json)) return {"", "this glTF needs other files: write it as one .glb file"};
  return {extension, ""};
}

/// The first chunk of a .glb file is its JSON (glTF 2.0, section 4.4).
SurfaceKind glb_kind(std::string_view bytes) {
  std::uint32_t length = 0;
  if (bytes.size() < 20) return {"", no_surface};
  std::memcpy(&length, bytes.data() + 12, 4);
  if (length > bytes.size() - 20 || bytes.substr(16, 4) != "JSON") return {"", no_surface};
  return gltf_kind(bytes.substr(20, length), ".glb");
}

}  // namespace

SurfaceKind surface_kind(std::string_view bytes) {
  if (bytes.empty()) return {"", "this file is empty"};
  const std::string_view head = bytes.substr(0, 4096);
  const std::string_view begins = trim(head);
  if (bytes.starts_with("ply\n") || bytes.starts_with("ply\r")) return {".ply", ""};
  if (bytes.starts_with("\x89HDF\r\n\x1a\n")) return {".h5", ""};
  if (bytes.starts_with("glTF")) return glb_kind(bytes);
  if (is_binary_stl(bytes)) return {".stl", ""};
  if (begins.starts_with("solid") && head.find("facet") != std::string_view::npos) return {".stl", ""};
  if (begins.starts_with("OFF")) return {".off", ""};
  if (begins.starts_with("{")) return gltf_kind(bytes, ".gltf");
  if (begins.starts_with("<") && head.find("<VTKFile") != std::string_view::npos) {
    if (head.find("PolyData") != std::string_view::npos) return {".vtp", ""};
    if (head.find("UnstructuredGrid") != std::string_view::npos) return {".vtu", ""};
    return {"", "this VTK file holds no surface: write it as PolyData (.vtp)"};
  }
  if (is_obj(bytes)) return {".obj", ""};
  return {"", no_surface};
}

}  // namespace insula::gateway
