// SPDX-License-Identifier: GPL-3.0-or-later
/*
# arachnoid_membrane

Translucent arachnoid between neighbouring strands of one <strand_springs>. It tents over a tool that presses on it,
tears, and retracts.

    <strand_springs id="arachnoid" from="frontal_surface" to="temporal_surface"/>
    <arachnoid_membrane id="membrane" strands="arachnoid"/>

Two strands are neighbours if no third one stands between them and they are not farther apart than `span`. A piece of
membrane is a bilinear patch. Its corners are the ends of two neighbours, so it moves with the tissue to which they are
attached. A tool of a hand that presses a piece meets one row at its deepest point x in the patch,

    delta = n . (x - sum_i w_i c_i),   delta + lambda / k = 0,   0 <= lambda <= strength

with the corners c_i, their bilinear weights w_i at the foot of x, and the patch's normal n to the side that the tool
came from. So the force is k times the depth of the tent, and the four ends carry it in the shares w_i. Nothing acts
while the tool is clear of the patch. A tool that has come in through a gap beside a piece does not touch it until it
has been clear of it.

A piece tears where lambda reaches `strength`, or the tent `tear_depth`. A cutting edge that travels along the patch by
`cut_length` parts it. Before that, k and `strength` fall in proportion to the travel. Where one of its two strands has
parted, the half beside the other one remains. Where both have, all of it retracts. Strands are as strong without the
membrane as with it, and goals on strands do not count its pieces.

The membrane has no mass and no tension at rest. Its pieces act on tools only.
*/
#include "plugins/arachnoid_membrane/arachnoid_membrane.h"

#include <algorithm>
#include <cmath>

#include "core/registry/registry.h"

