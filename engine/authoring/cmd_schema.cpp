// SPDX-License-Identifier: GPL-3.0-or-later
// insula schema: XML Schema 1.0 from the declarations, for checking and completion in editors.
#include <fmt/format.h>

#include <fstream>
#include <map>
#include <ostream>
#include <set>
#include <sstream>

#include "core/base/text.h"
#include "engine/authoring/describe.h"
#include "engine/command_line/commands.h"

namespace insula {
namespace {

constexpr const char* number_pattern = R"([+\-]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+\-]?[0-9]+)?)";

std::string escaped(std::string_view text) {
  std::string out;
  for (char c : text) switch (c) {
      case '<': out += "&lt;"; break;
      case '>': out += "&gt;"; break;
      case '&': out += "&amp;"; break;
      case '"': out += "&quot;"; break;
      default: out += c;
    }
  return out;
}

std::string annotation(std::string_view text, std::string_view indent) {
  return fmt::format("{0}<xs:annotation><xs:documentation>{1}</xs:documentation></xs:annotation>\n", indent,
                     escaped(text));
}

std::string type_id(std::string_view prefix, std::string_view name) {
  std::string out(prefix);
  for (char c : name) out += c == ' ' ? '_' : c;
  return out;
}

/// "(Pa|kPa)", with any number of blanks where a symbol has one.
std::string unit_pattern(std::span<const Unit> units) {
  std::string out;
  for (const auto& u : units) {
    if (!out.empty()) out += '|';
    for (char c : u.symbol) out += c == ' ' ? std::string(R"(\s+)") : std::string(1, c);
  }
  return out.empty() ? out : R"(\s*()" + out + ")";
}

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
    out << "<?xml version=\"1.0\" encoding=\"UTF-8\"?>\n"
           "<xs:schema xmlns:xs=\"http://www.w3.org/2001/XMLSchema\">\n"
        << annotation(
               "Scene files of Insula. A value that uses a variable ($name) is accepted as it stands; `insula check` "
               "checks more.",
               "  ")
        << "  <xs:element name=\"scene\" type=\"scene\"/>\n"
        << part() << preprocessing() << groups << types << simple_types_text() << "</xs:schema>\n";
    return out.str();
  }

 private:
  /// Registers a simple type on first use and returns its name.
  std::string simple_type(const ParamBase& p) {
    if (!p.ref_kind().empty()) return p.is_list() ? "references" : "reference";
    if (dynamic_cast<const Param<bool>*>(&p)) return "true_or_false";
    if (dynamic_cast<const Param<int>*>(&p)) return "whole_number";
    if (dynamic_cast<const Param<LengthUnit>*>(&p)) return "unit_of_length";
    if (const auto* q = dynamic_cast<const QuantityParam*>(&p)) {
      const std::string name = type_id("quantity_", q->type_name());
      simple_types_[name] = number_pattern + unit_pattern(q->units());
      return name;
    }
    if (const auto* v = dynamic_cast<const VectorParam*>(&p)) {
      std::string quantity = v->type_name();  // "three numbers (length)"
      quantity = quantity.substr(quantity.find('(') + 1);
      quantity.pop_back();
      const std::string name = type_id("vector_", quantity);
      const std::string n(number_pattern);
      simple_types_[name] = n + R"(\s+)" + n + R"(\s+)" + n + unit_pattern(v->units());
      return name;
    }
    return "xs:string";
  }

  std::string attribute(const ParamBase& p) {
    std::string doc(p.spec().doc);
    doc += " (" + p.type_name();
    if (const auto allowed = allowed_text(p); !allowed.empty()) doc += "; " + allowed;
    if (const auto units = units_text(p); !units.empty()) doc += "; units " + units;
    doc += p.required() ? "; required)" : "; default " + default_text(p) + ")";
    const std::string use = p.required() ? " use=\"required\"" : "";
    if (p.spec().choices.empty())
      return fmt::format("    <xs:attribute name=\"{}\" type=\"{}\"{}>\n{}    </xs:attribute>\n", p.name(),
                         simple_type(p), use, annotation(doc, "      "));
    std::string choices;
    for (const auto c : p.spec().choices) choices += fmt::format("<xs:enumeration value=\"{}\"/>", escaped(c));
    return fmt::format(
        "    <xs:attribute name=\"{}\"{}>\n{}"
        "      <xs:simpleType><xs:union memberTypes=\"with_variable\"><xs:simpleType><xs:restriction "
        "base=\"xs:token\">{}"
        "</xs:restriction></xs:simpleType></xs:union></xs:simpleType>\n    </xs:attribute>\n",
        p.name(), use, annotation(doc, "      "), choices);
  }

  std::string element_type(const ComponentInfo& info) {
    std::string out = fmt::format("  <xs:complexType name=\"{}\">\n{}", info.element, annotation(info.doc, "    "));
    if (info.kind == Kind::scene || !children_of_kind(registry_, info.kind).empty())
      out += fmt::format("    <xs:group ref=\"{}\" minOccurs=\"0\" maxOccurs=\"unbounded\"/>\n",
                         type_id("in_", kind_name(info.kind)));
    out += "    <xs:attribute name=\"id\" type=\"with_id\"/>\n";
    const auto component = registry_.create(info.element);
    for (const ParamBase* p : component->params()) out += attribute(*p);
    return out + "  </xs:complexType>\n";
  }

