// SPDX-License-Identifier: GPL-3.0-or-later
// A case as a folder: what each stage writes and the next one reads, with everything worth telling the author.
#pragma once
#include <filesystem>
#include <string>
#include <vector>

#include "core/model/mesh.h"
#include "tools/case_builder/options.h"

namespace insula::case_builder {

namespace fs = std::filesystem;

/// A finding during the work. A repair says what was changed; a problem says what to do, and has a name that stays the
/// same whatever the numbers in its text.
struct Note {
  enum class Kind { fact, repair, problem };
  Kind kind = Kind::fact;
  std::string text, advice;
  std::string id = {};
};
Note problem(std::string id, std::string text, std::string advice);
Json to_json(const std::vector<Note>& notes);
std::vector<Note> notes_from_json(const Json& json);

struct CaseFolder {
  fs::path path;
  std::string name;
  std::string opening = "1_sylvian_fissure";  ///< file of the exercise that opens the fissure (approach.h)

  fs::path intake() const { return path / "intake"; }
  fs::path wall() const { return path / "wall"; }
  fs::path artery() const { return path / "artery"; }
  fs::path brain() const { return path / "brain"; }
  fs::path lobes() const { return path / "lobes"; }
  fs::path options_file() const { return path / "case.json"; }
};

/// Reads case.json; throws InputError when the folder is no case.
Options read_options(CaseFolder& folder);
void write_options(const CaseFolder& folder, const Options& options);

/// Whole files; throw InputError with the file's name. Writing makes the folder.
Json read_json(const fs::path& file);
void write_json(const fs::path& file, const Json& json);
void write_text(const fs::path& file, const std::string& text);
/// Binary PLY, float coordinates, in the mesh's unit.
void write_ply(const fs::path& file, const TriMesh& mesh, const std::string& comment);
/// Reads what write_ply has written, triangle for triangle. Throws InputError.
TriMesh read_ply(const fs::path& file);

/// Rounded so that the last bits of a sum do not show.
double rounded(double value);
/// "(x, y, z)" in tenths of a millimetre.
std::string place(const Vec3& p);
Json to_json(const Vec3& p);
Vec3 vec3_from(const Json& json);

}  // namespace insula::case_builder
