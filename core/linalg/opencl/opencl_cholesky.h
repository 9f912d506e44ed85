// SPDX-License-Identifier: GPL-3.0-or-later
// The direct solver on an OpenCL device: the fronts of MultifrontalCholesky<double>, level by level, with kernels of
// our own. Matrix, factor, Y and W stay on the device. Only W, a flag and vectors come back. A step allocates nothing
// unless its rows, or their entries, exceed all earlier ones.
//
// Every function may throw DeviceFailure, after which the solver must not be used. GuardedSolver goes on without it.
#pragma once
#include <array>
#include <memory>
#include <utility>
#include <vector>

#include "core/linalg/body_solver.h"
#include "core/linalg/opencl/device.h"
#include "core/linalg/opencl/plan.h"
#include "core/linalg/row_entries.h"

namespace insula::opencl {

class OpenclCholesky final : public BodySolver {
 public:
  explicit OpenclCholesky(const FoundDevice& device) : device_(device) {}

  void analyse(const BlockMatrix& a) override;
  bool factorise(const BlockMatrix& a) override;
  void solve(double* x) override;
  bool begin_motion(const BlockMatrix* a, const VecX& load, const VecX& guess) override;
  void unforced_motion(const VecX& load, VecX& x) override;
  void add_free_motion(const BodyRows& rows, double* delta) const override;
  void end_motion(const BodyRows& rows, const double* lambda, VecX& x) override;
  void begin_compliance(const BodyRows& rows, const std::vector<int>& node_of_block) override;
  int compliance_parts(ComplianceAct act) const override;
  void compliance_part(ComplianceAct act, int part) override;
  void add_compliance(const BodyRows& rows, double* w, int stride) override;
  bool has_second_rows() const override { return true; }
  void exchange_rows() override { std::swap(rows_, second_rows_); }
  SolverCost cost() const override;

  Device& device() { return device_; }

 private:
  static constexpr int most_parts = 32;  ///< of a sum over the fronts that rows reach

  void queue_factor(const BlockMatrix& a);
  bool factor_is_good();
  void queue_forward(const Buffer& x);
  void queue_backward(const Buffer& x);
  void put(const double* natural, const Buffer& to);
  void get(const Buffer& from, double* natural);

  Device device_;
  Elimination e_;
  Plan plan_;
  Buffer fronts_, children_, map_, index_, tasks_, scatter_target_, scatter_, diagonal_;
  Buffer values_, panels_, inverses_, bad_;
  std::array<Buffer, 2> updates_, carried_one_, carried_many_;  ///< of levels in turn
  Buffer x_, load_;
  std::vector<double> permuted_;
  std::int64_t factor_number_ = 0;
  bool loaded_ = false;

  /// The rows of the last begin_compliance(), sorted by their first column.
  struct RowSet {
    RowEntries entries, before;
    std::vector<int> order;  ///< row of each column of Y
    std::vector<int> begin;  ///< first permuted node of each row
    std::vector<ReachRecord> reach;
    std::vector<EntryRecord> entry_records;
    std::vector<int> reached;  ///< fronts, ascending
    std::vector<Task> tasks;
    std::vector<std::pair<TaskRange, TaskRange>> levels;  ///< forward_own, forward_below
    TaskRange tiles, parts;
    int columns = 0, ldy = 0;
    std::int64_t rows_factor = -1;
    bool unchanged = false;
    std::vector<double> w, of_load, lambda;
    Buffer y, w_part, w_sum, load_part, load_sum, lambda_there, reach_there, entries_there, reached_there, tasks_there;
  };
  void arrange();
  void find_reach();
  void list_tasks();
  void reserve_rows();
  void queue_compliance();
  void read_compliance();
  RowSet rows_, second_rows_;
};

}  // namespace insula::opencl
