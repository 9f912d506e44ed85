// SPDX-License-Identifier: GPL-3.0-or-later
// Regular scalar volumes in RAS millimetres and the reader of NIfTI-1 files (.nii, .nii.gz).
#pragma once

#include <array>
#include <cmath>
#include <cstddef>
#include <string>
#include <vector>

namespace insula::mesh_tool {

using Vec3 = std::array<double, 3>;

inline Vec3 operator+(const Vec3& a, const Vec3& b) { return {a[0] + b[0], a[1] + b[1], a[2] + b[2]}; }
inline Vec3 operator-(const Vec3& a, const Vec3& b) { return {a[0] - b[0], a[1] - b[1], a[2] - b[2]}; }
inline Vec3 operator*(double s, const Vec3& a) { return {s * a[0], s * a[1], s * a[2]}; }
inline double dot(const Vec3& a, const Vec3& b) { return a[0] * b[0] + a[1] * b[1] + a[2] * b[2]; }
inline Vec3 cross(const Vec3& a, const Vec3& b) {
  return {a[1] * b[2] - a[2] * b[1], a[2] * b[0] - a[0] * b[2], a[0] * b[1] - a[1] * b[0]};
}
inline double norm(const Vec3& a) { return std::sqrt(dot(a, a)); }

// A volume as stored in a file: values x fastest, and the affine that takes voxel indices to RAS millimetres.
struct NiftiVolume {
  std::array<int, 3> size{};
  std::vector<float> value;
  std::array<double, 12> to_world{};    // rows of a 3x4 matrix, mm
  std::array<double, 12> from_world{};  // its inverse

  float at(int i, int j, int k) const {
    return value[static_cast<std::size_t>(i) +
                 static_cast<std::size_t>(size[0]) *
                     (static_cast<std::size_t>(j) + static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(k))];
  }
  // Value of the voxel that holds the point (mm); 0 outside the volume.
  float nearest(const Vec3& world) const;
  // Trilinear value at a point (mm); 0 outside the volume.
  float linear(const Vec3& world) const;
};

// Reads a NIfTI-1 single file, either byte order, types uint8, int8, uint16, int16, uint32, int32, float, double.
// Takes the sform when its code is set, else the qform, else the voxel sizes. Applies scl_slope and scl_inter.
// Throws std::runtime_error with the file's name for anything it cannot read.
NiftiVolume read_nifti(const std::string& path);

// An axis-aligned grid of cubic voxels; node (i,j,k) lies at origin + spacing (i,j,k), millimetres.
struct Grid {
  std::array<int, 3> size{};
  Vec3 origin{};
  double spacing = 1;

  std::size_t count() const {
    return static_cast<std::size_t>(size[0]) * static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(size[2]);
  }
  std::size_t index(int i, int j, int k) const {
    return static_cast<std::size_t>(i) +
           static_cast<std::size_t>(size[0]) *
               (static_cast<std::size_t>(j) + static_cast<std::size_t>(size[1]) * static_cast<std::size_t>(k));
  }
  Vec3 point(int i, int j, int k) const {
    return {origin[0] + spacing * i, origin[1] + spacing * j, origin[2] + spacing * k};
  }
};

using Field = std::vector<float>;         // one value a node
using Mask = std::vector<unsigned char>;  // 0 or 1 a node

// Trilinear value of a field at a point (mm); points outside take the nearest border value.
double sample(const Grid& grid, const Field& field, const Vec3& world);

}  // namespace insula::mesh_tool
