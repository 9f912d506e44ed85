// SPDX-License-Identifier: GPL-3.0-or-later
#include "engine/authoring/schema_types.h"

#include <fmt/format.h>

#include <fstream>
#include <ostream>

#include "core/base/text.h"
#include "core/params/list.h"
#include "engine/authoring/describe.h"
#include "engine/reports/svg_plot.h"
#include "training/curriculum/limit_param.h"

namespace insula {
namespace {

constexpr const char* number_pattern = R"([+\-]?([0-9]+(\.[0-9]*)?|\.[0-9]+)([eE][+\-]?[0-9]+)?)";

/// "(Pa|kPa)", with any number of blanks where a symbol has one.
std::string unit_pattern(std::span<const Unit> units) {
  std::string out;
  for (const auto& u : units) {
    if (!out.empty()) out += '|';
    for (char c : u.symbol) out += c == ' ' ? std::string(R"(\s+)") : std::string(1, c);
  }
  return out.empty() ? out : R"(\s*()" + out + ")";
}

std::string enumeration(std::string_view name, const std::vector<std::string>& values) {
  std::string out = fmt::format(
      "  <xs:simpleType name=\"{}\"><xs:union memberTypes=\"with_variable\"><xs:simpleType><xs:restriction "
      "base=\"xs:token\">",
      name);
  for (const auto& v : values) out += fmt::format("<xs:enumeration value=\"{}\"/>", escaped(v));
  return out + "</xs:restriction></xs:simpleType></xs:union></xs:simpleType>\n";
}

}  // namespace

std::string schema_annotation(std::string_view text, std::string_view indent) {
  return fmt::format("{0}<xs:annotation><xs:documentation>{1}</xs:documentation></xs:annotation>\n", indent,
                     escaped(text));
}

std::string schema_type_id(std::string_view prefix, std::string_view name) {
  std::string out(prefix);
  for (char c : name) out += c == ' ' ? '_' : c;
  return out;
}

std::string schema_preprocessing() {
  return "  <xs:element name=\"include\">\n" +
         schema_annotation("puts the children of another file's root here", "    ") +
         "    <xs:complexType>\n"
         "      <xs:sequence><xs:element ref=\"variable\" minOccurs=\"0\" maxOccurs=\"unbounded\"/></xs:sequence>\n"
         "      <xs:attribute name=\"file\" type=\"xs:string\" use=\"required\"/>\n"
         "      <xs:attribute name=\"prefix\" type=\"xs:string\"/>\n    </xs:complexType>\n  </xs:element>\n"
         "  <xs:element name=\"variable\">\n" +
         schema_annotation("a value to be used as $name", "    ") +
         "    <xs:complexType>\n      <xs:attribute name=\"name\" use=\"required\"><xs:simpleType><xs:restriction "
         "base=\"xs:string\">"
         "<xs:pattern value=\"[A-Za-z_][A-Za-z0-9_]*\"/></xs:restriction></xs:simpleType></xs:attribute>\n"
         "      <xs:attribute name=\"value\" type=\"xs:string\" use=\"required\"/>\n    </xs:complexType>\n  "
         "</xs:element>\n";
}

std::string SchemaTypes::simple_type(const ParamBase& p) {
  if (!p.ref_kind().empty()) return p.is_list() ? "references" : "reference";
  if (dynamic_cast<const Param<bool>*>(&p)) return "true_or_false";
  if (dynamic_cast<const Param<int>*>(&p)) return "whole_number";
  if (dynamic_cast<const Param<LengthUnit>*>(&p)) return "unit_of_length";
  if (dynamic_cast<const Param<List<int>>*>(&p)) return "whole_numbers";
  if (dynamic_cast<const Param<MetricLimit>*>(&p)) return "limit_of_metric";
  if (const auto* list = dynamic_cast<const QuantityListParam*>(&p)) {
    const std::string name = schema_type_id("list_", list->quantity()), n(number_pattern);
    simple_types_[name] = n + R"((\s+)" + n + ")*" + unit_pattern(list->units());
    return name;
  }
  if (const auto* q = dynamic_cast<const QuantityParam*>(&p)) {
    const std::string name = schema_type_id("quantity_", q->type_name());
    simple_types_[name] = number_pattern + unit_pattern(q->units());
    return name;
  }
  if (const auto* v = dynamic_cast<const VectorParam*>(&p)) {
    std::string quantity = v->type_name();  // "three numbers (length)"
    quantity = quantity.substr(quantity.find('(') + 1);
    quantity.pop_back();
    const std::string name = schema_type_id("vector_", quantity);
    const std::string n(number_pattern);
    simple_types_[name] = n + R"(\s+)" + n + R"(\s+)" + n + unit_pattern(v->units());
    return name;
  }
  return "xs:string";
}

std::string SchemaTypes::attribute(const ParamBase& p) {
  std::string doc(p.spec().doc);
  doc += " (" + p.type_name();
  if (const auto allowed = allowed_text(p); !allowed.empty()) doc += "; " + allowed;
  if (const auto units = units_text(p); !units.empty()) doc += "; units " + units;
  doc += p.required() ? "; required)" : "; default " + default_text(p) + ")";
  const std::string use = p.required() ? " use=\"required\"" : "";
  if (p.spec().choices.empty())
    return fmt::format("    <xs:attribute name=\"{}\" type=\"{}\"{}>\n{}    </xs:attribute>\n", p.name(),
                       simple_type(p), use, schema_annotation(doc, "      "));
  std::string choices;
  for (const auto c : p.spec().choices) choices += fmt::format("<xs:enumeration value=\"{}\"/>", escaped(c));
  return fmt::format(
      "    <xs:attribute name=\"{}\"{}>\n{}"
      "      <xs:simpleType><xs:union memberTypes=\"with_variable\"><xs:simpleType><xs:restriction "
      "base=\"xs:token\">{}"
      "</xs:restriction></xs:simpleType></xs:union></xs:simpleType>\n    </xs:attribute>\n",
      p.name(), use, schema_annotation(doc, "      "), choices);
}

std::string SchemaTypes::text() {
  simple_types_["with_id"] = R"([^\s$#]+)";
  simple_types_["reference"] = R"([^\s$#]*)";
  simple_types_["references"] = R"([^$#]*)";
  simple_types_["limit_of_metric"] = number_pattern + std::string(".*");
  simple_types_["whole_numbers"] = R"([+\-]?[0-9]+(\s+[+\-]?[0-9]+)*)";
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

int write_schema(const CommandContext& context, const std::string& text, const std::filesystem::path& file) {
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
