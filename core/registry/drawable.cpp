// SPDX-License-Identifier: GPL-3.0-or-later
// Checking the declaration of a drawable, and the kinds that are more than a copy.
#include "core/registry/drawable.h"

#include <stdexcept>

#include "core/registry/component.h"

namespace insula {
namespace {

[[noreturn]] void bad_drawable(std::string_view drawable, const std::string& why) {
  throw std::logic_error("drawable \"" + std::string(drawable) + "\" is declared wrongly: " + why);
}

}  // namespace

std::string_view drawable_kind_name(DrawableKind kind) {
  switch (kind) {
    case DrawableKind::points: return "points";
    case DrawableKind::polylines: return "polylines";
    case DrawableKind::patch: return "patch";
    case DrawableKind::plane: return "plane";
    case DrawableKind::label: return "label";
    case DrawableKind::links: return "links";
  }
  return "points";
}

DrawableBase::DrawableBase(Component* owner, DrawableSpec spec, DrawableKind kind)
    : spec_(spec), kind_(kind), material_(spec.material) {
  if (!owner) bad_drawable(spec_.name, "it has no owner");
  if (spec_.name.empty() || spec_.name.find_first_of(". \t") != std::string_view::npos)
    bad_drawable(spec_.name, "it needs a name without dots and blanks");
  if (spec_.doc.empty()) bad_drawable(spec_.name, "it has no doc");
  if (spec_.material.empty()) bad_drawable(spec_.name, "it has no material");
  if (spec_.points_per_line < 2) bad_drawable(spec_.name, "a line has two points or more");
  for (const DrawableBase* other : owner->drawables())
    if (other->spec().name == spec_.name) bad_drawable(spec_.name, "the component has it twice");
  std::string error;
  const auto radius = parse_quantity(spec_.radius, Length::units(), Length::name, error);
  if (!radius || !(*radius > 0))
    bad_drawable(spec_.name, "its radius: " + (radius ? std::string("must be positive") : error));
  radius_ = *radius;
  owner->drawables_.push_back(this);
}

int DrawableBase::floats_per_element() const {
  switch (kind_) {
    case DrawableKind::polylines: return 4 * spec_.points_per_line;
    case DrawableKind::plane:
    case DrawableKind::links: return 8;
    default: return 4;
  }
}

void Patch::set_triangles(std::vector<std::array<int, 3>> triangles, std::size_t vertices) {
  for (const auto& t : triangles)
    for (int v : t)
      if (v < 0 || std::size_t(v) >= vertices)
        throw std::logic_error("drawable \"" + std::string(spec().name) +
                               "\": a triangle names a vertex that is not there");
  triangles_ = std::move(triangles);
  resize_elements(vertices);
}

void Links::set(std::size_t i, const Pose& pose, double value) {
  put(8 * i, pose.p);
  const double q[4] = {pose.q.w(), pose.q.x(), pose.q.y(), pose.q.z()};
  for (std::size_t k = 0; k < 4; ++k) data_[8 * i + 3 + k] = float(q[k]);
  data_[8 * i + 7] = float(value);
}

}  // namespace insula
