// SPDX-License-Identifier: GPL-3.0-or-later
// A deformable body: nodes with lumped masses, force models, supports, and one implicit Euler linearisation a step:
//   (M/h^2 + C/h + K) dq = f + M v/h,   C = alpha M + beta K
#pragma once
#include <memory>

#include "core/linalg/block_cholesky.h"
#include "core/mechanics/body.h"
#include "core/mechanics/force_model.h"
#include "core/model/mesh.h"

namespace insula {

class SoftBody final : public Body {
 public:
  Param<File> mesh{this, {.name = "mesh", .doc = "tetrahedral mesh: gmsh .msh, VTK .vtk or .vtu, Medit .mesh"}};
  Param<LengthUnit> mesh_unit{this, {.name = "mesh_unit", .doc = "unit of length of the mesh file"}};

  void prepare(PrepareContext& context) override;
  void connect(PrepareContext& context) override;

  const TetMesh& rest() const { return rest_; }
  /// In place of a file, before prepare(): for tests and generated bodies.
  void set_mesh(TetMesh m) { rest_ = std::move(m); given_ = true; }
  int nodes() const { return int(rest_.nodes.size()); }
  const VecX& q() const { return q_; }    ///< 3 values a node, m
  const VecX& v() const { return v_; }    ///< m/s
  VecX& q() { return q_; }
  VecX& v() { return v_; }
  const std::vector<double>& node_mass() const { return mass_; }
  const std::vector<char>& held() const { return held_; }
  const std::vector<int>& free_of_node() const { return free_; }  ///< node -> block of the system matrix, -1 when held
  const std::vector<ForceModel*>& forces() const { return forces_; }
  const BlockCholesky& solver() const { return *solver_; }
  /// Steps whose matrix was not positive definite; they were solved with more mass (see step()).
  int indefinite_steps() const { return indefinite_; }
  /// External force for the next steps, 3 values a node, N (tests, loads).
  VecX external;

  int blocks() const override { return nodes(); }
  Vec3 position(const MaterialPoint& p) const override;
  Vec3 free_displacement(const MaterialPoint& p) const override;
  void add_row(BodyRows& rows, const MaterialPoint& p, const Vec3& d) const override;
  void free_motion(const StepContext& context) override;
  void compute_compliance(const BodyRows& rows) override;
  void add_compliance(const BodyRows& rows, double* w, int stride) override;
  void apply(const StepContext& context, const BodyRows& rows, const double* lambda) override;
  void reset() override;
  double energy() const override;
  void append_state(std::vector<double>& out) const override;

 private:
  TetMesh rest_;
  bool given_ = false;
  std::vector<ForceModel*> forces_;
  std::vector<char> held_;
  std::vector<int> free_;
  int free_count_ = 0;
  std::vector<double> mass_, damping_;
  VecX q_, v_, force_, dq_, correction_, packed_;
  BlockMatrix a_;
  std::unique_ptr<BlockCholesky> solver_;
  int indefinite_ = 0;
};

}  // namespace insula
