// SPDX-License-Identifier: GPL-3.0-or-later
// The comparison of solvers: all of them on the same step, near the same answer; the borrowed ones keep the interface's
// promises.
#include <gtest/gtest.h>

#include <algorithm>
#include <nlohmann/json.hpp>
#include <sstream>

#include "core/linalg/opencl_solver.h"
#include "tools/workbench/reference_solvers.h"
#include "tools/workbench/workbench.h"

namespace insula {
namespace {

BenchOptions strands() {
  BenchOptions options;
  options.scene = std::filesystem::path(INSULA_SOURCE_DIR) / "plugins/strand_springs/example.xml";
  options.motion = "none";
  return options;
}

TEST(BenchSolvers, EverySolverAgreesOnTheSameStep) {
  Registry registry;
  register_builtin(registry);
  std::ostringstream out, err;
  BenchOptions options = strands();
  options.threads = 1;
  options.json = true;
  options.rows = 12;
  ASSERT_EQ(cmd_bench_solvers({registry, out, err}, options), 0) << err.str();
  const auto j = nlohmann::json::parse(out.str());
  for (const char* rate : {"peak_f64", "peak_f32", "product_f64", "product_f32", "read"})
    EXPECT_GT(j["machine"][rate].get<double>(), 1e6) << rate;
  ASSERT_FALSE(j["bodies"].empty());
  int rows = 0;
  for (const auto& body : j["bodies"]) {
    rows += body["rows"].get<int>();
    EXPECT_LE(body["rows"].get<int>(), 12);
    const std::size_t devices = opencl_devices().empty() ? 0 : 1;
    ASSERT_EQ(body["solvers"].size(), 3 + devices + 2 * j["blas"].size());
    for (const auto& s : body["solvers"]) {
      const std::string name = s["solver"];
      const double tolerance = name.find("single") != std::string::npos ? 1e-4 : 1e-11;
      EXPECT_LT(s["solve_error"].get<double>(), tolerance) << name;
      EXPECT_LT(s["w_error"].get<double>(), tolerance) << name;
      for (const char* key : {"factor_ms", "solve_ms", "w_ms", "w_again_ms", "factor_flops", "solve_bytes",
                              "factor_share_of_product", "solve_share_of_read"}) {
        EXPECT_GT(s[key].get<double>(), 0) << name << ' ' << key;
        EXPECT_LT(s[key].get<double>(), 1e12) << name << ' ' << key;
      }
    }
  }
  EXPECT_GT(rows, 0);
  ASSERT_FALSE(j["blas"].empty());
  for (const auto& blas : j["blas"]) {
    // A column says which BLAS it really used.
    const std::string name = blas["name"], library = blas["library"];
    EXPECT_FALSE(library.empty()) << name;
    EXPECT_EQ(name == "OpenBLAS", library.starts_with("OpenBLAS")) << name << ": " << library;
    int columns = 0;
    for (const auto& s : j["bodies"][0]["solvers"])
      columns += s["solver"].get<std::string>().starts_with("CHOLMOD, " + name);
    EXPECT_EQ(columns, 2) << name;
  }
  const bool open =
      std::any_of(j["blas"].begin(), j["blas"].end(), [](const auto& b) { return b["name"] == "OpenBLAS"; });
  EXPECT_EQ(j["remarks"].dump().find("OpenBLAS is not installed") == std::string::npos, open) << j["remarks"];
}

// A brick in place of a scene: our own solvers, and a device where there is one.
TEST(BenchSolvers, ABrickOfSoManyNodesIsMeasured) {
  Registry registry;
  register_builtin(registry);
  std::ostringstream out, err;
  BenchOptions options;
  options.threads = 1;
  options.json = true;
  options.nodes = 343;
  ASSERT_EQ(cmd_bench_solvers({registry, out, err}, options), 0) << err.str();
  const auto j = nlohmann::json::parse(out.str());
  ASSERT_EQ(j["bodies"].size(), 2U);
  EXPECT_EQ(j["bodies"][0]["nodes"].get<int>(), 343 - 49) << "one layer is fixed";
  EXPECT_GT(j["bodies"][0]["rows"].get<int>(), 20);
  const std::vector<std::string> devices = opencl_devices();
  ASSERT_EQ(j["bodies"][0]["solvers"].size(), devices.empty() ? 2U : 3U);
  if (!devices.empty()) {
    EXPECT_EQ(j["bodies"][0]["solvers"][2]["solver"], "OpenCL, " + devices.front());
  }
  for (const auto& s : j["bodies"][0]["solvers"]) EXPECT_LT(s["w_error"].get<double>(), 1e-4);
}

TEST(BenchSolvers, AFolderWithoutABlasIsRefused) {
  Registry registry;
  register_builtin(registry);
  std::ostringstream out, err;
  BenchOptions options = strands();
  options.blas = std::filesystem::path(INSULA_SOURCE_DIR) / "docs";
  EXPECT_EQ(cmd_bench_solvers({registry, out, err}, options), 2);
  EXPECT_NE(err.str().find("libblas.so.3"), std::string::npos) << err.str();
}

TEST(BenchSolvers, BorrowedSolversSayWhenAMatrixIsIndefinite) {
  BlockMatrix a;
  a.set_pattern(2, {{0, 1}});
  const auto cholmod = load_cholmod({});
  for (const auto& [name, s] : {std::pair{"CHOLMOD", std::shared_ptr(make_cholmod_solver(cholmod, ReferenceW::full))},
                                {"Eigen", std::shared_ptr(make_eigen_solver())}}) {
    s->analyse(a);
    for (double pivot : {3.0, -3.0, 3.0}) {
      for (int i = 0; i < 3; ++i) {
        a.block(a.diagonal(0))[4 * i] = 2;
        a.block(a.diagonal(1))[4 * i] = pivot;
        a.block(a.slot(1, 0))[4 * i] = 1;
      }
      EXPECT_EQ(s->factorise(a), pivot > 0) << name;
      if (pivot < 0) continue;
      double x[6] = {1, 0, 0, 0, 0, 0};
      s->solve(x);
      EXPECT_NEAR(x[0], 0.6, 1e-15) << name;
      EXPECT_NEAR(x[3], -0.2, 1e-15) << name;
    }
  }
}

}  // namespace
}  // namespace insula
