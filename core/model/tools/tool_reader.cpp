// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a tool from URDF, its meshes and its tool.json.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>
#include <numbers>

#include "core/base/text.h"
#include "core/model/formats/file_bytes.h"
#include "core/model/tools/primitive_mesh.h"
#include "core/model/tools/tool_json.h"
#include "core/model/tools/tool_model.h"
#include "core/model/tools/urdf_text.h"

namespace insula {
namespace {

constexpr std::size_t max_hull_points = 24;

class ToolReader {
 public:
  explicit ToolReader(const std::filesystem::path& file) : file_(file) {}

  ToolModel read() {
    const auto model = parse_urdf(file_);
    if (!model->root_link_) fail(file_, "has no links");
    tool_.name = model->getName();
    const std::vector<const urdf::Joint*> joints = ordered_joints(*model);
    read_link(*model->root_link_);
    for (const urdf::Joint* joint : joints) {
      const auto child = model->links_.find(joint->child_link_name);
      if (child == model->links_.end() || !child->second)
        fail(file_, "the link of the joint " + in_quotes(joint->name) + " is missing");
      hinge(*joint);
      read_link(*child->second);
    }
    combine_inertias();
    if (tool_.pieces.empty()) fail(file_, "has no collision pieces");
    read_tool_json(file_.parent_path() / "tool.json", tool_);
    return std::move(tool_);
  }

 private:
  Pose pose(const urdf::Pose& p, const std::string& what) const {
    Pose out{Vec3(p.position.x, p.position.y, p.position.z),
             Quat(p.rotation.w, p.rotation.x, p.rotation.y, p.rotation.z)};
    if (!out.p.allFinite() || !out.q.coeffs().allFinite() || !(out.q.norm() > 0.5))
      fail(file_, what + ": its origin is not finite");
    out.q.normalize();
    return out;
  }

  double length(double value, const std::string& what) const {
    if (!std::isfinite(value) || !(value > 0)) fail(file_, what + " must be positive and finite");
    return value;
  }

  /// The driving joint first, then its mimics by name (urdfdom keeps no other order).
  std::vector<const urdf::Joint*> ordered_joints(const urdf::ModelInterface& model) const {
    std::vector<const urdf::Joint*> joints;
    for (const auto& [name, joint] : model.joints_) {
      if (!joint) continue;
      const std::string what = "the joint " + in_quotes(name);
      if (joint->type != urdf::Joint::REVOLUTE)
        fail(file_, what + " is not revolute; the links of a tool are turned by revolute joints");
      if (joint->parent_link_name != model.root_link_->name)
        fail(file_, what + " hangs on the link " + in_quotes(joint->parent_link_name) +
                        "; every joint of a tool hangs on its root " + in_quotes(model.root_link_->name));
      if (joint->mimic) {
        joints.push_back(joint.get());
        continue;
      }
      if (!joints.empty() && !joints.front()->mimic)
        fail(file_, "the joints " + in_quotes(joints.front()->name) + " and " + in_quotes(name) +
                        " are independent; one must <mimic> the other");
      joints.insert(joints.begin(), joint.get());
    }
    for (const urdf::Joint* joint : joints)
      if (joint->mimic && joint->mimic->joint_name != joints.front()->name)
        fail(file_, "the joint " + in_quotes(joint->name) + " mimics " + in_quotes(joint->mimic->joint_name) +
                        ", which is no independent joint of this tool");
    if (!joints.empty() && joints.front()->mimic)
      fail(file_, "the joint " + in_quotes(joints.front()->name) + " mimics itself");
    return joints;
  }

  void hinge(const urdf::Joint& joint) {
    const std::string what = "the joint " + in_quotes(joint.name);
    const Pose at = pose(joint.parent_to_joint_origin_transform, what);
    const Vec3 axis(joint.axis.x, joint.axis.y, joint.axis.z);
    if (!axis.allFinite() || !(axis.norm() > 1e-9)) fail(file_, what + ": its axis must be finite and not zero");
    Hinge h{at.p, (at.q * axis).normalized(), 1};
    if (!joint.limits) fail(file_, what + " has no <limit>");
    const double lower = joint.limits->lower, upper = joint.limits->upper;
    if (!std::isfinite(lower) || !std::isfinite(upper) || lower > upper || std::max(-lower, upper) > std::numbers::pi)
      fail(file_, what + ": its limits must be finite, in order and within half a turn");
    if (joint.mimic) {
      h.multiplier = joint.mimic->multiplier;
      if (!std::isfinite(h.multiplier) || h.multiplier == 0)
        fail(file_, what + ": the multiplier of its <mimic> must be finite and not zero");
      if (joint.mimic->offset != 0) fail(file_, what + ": the offset of its <mimic> must be 0");
      const auto [least, most] = std::minmax({h.multiplier * tool_.opening_min, h.multiplier * tool_.opening_max});
      if (least < lower - 1e-6 || most > upper + 1e-6)
        fail(file_, what + ": its limits are narrower than those of the joint it mimics");
    } else {
      tool_.opening_min = lower;
      tool_.opening_max = upper;
    }
    tool_.hinges.push_back(h);
    frame_ = at;
    link_ = int(tool_.hinges.size());
  }

