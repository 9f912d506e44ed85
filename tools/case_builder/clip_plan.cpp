// SPDX-License-Identifier: GPL-3.0-or-later
#include "tools/case_builder/clip_plan.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/input_error.h"
#include "plugins/clip/clip_data.h"
#include "tools/case_builder/neck_frame.h"
#include "tools/case_builder/place.h"

namespace insula::case_builder {
namespace {

constexpr double degree = std::numbers::pi / 180;
constexpr double half_blade = 0.7;      // mm: of a blade's width, with what lies between two vertices of the wall
constexpr double yields = 1;            // mm by which the sac lets itself be pressed in by an open blade
constexpr double past = 1.5;            // mm that the tips go beyond the flattened neck
constexpr double off_floor = 0.4;       // mm that they keep from the floor, half their own width included
constexpr double off_floor_open = 0.1;  // the same of open blades
constexpr double large_opening =
    10;  // mm at the tips: wider jaws press the lobes, so they are for domes that need them

Vec3 across(const Vec3& a, const Vec3& n) { return (a - a.dot(n) * n).normalized(); }

/// How far blades with their middle there have to be drawn back before their outer half is clear of the floor.
/// inward, closing: unit.
double way_back(const Solid& floor, const ClipShape& clip, const Vec3& middle, const Vec3& inward, const Vec3& closing,
                Care care) {
  constexpr double farthest = 6, step = 0.1, most_for_open = 1;
  const auto first_clear = [&](double from, double to, const std::vector<double>& sides, double off) {
    for (double back = from; back < to; back += step) {
      bool clear = true;
      for (const double along : {0.0, 0.25, 0.5}) {
        const double aside = clip.half_open((clip.middle + along * clip.blade * clip.inward).z());
        for (const double side : sides) {
          const Vec3 p = middle + (along * clip.blade - back) * inward + side * aside * closing;
          const Nearest n = floor.nearest(p, farthest);
          clear = clear && !(n.found && n.distance < off);
        }
      }
      if (clear) return back;
    }
    return to;
  };
  const double shut = first_clear(0, farthest, {0}, off_floor);
  if (care == Care::usual) return shut;
  return first_clear(shut, std::min(shut + most_for_open, farthest), {-1, 1}, off_floor_open);
}

/// Height of the blades over the neck's plane, mm: a little towards the parent, as the neck bulges when it is pressed
/// flat.
double default_lift(double neck_diameter) { return -0.5 - 0.08 * neck_diameter; }

}  // namespace

std::vector<ClipShape> read_clips(const fs::path& project) {
  const Json catalogue = read_json(project / "meshes/clips/catalogue.json");
  std::vector<ClipShape> out;
  for (const Json& entry : catalogue.contains("clips") ? catalogue["clips"] : catalogue) {
    const std::string name = entry.at("name");
    const ToolModel tool = read_tool(project / "meshes/clips" / name / (name + ".urdf"));
    const auto data = read_clip_data(tool);
    if (!data || data->fenestration) continue;
    const ClipData& c = *data;
    const Vec3 from = 1000 * c.blade_line.front(), to = 1000 * c.blade_line.back();
    if (std::abs(from.x()) > 0.1 || (to - from).norm() < 0.97e3 * c.blade_length) continue;  // bent clamping lines
    ClipShape s{name,
                c.kind,
                1000 * c.blade_length,
                1000 * c.gap(tool.opening_max),
                0.5 * (from + to),
                (to - from).normalized(),
                1000 * c.grip.p,
                std::sin(tool.opening_max)};
    out.push_back(s);
  }
  if (out.empty()) throw InputError("meshes/clips holds no clip");
  return out;
}

ApplierPose applier_pose(const ClipShape& clip, const Vec3& middle, const Vec3& towards, const Vec3& closing) {
  const Vec3 inward = across(towards, closing), side = closing.cross(inward);
  const double c = -clip.inward.z(), s = clip.inward.y();  // the clip's own direction is (0, s, -c)
  const Vec3 y = s * inward + c * side, z = -c * inward + s * side;
  const auto turned = [&](const Vec3& v) -> Vec3 { return v.x() * closing + v.y() * y + v.z() * z; };
  const Vec3 tip = middle - turned(clip.middle);
  return {tip + turned(clip.grip), closing, z};
}

NeckSize neck_size(const artery::Vessel& v, const Vec3& along) {
  const Vec3 closing = v.neck->normal.cross(along);
  NeckSize out;
  double low[2] = {1e300, 1e300}, high[2] = {-1e300, -1e300};
  for (const auto& ends : neck_line(v)) {
    const Vec3 p = ends[0].in(v.wall.mesh.vertices), q = ends[1].in(v.wall.mesh.vertices);
    out.perimeter += (q - p).norm();
    for (const Vec3& x : {p, q}) {
      low[0] = std::min(low[0], x.dot(along)), high[0] = std::max(high[0], x.dot(along));
      low[1] = std::min(low[1], x.dot(closing)), high[1] = std::max(high[1], x.dot(closing));
    }
  }
  out.along = high[0] - low[0], out.across = high[1] - low[1];
  return out;
}

void ClipPlan::lay(const artery::Neck& neck, const BladePlacement& where) {
  at = where;
  const Vec3 outward = Eigen::AngleAxisd(at.turn * degree, neck.normal) * across(to_surgeon, neck.normal);
  const Vec3 closing = (at.mirrored ? -1.0 : 1.0) * neck.normal.cross(outward);
  pose = applier_pose(clip, neck.centre + at.lift * neck.normal - at.slide * outward, -outward, closing);
}

bool ClipPlan::meets_dome() const { return dome_outside > yields; }
bool ClipPlan::too_short() const { return clip.blade < needed - past; }
bool ClipPlan::kept_back() const { return drawn_back > past; }

namespace {

/// Points of the vessel in a clip's own frame where an applier holds the clip.
class ClipView {
 public:
  ClipView(const ClipShape& clip, const ApplierPose& pose)
      : clip_(clip),
        tip_(pose.tip),
        to_clip_(pose.rotation().transpose()),
        root_(clip.middle - 0.5 * clip.blade * clip.inward) {}
  Vec3 local(const Vec3& p) const { return clip_.grip + to_clip_ * (p - tip_); }
  /// Calls with points of the clamping line from `behind` mm behind the root to the tip.
  template <class Call>
  void along_blade(double behind, const Call& call) const {
    for (double along = -behind; along <= clip_.blade; along += 0.25) call(Vec3(root_ + along * clip_.inward));
  }

