// SPDX-License-Identifier: GPL-3.0-or-later
// A step's problem cut down to what one message carries, without changing what the tools feel.
#pragma once
#include <vector>

#include "core/constraint/problem.h"

namespace insula {

/// Returns `full` itself where it has at most max_rows rows. Otherwise it writes `small` and returns that; each block
/// then has one of three fates:
///   kept        those that touch a tool or what it carries, then those that are coupled to them and may soon change
///   their state, in their order eliminated  what no tool touches, in a state in which its law is a linear equation
///   delta_E + C lambda_E = 0: pressure, springs,
///               fibres in tension, contacts that press or stick, and of friction that slips the direction across it,
///               which turns with the slip: C = |delta_t| / |lambda_t|. Exactly, by the Schur complement
///                 W'          = W_KK - W_KE (W_EE + C)^-1 W_EK
///                 delta_free' = what gives the kept rows the delta of the full problem at its lambda
///   held        lambda stays what it is: rows at a bound (separated contacts, slack fibres), friction along its slip
///   (its bound follows
///               the normal force, which no symmetric W' can say), rows that hang on others (pivots near 0), and those
///               that touch a tool and find no place
/// Eliminating is exact for laws without bounds (bilateral, compliant) wherever the tools go, for the others as long as
/// none changes its state. Laws without bounds are therefore eliminated first; as long as all the other rows fit, the
/// condensed problem is the full one. lambda of `full` must be its solution. Allocates when sizes grow, and when the
/// tools' Jacobians change theirs.
class Condenser {
 public:
  const ConstraintProblem& operator()(const ConstraintProblem& full, int max_rows, ConstraintProblem& small);

  /// Beyond this, the least coupled are held: the cost grows with the cube.
  static constexpr int max_eliminated = 400;

 private:
  enum class Fate : char { held, linear, slips, kept };  // slips: of the first of two tangents
  struct Group {  ///< blocks first to last: a patch goes with the contacts it is of
    int first, last, rows;
    bool tool_coupled, linear;
    double rank;
  };
  /// An unknown that is eliminated: a row, or a direction in the plane of two tangents.
  struct Direction {
    int row;  ///< and the next one, where it has a part in that
    double along[2];
    double compliance;
    double free;  ///< delta + compliance lambda of the full solution
  };
  void find_tool_coupled_rows(const ConstraintProblem& full);
  void find_states(const ConstraintProblem& full);
  double state(const ConstraintProblem& full, const Block& block);
  void make_groups(const ConstraintProblem& full);
  void choose(const ConstraintProblem& full, int max_rows, ConstraintProblem& small);
  void copy_kept(const ConstraintProblem& full, ConstraintProblem& small) const;
  void add_eliminated(const ConstraintProblem& full, const Block& block);
  void eliminate(const ConstraintProblem& full, ConstraintProblem& small);

  std::vector<char> tool_coupled_;  ///< by row of the full problem
  std::vector<char> is_weld_;       ///< by row: between a tool and what it carries
  std::vector<Fate> fate_;          ///< linear: could be eliminated, until chosen
  std::vector<double> margin_m_;    ///< by block: how far it is from another state; negative: it has no other
  AlignedVector<double> delta_m_, factor_, weights_;
  std::vector<Group> groups_;
  std::vector<int> chosen_, kept_;
  std::vector<Direction> eliminated_;
};

}  // namespace insula
