// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/live/contact_sides.h"

#include <algorithm>
#include <limits>

#include "engine/live/frame.h"

namespace insula {
namespace {

using Json = nlohmann::ordered_json;

/// Of the drawn part of the link that comes nearest to the working tip, the origin of the tool's frame.
std::string material_of(const ToolModel& model, int link) {
  std::string out;
  double least = std::numeric_limits<double>::infinity();
  for (const ToolPart& part : model.parts) {
    if (part.link != link) continue;
    for (const Vec3& v : part.mesh.vertices) {
      if (v.squaredNorm() >= least) continue;
      least = v.squaredNorm();
      out = part.material;
    }
  }
  return out;
}

const char* role_of(const Body& body) {
  if (const auto* rigid = dynamic_cast<const RigidBody*>(&body)) return rigid->implant() ? "implant" : "instrument";
  return body.blocks() > 0 ? "deformable" : "fixed";
}

Json side(std::size_t number, const Body& owner) {
  return {{"number", number}, {"owner", owner.id}, {"kind", owner.element}, {"role", role_of(owner)}};
}

}  // namespace

ContactSides::ContactSides(const Simulation& simulation)
    : rigid_(picture_tools(simulation)), surfaces_(simulation.surfaces()) {
  for (const RigidBody* body : rigid_) {
    first_.push_back(links_);
    links_ += body->links();
  }
}

std::int16_t ContactSides::number(const Body& owner, const ContactPart& part) const {
  if (part.surface) {
    const auto at = std::find(surfaces_.begin(), surfaces_.end(), part.surface);
    return at == surfaces_.end() ? std::int16_t(-1) : std::int16_t(links_ + (at - surfaces_.begin()));
  }
  const auto at = std::find(rigid_.begin(), rigid_.end(), &owner);
  return at == rigid_.end() ? std::int16_t(-1) : std::int16_t(first_[std::size_t(at - rigid_.begin())] + part.link);
}

nlohmann::ordered_json contact_sides_json(const Simulation& simulation) {
  Json out = Json::array();
  for (const RigidBody* body : picture_tools(simulation))
    for (int link = 0; link < body->links(); ++link) {
      Json entry = side(out.size(), *body);
      entry["link"] = link;
      entry["material"] = material_of(body->tool(), link);
      out.push_back(entry);
    }
  for (const Surface* surface : simulation.surfaces()) {
    Json entry = side(out.size(), surface->body());
    entry["part"] = surface->id;
    entry["material"] = surface->material();
    out.push_back(entry);
  }
  return out;
}

}  // namespace insula
