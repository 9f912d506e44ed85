// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/hdf5_surface.h"

// Debian 12 has version 1.10, Debian 13 a later one with the same interface on request.
#define H5_USE_110_API
#include <hdf5.h>

#include <algorithm>
#include <string>

#include "core/model/formats/file_bytes.h"
#include "tools/case_builder/cell_surface.h"

namespace insula::case_builder {
namespace {

namespace fs = std::filesystem;

constexpr hsize_t most_rows = 20'000'000;

/// A handle of the library.
template <herr_t (*close)(hid_t)>
class Handle {
 public:
  explicit Handle(hid_t id) : id_(id) {}
  ~Handle() {
    if (id_ >= 0) close(id_);
  }
  Handle(const Handle&) = delete;
  Handle& operator=(const Handle&) = delete;
  operator hid_t() const { return id_; }

 private:
  hid_t id_;
};
using File = Handle<H5Fclose>;
using Set = Handle<H5Dclose>;
using Space = Handle<H5Sclose>;
using Type = Handle<H5Tclose>;
using List = Handle<H5Pclose>;

bool is_points(std::string_view name) { return name == "coordinates" || name == "geometry"; }
constexpr std::string_view topology = "topology";

/// Groups that hold points and a topology.
struct Found {
  std::vector<std::string> points, cells;  ///< paths of datasets
};

herr_t visit(hid_t, const char* path, const H5O_info_t* info, void* to) {
  if (info->type != H5O_TYPE_DATASET) return 0;
  Found& found = *static_cast<Found*>(to);
  const std::string_view all(path), name = all.substr(all.find_last_of('/') + 1);
  if (is_points(name)) found.points.emplace_back(path);
  if (name == topology) found.cells.emplace_back(path);
  return 0;
}

std::string folder_of(const std::string& path) { return path.substr(0, path.find_last_of('/') + 1); }

class Reader {
 public:
  Reader(const fs::path& path, hid_t file) : path_(path), file_(file) {}

  /// Rows of `columns` numbers.
  template <class T>
  std::vector<T> rows(const std::string& name, hid_t as, H5T_class_t kind, hsize_t& columns) const {
    const Set set(H5Dopen2(file_, name.c_str(), H5P_DEFAULT));
    if (set < 0) fail(path_, "its " + name + " cannot be opened");
    const List made(H5Dget_create_plist(set));
    if (H5Pget_layout(made) == H5D_VIRTUAL || H5Pget_external_count(made) != 0)
      fail(path_, "its " + name + " lies in another file");
    const Type type(H5Dget_type(set));
    const Space space(H5Dget_space(set));
    hsize_t size[2] = {0, 0};
    if (H5Tget_class(type) != kind || H5Sget_simple_extent_ndims(space) != 2 ||
        H5Sget_simple_extent_dims(space, size, nullptr) != 2)
      fail(path_, "its " + name + " is no table of " + (kind == H5T_FLOAT ? "numbers" : "whole numbers"));
    columns = size[1];
    if (size[0] == 0 || size[0] > most_rows || columns < 3 || columns > 10)
      fail(path_, "its " + name + " has " + std::to_string(size[0]) + " rows of " + std::to_string(columns));
    std::vector<T> out(size[0] * columns);
    if (H5Dread(set, as, H5S_ALL, H5S_ALL, H5P_DEFAULT, out.data()) < 0)
      fail(path_, "its " + name + " cannot be read, or ends early");
    return out;
  }

 private:
  fs::path path_;
  hid_t file_;
};

/// The paths of points and cells of one group.
std::pair<std::string, std::string> mesh_of(const fs::path& path, hid_t file) {
  Found found;
  H5Ovisit(file, H5_INDEX_NAME, H5_ITER_INC, visit, &found);
  std::stable_sort(found.points.begin(), found.points.end(), [](const std::string& a, const std::string& b) {
    return folder_of(a) == "mesh/" && folder_of(b) != "mesh/";
  });
  for (const std::string& points : found.points)
    for (const std::string& cells : found.cells)
      if (folder_of(points) == folder_of(cells)) return {points, cells};
  fail(path, "holds no mesh: a group with coordinates and topology, such as /mesh of FEniCS");
}

}  // namespace

TriMesh read_hdf5_surface(const fs::path& path) {
  H5Eset_auto2(H5E_DEFAULT, nullptr, nullptr);  // what matters is said here
  H5PLset_loading_state(0);
  if (!fs::exists(path)) fail(path, "does not exist");
  const File file(H5Fopen(path.c_str(), H5F_ACC_RDONLY, H5P_DEFAULT));
  if (file < 0) fail(path, "is no HDF5 file, or is damaged");
  const auto [points_name, cells_name] = mesh_of(path, file);
  const Reader in(path, file);
  hsize_t columns = 0, corners = 0;
  const std::vector<double> x = in.rows<double>(points_name, H5T_NATIVE_DOUBLE, H5T_FLOAT, columns);
  if (columns != 3) fail(path, "its " + points_name + " has " + std::to_string(columns) + " numbers a point, not 3");
  std::vector<Vec3> points;
  for (std::size_t i = 0; i < x.size(); i += 3) {
    points.emplace_back(x[i], x[i + 1], x[i + 2]);
    if (!points.back().allFinite()) fail(path, "point " + std::to_string(i / 3) + " is not finite");
  }
  const std::vector<std::int64_t> cells = in.rows<std::int64_t>(cells_name, H5T_NATIVE_INT64, H5T_INTEGER, corners);
  if (corners != 3 && corners != 4 && corners != 10)
    fail(path, "its cells have " + std::to_string(corners) + " points; triangles and tetrahedra are read");
  CellSurface out(path, points);
  for (std::size_t c = 0; c < cells.size(); c += corners) {
    if (corners == 3) out.add_face(&cells[c], 3);
    else out.add_volume(&cells[c], 4);
  }
  return out.surface();
}

}  // namespace insula::case_builder
