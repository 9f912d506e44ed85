// SPDX-License-Identifier: GPL-3.0-or-later
// Reads a rigid tool from URDF, its meshes and its tool.json.
#include <Eigen/Eigenvalues>
#include <algorithm>
#include <cmath>

#include "core/base/text.h"
#include "core/model/file_bytes.h"
#include "core/model/primitive_mesh.h"
#include "core/model/tool_json.h"
#include "core/model/tool_model.h"
#include "core/model/urdf_text.h"

namespace insula {
namespace {

constexpr std::size_t max_hull_points = 24;

class ToolReader {
 public:
  explicit ToolReader(const std::filesystem::path& file) : file_(file) {}

  ToolModel read() {
    const auto model = parse_urdf(file_);
    if (model->links_.size() != 1 || !model->root_link_)
      fail(file_, "has " + std::to_string(model->links_.size()) + " links; a rigid tool has one");
    const urdf::Link& link = *model->root_link_;
    tool_.name = model->getName();
    inertia(link);
    for (const auto& c : link.collision_array)
      if (c) collision(*c);
    if (tool_.pieces.empty()) fail(file_, "has no collision pieces");
    for (const auto& v : link.visual_array)
      if (v) visual(*v);
    read_tool_json(file_.parent_path() / "tool.json", tool_);
    return std::move(tool_);
  }

 private:
  Pose pose(const urdf::Pose& p, const std::string& what) const {
    Pose out{Vec3(p.position.x, p.position.y, p.position.z), Quat(p.rotation.w, p.rotation.x, p.rotation.y, p.rotation.z)};
    if (!out.p.allFinite() || !out.q.coeffs().allFinite() || !(out.q.norm() > 0.5)) fail(file_, what + ": its origin is not finite");
    out.q.normalize();
    return out;
  }

  double length(double value, const std::string& what) const {
    if (!std::isfinite(value) || !(value > 0)) fail(file_, what + " must be positive and finite");
    return value;
  }

  void inertia(const urdf::Link& link) {
    if (!link.inertial) fail(file_, "has no <inertial>");
    const urdf::Inertial& in = *link.inertial;
    if (!std::isfinite(in.mass) || !(in.mass > 0)) fail(file_, "its mass must be positive and finite");
    tool_.mass = in.mass;
    const Pose at = pose(in.origin, "<inertial>");
    tool_.centre_of_mass = at.p;
    Mat3 local;
    local << in.ixx, in.ixy, in.ixz, in.ixy, in.iyy, in.iyz, in.ixz, in.iyz, in.izz;
    if (!local.allFinite()) fail(file_, "its inertia is not finite");
    const Vec3 moments = Eigen::SelfAdjointEigenSolver<Mat3>(local).eigenvalues();  // ascending
    if (!(moments[0] > 1e-12 * moments[2])) fail(file_, "its inertia is not positive definite");
    if (moments[0] + moments[1] < moments[2] * (1 - 1e-5))
      fail(file_, "its inertia belongs to no body: the largest principal moment exceeds the sum of the two others");
    const Mat3 r = at.q.toRotationMatrix();
    const Mat3 turned = r * local * r.transpose();
    tool_.inertia = 0.5 * (turned + turned.transpose());
  }

  /// Beside the URDF; "package://NAME/" stands for that folder.
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
    const auto relative = std::filesystem::weakly_canonical(mesh, error).lexically_relative(std::filesystem::weakly_canonical(folder, error));
    if (error || relative.empty() || *relative.begin() == "..") fail(file_, what + ": the mesh " + in_quotes(name) + " lies outside this file's folder");
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
        piece.points = box_mesh({length(d.x, what + ": the size"), length(d.y, what + ": the size"), length(d.z, what + ": the size")}).vertices;
        break;
      }
      case urdf::Geometry::MESH: {
        piece.points = mesh(static_cast<const urdf::Mesh&>(*c.geometry), what).vertices;
        if (piece.points.size() > max_hull_points)
          fail(file_, what + ": its hull has " + std::to_string(piece.points.size()) + " points; at most " + std::to_string(max_hull_points) + " are allowed");
        break;
      }
    }
    for (Vec3& p : piece.points) p = at.apply(p);
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
        part.mesh = box_mesh({length(d.x, what + ": the size"), length(d.y, what + ": the size"), length(d.z, what + ": the size")});
        break;
      }
      case urdf::Geometry::MESH: part.mesh = mesh(static_cast<const urdf::Mesh&>(*v.geometry), what); break;
    }
    const Pose at = pose(v.origin, what);
    for (Vec3& p : part.mesh.vertices) p = at.apply(p);
    tool_.parts.push_back(std::move(part));
  }

  std::filesystem::path file_;
  ToolModel tool_;
};

}  // namespace

ToolModel read_tool(const std::filesystem::path& urdf) { return ToolReader(urdf).read(); }

}  // namespace insula