  std::string group(Kind kind) {
    std::string out = fmt::format("  <xs:group name=\"{}\"><xs:choice>\n", type_id("in_", kind_name(kind)));
    for (const auto* info : children_of_kind(registry_, kind))
      out += fmt::format("    <xs:element name=\"{0}\" type=\"{0}\"/>\n", info->element);
    out += "    <xs:element ref=\"include\"/>\n";
    if (kind == Kind::scene) out += "    <xs:element ref=\"variable\"/>\n";
    return out + "  </xs:choice></xs:group>\n";
  }

  std::string part() {
    std::string out = "  <xs:element name=\"part\">\n" + annotation("a piece that scenes include", "    ") +
                      "    <xs:complexType>\n      <xs:choice minOccurs=\"0\" maxOccurs=\"unbounded\">\n";
    for (const auto* info : registry_.all())
      if (info->kind != Kind::scene)
        out += fmt::format("        <xs:element name=\"{0}\" type=\"{0}\"/>\n", info->element);
    return out +
           "        <xs:element ref=\"include\"/>\n        <xs:element ref=\"variable\"/>\n      </xs:choice>\n"
           "      <xs:attribute name=\"title\" type=\"xs:string\"/>\n    </xs:complexType>\n  </xs:element>\n";
  }

  static std::string preprocessing() {
    return "  <xs:element name=\"include\">\n" + annotation("puts the children of another file's root here", "    ") +
           "    <xs:complexType>\n"
           "      <xs:sequence><xs:element ref=\"variable\" minOccurs=\"0\" maxOccurs=\"unbounded\"/></xs:sequence>\n"
           "      <xs:attribute name=\"file\" type=\"xs:string\" use=\"required\"/>\n"
           "      <xs:attribute name=\"prefix\" type=\"xs:string\"/>\n    </xs:complexType>\n  </xs:element>\n"
           "  <xs:element name=\"variable\">\n" +
           annotation("a value to be used as $name", "    ") +
           "    <xs:complexType>\n      <xs:attribute name=\"name\" use=\"required\"><xs:simpleType><xs:restriction "
           "base=\"xs:string\">"
           "<xs:pattern value=\"[A-Za-z_][A-Za-z0-9_]*\"/></xs:restriction></xs:simpleType></xs:attribute>\n"
           "      <xs:attribute name=\"value\" type=\"xs:string\" use=\"required\"/>\n    </xs:complexType>\n  "
           "</xs:element>\n";
  }

  std::string simple_types_text() {
    simple_types_["with_id"] = R"([^\s$#]+)";
    simple_types_["reference"] = R"([^\s$#]*)";
    simple_types_["references"] = R"([^$#]*)";
    simple_types_["whole_number"] = R"([+\-]?[0-9]+)";
    std::string out =
        "  <xs:simpleType name=\"with_variable\"><xs:restriction base=\"xs:string\"><xs:pattern value=\".*[$].*\"/>"
        "</xs:restriction></xs:simpleType>\n";
    for (const auto& [name, pattern] : simple_types_)
      out += fmt::format(
          "  <xs:simpleType name=\"{}\"><xs:restriction base=\"xs:string\"><xs:pattern value=\"\\s*{}\\s*\"/>"
          "<xs:pattern value=\".*[$].*\"/></xs:restriction></xs:simpleType>\n",
          name, escaped(pattern));
    out += enumeration("true_or_false", {"true", "false"});
    std::vector<std::string> lengths;
    for (const auto& u : Length::units()) lengths.emplace_back(u.symbol);
    return out + enumeration("unit_of_length", lengths);
  }

  static std::string enumeration(std::string_view name, const std::vector<std::string>& values) {
    std::string out = fmt::format(
        "  <xs:simpleType name=\"{}\"><xs:union memberTypes=\"with_variable\"><xs:simpleType><xs:restriction "
        "base=\"xs:token\">",
        name);
    for (const auto& v : values) out += fmt::format("<xs:enumeration value=\"{}\"/>", escaped(v));
    return out + "</xs:restriction></xs:simpleType></xs:union></xs:simpleType>\n";
  }

  const Registry& registry_;
  std::map<std::string, std::string> simple_types_;
};

}  // namespace

int cmd_schema(const CommandContext& context, const std::filesystem::path& file) {
  const std::string text = Schema(context.registry).text();
  if (file.empty() || file == "-") {
    context.out << text;
    return 0;
  }
  std::ofstream out(file, std::ios::binary);
  if (!(out << text << std::flush)) {
    context.err << "error: " << file.generic_string() << " cannot be written\n";
    return 1;
  }
  context.out << file.generic_string() << '\n';
  return 0;
}

}  // namespace insula
