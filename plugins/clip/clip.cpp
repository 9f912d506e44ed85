// SPDX-License-Identifier: GPL-3.0-or-later
/*
# clip

An aneurysm clip: two jaws on one hinge and a spring that closes them.

    <clip id="straight" model="../../meshes/clips/straight/straight.urdf"/>
    <clip_applier id="applier" clips="straight" load="straight" .../>
    <contact between="straight artery" friction="0.35"/>

The clip lies on the tray, is held by a `<clip_applier>`, or is free in the field. In the field it stays simulated. It
holds by its spring and by friction, and it slips when it is pulled harder than friction allows. It has seven
unknowns: three of translation, three of rotation, and the angle `o` by which each jaw is turned from the closed
position.

The spring turns each jaw with the moment (F0 closing force, s its slope, r the distance from the hinge to the middle
of the blade)

    T(o) = strength * r * (F0 + s * 2 r sin(o)),      so a blade presses with T / x at the distance x from the hinge.

The moment is integrated implicitly: A of the opening is I/h^2 + (1 + hinge_time/h) 2 dT/do. Closed jaws rest on one
another by a unilateral row. Its gap at the middle of the blades is 2 r (o - least) >= 0. An applier that holds the
jaws open moves `least`.

`closing_time` moves it too. It is the shortest time in which the jaws go from fully open to shut. Contact normals and
levers are those of the start of a step. Jaws that shut on a vessel within one step would therefore grip nothing.

A spring that is held open weakens slowly (Papadopoulos et al. 2004: by 19 to 26 % of the force in ten minutes fully
open):

    d strength / dt = ln(1 - weakening) / 600 s * (o / widest) * strength    while an applier holds it open.

A real clip weighs 0.1 g. At a step of 1/60 s this inertia is a hundred times more compliant than a vessel's wall, and
the solver would converge very slowly. `added_mass` therefore replaces the mass in the inertial terms, and `gyration`
adds moments of inertia. Contact normals and levers are constant over a step. A clip that turns more easily than J/h^2
= closing force times its length would be thrown off by its own grip. The inertial force must only stay small beside
the closing force. The weight is the true one. Linear and angular momentum about the centre of mass are conserved
exactly.
*/
#include "plugins/clip/clip.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/input_error.h"
#include "core/mechanics/force_model.h"
#include "core/registry/registry.h"
#include "plugins/clip/clip_applier.h"
#include "plugins/clip/slices.h"
#include "plugins/clip/touch.h"

