// SPDX-License-Identifier: GPL-3.0-or-later
// What a device does for matrices of one pattern, in which order: fronts of equal depth in the elimination tree are one
// level, and the deepest level comes first. Each kernel gets a range of tasks, one for each of its groups.
#pragma once
#include <array>
#include <vector>

#include "core/linalg/elimination.h"
#include "core/linalg/opencl/front_record.h"

namespace insula::opencl {

/// What one group works on. The meaning of a, b and c is the kernel's (*.cl).
struct Task {
  int front = 0, a = 0, b = 0, c = 0;
};

struct TaskRange {
  int first = 0, count = 0;
};

struct Level {
  /// One block of columns of each front that has so many.
  struct Block {
    TaskRange update, diagonal, solve;
  };
  std::vector<int> fronts;
  TaskRange all, assemble, subtract;  ///< all: one task a front
  std::vector<Block> blocks;
};

struct Plan {
  Plan() = default;
  Plan(const Elimination& e, const BlockMatrix& a);

  std::vector<FrontRecord> fronts;
  std::vector<Level> levels;  ///< the deepest first
  std::vector<Task> tasks;
  std::vector<int> children;
  std::vector<int> diagonal;                      ///< permuted node -> slot of its diagonal block
  std::vector<record_long> scatter_target;        ///< of each block of A, in the panels
  std::vector<std::array<int, 4>> scatter;        ///< its slot, leading dimension, whether transposed, 0
  record_long update_size = 0, inverse_size = 0;  ///< largest of a level; of all fronts, scalars
  int carried_rows = 0;                           ///< largest of a level

 private:
  void place(const Elimination& e);
  void add_tasks(Level& level);
  void add_blocks(Level& level);
};

}  // namespace insula::opencl
