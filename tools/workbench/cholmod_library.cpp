// SPDX-License-Identifier: GPL-3.0-or-later
// Loads CHOLMOD into link namespaces.
#include "tools/workbench/cholmod_library.h"

#include <dlfcn.h>

#include <stdexcept>

namespace insula {
namespace {

namespace fs = std::filesystem;

std::string last_error() {
  const char* text = ::dlerror();
  return text ? text : "unknown failure of the loader";
}

/// File and folder of the library that holds an address.
fs::path file_of(void* address) {
  Dl_info info{};
  if (!address || !::dladdr(address, &info) || !info.dli_fname) return {};
  std::error_code error;
  const fs::path file = fs::canonical(info.dli_fname, error);
  return error ? fs::path(info.dli_fname) : file;
}

void* open_in(Lmid_t space, const fs::path& file) {
  void* handle = ::dlmopen(space, file.c_str(), RTLD_NOW | RTLD_LOCAL);
  if (!handle) throw std::runtime_error(last_error());
  return handle;
}

template <class F>
void find(void* library, const char* name, F& function, bool required = true) {
  function = reinterpret_cast<F>(::dlsym(library, name));
  if (!function && required) throw std::runtime_error(last_error());
}

std::string description(void* library) {
  char* (*config)() = nullptr;
  find(library, "openblas_get_config", config, false);
  if (config) {
    std::string text = config();
    while (!text.empty() && text.back() == ' ') text.pop_back();
    return text;
  }
  const fs::path file = file_of(::dlsym(library, "dgemm_"));
  return (file.parent_path().filename() / file.filename()).string();
}

}  // namespace

InstalledBlas installed_blas() {
  InstalledBlas out;
  const fs::path folder = file_of(reinterpret_cast<void*>(&cholmod_start)).parent_path();
  const auto look = [&](const std::string& name, const std::vector<const char*>& folders, const std::string& package) {
    for (const char* f : folders)
      if (fs::exists(folder / f / "libblas.so.3")) {
        out.found.push_back({name, folder / f});
        return;
      }
    out.missing.push_back(name + " is not installed (Debian package " + package +
                          "); --blas FOLDER names one elsewhere");
  };
  look("reference BLAS", {"blas"}, "libblas3");
  look("OpenBLAS", {"openblas-pthread", "openblas-serial", "openblas-openmp"}, "libopenblas0-pthread");
  return out;
}

std::shared_ptr<const CholmodLibrary> load_cholmod(const fs::path& folder) {
  const fs::path file = file_of(reinterpret_cast<void*>(&cholmod_start));
  auto out = std::make_shared<CholmodLibrary>();
  Lmid_t space = LM_ID_NEWLM;
  if (!folder.empty()) {
    // CHOLMOD then finds its libblas.so.3 and liblapack.so.3 loaded already.
    if (::dlinfo(open_in(LM_ID_NEWLM, folder / "libblas.so.3"), RTLD_DI_LMID, &space) != 0)
      throw std::runtime_error(last_error());
    const fs::path own = folder / "liblapack.so.3";
    open_in(space, fs::exists(own) ? own : folder.parent_path() / "lapack" / "liblapack.so.3");
  }
  void* library = open_in(space, file);
  find(library, "cholmod_start", out->start);
  find(library, "cholmod_finish", out->finish);
  find(library, "cholmod_analyze", out->analyze);
  find(library, "cholmod_factorize", out->factorize);
  find(library, "cholmod_solve2", out->solve2);
  find(library, "cholmod_free_dense", out->free_dense);
  find(library, "cholmod_free_factor", out->free_factor);
  find(library, "dsyrk_", out->dsyrk);
  find(library, "omp_set_max_active_levels", out->set_levels, false);
  void (*set_threads)(int) = nullptr;
  find(library, "openblas_set_num_threads", set_threads, false);
  if (set_threads) set_threads(1);
  out->blas = description(library);
  return out;
}

}  // namespace insula
