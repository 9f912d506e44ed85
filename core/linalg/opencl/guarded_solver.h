// SPDX-License-Identifier: GPL-3.0-or-later
// A solver on a device that may fail while it works. After a failure the direct solver of the processor repeats what
// the step has been given and goes on. The failure is logged once.
#pragma once
#include <array>
#include <memory>
#include <string>
#include <utility>

#include "core/linalg/opencl/opencl_cholesky.h"

namespace insula::opencl {

class GuardedSolver final : public BodySolver {
 public:
  /// Throws DeviceFailure if the device cannot be used at all.
  explicit GuardedSolver(const FoundDevice& device)
      : on_device_(std::make_unique<OpenclCholesky>(device)), name_(device.name) {}

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
  void exchange_rows() override;
  SolverCost cost() const override;

  /// Of the device, also after its failure.
  const std::string& device_name() const { return name_; }
  bool device_lost() const { return on_device_ == nullptr; }
  /// Null after a failure.
  Device* device() { return on_device_ ? &on_device_->device() : nullptr; }

 private:
  struct Given {
    BodyRows rows;
    const std::vector<int>* node_of_block = nullptr;  ///< null: no rows
    bool computed = false;                            ///< by the take-over; parts of this call are left out
  };
  BodySolver& present() const;
  void take_over(const std::string& why);
  void repeat(Given& given);
  template <class F>
  void attempt(F&& f);

  std::unique_ptr<OpenclCholesky> on_device_;
  std::unique_ptr<BodySolver> on_processor_;  ///< null before a failure
  std::string name_;
  const BlockMatrix *pattern_ = nullptr, *matrix_ = nullptr;  ///< of analyse(); of the present factor
  VecX load_;
  bool loaded_ = false;
  Given given_, second_;
};

}  // namespace insula::opencl
