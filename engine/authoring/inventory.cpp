// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/authoring/inventory.h"

#include <fmt/format.h>

#include <algorithm>

#include "core/mechanics/shell_body.h"
#include "core/mechanics/soft_body.h"
#include "core/sim/report.h"

namespace insula {
namespace {

constexpr std::size_t max_lines = 3000, max_points = 3000;  // of one item; enough to recognise it

std::string mm(double metres) { return fmt::format("{:.{}f}", 1000 * metres, metres < 0.01 ? 2 : 1); }

std::string box_text(const Eigen::AlignedBox3d& box) {
  if (box.isEmpty()) return "empty";
  const Vec3 s = box.sizes();
  return mm(s.x()) + " x " + mm(s.y()) + " x " + mm(s.z()) + " mm";
}

template <class Points>
Eigen::AlignedBox3d box_of(const Points& points) {
  Eigen::AlignedBox3d box;
  for (const Vec3& p : points) box.extend(p);
  return box;
}

/// A regular selection of pairs of points, at most `most`.
std::vector<Vec3> thinned(const std::vector<Vec3>& all, std::size_t points_each, std::size_t most) {
  const std::size_t n = all.size() / points_each, step = std::max<std::size_t>(1, (n + most - 1) / most);
  std::vector<Vec3> out;
  for (std::size_t i = 0; i < n; i += step)
    for (std::size_t k = 0; k < points_each; ++k) out.push_back(all[points_each * i + k]);
  return out;
}

template <class At>
std::vector<Vec3> edges_of(const std::vector<std::array<int, 3>>& triangles, const At& at) {
  std::vector<std::pair<int, int>> edges;
  for (const auto& t : triangles)
    for (std::size_t k = 0; k < 3; ++k) edges.push_back(std::minmax(t[k], t[(k + 1) % 3]));
  std::sort(edges.begin(), edges.end());
  edges.erase(std::unique(edges.begin(), edges.end()), edges.end());
  std::vector<Vec3> out;
  for (const auto& [i, j] : edges) {
    out.push_back(at(i));
    out.push_back(at(j));
  }
  return thinned(out, 2, max_lines);
}

class Taker {
 public:
  explicit Taker(const Simulation& s) : simulation_(s) {}

  std::vector<InventoryItem> all() {
    for (const Body* b : simulation_.bodies())
      if (!dynamic_cast<const RigidBody*>(b)) body(*b);
    for (const Surface* s : simulation_.surfaces()) surface(*s);
    for (const ShellBody* shell : simulation_.scene().all<ShellBody>()) regions(*shell);
    for (Support* s : simulation_.scene().all<Support>()) support(*s);
    for (const ForceModel* f : simulation_.scene().all<ForceModel>())
      if (!f->internal()) add("anchor", *f, "holds " + f->parent->id, lines_of(*dynamic_cast<const Body*>(f->parent)));
    for (const auto& [component, drawable] : simulation_.drawables()) this->drawable(*component, *drawable);
    pairs();
    for (const Constraint* c : simulation_.constraints()) {
      if (!list_between(*c)) add("constraint", *c, joins(*c), {});
    }
    for (const Body* b : simulation_.bodies())
      if (const auto* rigid = dynamic_cast<const RigidBody*>(b)) tool(*rigid);
    return std::move(items_);
  }

 private:
  InventoryItem& add(std::string group, const Component& c, std::string size, std::vector<Vec3> lines) {
    InventoryItem item;
    item.group = std::move(group);
    item.name = c.id;
    item.element = c.element;
    item.size = std::move(size);
    for (const ParamBase* p : c.params())
      if (!p->text().empty()) item.values.emplace_back(p->name(), p->text());
    item.file = c.pos.line > 0 ? fmt::format("{}:{}", c.pos.file, c.pos.line) : c.pos.file;
    item.lines = std::move(lines);
    return items_.emplace_back(std::move(item));
  }
  static Vec3 node(const DeformableBody& b, int i) { return b.q().segment<3>(3 * i); }

