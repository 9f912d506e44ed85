// SPDX-License-Identifier: GPL-3.0-or-later
/*
# bridging_veins

Veins that bridge a fissure, such as the superficial Sylvian veins. They must be kept. In the mechanics a vein is a
strand of <strand_springs>: one compliant row that carries tension only, which a blade wears down and a pull beyond
`strength` tears. It is slack by `slack`, so that the lips may part, and it does not count among the strands that an
exercise asks to divide.

A parted vein bleeds from then on, half of `bleeding_rate` from either stump, until heat closes it
(<bipolar_forceps>). The blood fills a bowl, a paraboloid as in <bleeding>:

    dV/dt = open stumps * bleeding_rate / 2 - suction - drain

Heat at its middle closes a whole vein. It then does not bleed when it parts, but it is lost all the same.

Each vein is drawn along both surfaces, from `along` away up to the lip, and across the gap in an arch as long as its
own length. A parted one keeps a stump at each lip.

Forces: human bridging veins tear at 1 to 3 N (Lee and Haut 1989); the small tributaries at the Sylvian fissure bear
less. They are thin against those: a few tenths of a newton.
*/
#include "plugins/bridging_veins/bridging_veins.h"

#include <algorithm>
#include <cmath>

#include "core/registry/registry.h"
#include "core/sim/events.h"
#include "core/sim/simulation.h"
#include "plugins/strand_springs/nearest.h"

