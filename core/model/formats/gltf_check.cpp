// SPDX-License-Identifier: GPL-3.0-or-later
// Checks the references inside the JSON of a glTF file: assimp follows some of them unchecked.
#include "core/model/formats/gltf_check.h"

#include <nlohmann/json.hpp>

#include "core/base/text.h"
#include "core/model/formats/file_bytes.h"

namespace insula {
namespace {

using Json = nlohmann::json;

class GltfCheck {
 public:
  GltfCheck(const std::filesystem::path& file, const Json& root) : file_(file), root_(root) {}

  std::size_t check() {
    if (!root_.is_object()) bad("the file");
    views();
    accessors();
    meshes();
    nodes();
    return strips_ ? 0 : triangles_;
  }

 private:
  [[noreturn]] void bad(const std::string& what) const { fail(file_, "is malformed: " + what); }

  const Json& list(const char* name) const {
    static const Json none = Json::array();
    if (!root_.contains(name)) return none;
    if (!root_[name].is_array()) bad(name);
    for (const Json& item : root_[name])
      if (!item.is_object()) bad(name);
    return root_[name];
  }
  std::uint64_t whole(const Json& object, const char* key, std::uint64_t fallback) const {
    if (!object.contains(key)) return fallback;
    if (!object[key].is_number_unsigned() || object[key].get<std::uint64_t>() > 0xFFFFFFFFu) bad(key);
    return object[key].get<std::uint64_t>();
  }
  /// Index into `name`'s list.
  std::size_t index(const Json& value, const char* name) const {
    if (!value.is_number_unsigned() || value.get<std::uint64_t>() >= list(name).size())
      bad(std::string("an index into ") + name);
    return value.get<std::size_t>();
  }

  void views() const {
    for (const Json& view : list("bufferViews")) {
      if (!view.contains("buffer")) bad("a bufferView without buffer");
      const Json& buffer = list("buffers")[index(view["buffer"], "buffers")];
      if (whole(view, "byteOffset", 0) + whole(view, "byteLength", 0) > whole(buffer, "byteLength", 0))
        bad("a bufferView outside its buffer");
    }
  }

  void accessors() const {
    for (const Json& a : list("accessors")) {
      if (a.contains("sparse")) fail(file_, "has sparse accessors, which are not read");
      if (!a.contains("bufferView") || !a.contains("componentType") || !a.contains("type") || !a["type"].is_string())
        bad("an accessor");
      const Json& view = list("bufferViews")[index(a["bufferView"], "bufferViews")];
      const std::uint64_t component = whole(a, "componentType", 0);
      const std::uint64_t bytes = component == 5120 || component == 5121   ? 1
                                  : component == 5122 || component == 5123 ? 2
                                  : component == 5125 || component == 5126 ? 4
                                                                           : 0;
      static constexpr std::pair<std::string_view, std::uint64_t> types[] = {
          {"SCALAR", 1}, {"VEC2", 2}, {"VEC3", 3}, {"VEC4", 4}, {"MAT2", 4}, {"MAT3", 9}, {"MAT4", 16}};
      std::uint64_t parts = 0;
      for (const auto& [name, n] : types)
        if (a["type"].get_ref<const std::string&>() == name) parts = n;
      if (bytes == 0 || parts == 0) bad("an accessor's type");
      const std::uint64_t count = whole(a, "count", 0), stride = std::max(whole(view, "byteStride", 0), bytes * parts);
      if (count == 0) bad("an accessor's count");
      if (whole(a, "byteOffset", 0) + stride * (count - 1) + bytes * parts > whole(view, "byteLength", 0))
        bad("an accessor outside its bufferView");
    }
  }

  void meshes() {
    for (const Json& mesh : list("meshes")) {
      if (!mesh.contains("primitives") || !mesh["primitives"].is_array()) bad("a mesh without primitives");
      for (const Json& p : mesh["primitives"]) {
        if (!p.is_object() || !p.contains("attributes") || !p["attributes"].is_object()) bad("a primitive");
        for (const Json& a : p["attributes"]) index(a, "accessors");
        const Json corners = p.contains("indices") ? p["indices"] : p["attributes"].value("POSITION", Json());
        const Json& a = list("accessors")[index(corners, "accessors")];
        if (p.contains("indices") && a["type"] != "SCALAR") bad("a primitive's indices");
        const std::uint64_t mode = whole(p, "mode", 4);
        if (mode == 4) triangles_ += whole(a, "count", 0) / 3;
        else if (mode > 4) strips_ = true;
        if (p.contains("material")) index(p["material"], "materials");
        if (p["attributes"].contains("POSITION") &&
            list("accessors")[index(p["attributes"]["POSITION"], "accessors")]["type"] != "VEC3")
          bad("a primitive's positions");
      }
    }
  }

  void nodes() const {
    const Json& all = list("nodes");
    std::vector<std::ptrdiff_t> parent(all.size(), -1);
    for (std::size_t n = 0; n < all.size(); ++n) {
      if (all[n].contains("mesh")) index(all[n]["mesh"], "meshes");
      if (!all[n].contains("children")) continue;
      if (!all[n]["children"].is_array()) bad("a node's children");
      for (const Json& child : all[n]["children"]) {
        const std::size_t c = index(child, "nodes");
        if (parent[c] >= 0) bad("a node with two parents");
        parent[c] = std::ptrdiff_t(n);
      }
    }
    // Every node has one parent at most, so a walk up that is longer than 256 is a cycle or too deep.
    for (std::size_t n = 0; n < all.size(); ++n) {
      std::size_t depth = 0;
      for (std::ptrdiff_t at = std::ptrdiff_t(n); at >= 0; at = parent[std::size_t(at)])
        if (++depth > 256) bad("its nodes are nested too deeply or in a cycle");
    }
    for (const Json& scene : list("scenes"))
      if (scene.contains("nodes")) {
        if (!scene["nodes"].is_array()) bad("a scene's nodes");
        for (const Json& n : scene["nodes"]) index(n, "nodes");
      }
    if (root_.contains("scene")) index(root_["scene"], "scenes");
  }

  const std::filesystem::path& file_;
  const Json& root_;
  std::size_t triangles_ = 0;
  bool strips_ = false;
};

}  // namespace

std::size_t check_gltf(const std::filesystem::path& file, std::string_view json) {
  Json root;
  try {
    root = Json::parse(json);
  } catch (const Json::exception& e) {
    fail(file, "is no valid glTF: " + shown(e.what()));
  }
  return GltfCheck(file, root).check();
}

}  // namespace insula
