// SPDX-License-Identifier: GPL-3.0-or-later
// Problems of scenes as data, and the exceptions of readers.
#include "core/base/input_error.h"
#include "python/src/bind.h"

namespace insula::python {

namespace {

/// The name in the end of a message: did you mean "name"?, or did you mean <name>?
std::optional<std::string> nearest_in(const Diagnostic& d) {
  static constexpr std::string_view before = "did you mean ";
  const std::size_t at = d.text.rfind(before), from = at + before.size() + 1;
  if (at == std::string::npos || from >= d.text.size()) return std::nullopt;
  return d.text.substr(from, d.text.find(d.text[from - 1] == '<' ? '>' : '"', from) - from);
}

}  // namespace

void bind_errors(nb::module_& m) {
  nb::exception<InputError>(m, "InputError", PyExc_ValueError);
  nb::class_<Diagnostic>(m, "Problem", "An error or a warning of a scene, with its place.")
      .def_prop_ro(
          "severity", [](const Diagnostic& d) { return d.severity == Severity::error ? "error" : "warning"; },
          "\"error\" or \"warning\".")
      .def_prop_ro(
          "file", [](const Diagnostic& d) { return d.pos.file; }, "File of the scene.")
      .def_prop_ro(
          "line", [](const Diagnostic& d) { return d.pos.line; }, "Line, from 1; 0: the whole file.")
      .def_prop_ro(
          "column", [](const Diagnostic& d) { return d.pos.column; }, "Column, from 1; 0: the whole line.")
      .def_ro("message", &Diagnostic::text, "What is wrong.")
      .def_prop_ro("nearest", &nearest_in, "The name that was probably meant, None if there is none.")
      .def("__str__",
           [](const Diagnostic& d) {
             Diagnostics one;
             d.severity == Severity::error ? one.error(d.pos, d.text) : one.warning(d.pos, d.text);
             std::string text = one.format();
             if (!text.empty() && text.back() == '\n') text.pop_back();
             return text;
           })
      .def("__repr__", [](const Diagnostic& d) { return "<Problem " + d.text + ">"; });
}

}  // namespace insula::python
