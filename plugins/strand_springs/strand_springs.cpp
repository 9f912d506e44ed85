// SPDX-License-Identifier: GPL-3.0-or-later
/*
# strand_springs

Arachnoid strands between two bodies. Each is one compliant row on the distance of its ends,

    delta = |qi - qj| - l0,   delta + lambda / k = 0,   lambda <= 0  (tension only)

solved with the contacts. A strand is therefore never stiffer or later than the tissue it pulls. Strands are generated
across the gap between two surfaces from a density and a maximal length. The same seed gives the same strands. Both
surfaces may be the same one (an aneurysm's sac and the branches at its neck). A strand then joins two points that
face each other and are not near along the surface. The path between them along the edges must be more than three
times as long as the strand.

A blade that comes within `reach` of a strand meets a rigid-plastic resistance. This is one row on their relative
motion whose force is at most cut_force, and whose violation is what the blade has still to go. Where the strand yields,
the blade's travel through it damages it. k decreases in proportion, and after cut_length the strand is severed. It is
also severed when it is pulled beyond `strength` times its remaining integrity. It then counts as torn, or as cut if a
blade is in it.

Source: Dequidt et al. 2015, section 3.3 (springs between lobes as constraints); forces of dissection: Marcus et al.
2014.
*/
#include "plugins/strand_springs/strand_springs.h"

#include <algorithm>
#include <cmath>

#include "core/base/random.h"
#include "core/collision/shapes/closest.h"
#include "core/registry/registry.h"
#include "plugins/strand_springs/nearest.h"

namespace insula {

void StrandSprings::add_strand(const MaterialPoint& a, const MaterialPoint& b) {
  Strand s;
  s.a = a;
  s.b = b;
  s.rest = slack() * (a.body->position(a) - b.body->position(b)).norm();
  strands_.push_back(s);
}

void StrandSprings::connect(PrepareContext& context, Simulation& simulation) {
  blades_.clear();
  for (Instrument* tool : simulation.instruments())
    blades_.push_back({.tool = tool, .edges = tool->tool().blade_edges});
  if (bool(from) != bool(to)) return error(context, "from and to belong together");
  if (from) {
    if (&from->body() == &to->body() && from.get() != to.get())
      return error(context, to, "to: strands within one body begin and end on the same surface");
    if (created_at.is("at_rest")) generate(context);
  }
}

void StrandSprings::settled(PrepareContext& context) {
  if (!from || !created_at.is("settled")) return;
  strands_.clear();
  generate(context);
}

namespace {

/// The pairs of vertices of two surfaces that a strand may join.
class StrandPartners {
 public:
  StrandPartners(const TriMesh& from, const TriMesh& to, bool within, double max_length)
      : mesh_(from),
        other_(to),
        within_(within),
        max_length_(max_length),
        normals_(vertex_normals(from)),
        other_normals_(vertex_normals(to)),
        nearest_(to.vertices, max_length),
        paths_(from) {}

  /// Possible partners for a strand from vertex v: facing, in reach, not much farther than the nearest.
  std::vector<int> of(int v) {
    const Vec3& p = mesh_.vertices[std::size_t(v)];
    nearest_.within(p, max_length_, found_);
    double least = max_length_;
    std::vector<int> out;
    for (int pass = 0; pass < 2; ++pass)
      for (int o : found_) {
        const Vec3 d = other_.vertices[std::size_t(o)] - p;
        const double length = d.norm();
        if (length < 1e-6 || d.dot(normals_[std::size_t(v)]) < 0.2 * length ||
            d.dot(other_normals_[std::size_t(o)]) > -0.2 * length)
          continue;
        if (within_ && near_along_surface(v, o, length)) continue;
        if (pass == 0) least = std::min(least, length);
        else if (length <= std::min(max_length_, 1.7 * least)) out.push_back(o);
      }
    return out;
  }

 private:
  bool near_along_surface(int v, int o, double length) {
    constexpr double detour = 3;
    return paths_.connected(v, o, detour * max_length_) && paths_.connected(v, o, detour * length);
  }