 private:
  const ClipShape& clip_;
  Vec3 tip_;
  Mat3 to_clip_;
  Vec3 root_;
};

}  // namespace

double outside_of_blades(const artery::Vessel& v, const ClipShape& clip, const ApplierPose& pose) {
  const ClipView view(clip, pose);
  double outside = 0;
  for (std::size_t i = 0; i < v.wall.mesh.vertices.size(); ++i) {
    const std::string& region = v.regions[std::size_t(v.region[i])];
    if (region != "sac" && region != "bleb") continue;
    const Vec3 p = view.local(v.wall.mesh.vertices[i]);
    double narrowest = 1e300;  // of all points of the blade that come by there
    view.along_blade(0, [&](const Vec3& b) {
      if (std::abs(b.y() - p.y()) < half_blade && b.z() <= p.z() + half_blade)
        narrowest = std::min(narrowest, clip.half_open(b.z()));
    });
    if (narrowest < 1e300) outside = std::max(outside, std::abs(p.x()) - narrowest);
  }
  return outside;
}

double branch_between_blades(const artery::Vessel& v, const ClipShape& clip, const ApplierPose& pose) {
  constexpr double behind_root = 3;  // mm: the jaws come together there too
  const ClipView view(clip, pose);
  double caught = 0;
  for (const artery::NamedCurve& c : v.centrelines) {
    if (c.name == "sac") continue;
    for (std::size_t k = 0; k < c.curve.size(); ++k) {
      const Vec3 p = view.local(c.curve.points[k]), from_neck = c.curve.points[k] - v.neck->centre;
      const double r = c.curve.radius[k], height = from_neck.dot(v.neck->normal);
      const bool beside_neck = (from_neck - height * v.neck->normal).norm() > 0.45 * v.neck->diameter;
      if (!beside_neck || height < -0.5 * r) continue;  // what lies below the neck is drawn away when blades close it
      // What lies beside the plane in which the blades meet slips out from between them, unless it rises past them.
      const double near_plane = std::clamp(1.5 - 0.75 * std::abs(p.x()) / r, 0.0, 1.0);
      view.along_blade(behind_root, [&](const Vec3& b) {
        const double beside = std::hypot(p.y() - b.y(), p.z() - b.z());
        const bool trapped = height > 0.5 * r && std::abs(p.x()) < clip.half_open(b.z());
        caught = std::max(caught, (trapped ? 1 : near_plane) * std::min(1.0, (r + half_blade - beside) / (2 * r)));
      });
    }
  }
  return caught;
}

std::vector<ClipPlan> clip_plans(const artery::Vessel& v, const Solid& floor, const std::vector<ClipShape>& clips,
                                 const Options& o, const Approach& approach, Care care) {
  const artery::Neck& neck = *v.neck;
  const Vec3& to_surgeon = approach.to_surgeon;
  std::vector<ClipPlan> out;
  for (double turn = -60; turn <= 60; turn += 15) {
    const double angle = o.turn.value_or(turn);
    const Vec3 outward = Eigen::AngleAxisd(angle * degree, neck.normal) * across(to_surgeon, neck.normal);
    const NeckSize size = neck_size(v, outward);
    // Closed, the neck's wall lies double: it is half its perimeter wide.
    const double needed = 0.5 * size.perimeter + past, lift = o.lift.value_or(default_lift(neck.diameter));
    for (const ClipShape& clip : clips) {
      if (!o.clip.empty() ? clip.name != o.clip : clip.kind == "temporary" || clip.kind == "mini_temporary") continue;
      if (o.clip.empty() && care == Care::usual && clip.tips_open() > large_opening) continue;
      const double slide = o.slide.value_or(std::max(0.0, needed - 0.5 * clip.blade - 0.25 * size.perimeter + 0.7));
      const Vec3 middle = neck.centre + lift * neck.normal - slide * outward;
      const double back = o.slide ? 0 : way_back(floor, clip, middle, -outward, neck.normal.cross(outward), care);
      for (const bool mirrored : {false, true}) {
        ClipPlan plan;
        plan.clip = clip, plan.to_surgeon = to_surgeon, plan.needed = needed, plan.drawn_back = back;
        plan.lay(neck, {lift, slide - back, angle, mirrored});
        plan.off_view = std::acos(std::clamp(plan.pose.shaft.dot(to_surgeon), -1.0, 1.0)) / degree;
        plan.dome_outside = outside_of_blades(v, clip, plan.pose);
        plan.branch_caught = branch_between_blades(v, clip, plan.pose);
        plan.cost = std::pow(plan.off_view / 12, 2) + std::pow(angle / 60, 2) +
                    1.2 * std::max(0.0, needed - clip.blade) + 0.35 * std::max(0.0, clip.blade - needed - 1) +
                    1.5 * std::max(0.0, 0.75 * size.across - 0.6 * clip.opening) + 1.2 * back + 8 * plan.branch_caught +
                    1.5 * std::max(0.0, plan.dome_outside - yields);
        out.push_back(std::move(plan));
      }
    }
    if (o.turn) break;
  }
  if (out.empty())
    throw InputError("--clip: the library has no clip \"" + o.clip +
                     "\" with a straight clamping line; see meshes/clips/README.md");
  std::stable_sort(out.begin(), out.end(), [](const ClipPlan& a, const ClipPlan& b) { return a.cost < b.cost; });
  return out;
}

std::vector<Note> notes_of(const ClipPlan& plan) {
  std::vector<Note> notes;
  if (plan.too_short())
    notes.push_back(
        problem("clip_too_short",
                fmt::format("The flattened neck is {:.1f} mm wide; the blades of {} reach over {:.1f} mm of it.",
                            plan.needed - past, plan.clip.name, plan.clip.blade),
                "Expect a remnant, or a second clip; a longer clip can be chosen with --clip."));
  if (plan.kept_back())
    notes.push_back(problem(
        "insula_behind_neck",
        fmt::format("The insula lies {:.1f} mm nearer behind the neck than the blades' tips need.", plan.drawn_back),
        "Expect a remnant behind; turn the vessel (--spin) or the blades (--turn), or choose a shorter clip "
        "(--clip)."));
  if (plan.meets_dome())
    notes.push_back(
        problem("dome_in_the_way",
                fmt::format("The sac reaches {:.1f} mm out of the space between the open blades.", plan.dome_outside),
                "Turn the vessel (--spin) or the blades (--turn), or choose another clip (--clip)."));
  if (plan.branch_caught > 0.3)
    notes.push_back(problem("branch_between_blades",
                            fmt::format("A branch beside the neck lies between the blades with {:.0f} % of its lumen.",
                                        100 * plan.branch_caught),
                            "Turn the vessel (--spin) or the blades (--turn), or choose a shorter clip (--clip)."));
  if (plan.off_view > 50)
    notes.push_back(problem("applier_off_view",
                            fmt::format("The applier comes {:.0f} degrees off the line of sight.", plan.off_view),
                            "Turn the vessel (--spin), or choose another clip (--clip)."));
  return notes;
}

ApplierPose plan_temporary(const artery::Vessel& v, const Solid& floor, const ClipShape& clip,
                           const Approach& approach) {
  const auto& c = v.centrelines.front().curve;
  std::size_t near = 0;
  for (std::size_t k = 0; k < c.size(); ++k)
    if ((c.points[k] - v.neck->centre).norm() < (c.points[near] - v.neck->centre).norm()) near = k;
  std::size_t at = near;
  double distance = 0;
  while (at > 2 && distance < 0.5 * v.neck->diameter + 2) distance += (c.points[at] - c.points[at - 1]).norm(), --at;
  const Vec3 along = c.tangent(at), square = across(approach.to_surgeon, along);
  const Vec3 outward = (0.4 * square + 0.6 * approach.to_surgeon).normalized();
  // Pressed flat the parent is half its perimeter wide; the tips go past its far edge where the floor lets them.
  const double tips = 0.5 * std::numbers::pi * c.radius[at] + past, slide = tips - 0.5 * clip.blade;
  const Vec3 middle = c.points[at] - slide * outward;
  const Vec3 closing = along.cross(outward).normalized();
  const double back = way_back(floor, clip, middle, -outward, closing, Care::usual);
  return applier_pose(clip, middle + back * outward, -outward, closing);
}

}  // namespace insula::case_builder
