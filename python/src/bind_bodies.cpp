// SPDX-License-Identifier: GPL-3.0-or-later
// Bodies: shape, motion, forces and stress.
#include "core/mechanics/shell_body.h"
#include "core/mechanics/soft_body.h"
#include "python/src/bind.h"

namespace insula::python {
namespace {

/// A body of a simulation that it keeps alive.
struct BodyOf {
  nb::object owner;
  Body* body = nullptr;

  Run& run() const { return nb::cast<Run&>(owner); }
  /// Throws std::invalid_argument for a body without nodes.
  const DeformableBody& nodes() const {
    if (const auto* b = dynamic_cast<const DeformableBody*>(body)) return *b;
    throw std::invalid_argument("\"" + body->id + "\" has no nodes: it does not deform");
  }
};

Array<const double> node_values(const BodyOf& b, const double* data) {
  return view(data, {std::size_t(b.nodes().nodes()), 3}, b.owner);
}

/// Tetrahedra of a solid, wall triangles of a shell.
nb::object elements(const BodyOf& b) {
  if (const auto* solid = dynamic_cast<const SoftBody*>(b.body)) return nb::cast(rows_of(solid->rest().tets, b.owner));
  if (const auto* shell = dynamic_cast<const ShellBody*>(b.body))
    return nb::cast(rows_of(shell->wall_triangles(), b.owner));
  return nb::cast(rows_of(std::vector<std::array<int, 3>>(), nb::handle()));
}

std::size_t element_count(const Body& body) {
  if (const auto* solid = dynamic_cast<const SoftBody*>(&body)) return solid->rest().tets.size();
  if (const auto* shell = dynamic_cast<const ShellBody*>(&body)) return shell->wall_triangles().size();
  return 0;
}

Array<double> stress(const BodyOf& b) {
  const Run::Turn turn(b.run());
  const DeformableBody& body = b.nodes();
  std::vector<Mat3> sum(element_count(body), Mat3::Zero());
  for (const ForceModel* model : body.forces()) model->add_stress(body.q().data(), sum);
  Array<double> out = array<double>({sum.size(), 3, 3});
  for (std::size_t t = 0; t < sum.size(); ++t)  // symmetric, so the order of rows and columns does not matter
    std::copy_n(sum[t].data(), 9, out.data() + 9 * t);
  return out;
}

/// H^T lambda of the last step: of a deformable body for each node, of a rigid one force and torque.
Array<double> constraint_forces(const BodyOf& b) {
  const Run::Turn turn(b.run());
  const ConstraintProblem& problem = b.run().simulation().problem();
  // A deformable body's rows name its nodes.
  const auto* deformable = dynamic_cast<const DeformableBody*>(b.body);
  const std::size_t places = std::size_t(deformable ? deformable->nodes() : b.body->blocks());
  Array<double> out = array<double>({places, 3});
  const BodyRows& rows = b.body->rows;
  for (int r = 0; r < rows.count() && problem.rows > 0; ++r) {
    const double lambda = problem.lambda[std::size_t(rows.row[std::size_t(r)])];
    for (int e = rows.start[std::size_t(r)]; e < rows.start[std::size_t(r) + 1]; ++e)
      for (int k = 0; k < 3; ++k)
        out.data()[3 * rows.block[std::size_t(e)] + k] += lambda * rows.coeff[std::size_t(e)][k];
  }
  return out;
}

/// Forces of the left and of the right hand on a structure.
Array<double> hand_forces(const BodyOf& b) {
  Array<double> out = array<double>({2, 3});
  for (const StructureForce& s : b.run().simulation().report().structures)
    if (s.body == b.body)
      for (std::size_t hand = 0; hand < 2; ++hand) std::copy_n(s.of_hand[hand].data(), 3, out.data() + 3 * hand);
  return out;
}

const RigidBody& rigid(const BodyOf& b) {
  if (const auto* r = dynamic_cast<const RigidBody*>(b.body)) return *r;
  throw std::invalid_argument("\"" + b.body->id + "\" is not rigid");
}

std::vector<PoseTuple> links(const BodyOf& b) {
  std::vector<PoseTuple> out;
  for (int k = 0; k < rigid(b).links(); ++k) out.push_back(tuple_of(rigid(b).link_pose(k)));
  return out;
}

Array<double> masses(const BodyOf& b) { return numbers_of(b.nodes().node_mass()); }

Array<std::uint8_t> fixed(const BodyOf& b) {
  const std::vector<char>& chosen = b.nodes().fixed();
  Array<std::uint8_t> out = array<std::uint8_t>({chosen.size()});
  for (std::size_t i = 0; i < chosen.size(); ++i) out.data()[i] = chosen[i] != 0;
  return out;
}

void bind_body(nb::class_<BodyOf>& body) {
  body.def_prop_ro(
          "id", [](const BodyOf& b) { return b.body->id; }, "Id in the scene.")
      .def_prop_ro(
          "index", [](const BodyOf& b) { return b.body->index; }, "Index among Simulation.bodies.")
      .def_prop_ro(
          "element", [](const BodyOf& b) { return b.body->element; }, "Element of the scene: \"soft_body\".")
      .def_prop_ro(
          "deformable", [](const BodyOf& b) { return dynamic_cast<const DeformableBody*>(b.body) != nullptr; },
          "Whether it has nodes.")
      .def_prop_ro(
          "active",
          [](const BodyOf& b) {
            const auto* moving = dynamic_cast<const DynamicBody*>(b.body);
            return moving == nullptr || moving->active();
          },
          "Whether it takes part in steps; a tool on the tray does not.")
      .def_prop_ro(
          "energy",
          [](const BodyOf& b) {
            const auto* moving = dynamic_cast<const DynamicBody*>(b.body);
            return moving ? moving->energy() : 0.0;
          },
          "Kinetic and elastic energy, J.")
      .def("__repr__", [](const BodyOf& b) { return "<Body " + b.body->id + " (" + b.body->element + ")>"; });
}

}  // namespace

void bind_bodies(nb::module_& m, RunClass& run) {
  nb::class_<BodyOf> body(m, "Body", "A body of a simulation: tissue, a vessel, an obstacle, a tool, a clip.");
  bind_body(body);
  body.def_prop_ro(
          "positions", [](const BodyOf& b) { return node_values(b, b.nodes().q().data()); }, as_array,
          "View of the positions of the nodes, scene frame, m.")
      .def_prop_ro(
          "velocities", [](const BodyOf& b) { return node_values(b, b.nodes().v().data()); }, as_array,
          "View of the velocities of the nodes, m/s.")
      .def_prop_ro(
          "rest", [](const BodyOf& b) { return node_values(b, b.nodes().rest_nodes().front().data()); }, as_array,
          "View of the positions of the nodes at rest, m.")
      .def_prop_ro("elements", &elements, as_array,
                   "View of the tetrahedra of a solid, or of the wall triangles of a shell.")
      .def_prop_ro("masses", &masses, as_array, "Masses of the nodes, kg.")
      .def_prop_ro("fixed", &fixed, as_array, "1 for nodes that a support or a cap holds.")
      .def_prop_ro("stress", &stress, as_array,
                   "Cauchy stress of each element, Pa, scene frame, without damping. That of a wall is the mean over "
                   "its thickness at rest.")
      .def_prop_ro("constraint_forces", &constraint_forces, as_array,
                   "Forces of all rows of the last step (contact, strands, pressure, grips): for each node (N), or "
                   "force (N) and torque (N m) of a rigid body.")
      .def_prop_ro("hand_forces", &hand_forces, as_array,
                   "Forces of the left and of the right hand on this structure, N.")
      .def_prop_ro("links", &links, "Position (m) and orientation (w x y z) of each link of a rigid body.")
      .def_prop_ro(
          "opening", [](const BodyOf& b) { return rigid(b).opening(); }, "Angle of a rigid body's hinges, rad.");
  run.def_prop_ro(
         "bodies",
         [](nb::handle self) {
           std::vector<BodyOf> out;
           for (Body* b : nb::cast<Run&>(self).simulation().bodies()) out.push_back({nb::borrow(self), b});
           return out;
         },
         "All bodies, in the order of the document.")
      .def(
          "body",
          [](nb::handle self, const std::string& id) {
            std::vector<std::string> ids;
            for (Body* b : nb::cast<Run&>(self).simulation().bodies()) {
              if (b->id == id) return BodyOf{nb::borrow(self), b};
              ids.push_back(b->id);
            }
            throw nb::key_error(("no body \"" + id + "\"" + did_you_mean(nearest_name(id, ids))).c_str());
          },
          "id"_a, "The body of that id. Raises KeyError with the nearest name.");
}

}  // namespace insula::python
