// SPDX-License-Identifier: GPL-3.0-or-later
// A clip that must be let go at a marked place of a tube, square to it.
#pragma once
#include "plugins/clip/clip_state.h"
#include "plugins/skill_rules/ring.h"
#include "plugins/skill_rules/skill_goal.h"

namespace insula {

class GoalClipPlaced final : public SkillGoal {
 public:
  Param<Vec<Scalar>> axis{this, {.name = "axis", .doc = "direction of the tube at the mark"}};
  Param<Angle> angle{this,
                     {.name = "angle",
                      .fallback = "20 deg",
                      .min = "1 deg",
                      .max = "90 deg",
                      .doc = "largest deviation of the blades from square to the tube"}};
  Param<Length> ring_radius{this,
                            {.name = "ring_radius",
                             .fallback = "2 mm",
                             .min = "0.1 mm",
                             .max = "50 mm",
                             .doc = "of the ring about the tube"}};
  Param<std::string> elsewhere{this,
                               {.name = "elsewhere",
                                .fallback = "A clip was let go beside the mark",
                                .doc = "what the trainee is told when a clip is let go in another place"}};

  Channel<Length> off{this,
                      {.name = "off",
                       .doc = "distance of the clip's blades from the mark",
                       .min = "0 mm",
                       .shown = Shown::curve,
                       .display = "mm",
                       .digits = 1}};
  Marks<Polylines> ring{this, "0.3 mm", ring_points};

  void prepare(PrepareContext& context) override {
    SkillGoal::prepare(context);
    if (axis().norm() < 1e-9) error(context, axis, "a direction must not be zero");
  }
  void declare(PrepareContext& context, const Simulation& simulation, ExerciseLog& log) override {
    SkillGoal::declare(context, simulation, log);
    clips_ = Clips(simulation);
    fault_ = log.add_fault(id + "_elsewhere", elsewhere());
    free_.assign(clips_.now().size(), 0);
  }
  void publish() override {
    SkillGoal::publish();
    off.set(least_);
  }
  void reset() override {
    SkillGoal::reset();
    free_.assign(free_.size(), 0);
    least_ = std::nan("");
  }

 protected:
  void mark(Look look, double share) override { draw_ring(ring.only(look), at(), axis(), ring_radius(), 1, share); }
  void watch(const StepReport& report, ExerciseLog& log) override {
    least_ = std::nan("");
    placed_ = false;
    const auto& clips = clips_.now();
    for (std::size_t i = 0; i < clips.size(); ++i) {
      const ClipState& clip = clips[i];
      const bool is_free = !clip.on_tray && !clip.holder, right = fits(clip);
      if (!clip.on_tray) least_ = std::fmin(least_, distance_of(clip));
      placed_ = placed_ || (is_free && right);
      if (is_free && !free_[i] && !right) log.fault(fault_, report.time, distance_of(clip));
      free_[i] = is_free;
    }
  }
  bool good(const StepReport&) override { return placed_; }
  double deviation(const StepReport&) const override { return least_; }

 private:
  /// Distance of the blades' line from the mark, m.
  double distance_of(const ClipState& clip) const {
    const Vec3 d = clip.blade_tip - clip.blade_root;
    const double s = std::clamp((at() - clip.blade_root).dot(d) / d.squaredNorm(), 0.0, 1.0);
    return (clip.blade_root + s * d - at()).norm();
  }
  bool fits(const ClipState& clip) const {
    const double along = (clip.blade_tip - clip.blade_root).normalized().dot(axis().normalized());
    return distance_of(clip) <= radius() && std::abs(along) <= std::sin(angle());
  }

  Clips clips_;
  int fault_ = 0;
  std::vector<char> free_;       ///< by clip: let go before
  double least_ = std::nan("");  ///< m; NaN: no clip is in the field
  bool placed_ = false;
};

}  // namespace insula
