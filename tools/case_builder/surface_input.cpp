// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/surface_input.h"

#include "core/model/formats/file_bytes.h"
#include "core/model/geometry/box_tree.h"
#include "tools/case_builder/vtp_reader.h"
#include "tools/case_builder/vtu_surface.h"
#ifdef INSULA_WITH_HDF5
#include "tools/case_builder/hdf5_surface.h"
#endif

namespace insula::case_builder {

namespace {

TriMesh read_file(const std::filesystem::path& file) {
  const std::string kind = lower_extension(file);
  if (kind == ".vtp") return read_vtp(file);
  if (kind == ".vtu") return read_vtu_surface(file);
  if (kind != ".h5" && kind != ".hdf5") return read_surface(file, 1.0);
#ifdef INSULA_WITH_HDF5
  return read_hdf5_surface(file);
#else
  fail(file, "needs HDF5 (Debian: libhdf5-dev), which was not there when this program was built");
#endif
}

}  // namespace

bool is_in_metres(const std::filesystem::path& file) {
  const std::string kind = lower_extension(file);
  return kind == ".gltf" || kind == ".glb";
}

double unit_mm(const std::filesystem::path& file, const std::optional<double>& given) {
  return given.value_or(is_in_metres(file) ? 1000 : 1);
}

TriMesh read_any_surface(const std::filesystem::path& file, double unit) {
  TriMesh m = read_file(file);
  for (Vec3& p : m.vertices) p *= unit;
  return m;
}

double extent_of(const TriMesh& m) {
  Box box;
  for (const Vec3& p : m.vertices) box.extend(p);
  return m.vertices.empty() ? 0 : box.diagonal().norm();
}

}  // namespace insula::case_builder
