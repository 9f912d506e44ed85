// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/clipping_rehearsal.h"

#include <fmt/format.h>

#include <algorithm>
#include <array>
#include <cmath>
#include <future>

#include "core/base/input_error.h"
#include "core/mechanics/shell_body.h"
#include "engine/live/headless.h"
#include "tools/case_builder/motion_script.h"
#include "tools/case_builder/neck_frame.h"
#include "tools/case_builder/rehearsal.h"
#include "tools/case_builder/standing.h"

namespace insula::case_builder {
namespace {

// A released clip that leaves much of the sac open after this time does not improve any more, s.
constexpr double hopeless_after_s = 1.5;

const ShellBody& vessel_of(const Simulation& simulation) {
  for (const Body* b : simulation.bodies())
    if (const auto* shell = dynamic_cast<const ShellBody*>(b); shell && !shell->model().centrelines.empty())
      return *shell;
  throw InputError("exercise 3 has no vessel");
}

/// The exercise, played again and again from its start.
class ClippingTrial {
 public:
  explicit ClippingTrial(const fs::path& scene) : scene_(scene, "exercise 3") {}

  /// The neck under pressure, between the lobes.
  artery::Neck neck(const artery::Vessel& at_rest) const {
    return deformed_neck(at_rest, nodes_mm(vessel_of(scene_.simulation())));
  }

  ClippingOutcome play(const ClipPlan& plan) {
    Simulation& s = scene_.simulation();
    s.reset();
    const Motion motion = parse_motion(clipping_motion(plan), "rehearsal");
    HeadlessRun run(s, motion);
    double released = -1;
    while (s.time() < motion.duration() && s.exercise()->log().state() == ExerciseState::running) {
      run.step();
      if (!s.report().finite) break;
      for (const Event& e : s.events())
        if (e.kind == "clip_released") released = s.time();
      if (released >= 0 && s.time() > released + hopeless_after_s && hopeless(now())) break;
    }
    return now();
  }

 private:
  static bool hopeless(const ClippingOutcome& o) {
    return o.grade > 2 || o.faults > 2 || o.least_flow() < 0.5 || o.ruptured;
  }

  ClippingOutcome now() const {
    ClippingOutcome out;
    const Simulation& s = scene_.simulation();
    const ExerciseLog& log = s.exercise()->log();
    out.goal = log.state() == ExerciseState::done && s.report().finite;
    for (const MeasureState& m : log.measures()) {
      if (!m.known) continue;
      const std::string_view id = m.id;
      if (id == "grade") out.grade = int(std::lround(m.value));
      else if (id == "remnant_pct") out.remnant = 0.01 * m.value;
      else if (id == "tip_past_neck") out.tip_past_neck = m.value;
      else if (id == "slit") out.slit = m.value;
      else if (id.ends_with(".flow_pct"))
        out.flows.emplace_back(id.substr(0, id.size() - std::string_view(".flow_pct").size()), 0.01 * m.value);
      else if (id.ends_with(".stenosis_pct")) out.stenosis = std::max(out.stenosis, 0.01 * m.value);
      if (m.good < 0) tell(out.told, in_words(m));
    }
    for (const FaultState& f : log.faults()) {
      if (f.count == 0) continue;
      out.faults += f.count;
      out.ruptured = out.ruptured || f.id == "rupture";
      tell(out.told, in_words(f));
    }
    return out;
  }

