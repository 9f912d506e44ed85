// SPDX-License-Identifier: GPL-3.0-or-later
// The readers of scenes for files that Python reads: XML with its places, and quantities.
#include "core/params/number.h"
#include "core/xml/document.h"
#include "python/src/bind.h"

namespace insula::python {
namespace {

nb::list attributes_of(const Element& e) {
  nb::list out;
  for (const Attribute& a : e.attributes)
    out.append(
        nb::make_tuple(a.name, a.value, a.name_pos.line, a.name_pos.column, a.value_pos.line, a.value_pos.column));
  return out;
}

nb::tuple tree_of(const Element& e) {
  nb::list children;
  for (const auto& child : e.children) children.append(tree_of(*child));
  return nb::make_tuple(e.name, e.pos.line, e.pos.column, attributes_of(e), children);
}

template <class Q>
std::pair<std::optional<double>, std::string> read(const std::string& text) {
  std::string error;
  const auto value = read_quantity(text, Q::units(), Q::name, error);
  return {value ? std::optional(value->si) : std::nullopt, error};
}

}  // namespace

void bind_xml(nb::module_& m) {
  m.def(
      "read_xml",
      [](const std::string& text, const std::string& file) {
        Diagnostics found;
        const Document document = parse_document(text, file, found);
        nb::object tree = nb::none();
        if (document.root) tree = tree_of(*document.root);
        return std::pair(tree, found.all());
      },
      "text"_a, "file"_a,
      "Reads XML as scenes are read. Returns the root, or None, and all problems. An element is a tuple: name, line, "
      "column, attributes, children; an attribute is name, value, line and column of each.");
  m.def("read_time", &read<Duration>, "text"_a, "A time with its unit in s, or None and what is wrong with it.");
  m.def("read_frequency", &read<Frequency>, "text"_a, "The same of a frequency, in Hz.");
  m.def(
      "nearest_name",
      [](const std::string& word, const std::vector<std::string>& names) -> std::optional<std::string> {
        std::string near = nearest_name(word, names);
        if (near.empty()) return std::nullopt;
        return near;
      },
      "word"_a, "names"_a, "The name that was probably meant, None if no name is near.");
}

}  // namespace insula::python
