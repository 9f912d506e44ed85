// SPDX-License-Identifier: GPL-3.0-or-later
// Result of a long run of an exercise as data: left alone, and under random hands.
#pragma once
#include <cstdio>
#include <ctime>
#include <vector>

#include "core/registry/registry.h"
#include "engine/live/command_script.h"
#include "tests/exercises/random_hands.h"
#include "tests/exercises/soundness.h"

namespace insula::test {

struct Soak {
  bool ran = false, finite = true;
  double seconds = 0;  ///< simulated
  // Left alone.
  Worst drift;  ///< of any node, vertex, tool or clip from where it was in the same phase of the first beat, m
  std::vector<double> energy;  ///< in the same phase of each beat, J
  // Elements: with the hands at rest, and the worst at any time.
  ElementState rest, ever;
  double first_inverted = -1;  ///< s
  // Hands away and at rest.
  Worst tool, clip;  ///< depth of a core in a surface, m
  Worst astray;      ///< distance of a tool from where its hand holds it, m
  Worst moved;       ///< of a deformable body's nodes from where they were at the start, m
  double cpu_s = 0;  ///< of computing
};

inline SimulationResult open_exercise(const std::filesystem::path& scene) {
  Registry registry;
  register_builtin(registry);
  return load_simulation(scene, registry, 1);
}

/// Positions of everything that can be seen or touched.
class Snapshot {
 public:
  void take(const Simulation& s) {
    points_.clear();
    names_.clear();
    for (const Body* b : s.bodies()) {
      begin(b->id);
      if (const auto* d = dynamic_cast<const DeformableBody*>(b))
        for (int i = 0; i < d->nodes(); ++i) points_.push_back(node(*d, i));
      const auto* rigid = dynamic_cast<const RigidBody*>(b);
      if (!rigid || !rigid->active()) continue;
      for (int link = 0; link < rigid->links(); ++link)
        for (const ConvexPiece& piece : rigid->link_pieces(link))
          for (const Vec3& p : piece.points) points_.push_back(rigid->link_pose(link).apply(p));
    }
    for (Surface* surface : s.surfaces()) {
      if (surface->body().blocks() == 0) continue;
      begin(surface->id);
      surface->update();
      points_.insert(points_.end(), surface->positions().begin(), surface->positions().end());
    }
  }
  void blend(const Snapshot& before, double part) {
    for (std::size_t i = 0; i < points_.size() && i < before.points_.size(); ++i)
      points_[i] = before.points_[i] + part * (points_[i] - before.points_[i]);
  }
  Worst farthest_from(const Snapshot& other) const {
    Worst out;
    if (points_.size() != other.points_.size()) out.most(1e300, "something came or went");
    else
      for (std::size_t n = 0; n < names_.size(); ++n)
        for (std::size_t i = names_[n].first; i < (n + 1 < names_.size() ? names_[n + 1].first : points_.size()); ++i)
          if (const double d = (points_[i] - other.points_[i]).norm(); !(d <= out.value))
            out.most(d, names_[n].second + " " + std::to_string(i - names_[n].first));
    return out;
  }

 private:
  void begin(const std::string& name) { names_.emplace_back(points_.size(), name); }
  std::vector<Vec3> points_;
  std::vector<std::pair<std::size_t, std::string>> names_;  ///< where each begins
};

/// Sets the hands directly: no arm that yields, trembles or limits the speed. A hand without a motion stays at home.
class Hands {
 public:
  explicit Hands(const Motion& motion) : motion_(motion), script_(motion.commands()) {}
  void step(Simulation& s) {
    script_.advance(s);
    for (int hand = 0; hand < 2; ++hand) {
      const Instrument* tool = s.instrument_of(hand);
      if (!tool) continue;
      HandSample at;
      if (motion_.has(hand)) at = motion_.at(hand, s.time() + s.h());
      else at.pose = tool->home_pose();
      s.set_hand(hand, {true, at.pose, at.button1, at.button2});
    }
    s.step();
  }

