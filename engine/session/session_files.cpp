// SPDX-License-Identifier: GPL-3.0-or-later
// Hashes by OpenSSL; the layout of folders is kept, since scenes name files relative to themselves.
#include "engine/session/session_files.h"

#include <openssl/evp.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <iterator>

#include "core/base/input_error.h"
#include "engine/live/scene_files.h"

namespace insula {
namespace fs = std::filesystem;
namespace {

constexpr const char* file_list = "files";  // the description with the hashes
constexpr std::string_view attachment_prefix = "scene/";
constexpr std::size_t most_named = 20;  // missing files in a message

bool is_text(const fs::path& file) {
  static const std::array<std::string, 4> extensions = {".xml", ".urdf", ".json", ".csv"};
  return std::find(extensions.begin(), extensions.end(), file.extension()) != extensions.end();
}

mcap::Buffer read_whole(const fs::path& file) {
  std::ifstream in(file, std::ios::binary);
  if (!in) throw InputError(file.string() + ": cannot be read");
  return {std::istreambuf_iterator<char>(in), {}};
}

/// Whether a recorded path stays below the folder that it is put into.
bool stays_inside(const fs::path& path) {
  return !path.empty() && path.is_relative() &&
         std::none_of(path.begin(), path.end(), [](const fs::path& part) { return part == ".."; });
}

/// The file of that hash: at the same path below a place, or of the same name anywhere below it.
fs::path find_mesh(const std::vector<fs::path>& places, const fs::path& path, const std::string& hash) {
  std::error_code ec;
  const auto is_it = [&](const fs::path& candidate) {
    return fs::is_regular_file(candidate, ec) && sha256_of(candidate) == hash;
  };
  for (const fs::path& place : places)
    if (is_it(place / path)) return place / path;
  for (const fs::path& place : places)
    for (fs::recursive_directory_iterator it(place, fs::directory_options::skip_permission_denied, ec), end;
         !ec && it != end; it.increment(ec))
      if (it->path().filename() == path.filename() && is_it(it->path())) return it->path();
  return {};
}

}  // namespace

std::string sha256(mcap::Bytes bytes) {
  std::array<unsigned char, EVP_MAX_MD_SIZE> digest{};
  unsigned n = 0;
  if (EVP_Digest(bytes.data(), bytes.size(), digest.data(), &n, EVP_sha256(), nullptr) != 1)
    throw InputError("SHA-256 is not available");
  static constexpr char digits[] = "0123456789abcdef";
  std::string out;
  for (unsigned i = 0; i < n; ++i) {
    out += digits[digest[i] >> 4];
    out += digits[digest[i] & 15];
  }
  return out;
}

std::string sha256_of(const fs::path& file) { return sha256(read_whole(file)); }

SceneFileList list_scene_files(const fs::path& scene) {
  SceneFileList out;
  std::vector<fs::path> files;
  for (const fs::path& f : scene_files(scene))
    if (fs::is_regular_file(f)) files.push_back(f);
  const fs::path main = fs::weakly_canonical(fs::absolute(scene));
  out.root = main.parent_path();
  const auto outside = [&](const fs::path& f) { return !stays_inside(f.lexically_relative(out.root)); };
  while (std::any_of(files.begin(), files.end(), outside)) out.root = out.root.parent_path();
  out.scene = main.lexically_relative(out.root).generic_string();
  for (const fs::path& f : files) out.sha256[f.lexically_relative(out.root).generic_string()] = sha256_of(f);
  return out;
}

void put_scene_files(McapWriter& file, const SceneFileList& list) {
  file.describe(file_list, list.sha256);
  for (const auto& [path, hash] : list.sha256)
    if (is_text(path))
      file.attach(std::string(attachment_prefix) + path, "text/plain", 0, read_whole(list.root / path));
}

fs::path restore_scene_files(McapReader& file, const std::vector<fs::path>& places, const fs::path& folder) {
  const auto session = file.descriptions().find("session");
  const auto files = file.descriptions().find(file_list);
  if (session == file.descriptions().end() || files == file.descriptions().end() ||
      !session->second.contains("scene_file"))
    throw InputError("the recording has lost the list of its scene's files");
  std::map<std::string, const McapReader::Attachment*> kept;
  for (const McapReader::Attachment& a : file.attachments()) kept[a.name] = &a;

  std::vector<std::string> missing;
  for (const auto& [path, hash] : files->second) {
    if (!stays_inside(path)) throw InputError("the recording names a file outside its scene: " + path);
    const fs::path target = folder / path;
    fs::create_directories(target.parent_path());
    if (const auto a = kept.find(std::string(attachment_prefix) + path); a != kept.end()) {
      const auto data = file.data(*a->second);
      if (data && sha256(*data) == hash) {
        std::ofstream(target, std::ios::binary)
            .write(reinterpret_cast<const char*>(data->data()), std::streamsize(data->size()));
        continue;
      }
    }
    const fs::path mesh = find_mesh(places, path, hash);
    if (mesh.empty()) missing.push_back(path);
    else fs::copy_file(mesh, target, fs::copy_options::overwrite_existing);
  }
  if (!missing.empty()) {
    std::string text = "files of the recorded scene are missing or have changed since:";
    for (std::size_t i = 0; i < std::min(missing.size(), most_named); ++i) text += "\n  " + missing[i];
    if (missing.size() > most_named) text += "\n  and " + std::to_string(missing.size() - most_named) + " more";
    throw InputError(text + "\nName the folder that has them with --files.");
  }
  const std::string& scene = session->second.at("scene_file");
  if (!files->second.contains(scene)) throw InputError("the recording does not contain its scene " + scene);
  return folder / scene;
}

}  // namespace insula