  std::vector<Vec3> lines_of(const Body& b) const {
    const auto node_of = [&](const DeformableBody& d) { return [&d](int i) { return node(d, i); }; };
    if (const auto* soft = dynamic_cast<const SoftBody*>(&b))
      return edges_of(boundary_triangles(soft->rest()), node_of(*soft));
    if (const auto* shell = dynamic_cast<const ShellBody*>(&b))
      return edges_of(shell->rest().triangles, node_of(*shell));
    std::vector<Vec3> out;
    if (const auto* rigid = dynamic_cast<const RigidBody*>(&b)) {
      for (const ToolPart& part : rigid->tool().parts) {
        const Pose pose = rigid->link_pose(part.link);
        const auto more =
            edges_of(part.mesh.triangles, [&](int i) { return pose.apply(part.mesh.vertices[std::size_t(i)]); });
        out.insert(out.end(), more.begin(), more.end());
      }
      return thinned(out, 2, max_lines);
    }
    for (const Surface* s : b.children_of<Surface>()) {
      const auto more = edges_of(s->triangles(), [&](int i) { return s->positions()[std::size_t(i)]; });
      out.insert(out.end(), more.begin(), more.end());
    }
    return thinned(out, 2, max_lines);
  }
  static std::string unit_of(const Component& c, const char* what) {
    const ParamBase* file = c.find_param(what);
    const ParamBase* unit = c.find_param("mesh_unit");
    return unit && file && !file->text().empty() ? ", file in " + unit->text() : "";
  }

