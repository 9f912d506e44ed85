// SPDX-License-Identifier: GPL-3.0-or-later
/*
# blood_flow

Blood flow through a vessel with centrelines, as a network of resistances that follows the deformed wall. Along every
centreline the wall is cut into material cross-sections (section.h), where it is narrowed also into oblique ones; the
one that is narrowed most counts. A station of lumen A, perimeter P and length l has

    R = 2 mu P^2 l / A^3          (a circle: Poiseuille, 8 mu l / (pi r^4));   closed when A falls below `closed_below`
of its rest

Between the ends of a centreline is a node. It is the chamber of that stretch, whose wall stores blood
(plugins/pressure). The network is linear in the current pressures. It is solved together with the wall, the contacts
and the hands.

    arteries   p(t) --- upstream --- inlet            loses `upstream_drop` of the mean pressure at rest
    outlets    --- bed --- venous pressure            never backwards: a collapsed bed does not feed the vessel
               --- collateral --- p(t)                other arteries, little
    tear       Q = Cd A sqrt(2 dp / rho)              as conductance Cd A sqrt(2 / (rho dp)) of the last step's dp;
                                                      inward where the wall draws (a sac that is cut off)

The beds follow from the flow at rest. The inlet flow is split among the outlets by area to the power `split` (1.5:
Murray's law). A part that is cut off from every opening is sealed. Its pressure decays to the pressure outside within
`seal_decay`.

Sources: Murray 1926; Westerhof et al. 1969 (lumped arterial networks); orifice law as in any text on hydraulics.
*/
#include "plugins/blood_flow/blood_flow.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "core/base/text.h"
#include "core/registry/registry.h"

