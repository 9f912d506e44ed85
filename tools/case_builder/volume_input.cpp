// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/volume_input.h"

#include "core/base/input_error.h"
#include "core/model/formats/file_bytes.h"
#include "tools/case_builder/crop.h"
#include "tools/case_builder/grid_surface.h"
#include "tools/case_builder/mirror.h"
#include "tools/case_builder/series_archive.h"
#ifdef INSULA_WITH_ITK
#include "tools/case_builder/volume_reader.h"
#endif

namespace insula::case_builder {
namespace {

#ifdef INSULA_WITH_ITK
mesh_tool::NiftiVolume read_archive(const fs::path& input) {
  const RemovedAtEnd series = unpacked_series(input);
  try {
    return read_volume(series.path());
  } catch (const InputError& e) {
    // The author knows no such folder.
    std::string said = e.what();
    for (std::size_t at; (at = said.find(series.path().string())) != std::string::npos;)
      said.replace(at, series.path().string().size(), input.string());
    throw InputError(said);
  }
}
#endif

}  // namespace

bool is_volume_input(const fs::path& input) {
  const std::string kind = lower_extension(input);
  return fs::is_directory(input) || kind == ".nii" || kind == ".gz" || kind == ".mha" || kind == ".mhd" ||
         kind == ".nrrd" || kind == ".dcm" || kind == ".zip";
}

mesh_tool::NiftiVolume read_any_volume(const fs::path& input) {
#ifdef INSULA_WITH_ITK
  return lower_extension(input) == ".zip" ? read_archive(input) : read_volume(input);
#else
  fail(input, "volumes need ITK (Debian: libinsighttoolkit5-dev), which was not there when this program was built");
#endif
}

TriMesh read_volume_surface(const fs::path& input, const Options& options, std::vector<Note>& notes,
                            std::vector<Plane>& ends) {
  if (options.label && options.threshold) fail(input, "--label and --threshold exclude each other");
  if (options.unit_mm) fail(input, "a volume says its unit itself; --unit is for surfaces");
  if (options.around && !options.seed) fail(input, "--around needs the middle of what is taken: name it with --seed");
  mesh_tool::NiftiVolume volume = read_any_volume(input);
  if (options.mirror) mirror(volume);
  if (options.around) volume = cropped(input, volume, *options.seed, *options.around);
  notes.push_back({Note::Kind::fact,
                   "Only voxels and their positions were taken from the scan. No other tags were copied, such as the "
                   "name of a person.",
                   ""});
  return surface_of_volume(input, volume, options, notes, ends);
}

}  // namespace insula::case_builder
