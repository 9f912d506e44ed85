// SPDX-License-Identifier: GPL-3.0-or-later
// Two hands with random motions around an exercise's field. The motions are smooth, fast and slow, with rotations,
// buttons, exchanges of tools, and clips that are loaded and released. At the end both hands draw back along their
// shafts and rest at home. Motion k of a seed does not depend on earlier motions.
#pragma once
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/random.h"
#include "core/sim/motion.h"
#include "core/sim/simulation.h"
#include "plugins/clip/clip_applier.h"

namespace insula::test {

struct RandomHandsSettings {
  double busy = 3;          ///< time of random motion, s
  double rest = 1.5;        ///< at home at the end, s
  double half_box = 12e-3;  ///< the targets' box is twice this wide, about what the microscope looks at, m
  double min_speed = 0.02, max_speed = 0.5;  ///< highest speed of a stroke, m/s
  double max_spin = 6;                       ///< rad/s
  double max_tilt = 0.6;                     ///< from the orientation at home, rad
};

/// A sequence of strokes with the smoothest speed that starts and ends at rest (minimum jerk: its peak is 15/8 of its
/// mean).
class StrokeWriter {
 public:
  StrokeWriter(Motion& motion, int hand, const Pose& start) : motion_(motion), hand_(hand), pose_(start) { key(); }

  void stroke(const Pose& target, double speed, double spin) {
    const Vec6 motion = displacement(pose_, target);
    const double length = motion.head<3>().norm(), angle = motion.tail<3>().norm();
    const double duration = std::max({15.0 / 8 * length / speed, 15.0 / 8 * angle / spin, 0.02});
    const int n = std::max(2, int(std::ceil(duration / 0.01)));
    const Pose from = pose_;
    for (int i = 1; i <= n; ++i) {
      const double x = double(i) / n;
      pose_ = displaced(from, x * x * x * (10 - 15 * x + 6 * x * x) * motion);
      time_ += duration / n;
      key();
    }
  }
  void hold(double duration) {
    time_ += duration;
    key();
  }
  void buttons(bool one, bool two) {
    one_ = one;
    two_ = two;
  }
  double time() const { return time_; }
  const Pose& pose() const { return pose_; }
  bool one() const { return one_; }
  bool two() const { return two_; }

 private:
  void key() { motion_.add(hand_, {time_, {pose_, one_, two_}}); }
  Motion& motion_;
  int hand_;
  Pose pose_;
  double time_ = 0;
  bool one_ = false, two_ = false;
};

inline Vec3 random_direction(Random& r) {
  const double z = r.uniform(-1, 1), a = r.uniform(0, 2 * std::numbers::pi), s = std::sqrt(1 - z * z);
  return {s * std::cos(a), s * std::sin(a), z};
}

/// Random commands of a hand. They are more frequent at the start, when the hand is still outside and they are not
/// refused.
inline void random_commands(Motion& motion, const Simulation& s, int hand, Random& r, double busy) {
  std::vector<const Instrument*> tools;
  for (const Instrument* i : s.instruments())
    if (i->hand_index() == hand) tools.push_back(i);
  const auto exchange = [&](double t) {
    const auto* tool = tools[r.below(std::uint32_t(tools.size()))];
    motion.add(MotionCommand{t, "exchange", (hand == 0 ? "left " : "right ") + tool->id});
  };
  const auto clips = [&](double t, bool at_start) {
    for (const Instrument* i : tools)
      if (const auto* applier = dynamic_cast<const ClipApplier*>(i)) {
        const auto& all = applier->clips();
        const std::uint32_t what = at_start ? 0 : r.below(4);
        const std::string clip = all[r.below(std::uint32_t(all.size()))]->id;
        motion.add(MotionCommand{t, "ask",
                                 applier->id + (what < 2    ? " load " + clip
                                                : what == 2 ? " release"
                                                            : " take")});
      }
  };
  if (tools.size() > 1 && r.uniform() < 0.4) exchange(0.02);
  if (r.uniform() < 0.8) clips(0.05, true);
  for (double t = 0.1 + r.uniform(0, 1.5); t < busy; t += r.uniform(0.2, 1.5)) {
    if (tools.size() > 1 && r.uniform() < 0.5) exchange(t);
    else clips(t, false);
  }
}

inline Motion random_motion(const Simulation& s, std::uint64_t seed, std::uint64_t k,
                            const RandomHandsSettings& settings = {}) {
  Motion motion;
  const Vec3 middle = s.view() ? Vec3(s.view()->target()) : Vec3(Vec3::Zero());
  double end = 0;
  for (int hand = 0; hand < 2; ++hand) {
    const Instrument* tool = s.instrument_of(hand);
    if (!tool) continue;
    Random r(seed, 4 * k + std::uint64_t(hand));
    const Pose home = tool->home_pose();
    StrokeWriter w(motion, hand, home);
    w.hold(r.uniform(0.1, 0.3));
    while (w.time() < settings.busy) {
      Pose target = home;
      for (int c = 0; c < 3; ++c) target.p[c] = middle[c] + r.uniform(-settings.half_box, settings.half_box);
      if (r.uniform() < 0.2) target.p = 0.5 * (target.p + home.p);
      target.q = from_rotation_vector(r.uniform(0, settings.max_tilt) * random_direction(r)) * home.q;
      // Slow and fast strokes are equally frequent.
      const double speed = settings.min_speed * std::pow(settings.max_speed / settings.min_speed, r.uniform());
      w.buttons(r.uniform() < 0.35 ? !w.one() : w.one(), r.uniform() < 0.35 ? !w.two() : w.two());
      w.stroke(target, std::max(speed, 1.5 * (target.p - w.pose().p).norm()), settings.max_spin);
      if (r.uniform() < 0.4) w.hold(r.uniform(0.1, 0.5));
    }
    w.buttons(false, false);
    w.hold(0.05);
    // Out along the shaft, since the path in may be around a corner.
    Pose out = w.pose();
    out.p += out.q * Vec3(0, 0, 40e-3);
    w.stroke(out, 0.15, settings.max_spin);
    w.stroke(home, 0.3, settings.max_spin);
    end = std::max(end, w.time());
    random_commands(motion, s, hand, r, settings.busy);
  }
  for (int hand = 0; hand < 2; ++hand)
    if (motion.has(hand)) motion.add(hand, {end + settings.rest, motion.keys(hand).back().sample});
  return motion;
}

}  // namespace insula::test
