// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/rupture_script.h"

#include <fmt/format.h>

#include <cmath>

#include "core/model/formats/file_bytes.h"
#include "tools/case_builder/motion_script.h"
#include "tools/case_builder/rehearsal.h"
#include "tools/case_builder/scenes.h"

namespace insula::case_builder {
namespace {

// Of the blades above the neck's plane, in diameters of the neck; the first one is taken without a rehearsal.
constexpr double heights[] = {0.3, 0.0, 0.2, 0.4};

std::string rupture_motion(const ClipPlan& plan, const ApplierPose& temporary, const SceneFacts& facts,
                           const artery::Neck& neck, double height) {
  const Approach& approach = facts.approach;
  ApplierPose permanent = plan.pose;
  permanent.tip += height * neck.diameter * neck.normal;
  MotionScript m;
  m.command(1, "bleeding rupture");
  m.command(0.1, "applier load " + facts.temporary);
  m.place_clip(temporary, 9, 2.0);
  ApplierPose away = drawn_back(temporary, out_of_field);
  away.tip += 30 * approach.to_surgeon;
  m.key(true, 0.8, away);
  m.command(std::round((m.time(true) + 0.2) * 1000) / 1000, "applier load " + plan.clip.name);
  m.key(true, 0.5, away);
  m.place_clip(permanent, out_of_field, 2.5);
  m.take_clip(temporary);
  m.key(true, 8, drawn_back(temporary, out_of_field));
  // The suction tube, dipped into the field beside the neck.
  const Vec3 &shaft = approach.suction_shaft,
             flat = (approach.suction_flat - approach.suction_flat.dot(shaft) * shaft).normalized();
  const ApplierPose low{neck.centre + approach.suction_beside_neck + 6 * shaft, flat, shaft},
      outside = drawn_back(low, 26);
  m.key(false, 0.01, outside);
  m.key(false, 1.5, outside);
  m.key(false, 2, low, true);
  m.key(false, std::max(1.0, m.time(true) - 10), low, true);
  m.key(false, 2, outside);
  return m.csv();
}

struct Outcome {
  int flaws = 0;  ///< goals missed count ten times as much as a measure out of its band
  bool sound = false;
  std::string told;
};

/// To the end of the motion, also after the exercise is done: a clip may still slide. Forces are left out, since the
/// script cannot know them. A narrowed vessel that lets its flow through is told and not refused.
Outcome outcome(const fs::path& scene, double share_from, Progress& progress) {
  const Rehearsal played(scene, "exercise 4", true,
                         [&](double done) { progress.share(share_from + done / double(std::size(heights))); });
  Outcome out;
  bool narrowed_only = true;
  const auto count = [&](int weight, const std::string& what) {
    out.flaws += weight;
    tell(out.told, what);
  };
  const ExerciseLog& log = played.simulation().exercise()->log();
  for (const GoalState& g : log.goals())
    if (g.required && !g.done) count(10, fmt::format("\"{}\" is not reached", g.text)), narrowed_only = false;
  for (const FaultState& f : log.faults())
    if (f.count > 0 && !f.id.ends_with("_force")) count(10, in_words(f)), narrowed_only = false;
  for (const MeasureState& m : log.measures())
    if (m.known && m.good < 0) {
      count(1, in_words(m));
      narrowed_only = narrowed_only && m.id.ends_with(".stenosis_pct");
    }
  out.sound = narrowed_only;
  return out;
}

}  // namespace

void script_rupture(const CaseFolder& folder, const artery::Vessel& vessel, const ClipPlan& plan,
                    const ApplierPose& temporary, const SceneFacts& facts, bool rehearse, std::vector<Note>& notes,
                    Progress& progress) {
  const auto write = [&](double height) {
    write_text(folder.path / "4_rupture_steady.csv", rupture_motion(plan, temporary, facts, *vessel.neck, height));
  };
  if (!rehearse || plan.leaves_remnant()) return write(heights[0]);
  progress.step("rehearsing the rupture");
  double best_height = heights[0], played = 0;
  Outcome best;
  for (const double height : heights) {
    write(height);
    const Outcome now = outcome(exercise_file(folder, 4), played / double(std::size(heights)), progress);
    if (played++ == 0 || now.sound || now.flaws < best.flaws) best = now, best_height = height;
    if (now.sound) break;
  }
  write(best_height);
  if (!best.told.empty())
    notes.push_back(problem("rupture_motion_fails",
                            "The scripted hands of exercise 4 are not perfect: " + best.told + ".",
                            "Place the clip of that exercise by hand, or choose another one with --clip."));
}

}  // namespace insula::case_builder
