// SPDX-License-Identifier: GPL-3.0-or-later
// Steps, commands and events. A step releases Python's lock, so simulations run in threads at the same time.
#include "python/src/bind.h"

namespace insula::python {
namespace {

struct CommandRefused : std::runtime_error {
  using std::runtime_error::runtime_error;
};

constexpr int steps_between_signals = 60;  ///< Ctrl-C ends a long call after that many steps

void step(Run& run, int steps) {
  if (steps < 0) throw std::invalid_argument("steps: at least 0");
  const Run::Turn turn(run);
  run.clear_events();
  while (steps > 0) {
    {
      nb::gil_scoped_release free;
      for (int k = std::min(steps, steps_between_signals); k > 0; --k, --steps) run.step();
    }
    if (steps > 0 && PyErr_CheckSignals() != 0) throw nb::python_error();
  }
}

using CommandTuple = std::tuple<std::string, std::string, std::string, std::string, double, double>;

std::vector<CommandTuple> commands_of(const Run& run) {
  std::vector<CommandTuple> out;
  for (const Component* c : run.simulation().scene().components())
    for (const CommandInfo& i : c->commands()) out.emplace_back(c->id, i.name, i.doc, i.argument, i.min, i.max);
  return out;
}

void bind_events(nb::module_& m) {
  nb::class_<Event>(m, "Event", "Something that happened once: a goal, a fault, a command, a torn strand.")
      .def_ro("kind", &Event::kind, "\"goal\", \"fault\", \"message\", \"end\", or one that a component declares.")
      .def_ro("id", &Event::id, "Id of the component, goal or fault.")
      .def_ro("text", &Event::text, "Text for the trainee.")
      .def_ro("value", &Event::value, "SI; its meaning depends on the kind.")
      .def_ro("time", &Event::time, "Simulated time, s.")
      .def_prop_ro(
          "hand",
          [](const Event& e) -> std::optional<std::string> {
            if (e.hand < 0) return std::nullopt;
            return e.hand == 0 ? "left" : "right";
          },
          "Hand whose tool caused it, None if there is none.")
      .def("__repr__", [](const Event& e) { return "<Event " + e.kind + " " + e.id + " " + e.text + ">"; });
}

}  // namespace

void bind_stepping(nb::module_& m, RunClass& run) {
  bind_events(m);
  nb::exception<CommandRefused>(m, "CommandRefused", PyExc_RuntimeError);
  run.def("step", &step, "steps"_a = 1,
          "Makes steps. Other threads of Python run meanwhile. Raises RuntimeError when the state leaves the range of "
          "numbers.")
      .def(
          "reset",
          [](Run& r) {
            const Run::Turn turn(r);
            nb::gil_scoped_release free;
            r.reset();
          },
          "Returns to the start, with the bits of a new process. A seed and a followed motion stay.")
      .def(
          "command",
          [](Run& r, const std::string& verb, const std::string& argument) {
            const Run::Turn turn(r);
            if (const std::string why = r.command(verb, argument); !why.empty()) throw CommandRefused(why);
          },
          "verb"_a, "argument"_a,
          "A command between two steps: \"exchange\", \"right applier\"; \"ask\", \"artery_pressure set_systolic "
          "160\"; "
          "\"message\", text. Raises CommandRefused with the reason.")
      .def_prop_ro("commands", &commands_of,
                   "Commands that components accept: id, name, meaning, argument, and the range of a number.")
      .def(
          "draw_complications",
          [](Run& r, std::uint64_t seed) {
            const Run::Turn turn(r);
            r.draw_complications(seed);
          },
          "seed"_a,
          "Draws the complications of the scene from this seed, now and after each reset; 0: the scene's own.")
      .def_prop_ro(
          "time", [](const Run& r) { return r.simulation().time(); }, "Simulated time, s.")
      .def_prop_ro(
          "steps", [](const Run& r) { return r.simulation().steps(); }, "Number of steps since the start.")
      .def_prop_ro(
          "step_ms", [](const Run& r) { return r.simulation().report().step_ms; }, "Wall time of the last step, ms.")
      .def_prop_ro(
          "energy", [](const Run& r) { return r.simulation().energy(); },
          "Kinetic and elastic energy of all bodies, J.")
      .def_prop_ro(
          "events", [](const Run& r) { return r.events(); }, "Events of the last call of step(), in order.");
}

}  // namespace insula::python
