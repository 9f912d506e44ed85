// SPDX-License-Identifier: GPL-3.0-or-later
// Saved states.
#include <fmt/format.h>

#include "python/src/bind.h"

namespace insula::python {

void bind_state(nb::module_& m, RunClass& run) {
  nb::class_<State>(m, "State", "A saved state of a simulation. It can be pickled, and restored by another process.")
      .def_ro("time", &State::time_s, "Simulated time, s.")
      .def_ro("steps", &State::steps, "Number of steps since the start.")
      .def_ro("hash", &State::hash, "Simulation.state_hash of the state.")
      .def(
          "__bytes__",
          [](const State& s) {
            const std::string bytes = s.bytes();
            return nb::bytes(bytes.data(), bytes.size());
          },
          "The state as bytes.")
      .def_static(
          "of_bytes",
          [](const nb::bytes& b) {
            return State::of_bytes({b.c_str(), b.size()});
          },
          "data"_a, "The state of these bytes. Raises InputError if they are none.")
      .def("__repr__", [](const State& s) { return fmt::format("<State at {:.6f} s, {:016x}>", s.time_s, s.hash); })
      .def("__getstate__",
           [](const State& s) {
             const std::string bytes = s.bytes();
             return nb::bytes(bytes.data(), bytes.size());
           })
      .def("__setstate__", [](State& s, const nb::bytes& b) {
        new (&s) State(State::of_bytes({b.c_str(), b.size()}));
      });
  run.def(
         "save",
         [](Run& r) {
           const Run::Turn turn(r);
           return r.save();
         },
         "The present state: what the simulation was asked to do since its start. It takes some bytes for each step.")
      .def(
          "restore",
          [](Run& r, const State& state) {
            const Run::Turn turn(r);
            nb::gil_scoped_release free;
            r.restore(state);
          },
          "state"_a,
          "Makes the state again, to the bit. The steps that lead to it are made again, from the present state if that "
          "is on the way and otherwise from the start. Raises InputError if it is of another scene or version.")
      .def_prop_ro(
          "state_hash", [](const Run& r) { return r.simulation().state_hash(); },
          "Hash of the state of all bodies and constraints, as `insula run` prints it.");
}

}  // namespace insula::python
