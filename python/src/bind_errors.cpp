// SPDX-License-Identifier: GPL-3.0-or-later
// Problems of scenes as data, and the exceptions of readers.
#include "core/base/input_error.h"
#include "python/src/bind.h"

namespace insula::python {

void bind_errors(nb::module_& m) {
  nb::exception<InputError>(m, "InputError", PyExc_ValueError);
  nb::class_<Diagnostic>(m, "Problem", "An error or a warning of a scene, with its place.")
      .def(
          "__init__",
          [](Diagnostic* d, std::string message, std::string file, int line, int column) {
            new (d) Diagnostic{Severity::error, {std::move(file), line, column}, std::move(message)};
          },
          "message"_a, "file"_a = "", "line"_a = 0, "column"_a = 0, "An error at a place of a file.")
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
      .def_prop_ro(
          "nearest",
          [](const Diagnostic& d) {
            const std::string name = proposed_name(d.text);
            return name.empty() ? std::nullopt : std::optional(name);
          },
          "The name that was probably meant, None if there is none.")
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
