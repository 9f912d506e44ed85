// SPDX-License-Identifier: GPL-3.0-or-later
/*
# bleeding

A weak region of a vessel's wall (the bleb) tears in one of these cases:

- it is pressed or pulled harder than `force`, or than `sharp_force` by instruments with a cutting edge;
- the pressure inside reaches `burst`;
- the command `rupture` is sent.

Heat closes the tear (<bipolar_forceps>) once little enough blood leaves it, since the jet carries the heat away.

The force is summed over all rows of the step's problem except those of the pressure. Each row contributes the
magnitude of the force that it puts on the region:

    F = sum over blocks | sum over nodes in the region of H^T lambda |

The tear is an opening of `tear_area` in the network of <blood_flow>. Its rate therefore follows the pressure, and a
clip on the parent or across the neck stops it. If the wall draws inward, fluid over the tear flows back. This fluid
is blood of the pool, if there is any. Otherwise it is cerebrospinal fluid or air, which leaves first again. Blood
rises as a level surface in a paraboloid and hides the field. With V the volume in the field and `tear` negative while
blood flows back,

    dV/dt = tear - suction - drain,   height = depth sqrt(V / V_full),   V_full = pi radius^2 depth / 2

Blood above the rim runs off. If its tip is below the surface, a suction tube takes `suction_rate` while its button is
held. Otherwise it takes `idle_suction` of that rate. Cotton patties and irrigation take `drain` all the time.

The flow of the middle cerebral artery is 120-170 mL/min, and a microsurgical field holds 5-15 mL. Without suction,
the default tear hides the field in about ten seconds.
*/
#include "plugins/bleeding/bleeding.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/text.h"
#include "core/registry/registry.h"
#include "core/sim/events.h"
#include "core/sim/simulation.h"