namespace insula {
namespace {

constexpr double aware = 0.004;          // m from a patch within which the side of a tool is known
constexpr double working_end = 0.012;    // m from the tip, with which a tool touches membranes
constexpr double outline_step = 0.0004;  // m
constexpr double ahead = 0.0002;         // m; a gap that closes to less than this in the free motion has a row

}  // namespace

void ArachnoidMembrane::connect(PrepareContext& context, Simulation& simulation) {
  if (!strands) return error(context, "strands names the strands between which it is spanned");
  tools_.clear();
  for (Instrument* tool : simulation.instruments())
    if (tool->hand_index() >= 0) tools_.emplace_back(*tool, working_end, outline_step);
  strands->when_spun([this] { weave(); });
  weave();
}

void ArachnoidMembrane::weave() {
  std::vector<StrandState> states;
  for (int i = 0; i < strands->count(); ++i) states.push_back(strands->strand(i));
  pieces_.clear();
  for (const StrandPair& pair : neighbouring_strands(states, span())) {
    Piece piece;
    piece.pair = pair;
    piece.corner = {strands->beginning(pair.first), strands->ending(pair.first), strands->beginning(pair.second),
                    strands->ending(pair.second)};
    if (pair.crossed) std::swap(piece.corner[2], piece.corner[3]);
    pieces_.push_back(std::move(piece));
  }
  for (std::size_t i = 0; i < pieces_.size(); ++i)
    for (std::size_t j = 0; j < pieces_.size(); ++j) {
      const StrandPair &a = pieces_[i].pair, &b = pieces_[j].pair;
      if (i != j && (a.first == b.first || a.first == b.second || a.second == b.first || a.second == b.second))
        pieces_[i].neighbours.push_back(int(j));
    }
  tents_.assign(pieces_.size() * tools_.size(), Tent());
}

BilinearPatch ArachnoidMembrane::patch(const Piece& piece) const {
  BilinearPatch out;
  for (std::size_t k = 0; k < 4; ++k) out.corner[k] = piece.corner[k].body->position(piece.corner[k]);
  return out;
}

/// A piece spans as a whole, or only beside the strand that stands.
ArachnoidMembrane::Placed ArachnoidMembrane::place(const Piece& piece) const {
  const BilinearPatch at = patch(piece);
  return {at, BilinearPatch::Bounds(at), strands->severed(piece.pair.first) ? 0.5 : 0.0,
          strands->severed(piece.pair.second) ? 0.5 : 1.0};
}

/// The lowest point of the tool above the patch (side 1), or the highest of it (side -1).
ArachnoidMembrane::Deepest ArachnoidMembrane::deepest_from(int side, const Placed& piece, const ToolOutline& tool) {
  Deepest out;
  out.gap = infinite;
  const auto is_far = [&](const Vec3& at, double spread, double radius) {
    const double lowest = piece.bounds.least_height(at, side) - spread;
    return (lowest > 0 && lowest - radius > std::min(out.gap, aware)) ||
           !piece.bounds.may_have_foot(at, spread, aware + radius);
  };
  for (const ToolOutline::Group& group : tool.groups()) {
    if (is_far(group.at, group.spread, group.radius)) continue;
    for (std::size_t i = group.begin; i < group.end; ++i) {
      const ToolOutline::Ball& ball = tool.balls()[i];
      if (is_far(ball.at, 0, ball.radius)) continue;
      BilinearPatch::Foot foot;
      if (!piece.patch.foot_parameters(ball.at, foot.s, foot.t) || !piece.spans(foot.s, foot.t)) continue;
      piece.patch.complete(ball.at, foot);
      const double gap = side * foot.height - ball.radius;
      if (std::abs(foot.height) <= aware + ball.radius && gap < out.gap) out = {side, gap, &ball, foot};
    }
  }
  return out;
}

ArachnoidMembrane::Deepest ArachnoidMembrane::deepest(const Placed& piece, const ToolOutline& tool, int side) {
  if (side != 0) return deepest_from(side, piece, tool);
  Deepest below = deepest_from(1, piece, tool);
  if (below.gap > 0) return below;
  const Deepest above = deepest_from(-1, piece, tool);
  if (above.gap > 0) return above;
  below.side = 0;
  return below;
}

void ArachnoidMembrane::touch(const Placed& piece, const ToolOutline& tool, Tent& tent) {
  const Deepest d = deepest(piece, tool, tent.side);
  tent.near = d.ball != nullptr;
  tent.side_now = d.ball ? d.side : 0;
  tent.gap = infinite;
  if (tent.side_now == 0) return;
  tent.direction = d.side * d.foot.normal;
  tent.point = tool.tool().point(d.ball->at - d.ball->radius * tent.direction);
  tent.weight = BilinearPatch::weights(d.foot.s, d.foot.t);
  tent.gap = d.gap;
}

/// Where a cutting edge touches or crosses the patch.
void ArachnoidMembrane::find_edge(const Placed& piece, const ToolOutline& tool, Tent& tent) const {
  const BilinearPatch& patch = piece.patch;
  double best = reach();
  bool known = false;  // the foot of the point before
  BilinearPatch::Foot before;
  Vec3 at_before = Vec3::Zero();
  const auto take = [&](const Vec3& at, const BilinearPatch::Foot& foot) {
    if (!piece.spans(foot.s, foot.t) || std::abs(foot.height) > best) return;
    best = std::abs(foot.height);
    tent.edge = true;
    tent.edge_foot = foot;
    tent.edge_at = at;
  };
  for (const ToolOutline::Ball& b : tool.edge()) {
    // From here, neither this point nor the edge on either side of it reaches the patch.
    if (piece.bounds.least_distance(b.at) > std::max(best, outline_step)) {
      known = false;
      continue;
    }
    BilinearPatch::Foot foot;
    const bool found = patch.foot(b.at, foot);
    if (found) take(b.at, foot);
    if (found && known && foot.height * before.height < 0) {
      const Vec3 between = at_before + before.height / (before.height - foot.height) * (b.at - at_before);
      BilinearPatch::Foot crossing;
      if (patch.foot(between, crossing)) take(between, crossing);
    }
    known = found;
    before = foot;
    at_before = b.at;
  }
  if (tent.edge) tent.edge_point = tool.tool().point(tent.edge_at);
}

void ArachnoidMembrane::detect(const StepContext&) {
  for (ToolOutline& tool : tools_)
    if (tool.tool().active()) tool.place();
  for (Tent& t : tents_) {
    t.near = t.edge = false;
    t.side_now = 0;
    t.gap = infinite;
  }
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    if (!pieces_[i].holds) continue;
    const Placed piece = place(pieces_[i]);
    for (std::size_t k = 0; k < tools_.size(); ++k) {
      const ToolOutline& tool = tools_[k];
      if (!tool.tool().active() || piece.bounds.gap(tool.middle(), tool.radius()) > aware) continue;
      touch(piece, tool, tent(i, k));
      if (tool.tool().cutting()) find_edge(piece, tool, tent(i, k));
    }
  }
}

