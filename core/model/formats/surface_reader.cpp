// SPDX-License-Identifier: GPL-3.0-or-later
// Reads triangle surfaces through assimp, with the checks that assimp omits.
#include <assimp/DefaultIOSystem.h>
#include <assimp/config.h>
#include <assimp/postprocess.h>
#include <assimp/scene.h>

#include <algorithm>
#include <assimp/Importer.hpp>
#include <cmath>
#include <memory>
#include <unordered_map>

#include "core/base/text.h"
#include "core/model/formats/assimp_assert.h"
#include "core/model/formats/file_bytes.h"
#include "core/model/formats/library_leaks.h"
#include "core/model/formats/ply_check.h"
#include "core/model/formats/raw_tets.h"
#include "core/model/formats/surface_precheck.h"

namespace insula {
namespace {

// A reference, so that a static library includes the handler.
[[maybe_unused]] void (*const volatile assertion_handler)(const char*, const char*, int) = Assimp::aiAssertViolation;

/// Opens nothing outside the folder of the mesh file (buffers of glTF, materials of OBJ).
class FolderIO : public Assimp::DefaultIOSystem {
 public:
  explicit FolderIO(const std::filesystem::path& file)
      : folder_(std::filesystem::weakly_canonical(file).parent_path()) {}
  bool Exists(const char* name) const override { return inside(name) && DefaultIOSystem::Exists(name); }
  Assimp::IOStream* Open(const char* name, const char* mode) override {
    if (!inside(name) || std::string_view(mode).find_first_of("wa+") != std::string_view::npos) return nullptr;
    return DefaultIOSystem::Open(name, mode);
  }

 private:
  bool inside(const char* name) const {
    std::error_code error;
    const auto path = std::filesystem::weakly_canonical(name, error);
    const auto relative = path.lexically_relative(folder_);
    return !error && !relative.empty() && *relative.begin() != ".." && std::filesystem::is_regular_file(path, error);
  }
  std::filesystem::path folder_;
};

/// Hash of finite positions without -0, so that equal ones have equal bits.
struct VertexHash {
  std::size_t operator()(const Vec3& p) const {
    return std::hash<std::string_view>{}({reinterpret_cast<const char*>(p.data()), 3 * sizeof(double)});
  }
};

/// Joins the triangles of all parts; equal vertices become one, in the order they are first used.
class Joiner {
 public:
  Joiner(const std::filesystem::path& file, double scale) : file_(file), scale_(scale) {}

  void add(const aiMesh& part, const aiMatrix4x4& pose) {
    for (unsigned f = 0; f < part.mNumFaces; ++f) {
      const aiFace& face = part.mFaces[f];
      if (face.mNumIndices < 3) continue;  // points and lines
      if (face.mNumIndices != 3) fail(file_, "has a face that is no triangle");
      std::array<Vec3, 3> p;
      for (unsigned k = 0; k < 3; ++k) {
        const unsigned i = face.mIndices[k];
        if (i >= part.mNumVertices) fail(file_, "a triangle names a vertex that does not exist");
        const aiVector3D v = pose * part.mVertices[i];
        p[k] = Vec3(double(v.x), double(v.y), double(v.z)) * scale_ + Vec3::Zero();  // -0 becomes 0
        if (!p[k].allFinite()) fail(file_, "vertex " + std::to_string(i) + " is not finite");
      }
      const double longest2 =
          std::max({(p[1] - p[0]).squaredNorm(), (p[2] - p[1]).squaredNorm(), (p[0] - p[2]).squaredNorm()});
      if (!((p[1] - p[0]).cross(p[2] - p[0]).norm() > 1e-12 * longest2)) continue;  // flat
      std::array<int, 3> t;
      for (int k = 0; k < 3; ++k) t[k] = vertex(p[k]);
      mesh_.triangles.push_back(t);
    }
  }
  TriMesh take() { return std::move(mesh_); }

 private:
  int vertex(const Vec3& p) {
    const auto [at, fresh] = places_.emplace(p, int(mesh_.vertices.size()));
    if (fresh) mesh_.vertices.push_back(p);
    return at->second;
  }
  std::filesystem::path file_;
  double scale_;
  TriMesh mesh_;
  std::unordered_map<Vec3, int, VertexHash> places_;  // only looked up, never iterated, so its order has no effect
};

}  // namespace

TriMesh read_surface(const std::filesystem::path& file, double metres_per_unit) {
  check_unit(file, metres_per_unit);
  std::string bytes = read_file_bytes(file);
  const std::size_t expected = precheck_surface(file, bytes);
  Assimp::Importer importer;
  importer.SetIOHandler(new FolderIO(file));  // the importer owns it
  importer.SetPropertyBool(AI_CONFIG_IMPORT_NO_SKELETON_MESHES, true);
  const aiScene* scene = nullptr;
  try {
    const LibraryLeaks not_ours;
    if (lower_extension(file) == ".ply") {
      if (begins_with_line_end(bytes)) bytes = with_opposite_byte_order(file, bytes);
      scene = importer.ReadFileFromMemory(bytes.data(), bytes.size(), aiProcess_Triangulate, "ply");
    } else {
      scene = importer.ReadFile(std::filesystem::absolute(file).string(), aiProcess_Triangulate);
    }
  } catch (const std::exception& e) {
    fail(file, std::string("cannot be read: ") + shown(e.what()));
  }
  if (!scene) fail(file, std::string("cannot be read: ") + shown(importer.GetErrorString()));
  if (!scene->mRootNode || scene->mNumMeshes == 0) fail(file, "holds no triangles, or ends early");
  std::size_t faces = 0;
  for (unsigned m = 0; m < scene->mNumMeshes; ++m) faces += scene->mMeshes[m]->mNumFaces;
  if (expected > 0 && faces < expected)  // assimp leaves triangles with bad indices out
    fail(file,
         "announces " + std::to_string(expected) + " triangles, of which " + std::to_string(faces) + " can be read");

  Joiner joiner(file, metres_per_unit);
  struct Visit {
    const aiNode* node;
    aiMatrix4x4 pose;
  };
  std::vector<Visit> stack{{scene->mRootNode, scene->mRootNode->mTransformation}};
  while (!stack.empty()) {
    const Visit v = stack.back();
    stack.pop_back();
    for (unsigned m = 0; m < v.node->mNumMeshes; ++m)
      if (v.node->mMeshes[m] < scene->mNumMeshes) joiner.add(*scene->mMeshes[v.node->mMeshes[m]], v.pose);
    for (unsigned c = v.node->mNumChildren; c-- > 0;)
      stack.push_back({v.node->mChildren[c], v.pose * v.node->mChildren[c]->mTransformation});
  }
  TriMesh mesh = joiner.take();
  if (mesh.triangles.empty()) fail(file, "holds no triangles, or ends early");
  return mesh;
}

}  // namespace insula
