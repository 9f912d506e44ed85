// SPDX-License-Identifier: GPL-3.0-or-later
// insula describe NAME
#include <fmt/format.h>

#include <algorithm>
#include <ostream>

#include "core/base/text.h"
#include "engine/authoring/describe.h"
#include "engine/command_line/commands.h"

namespace insula {

namespace {

struct Line {
  std::string name, what, doc;
};

void table(std::ostream& out, const char* heading, const std::vector<Line>& lines) {
  if (lines.empty()) return;
  std::size_t name = 0, what = 0;
  for (const Line& l : lines) {
    name = std::max(name, l.name.size());
    what = std::max(what, l.what.size());
  }
  out << '\n' << heading << '\n';
  for (const Line& l : lines) out << fmt::format("  {:<{}}  {:<{}}  {}\n", l.name, name, l.what, what, l.doc);
}

void describe_step_data(std::ostream& out, const Component& component) {
  std::vector<Line> lines;
  for (const ChannelBase* c : component.channels())
    lines.push_back({channel_name(*c), channel_text(*c), std::string(c->spec().doc)});
  table(out, "channels", lines);
  lines.clear();
  for (const DrawableBase* d : component.drawables())
    lines.push_back({std::string(d->spec().name), drawable_text(*d), std::string(d->spec().doc)});
  table(out, "drawables", lines);
  lines.clear();
  for (const EventKind* e : component.event_kinds())
    lines.push_back({e->name(), std::string(e->spec().value), std::string(e->spec().doc)});
  table(out, "events", lines);
  lines.clear();
  for (const MetricBase* m : metrics_of(component)) lines.push_back({metric_name(*m), metric_text(*m), m->spec().doc});
  table(out, "metrics", lines);
}

}  // namespace

int cmd_describe(const CommandContext& context, const std::string& element) {
  const auto* info = context.registry.find(element);
  if (!info) {
    std::vector<std::string> names;
    for (const auto* other : context.registry.all()) names.push_back(other->element);
    const std::string near = nearest_name(element, names);
    context.err << "error: there is no element <" << shown(element) << ">"
                << (near.empty() ? "; `insula list` shows all" : did_you_mean_element(near)) << '\n';
    return 2;
  }
  auto& out = context.out;
  out << fmt::format("<{}>  {}\n\n", info->element, info->doc);
  out << fmt::format("kind     {}\nstands   {}\nfrom     {}\n", kind_name(info->kind),
                     place_text(context.registry, *info), info->plugin == "core" ? "core" : "plugin " + info->plugin);
  const auto children = children_of_kind(context.registry, info->kind);
  if (!children.empty()) {
    std::vector<std::string> names;
    for (const auto* child : children) names.push_back(child->element);
    out << "holds    " << joined(names) << '\n';
  }
  const auto component = context.registry.create(element);
  std::size_t name_width = 2, type_width = 0, default_width = 0;
  for (const ParamBase* p : component->params()) {
    name_width = std::max(name_width, p->name().size());
    type_width = std::max(type_width, p->type_name().size());
    default_width = std::max(default_width, default_text(*p).size());
  }
  out << "\nparameters\n";
  out << fmt::format("  {:<{}}  {:<{}}  {:<{}}  name by which others refer to it\n", "id", name_width, "text",
                     type_width, "(none)", default_width);
  for (const ParamBase* p : component->params()) {
    std::string doc(p->spec().doc);
    if (const auto allowed = allowed_text(*p); !allowed.empty()) doc += " [" + allowed + "]";
    out << fmt::format("  {:<{}}  {:<{}}  {:<{}}  {}\n", p->name(), name_width, p->type_name(), type_width,
                       default_text(*p), default_width, doc);
  }
  describe_step_data(out, *component);
  return 0;
}

}  // namespace insula
