// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/volume_input.h"

#include "core/model/formats/file_bytes.h"
#include "tools/case_builder/grid_surface.h"
#include "tools/case_builder/mirror.h"
#ifdef INSULA_WITH_ITK
#include "tools/case_builder/volume_reader.h"
#endif

namespace insula::case_builder {

bool is_volume_input(const fs::path& input) {
  const std::string kind = lower_extension(input);
  return fs::is_directory(input) || kind == ".nii" || kind == ".gz" || kind == ".mha" || kind == ".mhd" ||
         kind == ".dcm";
}

TriMesh read_volume_surface(const fs::path& input, const Options& options, std::vector<Note>& notes,
                            std::vector<Plane>& ends) {
  if (options.label && options.threshold) fail(input, "--label and --threshold exclude each other");
  if (options.unit_mm) fail(input, "a volume says its unit itself; --unit is for surfaces");
#ifdef INSULA_WITH_ITK
  mesh_tool::NiftiVolume volume = read_volume(input);
  if (options.mirror) mirror(volume);
  return surface_of_volume(input, volume, options, notes, ends);
#else
  (void)notes, (void)ends;
  fail(input, "volumes need ITK (Debian: libinsighttoolkit5-dev), which was not there when this program was built");
#endif
}

}  // namespace insula::case_builder