namespace insula {
namespace {

constexpr double stopped_below = 0.05;  // rate, over that of the rupture, below which bleeding counts as stopped
constexpr double stopped_after_s = 2;   // time that it must stay below

}  // namespace

void Bleeding::prepare(PrepareContext& context) {
  if (up().norm() < 1e-9) return error(context, up, "must be a direction");
  bowl_ = {radius(), depth(), origin(), up().normalized()};
  if (sharp_force() > force())
    error(context, sharp_force, "is above force; a sharp instrument tears more easily than a blunt one");
}

void Bleeding::connect(PrepareContext& context, Simulation& simulation) {
  const BloodPressure& pressure = *flow->blood_pressure;
  if (pressure.on.get() != on.get())
    return error(
        context, flow,
        in_quotes(flow->id) + " is the blood of " + in_quotes(pressure.on->id) + ", not of " + in_quotes(on->id));
  if (!flow->blood_pressure->ready(context)) return;
  const int r = on->region(region());
  if (r < 0) {
    const std::string near = nearest_name(region(), on->model().regions);
    return error(context, region, in_quotes(on->id) + " has no region " + in_quotes(region()) + did_you_mean(near));
  }
  zone_.assign(std::size_t(on->nodes()), 0);
  zone_nodes_.clear();
  for (std::size_t v = 0; v < zone_.size(); ++v) {
    if (on->model().vertex_region[v] != r) continue;
    zone_[v] = true;
    zone_nodes_.push_back(int(v));
  }
  if (zone_nodes_.empty()) return error(context, region, "region " + in_quotes(region()) + " has no vertices");
  for (const auto& t : on->wall_triangles())
    if (zone_[std::size_t(t[0])] && zone_[std::size_t(t[1])] && zone_[std::size_t(t[2])]) zone_triangles_.push_back(t);
  jet.resize(1);
  chamber_ = pressure.chambers().of_region(r);
  instruments_ = simulation.instruments();
  suctions_ = suction_tubes(instruments_);
}

void Bleeding::measure_forces(const ConstraintSolution& solution) {
  force_ = sharp_ = 0;
  const BodyRows& rows = on->rows;
  const int own = flow->blood_pressure->order;
  row_force_.assign(3 * std::size_t(solution.problem.rows), 0.0);
  for (int i = 0; i < rows.count(); ++i) {
    Vec3 f = Vec3::Zero();
    for (int e = rows.start[std::size_t(i)]; e < rows.start[std::size_t(i) + 1]; ++e)
      if (zone_[std::size_t(rows.block[std::size_t(e)])]) f += rows.coeff[std::size_t(e)];
    const int row = rows.row[std::size_t(i)];
    Eigen::Map<Vec3>(row_force_.data() + 3 * row) = solution.lambda[row] * f;
  }
  for (const Block& b : solution.problem.blocks) {
    if (b.owner == own) continue;
    Vec3 f = Vec3::Zero();
    for (int k = 0; k < b.rows(); ++k) f += Eigen::Map<const Vec3>(row_force_.data() + 3 * (b.row + k));
    const double size = f.norm();
    if (size == 0) continue;
    force_ += size;
    for (const Instrument* i : instruments_) {
      const auto& r = i->rows.row;
      if (i->active() && i->cutting() && std::binary_search(r.begin(), r.end(), b.row)) {
        sharp_ += size;
        break;
      }
    }
  }
}

void Bleeding::emit(const StepContext& context, const EventKind& what, const char* text, double value) const {
  if (context.events) context.events->emit({what.name(), id, text, value, context.time + context.h});
}

void Bleeding::tear(const StepContext& context, const char* why, double value) {
  asked_ = false;
  open_ = true;
  stopped_ = false;
  low_for_ = first_rate_ = lost_ = dose_ = 0;
  since_ = context.time + context.h;
  flow->set_tear(chamber_, tear_area());
  emit(context, ruptured, why, value);
}

void Bleeding::finish(const StepContext& context, const ConstraintSolution& solution) {
  now_ = context.time + context.h;
  measure_forces(solution);
  const double out = open_ ? flow->tear_flow(chamber_) : 0;
  if (!open_) {
    const double inside = flow->blood_pressure->pressure(chamber_);
    if (asked_) tear(context, "asked for", 0);
    else if (sharp_ > sharp_force()) tear(context, "cut by an instrument", sharp_);
    else if (force_ > force()) tear(context, "pressed or pulled too hard", force_);
    else if (inside > burst()) tear(context, "burst", inside);
  }
  fill(context.h, blood_of(context.h, out));
  if (open_) tell(context);
}

double Bleeding::blood_of(double h, double out) {
  if (out > 0) {
    const double first = std::min(other_, h * out);
    other_ -= first;
    return out - first / h;
  }
  const double taken = bowl_.height_of(tear_centre()) < height() ? std::min(volume_, -h * out) : 0;
  other_ += -h * out - taken;
  return -taken / h;
}

Vec3 Bleeding::tear_centre() const {
  Vec3 sum = Vec3::Zero();
  for (const int v : zone_nodes_) sum += Eigen::Map<const Vec3>(on->q().data() + 3 * v);
  return sum / double(zone_nodes_.size());
}

std::optional<CoagulationSite> Bleeding::site(int) const {
  if (!open_) return std::nullopt;
  return CoagulationSite{tear_centre(), rate_};
}

bool Bleeding::add_dose(const StepContext& context, int, double dose) {
  dose_ += dose;
  if (!open_ || dose_ < 1) return false;
  seal();
  if (!stopped_) emit(context, stopped, "", lost_);
  return true;
}

void Bleeding::seal() {
  open_ = false;
  rate_ = other_ = 0;
  flow->set_tear(chamber_, 0);
}

void Bleeding::fill(double h, double blood) {
  rate_ = std::max(0.0, blood);
  lost_ += h * blood;
  volume_ += h * blood;
  const double taken = suction_takes(bowl_, volume_, suctions_, {suction_rate(), idle_suction()}, h);
  sucked_rate_ = std::min(std::max(0.0, volume_), taken) / h;
  const double most = taken + h * drain();
  volume_ = std::min(std::max(0.0, volume_ - most), bowl_.capacity());
}

void Bleeding::tell(const StepContext& context) {
  first_rate_ = std::max(first_rate_, rate_);
  if (rate_ < stopped_below * first_rate_) {
    low_for_ += context.h;
    if (!stopped_ && low_for_ > stopped_after_s) {
      stopped_ = true;
      emit(context, stopped, "", lost_);
    }
    return;
  }
  // Hysteresis: a small flow does not count as renewed bleeding.
  if (stopped_ && rate_ < 2 * stopped_below * first_rate_) return;
  low_for_ = 0;
  if (stopped_) emit(context, again, "", rate_);
  stopped_ = false;
}

void Bleeding::publish() {
  bleeding_rate.set(rate_);
  lost.set(lost_);
  level.set(height());
  sucked.set(sucked_rate_);
  since.set(since_ >= 0 ? now_ - since_ : std::numeric_limits<double>::quiet_NaN());
  is_open.set(open_);
  load.set(open_ ? std::numeric_limits<double>::quiet_NaN() : std::max(force_ / force(), sharp_ / sharp_force()));
  pool.set(origin() + height() * bowl_.up, bowl_.up, height() > 0 ? radius() : 0, height());  // radius 0: dry
  Vec3 outward = Vec3::Zero();
  const auto at = [&](int node) -> Vec3 { return Eigen::Map<const Vec3>(on->q().data() + 3 * node); };
  for (const auto& t : zone_triangles_) outward += (at(t[1]) - at(t[0])).cross(at(t[2]) - at(t[0]));
  const double length = outward.norm();
  const Vec3 direction = length > 0 ? Vec3(outward / length) : bowl_.up;
  const double strength = std::min(1.0, rate_ / full_jet);
  const Vec3 place = tear_centre();
  jet.set(0, 0, place, strength);
  jet.set(0, 1, place + 0.01 * direction, strength);
}

void Bleeding::reset() {
  open_ = asked_ = stopped_ = false;
  rate_ = lost_ = sucked_rate_ = volume_ = other_ = first_rate_ = low_for_ = force_ = sharp_ = dose_ = 0;
  since_ = -1;
  now_ = 0;
}

void Bleeding::append_state(std::vector<double>& out) const {
  out.insert(out.end(),
             {double(open_), double(asked_), double(stopped_), rate_, lost_, volume_, since_, first_rate_, low_for_});
  if (other_ > 0) out.push_back(other_);
  if (dose_ > 0) out.push_back(dose_);
}

std::vector<CommandInfo> Bleeding::commands() const {
  return {{"rupture", "the weak spot tears", "", 0, 0}, {"seal", "the tear closes, as after coagulation", "", 0, 0}};
}

std::string Bleeding::run_command(std::string_view name, std::string_view) {
  if (name == "rupture") {
    if (open_) return "it bleeds already";
    asked_ = true;
    return {};
  }
  if (name == "seal") {
    if (!open_) return "nothing bleeds";
    seal();
    return {};
  }
  return "unknown command " + in_quotes(name);
}

}  // namespace insula

INSULA_PLUGIN(bleeding) {
  registry.add_material({"blood", "fluid", {0.35, 0.01, 0.01, 0.95}, 0.1, 0, 0.1});
  registry.add<insula::Bleeding>("bleeding", insula::Kind::constraint,
                                 "a weak spot of a vessel's wall that tears and bleeds into the field");
}