namespace insula {

void Clip::prepare(PrepareContext& context) {
  for (const ForceModel* f : children_of<ForceModel>()) f->error(context, "has no effect on a clip, which is rigid");
  for (const Support* f : children_of<Support>()) f->error(context, "has no effect on a clip, which is rigid");
  try {
    tool_ = read_tool(model());
    const auto data = read_clip_data(tool_);
    if (!data) return error(context, model, "this tool is no clip: its tool.json has no \"clip\"");
    data_ = *data;
  } catch (const InputError& e) {
    return error(context, model, e.what());
  }
  if (shaft().norm() < 1e-9) return error(context, shaft, "a direction must not be zero");
  if (shaft().cross(flat()).norm() < 1e-6 * shaft().norm())
    return error(context, flat, "must not be parallel to the shaft");
  if (start_opening() > tool_.opening_max)
    return error(
        context, start_opening,
        "the jaws open by no more than " + std::to_string(int(tool_.opening_max * 180 / std::numbers::pi)) + " deg");
  pieces_.assign(3, {});
  for (const ConvexPiece& p : tool_.pieces) add_slices(p, pieces_[std::size_t(p.link)]);
  turned_.resize(3);
  reset();
}

double Clip::torque(double opening) const {
  const double r = data_.reference;
  return strength_ * r * (closing() + slope() * 2 * r * std::sin(opening));
}

Pose Clip::start_pose() const {
  const Vec3 z = shaft().normalized();
  const Vec3 x = (flat() - flat().dot(z) * z).normalized();
  Mat3 r;
  r << x, z.cross(x), z;
  return {home(), Quat(r).normalized()};
}

void Clip::settle(const Pose& pose, double opening) {
  place(pose, opening);
  free_pose_ = pose;
  velocity_.setZero();
  spin_.setZero();
  turn_rate_ = last_change_ = free_opening_ = soonest_ = 0;
  free_shift_.setZero();
  free_turn_.setZero();
  force_ = stop_force_ = pushed_ = 0;
  touched_ = held_open_ = false;
}

void Clip::place(const Pose& pose, double opening) {
  pose_ = pose;
  opening_ = opening;
  for (int k = 0; k < 3; ++k) turned_[std::size_t(k)] = tool_.link_pose(k, opening_);
}

void Clip::reset() {
  holder_ = start_holder_;
  in_field_ = !holder_ && start.is("field");
  strength_ = 1;
  applications_ = 0;
  external.setZero();
  settle(holder_ ? holder_->clip_home(*this) : start_pose(), in_field_ ? start_opening() : 0);
}

void Clip::start_in(ClipApplier* applier) {
  start_holder_ = applier;
  reset();
}

void Clip::load(ClipApplier& applier, const Pose& pose) {
  holder_ = &applier;
  in_field_ = false;
  settle(pose, 0);
}

void Clip::let_go() {
  holder_ = nullptr;
  in_field_ = true;
  held_open_ = false;
  ++applications_;
}

void Clip::to_tray() {
  holder_ = nullptr;
  in_field_ = false;
  settle(start_pose(), 0);
}

bool Clip::active() const { return holder_ ? holder_->active() : in_field_; }

double Clip::held_opening() const { return holder_ ? std::max(0.0, holder_->held_opening()) : 0.0; }

void Clip::build(const StepContext&, ConstraintBuilder& builder) {
  const auto stop = [&](std::uint64_t key, double sign, double at) {
    Block block;
    block.id = row_id(*this, key);
    block.role = BlockRole::stop;
    block.lower = 0;
    const int row = builder.add(block);
    rows.open(row);
    rows.add(2, Vec3(sign * lever(), 0, 0));
    builder.violation(row, sign * lever() * (opening_ - at));
    return row;
  };
  held_open_ = held_opening() > 0;
  stop_row_ = stop(0, 1, min_opening());
  // Only a force that opens the jaws can bring them here.
  limit_row_ = opening_ + std::max(0.0, free_opening_) > 0.8 * tool_.opening_max ? stop(1, -1, tool_.opening_max) : -1;
}

void Clip::finish(const StepContext& context, const ConstraintSolution& solution) {
  stop_force_ = solution.lambda[stop_row_];
  const double limit = limit_row_ >= 0 ? solution.lambda[limit_row_] : 0;
  force_ = std::max(0.0, pushed_ / lever() - stop_force_ + limit);
  touched_ = touched_by_others(*this, solution, order, holder_ ? holder_->order : order);
  held_open_ = held_open_ && stop_force_ > 0;
  if (held_open_) strength_ *= std::exp(std::log1p(-weakening()) / 600 * context.h * opening_ / tool_.opening_max);
}

ClipState Clip::clip_state() const {
  ClipState s;
  s.clip = this;
  s.holder = holder_;
  s.on_tray = !active();
  s.temporary = data_.temporary();
  s.opening = opening_;
  s.force = force_;
  s.gap = data_.gap(opening_);
  s.blade_root = pose_.apply(data_.blade_line.front());
  s.blade_tip = pose_.apply(data_.blade_line.back());
  s.pose = pose_;
  s.blade_line = data_.blade_line;
  s.blade_width = data_.blade_width;
  s.applications = applications_;
  return s;
}

void Clip::publish() {
  pressing.set(force_);
  opening_now.set(opening_);
  applied.set(applications_);
  place_now.set(!active() ? 0 : holder_ ? 1 : 2);
}

const RigidBody* Clip::held_by() const { return holder_; }

std::vector<std::string> Clip::tags() const { return {data_.temporary() ? "temporary" : "permanent", data_.shape}; }

std::vector<BodyProperty> Clip::properties() const {
  return {
      {"blade_length", data_.blade_length, "m", std::to_string(int(std::lround(1000 * data_.blade_length))) + " mm"},
      {"closing_force", data_.closing_force, "N", fmt::format("{:.2g} N", data_.closing_force)},
      {"opening_max", tool_.opening_max, "rad",
       std::to_string(int(std::lround(tool_.opening_max * 180 / std::numbers::pi))) + " deg"}};
}

double Clip::energy() const {
  if (!active()) return 0;
  const double r = data_.reference;
  const double spring = strength_ * 2 * r * (closing() * opening_ + slope() * 2 * r * (1 - std::cos(opening_)));
  const double turn = added_mass() * r * r / 3 * turn_rate_ * turn_rate_;
  const double rotation = moments_.isZero(0) ? 0 : spin_.dot(moments_.ldlt().solve(spin_));
  return spring + 0.5 * (added_mass() * velocity_.squaredNorm() + rotation + turn);
}

void Clip::append_state(std::vector<double>& out) const {
  for (const Vec3& x : {pose_.p, velocity_, spin_}) out.insert(out.end(), {x.x(), x.y(), x.z()});
  out.insert(out.end(), {pose_.q.w(), pose_.q.x(), pose_.q.y(), pose_.q.z(), opening_, turn_rate_, strength_});
  out.insert(out.end(), {holder_ ? double(holder_->index) : -1.0, double(in_field_), double(applications_),
                         double(touched_), force_});
}

}  // namespace insula

INSULA_PLUGIN(clip) {
  registry.add<insula::Clip>("clip", insula::Kind::body, "aneurysm clip: two jaws that a spring closes");
  registry.add<insula::ClipApplier>("clip_applier", insula::Kind::instrument,
                                    "holds a clip, opens it, lets it go and takes it back");
}
