// SPDX-License-Identifier: GPL-3.0-or-later
// Targets from a motion, by the Ramer-Douglas-Peucker algorithm on poses.
#include "engine/live/motion_guide.h"

#include <algorithm>

namespace insula {
namespace {

using Keys = std::vector<Motion::Key>;

/// Distance of two poses in tolerances.
double apart(const Pose& a, const Pose& b, const TargetSettings& s) {
  const Vec6 d = displacement(a, b);
  return std::max(d.head<3>().norm() / s.tolerance_m, d.tail<3>().norm() / s.tolerance_rad);
}

/// Length of the way up to each key, in tolerances: the parameter along the way, which a pause does not advance.
std::vector<double> way_of(const Keys& keys, const TargetSettings& s) {
  std::vector<double> way(keys.size(), 0.0);
  for (std::size_t i = 1; i < keys.size(); ++i)
    way[i] = way[i - 1] + apart(keys[i - 1].sample.pose, keys[i].sample.pose, s);
  return way;
}

/// Marks the keys between `first` and `last` that are needed so that none is farther than a tolerance from the way.
void mark_turns(const Keys& keys, const std::vector<double>& way, std::size_t first, std::size_t last,
                const TargetSettings& s, std::vector<char>& needed) {
  if (last <= first + 1) return;
  const Pose& a = keys[first].sample.pose;
  const Vec6 whole = displacement(a, keys[last].sample.pose);
  const double length = way[last] - way[first];
  std::size_t worst = first;
  double most = 1;
  for (std::size_t i = first + 1; i < last; ++i) {
    const double share = length > 0 ? (way[i] - way[first]) / length : 0;
    const double off = apart(displaced(a, share * whole), keys[i].sample.pose, s);
    if (off > most) {
      most = off;
      worst = i;
    }
  }
  if (worst == first) return;
  needed[worst] = 1;
  mark_turns(keys, way, first, worst, s, needed);
  mark_turns(keys, way, worst, last, s, needed);
}

/// Marks the ends, the keys at which a button changes, and the turns between them.
std::vector<char> marked(const Keys& keys, const TargetSettings& s) {
  std::vector<char> needed(keys.size(), 0);
  if (keys.empty()) return needed;
  needed.front() = needed.back() = 1;
  for (std::size_t i = 1; i < keys.size(); ++i) {
    const HandSample &a = keys[i - 1].sample, &b = keys[i].sample;
    if (a.button1 != b.button1 || a.button2 != b.button2) needed[i] = 1;
  }
  const std::vector<double> way = way_of(keys, s);
  std::size_t from = 0;
  for (std::size_t i = 1; i < keys.size(); ++i) {
    if (!needed[i]) continue;
    mark_turns(keys, way, from, i, s, needed);
    from = i;
  }
  return needed;
}

/// The instrument that the motion has in the hand at that time: the first one, or the last that it has taken up.
std::string tool_at(const Motion& motion, const Simulation& simulation, int hand, double time_s) {
  std::string tool;
  for (const Instrument* i : simulation.instruments())
    if (tool.empty() && i->hand_index() == hand) tool = i->id;
  const std::string side = hand == 0 ? "left " : "right ";
  for (const MotionCommand& c : motion.commands())
    if (c.verb == "exchange" && c.time_s <= time_s && c.argument.starts_with(side))
      tool = c.argument.substr(side.size());
  return tool;
}

/// What the motion has asked of an instrument last by that time, as "command argument"; empty: nothing.
std::string asked_of(const Motion& motion, const std::string& tool, double time_s) {
  std::string asked;
  for (const MotionCommand& c : motion.commands())
    if (c.verb == "ask" && c.time_s <= time_s && c.argument.starts_with(tool + ' '))
      asked = c.argument.substr(tool.size() + 1);
  return asked;
}

bool idle(const HandSample& s) { return !s.button1 && !s.button2; }

GuidePose pose_of(const Motion& motion, const Simulation& simulation, int hand, std::size_t at) {
  const Keys& keys = motion.keys(hand);
  const Motion::Key& key = keys[at];
  GuidePose pose{hand, tool_at(motion, simulation, hand, key.time_s), key.time_s, key.sample, "", ""};
  const auto beside = [&](std::size_t i) { return i >= keys.size() || idle(keys[i].sample); };
  pose.passes = idle(key.sample) && beside(at - 1) && beside(at + 1);
  const std::string asked = asked_of(motion, pose.tool, key.time_s);
  const std::size_t space = std::min(asked.find(' '), asked.size());
  pose.command = asked.substr(0, space);
  pose.argument = asked.substr(std::min(space + 1, asked.size()));
  return pose;
}

}  // namespace

std::vector<GuidePose> guide_poses(const Motion& motion, const Simulation& simulation, const TargetSettings& settings) {
  std::vector<GuidePose> out;
  for (int hand = 0; hand < 2; ++hand) {
    const Keys& keys = motion.keys(hand);
    TargetSettings s = settings;
    std::vector<char> needed = marked(keys, s);
    while (std::size_t(std::count(needed.begin(), needed.end(), 1)) > settings.most_poses && s.tolerance_m < 1) {
      s.tolerance_m *= 2;
      s.tolerance_rad *= 2;
      needed = marked(keys, s);
    }
    for (std::size_t i = 0; i < keys.size(); ++i)
      if (needed[i]) out.push_back(pose_of(motion, simulation, hand, i));
  }
  return out;
}

}  // namespace insula