  LoadedScene scene_;
};

/// So that there and back is the same.
double rounded_sum(double a, double b) { return 1e-3 * std::round(1e3 * (a + b)); }

/// What a surgeon would try next, the most promising first.
std::vector<BladePlacement> corrections(const BladePlacement& at, const ClippingOutcome& seen, double fineness) {
  const double step = fineness * (seen.shut() ? 1 : 2);
  const auto moved = [&](double lift, double slide, double turn) {
    BladePlacement p = at;
    p.lift = rounded_sum(p.lift, step * lift), p.slide = rounded_sum(p.slide, step * slide);
    p.turn = rounded_sum(p.turn, fineness * turn);
    return p;
  };
  const BladePlacement deeper = moved(0, 1.2, 0), back = moved(0, -1.2, 0), higher = moved(0.6, 0, 0),
                       lower = moved(-0.6, 0, 0), left = moved(0, 0, 15), right = moved(0, 0, -15);
  // Blades that narrow a branch, and leave the neck open, lie below it.
  if (seen.least_flow() < 0.9 || (!seen.shut() && seen.stenosis > 0.3))
    return {higher, left, right, back, deeper, lower};
  if (seen.tip_past_neck < 0.3) return {deeper, lower, left, right, higher, back};
  return {lower, deeper, higher, left, right, back};
}

/// The best of the placements that have been played. Two are played at a time.
class ClipSearch {
 public:
  ClipSearch(const fs::path& scene, const artery::Vessel& at_rest, int most_plays, Progress& progress)
      : trials_{ClippingTrial(scene), ClippingTrial(scene)},
        neck_(trials_[0].neck(at_rest)),
        most_plays_(most_plays),
        progress_(progress) {}

  /// Plays the plans that have not been played, two by two. Ends with the first pair that has a sound one, or if
  /// `all` is false a better one than the best. Returns whether there was a better one.
  bool play(std::vector<ClipPlan> plans, bool all) {
    for (ClipPlan& plan : plans) plan.lay(neck_, plan.at);
    std::erase_if(plans, [&](const ClipPlan& p) {
      return std::any_of(known_.begin(), known_.end(),
                         [&](const ClipPlan& k) { return k.clip.name == p.clip.name && k.at == p.at; });
    });
    bool better = false;
    for (std::size_t k = 0; k < plans.size() && best_.plays < most_plays_; k += trials_.size()) {
      std::vector<std::future<ClippingOutcome>> outcomes;
      for (std::size_t i = 0; i < trials_.size() && k + i < plans.size(); ++i)
        outcomes.push_back(
            std::async(std::launch::async, [this, i, &plan = plans[k + i]] { return trials_[i].play(plan); }));
      for (std::size_t i = 0; i < outcomes.size(); ++i) better = take(plans[k + i], outcomes[i].get()) || better;
      if (best_.outcome.sound() || (better && !all)) break;
    }
    return better;
  }
  /// Tries placements near the best one.
  void correct() {
    std::vector<ClipPlan> near;
    for (const BladePlacement& at : corrections(best_.plan.at, best_.outcome, fineness_)) {
      near.push_back(best_.plan);
      near.back().at = at;
    }
    if (!play(std::move(near), false)) fineness_ *= 0.5;
  }
  bool goes_on() const { return !best_.outcome.sound() && best_.plays < most_plays_ && fineness_ > finest; }
  const RehearsedClip& best() const { return best_; }

 private:
  static constexpr double finest = 0.3;

  bool take(const ClipPlan& plan, const ClippingOutcome& outcome) {
    known_.push_back(plan);
    const bool better = best_.plays++ == 0 || outcome.cost() < best_.outcome.cost();
    if (better) best_.plan = plan, best_.outcome = outcome;
    progress_.share(double(best_.plays) / most_plays_);
    return better;
  }

