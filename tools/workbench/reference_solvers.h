// SPDX-License-Identifier: GPL-3.0-or-later
// Solvers that others wrote, behind our interface: what ours is measured against and tested with. No exercise runs on
// them. They factorise in double precision and compute W with the functions of their library.
#pragma once
#include <memory>

#include "core/linalg/compliance_solver.h"
#include "tools/workbench/cholmod_library.h"

namespace insula {

enum class ReferenceW {
  full,     ///< X = A^-1 H^T by a full solve of all columns, then W = H X
  forward,  ///< Y = L^-1 P H^T by a forward solve of all columns, then W = Y^T Y by dsyrk
};

/// CHOLMOD's supernodal LL^T with its own choice of ordering, on one thread. Its solves take dense right-hand sides:
/// for a supernodal factor cholmod_spsolve makes them dense as well, and none follows the reach of the rows.
std::unique_ptr<ComplianceSolver> make_cholmod_solver(std::shared_ptr<const CholmodLibrary> library, ReferenceW w);
/// Eigen's SimplicialLDLT with AMD, full solves.
std::unique_ptr<ComplianceSolver> make_eigen_solver();

}  // namespace insula
