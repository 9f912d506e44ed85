// SPDX-License-Identifier: GPL-3.0-or-later
// What pictures are made of: surfaces, parts of tools, drawables, the view, materials.
#include "python/src/bind.h"

namespace insula::python {
namespace {

struct SurfaceOf {
  nb::object owner;
  const Surface* surface;
};

struct PartOf {
  nb::object owner;
  const ToolPart* part;
};

struct DrawableOf {
  nb::object owner;
  const Simulation::DrawableEntry* entry;
};

Array<double> positions(const SurfaceOf& s) {
  const Surface& surface = *s.surface;
  std::vector<Vec3> out;
  out.reserve(surface.points().size());
  for (const MaterialPoint& p : surface.points()) out.push_back(surface.body().position(p));
  return rows_of(out);
}

Array<float> data_of(const DrawableOf& d) {
  const DrawableBase& drawable = *d.entry->drawable;
  const std::size_t width = std::size_t(drawable.floats_per_element());
  Array<float> out = array<float>({drawable.data().size() / width, width});
  std::copy_n(drawable.data().data(), drawable.data().size() / width * width, out.data());
  return out;
}

std::string id_of(const DrawableOf& d) {
  return d.entry->component->id + "." + std::string(d.entry->drawable->spec().name);
}

void bind_parts(nb::module_& m) {
  nb::class_<SurfaceOf>(m, "Surface", "A triangle mesh that follows its body.")
      .def_prop_ro(
          "id", [](const SurfaceOf& s) { return s.surface->id; }, "Id in the scene.")
      .def_prop_ro(
          "body", [](const SurfaceOf& s) { return s.surface->body().id; }, "Id of its body.")
      .def_prop_ro(
          "material", [](const SurfaceOf& s) { return std::string(s.surface->material()); }, "Name of its material.")
      .def_prop_ro(
          "triangles", [](const SurfaceOf& s) { return rows_of(s.surface->triangles(), s.owner); }, as_array,
          "View of its triangles, counter-clockwise from outside.")
      .def_prop_ro(
          "rest", [](const SurfaceOf& s) { return rows_of(s.surface->rest().vertices); }, as_array,
          "Vertices at rest, m.")
      .def_prop_ro("positions", &positions, as_array, "Vertices now, m.")
      .def("__repr__", [](const SurfaceOf& s) { return "<Surface " + s.surface->id + ">"; });
  nb::class_<PartOf>(m, "Part", "A mesh of a tool, in the frame of one of its links.")
      .def_prop_ro(
          "name", [](const PartOf& p) { return p.part->name; }, "Its name.")
      .def_prop_ro(
          "material", [](const PartOf& p) { return p.part->material; }, "Name of its material.")
      .def_prop_ro(
          "rgba", [](const PartOf& p) { return p.part->rgba; }, "Its colour, 0 to 1.")
      .def_prop_ro(
          "link", [](const PartOf& p) { return p.part->link; }, "Index among Body.links.")
      .def_prop_ro(
          "vertices", [](const PartOf& p) { return rows_of(p.part->mesh.vertices); }, as_array, "Vertices, m.")
      .def_prop_ro(
          "triangles", [](const PartOf& p) { return rows_of(p.part->mesh.triangles, p.owner); }, as_array,
          "View of its triangles.")
      .def("__repr__", [](const PartOf& p) { return "<Part " + p.part->name + ">"; });
  nb::class_<DrawableOf>(m, "Drawable", "Points, lines, a patch, a plane, a label or links of a component.")
      .def_prop_ro("id", &id_of, "\"component.drawable\".")
      .def_prop_ro(
          "kind", [](const DrawableOf& d) { return std::string(drawable_kind_name(d.entry->drawable->kind())); },
          "\"points\", \"polylines\", \"patch\", \"plane\", \"label\" or \"links\".")
      .def_prop_ro(
          "doc", [](const DrawableOf& d) { return std::string(d.entry->drawable->spec().doc); },
          "Its meaning in one line.")
      .def_prop_ro(
          "material", [](const DrawableOf& d) { return d.entry->drawable->material(); }, "Name of its material.")
      .def_prop_ro(
          "radius", [](const DrawableOf& d) { return d.entry->drawable->radius(); }, "Of points and lines, m.")
      .def_prop_ro("data", &data_of, as_array,
                   "One row of numbers for each element, in the layout of lcm_types/render_frame.lcm.")
      .def("__repr__", [](const DrawableOf& d) { return "<Drawable " + id_of(d) + ">"; });
}

}  // namespace

void bind_geometry(nb::module_& m, RunClass& run) {
  bind_parts(m);
  run.def_prop_ro(
         "surfaces",
         [](nb::handle self) {
           std::vector<SurfaceOf> out;
           for (const Surface* s : nb::cast<Run&>(self).simulation().surfaces()) out.push_back({nb::borrow(self), s});
           return out;
         },
         "All surfaces, in the order of the document.")
      .def(
          "tool_parts",
          [](nb::handle self, const std::string& id) {
            const auto* tool = nb::cast<Run&>(self).simulation().scene().find_as<RigidBody>(id);
            if (!tool) throw std::invalid_argument("nothing rigid in the scene is called \"" + id + "\"");
            std::vector<PartOf> out;
            for (const ToolPart& p : tool->tool().parts) out.push_back({nb::borrow(self), &p});
            return out;
          },
          "id"_a, "Meshes of a tool or a clip.")
      .def_prop_ro(
          "drawables",
          [](nb::handle self) {
            std::vector<DrawableOf> out;
            for (const auto& d : nb::cast<Run&>(self).simulation().drawables()) out.push_back({nb::borrow(self), &d});
            return out;
          },
          "What components draw, in the order of the document.")
      .def_prop_ro(
          "view",
          [](const Run& r) -> std::optional<std::array<std::array<double, 3>, 3>> {
            const ViewSettings* v = r.simulation().view();
            if (!v) return std::nullopt;
            const auto list = [](const Vec3& x) { return std::array<double, 3>{x.x(), x.y(), x.z()}; };
            return std::array{list(v->eye()), list(v->target()), list(v->up())};
          },
          "Eye and target (m) and up of the scene's view; None if it has none.");
}

}  // namespace insula::python