namespace insula {
namespace {

constexpr double collateral_delay = 3;  // s, of the dye through collateral vessels
constexpr double min_drop = 10;         // Pa, across a tear in its linear law

VecX rest_shape(const ShellBody& body) {
  VecX q(3 * body.nodes());
  for (int i = 0; i < body.nodes(); ++i) q.segment<3>(3 * i) = body.rest_nodes()[std::size_t(i)];
  return q;
}

}  // namespace

void BloodFlow::connect(PrepareContext& context, Simulation&) {
  if (!blood_pressure->ready(context)) return;
  if (blood_pressure->fed())
    return error(context, blood_pressure, in_quotes(blood_pressure->id) + " is fed by another network already");
  const ShellBody& body = *blood_pressure->on;
  if (std::string why = graph_.build(body.model(), body.wall_triangles(), thickness(), spacing()); !why.empty())
    return error(context, blood_pressure, in_quotes(body.id) + ": " + why);
  if (!find_ends(context) || !map_chambers(context)) return;
  graph_.measure(rest_shape(body), thickness(), viscosity(), closed_below());
  const std::size_t n = graph_.nodes.size();
  solved_.assign(n, 0.0);
  inflow_.assign(n, 0.0);
  inflow_dye_.assign(n, 0.0);
  part_.assign(n, 0);
  pressure_.assign(n, 0.0);
  const std::size_t chambers = std::size_t(blood_pressure->chambers().count());
  tear_area_.assign(chambers, 0.0);
  if (!set_beds(context)) return;
  for (std::size_t s = 0; s < graph_.stretches.size(); ++s)
    if (graph_.stretches[s].dead_end)
      for (const Station& t : graph_.stretches[s].stations) dye_.volume[s] += t.rest.area * t.length;
  for (std::size_t c = 0; c < chambers; ++c)
    if (const std::size_t s = std::size_t(main_stretch_[c]); graph_.stretches[s].dead_end)
      dye_.volume[s] = blood_pressure->rest_volume(int(c));
  reset();
  declare_channels();
  blood_pressure->set_feed(this);
}

void BloodFlow::set_links(StarMesh& mesh) const {
  mesh.clear(int(graph_.nodes.size()));
  for (const Branch& b : graph_.branches) mesh.link(place_[std::size_t(b.a)], place_[std::size_t(b.b)], b.conductance);
}

double BloodFlow::flow_of(const Stretch& s, int index) const {
  double sum = 0;
  int n = 0;
  for (const Branch& b : graph_.branches)
    if (b.stretch == index) {
      sum += b.flow;
      ++n;
    }
  return s.dead_end ? std::abs(sum) + dye_.exchange[std::size_t(index)] : sum / std::max(n, 1);
}

void BloodFlow::find_sealed() {
  for (std::size_t i = 0; i < part_.size(); ++i) part_[i] = int(i);
  for (bool changed = true; changed;) {
    changed = false;
    for (const Branch& b : graph_.branches) {
      int &a = part_[std::size_t(b.a)], &c = part_[std::size_t(b.b)];
      if (b.conductance > 0 && a != c) {
        a = c = std::min(a, c);
        changed = true;
      }
    }
  }
  for (std::size_t c = 0; c < sealed_.size(); ++c) {
    const int part = part_[std::size_t(chamber_node_[c])];
    bool fed = part == part_[std::size_t(inlet_node_)];
    for (const Outlet& o : outlets_)
      fed = fed ||
            (part == part_[std::size_t(o.node)] && (o.collateral > 0 || pressure_[std::size_t(o.node)] > venous()));
    for (std::size_t t = 0; t < sealed_.size(); ++t)
      fed = fed || (tear_area_[t] > 0 && part == part_[std::size_t(chamber_node_[t])]);
    sealed_[c] = !fed;
  }
}

void BloodFlow::reduce(const StepContext& context, StarMesh& out) {
  graph_.measure(blood_pressure->on->q(), thickness(), viscosity(), closed_below());
  find_sealed();
  const auto at = [&](int node) { return place_[std::size_t(node)]; };
  arterial_ = blood_pressure->arterial(context.h);
  set_links(mesh_);
  mesh_.ground(at(inlet_node_), upstream_, arterial_);
  for (const Outlet& o : outlets_) {
    if (pressure_[std::size_t(o.node)] > venous()) mesh_.ground(at(o.node), o.bed, venous());
    mesh_.ground(at(o.node), o.collateral, arterial_);
  }
  const int n = int(graph_.nodes.size()), chambers = int(sealed_.size());
  for (int c = 0; c < chambers; ++c) {
    const std::size_t i = std::size_t(c);
    const double drop = pressure_[std::size_t(chamber_node_[i])] - outside();
    tear_conductance_[i] =
        discharge() * tear_area_[i] * std::sqrt(2 / (density() * std::max(std::abs(drop), min_drop)));
    mesh_.ground(at(chamber_node_[i]), tear_conductance_[i] + (sealed_[i] ? yielding_[i] / seal_decay() : 0),
                 outside());
  }
  const int first = n - chambers;
  for (int k = 0; k < first; ++k) mesh_.eliminate(k);
  for (int i = 0; i < chambers; ++i) {
    for (int j = i + 1; j < chambers; ++j) out.link(i, j, mesh_.link(first + i, first + j));
    out.ground(i, mesh_.ground(first + i), 0);
    out.source(i, mesh_.current(first + i));
  }
}

void BloodFlow::settle(const StepContext& context, const double* pressure, const double* yielding) {
  const int n = int(graph_.nodes.size()), chambers = int(sealed_.size()), first = n - chambers;
  for (int c = 0; c < chambers; ++c) {
    solved_[std::size_t(first + c)] = pressure[c];
    yielding_[std::size_t(c)] = yielding[c];
    tear_flow_[std::size_t(c)] = tear_conductance_[std::size_t(c)] * (pressure[c] - outside());
  }
  for (int k = first - 1; k >= 0; --k)
    solved_[std::size_t(k)] = mesh_.pressure(k, solved_.data(), pressure_[std::size_t(node_at_[std::size_t(k)])]);
  // The pressure of the last step decides whether beds are open.
  for (Outlet& o : outlets_) {
    const double before = pressure_[std::size_t(o.node)];
    o.flow = before > venous() ? o.bed * (solved_[std::size_t(place_[std::size_t(o.node)])] - venous()) : 0;
  }
  for (int k = 0; k < n; ++k) pressure_[std::size_t(node_at_[std::size_t(k)])] = solved_[std::size_t(k)];
  for (Branch& b : graph_.branches)
    b.flow = b.conductance * (pressure_[std::size_t(b.a)] - pressure_[std::size_t(b.b)]);
  arterial_flow_ = upstream_ * (arterial_ - pressure_[std::size_t(inlet_node_)]);
  carry_dye(context);
  average(context.h);
}

void BloodFlow::carry_dye(const StepContext& context) {
  std::fill(inflow_.begin(), inflow_.end(), 0.0);
  std::fill(inflow_dye_.begin(), inflow_dye_.end(), 0.0);
  const auto enter = [&](int node, double q, double delay) {
    if (q <= 0) return;
    inflow_[std::size_t(node)] += q;
    if (since_dye_ >= 0) inflow_dye_[std::size_t(node)] += q * arterial_dye(since_dye_ - delay);
  };
  enter(inlet_node_, arterial_flow_, 0);
  for (const Outlet& o : outlets_)
    enter(o.node, o.collateral * (arterial_ - pressure_[std::size_t(o.node)]), collateral_delay);
  for (const Branch& b : graph_.branches) {
    const Stretch& s = graph_.stretches[std::size_t(b.stretch)];
    if (!s.dead_end) continue;
    // Flow past the sac over the same flow at rest.
    double passing = 0, at_rest = 0;
    for (std::size_t k = 0; k < graph_.branches.size(); ++k) {
      const Branch& other = graph_.branches[k];
      if ((other.a != b.a && other.b != b.a) || graph_.stretches[std::size_t(other.stretch)].dead_end) continue;
      passing += std::abs(other.flow);
      at_rest += std::abs(rest_flow_[std::size_t(other.stretch)]);
    }
    const double share = at_rest > 0 ? std::min(2.0, passing / at_rest) : 1;
    dye_.exchange[std::size_t(b.stretch)] =
        b.conductance > 0 ? sac_exchange() * flow() * share * std::min(1.0, s.narrowest) : 0;
  }
  dye_.step(graph_, context.h, pressure_, inflow_, inflow_dye_);
  if (since_dye_ >= 0) since_dye_ += context.h;
}

void BloodFlow::average(double h) {
  const double share = blood_pressure->beat_share(h);
  for (std::size_t s = 0; s < beat_flow_.size(); ++s) beat_flow_[s] += share * flow_of(graph_.stretches[s], int(s));
  beat_share_ += share;
  const bool beat_over = blood_pressure->beating() ? blood_pressure->phase() + share >= 1 : beat_share_ >= 1;
  if (!beat_over) return;
  for (std::size_t s = 0; s < beat_flow_.size(); ++s) {
    mean_flow_[s] = beat_flow_[s] / beat_share_;
    beat_flow_[s] = 0;
  }
  beat_share_ = 0;
}

void BloodFlow::append_vessels(std::vector<VesselState>& out) const {
  for (std::size_t i = 0; i < graph_.stretches.size(); ++i) {
    const Stretch& s = graph_.stretches[i];
    VesselState v;
    v.id = s.name;
    v.pressure = pressure_[std::size_t(s.middle)];
    v.flow = mean_flow_[i];
    v.flow_at_rest = rest_flow_[i];
    v.lumen = s.narrowest;
    v.dye = dye(i);  // as published
    v.heart_rests = blood_pressure->rests();
    out.push_back(v);
  }
}

void BloodFlow::publish() {
  for (std::size_t i = 0; i < stretch_flow.groups().size(); ++i) {
    const Stretch& s = graph_.stretches[i];
    stretch_pressure.set(i, pressure_[std::size_t(s.middle)]);
    stretch_flow.set(i, mean_flow_[i]);
    lumen.set(i, s.narrowest);
    dye.set(i, std::clamp(DyeTransport::mean(s), 0.0, 1.0));
  }
  for (std::size_t k = 0; k < passed_.size(); ++k) {
    const std::size_t i = passed_[k];
    // The share is a claim to a person: flow back counts as none. The channel `flow` has the sign.
    flow_share.set(k, rest_flow_[i] != 0 ? std::max(0.0, mean_flow_[i] / rest_flow_[i])
                                         : std::numeric_limits<double>::quiet_NaN());
  }
}

void BloodFlow::declare_channels() {
  std::vector<std::string> names, passed;
  passed_.clear();
  for (std::size_t i = 0; i < graph_.stretches.size(); ++i) {
    const Stretch& s = graph_.stretches[i];
    names.emplace_back(s.name);
    if (s.dead_end) continue;
    passed_.push_back(i);
    passed.emplace_back(s.name);
  }
  flow_share.declare(passed);
  for (auto* group : {&lumen, &dye}) group->declare(names);
  stretch_pressure.declare(names);
  dye.set_subject(blood_pressure->on.get());
  stretch_flow.declare(names);
}

void BloodFlow::reset() {
  pressure_ = rest_pressure_;
  const std::size_t n = main_stretch_.size();
  yielding_.assign(n, 0.0);
  tear_area_.assign(n, 0.0);
  tear_flow_.assign(n, 0.0);
  tear_conductance_.assign(n, 0.0);
  sealed_.assign(n, 0);
  mean_flow_ = rest_flow_;
  beat_flow_.assign(rest_flow_.size(), 0.0);
  beat_share_ = 0;
  arterial_flow_ = flow();
  since_dye_ = -1;
  dye_.reset(graph_);
}

void BloodFlow::append_state(std::vector<double>& out) const {
  for (const auto* v : {&pressure_, &yielding_, &tear_area_, &mean_flow_, &beat_flow_})
    out.insert(out.end(), v->begin(), v->end());
  out.insert(out.end(), {beat_share_, since_dye_});
  dye_.append_state(graph_, out);
}

std::vector<CommandInfo> BloodFlow::commands() const {
  return {{"inject_dye", "indocyanine green into a vein; the arteries glow some seconds later", "", 0, 0}};
}

std::string BloodFlow::run_command(std::string_view name, std::string_view) {
  if (name != "inject_dye") return "unknown command " + in_quotes(name);
  since_dye_ = 0;
  return {};
}

}  // namespace insula

INSULA_PLUGIN(blood_flow) {
  registry.add<insula::BloodFlow>(
      "blood_flow", insula::Kind::constraint,
      "blood flow through a vessel along its centrelines, with lumens measured on the deformed wall");
}