  std::array<ClippingTrial, 2> trials_;
  artery::Neck neck_;
  int most_plays_;
  Progress& progress_;
  std::vector<ClipPlan> known_;  ///< have been played
  double fineness_ = 1;
  RehearsedClip best_;
};

}  // namespace

double ClippingOutcome::least_flow() const {
  double least = 1;
  for (const auto& [name, flow] : flows) least = std::min(least, flow);
  return least;
}

// A branch that is shut is worse than a neck that is left open.
double ClippingOutcome::cost() const {
  return (goal ? 0 : 3) + grade + 5 * remnant + 14 * std::max(0.0, 0.9 - least_flow()) +
         2 * std::max(0.0, stenosis - 0.3) + std::min(faults, 6) + (ruptured ? 10 : 0) +
         0.4 * std::max(0.0, -tip_past_neck) + 0.5 * slit;
}

std::string clipping_motion(const ClipPlan& plan) {
  MotionScript m;
  m.command(0.1, "applier load " + plan.clip.name);
  m.place_clip(plan.pose, out_of_field, 2.5);
  m.key(true, 8, drawn_back(plan.pose, out_of_field));
  return m.csv();
}

namespace {

/// Whether two plans do nearly the same: blades of like length from like directions.
bool alike(const ClipPlan& a, const ClipPlan& b) {
  const bool turned_apart = std::abs(a.at.turn - b.at.turn) > 29;
  const bool other_shape = std::abs(a.clip.inward.y() - b.clip.inward.y()) > 0.2 || a.clip.kind != b.clip.kind;
  const bool bent = std::abs(a.clip.inward.y()) > 0.1;  // the others are the same when they are mirrored
  return !turned_apart && !other_shape && !(bent && a.at.mirrored != b.at.mirrored) &&
         std::abs(a.clip.blade - b.clip.blade) < 2.5;
}

}  // namespace

std::vector<ClipPlan> distinct_plans(const std::vector<ClipPlan>& ranked, std::size_t most) {
  std::vector<ClipPlan> out;
  const auto add = [&](std::size_t until, bool whole_neck_alone) {
    for (const ClipPlan& p : ranked) {
      if (out.size() >= until) break;
      if (whole_neck_alone && p.leaves_remnant()) continue;
      if (std::none_of(out.begin(), out.end(), [&](const ClipPlan& o) { return alike(o, p); })) out.push_back(p);
    }
  };
  // Half of them are long enough for the whole neck, however far their applier is off the line of sight.
  add(most - most / 2, false);
  add(most, true);
  add(most, false);
  return out;
}

namespace {

/// Each plan at its own height and farther up: how far a neck is drawn down when it is closed shows only in the play.
std::vector<ClipPlan> at_two_heights(const std::vector<ClipPlan>& plans) {
  constexpr double up = 1.2;  // mm
  std::vector<ClipPlan> out;
  for (const ClipPlan& p : plans) {
    out.push_back(p);
    out.back().at.lift = rounded_sum(p.at.lift, 0);
    out.push_back(p);
    out.back().at.lift = rounded_sum(p.at.lift, up);
  }
  return out;
}

}  // namespace

RehearsedClip rehearse_clipping(const fs::path& scene, const fs::path& motion, const artery::Vessel& at_rest,
                                const std::vector<ClipPlan>& tried, bool correct, int most_plays, Progress& progress) {
  write_text(motion, clipping_motion(tried.front()));  // the scene names it
  ClipSearch search(scene, at_rest, most_plays, progress);
  search.play(correct ? at_two_heights(tried) : tried, true);
  while (correct && search.goes_on()) search.correct();
  return search.best();
}

std::vector<Note> notes_of(const RehearsedClip& clipped) {
  std::vector<Note> out;
  const ClippingOutcome& o = clipped.outcome;
  if (o.sound())
    out.push_back({Note::Kind::fact,
                   fmt::format("The scripted hands close the neck: grade {}, {:.0f} % of it left open, least flow of a "
                               "branch {:.0f} %. {} placements were played.",
                               o.grade, 100 * o.remnant, 100 * o.least_flow(), clipped.plays),
                   ""});
  else
    out.push_back(
        problem("clipping_unsolved",
                fmt::format("The best of {} played placements of the clip leaves something to be desired: {}.",
                            clipped.plays, o.told.empty() ? "the goal is not reached" : o.told),
                "Expect a remnant, or a second clip. Try another clip (--clip), or turn the vessel (--spin)."));
  for (const Note& n : notes_of(clipped.plan)) out.push_back(o.sound() ? Note{Note::Kind::fact, n.text, ""} : n);
  return out;
}

Json to_json(const ClippingOutcome& o) {
  Json flows = Json::object();
  for (const auto& [name, flow] : o.flows) flows[name] = rounded(100 * flow);
  return {{"goal", o.goal},
          {"grade", o.grade},
          {"remnant_pct", rounded(100 * o.remnant)},
          {"flows_pct", flows},
          {"faults", o.faults}};
}

}  // namespace insula::case_builder
