// SPDX-License-Identifier: GPL-3.0-or-later
// Channels, drawables and materials as JSON.
#include "engine/live/bundle_step_data.h"

namespace insula {
namespace {

using Json = nlohmann::ordered_json;

Json or_null(const std::optional<double>& v) { return v ? Json(*v) : Json(); }

bool given(const ChannelBase::Bounds& b) { return b[0] || b[1]; }

Json bounds_json(const ChannelBase::Bounds& b) {
  Json out = Json::array();  // avoids a copy of its only element
  out.push_back(or_null(b[0]));
  out.push_back(or_null(b[1]));
  return out;
}

Json channel_json(const ChannelEntry& e) {
  const ChannelBase& c = *e.channel;
  Json out = {{"id", e.id},
              {"component", e.component->id},
              {"name", c.name(e.item)},
              {"unit", c.quantity().si},
              {"doc", c.spec().doc},
              {"size", c.size()},
              {"offset", e.offset},
              {"min", or_null(c.min())},
              {"max", or_null(c.max())},
              {"display", {{"unit", c.display_unit()}, {"scale", c.display_scale()}, {"digits", c.spec().digits}}},
              {"shown", shown_name(c.spec().shown)},
              {"group", e.group()},
              {"quantity", c.quantity().name}};
  if (given(c.good()) || given(c.high())) {
    out["bands"]["good"] = bounds_json(c.good());
    out["bands"]["high"] = bounds_json(c.high());
  }
  return out;
}

}  // namespace

Json channels_json(const ChannelTable& channels) {
  Json out = Json::array();
  for (const ChannelEntry& e : channels.entries()) out.push_back(channel_json(e));
  return out;
}

Json drawables_json(const BundleWriter& writer, const Simulation& simulation) {
  Json out = Json::array();
  for (std::size_t i = 0; i < simulation.drawables().size(); ++i) {
    const auto& [component, d] = simulation.drawables()[i];
    const DrawableSpec& spec = d->spec();
    Json entry = {{"index", i},
                  {"id", component->id + "." + std::string(spec.name)},
                  {"component", component->id},
                  {"name", spec.name},
                  {"kind", drawable_kind_name(d->kind())},
                  {"material", d->material()},
                  {"doc", spec.doc},
                  {"points_per_line", spec.points_per_line},
                  {"count", d->count()},
                  {"radius_m", d->radius()},
                  {"value", {{"doc", spec.value}, {"unit", spec.unit}}},
                  {"text", spec.text}};
    if (!spec.rate_channel.empty()) entry["rate_channel"] = component->id + "." + std::string(spec.rate_channel);
    const std::string name = "d" + std::to_string(i);
    if (const auto* patch = dynamic_cast<const Patch*>(d)) {
      std::vector<Vec3> vertices;
      for (std::size_t v = 0; v + 3 < patch->data().size(); v += 4)
        vertices.emplace_back(patch->data()[v], patch->data()[v + 1], patch->data()[v + 2]);
      writer.mesh(entry, name, vertices, patch->triangles());
    }
    if (const auto* links = dynamic_cast<const Links*>(d)) {
      entry["parts"] = Json::array();
      for (std::size_t k = 0; k < links->parts().size(); ++k) {
        Json part = Json::object();
        writer.mesh(part, name + "_" + std::to_string(k), links->parts()[k].vertices, links->parts()[k].triangles);
        entry["parts"].push_back(part);
      }
    }
    out.push_back(entry);
  }
  return out;
}

Json materials_json(const std::vector<Material>& materials) {
  Json out = Json::object();
  for (const Material& m : materials)
    out[m.name] = {{"style", m.style},
                   {"rgba", m.rgba},
                   {"roughness", m.roughness},
                   {"metalness", m.metalness},
                   {"translucency", m.translucency}};
  return out;
}

}  // namespace insula
