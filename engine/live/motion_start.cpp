// SPDX-License-Identifier: GPL-3.0-or-later
// Moves a tool from its home to the first pose of its hand, and looks for the first thing in its way.
#include "engine/live/motion_start.h"

#include <fmt/format.h>

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "core/base/input_error.h"
#include "core/collision/shapes/gjk.h"
#include "core/mechanics/rigid_body.h"
#include "core/mechanics/surface.h"

namespace insula {
namespace {

constexpr double seen_m = 1e-3;     // contact's alarm distance: what is within it needs no check
constexpr double spacing_m = 5e-4;  // between two poses on the way
constexpr int most_poses = 1000;
constexpr const char* hand_names[] = {"left", "right"};

using Box = Eigen::AlignedBox3d;
using Hull = std::vector<Vec3>;

/// A piece of a tool at one pose.
struct PlacedHull {
  Hull points;
  double radius;
  Box box;
};

Box grown(Box box, double by) {
  box.min().array() -= by;
  box.max().array() += by;
  return box;
}

/// The pieces of a body whose root is at `root`, and whose links have the same places relative to it as now.
std::vector<PlacedHull> placed(const RigidBody& body, const Pose& root) {
  std::vector<PlacedHull> out;
  const Pose now = body.link_pose(0);
  const auto& pieces = body.tool().pieces;
  for (const ConvexPiece& piece : pieces) {
    PlacedHull& hull = out.emplace_back();
    hull.radius = piece.radius;
    for (const Vec3& p : piece.points) {
      const Vec3 relative = now.q.conjugate() * (body.link_pose(piece.link).apply(p) - now.p);
      hull.points.push_back(root.apply(relative));
      hull.box.extend(hull.points.back());
    }
    hull.box = grown(hull.box, piece.radius);
  }
  return out;
}

bool meet(const PlacedHull& a, std::span<const Vec3> b, const Box& box, double radius) {
  if (!a.box.intersects(box)) return false;
  const double limit = a.radius + radius;
  return hull_distance(a.points, b, limit + 1e-6).distance <= limit;
}

bool meet(const std::vector<PlacedHull>& a, const std::vector<PlacedHull>& b) {
  for (const PlacedHull& x : a)
    for (const PlacedHull& y : b)
      if (meet(x, y.points, y.box, y.radius)) return true;
  return false;
}

/// Whether a component joins both bodies by a list of bodies, as contact does.
bool may_touch(const Simulation& simulation, Body* a, Body* b) {
  for (const Constraint* c : simulation.constraints())
    for (const ParamBase* p : c->params()) {
      const auto* list = dynamic_cast<const RefList<Body>*>(p);
      if (!list) continue;
      const auto& bodies = (*list)();
      const auto has = [&](const Body* body) { return std::find(bodies.begin(), bodies.end(), body) != bodies.end(); };
      if (has(a) && has(b)) return true;
    }
  return false;
}

/// What a tool may meet on its way: triangles and rigid bodies, with the names of their owners.
class Field {
 public:
  Field(const Simulation& simulation, Instrument& tool, const std::vector<std::vector<PlacedHull>>& way) {
    Box reach;
    for (const auto& pose : way)
      for (const PlacedHull& hull : pose) reach.extend(hull.box);
    for (const Surface* s : simulation.surfaces())
      if (s->contact() && may_touch(simulation, &tool, &s->body())) add(*s, reach);
    for (Body* b : simulation.bodies()) {
      auto* rigid = dynamic_cast<RigidBody*>(b);
      if (!rigid || rigid == &tool || rigid->held_by() == &tool || !rigid->active() || !may_touch(simulation, &tool, b))
        continue;
      auto hulls = placed(*rigid, rigid->link_pose(0));
      if (!meet(way.front(), hulls)) rigid_.push_back({std::move(hulls), rigid->id});
    }
  }
  /// Name of what the tool meets there; null if nothing.
  const std::string* met(const std::vector<PlacedHull>& tool) const {
    for (const Triangle& t : triangles_)
      for (const PlacedHull& hull : tool)
        if (meet(hull, t.corners, t.box, t.radius)) return t.owner;
    for (const auto& [hulls, name] : rigid_)
      if (meet(tool, hulls)) return &name;
    return nullptr;
  }

