// SPDX-License-Identifier: GPL-3.0-or-later
// The reduced dynamic model of a problem from which rows are eliminated.
//
// Eliminated rows are linear springs, delta_E + C lambda_E = 0, so they belong to the system between the kept rows. Its
// matrix is A' = A + H_E^T C^-1 H_E. The modes become V' = A'^-1 A V. With Z = U^-T g_E and Y = U^-T W_EK of
// core/haptics/condense.cpp,
//   S = V'^T A' V' = 1 - Z^T Z,   g' = g_K - Y^T Z,   M' = S diag(m) S
// M' is that of the part of V' which lies in the space of V; so is the damping, of which only the part in each new mode
// is used. New modes are orthogonal in A' and M' again. All bodies then form one group.
#pragma once
#include <cstddef>

#include "core/constraint/reduced_model.h"

namespace insula {

/// Z and Y row by row: `rows` of `width` numbers, Y from `kept_at` on and Z from `modes_at` on.
struct EliminatedRows {
  const double* data;
  std::size_t rows, width, kept_at, modes_at;
};

/// Changes the model of the `kept` rows, whose participations are those of the full problem. At most
/// ReducedModel::max_modes_of_body modes stay: those that move the rows most.
void condense_modes(const EliminatedRows& eliminated, std::size_t kept, ReducedModel& model);

}  // namespace insula
