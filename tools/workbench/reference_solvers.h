// SPDX-License-Identifier: GPL-3.0-or-later
// Solvers that others wrote, behind our interface: what ours is measured against and tested with. No exercise runs on
// them. Both factorise in double precision and compute W by solving for all columns of H^T, as one would who has only
// the library.
#pragma once
#include <memory>

#include "core/linalg/compliance_solver.h"

namespace insula {

/// CHOLMOD's supernodal LL^T with its own choice of ordering, on one thread whatever OpenMP would like.
std::unique_ptr<ComplianceSolver> make_cholmod_solver();
/// Eigen's SimplicialLDLT with AMD.
std::unique_ptr<ComplianceSolver> make_eigen_solver();
/// The BLAS that CHOLMOD calls here: file and folder.
std::string blas_library();

}  // namespace insula
