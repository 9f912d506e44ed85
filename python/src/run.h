// SPDX-License-Identifier: GPL-3.0-or-later
// A simulation as Python holds it: it steps with hands that the program or a motion moves, keeps the events of the last
// call, and remembers what it was asked to do.
#pragma once
#include <atomic>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "core/base/diagnostic.h"
#include "core/registry/registry.h"
#include "core/scene/edits.h"
#include "core/sim/simulation.h"
#include "engine/live/headless.h"
#include "python/src/contact_records.h"
#include "python/src/history.h"

namespace insula::python {

/// A saved state: what leads to it, and how to know that it was reached.
struct State {
  std::uint64_t scene = 0;  ///< hash of the scene's files
  double step_s = 0;
  std::int64_t steps = 0;
  double time_s = 0;
  std::uint64_t hash = 0;  ///< of the simulation's state
  History history;

  std::string bytes() const;
  /// Throws InputError if the bytes are no state.
  static State of_bytes(std::string_view bytes);
};

class Run {
 public:
  Run(std::unique_ptr<Registry> registry, std::unique_ptr<Simulation> simulation, std::vector<Diagnostic> warnings);

  /// Throws std::logic_error while a motion moves the hands.
  void set_hand(int hand, const HandState& state);
  /// Returns why it was refused; empty when done.
  std::string command(const std::string& verb, const std::string& argument);
  /// From now on both hands follow the motion by simulated arms and the servo, as in `insula run`. An empty motion
  /// frees them. Throws InputError if the motion may not start where it does.
  void follow(Motion motion);
  bool follows() const { return headless_ != nullptr; }
  void draw_complications(std::uint64_t seed);
  void clear_events() { events_.clear(); }
  /// One step. Throws std::runtime_error when the state has left the range of numbers.
  void step();
  void reset();
  State save() const;
  /// Throws InputError if the state belongs to another scene or if its bits are not reached.
  void restore(const State& state);

  Simulation& simulation() { return *simulation_; }
  const Simulation& simulation() const { return *simulation_; }
  /// Events since clear_events().
  const std::vector<Event>& events() const { return events_; }
  const std::vector<Diagnostic>& warnings() const { return warnings_; }
  ContactRecords& contacts() { return contacts_; }

  /// Throws std::runtime_error if another thread is at work in the run.
  class Turn {
   public:
    explicit Turn(Run& run);
    ~Turn() { run_.busy_.clear(); }
    Turn(const Turn&) = delete;
    Turn& operator=(const Turn&) = delete;

   private:
    Run& run_;
  };

 private:
  void do_step();

  std::unique_ptr<Registry> registry_;
  std::unique_ptr<Simulation> simulation_;
  std::vector<Diagnostic> warnings_;
  std::unique_ptr<HeadlessRun> headless_;  ///< while a motion moves the hands
  Motion motion_;
  std::optional<std::uint64_t> seed_;
  std::vector<Event> events_;
  ContactRecords contacts_;
  History history_;
  std::atomic_flag busy_ = ATOMIC_FLAG_INIT;
};

/// A scene with its problems. `run` is null after an error.
struct Loaded {
  std::unique_ptr<Run> run;
  std::vector<Diagnostic> problems;
};
struct LoadOptions {
  std::vector<std::string> plugins;
  int threads = 1;
  double time_step_s = 0;        ///< 0: the scene's own
  std::vector<SceneEdit> edits;  ///< in place of what the scene says
};
/// text: of the scene; empty: that of the file. Throws InputError if a plugin cannot be loaded.
Loaded load_run(const std::string& text, const std::string& file, const LoadOptions& options);

struct Checked {
  std::vector<Diagnostic> problems;
  std::uint64_t hash = 0;  ///< of the scene's files and of the edits; 0 after an error
};
/// Reads and checks the scene of a file, without preparing a first step. Throws InputError as load_run() does.
Checked check_scene(const std::string& file, const LoadOptions& options);

}  // namespace insula::python