void ArachnoidMembrane::build(const StepContext&, ConstraintBuilder& builder) {
  for (std::size_t i = 0; i < pieces_.size(); ++i)
    for (std::size_t k = 0; k < tools_.size(); ++k) {
      Tent& t = tent(i, k);
      t.row = -1;
      if (t.side_now == 0) continue;
      const double closing = -t.direction.dot(tools_[k].tool().free_displacement(t.point));
      if (t.gap - std::max(0.0, closing) > ahead) continue;
      Block block;
      block.id = row_id(*this, index(i, k));
      block.role = BlockRole::fibre;
      block.compliance = 1 / rigidity(pieces_[i]);
      block.lower = 0;
      block.upper = yield(pieces_[i]);
      t.row = builder.add(block);
      builder.violation(t.row, t.gap);
      builder.point(t.row, t.point, t.direction);
      for (std::size_t c = 0; c < 4; ++c) builder.point(t.row, pieces_[i].corner[c], -t.weight[c] * t.direction);
    }
}

/// A tool that slides from a tent to the next piece presses that one from the same side.
void ArachnoidMembrane::remember_side(std::size_t piece, std::size_t tool) {
  Tent& t = tent(piece, tool);
  if (!t.near) {
    t.side = 0;
    return;
  }
  if (t.side_now != 0) {
    t.side = t.side_now;
    return;
  }
  const Vec3 normal = patch(pieces_[piece]).normal(0.5, 0.5);
  for (const int other : pieces_[piece].neighbours) {
    const Tent& from = tent(std::size_t(other), tool);
    const double along = from.direction.dot(normal);
    if (from.side_now == 0 || from.depth <= 0 || std::abs(along) < 0.7) continue;
    t.side = along > 0 ? 1 : -1;
    return;
  }
}

/// How far the edge has moved along the patch in the step, m.
double ArachnoidMembrane::travel(const Piece& piece, const ToolOutline& tool, const Tent& tent) const {
  const BilinearPatch::Foot& foot = tent.edge_foot;
  Vec3 motion = tool.tool().position(tent.edge_point) - tent.edge_at - (patch(piece).at(foot.s, foot.t) - foot.at);
  motion -= motion.dot(foot.normal) * foot.normal;
  return motion.norm();
}

void ArachnoidMembrane::part(const StepContext& context, Piece& piece, const EventKind& what, const ToolOutline& tool,
                             double force) {
  piece.holds = false;
  piece.damage = 1;
  if (context.events)
    context.events->emit({what.name(), id, "", force, context.time + context.h, tool.tool().hand_index()});
}

void ArachnoidMembrane::follow_strands(Piece& piece) const {
  if (!piece.holds || !strands->severed(piece.pair.first) || !strands->severed(piece.pair.second)) return;
  piece.holds = false;
  piece.damage = 1;
}

