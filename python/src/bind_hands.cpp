// SPDX-License-Identifier: GPL-3.0-or-later
// Both hands: poses that the program sets, scripted motions, and what the hands feel.
#include <fmt/format.h>

#include "core/base/input_error.h"
#include "engine/live/live_engine.h"
#include "python/src/bind.h"

namespace insula::python {
namespace {

const HandReport& report_of(const Run& run, const std::string& hand) {
  return run.simulation().report().hands[std::size_t(hand_of(hand))];
}

/// Throws std::invalid_argument if the hand is empty.
const Instrument& tool_in(const Run& run, const std::string& hand) {
  if (const Instrument* tool = run.simulation().instrument_of(hand_of(hand))) return *tool;
  throw std::invalid_argument("the " + hand + " hand has no tool");
}

std::vector<std::string> tools_of(const Run& run, const std::string& hand) {
  std::vector<std::string> out;
  for (const Instrument* i : run.simulation().instruments())
    if (i->hand_index() == hand_of(hand)) out.push_back(i->id);
  return out;
}

void bind_motion(nb::module_& m) {
  nb::class_<Motion>(m, "Motion", "A scripted motion of both hands: poses over time, and commands.")
      .def(nb::init<>())
      .def_static(
          "read", [](const std::string& file) { return load_motion(file); }, "file"_a,
          "Reads a CSV file of a motion. Raises InputError with file and line.")
      .def_static(
          "parse", [](const std::string& text, const std::string& name) { return parse_motion(text, name); }, "text"_a,
          "name"_a = "motion", "The same from a text; `name` is the file in messages.")
      .def(
          "add",
          [](Motion& motion, const std::string& hand, double time, const std::array<double, 3>& position,
             const std::array<double, 4>& orientation, bool button1, bool button2) {
            motion.add(hand_of(hand), {time, {pose_of(position, orientation), button1, button2}});
          },
          "hand"_a, "time"_a, "position"_a, "orientation"_a, "button1"_a = false, "button2"_a = false,
          "Adds a pose (m; quaternion w x y z) at a time (s) after that hand's last one.")
      .def(
          "add_command",
          [](Motion& motion, double time, std::string verb, std::string argument) {
            motion.add(MotionCommand{time, std::move(verb), std::move(argument)});
          },
          "time"_a, "verb"_a, "argument"_a, "Adds a command at a time (s).")
      .def(
          "moves", [](const Motion& motion, const std::string& hand) { return motion.has(hand_of(hand)); }, "hand"_a,
          "Whether it has poses for a hand.")
      .def(
          "at",
          [](const Motion& motion, const std::string& hand, double time) {
            const HandSample s = motion.at(hand_of(hand), time);
            const auto [position, orientation] = tuple_of(s.pose);
            return std::tuple(position, orientation, s.button1, s.button2);
          },
          "hand"_a, "time"_a, "Position, orientation and both buttons of a hand at a time (s).")
      .def_prop_ro("duration", &Motion::duration, "Time of the last pose or command, s.")
      .def_prop_ro(
          "commands",
          [](const Motion& motion) {
            std::vector<std::tuple<double, std::string, std::string>> out;
            for (const MotionCommand& c : motion.commands()) out.emplace_back(c.time_s, c.verb, c.argument);
            return out;
          },
          "Time (s), verb and argument of each command.")
      .def("__repr__", [](const Motion& motion) { return fmt::format("<Motion of {:.2f} s>", motion.duration()); });
}

void bind_following(RunClass& run) {
  run.def(
         "follow",
         [](Run& r, std::optional<Motion> motion) {
           const Run::Turn turn(r);
           r.follow(motion ? std::move(*motion) : Motion());
         },
         "motion"_a.none(),
         "Both hands follow the motion by simulated arms and the servo, as in `insula run`. None frees them.")
      .def(
          "motion",
          [](const Run& r, const std::string& name) {
            const auto file = find_motion(r.simulation(), name);
            if (file.empty()) throw InputError("no motion \"" + name + "\"");
            return load_motion(file);
          },
          "name"_a, "A motion of the exercise by its id, or of a CSV file.")
      .def_prop_ro(
          "motions",
          [](const Run& r) {
            std::vector<std::string> out;
            if (const Exercise* e = r.simulation().exercise())
              for (const MotionEntry* entry : e->motions()) out.push_back(entry->id);
            return out;
          },
          "Ids of the exercise's motions.");
}

}  // namespace

void bind_hands(nb::module_& m, RunClass& run) {
  bind_motion(m);
  bind_following(run);
  run.def(
         "set_hand",
         [](Run& r, const std::string& hand, const std::array<double, 3>& position,
            const std::array<double, 4>& orientation, bool button1, bool button2) {
           const HandState state{true, pose_of(position, orientation), button1, button2};
           const Run::Turn turn(r);
           r.set_hand(hand_of(hand), state);
         },
         "hand"_a, "position"_a, "orientation"_a, "button1"_a = false, "button2"_a = false,
         "Where the hand's device is at the end of the coming step, and until it is set again: position in the scene "
         "frame (m), orientation as a quaternion w x y z, and the device's buttons.")
      .def(
          "release_hand",
          [](Run& r, const std::string& hand) {
            const Run::Turn turn(r);
            r.set_hand(hand_of(hand), {});
          },
          "hand"_a, "No device moves the hand any more: its tool stays where it is.")
      .def(
          "hand_pose", [](const Run& r, const std::string& hand) { return tuple_of(tool_in(r, hand).device()); },
          "hand"_a, "Position (m) and orientation (w x y z) of the hand's device. Raises ValueError for an empty hand.")
      .def(
          "tip_pose", [](const Run& r, const std::string& hand) { return tuple_of(tool_in(r, hand).pose()); }, "hand"_a,
          "The same of the tool: its tip, with +z along the shaft to the handle.")
      .def(
          "tool",
          [](const Run& r, const std::string& hand) -> std::optional<std::string> {
            const Instrument* tool = r.simulation().instrument_of(hand_of(hand));
            if (!tool) return std::nullopt;
            return tool->id;
          },
          "hand"_a, "Id of the tool in the hand, None if it is empty.")
      .def("tools", &tools_of, "hand"_a, "Ids of all tools of a hand, that in the hand and those on the tray.")
      .def(
          "hand_force",
          [](const Run& r, const std::string& hand) {
            const Instrument* tool = r.simulation().instrument_of(hand_of(hand));
            return numbers_of(tool ? tool->hand_force() : Vec6(Vec6::Zero()));
          },
          "hand"_a, "Force (N) and torque (N m) of the coupling on the hand, scene frame.")
      .def(
          "contact_force", [](const Run& r, const std::string& hand) { return report_of(r, hand).contact_force; },
          "hand"_a, "Norm of the contact forces on the hand's tool and on all that it holds, N.");
}

}  // namespace insula::python
