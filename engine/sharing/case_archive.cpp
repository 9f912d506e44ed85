// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/sharing/case_archive.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <set>

#include "core/base/input_error.h"
#include "core/model/formats/file_bytes.h"
#include "engine/live/scene_files.h"
#include "engine/session/session_files.h"
#include "engine/sharing/zip_reader.h"

namespace insula {
namespace fs = std::filesystem;
namespace {

constexpr std::array kinds = {".xml", ".json", ".csv", ".urdf", ".obj", ".stl",  ".ply", ".off", ".msh",
                              ".vtu", ".vtp",  ".jpg", ".png",  ".svg", ".html", ".md",  ".txt"};
constexpr std::uint64_t max_manifest_bytes = 2'000'000;
constexpr int format = 1;

bool is_of_a_case(const fs::path& file) {
  return std::find(kinds.begin(), kinds.end(), file.extension()) != kinds.end();
}

/// A path of the archive that stays below the folder it is unpacked to, on every system.
bool is_safe_path(const std::string& path) {
  const fs::path p(path);
  return !path.empty() && path.size() < 300 && path.find_first_of("\\:*?\"<>|") == std::string::npos &&
         std::none_of(path.begin(), path.end(), [](unsigned char c) { return c < 32; }) && p.is_relative() &&
         std::none_of(p.begin(), p.end(), [](const fs::path& part) { return part.empty() || part.string()[0] == '.'; });
}

std::string hash_of(const std::string& bytes) {
  return sha256({reinterpret_cast<const std::uint8_t*>(bytes.data()), bytes.size()});
}

/// The files of all scenes by their path below the folder that contains them all.
std::map<std::string, fs::path> gathered(const std::vector<fs::path>& scenes, const std::vector<fs::path>& more) {
  std::set<fs::path> files;
  for (const fs::path& scene : scenes) {
    if (!fs::is_regular_file(scene)) throw InputError(scene.string() + ": is not there");
    for (const fs::path& f : scene_files(scene))  // also of what only looks like the name of a file
      if (fs::is_regular_file(f)) files.insert(fs::weakly_canonical(f));
  }
  for (const fs::path& f : more) files.insert(fs::weakly_canonical(f));
  if (files.empty()) throw InputError("there is no scene to pack");
  fs::path root = files.begin()->parent_path();
  const auto outside = [&](const fs::path& f) { return !is_safe_path(f.lexically_relative(root).generic_string()); };
  while (root.has_relative_path() && std::any_of(files.begin(), files.end(), outside)) root = root.parent_path();
  std::map<std::string, fs::path> out;
  for (const fs::path& f : files) {
    if (!is_of_a_case(f)) throw InputError(f.string() + ": is of a kind that no case has");
    out[f.lexically_relative(root).generic_string()] = f;
  }
  return out;
}

void add(zip_t* z, const std::string& name, const std::string& bytes, const fs::path& file) {
  zip_source_t* source = zip_source_buffer(z, bytes.data(), bytes.size(), 0);
  const zip_int64_t at = source ? zip_file_add(z, name.c_str(), source, ZIP_FL_ENC_UTF_8) : -1;
  // One date for all, so that the same files give the same archive: 1 January 1980, the first that there is.
  if (at < 0 || zip_file_set_dostime(z, zip_uint64_t(at), 0, 0x21, 0) != 0)
    throw InputError(file.string() + ": cannot be written: " + zip_strerror(z));
}

/// An archive whose names are safe and of a case.
class Reader {
 public:
  explicit Reader(const fs::path& file) : zip_(file, "case", max_case_files + 1) {
    for (std::uint64_t i = 0; i < zip_.count(); ++i) {
      const std::string path = zip_.name(i);
      if (!is_safe_path(path)) refuse("has the file \"" + path + "\", which would lie outside of its folder");
      if (!is_of_a_case(path)) refuse("has the file \"" + path + "\", which is of a kind that no case has");
      if (!at_.emplace(path, i).second) refuse("has the file \"" + path + "\" twice");
    }
  }
  const std::map<std::string, std::uint64_t>& files() const { return at_; }
  std::string read(const std::string& path, std::uint64_t most) const {
    const auto at = at_.find(path);
    if (at == at_.end()) refuse("has no file \"" + path + "\"");
    return zip_.read(at->second, most);
  }
  [[noreturn]] void refuse(const std::string& why) const { zip_.refuse(why); }

