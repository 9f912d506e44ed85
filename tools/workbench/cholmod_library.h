// SPDX-License-Identifier: GPL-3.0-or-later
// CHOLMOD on a chosen BLAS. Each library has a link namespace of its own (dlmopen), so one process measures several.
#pragma once
#include <cholmod.h>

#include <filesystem>
#include <memory>
#include <string>
#include <vector>

namespace insula {

/// Functions of one loaded CHOLMOD and of its BLAS. It stays loaded until the process ends: a process can load some ten
/// of them.
struct CholmodLibrary {
  std::string blas;  ///< what the BLAS says of itself: "OpenBLAS 0.3.21 ... Cooperlake", or its file

  decltype(&cholmod_start) start = nullptr;
  decltype(&cholmod_finish) finish = nullptr;
  decltype(&cholmod_analyze) analyze = nullptr;
  decltype(&cholmod_factorize) factorize = nullptr;
  decltype(&cholmod_solve2) solve2 = nullptr;
  decltype(&cholmod_free_dense) free_dense = nullptr;
  decltype(&cholmod_free_factor) free_factor = nullptr;
  /// BLAS: C := alpha op(A) op(A)^T + beta C, one triangle.
  void (*dsyrk)(const char* uplo, const char* trans, const int* n, const int* k, const double* alpha, const double* a,
                const int* lda, const double* beta, double* c, const int* ldc) = nullptr;
  /// CHOLMOD starts threads for loops of microseconds. Called before its functions, this keeps the calling thread
  /// alone.
  void one_thread() const {
    if (set_levels) set_levels(0);
  }
  void (*set_levels)(int) = nullptr;
};

struct BlasFolder {
  std::string name;  ///< "reference BLAS"
  std::filesystem::path folder;
};

/// The reference BLAS and OpenBLAS where Debian installs them, beside CHOLMOD. `found` are those that exist; `missing`
/// are sentences on the others.
struct InstalledBlas {
  std::vector<BlasFolder> found;
  std::vector<std::string> missing;
};
InstalledBlas installed_blas();

/// Loads CHOLMOD with libblas.so.3 and liblapack.so.3 of the folder. The reference BLAS has its LAPACK in the folder
/// `lapack` beside it. An empty folder: as the program itself is linked. Throws std::runtime_error with the reason.
std::shared_ptr<const CholmodLibrary> load_cholmod(const std::filesystem::path& folder);

}  // namespace insula
