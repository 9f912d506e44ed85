// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts that are found anew in each tick, on the surface patches of the problem (core/constraint/surface_patch.h).
//
// A contact that the step found has a fixed place and direction until the next problem. On what slides, this is most of
// the error of the hand's force. So the patches' vertices move from tick to tick, as the other rows do
// (substep_correction.h), and the tool meets the triangles where they are. With u the vertices' displacement,
//   du = a dt u' + s W_uu (f - f of the tick before) + s W_ur (lambda - lambda of the tick before)
// f is the contacts' force on the vertices, -b_i n lambda at a corner of barycentric coordinate b_i. Contacts are found
// where tool and vertices would be if no force changed. Their rows follow from that place:
//   W_cc = G W_uu G^T + J A_tool J^T,   W_cr = G W_ur + J A_tool J_r^T,   G = -n b
//   delta_free = gap there, or slip in the tick, - (what the forces of the tick before contribute)
#pragma once
#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "core/constraint/problem.h"
#include "core/haptics/patch_collider.h"
#include "haptic_server/reduced_dynamics.h"

namespace insula {

/// Allocates only in its constructor.
class PatchContacts {
 public:
  static constexpr std::size_t most_contacts = 24;  ///< of both tools in a tick

  explicit PatchContacts(int max_rows);
  void reset() noexcept;

  /// Takes a problem. Returns it without the vertices' rows and the replaced contacts, whose force is then that of the
  /// patches; `problem` itself if it has no patches. Valid until the next call.
  const ConstraintProblem& begin(const ConstraintProblem& problem) noexcept;
  /// The problem that the ticks use: what begin() returned, or the same without some of its blocks.
  void couple(const ConstraintProblem& problem) noexcept;
  /// Force and moment of the patches' contacts on a tool in the last tick, about the tool's origin, N and N m.
  const Vec6& push(std::size_t tool) const noexcept { return push_[tool]; }

  /// Shares of the compliance that act within a tick, as square roots: `step_s` is the length of the step.
  void scale(double dt_s, double step_s, bool substep_compliance) noexcept;
  /// Removes the effect of the last tick's forces from the rows' delta_free; `share` of these rows.
  void subtract_known(std::span<const double> share, std::span<double> delta_free) const noexcept;
  struct Tool {
    Pose pose;                   ///< if no force changes
    Vec6 went = Vec6::Zero();    ///< to there, in the tick
    Vec6 push = Vec6::Zero();    ///< of all rows and patches in the tick before
    const Mat6* give = nullptr;  ///< compliance in the tick
    const Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor>* jacobian = nullptr;  ///< of the rows
  };
  /// The tick's problem of the other rows, and of the contacts found now. `known`: lambda of the rows in the tick
  /// before, N. Its lambda is the warm start of the contacts' rows.
  const ConstraintProblem& next(const ConstraintProblem& rows, std::span<const double> share,
                                std::span<const double> known, std::span<const Tool> tools, double dt_s,
                                bool extrapolate) noexcept;
  /// Takes the forces of that problem's solution; `rows`: number of the rows before those of the contacts.
  void take_forces(std::span<const double> lambda, std::size_t rows) noexcept;
  /// Moves the vertices by them. Modes must have advanced. `known` and `share` as before.
  void move(std::span<const double> lambda, std::span<const double> share, std::span<const double> known, double dt_s,
            bool substep_compliance) noexcept;

  /// Splits the vertices' W and rates into those of the modes and the rest. Call it after couple(); null: no modes.
  void begin_dynamics(ReducedDynamics* dynamics) noexcept;
  /// Adds the forces on the vertices to those of the modes.
  void add_forces() noexcept;
  /// Whether a contact that pressed in the tick before is not among those of this one. Its force has jumped to others.
  bool exchanged() const noexcept { return exchanged_; }

 private:
  using Directions = Eigen::Matrix<double, 3, 3, Eigen::RowMajor>;
  struct Contact {
    std::size_t tool;
    double friction, compliance;
    std::uint64_t key;
    std::array<int, 3> slot;  ///< first of the corner's three values; -1: it cannot move
    Vec3 bary, arm;           ///< arm: from the tool's origin, m
    Directions directions;    ///< rows: normal, tangent, other tangent
    double gap;
    Vec6 jacobian(int k) const {
      Vec6 j;
      const Vec3 d = directions.row(k).transpose();
      j << d, arm.cross(d);
      return j;
    }
  };
  struct Remembered {
    std::uint64_t key;
    Vec3 lambda;
  };
  PatchCollider& collider_of(std::uint64_t id) noexcept;
  void take_vertices(const ConstraintProblem& problem) noexcept;
  void take_replaced(const ConstraintProblem& problem) noexcept;
  void find_contacts(std::span<const Tool> tools, int room) noexcept;
  void add_contact(const SurfacePatch& patch, const Proximity& x, const Tool& tool) noexcept;
  void write_compliance(const ConstraintProblem& rows, std::span<const double> share,
                        std::span<const Tool> tools) noexcept;
  void write_free(int first, std::span<const Tool> tools) noexcept;
  Vec3 at(const Contact& c, const std::vector<double>& values) const noexcept;
  double vv(std::size_t i, std::size_t j) const noexcept { return w_vv_[i * std::size_t(vertex_rows_) + j]; }
  double vr(std::size_t i, std::size_t row) const noexcept { return w_vr_[i * std::size_t(max_rows_) + row]; }

  /// Of one of the vertices' values.
  const double* participation(std::size_t i) const noexcept { return problem_->reduced.row(std::size_t(source_[i])); }
  void subtract_known_modes(std::span<double> delta_free) const noexcept;
  void find_participations() noexcept;
  void add_modal_compliance(std::size_t rows) noexcept;

  int max_rows_;
  const ConstraintProblem *problem_ = nullptr, *rows_ = nullptr;  ///< of the message; that the ticks use
  ReducedDynamics* dynamics_ = nullptr;                           ///< null: none
  const SurfacePatches* patches_ = nullptr;                       ///< null: none
  ConstraintProblem rest_, tick_;
  Eigen::Matrix<double, Eigen::Dynamic, 6, Eigen::RowMajor> spare_;
  std::vector<int> kept_;            ///< rows of the problem in rest_
  std::vector<char> dropped_;        ///< of the problem's rows
  std::vector<int> slots_;           ///< of the vertices: first of three values, -1: it cannot move
  std::vector<int> source_;          ///< of the values: row of the problem
  int vertex_rows_ = 0;              ///< values of moving vertices, n
  std::vector<double> w_vv_, w_vr_;  ///< n x n; n x max_rows
  std::vector<double> beta_, share_, rate_, force_, free_, back_, change_, modal_;
  std::vector<double> contact_participation_;  ///< of the contacts' rows, rows x modes
  std::vector<Vec3> position_, ahead_;
  std::vector<double> axes_;  ///< of each contact, three rows of n: compliance from its place to the vertices
  std::array<Vec6, 2> push_{Vec6::Zero(), Vec6::Zero()};

  std::vector<PatchCollider> colliders_;
  std::size_t next_collider_ = 0;
  std::uint64_t next_key_ = 1;
  bool exchanged_ = false;
  double later_ = 0;  ///< share of an overlap that stays until later ticks
  std::vector<Proximity> found_;
  std::vector<Contact> contacts_;
  std::vector<Remembered> remembered_;
};

}  // namespace insula
