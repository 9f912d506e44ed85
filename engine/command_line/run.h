// SPDX-License-Identifier: GPL-3.0-or-later
// The commands that step a scene: run (headless, with a report), bench (stage times), engine (the live process).
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/command_line/commands.h"

namespace insula {

struct RunOptions {
  std::filesystem::path scene;
  std::string motion = "none";         ///< id of a motion of the exercise, CSV file, or none
  double duration = 0;                 ///< simulated seconds; 0: the motion and one second more, or 10 s without one
  std::filesystem::path report;        ///< folder for report.json and report.html; empty: none
  std::filesystem::path export_folder; ///< folder for the bodies' final nodes as .vtu; empty: none
  int threads = 0;
  std::uint64_t seed = 0;              ///< of the complications; 0: the scene's
  bool quiet = false;
};
/// Runs a scene headless and deterministic with both hands inside the process. Status 0, or 2 for bad input, 1 when the
/// simulation left the range of numbers or a file could not be written.
int cmd_run(const CommandContext& context, const RunOptions& options);

struct BenchOptions {
  std::filesystem::path scene;
  std::string motion = "steady";
  int steps = 600;
  double from = 0;   ///< simulated time at which measuring begins, s
  int threads = 0;
  bool json = false;
  bool solvers = false;  ///< compare solvers instead
  int rows = 0;          ///< of each body, for the comparison of solvers; 0: all of them
  std::filesystem::path record;    ///< folder for the steps' constraint problems, in place of measuring
  int every = 10;                  ///< a problem of so many is written
  std::filesystem::path problems;  ///< folder of such problems, to be solved in place of a scene
};
/// Steps a scene as fast as it goes and prints where each millisecond went.
int cmd_bench(const CommandContext& context, const BenchOptions& options);
/// Steps a scene as above and writes every so manieth constraint problem to a folder. Status 0, 1 or 2.
int cmd_record_problems(const CommandContext& context, const BenchOptions& options);
/// Solves the problems of a folder by each method, and measures the rate of sweeps. Status 0 or 2.
int cmd_bench_problems(const CommandContext& context, const BenchOptions& options);
/// Takes every deformable body's matrix and rows of one step and compares solvers on them: time, error, share of the machine.
int cmd_bench_solvers(const CommandContext& context, const BenchOptions& options);

struct HapticBenchOptions {
  std::filesystem::path scene;
  std::string motion = "steady";   ///< id of a motion of the exercise, or a CSV file: where the devices go
  std::vector<double> rates{30, 60, 100};  ///< of the engine, Hz
  double duration = 0;   ///< simulated seconds; 0: the whole motion
  std::string latency = "1";  ///< from the devices' poses to the arrival of the step's problem: "0.5" steps, or "3 ms"
  double jitter = 0;     ///< and so much later still at most, in steps
  bool ablation = false; ///< what goes beyond equation 7, one after the other
  bool fine = false;     ///< the engine steps at 1 kHz whatever the rate, which tells the servo's part of the error from the step's
  std::filesystem::path traces;  ///< folder for the forces as CSV; empty: none
  int threads = 0;
};
/// Compares the servo's force with the engine's at 1 kHz on the same path of the devices. Status 0, or 2 for bad input.
int cmd_bench_haptics(const CommandContext& context, const HapticBenchOptions& options);

struct EngineOptions {
  std::filesystem::path scene;
  std::string motion = "steady";
  std::filesystem::path bundle_root;
  double duration = 0;
  bool unthrottled = false;
  int threads = 0;
  std::uint64_t seed = 0;
  bool keep_bundle = false;       ///< for a replay
  bool still = false;             ///< to be looked at (insula view)
  bool standby = false;           ///< loads, prints standby_line, and waits for SIGUSR1 before it speaks on the bus
  std::filesystem::path notice;   ///< file whose text viewers are shown while it is not empty
  std::filesystem::path report;   ///< folder for the session's reports; empty: none
};
inline constexpr const char* standby_line = "insula engine stands by";
/// The engine process of a session; talks over the bus of LCM_DEFAULT_URL until SIGINT or SIGTERM.
int cmd_engine(const CommandContext& context, const EngineOptions& options);

struct ReplayOptions {
  std::filesystem::path log;  ///< of lcm-logger
  double speed = 1;
  bool loop = false;
};
/// Plays what viewers show of a recorded session onto the bus.
int cmd_replay(const CommandContext& context, const ReplayOptions& options);

}  // namespace insula
