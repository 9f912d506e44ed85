// SPDX-License-Identifier: GPL-3.0-or-later
// Solver of large bodies: conjugate gradients on the step's own matrix A. The preconditioner is a factor of the matrix
// of an earlier step, which a background thread computes (Courtecuisse, Allard, Kerfriden, Bordas, Cotin, Duriez 2010
// and 2014). With R the nodes' rotations since then,
//     P^-1 = R A0^-1 R^T,
// since a co-rotational matrix rotates with its nodes. A step never waits for a factor. It uses the old one and needs
// more iterations.
//
// The free motion is computed under the row forces of the step before. The change in a step is then small, and so is
// the error of an old factor. The compliance of rows is H P^-1 H^T. Rows that have hardly changed keep their compliance
// of earlier steps. correct() solves with A, which shows the error of that compliance. Defect correction removes the
// error (core/sim/defect_correction.h). A solve ends when P^-1 of the residual moves no node by more than `tolerance`.
// The solution is then moved by exactly that displacement.
#pragma once
#include "core/linalg/background_factor.h"
#include "core/linalg/inexact_solver.h"

namespace insula {

class AsynchronousSolver final : public InexactSolver {
 public:
  explicit AsynchronousSolver(double tolerance);  ///< m

  void analyse(const BlockMatrix& a) override;
  /// Takes the step's matrix, which must not change until the next call. The first matrix is factorised at once. Later
  /// ones are factorised in the background, when the number of iterations has grown. Returns false if the first matrix
  /// was not positive definite.
  bool factorise(const BlockMatrix& a) override;
  void set_rotations(const std::vector<Mat3>& rotation) override;
  void solve(double* x) override;
  bool begin_motion(const BlockMatrix* a, const VecX& load, const VecX& guess) override;
  void unforced_motion(const VecX& load, VecX& x) override { refine(load.data(), x.data(), early * tolerance_); }
  void add_free_motion(const BodyRows& rows, double* delta) const override { add_rows_of(free_.data(), rows, delta); }
  void end_motion(const BodyRows& rows, const double* lambda, VecX& x) override;
  void begin_compliance(const BodyRows& rows, const std::vector<int>& node_of_block) override;
  int compliance_parts(ComplianceAct act) const override { return front_->full.compliance_parts(act); }
  void compliance_part(ComplianceAct act, int part) override { front_->full.compliance_part(act, part); }
  void add_compliance(const BodyRows& rows, double* w, int stride) override;
  void subtract_lagged(const BodyRows& rows, double* delta) const override;
  const std::vector<double>& correct(const BodyRows& rows, const double* lambda) override;
  void add_correction(const BodyRows& rows, double* delta) const override { add_rows_of(last_x_.data(), rows, delta); }
  void reset() override;
  void set_timing(FactorTiming timing) override { timing_ = timing; }
  void take_next() override { take_next_ = true; }
  bool took() const override { return took_; }
  SolverStatus status() const override { return status_; }
  SolverCost cost() const override { return front_->full.cost(); }

  /// With counted timing, a requested factor is put in place this many steps after the request. This is about the
  /// time that a busy core needs for it. It is computed from flops and not from a clock, so the same input gives the
  /// same bits.
  int delay() const { return 1 + int(front_->full.cost().factor_flops / 5e8); }
  static constexpr double early = 30;          ///< allowed error of the free motion, in units of the tolerance
  static constexpr int enough_iterations = 2;  ///< in one solve; more of them request a new factor
  static constexpr int max_iterations = 12;

 private:
  void add_rows_of(const double* x, const BodyRows& rows, double* delta) const;  ///< delta += H x, by row number
  void keep_rows();
  void precondition(const double* r, double* z);
  double refine(const double* b, double* x, double tolerance);  ///< returns the remaining error, m
  void add_lagged_row(const std::vector<int>& node_of_block);
  void ask();
  void take();

  double tolerance_;
  VecX free_;  ///< the free motion, natural order, m
  const BlockMatrix* a_ = nullptr;
  std::unique_ptr<StaleFactor> front_;
  BackgroundFactor background_;
  int asked_steps_ = 0;  ///< steps since the request
  std::vector<Mat3> rotation_, factor_rotation_,
      requested_rotation_;               ///< of each node: now, in the factor, in the requested factor
  std::vector<Mat3> since_;              ///< rotation from the factor's configuration to the present one
  BodyRows rotated_rows_, rows_before_;  ///< as given to the factor, numbered from 0; the row of the lagged forces
                                         ///< follows, if there are any
  std::vector<double> lagged_, given_,
      left_;  ///< forces on nodes: of the rows of the last step, of this step, and the imbalance of the free motion
  std::vector<int> block_of_node_;
  std::vector<double> s_;  ///< compliance of rotated_rows_, as it was last added
  bool factor_is_new_ = true;
  bool corrected_ = false;  ///< since begin_compliance(): last_lambda_ and last_x_ are of its rows
  std::vector<double> b_, r_, z_, p_, ap_, last_lambda_, last_x_, difference_, change_;
  const std::vector<int>* nodes_of_block_ = nullptr;
  double lacks_ = 0;    ///< estimated error of a node of last_x_, m
  double seen_ = 0;     ///< reduction of the error by one iteration, as last measured
  double quality_ = 1;  ///< the same, doubled in every step until it is measured again
  SolverStatus status_;
  FactorTiming timing_ = FactorTiming::counted;
  bool usable_ = false, take_next_ = false, took_ = false;
};

}  // namespace insula