 private:
  const Motion& motion_;
  CommandScript script_;
};

/// The part of a motion up to t. After that, hands stay at their poses.
inline Motion until(const Motion& motion, double t) {
  Motion out;
  for (int hand = 0; hand < 2; ++hand)
    for (const Motion::Key& k : motion.keys(hand))
      if (k.time_s <= t) out.add(hand, k);
  for (const MotionCommand& c : motion.commands())
    if (c.time_s <= t) out.add(c);
  return out;
}

/// Draws complications with a seed for which none comes later than t.
inline void no_complication_after(Simulation& s, double t) {
  if (!s.complications()) return;
  for (std::uint64_t seed = 1; seed < 10000; ++seed) {
    s.draw_complications(seed);
    bool late = false;
    for (const DrawnComplication& c : s.complications()->drawn()) late = late || (c.happens && c.time > t);
    if (!late) return;
  }
}

struct IdleSettings {
  std::string motion;     ///< id, empty: no hand ever moves
  double hold_from = 0;   ///< of the motion no more than this is played, s
  double settle = 1.5;    ///< after that, before the first beat that counts, s
  double duration = 600;  ///< from then on, s
};

/// Plays, then holds still and compares each beat with the first in the same phase, late in diastole.
inline Soak leave_alone(const std::filesystem::path& scene, const IdleSettings& settings, bool speak) {
  Soak out;
  const std::clock_t begin = std::clock();
  SimulationResult loaded = open_exercise(scene);
  if (!loaded.simulation) return out;
  Simulation& s = *loaded.simulation;
  no_complication_after(s, settings.hold_from);
  Motion motion;
  if (s.exercise())
    for (const MotionEntry* m : s.exercise()->motions())
      if (m->id == settings.motion) motion = until(load_motion(m->file()), settings.hold_from);
  Hands hands(motion);
  const double from = settings.hold_from + settings.settle, to = from + settings.duration;
  Snapshot first, before, now;
  constexpr double phase = 0.85;
  double last = 0;
  // The pulse of the scene's pressure; a scene without one counts seconds.
  const ChannelEntry* pulse = nullptr;
  for (const ChannelEntry& e : s.channels().entries())
    if (e.channel->spec().role == Role::pulse) pulse = &e;
  const auto phase_of = [&] { return pulse ? *pulse->channel->values(0) : std::fmod(s.time(), 1.0); };
  while (s.time() < to) {
    const double energy = s.energy();
    const double at = last, coming = s.time() < from ? 0 : last + s.h() * 3;
    const bool near = at < phase && coming >= phase;
    if (near) before.take(s);
    hands.step(s);
    last = phase_of();
    out.finite = out.finite && s.report().finite;
    if (!out.finite) break;
    if (!near || last < phase) continue;
    const double part = (phase - at) / (last - at);
    now.take(s);
    now.blend(before, part);
    if (out.energy.empty()) first = now;
    out.energy.push_back(energy + part * (s.energy() - energy));
    const Worst d = now.farthest_from(first);
    if (d.value > out.drift.value) out.drift = d;
    if (speak && (out.energy.size() < 20 || out.energy.size() % 20 == 1))
      std::printf("    %7.2f s: drift %.2e m (%s), energy %.6e J\n", s.time(), d.value, d.whose.c_str(),
                  out.energy.back()),
          std::fflush(stdout);
  }
  out.finite = out.finite && all_finite(s);
  out.rest = out.ever = look_at_elements(s);
  DepthGauge gauge(s);
  out.tool = gauge.deepest(false);
  out.clip = gauge.deepest(true);
  out.seconds = s.time();
  out.ran = true;
  out.cpu_s = double(std::clock() - begin) / CLOCKS_PER_SEC;
  return out;
}

class RandomCampaign {
 public:
  explicit RandomCampaign(const std::filesystem::path& scene) : loaded_(open_exercise(scene)) {
    if (!loaded_.simulation) return;
    gauge_ = std::make_unique<DepthGauge>(*loaded_.simulation);
    settled_ = look_at_elements(*loaded_.simulation);
  }
  bool opened() const { return loaded_.simulation != nullptr; }
  const Diagnostics& diagnostics() const { return loaded_.diagnostics; }
  /// The state before any hand moved.
  const ElementState& settled() const { return settled_; }

