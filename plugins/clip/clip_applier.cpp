// SPDX-License-Identifier: GPL-3.0-or-later
/*
# clip_applier

A clip applier on the virtual coupling. It holds at most one `<clip>` by six rows: three at the grip, and three of
rotation with a lever of 5 mm,

    delta_k = a_k . (clip's grip - applier's),    delta_k+3 = 5 mm * a_k . (rotation vector from applier to clip)

where a_k are the applier's axes. The hand thus feels all that the clip touches.

- First button, held: the jaws are squeezed open to their limit within `open_time`.
- First button, let go: the applier opens its grip in the same time, and the spring closes the jaws. The applier holds
  the jaws open and never presses them shut.
- Second button: the clip is released where it is, unless the applier holds it open.
- Second button with the grip of a clip in the field within `reach` and `alignment`: that clip is taken back. It is
  first held as it lies, then brought into the applier's jaws within `settle_time`, without a jump.

A clip may be held by either side (half a turn about its shaft).

Commands: `load <clip>` (from the tray; the clip in the applier goes back there), `release`, `take`.
Events: clip_loaded, clip_shut (the jaws no longer hold it open), clip_released, clip_taken, with the clip's id.
*/
#include "plugins/clip/clip_applier.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/text.h"
#include "plugins/clip/touch.h"

