// SPDX-License-Identifier: GPL-3.0-or-later
// Condensation of a step's problem to the size of one message, without a change of the forces on the tools.
#pragma once
#include <vector>

#include "core/constraint/problem.h"

namespace insula {

/// Returns `full` itself if it has at most `max_rows` rows. Otherwise it writes `small` and returns that. Each block is
/// then kept, eliminated or held.
/// - Kept: blocks that touch a tool or a body that it grasps, then blocks that are coupled to these and may soon change
///   their state. Their order stays. Rows of surface patches count as blocks at a tool.
/// - Eliminated: blocks that no tool touches, in a state in which their law is the linear equation
///   delta_E + C lambda_E = 0. These are pressure, springs, fibres in tension, and contacts that press or stick. For
///   sliding friction it is the direction across the slip, which rotates with the slip: C = |delta_t| / |lambda_t|.
///   The Schur complement is exact:
///     W'          = W_KK - W_KE (W_EE + C)^-1 W_EK
///     delta_free' : the kept rows have the delta of the full problem at its lambda
/// - Held: blocks whose lambda stays. These are rows at a bound (separated contacts, slack fibres), friction along its
///   slip, rows that depend on others (pivots near 0), and blocks at a tool for which there is no room. The bound of
///   friction follows the normal force, which a symmetric W' cannot represent.
///
/// Elimination is exact for laws without bounds (bilateral, compliant) for all motions of the tools. For other laws it
/// is exact as long as none changes its state. So laws without bounds are eliminated first. If all other rows then fit,
/// the condensed problem is equivalent to the full one. lambda of `full` must be its solution. Allocates when sizes
/// grow, and when the tools' Jacobians change their size.
class Condenser {
 public:
  const ConstraintProblem& operator()(const ConstraintProblem& full, int max_rows, ConstraintProblem& small);

  /// Marks the rows of blocks that touch a tool or a body that it grasps.
  static void find_rows_at_tools(const ConstraintProblem& problem, std::vector<char>& at_tool);

  /// Beyond this number, the least coupled rows are held, since the cost grows with the cube.
  static constexpr int max_eliminated = 400;

 private:
  enum class Fate : char { held, linear, slips, kept };  // slips: for the first of two tangents
  struct Group {                                         ///< blocks first to last: a patch belongs to its contacts
    int first, last, rows;
    bool tool_coupled, linear;
    double rank;
  };
  /// An unknown that is eliminated: a row, or a direction in the plane of two tangents.
  struct Direction {
    int row;  ///< and the next row, if the direction has a part in it
    double along[2];
    double compliance;
    double free;  ///< delta + compliance lambda of the full solution
  };
  void find_tool_coupled_rows(const ConstraintProblem& full);
  void find_states(const ConstraintProblem& full);
  double state(const ConstraintProblem& full, const Block& block);
  void make_groups(const ConstraintProblem& full);
  void choose(const ConstraintProblem& full, int max_rows, ConstraintProblem& small);
  void copy_kept(const ConstraintProblem& full, ConstraintProblem& small);
  void add_eliminated(const ConstraintProblem& full, const Block& block);
  void fill_factor(const ConstraintProblem& full, long kept_at, long r_at, long modes_at, long width);
  void eliminate(const ConstraintProblem& full, ConstraintProblem& small);

  std::vector<char> tool_coupled_;  ///< by row of the full problem
  std::vector<char> is_weld_;       ///< by row: between a tool and the body that it grasps
  std::vector<Fate> fate_;          ///< linear: could be eliminated, until chosen
  std::vector<double> margin_m_;    ///< by block: how far it is from another state; negative: it has no other
  AlignedVector<double> delta_m_, factor_, weights_;
  std::vector<Group> groups_;
  std::vector<int> chosen_, kept_, new_row_;
  std::vector<Direction> eliminated_;
};

}  // namespace insula
