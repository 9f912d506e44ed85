// SPDX-License-Identifier: GPL-3.0-or-later
// An exercise: goals, faults and an end. Rules read the step's report and write only these.
#pragma once
#include <array>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "core/registry/component.h"
#include "core/sim/metric.h"
#include "core/sim/report.h"

namespace insula {

class Simulation;
struct ChannelEntry;

struct GoalState {
  std::string id, text;
  bool done = false;
  double time = -1;      ///< simulated time when it was reached, s
  bool required = true;  ///< the exercise ends when all required goals are done
};

struct FaultState {
  /// Number of times that are kept of each fault.
  static constexpr std::size_t most_times = 20;
  std::string id, text;
  std::string advice;  ///< what the trainee should do instead; empty: the text says it
  int count = 0;
  double last_time = -1;
  std::vector<double> times;  ///< simulated time of the first most_times faults, s
};

/// A clock shown to the trainee.
struct TimerState {
  std::string id, text;
  double limit = 0;    ///< s; 0: none
  double elapsed = 0;  ///< s
  bool running = false;
  double longest = 0;  ///< largest elapsed so far, s
};

/// The value of a measure, now or at the exercise's end: neck remnant, narrowing of a branch, ...
struct MeasureState {
  std::string id, text, unit;
  bool known = false;  ///< has a value
  double value = 0;    ///< in `unit`
  int good = 0;        ///< 1 good, 0 neutral, -1 bad
  /// From and to of the values that are good, in `unit`; none: open. Both none: nothing is said of good and bad.
  std::array<std::optional<double>, 2> band{};
  std::string limit;  ///< the values that are good, as text: "below 10 %"; empty: not stated
};

enum class ExerciseState { running, done, failed };

/// Output of rules: goals reached, faults made, messages, the end.
class ExerciseLog {
 public:
  int add_goal(std::string id, std::string text, bool required = true);
  int add_fault(std::string id, std::string text);
  /// Sets the advice of all faults from index `first` on that have none.
  void advise(std::size_t first, const std::string& advice);
  int add_timer(std::string id, std::string text, double limit_s);
  int add_measure(std::string id, std::string text, std::string unit,
                  const std::array<std::optional<double>, 2>& band = {});
  void goal(int index, double time);
  /// Takes back a goal whose condition no longer holds. Only while the exercise runs. See reopen() for later.
  void goal_lost(int index, double time);
  void fault(int index, double time, double value);
  void timer(int index, double elapsed_s, bool running);
  void measure(int index, double value, int good);
  void message(std::string text, double time);
  void fail(std::string why, double time);
  /// Takes back an end by success: the exercise runs again. For what an instructor asks for after the end.
  void reopen(double time);
  void reset();

  const std::vector<GoalState>& goals() const { return goals_; }
  const std::vector<FaultState>& faults() const { return faults_; }
  const std::vector<TimerState>& timers() const { return timers_; }
  const std::vector<MeasureState>& measures() const { return measures_; }
  ExerciseState state() const { return state_; }
  const std::string& last_message() const { return message_; }
  double end_time() const { return end_time_; }
  EventSink events;  ///< since the last time the simulation collected them

 private:
  std::vector<GoalState> goals_;
  std::vector<FaultState> faults_;
  std::vector<TimerState> timers_;
  std::vector<MeasureState> measures_;
  ExerciseState state_ = ExerciseState::running;
  std::string message_;
  double end_time_ = -1;
};

/// A rule declares its measures as channels with `measure = true`, and sets them in observe(). A group of channels is
/// declared in prepare(). The exercise takes the measures of all components into its log.
class ExerciseRule : public Component {
 public:
  static constexpr std::string_view kind_name = "exercise rule";
  Param<std::string> advice{this,
                            {.name = "advice",
                             .fallback = "",
                             .doc = "what the trainee should do after a fault of this rule, shown at the end"}};
  /// Called once: finds what the rule watches, declares goals and faults.
  virtual void declare(PrepareContext&, const Simulation&, ExerciseLog&) = 0;
  virtual void observe(const StepReport& report, ExerciseLog& log) = 0;
  virtual void reset() {}
};

/// `<motion id="steady" file="..."/>`: a scripted two-hand motion of the exercise.
class MotionEntry final : public Component {
 public:
  static constexpr std::string_view kind_name = "motion";
  Param<File> file{this, {.name = "file", .doc = "CSV of the motion: rows of hand poses and of commands"}};
  Param<bool> guide{this,
                    {.name = "guide",
                     .fallback = "false",
                     .doc = "whether pages show its poses as targets while a trainee practises"}};
  Param<Length> guide_distance{this,
                               {.name = "guide_distance",
                                .fallback = "3 mm",
                                .min = "0.2 mm",
                                .max = "20 mm",
                                .doc = "distance from a target of the guide that counts as reached; at least 3 mm "
                                       "where no button acts"}};
  Param<Angle> guide_angle{this,
                           {.name = "guide_angle",
                            .fallback = "15 deg",
                            .min = "1 deg",
                            .max = "90 deg",
                            .doc = "turn against a target of the guide that counts as reached; at least 15 deg "
                                   "where no button acts"}};
  void prepare(PrepareContext& context) override;
};

/// Id of the measure that a channel is: its name, with "_pct" for percentages: "grade", "superior.flow_pct".
std::string measure_id(const ChannelBase& channel, std::size_t item);

class Exercise final : public Component {
 public:
  static constexpr std::string_view kind_name = "exercise";
  Param<std::string> title{this, {.name = "title", .doc = "name of the exercise"}};
  Param<std::string> text{this, {.name = "text", .fallback = "", .doc = "what the trainee is to do"}};
  Param<Choice> site{this,
                     {.name = "site",
                      .fallback = "",
                      .choices = {"ophthalmic", "posterior communicating", "anterior choroidal", "carotid bifurcation",
                                  "middle cerebral", "anterior communicating", "pericallosal", "basilar tip",
                                  "superior cerebellar", "posterior inferior cerebellar", "other"},
                      .doc = "artery or junction at which the aneurysm is; pages group cases by it"}};
  Param<int> difficulty{this,
                        {.name = "difficulty",
                         .fallback = "0",
                         .min = "0",
                         .max = "5",
                         .doc = "from 1, for a first case, to 5, for an expert; 0: not said. Pages sort cases by it"}};

  void connect(PrepareContext& context, const Simulation& simulation);
  /// After each step: the rules. The measures are then those of the step; once the exercise has ended they stand still.
  void observe(const StepReport& report);
  /// After observe(), when the report has the channels that the rules have set: the metrics.
  void observe_metrics(const StepReport& report);
  void reset();
  ExerciseLog& log() { return log_; }
  const ExerciseLog& log() const { return log_; }
  std::vector<MotionEntry*> motions() const { return children_of<MotionEntry>(); }
  /// The metrics of the run so far, in document order. They stand still once the exercise has ended.
  std::vector<MetricValue> metrics() const;

 private:
  /// A channel that is a measure, and its number in the log.
  struct Measured {
    const ChannelEntry* entry;
    int index;
  };
  void add_measures(const Simulation& simulation);
  std::vector<ExerciseRule*> rules_;
  std::vector<MetricSet*> metric_sets_;
  std::vector<Measured> measured_;
  bool ran_ = false;  ///< at the start of the step
  ExerciseLog log_;
};

}  // namespace insula
