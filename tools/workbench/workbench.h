// SPDX-License-Identifier: GPL-3.0-or-later
// The workbench's commands: what a scene costs (check), and where the time of a step goes (bench). They are a program
// of their own, so that a trainee's session carries neither benchmarks nor the cost model.
#pragma once
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "engine/command_line/commands.h"

namespace insula {

/// Loads each scene or curriculum; prints one line per good one to `out`, everything wrong to `err`. Of a scene that
/// settles first
/// (<settle>) only with `settle` is that done: then what is made after settling and contacts stand, and what a step
/// costs is known.
int cmd_check(const CommandContext& context, const std::vector<std::filesystem::path>& files, bool settle = false);
/// The same without costs, as JSON for editors: {ok, problems: [{severity, file, line, column, text, nearest}]}.
/// nearest: the name that the text proposes; empty: none.
int cmd_check_json(const CommandContext& context, const std::vector<std::filesystem::path>& files);
struct ScalingOptions {
  int threads = 1;
  bool quick = false;  ///< small sizes only
  bool json = false;
  std::filesystem::path output;  ///< folder for scaling.json and scaling.svg; empty: none
};
/// Measures scenes made for it: the stages of a step against nodes, rows and fibres, with the slope beside theory.
int cmd_bench_scaling(const CommandContext& context, const ScalingOptions& options);

struct BenchOptions {
  std::filesystem::path scene;
  std::string motion = "steady";
  int steps = 600;
  double from = 0;  ///< simulated time at which measuring begins, s
  int threads = 0;
  bool json = false;
  bool frames = false;             ///< measure the viewer's frames instead
  bool recording = false;          ///< measure a session's recording instead
  bool solvers = false;            ///< compare solvers instead
  int nodes = 0;                   ///< of a brick in place of a scene, for the comparison of solvers; 0: the scene
  int rows = 0;                    ///< of each body, for the comparison of solvers; 0: all of them
  std::filesystem::path blas;      ///< folder with a further libblas.so.3 for the comparison of solvers; empty: none
  std::filesystem::path record;    ///< folder for the steps' constraint problems, in place of measuring
  int every = 10;                  ///< a problem of so many is written
  std::filesystem::path problems;  ///< folder of such problems, to be solved in place of a scene
};
/// Steps a scene as fast as it goes and prints where each millisecond went.
int cmd_bench(const CommandContext& context, const BenchOptions& options);
/// Steps a scene as above, sends its frames to nobody, and prints their size and time. Status 0, 1 or 2.
int cmd_bench_frames(const CommandContext& context, const BenchOptions& options);
/// Steps a scene as above while it is recorded into a temporary file, and prints what that costs. Status 0, 1 or 2.
int cmd_bench_recording(const CommandContext& context, const BenchOptions& options);
/// Steps a scene as above and writes every so manieth constraint problem to a folder. Status 0, 1 or 2.
int cmd_record_problems(const CommandContext& context, const BenchOptions& options);
/// Solves the problems of a folder by each method, and measures the rate of sweeps. Status 0 or 2.
int cmd_bench_problems(const CommandContext& context, const BenchOptions& options);
/// Takes every deformable body's matrix and rows of one step and compares solvers on them: time, error, share of the
/// machine.
int cmd_bench_solvers(const CommandContext& context, const BenchOptions& options);

struct HapticBenchOptions {
  std::filesystem::path scene;
  std::string motion = "steady";           ///< id of a motion of the exercise, or a CSV file: where the devices go
  std::vector<double> rates{30, 60, 100};  ///< of the engine, Hz
  double duration = 0;                     ///< simulated seconds; 0: the whole motion
  std::string latency = "1";  ///< from the devices' poses to the arrival of the step's problem: "0.5" steps, or "3 ms"
  double jitter = 0;          ///< and so much later still at most, in steps
  bool ablation = false;      ///< what goes beyond equation 7, one after the other
  bool fine = false;  ///< the engine steps at 1 kHz whatever the rate, which tells the servo's part of the error from
                      ///< the step's
  std::filesystem::path traces;  ///< folder for the forces as CSV; empty: none
  int random = 0;                ///< so many random probes in place of the motion; 0: none
  std::uint64_t seed = 1;        ///< of the probes
  bool json = false;
  int threads = 0;
};
/// Compares the servo's force with the engine's at 1 kHz on the same path of the devices. Status 0, or 2 for bad input.
int cmd_bench_haptics(const CommandContext& context, const HapticBenchOptions& options);

}  // namespace insula
