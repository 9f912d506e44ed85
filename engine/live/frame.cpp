// SPDX-License-Identifier: GPL-3.0-or-later
// Simulation -> render_frame_t.
#include "engine/live/frame.h"

#include <algorithm>

#include "core/mechanics/deformable_body.h"
#include "engine/live/contact_sides.h"
#include "engine/live/hud.h"
#include "engine/live/shown_contacts.h"

namespace insula {
namespace {

void put(float* to, const Vec3& v) {
  for (int k = 0; k < 3; ++k) to[k] = float(v[k]);
}
void put(double* to, const Vec3& v) {
  for (int k = 0; k < 3; ++k) to[k] = v[k];
}
template <class Row>
void put(std::vector<Row>& to, std::size_t i, const Vec3& v) {
  to[i].resize(3);
  put(to[i].data(), v);
}

constexpr std::int8_t on_tray = 0, held = 1, free_in_field = 2;

void fill_tool(const RigidBody& body, insula_lcm::render_tool_t& to) {
  const Pose pose = body.link_pose(0);
  put(to.p_m, pose.p);
  to.q[0] = pose.q.w();
  to.q[1] = pose.q.x();
  to.q[2] = pose.q.y();
  to.q[3] = pose.q.z();
  put(to.device_p_m, pose.p);
  to.hand = -1;
  to.state = body.active() ? held : on_tray;
  if (const auto* tool = dynamic_cast<const Instrument*>(&body)) {
    to.hand = std::int8_t(tool->hand_index());
    put(to.device_p_m, tool->device().p);
    put(to.force_N, tool->hand_force().head<3>());
    to.button1 = tool->state().button1;
    to.button2 = tool->state().button2;
    to.activity = float(tool->activity());
    return;
  }
  to.opening_rad = float(body.opening());
  if (body.active() && !body.held_by()) to.state = free_in_field;
  if (const auto* holder = dynamic_cast<const Instrument*>(body.held_by())) to.hand = std::int8_t(holder->hand_index());
}

void fill_step_data(const Simulation& simulation, insula_lcm::render_frame_t& f) {
  const std::vector<double>& values = simulation.report().channels;
  f.channels = std::int32_t(values.size());
  f.channel.resize(values.size());
  for (std::size_t i = 0; i < values.size(); ++i) f.channel[i] = float(values[i]);
  const auto& drawables = simulation.drawables();
  f.drawables = std::int32_t(drawables.size());
  f.drawable.resize(drawables.size());
  for (std::size_t i = 0; i < drawables.size(); ++i) {
    const std::vector<float>& data = drawables[i].drawable->data();
    f.drawable[i].index = std::int32_t(i);
    f.drawable[i].floats = std::int32_t(data.size());
    f.drawable[i].data.assign(data.begin(), data.end());
  }
}

void fill_contacts(const Simulation& simulation, insula_lcm::render_frame_t& f) {
  const std::vector<ContactPoint>& all = simulation.report().contacts;
  const std::vector<std::size_t> shown = shown_contacts(all);
  f.contacts = std::int32_t(shown.size());
  f.contact_x_m.resize(shown.size());
  f.contact_N.resize(shown.size());
  f.contact_side.resize(shown.size());
  const ContactSides sides(simulation);
  for (std::size_t i = 0; i < shown.size(); ++i) {
    const ContactPoint& c = all[shown[i]];
    put(f.contact_x_m, i, c.position);
    f.contact_N[i] = float(c.normal_force);
    f.contact_side[i] = {sides.number(*c.a, c.part_a), sides.number(*c.b, c.part_b)};
  }
}

}  // namespace

std::vector<const DeformableBody*> picture_bodies(const Simulation& simulation) {
  std::vector<const DeformableBody*> out;
  for (const Body* b : simulation.bodies())
    if (auto* body = dynamic_cast<const DeformableBody*>(b)) out.push_back(body);
  return out;
}

std::vector<const RigidBody*> picture_tools(const Simulation& simulation) {
  std::vector<const RigidBody*> out(simulation.instruments().begin(), simulation.instruments().end());
  for (const Body* b : simulation.bodies())
    if (auto* body = dynamic_cast<const RigidBody*>(b); body && !dynamic_cast<const Instrument*>(b))
      out.push_back(body);
  return out;
}

void fill_frame(const Simulation& simulation, insula_lcm::render_frame_t& f, const SessionNote& note,
                CauseLines* causes) {
  const StepReport& r = simulation.report();
  const auto bodies = picture_bodies(simulation);
  f.sim_time_s = r.time;
  f.bodies = std::int32_t(bodies.size());
  f.body.resize(bodies.size());
  f.body_force_N.assign(bodies.size(), 0.0);
  for (std::size_t b = 0; b < bodies.size(); ++b) {
    auto& to = f.body[b];
    to.index = std::int32_t(b);
    to.nodes = bodies[b]->nodes();
    to.x_m.resize(std::size_t(to.nodes));
    for (int i = 0; i < to.nodes; ++i) put(to.x_m, std::size_t(i), bodies[b]->q().segment<3>(3 * i));
    for (const StructureForce& s : r.structures)
      if (s.body == bodies[b]) f.body_force_N[b] = s.largest();
  }
  fill_step_data(simulation, f);
  const auto tools = picture_tools(simulation);
  f.tools = std::int8_t(tools.size());
  f.tool.resize(tools.size());
  for (std::size_t i = 0; i < tools.size(); ++i) {
    f.tool[i] = insula_lcm::render_tool_t{};
    f.tool[i].index = std::int32_t(i);
    fill_tool(*tools[i], f.tool[i]);
  }
  fill_contacts(simulation, f);
  f.step_ms = r.step_ms;
  f.step_period_ms = simulation.h() * 1000;
  f.rows = r.rows;
  f.sweeps = r.solve.sweeps;
  f.hud_json = hud_json(simulation, note, causes);
}

}  // namespace insula
