// SPDX-License-Identifier: GPL-3.0-or-later
// insula schema --curriculum: XML Schema 1.0 of curriculum files, from the declarations of their elements.
#include <fmt/format.h>

#include "engine/authoring/schema_types.h"
#include "engine/command_line/commands.h"
#include "training/curriculum/elements.h"

namespace insula {
namespace {

std::string curriculum_type(const CurriculumElementInfo& info, SchemaTypes& types) {
  std::string out = fmt::format("  <xs:complexType name=\"{}\">\n{}", info.name, schema_annotation(info.doc, "    "));
  if (!children_of_curriculum_element(info.name).empty())
    out += fmt::format("    <xs:group ref=\"in_{}\" minOccurs=\"0\" maxOccurs=\"unbounded\"/>\n", info.name);
  out += fmt::format("    <xs:attribute name=\"id\" type=\"with_id\"{}/>\n", info.needs_id ? " use=\"required\"" : "");
  const auto element = info.create();
  for (const ParamBase* p : element->params()) out += types.attribute(*p);
  return out + "  </xs:complexType>\n";
}

std::string curriculum_group(const CurriculumElementInfo& info) {
  const auto children = children_of_curriculum_element(info.name);
  if (children.empty()) return {};
  std::string out = fmt::format("  <xs:group name=\"in_{}\"><xs:choice>\n", info.name);
  for (const std::string& child : children) out += fmt::format("    <xs:element name=\"{0}\" type=\"{0}\"/>\n", child);
  out += "    <xs:element ref=\"include\"/>\n";
  if (info.parents.empty()) out += "    <xs:element ref=\"variable\"/>\n";
  return out + "  </xs:choice></xs:group>\n";
}

std::string curriculum_part() {
  std::string out = "  <xs:element name=\"part\">\n" + schema_annotation("a piece that curricula include", "    ") +
                    "    <xs:complexType>\n      <xs:choice minOccurs=\"0\" maxOccurs=\"unbounded\">\n";
  for (const auto& info : curriculum_elements())
    if (!info.parents.empty()) out += fmt::format("        <xs:element name=\"{0}\" type=\"{0}\"/>\n", info.name);
  return out +
         "        <xs:element ref=\"include\"/>\n        <xs:element ref=\"variable\"/>\n      </xs:choice>\n"
         "      <xs:attribute name=\"title\" type=\"xs:string\"/>\n    </xs:complexType>\n  </xs:element>\n";
}

}  // namespace

int cmd_curriculum_schema(const CommandContext& context, const std::filesystem::path& file) {
  SchemaTypes types;
  std::string elements, groups;
  for (const auto& info : curriculum_elements()) {
    elements += curriculum_type(info, types);
    groups += curriculum_group(info);
  }
  std::string text(schema_head);
  text += schema_annotation("Curriculum files of Insula. " + std::string(schema_promise), "  ");
  text += "  <xs:element name=\"curriculum\" type=\"curriculum\"/>\n" + curriculum_part() + schema_preprocessing();
  return write_schema(context, text + groups + elements + types.text() + "</xs:schema>\n", file);
}

}  // namespace insula