namespace insula {
namespace {

constexpr double stump = 0.0008;     // m, of a parted vein beyond the lip
constexpr double most_arch = 0.002;  // m, that a slack vein stands out of the gap

}  // namespace

void BridgingVeins::prepare(PrepareContext& context) {
  StrandSprings::prepare(context);
  if (up().norm() < 1e-9) return error(context, up, "must be a direction");
  bowl_ = {bowl_radius(), bowl_depth(), origin(), up().normalized()};
}

void BridgingVeins::connect(PrepareContext& context, Simulation& simulation) {
  if (!from || !to) return error(context, "from and to name the two surfaces that the veins join");
  StrandSprings::connect(context, simulation);
  tubes_ = suction_tubes(simulation.instruments());
}

/// The way of a vein on a surface: from the lip over its edges, out of the field and away from the gap.
BridgingVeins::Course BridgingVeins::course(const Surface& on, int lip, const Vec3& away) const {
  const TriMesh& mesh = on.rest();
  const double step = along() / (ashore - 1);
  Course out;
  out.on = &on;
  int at = lip;
  for (int k = ashore - 1; k >= 0; --k) {
    out.vertex[std::size_t(k)] = at;
    // It climbs over the lip first, then runs away from it.
    const Vec3 wanted = mesh.vertices[std::size_t(at)] + step * (away + (k > 1 ? 0.8 : 0.2) * bowl_.up).normalized();
    double least = infinite;
    for (std::size_t v = 0; v < mesh.vertices.size(); ++v) {
      const double d = (mesh.vertices[v] - wanted).squaredNorm();
      if (d >= least) continue;
      least = d;
      at = int(v);
    }
  }
  return out;
}

void BridgingVeins::spun(int from_vertex, int to_vertex) {
  const Vec3 across =
      (to->rest().vertices[std::size_t(to_vertex)] - from->rest().vertices[std::size_t(from_vertex)]).normalized();
  courses_.push_back({course(*from, from_vertex, -across), course(*to, to_vertex, across)});
  doses_.resize(places * courses_.size(), 0);
}

void BridgingVeins::part(const StepContext& context, Strand& s, const EventKind&, double value) {
  StrandSprings::part(context, s, vein_parted, value);
}

void BridgingVeins::finish(const StepContext& context, const ConstraintSolution& solution) {
  StrandSprings::finish(context, solution);
  const double out = open_stumps() * 0.5 * bleeding_rate();
  lost_ += context.h * out;
  const double taken = suction_takes(bowl_, volume_, tubes_, {suction_rate(), 0.1}, context.h) + context.h * drain();
  volume_ = std::clamp(volume_ + context.h * out - taken, 0.0, bowl_.capacity());
}

bool BridgingVeins::bleeds(std::size_t vein, Place stump) const {
  return strands()[vein].severed && dose_of(vein, middle) < 1 && dose_of(vein, stump) < 1;
}

int BridgingVeins::open_stumps() const {
  int open = 0;
  for (std::size_t i = 0; i < strands().size(); ++i) open += bleeds(i, from_stump) + bleeds(i, to_stump);
  return open;
}

std::optional<CoagulationSite> BridgingVeins::site(int i) const {
  const std::size_t vein = std::size_t(i / places);
  const Place place = Place(i % places);
  const Strand& s = strands()[vein];
  const Vec3 a = s.a.body->position(s.a), b = s.b.body->position(s.b);
  if (place == middle) {
    if (s.severed || dose_of(vein, middle) >= 1) return std::nullopt;
    return CoagulationSite{0.5 * (a + b) + arch(s, (b - a).norm()) * bowl_.up};
  }
  if (!bleeds(vein, place)) return std::nullopt;
  return CoagulationSite{place == from_stump ? a : b};
}

bool BridgingVeins::add_dose(const StepContext& context, int i, double dose) {
  double& d = doses_[std::size_t(i)];
  const bool closes = d < 1 && d + dose >= 1;
  d += dose;
  if (closes && i % places == middle && context.events)
    context.events->emit({vein_closed.name(), id, "", 1, context.time + context.h});
  return closes;
}

// A parabola of the height z is longer than its chord d by 8 z^2 / (3 d).
double BridgingVeins::arch(const Strand& s, double length) {
  return std::min(most_arch, std::sqrt(std::max(0.0, s.rest - length) * std::max(1e-6, length) * 0.375));
}

void BridgingVeins::draw(std::size_t line, const Course& course, const Strand& s, bool first) {
  const Vec3 a = s.a.body->position(s.a), b = s.b.body->position(s.b);
  const Vec3 lip = first ? a : b, other = first ? b : a;
  const double length = (b - a).norm();
  const double high = arch(s, length);
  for (int k = 0; k < ashore; ++k) {
    const std::size_t v = std::size_t(course.vertex[std::size_t(k)]);
    const MaterialPoint& p = course.on->points()[v];
    veins.set(line, std::size_t(k), k == ashore - 1 ? lip : p.body->position(p), 0);
  }
  for (int k = ashore; k < points; ++k) {
    // Half of the gap belongs to this line.
    const double share = double(k - ashore + 1) / (2 * (points - ashore));
    const double reach = s.severed ? std::min(0.4, stump / std::max(1e-6, length)) * 2 * share : share;
    const double rise = s.severed ? 0.0 : high * 4 * reach * (1 - reach);
    veins.set(line, std::size_t(k), lip + reach * (other - lip) + rise * bowl_.up, 0);
  }
}

void BridgingVeins::publish() {
  StrandSprings::publish();
  fibres.resize(0);  // drawn as veins
  const std::size_t n = strands().size();
  veins.resize(2 * n);
  jets.resize(2 * n);
  const double high = bowl_.height(volume_);
  for (std::size_t i = 0; i < n; ++i) {
    const Strand& s = strands()[i];
    draw(2 * i, courses_[i][0], s, true);
    draw(2 * i + 1, courses_[i][1], s, false);
    for (const MaterialPoint* p : {&s.a, &s.b}) {
      const std::size_t line = 2 * i + (p == &s.b);
      const bool open = bleeds(i, p == &s.a ? from_stump : to_stump);
      const double strength = open ? std::min(1.0, 0.5 * bleeding_rate() / full_jet) : 0;
      const Vec3 at = p->body->position(*p);
      jets.set(line, 0, at, strength);
      jets.set(line, 1, at + 0.01 * bowl_.up, strength);
    }
  }
  parted.set(veins_parted());
  rate.set(open_stumps() * 0.5 * bleeding_rate());
  lost.set(lost_);
  pool.set(bowl_.origin + high * bowl_.up, bowl_.up, high > 0 ? bowl_radius() : 0, high);
}

void BridgingVeins::reset() {
  if (created_at.is("settled")) courses_.clear();
  StrandSprings::reset();
  doses_.assign(places * courses_.size(), 0);
  volume_ = lost_ = 0;
}

void BridgingVeins::append_state(std::vector<double>& out) const {
  StrandSprings::append_state(out);
  out.insert(out.end(), {volume_, lost_});
  if (std::any_of(doses_.begin(), doses_.end(), [](double d) { return d > 0; }))
    out.insert(out.end(), doses_.begin(), doses_.end());
}

}  // namespace insula

INSULA_PLUGIN(bridging_veins) {
  registry.add_material({"vein", "wall", {0.22, 0.08, 0.20, 1}, 0.4, 0, 0.2});
  registry.add<insula::BridgingVeins>("bridging_veins", insula::Kind::constraint,
                                      "veins between two surfaces, which must be kept and bleed when they part");
}
