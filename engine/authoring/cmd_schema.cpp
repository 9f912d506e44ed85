// SPDX-License-Identifier: GPL-3.0-or-later
// insula schema: XML Schema 1.0 from the declarations, for checking and completion in editors.
#include <fmt/format.h>

#include <ostream>
#include <set>
#include <sstream>

#include "engine/authoring/describe.h"
#include "engine/authoring/schema_types.h"
#include "engine/command_line/commands.h"

namespace insula {
namespace {

class Schema {
 public:
  explicit Schema(const Registry& registry) : registry_(registry) {}

  std::string text() {
    std::string types, groups;
    for (const auto* info : registry_.all()) types += element_type(*info);
    std::set<Kind> parents{Kind::scene};
    for (const auto* info : registry_.all()) parents.insert(info->parents.begin(), info->parents.end());
    for (const Kind kind : parents) groups += group(kind);
    std::ostringstream out;
    out << schema_head << schema_annotation("Scene files of Insula. " + std::string(schema_promise), "  ")
        << "  <xs:element name=\"scene\" type=\"scene\"/>\n"
        << part() << schema_preprocessing() << groups << types << types_.text() << "</xs:schema>\n";
    return out.str();
  }

 private:
  std::string element_type(const ComponentInfo& info) {
    std::string out =
        fmt::format("  <xs:complexType name=\"{}\">\n{}", info.element, schema_annotation(info.doc, "    "));
    if (info.kind == Kind::scene || !children_of_kind(registry_, info.kind).empty())
      out += fmt::format("    <xs:group ref=\"{}\" minOccurs=\"0\" maxOccurs=\"unbounded\"/>\n",
                         schema_type_id("in_", kind_name(info.kind)));
    out += "    <xs:attribute name=\"id\" type=\"with_id\"/>\n";
    const auto component = registry_.create(info.element);
    for (const ParamBase* p : component->params()) out += types_.attribute(*p);
    return out + "  </xs:complexType>\n";
  }

  std::string group(Kind kind) {
    std::string out = fmt::format("  <xs:group name=\"{}\"><xs:choice>\n", schema_type_id("in_", kind_name(kind)));
    for (const auto* info : children_of_kind(registry_, kind))
      out += fmt::format("    <xs:element name=\"{0}\" type=\"{0}\"/>\n", info->element);
    out += "    <xs:element ref=\"include\"/>\n";
    if (kind == Kind::scene) out += "    <xs:element ref=\"variable\"/>\n";
    return out + "  </xs:choice></xs:group>\n";
  }

  std::string part() {
    std::string out = "  <xs:element name=\"part\">\n" + schema_annotation("a piece that scenes include", "    ") +
                      "    <xs:complexType>\n      <xs:choice minOccurs=\"0\" maxOccurs=\"unbounded\">\n";
    for (const auto* info : registry_.all())
      if (info->kind != Kind::scene)
        out += fmt::format("        <xs:element name=\"{0}\" type=\"{0}\"/>\n", info->element);
    return out +
           "        <xs:element ref=\"include\"/>\n        <xs:element ref=\"variable\"/>\n      </xs:choice>\n"
           "      <xs:attribute name=\"title\" type=\"xs:string\"/>\n    </xs:complexType>\n  </xs:element>\n";
  }

  const Registry& registry_;
  SchemaTypes types_;
};

}  // namespace

int cmd_schema(const CommandContext& context, const std::filesystem::path& file) {
  return write_schema(context, Schema(context.registry).text(), file);
}

}  // namespace insula
