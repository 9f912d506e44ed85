// SPDX-License-Identifier: GPL-3.0-or-later
// How the exercise stands: goals, faults, clocks, measures, metrics.
#include <fmt/format.h>

#include "python/src/bind.h"

namespace insula::python {
namespace {

const Exercise& exercise_of(const Run& run) {
  const Exercise* e = run.simulation().exercise();
  if (!e) throw std::invalid_argument("the scene has no exercise");
  return *e;
}

const char* name_of(ExerciseState state) {
  switch (state) {
    case ExerciseState::running: return "running";
    case ExerciseState::done: return "done";
    case ExerciseState::failed: return "failed";
  }
  return "";
}

/// As Python prints it.
template <class Value>
std::string described(const char* type, const std::string& name, const Value& v) {
  return v.known ? fmt::format("<{} {}: {:.6g}{}{}>", type, name, v.value, v.unit.empty() ? "" : " ", v.unit)
                 : fmt::format("<{} {}: not known>", type, name);
}

void bind_log(nb::module_& m) {
  nb::class_<GoalState>(m, "Goal", "A goal of the exercise.")
      .def_ro("id", &GoalState::id, "Its id.")
      .def_ro("text", &GoalState::text, "Text for the trainee.")
      .def_ro("done", &GoalState::done, "Whether it is reached.")
      .def_ro("required", &GoalState::required, "Whether the exercise ends only when it is reached.")
      .def("__repr__", [](const GoalState& g) { return "<Goal " + g.id + (g.done ? ", reached>" : ">"); });
  nb::class_<FaultState>(m, "Fault", "A fault, and how often it was made.")
      .def_ro("id", &FaultState::id, "Its id.")
      .def_ro("text", &FaultState::text, "Text for the trainee.")
      .def_ro("count", &FaultState::count, "How often it was made.")
      .def("__repr__", [](const FaultState& f) { return "<Fault " + f.id + ", " + std::to_string(f.count) + ">"; });
  nb::class_<TimerState>(m, "Timer", "A clock of the exercise.")
      .def_ro("id", &TimerState::id, "Its id.")
      .def_ro("elapsed", &TimerState::elapsed, "s.")
      .def_ro("limit", &TimerState::limit, "s; 0: none.")
      .def_ro("running", &TimerState::running, "Whether it runs.")
      .def("__repr__", [](const TimerState& t) { return fmt::format("<Timer {}, {:.1f} s>", t.id, t.elapsed); });
}

void bind_results(nb::module_& m) {
  nb::class_<MeasureState>(m, "Measure", "A result that the exercise measures.")
      .def_ro("id", &MeasureState::id, "Its id.")
      .def_ro("text", &MeasureState::text, "Text for the trainee.")
      .def_prop_ro(
          "value",
          [](const MeasureState& s) -> std::optional<double> {
            if (!s.known) return std::nullopt;
            return s.value;
          },
          "In `unit`; None: not known.")
      .def_ro("unit", &MeasureState::unit, "Unit of the value.")
      .def_ro("good", &MeasureState::good, "1 good, 0 neutral, -1 bad.")
      .def("__repr__", [](const MeasureState& s) { return described("Measure", s.id, s); });
  nb::class_<MetricValue>(m, "Metric", "A figure on how the hands work.")
      .def_ro("id", &MetricValue::id, "Its id.")
      .def_ro("text", &MetricValue::text, "Its meaning.")
      .def_prop_ro(
          "hand", [](const MetricValue& v) { return std::string(hand_name(v.hand)); },
          "\"left\", \"right\" or \"both\".")
      .def_prop_ro(
          "value",
          [](const MetricValue& v) -> std::optional<double> {
            if (!v.known) return std::nullopt;
            return v.value;
          },
          "In `unit`; None: not known.")
      .def_ro("unit", &MetricValue::unit, "Unit of the value.")
      .def("__repr__", [](const MetricValue& v) {
        return described("Metric", v.hand == both_hands ? v.id : v.id + " " + std::string(hand_name(v.hand)), v);
      });
}

}  // namespace

void bind_exercise(nb::module_& m, RunClass& run) {
  bind_log(m);
  bind_results(m);
  run.def_prop_ro(
         "has_exercise", [](const Run& r) { return r.simulation().exercise() != nullptr; },
         "Whether the scene has an exercise.")
      .def_prop_ro(
          "exercise_title", [](const Run& r) { return std::string(exercise_of(r).title()); }, "Its title.")
      .def_prop_ro(
          "exercise_text", [](const Run& r) { return std::string(exercise_of(r).text()); },
          "What the trainee is to do.")
      .def_prop_ro(
          "exercise_state", [](const Run& r) { return name_of(exercise_of(r).log().state()); },
          "\"running\", \"done\" or \"failed\".")
      .def_prop_ro(
          "goals", [](const Run& r) { return exercise_of(r).log().goals(); }, "Goals.")
      .def_prop_ro(
          "faults", [](const Run& r) { return exercise_of(r).log().faults(); }, "Faults.")
      .def_prop_ro(
          "timers", [](const Run& r) { return exercise_of(r).log().timers(); }, "Clocks.")
      .def_prop_ro(
          "measures", [](const Run& r) { return exercise_of(r).log().measures(); }, "Measures.")
      .def(
          "metrics", [](const Run& r) { return exercise_of(r).metrics(); }, "The metrics of the run so far.");
}

}  // namespace insula::python
