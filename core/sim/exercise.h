// SPDX-License-Identifier: GPL-3.0-or-later
// An exercise: goals, faults and an end, kept by rules that read the step's report and write nothing else.
#pragma once
#include <string>
#include <vector>

#include "core/registry/component.h"
#include "core/sim/report.h"

namespace insula {

class Simulation;

struct GoalState {
  std::string id, text;
  bool done = false;
  double time = -1;       ///< simulated time when it was reached, s
  bool required = true;   ///< the exercise ends when all required goals are done
};

struct FaultState {
  std::string id, text;
  int count = 0;
  double last_time = -1;
};

enum class ExerciseState { running, done, failed };

/// What rules write: goals reached, faults made, messages, the end.
class ExerciseLog {
 public:
  int add_goal(std::string id, std::string text, bool required = true);
  int add_fault(std::string id, std::string text);
  void goal(int index, double time);
  void fault(int index, double time, double value);
  void message(std::string text, double time);
  void fail(std::string why, double time);
  void reset();

  const std::vector<GoalState>& goals() const { return goals_; }
  const std::vector<FaultState>& faults() const { return faults_; }
  ExerciseState state() const { return state_; }
  const std::string& last_message() const { return message_; }
  double end_time() const { return end_time_; }
  EventSink events;  ///< since the last time the simulation collected them

 private:
  std::vector<GoalState> goals_;
  std::vector<FaultState> faults_;
  ExerciseState state_ = ExerciseState::running;
  std::string message_;
  double end_time_ = -1;
};

class ExerciseRule : public Component {
 public:
  static constexpr std::string_view kind_name = "exercise rule";
  /// Once: find what it watches, declare goals and faults.
  virtual void declare(PrepareContext&, const Simulation&, ExerciseLog&) = 0;
  virtual void observe(const StepReport& report, ExerciseLog& log) = 0;
  virtual void reset() {}
};

/// `<motion id="steady" file="..."/>`: a scripted two-hand motion of the exercise.
class MotionEntry final : public Component {
 public:
  static constexpr std::string_view kind_name = "motion";
  Param<File> file{this, {.name = "file", .doc = "CSV of the motion: time_s,hand,px_m,...,button2"}};
  void prepare(PrepareContext& context) override;
};

class Exercise final : public Component {
 public:
  static constexpr std::string_view kind_name = "exercise";
  Param<std::string> title{this, {.name = "title", .doc = "name of the exercise"}};
  Param<std::string> text{this, {.name = "text", .fallback = "", .doc = "what the trainee is to do"}};

  void connect(PrepareContext& context, const Simulation& simulation);
  void observe(const StepReport& report);
  void reset();
  ExerciseLog& log() { return log_; }
  const ExerciseLog& log() const { return log_; }
  std::vector<MotionEntry*> motions() const { return children_of<MotionEntry>(); }
  /// The hud_json of render_frame_t.
  std::string hud_json(const StepReport& report) const;

 private:
  std::vector<ExerciseRule*> rules_;
  ExerciseLog log_;
};

}  // namespace insula
