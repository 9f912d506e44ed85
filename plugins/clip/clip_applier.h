// SPDX-License-Identifier: GPL-3.0-or-later
// A clip applier: the instrument that holds, opens, releases and takes clips. Described in clip_applier.cpp.
#pragma once
#include <string>
#include <vector>

#include "core/mechanics/instrument.h"
#include "core/sim/events.h"
#include "plugins/clip/clip.h"

namespace insula {

class ClipApplier final : public Instrument {
 public:
  RefList<Clip> clips{this, {.name = "clips", .doc = "clips it can be loaded with"}};
  Ref<Clip> first{this, {.name = "load", .fallback = "", .doc = "clip in it at the start; none: it begins empty"}};
  Param<Duration> open_time{this,
                            {.name = "open_time",
                             .fallback = "0.3 s",
                             .min = "0.02 s",
                             .max = "10 s",
                             .doc = "from closed to fully open while the button is held, and back"}};
  Param<Length> reach{this,
                      {.name = "reach",
                       .fallback = "4 mm",
                       .min = "0.1 mm",
                       .max = "20 mm",
                       .doc = "a clip in the field is taken when its grip is this near"}};
  Param<Angle> alignment{this,
                         {.name = "alignment",
                          .fallback = "40 deg",
                          .min = "1 deg",
                          .max = "90 deg",
                          .doc = "and turned from the applier by no more than this"}};
  Param<Duration> settle_time{this,
                              {.name = "settle_time",
                               .fallback = "0.3 s",
                               .min = "0.05 s",
                               .max = "5 s",
                               .doc = "in which a clip taken askew slides into the applier's jaws"}};

  EventKind loaded{this, {.name = "clip_loaded", .doc = "a clip came from the tray into the applier"}};
  EventKind shut{this, {.name = "clip_shut", .doc = "the jaws of the held clip are shut again"}};
  EventKind released{this, {.name = "clip_released", .doc = "a clip was let go in the field"}};
  EventKind taken{this, {.name = "clip_taken", .doc = "a clip was taken back"}};
  EventKind warning{this, {.name = "warning", .doc = "a button could not do what was wanted; the text says why"}};

  void join(PrepareContext& context, Simulation& simulation) override;
  Clip* clip() const { return clip_; }
  double held_opening() const {
    return held_opening_;
  }                                                  ///< opening below which it does not let its clip's jaws close, rad
  const Pose& clip_pose() const { return target_; }  ///< of its clip's frame at the end of this step
  Pose clip_home(const Clip& clip) const;            ///< of a loaded clip at the applier's home

  bool cutting() const override { return false; }
  double activity() const override;
  std::string why_kept() const override;
  std::vector<BodyProperty> properties() const override;  ///< how near and how straight it must be to take a clip
  void take_up(const Pose& device) override;
  void lay_down() override;
  void free_motion(const StepContext& context) override;
  void build(const StepContext& context, ConstraintBuilder& builder) override;
  void finish(const StepContext& context, const ConstraintSolution& solution) override;
  void reset() override;
  void append_state(std::vector<double>& out) const override;
  std::vector<CommandInfo> commands() const override;
  std::string run_command(std::string_view name, std::string_view argument) override;

 private:
  void grasp(Clip* clip, const Pose& relative, const Pose& nominal);
  void empty();
  std::string load(std::string_view id);
  std::string release();
  std::string take();
  void say(const EventKind& event, const std::string& what, std::string text);
  void join_rows(ConstraintBuilder& builder) const;

  Clip *clip_ = nullptr, *start_clip_ = nullptr;
  Pose taken_, nominal_,
      target_;           ///< of the clip in the applier's frame: when grasped, at rest, at the end of the step
  double held_for_ = 0;  ///< s
  double held_opening_ = 0;
  bool button2_ = false, touched_ = false;
  std::vector<Event> said_;
};

}  // namespace insula
