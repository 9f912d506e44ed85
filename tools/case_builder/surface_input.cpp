// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/surface_input.h"

#include "core/model/formats/file_bytes.h"
#include "core/model/geometry/box_tree.h"
#include "tools/case_builder/vtp_reader.h"

namespace insula::case_builder {

bool is_in_metres(const std::filesystem::path& file) {
  const std::string kind = lower_extension(file);
  return kind == ".gltf" || kind == ".glb";
}

double unit_mm(const std::filesystem::path& file, const std::optional<double>& given) {
  return given.value_or(is_in_metres(file) ? 1000 : 1);
}

TriMesh read_any_surface(const std::filesystem::path& file, double unit) {
  TriMesh m = lower_extension(file) == ".vtp" ? read_vtp(file) : read_surface(file, 1.0);
  for (Vec3& p : m.vertices) p *= unit;
  return m;
}

double extent_of(const TriMesh& m) {
  Box box;
  for (const Vec3& p : m.vertices) box.extend(p);
  return m.vertices.empty() ? 0 : box.diagonal().norm();
}

}  // namespace insula::case_builder