namespace insula {
namespace {

constexpr double lever = 5e-3;  // m

Pose compose(const Pose& a, const Pose& b) { return {a.apply(b.p), (a.q * b.q).normalized()}; }
Pose inverse(const Pose& a) { return {-(a.q.conjugate() * a.p), a.q.conjugate()}; }

/// A clip's pose in the frame of an applier that holds it properly. `turned`: it is held by its other side.
Pose held_properly(const Clip& clip, bool turned) {
  const Pose half{Vec3::Zero(), turned ? Quat(0, 0, 0, 1) : Quat::Identity()};
  return compose(half, inverse(clip.data().grip));
}

}  // namespace

void ClipApplier::join(PrepareContext& context, Simulation&) {
  if (clips().empty()) return error(context, clips, "an applier needs a clip");
  if (first) {
    if (std::find(clips().begin(), clips().end(), first.get()) == clips().end())
      return error(context, first, in_quotes(first->id) + " is none of its clips");
    if (first->holder())
      return error(context, first,
                   in_quotes(first->id) + " is in the applier " + in_quotes(first->holder()->id) + " already");
    if (first->start.is("field")) return error(context, first, in_quotes(first->id) + " starts in the field");
    start_clip_ = first.get();
    start_clip_->start_in(this);
  }
  reset();
}

Pose ClipApplier::clip_home(const Clip& clip) const {
  return compose(hand_index() < 0 ? arm_pose(-infinite) : home_pose(), held_properly(clip, false));
}

void ClipApplier::grasp(Clip* clip, const Pose& relative, const Pose& nominal) {
  clip_ = clip;
  taken_ = target_ = relative;
  nominal_ = nominal;
  held_for_ = 0;
  held_opening_ = 0;
}

void ClipApplier::empty() { grasp(nullptr, {}, {}); }

void ClipApplier::reset() {
  Instrument::reset();
  if (start_clip_) grasp(start_clip_, held_properly(*start_clip_, false), held_properly(*start_clip_, false));
  else empty();
  button2_ = touched_ = false;
  said_.clear();
}

void ClipApplier::take_up(const Pose& device) {
  Clip* const kept = clip_;
  Instrument::take_up(device);
  empty();
  if (!kept) return;
  const Pose in = held_properly(*kept, false);
  grasp(kept, in, in);
  kept->load(*this, compose(device, in));
}

void ClipApplier::lay_down() {
  if (clip_) clip_->to_tray();
  Instrument::lay_down();
  empty();
}

std::string ClipApplier::why_kept() const {
  return clip_ && clip_->touched() ? "let the clip go, or draw it out of the field, before you lay down the applier"
                                   : "";
}

std::vector<BodyProperty> ClipApplier::properties() const {
  const double degrees = alignment() * 180 / std::numbers::pi;
  return {{"reach", reach(), "m", fmt::format("{:.3g} mm", 1000 * reach())},
          {"alignment", alignment(), "rad", fmt::format("{:.3g} deg", degrees)}};
}

double ClipApplier::activity() const {
  return clip_ ? std::clamp(held_opening_ / clip_->tool().opening_max, 0.0, 1.0) : state().button1 ? 1 : 0;
}

void ClipApplier::free_motion(const StepContext& context) {
  Instrument::free_motion(context);
  if (!clip_) return;
  const double widest = clip_->tool().opening_max, change = widest / open_time() * context.h;
  if (state().button1) held_opening_ = std::min(widest, std::max(held_opening_, clip_->opening()) + change);
  else {
    if (held_opening_ > 0 && held_opening_ <= change) say(shut, clip_->id, "");
    held_opening_ = std::max(0.0, held_opening_ - change);
  }
  const double s = std::min(1.0, (held_for_ + context.h) / settle_time());
  target_ = displaced(taken_, s * s * (3 - 2 * s) * displacement(taken_, nominal_));
}

void ClipApplier::join_rows(ConstraintBuilder& builder) const {
  const Mat3 axes = pose().q.toRotationMatrix();
  // Both ends act at the clip's grip. So there is no net moment, and the derivative is exact while the axes rotate with
  // the applier.
  const Pose& in_clip = clip_->data().grip;
  const Vec3 at = clip_->grip().p;
  const Pose wanted = compose(target_, in_clip);  // of the grip, in the applier's frame
  const auto both = [&](int row, const Vec3& where, const Vec3& d) {
    builder.point(row, clip_->link_point(0, clip_->pose().q.conjugate() * (where - clip_->pose().p)), d);
    builder.point(row, point(where), -d);
  };
  const auto add = [&](int key) {
    Block block;
    block.id = row_id(*this, std::uint64_t(key));
    block.role = BlockRole::weld;
    return builder.add(block);
  };
  for (int k = 0; k < 3; ++k) {
    const int row = add(k);
    builder.violation(row, axes.col(k).dot(at - pose().p) - wanted.p[k]);
    both(row, at, axes.col(k));
  }
  const Vec3 turn = rotation_vector(clip_->pose().q * (pose().q * target_.q).conjugate());
  for (int k = 0; k < 3; ++k) {
    // A moment about axis k is a pair of forces along another axis.
    const Vec3 arm = 0.5 * lever * axes.col((k + 1) % 3), d = axes.col((k + 2) % 3);
    const int row = add(3 + k);
    builder.violation(row, lever * axes.col(k).dot(turn));
    both(row, at + arm, d);
    both(row, at - arm, -d);
  }
}

void ClipApplier::build(const StepContext&, ConstraintBuilder& builder) {
  if (clip_) join_rows(builder);
}

void ClipApplier::finish(const StepContext& context, const ConstraintSolution& solution) {
  touched_ = touched_by_others(*this, solution, order, order);
  held_for_ += context.h;
  // The button acts from the next step on, since bodies move in parallel, and the holder must not change meanwhile.
  if (state().button2 && !button2_) {
    const std::string why = clip_ ? release() : take();
    if (!why.empty()) say(warning, id, why);
  }
  button2_ = state().button2;
  for (Event& e : said_) {
    e.time = context.time + context.h;
    context.events->emit(std::move(e));
  }
  said_.clear();
}

void ClipApplier::say(const EventKind& event, const std::string& what, std::string text) {
  said_.push_back({event.name(), what, std::move(text), 0, 0, hand_index()});
}

std::string ClipApplier::release() {
  if (!clip_) return "there is no clip in the applier";
  if (held_opening_ > 0 && clip_->stop_force() > 0) return "close the jaws before you let the clip go";
  clip_->let_go();
  say(released, clip_->id, fmt::format("Clip {} let go", clip_->id));
  empty();
  return {};
}

std::string ClipApplier::take() {
  if (clip_) return "there is a clip in the applier already";
  Clip* best = nullptr;
  double nearest = reach();
  Pose best_nominal;
  bool askew = false;
  for (Clip* c : clips()) {
    const double distance = (c->grip().p - pose().p).norm();
    if (!c->in_field() || !(distance <= nearest)) continue;
    const Pose now = compose(inverse(pose()), c->pose());
    double least = infinite;
    Pose nominal;
    for (const bool turned : {false, true}) {
      const Pose candidate = held_properly(*c, turned);
      const double angle = rotation_vector(now.q * candidate.q.conjugate()).norm();
      if (angle < least) {
        least = angle;
        nominal = candidate;
      }
    }
    if (least > alignment()) {
      askew = true;
      continue;
    }
    nearest = distance;
    best = c;
    best_nominal = nominal;
  }
  if (!best) return askew ? "the applier is not in line with the clip" : "no clip is within reach";
  grasp(best, compose(inverse(pose()), best->pose()), best_nominal);
  best->take(*this);
  say(taken, best->id, fmt::format("Clip {} taken", best->id));
  return {};
}

std::string ClipApplier::load(std::string_view wanted) {
  const auto found = std::find_if(clips().begin(), clips().end(), [&](const Clip* c) { return c->id == wanted; });
  if (found == clips().end()) {
    std::vector<std::string> ids;
    for (const Clip* c : clips()) ids.push_back(c->id);
    const std::string near = nearest_name(std::string(wanted), ids);
    return "no clip " + in_quotes(wanted) + " for this applier" + did_you_mean(near);
  }
  Clip* const c = *found;
  if (c == clip_) return {};
  if (!active()) return "the applier lies on the tray; take it up first";
  if (c->holder()) return "clip " + in_quotes(wanted) + " is in the applier " + in_quotes(c->holder()->id);
  if (c->in_field()) return "clip " + in_quotes(wanted) + " is in the field; take it with the applier";
  if (touched_ || (clip_ && clip_->touched())) return "draw the applier out of the field before you load it";
  if (clip_) clip_->to_tray();
  const Pose in = held_properly(*c, false);
  grasp(c, in, in);
  c->load(*this, compose(pose(), in));
  say(loaded, c->id, fmt::format("Clip {} loaded", c->id));
  return {};
}

std::vector<CommandInfo> ClipApplier::commands() const {
  return {{"load", "puts a clip from the tray into the applier", "clip id"},
          {"release", "lets its clip go where it is", ""},
          {"take", "takes the clip in the field that is within reach", ""}};
}

std::string ClipApplier::run_command(std::string_view name, std::string_view argument) {
  if (name == "load") return load(argument);
  if (!argument.empty()) return std::string(name) + " takes no argument";
  if (!active()) return "the applier lies on the tray";
  if (name == "release") return release();
  return name == "take" ? take() : "unknown command";
}

void ClipApplier::append_state(std::vector<double>& out) const {
  Instrument::append_state(out);
  out.insert(out.end(),
             {clip_ ? double(clip_->index) : -1.0, held_for_, held_opening_, double(button2_), double(touched_)});
  out.insert(out.end(),
             {taken_.p.x(), taken_.p.y(), taken_.p.z(), taken_.q.w(), taken_.q.x(), taken_.q.y(), taken_.q.z()});
}

}  // namespace insula
