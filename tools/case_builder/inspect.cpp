// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/inspect.h"

#include "core/base/input_error.h"
#include "core/model/geometry/box_tree.h"
#include "tools/case_builder/intake.h"
#include "tools/case_builder/mirror.h"
#include "tools/case_builder/volume_input.h"
#include "tools/case_builder/wall.h"
#ifdef INSULA_WITH_ITK
#include "tools/case_builder/scan_look.h"
#endif

namespace insula::case_builder {
namespace {

/// Of the author's file: what is mirrored is mirrored back.
void unmirror(Intake& in) {
  mirror(in.surface.mesh);
  for (Json& opening : in.facts.at("openings"))
    for (const char* place : {"centre", "normal"}) opening[place][0] = 0.0 - opening[place][0].get<double>();
}

Json size_of(const TriMesh& m) {
  Box box;
  for (const Vec3& p : m.vertices) box.extend(p);
  return to_json(box.sizes());
}

/// What there is to choose from, before the vessel is known.
void run_scan_look(const fs::path& input, const fs::path& folder, std::FILE* out, Progress& progress) {
  progress.stage("scan", 3);
  progress.step("reading " + input.filename().string());
  const mesh_tool::NiftiVolume volume = read_any_volume(input);
#ifdef INSULA_WITH_ITK
  progress.step("looking at its values");
  const ScanLook look = look_at(volume);
  progress.step("writing");
  if (folder.empty()) {
    std::fprintf(out, "%s\n", look.facts.dump(1).c_str());
  } else {
    fs::create_directories(folder);
    write_nameless(folder / "scan.mha", volume);
    write_text(folder / "scan.raw", look.block);
    write_json(folder / "scan.json", look.facts);
  }
  progress.finish();
#else
  (void)folder, (void)out;
#endif
}

}  // namespace

Inspection inspect(const fs::path& input, const Options& options, Progress& progress) {
  progress.stage("inspect", 4);
  Intake in = take_in(input, options, progress, Openings::any);
  Inspection out;
  progress.step("looking for the neck");
  std::string problem;
  Json neck{{"confidence", 0}, {"proposals", Json::array()}};
  if (in.surface.caps.size() < 2) problem = "a vessel needs an inlet and an outlet: cut its ends";
  else try {
      const artery::Vessel v = with_proposals(in.surface, as_read(options));
      if (v.neck) neck = neck_json(v, options.mirror);
      else problem = "no sac was found: nothing of the wall bulges out of the vessels by half of their radius";
    } catch (const InputError& e) {
      problem = e.what();
    }
  if (options.mirror) unmirror(in);
  out.facts = in.facts;
  out.facts["size_mm"] = size_of(in.surface.mesh);
  out.facts["neck"] = neck;
  out.facts["problem"] = problem;
  out.facts["notes"] = to_json(in.notes);
  out.surface = std::move(in.surface.mesh);
  return out;
}

void run_inspect(const fs::path& input, const fs::path& folder, const Options& options, std::FILE* out,
                 Progress& progress) {
  if (is_volume_input(input) && !options.threshold && !options.label)
    return run_scan_look(input, folder, out, progress);
  const Inspection found = inspect(input, options, progress);
  progress.step("writing");
  if (folder.empty()) {
    std::fprintf(out, "%s\n", found.facts.dump(1).c_str());
  } else {
    write_ply(folder / "surface.ply", found.surface, "unit mm; a vessel as it was given, mended and closed");
    write_json(folder / "inspect.json", found.facts);
  }
  progress.finish();
}

}  // namespace insula::case_builder