 private:
  ZipReader zip_;
  std::map<std::string, std::uint64_t> at_;
};

struct Manifest {
  PackedCase about;
  std::map<std::string, std::string> sha256;
};

Manifest read_manifest(const Reader& reader) {
  const auto json = nlohmann::json::parse(reader.read(case_manifest, max_manifest_bytes), nullptr, false);
  Manifest out;
  try {
    if (json.at("format") != format) reader.refuse("is of another version of Insula");
    out.about.name = json.at("name");
    out.about.scenes = json.at("scenes");
    out.sha256 = json.at("files").get<std::map<std::string, std::string>>();
  } catch (const nlohmann::json::exception&) {
    reader.refuse(std::string("has a wrong ") + case_manifest);
  }
  if (!is_case_name(out.about.name)) reader.refuse("has the name \"" + out.about.name + "\"");
  for (const std::string& scene : out.about.scenes)
    if (!out.sha256.count(scene)) reader.refuse("lacks its scene \"" + scene + "\"");
  for (const auto& [path, at] : reader.files())
    if (path != case_manifest && !out.sha256.count(path))
      reader.refuse("has the file \"" + path + "\" beside its list");
  return out;
}

/// A folder that goes unless it is kept.
class Incoming {
 public:
  explicit Incoming(fs::path path) : path_(std::move(path)) { fs::remove_all(path_); }
  ~Incoming() {
    std::error_code ignored;
    fs::remove_all(path_, ignored);
  }
  Incoming(const Incoming&) = delete;
  Incoming& operator=(const Incoming&) = delete;
  void write(const std::string& name, const std::string& bytes) const {
    fs::create_directories((path_ / name).parent_path());
    std::ofstream out(path_ / name, std::ios::binary);
    if (!out.write(bytes.data(), std::streamsize(bytes.size())).flush())
      throw InputError((path_ / name).string() + ": cannot be written");
  }
  void keep_as(const fs::path& to) const { fs::rename(path_, to); }

 private:
  fs::path path_;
};

}  // namespace

PackedCase pack_case(const std::string& name, const std::vector<fs::path>& scenes, const std::vector<fs::path>& more,
                     const fs::path& archive) {
  if (!is_case_name(name)) throw InputError("\"" + name + "\" is no name of a case: letters, digits, _ and -");
  const std::map<std::string, fs::path> files = gathered(scenes, more);
  PackedCase out{name, {}, files.size(), 0};
  std::map<std::string, std::string> bytes, hashes;  // libzip reads the bytes when it closes
  for (const auto& [path, file] : files) {
    out.bytes += bytes.emplace(path, read_file_bytes(file)).first->second.size();
    hashes[path] = hash_of(bytes[path]);
  }
  for (const fs::path& scene : scenes) {
    const fs::path packed = fs::weakly_canonical(scene);
    for (const auto& [path, file] : files)
      if (file == packed) out.scenes.push_back(path);
  }
  std::sort(out.scenes.begin(), out.scenes.end());
  const nlohmann::ordered_json manifest = {
      {"format", format}, {"name", name}, {"scenes", out.scenes}, {"files", hashes}};
  const std::string list = manifest.dump(1);
  const fs::path part = archive.string() + ".part";
  ZipArchive z = opened_zip(part, ZIP_CREATE | ZIP_TRUNCATE, "case");
  add(z.get(), case_manifest, list, archive);
  for (const auto& [path, text] : bytes) add(z.get(), path, text, archive);
  if (zip_close(z.get()) != 0) throw InputError(archive.string() + ": cannot be written: " + zip_strerror(z.get()));
  z.release();
  fs::rename(part, archive);
  return out;
}

PackedCase unpack_case(const fs::path& archive, const fs::path& folder) {
  const Reader reader(archive);
  Manifest manifest = read_manifest(reader);
  PackedCase out = manifest.about;
  const fs::path to = folder / out.name;
  if (fs::exists(to)) throw InputError(to.string() + ": is there already; remove it first");
  const Incoming incoming(folder / ("." + out.name + ".incoming"));
  for (const auto& [path, hash] : manifest.sha256) {
    const std::string bytes = reader.read(path, max_case_file_bytes);
    out.bytes += bytes.size();
    if (out.bytes > max_case_bytes) reader.refuse(fmt::format("holds more than {} bytes", max_case_bytes));
    if (hash_of(bytes) != hash) reader.refuse("has the file \"" + path + "\", which is not the one that was packed");
    incoming.write(path, bytes);
    ++out.files;
  }
  incoming.write(case_manifest, reader.read(case_manifest, max_manifest_bytes));
  incoming.keep_as(to);
  return out;
}

}  // namespace insula