 private:
  struct Triangle {
    std::array<Vec3, 3> corners;
    Box box;
    double radius;
    const std::string* owner;
  };
  void add(const Surface& surface, const Box& reach) {
    const double radius = 0.5 * surface.thickness();
    for (const auto& t : surface.triangles()) {
      Triangle triangle{{}, {}, radius, &surface.body().id};
      for (std::size_t k = 0; k < 3; ++k) {
        triangle.corners[k] = surface.positions()[std::size_t(t[k])];
        triangle.box.extend(triangle.corners[k]);
      }
      triangle.box = grown(triangle.box, radius);
      if (triangle.box.intersects(reach)) triangles_.push_back(triangle);
    }
  }

  std::vector<Triangle> triangles_;
  std::vector<std::pair<std::vector<PlacedHull>, std::string>> rigid_;
};

/// Whether the hand takes up a tool before the first step.
bool exchanges_at_start(const Motion& motion, int hand) {
  return std::any_of(motion.commands().begin(), motion.commands().end(), [&](const MotionCommand& c) {
    return c.time_s <= 0 && c.verb == "exchange" && c.argument.starts_with(hand_names[hand]);
  });
}

double farthest_point(const std::vector<PlacedHull>& a, const std::vector<PlacedHull>& b) {
  double out = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    for (std::size_t k = 0; k < a[i].points.size(); ++k) out = std::max(out, (a[i].points[k] - b[i].points[k]).norm());
  return out;
}

/// Name of what lies between home and start, empty if the way is free.
std::string in_the_way(const Simulation& simulation, Instrument& tool, const Pose& home, const Pose& start) {
  const double distance = farthest_point(placed(tool, home), placed(tool, start));
  if (distance <= seen_m) return {};
  const int n = std::min(most_poses, int(std::ceil(distance / spacing_m)));
  std::vector<std::vector<PlacedHull>> way;
  for (int k = 0; k <= n; ++k) {
    const double s = double(k) / n;
    way.push_back(placed(tool, Pose{(1 - s) * home.p + s * start.p, home.q.slerp(s, start.q)}));
  }
  const Field field(simulation, tool, way);
  const std::string* first = nullptr;
  double met_at = 1;
  for (int k = 0; k <= n; ++k) {
    const std::string* name = field.met(way[std::size_t(k)]);
    if (first && !name) return *first;  // it is passed through
    if (!first && name) {
      first = name;
      met_at = double(k) / n;
    }
  }
  return first && (1 - met_at) * distance > deepest_start_m ? *first : "";
}

}  // namespace

void check_start(const Simulation& simulation, const Motion& motion) {
  for (int hand = 0; hand < 2; ++hand) {
    Instrument* tool = simulation.instrument_of(hand);
    if (!motion.has(hand) || !tool || exchanges_at_start(motion, hand)) continue;
    const Pose home = tool->home_pose(), start = motion.at(hand, 0).pose;
    const double distance = (start.p - home.p).norm();
    const std::string found = distance > farthest_start_m ? "" : in_the_way(simulation, *tool, home, start);
    if (found.empty() && distance <= farthest_start_m) continue;
    const std::string reason = found.empty()
                                   ? fmt::format("more than the {:.0f} mm that are allowed", 1e3 * farthest_start_m)
                                   : fmt::format("and \"{}\" is in the way", found);
    throw InputError(fmt::format(
        "the motion starts {:.1f} mm and {:.0f} degrees away from the home of \"{}\" in the {} hand, {}; begin at "
        "the home ({:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g},{:.6g}) and lead the hand to the first pose",
        1e3 * distance, start.q.angularDistance(home.q) * 180 / M_PI, tool->id, hand_names[hand], reason, home.p.x(),
        home.p.y(), home.p.z(), home.q.w(), home.q.x(), home.q.y(), home.q.z()));
  }
}

}  // namespace insula
