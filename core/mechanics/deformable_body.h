// SPDX-License-Identifier: GPL-3.0-or-later
// A deformable body of any topology: nodes with lumped masses, force models, supports, and one implicit Euler
// linearisation a step:
//   (M/h^2 + C/h + K) dq = f + M v/h + D v,   C = alpha M + beta K + D,   D = -df/dv of force models with a damping of
//   their own
#pragma once
#include <memory>

#include "core/linalg/body_solver.h"
#include "core/mechanics/dynamic_body.h"
#include "core/mechanics/follower_load.h"
#include "core/mechanics/force_model.h"

namespace insula {

class DeformableBody : public DynamicBody {
 public:
  DeformableBody() : DynamicBody(0) {}

  /// The tangent may be older than the force. This changes neither the equilibrium nor the order of the time
  /// integration.
  Param<Scalar> tangent_tolerance{
      this,
      {.name = "tangent_tolerance",
       .fallback = "0",
       .min = "0",
       .max = "0.5",
       .doc = "change of shape (of the distance vector of neighbouring nodes, over their distance) up to which the "
              "system matrix and its factor are used again; 0: made anew every step"}};

  Param<Choice> solver_kind{
      this,
      {.name = "solver",
       .fallback = "direct",
       .choices = {"direct", "single", "asynchronous", "opencl", "faster"},
       .doc =
           "how the body's system is solved: a factor made anew when the tissue has changed shape, in double or single "
           "precision, or for large bodies conjugate gradients with a factor that is made in the background; opencl: "
           "as direct on an OpenCL device; faster: direct or opencl, as a short trial at the start finds"}};
  Param<Length> solver_tolerance{
      this,
      {.name = "solver_tolerance",
       .fallback = "0.001 mm",
       .min = "1e-9 mm",
       .max = "1 mm",
       .doc = "asynchronous solver: a solve ends when what is left would move no node by more than this"}};

  /// Rest positions of the nodes, scene frame, m. Known after prepare().
  virtual const std::vector<Vec3>& rest_nodes() const = 0;
  /// Nodes that the topology itself fixes (a shell's caps), in addition to supports. Default: none.
  virtual void fix_own_nodes(std::vector<char>&) const {}
  /// Once, after this body and everything it owns are prepared: topology, masses, symbolic factorisation.
  void connect(PrepareContext& context);

  int nodes() const { return int(rest_nodes().size()); }
  const VecX& q() const { return q_; }  ///< 3 values a node, m
  const VecX& v() const { return v_; }  ///< m/s
  VecX& q() { return q_; }
  VecX& v() { return v_; }
  double step_length() const { return step_; }  ///< of the current step, s
  const std::vector<double>& node_mass() const { return mass_; }
  const std::vector<double>& node_damping() const { return damping_; }  ///< Rayleigh mass damping, kg/s
  const std::vector<char>& fixed() const { return fixed_; }
  const std::vector<int>& free_of_node() const { return free_; }  ///< node -> block of the system matrix, -1 when fixed
  const std::vector<ForceModel*>& forces() const { return forces_; }
  SolverCost solver_cost() const { return solver_->cost(); }
  const BlockMatrix& system() const { return a_; }  ///< as last assembled
  /// Steps whose matrix was not positive definite; these were solved with more mass.
  int indefinite_steps() const { return indefinite_; }
  /// Steps that assembled and factorised the system matrix anew.
  int factorisations() const { return factorisations_; }
  double factor_ms() const {
    return factor_ms_;
  }  ///< of the last step; 0: the factor was kept, or is computed in the background
  /// External force for the next steps, 3 values a node, N (tests, loads).
  VecX external;
  /// Force of the fluid that fills the body, set by a constraint between the steps, 3 values a node, N.
  VecX filling;
  /// How `filling` changes with the shape; null: unknown. It must live as long as the body steps.
  const FollowerLoad* filling_gradient = nullptr;
  /// Prestrains the force models so that they balance `load` (3 values a node, N) in the rest configuration. Returns
  /// the remaining imbalance on the free nodes over |load|, which is 1 when no force model takes a prestrain. Call it
  /// after connect() and before the first step.
  double prestress(const VecX& load);

  Vec3 position(const MaterialPoint& p) const override;
  Vec3 expected_displacement(const MaterialPoint& p) const override;
  Vec3 unforced_displacement(const MaterialPoint& p) const override;
  bool can_move(const MaterialPoint& p) const override;
  void add_row(BodyRows& rows, const MaterialPoint& p, const Vec3& d) const override;
  void free_motion(const StepContext& context) override;
  BodySolver* solver() override { return solver_.get(); }
  void begin_compliance(const BodyRows& r) override { solver_->begin_compliance(r, free_); }
  void add_response(const BodyRows& rows, double* w, int stride, double* delta_free) override;
  void apply(const StepContext& context, const BodyRows& rows, const double* lambda) override;
  void add_rate(const BodyRows& rows, double* rate) const override;
  void finish(const StepContext& context, const ConstraintSolution& solution) override;
  double retardation_time(const MaterialPoint& p) const override;
  double retardation_time_of_node(int i) const { return retardation_time_[std::size_t(i)]; }  ///< s
  void reset() override;
  double energy() const override;
  bool finite() const override { return v_.allFinite(); }  // and so is q, the sum of all h v
  void append_state(std::vector<double>& out) const override;

 protected:
  /// Sizes q and v and puts the nodes at rest. A subclass calls it at the end of prepare().
  void start_at_rest();

 private:
  std::vector<ForceModel*> forces_;
  std::vector<char> fixed_;
  std::vector<int> free_;
  int free_count_ = 0;
  std::vector<double> mass_, damping_;
  VecX q_, v_, force_, packed_;
  VecX load_;              ///< of the step's motion, N
  mutable VecX unforced_;  ///< motion under load_ without row forces; computed when first requested
  enum class Unforced { unknown, known, asked };
  mutable Unforced unforced_is_ = Unforced::unknown;
  double factor_ms_ = 0;
  VecX guess_;              ///< of solvers that are not exact: the last step's displacement
  std::vector<Quat> turn_;  ///< rotation of each free node's neighbourhood from rest
  std::vector<Mat3> rotation_, around_;
  BlockMatrix a_;
  std::unique_ptr<BodySolver> solver_;
  int indefinite_ = 0;
  double step_ = 0;                       ///< of the current step, s
  std::vector<double> retardation_time_;  ///< at each node, s
  bool retardation_times_known_ = false;

  std::vector<ForceModel*> damped_;  ///< those with has_damping()
  BlockMatrix damping_matrix_;       ///< D as it was last assembled; no nodes if there is none
  VecX packed_v_, damped_load_;      ///< of the free nodes

  void make_solver(PrepareContext& context);
  void check_couplings(PrepareContext& context, const ForceModel& model, std::vector<std::pair<int, int>>& pairs) const;
  void bind(PrepareContext& context, ForceModel& model);
  void add_damping(double h, bool fresh);
  bool tangent_is_good(double h) const;
  void assemble(double h);
  void factorise(double h);
  void find_rotations();
  void start_retardation_times();
  void find_retardation_times(double h);
  struct Neighbours {
    int i, j;
    double distance2;  ///< at rest, m2
  };
  std::vector<Neighbours> neighbours_;  ///< watched for changes of shape
  VecX factor_q_;                       ///< configuration in which the tangent was computed
  double factor_h_ = 0;                 ///< 0: there is no factor yet
  int factorisations_ = 0;
};

}  // namespace insula
