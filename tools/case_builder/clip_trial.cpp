// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/clip_trial.h"

#include <cctype>

#include "core/base/input_error.h"
#include "core/base/removed_at_end.h"
#include "core/model/formats/file_bytes.h"
#include "tools/case_builder/approach.h"
#include "tools/case_builder/clipping_rehearsal.h"
#include "tools/case_builder/place.h"
#include "tools/case_builder/scenes.h"
#include "tools/case_builder/wall.h"

namespace insula::case_builder {
namespace {

constexpr double shaft_shown = 12;     // mm
constexpr double blades_apart = 0.45;  // from the middle of the closed clip to that of each blade, mm

bool is_of_name(char c) { return std::isalnum(static_cast<unsigned char>(c)) || c == '_'; }

/// As a whole name.
void replace_names(std::string& text, const std::string& what, const std::string& by) {
  for (std::size_t at = 0; (at = text.find(what, at)) != std::string::npos;) {
    const std::size_t end = at + what.size();
    const bool whole = (at == 0 || !is_of_name(text[at - 1])) && (end == text.size() || !is_of_name(text[end]));
    if (whole) text.replace(at, what.size(), by);
    at += whole ? by.size() : what.size();
  }
}

/// Files beside those of the case that are gone afterwards.
struct Beside {
  RemovedAtEnd field, scene, motion;
  explicit Beside(const fs::path& folder)
      : field(folder / "clip_trial_field.xml"), scene(folder / "clip_trial.xml"), motion(folder / "clip_trial.csv") {}
};

std::string replaced(std::string text, const std::string& what, const std::string& by, const fs::path& file) {
  const std::size_t at = text.find(what);
  if (at == std::string::npos) fail(file, "does not name " + what + "; do the stage scenes again");
  return text.replace(at, what.size(), by);
}

void write_beside(const CaseFolder& folder, const Beside& to, const std::string& clip) {
  const fs::path scene = exercise_file(folder, 3);
  std::string text = read_file_bytes(scene);
  text = replaced(text, "\"field.xml\"", "\"" + to.field.path().filename().string() + "\"", scene);
  text = replaced(text, "\"3_clipping_steady.csv\"", "\"" + to.motion.path().filename().string() + "\"", scene);
  write_text(to.scene.path(), text);
  write_text(to.field.path(), with_clip(read_file_bytes(folder.path / "field.xml"), clip));
}

/// A case outside of the project has copies of its clips. The folder of one that it did not have.
RemovedAtEnd brought_clip(const CaseFolder& folder, const fs::path& project, const std::string& clip) {
  const fs::path own = folder.path / "meshes/clips";
  if (!fs::is_directory(own) || fs::exists(own / clip)) return RemovedAtEnd();
  RemovedAtEnd copy(own / clip);
  fs::copy(project / "meshes/clips" / clip, copy.path(), fs::copy_options::recursive);
  return copy;
}

/// From the fissure back to the author's file.
class WayBack {
 public:
  WayBack(const CaseFolder& folder, bool mirrored)
      : placement_(placement_from(read_json(folder.path / "place.json"))), mirrored_(mirrored) {}
  Json operator()(const Vec3& p) const {
    Vec3 out = placement_.rotation.transpose() * (p - placement_.shift);
    if (mirrored_) out.x() = -out.x();
    return to_json(out);
  }

 private:
  Placement placement_;
  bool mirrored_;
};

Json blades_of(const ClipPlan& plan, const WayBack& back) {
  // The clip's frame has its grip at the applier's tip.
  const Mat3 turn = plan.pose.rotation();
  const Vec3 middle = plan.pose.tip + turn * (plan.clip.middle - plan.clip.grip),
             half = 0.5 * plan.clip.blade * (turn * plan.clip.inward);
  Json out = Json::array();
  for (const double side : {-blades_apart, blades_apart})
    out.push_back({back(middle - half + side * plan.pose.flat), back(middle + half + side * plan.pose.flat)});
  return {
      {"blades", out}, {"grip", back(plan.pose.tip)}, {"shaft", back(plan.pose.tip + shaft_shown * plan.pose.shaft)}};
}

}  // namespace

std::string with_clip(std::string part, const std::string& clip) {
  constexpr std::string_view first = "<clip id=\"";
  if (part.find(std::string(first) + clip + "\"") != std::string::npos) return part;
  const std::size_t at = part.find(first);
  if (at == std::string::npos) throw InputError("field.xml has no clip on its tray; do the stage scenes again");
  const std::size_t name = at + first.size();
  replace_names(part, part.substr(name, part.find('"', name) - name), clip);
  return part;
}

Json try_clip(const CaseFolder& folder, const fs::path& project, const Options& o, Progress& progress) {
  progress.stage("clip", 3);
  progress.step("laying the blades");
  const artery::Vessel v = read_wall(folder.artery());
  if (!v.neck) throw InputError("the vessel has no neck; do the stage wall again");
  const Approach approach = read_approach(project, o.approach);
  const Solid floor(read_ply(folder.lobes() / (approach.floor + "_surface.ply")));
  const ClipPlan plan = clip_plans(v, floor, read_clips(project), o, approach).front();
  const Beside beside(folder.path);
  const RemovedAtEnd clip = brought_clip(folder, project, plan.clip.name);
  write_beside(folder, beside, plan.clip.name);
  progress.step("closing the clip");
  const RehearsedClip tried =
      rehearse_clipping(beside.scene.path(), beside.motion.path(), v, {plan}, false, 1, progress);
  progress.step("writing");
  Json out = to_json(tried.outcome);
  out.update({{"clip", tried.plan.clip.name},
              {"lift_mm", rounded(tried.plan.at.lift)},
              {"slide_mm", rounded(tried.plan.at.slide)},
              {"turn_deg", rounded(tried.plan.at.turn)},
              {"tip_past_neck_mm", rounded(tried.outcome.tip_past_neck)},
              {"told", tried.outcome.told},
              {"notes", to_json(notes_of(tried.plan))}});
  // As it lies at the vessel at rest.
  ClipPlan shown = tried.plan;
  shown.lay(*v.neck, shown.at);
  out.update(blades_of(shown, WayBack(folder, o.mirror)));
  progress.finish();
  return out;
}

}  // namespace insula::case_builder