  void body(const Body& b) {
    std::string text;
    if (const auto* d = dynamic_cast<const DeformableBody*>(&b)) {
      double mass = 0;
      Eigen::AlignedBox3d box;
      for (int i = 0; i < d->nodes(); ++i) box.extend(node(*d, i));
      for (const double m : d->node_mass()) mass += m;
      const auto fixed = std::count_if(d->fixed().begin(), d->fixed().end(), [](char h) { return h != 0; });
      const auto* soft = dynamic_cast<const SoftBody*>(d);
      const auto* shell = dynamic_cast<const ShellBody*>(d);
      text = fmt::format("{}, {} nodes ({} fixed), {}, {:.3g} g{}", box_text(box), d->nodes(), fixed,
                         soft    ? fmt::format("{} tetrahedra", soft->rest().tets.size())
                         : shell ? fmt::format("{} triangles", shell->wall_triangles().size())
                                 : "",
                         1000 * mass, unit_of(b, "mesh"));
    } else {
      Eigen::AlignedBox3d box;
      for (const Surface* s : b.children_of<Surface>()) box.extend(box_of(s->positions()));
      text = box_text(box) + ", never moves";
    }
    add("body", b, std::move(text), lines_of(b));
  }
  void surface(const Surface& s) {
    add("surface", s,
        fmt::format("{}, {} triangles{}{}", box_text(box_of(s.positions())), s.triangles().size(),
                    s.contact() ? "" : ", for the picture alone", unit_of(s, "mesh")),
        edges_of(s.triangles(), [&](int i) { return s.positions()[std::size_t(i)]; }));
  }
  void regions(const ShellBody& shell) {
    for (std::size_t r = 0; r < shell.model().regions.size(); ++r) {
      std::vector<std::array<int, 3>> triangles;
      Eigen::AlignedBox3d box;
      double area = 0;
      for (const auto& t : shell.wall_triangles()) {
        if (shell.region_of_triangle(t) != int(r)) continue;
        triangles.push_back(t);
        const Vec3 a = node(shell, t[0]), b = node(shell, t[1]), c = node(shell, t[2]);
        area += 0.5 * (b - a).cross(c - a).norm();
        box.extend(a).extend(b).extend(c);
      }
      InventoryItem& item =
          add("region", shell, fmt::format("{}, {} triangles, {:.3g} mm2", box_text(box), triangles.size(), 1e6 * area),
              edges_of(triangles, [&](int i) { return node(shell, i); }));
      item.name = shell.id + ": " + shell.model().regions[r];
      item.values.clear();
    }
  }
  void support(Support& s) {
    const auto* body = dynamic_cast<const DeformableBody*>(s.parent);
    if (!body) return;
    std::vector<char> fixed(std::size_t(body->nodes()), 0);
    Diagnostics unused;
    PrepareContext context{unused, simulation_.h()};
    s.hold(context, body->rest_nodes(), fixed);
    std::vector<Vec3> points;
    for (int i = 0; i < body->nodes(); ++i)
      if (fixed[std::size_t(i)]) points.push_back(node(*body, i));
    InventoryItem& item = add("anchor", s,
                              fmt::format("holds {} of {} nodes of {}, within {}", points.size(), body->nodes(),
                                          body->id, box_text(box_of(points))),
                              {});
    item.points = thinned(points, 1, max_points);
  }
  void drawable(const Component& c, const DrawableBase& d) {
    const std::vector<float>& data = d.data();
    const auto point = [&](std::size_t i) { return Vec3(data[i], data[i + 1], data[i + 2]); };
    std::vector<Vec3> lines, points;
    double least = infinite, most = 0, sum = 0;
    const std::size_t per_line = 4 * std::size_t(d.spec().points_per_line);
    if (d.kind() == DrawableKind::polylines)
      for (std::size_t at = 0; at + per_line <= data.size(); at += per_line) {
        double length = 0;
        for (std::size_t i = at; i + 4 < at + per_line; i += 4) {
          lines.push_back(point(i));
          lines.push_back(point(i + 4));
          length += (point(i + 4) - point(i)).norm();
        }
        least = std::min(least, length);
        most = std::max(most, length);
        sum += length;
      }
    if (d.kind() == DrawableKind::points)
      for (std::size_t i = 0; i + 4 <= data.size(); i += 4) points.push_back(point(i));
    std::string text = fmt::format("{} {}, {}", d.count(), drawable_kind_name(d.kind()), d.spec().doc);
    if (!lines.empty())
      text += fmt::format("; {} to {} mm long, {} mm on average", mm(least), mm(most), mm(sum / d.count()));
    InventoryItem& item = add("drawable", c, std::move(text), thinned(lines, 2, max_lines));
    item.name = c.id + "." + std::string(d.spec().name);
    item.points = thinned(points, 1, max_points);
    item.values.clear();
  }
  static const RefList<Body>* list_between(const Constraint& c) {
    return dynamic_cast<const RefList<Body>*>(c.find_param("between"));
  }
  static std::string joins(const Constraint& c) {
    std::string out;
    for (const ParamBase* p : c.params())
      if (const auto* refs = dynamic_cast<const RefParamBase*>(p))
        for (const std::string& id : refs->ids()) out += (out.empty() ? "joins " : ", ") + id;
    return out;
  }
  // If several contacts name a pair, the one with the fewest names applies, and among equals the last one.
  void pairs() {
    std::vector<const Constraint*> lists;
    for (const Constraint* c : simulation_.constraints())
      if (list_between(*c)) lists.push_back(c);
    std::stable_sort(lists.begin(), lists.end(), [](const Constraint* a, const Constraint* b) {
      const auto na = (*list_between(*a))().size(), nb = (*list_between(*b))().size();
      return na != nb ? na < nb : a->order > b->order;
    });
    std::vector<std::pair<const Body*, const Body*>> known;
    for (const Constraint* c : lists) {
      const auto& all = (*list_between(*c))();
      for (std::size_t i = 0; i < all.size(); ++i)
        for (std::size_t j = i + 1; j < all.size(); ++j) {
          if (all[i]->blocks() == 0 && all[j]->blocks() == 0) continue;
          const std::pair<const Body*, const Body*> pair = std::minmax<const Body*>(
              all[i], all[j], [](const Body* a, const Body* b) { return a->order < b->order; });
          if (std::find(known.begin(), known.end(), pair) != known.end()) continue;
          known.push_back(pair);
          std::vector<Vec3> lines = lines_of(*all[i]);
          const std::vector<Vec3> others = lines_of(*all[j]);
          lines.insert(lines.end(), others.begin(), others.end());
          const ParamBase* friction = c->find_param("friction");
          InventoryItem& item =
              add("contact pair", *c, (friction ? "friction " + friction->text() + ", " : "") + "by " + c->id,
                  thinned(lines, 2, max_lines));
          item.name = all[i]->id + " - " + all[j]->id;
        }
    }
  }
  void tool(const RigidBody& body) {
    Eigen::AlignedBox3d box;
    for (const ToolPart& part : body.tool().parts) box.extend(box_of(part.mesh.vertices));
    const auto* instrument = dynamic_cast<const Instrument*>(&body);
    const std::string where = instrument
                                  ? (instrument->hand_index() < 0 ? "held by an arm" : instrument->hand() + " hand") +
                                        (body.active() ? "" : ", on the tray")
                              : body.active() ? "in the field"
                                              : "on the tray";
    add("tool", body, fmt::format("{}, {:.3g} g, {}; URDF in m", box_text(box), 1000 * body.tool().mass, where),
        body.active() ? lines_of(body) : std::vector<Vec3>());
  }

  const Simulation& simulation_;
  std::vector<InventoryItem> items_;
};

}  // namespace

std::vector<InventoryItem> inventory(const Simulation& simulation) { return Taker(simulation).all(); }

}  // namespace insula
