// SPDX-License-Identifier: GPL-3.0-or-later
// NIfTI-1 reading (through zlib, which also passes plain files) and trilinear sampling.
#include "volume.h"

#include <zlib.h>

#include <algorithm>
#include <cstdint>
#include <cstring>
#include <memory>
#include <stdexcept>

namespace insula::mesh_tool {
namespace {

[[noreturn]] void fail(const std::string& path, const std::string& what) {
  throw std::runtime_error(path + ": " + what);
}

std::vector<unsigned char> read_all(const std::string& path) {
  std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
  if (!file) fail(path, "cannot be opened");
  std::vector<unsigned char> bytes;
  constexpr std::size_t chunk = 1u << 20;
  for (;;) {
    const std::size_t old = bytes.size();
    bytes.resize(old + chunk);
    const int got = gzread(file.get(), bytes.data() + old, chunk);
    if (got < 0) fail(path, "is damaged (zlib cannot decompress it)");
    bytes.resize(old + static_cast<std::size_t>(got));
    if (got == 0) break;
  }
  return bytes;
}

// Reads a value of type T at a byte offset, swapping the bytes when the file has the other order.
template <class T>
T get(const std::vector<unsigned char>& bytes, std::size_t offset, bool swap) {
  unsigned char raw[sizeof(T)];
  std::memcpy(raw, bytes.data() + offset, sizeof(T));
  if (swap) std::reverse(raw, raw + sizeof(T));
  T value;
  std::memcpy(&value, raw, sizeof(T));
  return value;
}

std::array<double, 12> inverse(const std::array<double, 12>& m, const std::string& path) {
  const Vec3 c0{m[0], m[4], m[8]}, c1{m[1], m[5], m[9]}, c2{m[2], m[6], m[10]}, t{m[3], m[7], m[11]};
  const double det = dot(c0, cross(c1, c2));
  if (!(std::abs(det) > 1e-12)) fail(path, "its affine cannot be inverted");
  const Vec3 rows[3] = {(1 / det) * cross(c1, c2), (1 / det) * cross(c2, c0), (1 / det) * cross(c0, c1)};
  std::array<double, 12> out{};
  for (std::size_t r = 0; r < 3; ++r) {
    for (std::size_t c = 0; c < 3; ++c) out[4 * r + c] = rows[r][c];
    out[4 * r + 3] = -dot(rows[r], t);
  }
  return out;
}

Vec3 apply(const std::array<double, 12>& m, const Vec3& p) {
  return {m[0] * p[0] + m[1] * p[1] + m[2] * p[2] + m[3], m[4] * p[0] + m[5] * p[1] + m[6] * p[2] + m[7],
          m[8] * p[0] + m[9] * p[1] + m[10] * p[2] + m[11]};
}

// The affine of the header, NIfTI-1 methods 3 (sform), 2 (qform) and 1 (voxel sizes only).
std::array<double, 12> read_affine(const std::vector<unsigned char>& b, bool swap) {
  std::array<double, 12> m{};
  const auto number = [&](std::size_t offset) { return static_cast<double>(get<float>(b, offset, swap)); };
  const int unit = b[123] & 7;  // 1 metre, 2 millimetre, 3 micrometre
  const double scale = unit == 1 ? 1000.0 : unit == 3 ? 0.001 : 1.0;
  const Vec3 voxel{number(80), number(84), number(88)};
  if (get<std::int16_t>(b, 254, swap) > 0) {
    for (std::size_t i = 0; i < 12; ++i) m[i] = number(280 + 4 * i);
  } else if (get<std::int16_t>(b, 252, swap) > 0) {
    const double qb = number(256), qc = number(260), qd = number(264);
    const double qa = std::sqrt(std::max(0.0, 1 - qb * qb - qc * qc - qd * qd));
    const double handed = number(76) < 0 ? -1 : 1;
    const double r[9] = {qa * qa + qb * qb - qc * qc - qd * qd,
                         2 * (qb * qc - qa * qd),
                         2 * (qb * qd + qa * qc),
                         2 * (qb * qc + qa * qd),
                         qa * qa + qc * qc - qb * qb - qd * qd,
                         2 * (qc * qd - qa * qb),
                         2 * (qb * qd - qa * qc),
                         2 * (qc * qd + qa * qb),
                         qa * qa + qd * qd - qb * qb - qc * qc};
    for (std::size_t i = 0; i < 3; ++i) {
      m[4 * i] = r[3 * i] * voxel[0];
      m[4 * i + 1] = r[3 * i + 1] * voxel[1];
      m[4 * i + 2] = r[3 * i + 2] * voxel[2] * handed;
      m[4 * i + 3] = number(268 + 4 * i);
    }
  } else {
    m[0] = voxel[0];
    m[5] = voxel[1];
    m[10] = voxel[2];
  }
  for (double& value : m) value *= scale;
  return m;
}

template <class T>
void copy_values(NiftiVolume& volume, const std::vector<unsigned char>& bytes, std::size_t offset, bool swap,
                 double slope, double intercept, const std::string& path) {
  const std::size_t n = volume.value.size();
  if (bytes.size() < offset + n * sizeof(T)) fail(path, "is truncated");
  for (std::size_t i = 0; i < n; ++i) {
    const double v = slope * static_cast<double>(get<T>(bytes, offset + i * sizeof(T), swap)) + intercept;
    volume.value[i] = std::isfinite(v) ? static_cast<float>(v) : 0.0f;
  }
}

}  // namespace

NiftiVolume read_nifti(const std::string& path) {
  const auto bytes = read_all(path);
  if (bytes.size() < 352) fail(path, "is too short for a NIfTI-1 header");
  bool swap = false;
  if (get<std::int32_t>(bytes, 0, false) != 348) {
    if (get<std::int32_t>(bytes, 0, true) != 348) fail(path, "is no NIfTI-1 file");
    swap = true;
  }
  if (std::memcmp(bytes.data() + 344, "n+1", 4) != 0) fail(path, "is no single-file NIfTI-1 (magic is not n+1)");
  NiftiVolume volume;
  const int dims = get<std::int16_t>(bytes, 40, swap);
  if (dims < 3 || dims > 7) fail(path, "has no three dimensions");
  std::size_t count = 1;
  for (std::size_t i = 0; i < 3; ++i) {
    volume.size[i] = get<std::int16_t>(bytes, 42 + 2 * i, swap);
    if (volume.size[i] < 1) fail(path, "has an empty dimension");
    count *= static_cast<std::size_t>(volume.size[i]);
  }
  if (count > (std::size_t{1} << 31)) fail(path, "has more than 2^31 voxels");
  for (int i = 4; i <= dims; ++i)
    if (get<std::int16_t>(bytes, 40 + 2 * static_cast<std::size_t>(i), swap) > 1)
      fail(path, "holds more than one volume");
  const double vox_offset = get<float>(bytes, 108, swap);
  const std::size_t offset = vox_offset >= 352 && vox_offset < 1e9 ? static_cast<std::size_t>(vox_offset) : 352;
  double slope = get<float>(bytes, 112, swap), intercept = get<float>(bytes, 116, swap);
  if (!std::isfinite(slope) || slope == 0) slope = 1, intercept = 0;
  if (!std::isfinite(intercept)) intercept = 0;

  const int type = get<std::int16_t>(bytes, 70, swap);
  const auto copy = [&]<class T>(T) { copy_values<T>(volume, bytes, offset, swap, slope, intercept, path); };
  std::size_t width = 0;
  switch (type) {
    case 2:
    case 256: width = 1; break;
    case 4:
    case 512: width = 2; break;
    case 8:
    case 16:
    case 768: width = 4; break;
    case 64: width = 8; break;
    default: fail(path, "has the unsupported data type " + std::to_string(type));
  }
  if (bytes.size() < offset + count * width) fail(path, "is truncated");
  volume.value.resize(count);
  switch (type) {
    case 2: copy(std::uint8_t{}); break;
    case 4: copy(std::int16_t{}); break;
    case 8: copy(std::int32_t{}); break;
    case 16: copy(float{}); break;
    case 64: copy(double{}); break;
    case 256: copy(std::int8_t{}); break;
    case 512: copy(std::uint16_t{}); break;
    case 768: copy(std::uint32_t{}); break;
    default: break;
  }
  volume.to_world = read_affine(bytes, swap);
  volume.from_world = inverse(volume.to_world, path);
  return volume;
}

float NiftiVolume::nearest(const Vec3& world) const {
  const Vec3 p = apply(from_world, world);
  int ijk[3];
  for (std::size_t a = 0; a < 3; ++a) {
    const double r = std::floor(p[a] + 0.5);
    if (!(r >= 0 && r < size[a])) return 0;
    ijk[a] = static_cast<int>(r);
  }
  return at(ijk[0], ijk[1], ijk[2]);
}

float NiftiVolume::linear(const Vec3& world) const {
  const Vec3 p = apply(from_world, world);
  int base[3];
  double f[3];
  for (std::size_t a = 0; a < 3; ++a) {
    if (!(p[a] >= 0 && p[a] <= size[a] - 1)) return 0;
    base[a] = std::min(static_cast<int>(p[a]), std::max(0, size[a] - 2));
    f[a] = p[a] - base[a];
  }
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    double w = 1;
    int ijk[3];
    for (int a = 0; a < 3; ++a) {
      const bool up = (corner >> a) & 1;
      w *= up ? f[a] : 1 - f[a];
      ijk[a] = std::min(base[a] + (up ? 1 : 0), size[static_cast<std::size_t>(a)] - 1);
    }
    if (w > 0) sum += w * static_cast<double>(at(ijk[0], ijk[1], ijk[2]));
  }
  return static_cast<float>(sum);
}

double sample(const Grid& grid, const Field& field, const Vec3& world) {
  int base[3];
  double f[3];
  for (std::size_t a = 0; a < 3; ++a) {
    const double p = std::clamp((world[a] - grid.origin[a]) / grid.spacing, 0.0, grid.size[a] - 1.0);
    base[a] = std::min(static_cast<int>(p), grid.size[a] - 2);
    f[a] = p - base[a];
  }
  double sum = 0;
  for (int corner = 0; corner < 8; ++corner) {
    const int i = corner & 1, j = (corner >> 1) & 1, k = (corner >> 2) & 1;
    const double w = (i ? f[0] : 1 - f[0]) * (j ? f[1] : 1 - f[1]) * (k ? f[2] : 1 - f[2]);
    sum += w * static_cast<double>(field[grid.index(base[0] + i, base[1] + j, base[2] + k)]);
  }
  return sum;
}

}  // namespace insula::mesh_tool