  void read_link(const urdf::Link& link) {
    inertia(link);
    for (const auto& c : link.collision_array)
      if (c) collision(*c);
    for (const auto& v : link.visual_array)
      if (v) visual(*v);
  }

  Pose in_tool(const Pose& local) const { return {frame_.apply(local.p), frame_.q * local.q}; }

  void inertia(const urdf::Link& link) {
    const std::string its = link_ == 0 ? "its " : "link " + in_quotes(link.name) + ": its ";
    if (!link.inertial)
      fail(file_, (link_ == 0 ? std::string() : "link " + in_quotes(link.name) + " ") + "has no <inertial>");
    const urdf::Inertial& in = *link.inertial;
    if (!std::isfinite(in.mass) || !(in.mass > 0)) fail(file_, its + "mass must be positive and finite");
    const Pose at = in_tool(pose(in.origin, "<inertial>"));
    Mat3 local;
    local << in.ixx, in.ixy, in.ixz, in.ixy, in.iyy, in.iyz, in.ixz, in.iyz, in.izz;
    if (!local.allFinite()) fail(file_, its + "inertia is not finite");
    const Vec3 moments = Eigen::SelfAdjointEigenSolver<Mat3>(local).eigenvalues();  // ascending
    if (!(moments[0] > 1e-12 * moments[2])) fail(file_, its + "inertia is not positive definite");
    if (moments[0] + moments[1] < moments[2] * (1 - 1e-5))
      fail(file_, its + "inertia belongs to no body: the largest principal moment exceeds the sum of the two others");
    const Mat3 r = at.q.toRotationMatrix();
    const Mat3 turned = r * local * r.transpose();
    links_.push_back({in.mass, at.p, 0.5 * (turned + turned.transpose())});
  }

  /// Computed as corrections to the first link, so that a rigid tool keeps its exact numbers.
  void combine_inertias() {
    for (const LinkInertia& l : links_) tool_.mass += l.mass;
    Vec3 shift = Vec3::Zero();
    for (const LinkInertia& l : links_) shift += l.mass / tool_.mass * (l.centre - links_.front().centre);
    tool_.centre_of_mass = links_.front().centre + shift;
    for (const LinkInertia& l : links_) {
      const Vec3 d = l.centre - tool_.centre_of_mass;
      tool_.inertia += l.about_centre + l.mass * (d.squaredNorm() * Mat3::Identity() - d * d.transpose());
    }
  }

  /// Relative to the URDF. "package://NAME/" means that folder.
  std::filesystem::path resolved(std::string name, const std::string& what) const {
    if (name.rfind("package://", 0) == 0) {
      const std::size_t slash = name.find('/', 10);
      name = slash == std::string::npos ? std::string() : name.substr(slash + 1);
    }
    if (name.empty() || name.find("://") != std::string::npos || std::filesystem::path(name).is_absolute())
      fail(file_, what + ": the mesh " + in_quotes(name) + " must be named relative to this file");
    const std::filesystem::path folder = file_.has_parent_path() ? file_.parent_path() : std::filesystem::path(".");
    const std::filesystem::path mesh = folder / name;
    std::error_code error;
    const auto relative = std::filesystem::weakly_canonical(mesh, error)
                              .lexically_relative(std::filesystem::weakly_canonical(folder, error));
    if (error || relative.empty() || *relative.begin() == "..")
      fail(file_, what + ": the mesh " + in_quotes(name) + " lies outside this file's folder");
    return mesh;
  }

  TriMesh mesh(const urdf::Mesh& m, const std::string& what) const {
    const Vec3 scale(length(m.scale.x, what + ": the mesh's scale"), length(m.scale.y, what + ": the mesh's scale"),
                     length(m.scale.z, what + ": the mesh's scale"));
    TriMesh out = read_surface(resolved(m.filename, what), 1.0);
    for (Vec3& v : out.vertices) v = v.cwiseProduct(scale);
    return out;
  }