  const TriMesh &mesh_, &other_;
  bool within_;
  double max_length_;
  std::vector<Vec3> normals_, other_normals_;
  NearestVertices nearest_;
  SurfacePaths paths_;
  std::vector<int> found_;
};

/// The area that faces the other surface within reach, summed triangle by triangle.
struct FacingArea {
  std::vector<double> until;  ///< area of the triangles up to and including this one, m2
  std::vector<int> triangle;
  double total() const { return until.empty() ? 0 : until.back(); }
  int triangle_at(double area) const {
    const std::size_t t = std::size_t(std::upper_bound(until.begin(), until.end(), area) - until.begin());
    return triangle[std::min(t, triangle.size() - 1)];
  }
};

FacingArea facing_area(const TriMesh& mesh, StrandPartners& partners, const Vec3& centre, double radius) {
  FacingArea out;
  double area = 0;
  std::vector<signed char> faces(mesh.vertices.size(), -1);
  for (std::size_t t = 0; t < mesh.triangles.size(); ++t) {
    bool all = true;
    for (int v : mesh.triangles[t]) {
      if (faces[std::size_t(v)] < 0)
        faces[std::size_t(v)] = (mesh.vertices[std::size_t(v)] - centre).norm() <= radius && !partners.of(v).empty();
      all = all && faces[std::size_t(v)] == 1;
    }
    if (!all) continue;
    const auto& tri = mesh.triangles[t];
    const Vec3 &a = mesh.vertices[std::size_t(tri[0])], &b = mesh.vertices[std::size_t(tri[1])],
               &c = mesh.vertices[std::size_t(tri[2])];
    area += 0.5 * (b - a).cross(c - a).norm();
    out.until.push_back(area);
    out.triangle.push_back(int(t));
  }
  return out;
}

}  // namespace

void StrandSprings::generate(PrepareContext& context) {
  const TriMesh mesh{from->positions(), from->triangles()}, other{to->positions(), to->triangles()};
  const bool within = from.get() == to.get();
  StrandPartners partners(mesh, other, within, max_length());
  const FacingArea area = facing_area(mesh, partners, centre(), radius());
  const int wanted = int(std::lround(density() * area.total()));
  Random random{std::uint64_t(seed())};
  std::vector<std::pair<int, int>> pairs;
  for (int i = 0; i < wanted; ++i) {  // systematic sampling over the area: even, yet not regular
    const int t = area.triangle_at((i + random.uniform()) / wanted * area.total());
    const int v = mesh.triangles[std::size_t(t)][random.below(3)];
    const std::vector<int> choice = partners.of(v);
    const std::pair<int, int> pair{v, choice[random.below(std::uint32_t(choice.size()))]};
    const bool known = std::any_of(pairs.begin(), pairs.end(), [&](const auto& p) {
      return p == pair || (within && p.first == pair.second && p.second == pair.first);
    });
    if (!known) pairs.push_back(pair);
  }
  for (auto [v, o] : pairs) {
    add_strand(from->points()[std::size_t(v)], to->points()[std::size_t(o)]);
    spun(v, o);
  }
  if (strands_.empty() && density() > 0)
    error(context, "no strand fits: the surfaces are nowhere closer than max_length within the ball");
  tell_spun();
}

void StrandSprings::Blade::place(double steps) {
  cutting = tool->cutting();
  if (!cutting) return;
  middle.setZero();
  advance = 0;
  for (std::size_t i = 0; i < edges.size(); ++i)
    for (std::size_t k = 0; k < 2; ++k) {
      edges[i][k] = tool->pose().apply(tool->tool().blade_edges[i][k]);
      middle += edges[i][k] / (2 * double(edges.size()));
      advance = std::max(advance, steps * tool->free_displacement(tool->point(edges[i][k])).norm());
    }
  radius = 0;
  for (const auto& edge : edges)
    for (const Vec3& p : edge) radius = std::max(radius, (p - middle).norm());
}

namespace {

/// The part of a path along the unit vector u that lies within `reach` of a point that is `away` from its start, m;
/// infinite if there is none ahead.
struct Passage {
  double begin = infinite, end = infinite;
  Passage(const Vec3& away, const Vec3& u, double reach) {
    const double middle = away.dot(u), half2 = reach * reach - (away - middle * u).squaredNorm();
    if (!(half2 >= 0) || middle + std::sqrt(half2) < 0) return;
    end = middle + std::sqrt(half2);
    begin = std::max(0.0, middle - std::sqrt(half2));
  }
};

}  // namespace

/// Finds the blade that is in the strand, or else the one that reaches it first.
void StrandSprings::find_blade(Strand& s, double steps) const {
  const Vec3 pa = s.a.body->position(s.a), pb = s.b.body->position(s.b), axis = (pb - pa).normalized();
  double least_gap = infinite, least_distance = infinite;
  for (const Blade& blade : blades_) {
    const double range = reach() + blade.advance;
    if (!blade.cutting ||
        (0.5 * (pa + pb) - blade.middle).norm() > 0.5 * (pb - pa).norm() + blade.radius + 1.001 * range)
      continue;
    for (const auto& [e0, e1] : blade.edges) {
      double u, w;
      closest_segments(pa, pb, e0, e1, u, w);
      const Vec3 on_strand = pa + u * (pb - pa), on_edge = e0 + w * (e1 - e0), away = on_strand - on_edge;
      const double distance = away.norm();
      if (distance > range) continue;
      const MaterialPoint point = blade.tool->point(on_strand);
      double gap = 0;
      if (distance > reach()) {
        Vec3 motion = blade.tool->free_displacement(point);
        motion -= motion.dot(axis) * axis;
        gap = Passage(away, motion.stableNormalized(), reach()).begin;
        if (!(gap <= steps * motion.norm())) continue;
      }
      if (gap > least_gap || (gap == least_gap && distance > least_distance)) continue;
      least_gap = gap;
      least_distance = distance;
      s.blade = blade.tool;
      s.blade_point = point;  // the same point as on the strand: no net moment
      s.along = u;
      s.blade_away = away;
      s.blade_gap = gap;
    }
  }
}

void StrandSprings::detect(const StepContext& context) {
  const double steps = 1 + context.collision_horizon_s / context.h;
  for (Blade& blade : blades_) blade.place(steps);
  for (Strand& s : strands_) {
    s.blade = nullptr;
    if (s.severed) continue;
    find_blade(s, steps);
    if (!s.blade) continue;
    // The strand resists along the blade's motion across it.
    const Vec3 axis = (s.b.body->position(s.b) - s.a.body->position(s.a)).normalized();
    Vec3 motion = s.blade->free_displacement(s.blade_point) - (1 - s.along) * s.a.body->unforced_displacement(s.a) -
                  s.along * s.b.body->unforced_displacement(s.b);
    motion -= motion.dot(axis) * axis;
    if (motion.norm() > 1e-9) s.push = motion.normalized();
    else if (s.push.norm() < 0.5) s.blade = nullptr;  // without motion there is no resistance
  }
}

void StrandSprings::build(const StepContext&, ConstraintBuilder& builder) {
  std::uint64_t key = 0;
  for (Strand& s : strands_) {
    s.row = s.blade_row = -1;
    key += 2;
    if (s.severed) continue;
    const double integrity = 1 - s.damage;
    const bool cut = s.blade && cut_force() > 0;
    const int group = cut ? builder.rows() + 1 : 0;  // unlike that of other strands
    const Vec3 d = s.a.body->position(s.a) - s.b.body->position(s.b);
    const double length = d.norm();
    if (length > 1e-9) {
      const Vec3 u = d / length;
      const double longer =
          std::max(0.0, u.dot(s.a.body->expected_displacement(s.a) - s.b.body->expected_displacement(s.b)));
      // A strand that is slack by more than half a millimetre, now and after the expected motion, cannot become taut
      // within a step's correction.
      if (load_direction.is("both") || length + longer > s.rest - 0.0005) {
        Block block;
        block.id = row_id(*this, key);
        block.role = BlockRole::fibre;
        block.compliance = 1.0 / (stiffness() * integrity);
        block.failure_group = group;
        block.failure_force = float(strength() * integrity);
        block.upper = load_direction.is("both") ? infinite : 0.0;
        s.row = builder.add(block);
        builder.violation(s.row, length - s.rest);
        builder.point(s.row, s.a, u);
        builder.point(s.row, s.b, -u);
      }
    }
    if (cut) {
      Block block;
      block.id = row_id(*this, key + 1);
      block.role = BlockRole::contact;
      block.lower = -cut_force();
      block.upper = 0;
      // A blade that passes the strand before it has cut it leaves it whole.
      const double cuts_after = integrity * cut_length();
      const double passes_after = Passage(s.blade_away, s.push, reach()).end - s.blade_gap;
      block.failure_group = cuts_after <= passes_after ? group : 0;
      block.failure_travel = float(std::max(1e-9, std::min(cuts_after, passes_after)));
      s.blade_row = builder.add(block);
      builder.violation(s.blade_row, -s.blade_gap);
      builder.point(s.blade_row, s.blade_point, s.push);
      if (s.along < 1) builder.point(s.blade_row, s.a, -(1 - s.along) * s.push);
      if (s.along > 0) builder.point(s.blade_row, s.b, -s.along * s.push);
    }
  }
}

void StrandSprings::part(const StepContext& context, Strand& s, const EventKind& what, double value) {
  s.severed = true;
  s.damage = 1;
  s.tension = 0;
  if (context.events)
    context.events->emit({what.name(), id, "", value, context.time + context.h, s.blade ? s.blade->hand_index() : -1});
}

void StrandSprings::finish(const StepContext& context, const ConstraintSolution& solution) {
  for (Strand& s : strands_) {
    if (s.severed) continue;
    s.tension = s.row >= 0 ? -solution.lambda[s.row] : 0;
    double travel = 0;
    if (s.blade_row >= 0) travel = solution.delta[s.blade_row];
    else if (s.blade)  // no resistance: the free motion cuts
      travel = s.push.dot(s.blade->free_displacement(s.blade_point)) - s.blade_gap;
    if (s.blade_gap > 0 && travel <= 0) s.blade = nullptr;  // has not reached the strand in the step
    if (s.blade) {
      s.damage += std::max(0.0, travel) / cut_length();
      if (s.damage >= 1) {
        part(context, s, cut, cut_force());
        continue;
      }
    } else {
      s.push.setZero();
    }
    // A taut strand under a blade counts as cut, since surgeons tighten a strand before they cut it.
    if (strength() > 0 && s.tension > strength() * (1 - s.damage)) part(context, s, s.blade ? cut : torn, s.tension);
  }
}

StrandState StrandSprings::strand(int i) const {
  const Strand& s = strands_[std::size_t(i)];
  return {s.a.body->position(s.a), s.b.body->position(s.b), s.severed ? -1.0 : 1 - s.damage, s.tension};
}

void StrandSprings::publish() {
  double largest = 0;
  fibres.resize(strands_.size());
  for (int i = 0; i < count(); ++i) {
    const StrandState s = strand(i);
    fibres.set(std::size_t(i), 0, s.a, s.integrity);
    fibres.set(std::size_t(i), 1, s.b, s.integrity);
    largest = std::max(largest, s.tension);
  }
  standing.set_max(count());
  standing.set(strands_left());
  total.set(count());
  tension.set(largest);
  load.set(largest_load());
}

/// Of the strands that would tear: one under a blade is cut.
double StrandSprings::largest_load() const {
  double largest = 0;
  for (const Strand& s : strands_)
    if (!s.severed && !s.blade && strength() > 0)
      largest = std::max(largest, s.tension / (strength() * std::max(1 - s.damage, 1e-9)));
  return largest;
}

int StrandSprings::strands_left() const {
  return int(std::count_if(strands_.begin(), strands_.end(), [](const Strand& s) { return !s.severed; }));
}

void StrandSprings::reset() {
  if (created_at.is("settled")) {
    strands_.clear();
    tell_spun();
  }
  for (Strand& s : strands_) {
    s.damage = s.tension = 0;
    s.severed = false;
    s.blade = nullptr;
    s.push.setZero();
  }
}

void StrandSprings::append_state(std::vector<double>& out) const {
  for (const Strand& s : strands_) out.push_back(s.damage);
}

StatedLaw StrandSprings::law() const {
  double energy = 0;
  for (const Strand& s : strands_) {
    const double stretch = (s.a.body->position(s.a) - s.b.body->position(s.b)).norm() - s.rest;
    if (!s.severed && (stretch > 0 || load_direction.is("both")))
      energy += 0.5 * stiffness() * (1 - s.damage) * stretch * stretch;
  }
  return StatedLaw::potential(energy);
}

}  // namespace insula

INSULA_PLUGIN(strand_springs) {
  registry.add_material({"arachnoid", "fibre", {0.906, 0.876, 0.849, 0.78}, 0.35, 0, 0.5});
  registry.add<insula::StrandSprings>("strand_springs", insula::Kind::constraint,
                                      "arachnoid strands between two surfaces");
}
