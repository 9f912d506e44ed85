// SPDX-License-Identifier: GPL-3.0-or-later
// All state of one run: the scene's bodies and constraints, and the step. Several may exist in one program.
//
// One step: free motion per body (parallel) -> collision -> rows -> W = sum_b H_b A_b^-1 H_b^T (parallel) -> solve ->
// corrective motion (parallel) -> report -> exercise. Order everywhere is document order, so the same scene and the
// same hands give the same bits for any number of threads.
#pragma once
#include <array>
#include <filesystem>
#include <memory>
#include <string>
#include <utility>
#include <vector>

#include "core/base/workers.h"
#include "core/mechanics/constraint.h"
#include "core/mechanics/instrument.h"
#include "core/mechanics/surface.h"
#include "core/scene/scene.h"
#include "core/sim/channel_table.h"
#include "core/sim/complications.h"
#include "core/sim/defect_correction.h"
#include "core/sim/exercise.h"
#include "core/sim/input.h"
#include "core/sim/report.h"
#include "core/sim/settings.h"
#include "core/sim/structure_forces.h"

namespace insula {

class Registry;

class Simulation {
 public:
  /// Connects the scene's components and reports errors. threads: number of threads; 0: as many as the machine has
  /// cores.
  Simulation(std::unique_ptr<Scene> scene, Diagnostics& diagnostics, int threads = 0);
  ~Simulation();

  /// Sets the state of a hand for the end of the coming step (0 left, 1 right).
  void set_hand(int hand, const HandState& state);
  void step();
  /// A command of a viewer, a script or a complication between two steps:
  ///   exchange  "right applier"               the hand lays down its tool and takes that one
  ///   ask       "pump fail", "artery_pressure set_systolic 160"   a command of a component (Component::commands)
  ///   message   "text"                        said to the trainee
  /// Returns the reason for a refusal; empty when done. Both results become an event.
  std::string command(std::string_view verb, std::string_view argument);
  /// Adds an event to the coming step. For components; a recording does not have it.
  void announce(Event event) { commanded_.push_back(std::move(event)); }
  /// Removes and returns the events that the coming step would announce, for use while the run is paused.
  std::vector<Event> take_announced() { return std::exchange(commanded_, {}); }
  /// Draws the scene's complications again from that seed, now and after every reset; 0: from the scene's own seed.
  void draw_complications(std::uint64_t seed);
  /// Whether a step waits for background work, so that the same input gives the same bits (default), or never waits.
  void set_deterministic(bool yes);
  /// Time after a step for which its problem already contains the contacts of tools, s. The servo needs them before the
  /// next problem arrives. 0 (default): only contacts of the step and within the alarm distance.
  void set_collision_horizon(double seconds);
  /// Returns to the start, with the same bits.
  void reset();
  /// What the last step was given, in order: all that was done by the functions above since the step before it, and the
  /// factors that it took from the background.
  const std::vector<SimulationInput>& inputs() const { return inputs_; }
  /// Does what a recorded run was given. Call repeat_factors() before the first one.
  void give(const SimulationInput& input);
  /// From now on, steps take factors from the background only where an input says so, and wait for them.
  void repeat_factors();