void ArachnoidMembrane::finish(const StepContext& context, const ConstraintSolution& solution) {
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    Piece& piece = pieces_[i];
    for (std::size_t k = 0; k < tools_.size(); ++k) {
      Tent& t = tent(i, k);
      t.force = t.row >= 0 ? solution.lambda[t.row] : 0;
      t.depth = t.row >= 0 ? std::max(0.0, -solution.delta[t.row]) : 0;
      if (!piece.holds) continue;
      const double force = t.force, most = yield(piece);
      if (t.edge) piece.damage += travel(piece, tools_[k], t) / cut_length();
      if (piece.damage >= 1) part(context, piece, cut, tools_[k], force);
      else if (force >= most || t.depth > tear_depth()) part(context, piece, torn, tools_[k], force);
    }
    follow_strands(piece);
  }
  for (std::size_t i = 0; i < pieces_.size(); ++i)
    for (std::size_t k = 0; k < tools_.size(); ++k) remember_side(i, k);
}

int ArachnoidMembrane::pieces_left() const {
  return int(std::count_if(pieces_.begin(), pieces_.end(), [](const Piece& p) { return p.holds; }));
}

void ArachnoidMembrane::publish() {
  double largest = 0;
  sheets.resize(pieces_.size());
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const Piece& piece = pieces_[i];
    const BilinearPatch at = patch(piece);
    const Tent* deepest = nullptr;
    for (std::size_t k = 0; k < tools_.size(); ++k) {
      const Tent& t = tent(i, k);
      largest = std::max(largest, t.force);
      if (t.depth > 0 && (!deepest || t.depth > deepest->depth)) deepest = &t;
    }
    // A torn piece keeps the tip from which it tore for one step.
    const Vec3 tip = deepest ? deepest->point.body->position(deepest->point) : at.middle();
    const auto value = [&](int strand) { return strands->severed(strand) ? -1.0 : strands->integrity(strand); };
    sheets.set(i, 0, tip, piece.holds ? 1 - piece.damage : -1.0);
    for (std::size_t c = 0; c < 4; ++c)
      sheets.set(i, c + 1, at.corner[c], value(c < 2 ? piece.pair.first : piece.pair.second));
  }
  whole_pieces.set_max(count());
  whole_pieces.set(pieces_left());
  pieces.set(count());
  push.set(largest);
}

void ArachnoidMembrane::reset() {
  for (Piece& piece : pieces_) {
    piece.holds = true;
    piece.damage = 0;
  }
  std::fill(tents_.begin(), tents_.end(), Tent());
}

void ArachnoidMembrane::append_state(std::vector<double>& out) const {
  for (const Piece& piece : pieces_) out.push_back(piece.holds ? piece.damage : 1);
  for (const Tent& t : tents_) out.push_back(t.side);
}

StatedLaw ArachnoidMembrane::law() const {
  double energy = 0;
  for (std::size_t i = 0; i < pieces_.size(); ++i) {
    const Piece& piece = pieces_[i];
    for (std::size_t k = 0; piece.holds && k < tools_.size(); ++k) {
      ToolOutline tool = tools_[k];
      if (!tool.tool().active()) continue;
      tool.place();
      const Deepest d = deepest(place(piece), tool, tent(i, k).side);
      if (!d.ball || d.side == 0 || d.gap >= 0) continue;
      // Elastic up to the strength, then at a constant force.
      const double stretch = std::min(-d.gap, yield(piece) / rigidity(piece));
      energy += 0.5 * rigidity(piece) * stretch * stretch + yield(piece) * (-d.gap - stretch);
    }
  }
  return StatedLaw::potential(energy);
}

}  // namespace insula

INSULA_PLUGIN(arachnoid_membrane) {
  registry.add_material({"arachnoid_membrane", "sheet", {0.906, 0.876, 0.849, 0.78}, 0.35, 0, 0.5});
  registry.add<insula::ArachnoidMembrane>("arachnoid_membrane", insula::Kind::constraint,
                                          "membranes between neighbouring strands, which tent, tear and retract");
}
