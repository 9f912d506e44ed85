// SPDX-License-Identifier: GPL-3.0-or-later
// Writes the binary files of a bundle: 32-bit numbers, little endian.
#pragma once
#include <bit>
#include <filesystem>
#include <fstream>
#include <nlohmann/json.hpp>
#include <string>
#include <vector>

#include "core/base/input_error.h"
#include "core/mechanics/surface.h"

namespace insula {

class BundleWriter {
 public:
  explicit BundleWriter(const std::filesystem::path& dir) : dir_(dir) {}

  /// positions, indices and counts of a mesh; `name` is the prefix of its files' names.
  void mesh(nlohmann::ordered_json& to, const std::string& name, const std::vector<Vec3>& vertices,
            const std::vector<std::array<int, 3>>& triangles) const {
    to["vertices"] = vertices.size();
    to["triangles"] = triangles.size();
    to["positions"] = points(name + "_positions.bin", vertices);
    std::vector<std::uint32_t> flat;
    flat.reserve(3 * triangles.size());
    for (const auto& t : triangles)
      for (int i : t) flat.push_back(std::uint32_t(i));
    to["indices"] = file(name + "_indices.bin", flat);
  }

  std::string points(const std::string& name, const std::vector<Vec3>& values) const {
    std::vector<float> flat;
    flat.reserve(3 * values.size());
    for (const Vec3& v : values)
      for (int k = 0; k < 3; ++k) flat.push_back(float(v[k]));
    return file(name, flat);
  }

  /// Four nodes and weights for each vertex. Vertices with fewer nodes repeat the first one with weight 0.
  void skin(nlohmann::ordered_json& to, const std::string& name, const Surface& surface) const {
    std::vector<std::uint32_t> nodes;
    std::vector<float> weights;
    for (const MaterialPoint& p : surface.points())
      for (int k = 0; k < 4; ++k) {
        nodes.push_back(std::uint32_t(p.node[std::size_t(k < p.count ? k : 0)]));
        weights.push_back(k < p.count ? float(p.weight[std::size_t(k)]) : 0.f);
      }
    to["skin_nodes"] = file(name + "_nodes.bin", nodes);
    to["skin_weights"] = file(name + "_weights.bin", weights);
  }

  /// Copies the picture beside a tool's URDF. False if there is none.
  bool picture(const std::filesystem::path& urdf, const std::string& name) const {
    const std::filesystem::path from = urdf.parent_path() / "picture.svg";
    std::error_code error;
    if (!std::filesystem::is_regular_file(from, error)) return false;
    std::filesystem::copy_file(from, dir_ / name, std::filesystem::copy_options::overwrite_existing, error);
    if (error) throw InputError((dir_ / name).string() + ": cannot be written: " + error.message());
    return true;
  }

  template <class T>
  std::string file(const std::string& name, const std::vector<T>& values) const {
    static_assert(sizeof(T) == 4);
    std::ofstream out(dir_ / name, std::ios::binary | std::ios::trunc);
    for (const T& value : values) {
      auto bits = std::bit_cast<std::uint32_t>(value);
      if constexpr (std::endian::native == std::endian::big) bits = __builtin_bswap32(bits);
      out.write(reinterpret_cast<const char*>(&bits), 4);
    }
    out.close();
    if (!out) throw InputError((dir_ / name).string() + ": cannot be written");
    return name;
  }

 private:
  std::filesystem::path dir_;
};

}  // namespace insula