  void collision(const urdf::Collision& c) {
    ConvexPiece piece;
    piece.name = c.name.empty() ? "piece_" + std::to_string(tool_.pieces.size() + 1) : c.name;
    const std::string what = "collision " + in_quotes(piece.name);
    if (!c.geometry) fail(file_, what + " has no geometry");
    const Pose at = pose(c.origin, what);
    switch (c.geometry->type) {
      case urdf::Geometry::SPHERE:
        piece.radius = length(static_cast<const urdf::Sphere&>(*c.geometry).radius, what + ": the radius");
        piece.points = {Vec3::Zero()};
        break;
      case urdf::Geometry::CYLINDER: {
        const auto& g = static_cast<const urdf::Cylinder&>(*c.geometry);
        piece.radius = length(g.radius, what + ": the radius");
        const double half = 0.5 * length(g.length, what + ": the length") - piece.radius;
        if (half < -1e-9) fail(file_, what + ": as a capsule it must be at least as long as it is wide; use a sphere");
        piece.points = {Vec3(0, 0, -half), Vec3(0, 0, half)};
        if (half < 1e-9) piece.points = {Vec3::Zero()};
        break;
      }
      case urdf::Geometry::BOX: {
        const auto& d = static_cast<const urdf::Box&>(*c.geometry).dim;
        piece.points = box_mesh({length(d.x, what + ": the size"), length(d.y, what + ": the size"),
                                 length(d.z, what + ": the size")})
                           .vertices;
        break;
      }
      case urdf::Geometry::MESH: {
        piece.points = mesh(static_cast<const urdf::Mesh&>(*c.geometry), what).vertices;
        if (piece.points.size() > max_hull_points)
          fail(file_, what + ": its hull has " + std::to_string(piece.points.size()) + " points; at most " +
                          std::to_string(max_hull_points) + " are allowed");
        break;
      }
    }
    for (Vec3& p : piece.points) p = frame_.apply(at.apply(p));
    piece.link = link_;
    tool_.pieces.push_back(std::move(piece));
  }

  void visual(const urdf::Visual& v) {
    ToolPart part;
    part.name = v.name.empty() ? "part_" + std::to_string(tool_.parts.size() + 1) : v.name;
    const std::string what = "visual " + in_quotes(part.name);
    if (!v.geometry) fail(file_, what + " has no geometry");
    part.material = v.material_name.empty() ? "steel" : v.material_name;
    if (v.material) {
      const urdf::Color& c = v.material->color;
      part.rgba = {double(c.r), double(c.g), double(c.b), double(c.a)};
      for (double x : part.rgba)
        if (!(x >= 0 && x <= 1)) fail(file_, what + ": its colour must lie between 0 and 1");
    }
    switch (v.geometry->type) {
      case urdf::Geometry::SPHERE:
        part.mesh = sphere_mesh(length(static_cast<const urdf::Sphere&>(*v.geometry).radius, what + ": the radius"));
        break;
      case urdf::Geometry::CYLINDER: {
        const auto& g = static_cast<const urdf::Cylinder&>(*v.geometry);
        part.mesh = cylinder_mesh(length(g.radius, what + ": the radius"), length(g.length, what + ": the length"));
        break;
      }
      case urdf::Geometry::BOX: {
        const auto& d = static_cast<const urdf::Box&>(*v.geometry).dim;
        part.mesh = box_mesh(
            {length(d.x, what + ": the size"), length(d.y, what + ": the size"), length(d.z, what + ": the size")});
        break;
      }
      case urdf::Geometry::MESH: part.mesh = mesh(static_cast<const urdf::Mesh&>(*v.geometry), what); break;
    }
    const Pose at = pose(v.origin, what);
    for (Vec3& p : part.mesh.vertices) p = frame_.apply(at.apply(p));
    part.link = link_;
    tool_.parts.push_back(std::move(part));
  }

  struct LinkInertia {
    double mass;
    Vec3 centre;
    Mat3 about_centre;
  };

  std::filesystem::path file_;
  ToolModel tool_;
  std::vector<LinkInertia> links_;
  Pose frame_;  ///< of the link that is being read, at opening 0
  int link_ = 0;
};

}  // namespace

Pose ToolModel::link_pose(int link, double opening) const {
  if (link <= 0) return {};
  const Hinge& h = hinges[std::size_t(link) - 1];
  const Quat q(Eigen::AngleAxisd(h.multiplier * opening, h.axis));
  return {h.origin - q * h.origin, q};
}

ToolModel read_tool(const std::filesystem::path& urdf) { return ToolReader(urdf).read(); }

}  // namespace insula