  const Scene& scene() const { return *scene_; }
  double h() const { return context_.h; }
  double time() const { return context_.time; }
  std::int64_t steps() const { return context_.step; }
  const StepReport& report() const { return report_; }
  /// The last step's problem with its solution as warm start, as the haptic server gets it.
  const ConstraintProblem& problem() const { return problem_; }
  const std::vector<Body*>& bodies() const { return bodies_; }  ///< instruments included, document order
  const std::vector<Instrument*>& instruments() const { return instruments_; }
  const std::vector<Surface*>& surfaces() const { return surfaces_; }
  const std::vector<Constraint*>& constraints() const { return constraints_; }
  /// All channels of the scene; their values of the last step are in report().channels.
  const ChannelTable& channels() const { return channel_table_; }
  /// The value of a scalar channel as published last, SI. Throws std::out_of_range if the scene has no such channel.
  double channel(std::string_view id) const;
  /// All drawables of the scene in document order, with their components.
  struct DrawableEntry {
    const Component* component;
    const DrawableBase* drawable;
  };
  const std::vector<DrawableEntry>& drawables() const { return drawables_; }
  Complications* complications() const { return complications_; }  ///< null when the scene has none
  Exercise* exercise() const { return exercise_; }                 ///< null when the scene has none
  const ViewSettings* view() const { return view_; }
  const SolveSettings& solve_settings() const {
    return solve_settings_;
  }                                           ///< from the scene's <solver>, else the defaults
  Instrument* instrument_of(int hand) const;  ///< the one in that hand now; null if there is none
  Workers& workers() { return workers_; }
  /// Events of the last step: those of constraints first, then those of the exercise.
  const std::vector<Event>& events() const { return events_; }
  /// FNV-1a over the bits of every body's and constraint's state.
  std::uint64_t state_hash() const;
  /// Sum of the numbers of each moving body's state, in document order: where bits differ, a measure of by how much.
  void body_sums(std::vector<double>& sums) const;
  /// Kinetic and elastic energy of all bodies, J. It is computed on request, since no step needs it.
  double energy() const;

 private:
  SimulationInput& note(SimulationInput::Kind kind, int index = 0);
  void set_timing(FactorTiming timing);
  void note_factors();
  std::string exchange(std::string_view argument);
  std::string ask(std::string_view argument);
  void settle(Diagnostics& diagnostics);
  void move_freely();
  void detect();
  void build();
  void compute_compliance();
  void warm_start();
  void solve_rows();
  void correct_motion();
  void remember_solution();
  void collect_step_data();
  void publish();
  void make_report();
  void report_tool(const Instrument& tool);
  void report_hands();

  std::unique_ptr<Scene> scene_;
  Workers workers_;
  std::vector<Body*> bodies_;
  std::vector<DynamicBody*> dynamic_bodies_;  ///< those of them that move
  std::vector<DynamicBody*> heavy_first_;     ///< the same, by degrees of freedom: evens out the threads
  std::vector<Instrument*> instruments_;
  std::vector<Surface*> surfaces_;
  std::vector<Constraint*> constraints_;
  Exercise* exercise_ = nullptr;
  Complications* complications_ = nullptr;
  std::uint64_t complication_seed_ = 0;
  const ViewSettings* view_ = nullptr;
  SolveSettings solve_settings_;
  StepContext context_;
  EventSink sink_;
  std::vector<Event> events_;
  ConstraintProblem problem_;
  std::unique_ptr<ConstraintBuilder> builder_;
  int newton_soon_ = 0;  ///< steps for which it is
  SolveWorkspace workspace_;
  DefectCorrection defect_;
  struct Remembered {
    std::uint64_t id;
    int rows;
    std::array<double, 3> lambda;
  };
  std::vector<Remembered> remembered_;
  mutable std::vector<double> state_scratch_;
  std::vector<Event> commanded_;                  ///< between the last step and the next
  std::vector<SimulationInput> inputs_, coming_;  ///< of the last step, and of the next
  FactorTiming timing_ = FactorTiming::counted;
  bool stepping_ = false, settling_ = false;
  double settle_time_ = 0, settle_step_ = 0;        ///< s
  std::vector<std::pair<BodySolver*, int>> parts_;  ///< of the bodies' compliance, in this step
  StepReport report_;
  std::unique_ptr<StructureForces> structure_forces_;
  ChannelTable channel_table_;
  std::vector<DrawableEntry> drawables_;
  std::vector<Component*> publishers_;  ///< what declares channels or drawables, document order
};

struct SimulationResult {
  std::unique_ptr<Simulation> simulation;  ///< null when diagnostics has an error
  Diagnostics diagnostics;
};
/// Loads, prepares and connects a scene. time_step_s: in place of its own, 0: as written.
SimulationResult load_simulation(const std::filesystem::path& file, const Registry& registry, int threads = 0,
                                 double time_step_s = 0);
SimulationResult load_simulation_text(std::string_view text, const std::filesystem::path& virtual_path,
                                      const Registry& registry, int threads = 0);

}  // namespace insula
