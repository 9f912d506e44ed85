// SPDX-License-Identifier: GPL-3.0-or-later
// Checks of a surface file's bytes before assimp reads them.
#include "core/model/formats/surface_precheck.h"

#include <algorithm>

#include "core/base/text.h"
#include "core/model/formats/file_bytes.h"
#include "core/model/formats/gltf_check.h"
#include "core/model/formats/ply_check.h"

namespace insula {
namespace {

// STL: binary if the size agrees with the count at byte 80. Otherwise it is ASCII, which ends with "endsolid".
std::size_t check_stl(const std::filesystem::path& file, std::string_view bytes) {
  ByteCursor in(file, bytes);
  const bool solid = trim(bytes.substr(0, std::min<std::size_t>(bytes.size(), 80))).substr(0, 5) == "solid";
  if (bytes.size() >= 84) {
    in.seek(80);
    const auto n = in.binary<std::uint32_t>(!machine_is_little_endian, "the number of triangles");
    if (bytes.size() == 84 + 50 * std::size_t(n) && n > 0) return n;
    if (!solid) {
      if (n == 0) in.fail("holds no triangles");
      if (bytes.size() < 84 + 50 * std::size_t(n))
        in.fail("ends early: it announces " + std::to_string(n) + " triangles and holds " +
                std::to_string((bytes.size() - 84) / 50));
      in.fail("is longer than the " + std::to_string(n) + " triangles it announces");
    }
  }
  if (!solid) in.fail("ends early: it is shorter than an STL header");
  const std::size_t last_facet = bytes.rfind("endfacet"), end = bytes.rfind("endsolid");
  if (end == std::string_view::npos || (last_facet != std::string_view::npos && end < last_facet))
    in.fail("ends early: \"endsolid\" is missing");
  return 0;
}

std::size_t check_glb(const std::filesystem::path& file, std::string_view bytes) {
  ByteCursor in(file, bytes);
  if (in.bytes(4, "the mark glTF") != "glTF") in.fail("is no binary glTF file");
  in.binary<std::uint32_t>(!machine_is_little_endian, "the version");
  const auto length = in.binary<std::uint32_t>(!machine_is_little_endian, "the length");
  if (length != bytes.size())
    in.fail("ends early: it announces " + std::to_string(length) + " bytes and has " + std::to_string(bytes.size()));
  std::size_t triangles = 0;
  bool first = true;
  while (in.left() > 0) {
    const auto n = in.binary<std::uint32_t>(!machine_is_little_endian, "a chunk's length");
    const auto chunk_kind = in.binary<std::uint32_t>(!machine_is_little_endian, "a chunk's kind");
    const std::string_view chunk = in.bytes(n, "a chunk");
    if (first && chunk_kind != 0x4E4F534A) in.fail("its first chunk is no JSON");
    if (first) triangles = check_gltf(file, chunk);
    first = false;
  }
  return triangles;
}

// OFF: "OFF", three counts, vertices, faces.
void check_off(const std::filesystem::path& file, std::string_view bytes) {
  std::string text;  // without comments
  for (ByteCursor lines(file, bytes); lines.left() > 0;) {
    const std::string_view line = lines.line();
    text.append(line.substr(0, line.find('#'))).push_back('\n');
  }
  ByteCursor in(file, text);
  if (in.word("OFF") != "OFF") in.fail("is no plain OFF file");
  const std::size_t vertices = in.count("the number of vertices", 6), faces = in.count("the number of faces", 2);
  in.integer("the number of edges");
  for (std::size_t i = 0; i < 3 * vertices; ++i) in.number("a coordinate");
  for (std::size_t f = 0; f < faces; ++f) {
    const std::size_t n = in.count("a face's number of vertices", 2);
    if (n < 3) in.fail("face " + std::to_string(f) + " has fewer than three vertices");
    for (std::size_t k = 0; k < n; ++k) {
      const std::int64_t i = in.integer("a face's vertex");
      if (i < 0 || std::uint64_t(i) >= vertices)
        in.fail("face " + std::to_string(f) + " names a vertex that does not exist");
    }
    in.line();  // colours
  }
  if (!in.try_word().empty()) in.fail("is longer than the vertices and faces it announces");
}

}  // namespace

std::size_t precheck_surface(const std::filesystem::path& file, std::string_view bytes) {
  const std::string kind = lower_extension(file);
  if (kind == ".stl") return check_stl(file, bytes);
  if (kind == ".glb") return check_glb(file, bytes);
  if (kind == ".gltf") return check_gltf(file, bytes);
  if (kind == ".ply") return check_ply(file, bytes), 0;
  if (kind == ".off") return check_off(file, bytes), 0;
  // assimp's COLLADA reader crashes on damaged files, and the format's axes and units need interpretation anyway.
  if (kind != ".obj") fail(file, "is no known surface (use .stl, .obj, .ply, .off, .gltf or .glb)");
  return 0;
}

}  // namespace insula
