// SPDX-License-Identifier: GPL-3.0-or-later
// Rows that fail between steps: a strand that a blade cuts, or that is torn, parts at its tick and not when the
// engine's next problem arrives. The law is that of Block::failure_travel and Block::failure_force.
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <utility>
#include <vector>

#include "core/constraint/problem.h"

namespace insula {

/// Allocates only in its constructor.
class PredictedFailure {
 public:
  explicit PredictedFailure(int max_rows);

  /// Starts from the end of a step. delta: of the rows there. Rows that failed before and that the engine still sends,
  /// since it did not know of it yet, stay failed for as long as its knowledge is late.
  void begin(const ConstraintProblem& problem, std::span<const double> delta) noexcept;
  /// Forgets all failures.
  void reset() noexcept;
  /// Whether the row resists every further displacement.
  static bool plastic(const Block& b) { return b.law == LawKind::box && b.failure_travel > 0; }
  /// Writes the laws of the coming tick into the problem's blocks.
  void apply(std::span<Block> blocks) const noexcept;
  /// Takes the tick's solution. delta: of plastic rows that bear, since the tick began.
  void solved(std::span<const double> lambda, std::span<const double> delta, double dt_s) noexcept;
  /// The tools whose rows let go in the coming tick, as bits: the rows have failed, or a blade is out of its strand in
  /// a new problem. That change of their force is not to be faded out. Resets itself.
  unsigned take_release() noexcept { return std::exchange(release_, 0U); }

 private:
  struct Watched {
    std::uint64_t id;
    int block, row, group;
    int wear;  ///< of its group, index of wear_; -1: it does not wear
    bool failed, bears;
    unsigned tools;  ///< bits of those that have a part in the row
    double compliance, force;
  };
  struct Wear {
    int row, sign;  ///< sign: of the displacement that wears; 0: both
    double travel, limit;
    double integrity() const { return travel < limit ? 1 - travel / limit : 0; }
  };
  struct Remembered {
    std::uint64_t id = 0;
    double left_s = 0;  ///< for which it stays failed
  };
  void fail(std::size_t watched) noexcept;
  void remember(std::uint64_t id) noexcept;

  std::vector<Watched> watched_;
  std::vector<Wear> wear_;
  std::array<Remembered, 64> remembered_;
  double step_s_ = 0;
  unsigned release_ = 0;
};

}  // namespace insula
