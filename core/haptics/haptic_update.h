// SPDX-License-Identifier: GPL-3.0-or-later
// Transport of a step's constraint problem from the engine to the haptic server. haptic_problem_t is written and read
// directly, so that nothing is allocated once the buffers have their size.
#pragma once
#include <array>
#include <cstdint>
#include <string>
#include <vector>

#include "core/bus/bus.h"
#include "core/constraint/problem.h"

namespace insula {

inline constexpr int max_problem_rows = 240;
inline constexpr int max_problem_tools = 2;

/// What a message says besides the problem.
struct ProblemStamp {
  std::int64_t session = 0;       ///< engine run, microseconds of its start
  std::int64_t sequence = 0;      ///< counts up by one each step
  std::int64_t time_us = 0;       ///< CLOCK_MONOTONIC when the step ended
  std::int64_t pose_time_us = 0;  ///< CLOCK_MONOTONIC of the device poses the step was made with; 0: not known
  double step_s = 0;              ///< time step h, also the problem's own
  double sim_time_s = 0;          ///< simulated time at the end of the step
  /// Tool frame relative to the device's pose, per entry of problem.tools; identity unless calibrated.
  std::array<Pose, max_problem_tools> offset;
};

struct HapticUpdate : ProblemStamp {
  ConstraintProblem problem;
};

/// Writes the message into `out`, which keeps its capacity. W, Jacobians, friction, compliance, rate and retardation
/// time travel as float32, W as its lower triangle. False, with `out` empty, if the problem cannot be sent: more than
/// 240 rows or 2 tools, or vectors that do not match `rows`. The last four bytes are a checksum, since UDP checks
/// nothing on a loopback interface, and a number with a flipped bit in its mantissa is still plausible.
/// The tool of a hand in `left_out` (0 left, 1 right) is not in the message.
bool encode_problem(const ProblemStamp& stamp, const ConstraintProblem& problem, const std::array<bool, 2>& left_out,
                    std::vector<std::uint8_t>& out);
inline bool encode_problem(const HapticUpdate& update, std::vector<std::uint8_t>& out) {
  return encode_problem(update, update.problem, {}, out);
}

/// Writes the checksum of a changed message, for tests of the checks after it.
void seal_problem(std::vector<std::uint8_t>& message);

/// Reads a message and validates it:
/// - Sizes agree with each other and with the length of the message, and the checksum is right.
/// - Every number is finite and of plausible magnitude: |delta| < 1 m, |W| < 1e4 m/N, |lambda| < 1e4 N.
/// - The diagonal of W is >= 0.
/// - Blocks cover all rows once, in order, with unique ids, known laws, lower <= upper, friction in [0, 10] and
///   compliance >= 0.
/// - lambda satisfies the bounds of its law; |rate| < 1000 m/s; retardation time in [0, 100] s.
/// - Directions rotate by at most 1 rad in a step about any axis.
/// - There are at most two tools, with distinct hands, unit quaternions, and symmetric compliance and stiffness with a
///   non-negative diagonal.
/// - The modes of a reduced model are passive, and no row moves more by them than W says.
/// - Surface patches refer to rows, vertices, triangles, pieces and tools that exist. Their lengths are at most 0.1 m.
/// On failure `into` does not change, and `why` has the reason. Allocates only when `into` must grow, its Jacobians
/// change size, or the message is refused.
bool decode_problem(Bytes bytes, HapticUpdate& into, std::string& why);

}  // namespace insula