  /// Motion k of the seed, from the start of the exercise. `trace`: prints the state every quarter of a second.
  Soak run(std::uint64_t seed, std::uint64_t k, const RandomHandsSettings& settings, bool trace = false) {
    Soak out;
    const std::clock_t begin = std::clock();
    Simulation& s = *loaded_.simulation;
    if (used_) s.reset();
    used_ = true;
    const Motion motion = random_motion(s, seed, k, settings);
    Hands hands(motion);
    std::vector<VecX> start;
    for (const Body* b : s.bodies())
      if (const auto* d = dynamic_cast<const DeformableBody*>(b)) start.push_back(d->q());
    for (const double end = motion.duration(); s.time() < end && out.finite;) {
      hands.step(s);
      out.finite = s.report().finite;
      if (s.steps() % 5 == 0) watch(out);
      if (trace && s.steps() % 15 == 0) say(motion);
    }
    out.finite = out.finite && all_finite(s);
    out.rest = look_at_elements(s);
    out.tool = gauge_->deepest(false);
    out.clip = gauge_->deepest(true);
    std::size_t n = 0;
    for (const Body* b : s.bodies()) {
      if (const auto* i = dynamic_cast<const Instrument*>(b); i && i->active() && i->hand_index() >= 0)
        out.astray.most((i->pose().p - i->device().p).norm(), i->id);
      if (const auto* d = dynamic_cast<const DeformableBody*>(b)) {
        const VecX displacement = d->q() - start[n++];
        for (int i = 0; i < d->nodes(); ++i)
          out.moved.most(displacement.segment<3>(3 * i).norm(), d->id + " " + std::to_string(i));
      }
    }
    out.seconds = s.time();
    out.ran = true;
    out.cpu_s = double(std::clock() - begin) / CLOCKS_PER_SEC;
    return out;
  }

 private:
  void watch(Soak& out) const {
    const ElementState e = look_at_elements(*loaded_.simulation);
    if (e.inverted > 0 && out.first_inverted < 0) out.first_inverted = loaded_.simulation->time();
    out.ever.inverted = std::max(out.ever.inverted, e.inverted);
    out.ever.volume.least(e.volume.value, e.volume.whose);
    out.ever.area.least(e.area.value, e.area.whose);
    out.ever.inside.least(e.inside.value, e.inside.whose);
  }
  void say(const Motion& motion) {
    const Simulation& s = *loaded_.simulation;
    const ElementState e = look_at_elements(s);
    const Worst deep = gauge_->deepest(false);
    std::map<std::string, std::array<double, 3>> by_pair;
    for (const ContactPoint& c : s.report().contacts) {
      auto& sum = by_pair[c.a->id + " on " + c.b->id];
      sum[0] += 1;
      sum[1] += c.normal_force;
      sum[2] = std::min(sum[2], c.gap);
    }
    std::printf(
        "    %6.2f s: inverted %d, volume %.3f (%s), area %.3f (%s), inside %.3f, core %.2f mm (%s), rows %d, sweeps "
        "%d, energy %.3e\n",
        s.time(), e.inverted, e.volume.value, e.volume.whose.c_str(), e.area.value, e.area.whose.c_str(),
        e.inside.value, 1e3 * deep.value, deep.whose.c_str(), s.report().rows, s.report().solve.sweeps, s.energy());
    for (const auto& [names, sum] : by_pair)
      if (sum[1] > 0.02)
        std::printf("        %s: %d contacts, %.2f N, gap down to %.2f mm\n", names.c_str(), int(sum[0]), sum[1],
                    1e3 * sum[2]);
    for (int hand = 0; hand < 2; ++hand)
      if (const Instrument* i = s.instrument_of(hand)) {
        const HandSample at = motion.at(hand, s.time());
        std::printf("        %-12s at %6.1f %6.1f %6.1f mm, hand at %6.1f %6.1f %6.1f mm\n", i->id.c_str(),
                    1e3 * i->pose().p.x(), 1e3 * i->pose().p.y(), 1e3 * i->pose().p.z(), 1e3 * at.pose.p.x(),
                    1e3 * at.pose.p.y(), 1e3 * at.pose.p.z());
      }
    for (const Event& x : s.events()) std::printf("        %s %s %s\n", x.kind.c_str(), x.id.c_str(), x.text.c_str());
    std::fflush(stdout);
  }

  SimulationResult loaded_;
  std::unique_ptr<DepthGauge> gauge_;
  ElementState settled_;
  bool used_ = false;
};

}  // namespace insula::test
