// SPDX-License-Identifier: GPL-3.0-or-later
// Problem files: what was written comes back to the bit; what is damaged is refused with its reason.
#include "core/constraint/problem_file.h"

#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <fstream>

#include "core/base/input_error.h"
#include "tests/physics/random_problem.h"

namespace insula {
namespace {

namespace fs = std::filesystem;

class ProblemFile : public ::testing::Test {
 protected:
  void SetUp() override {
    folder_ = fs::temp_directory_path() /
              ("insula_" + std::string(::testing::UnitTest::GetInstance()->current_test_info()->name()));
    fs::create_directories(folder_);
    file_ = folder_ / "a.problem";
  }
  void TearDown() override { fs::remove_all(folder_); }

  std::string refusal() const {
    try {
      read_problem(file_);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  }
  void write_bytes(const std::string& bytes) const { std::ofstream(file_, std::ios::binary) << bytes; }
  std::string bytes() const {
    std::ifstream in(file_, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
  }

  fs::path folder_, file_;
};

TEST_F(ProblemFile, ComesBackToTheBit) {
  Random random(7);
  for (int trial = 0; trial < 50; ++trial) {
    ConstraintProblem p = test::random_problem(random, 0.5);
    for (double& l : p.lambda) l = random.uniform(-1, 1);
    write_problem(file_, p);
    const ConstraintProblem q = read_problem(file_);
    EXPECT_EQ(q.rows, p.rows);
    EXPECT_EQ(q.w, p.w);
    EXPECT_EQ(q.delta_free, p.delta_free);
    EXPECT_EQ(q.lambda, p.lambda);
    ASSERT_EQ(q.blocks.size(), p.blocks.size());
    for (std::size_t k = 0; k < p.blocks.size(); ++k) EXPECT_TRUE(q.blocks[k] == p.blocks[k]) << "block " << k;
  }
  EXPECT_EQ(problem_files(folder_), std::vector<fs::path>{file_});
}

TEST_F(ProblemFile, EveryTruncationIsRefused) {
  Random random(9);
  write_problem(file_, test::random_problem(random, 0.5));
  const std::string whole = bytes();
  for (std::size_t n = 0; n < whole.size(); n += n < 100 ? 1 : 37) {
    write_bytes(whole.substr(0, n));
    ASSERT_NE(refusal(), "") << n;
  }
  write_bytes(whole + "x");
  EXPECT_NE(refusal(), "");
}

TEST_F(ProblemFile, DamageIsNamed) {
  Random random(11);
  const ConstraintProblem good = test::random_problem(random, 0.5);
  const auto with = [&](auto&& damage) {
    ConstraintProblem p = good;
    damage(p);
    write_problem(file_, p);
    return refusal();
  };
  const auto has = [](const std::string& text, const char* part) {
    return text.find(part) != std::string::npos && text.find("a.problem") != std::string::npos;
  };
  EXPECT_PRED2(has, with([](auto& p) { p.w[0] = std::nan(""); }), "W");
  EXPECT_PRED2(has, with([](auto& p) { p.w[0] = -1; }), "negative diagonal");
  EXPECT_PRED2(has, with([](auto& p) { p.delta_free[1] = infinite; }), "delta_free of row 1");
  EXPECT_PRED2(has, with([](auto& p) { p.lambda[0] = 1e300; }), "lambda of row 0");
  EXPECT_PRED2(has, with([](auto& p) { p.blocks[0].compliance = -1; }), "block 0: compliance");
  EXPECT_PRED2(has, with([](auto& p) { p.blocks[0].lower = 1, p.blocks[0].upper = 0; }), "bounds out of order");
  EXPECT_PRED2(has, with([](auto& p) { p.blocks[0].friction = std::nan(""); }), "friction");
  EXPECT_PRED2(has, with([](auto& p) { p.blocks[0].normals = 3; }), "block 0");
  EXPECT_PRED2(has, with([](auto& p) { p.blocks[0].law = LawKind(9); }), "unknown law");
  EXPECT_PRED2(has, with([](auto& p) { p.blocks.pop_back(); }), "cover");
  write_bytes("INSULAP1" + std::string(8, '\x7f'));
  EXPECT_PRED2(has, refusal(), "rows");
  write_bytes("hello, this is text");
  EXPECT_PRED2(has, refusal(), "no constraint problem");
  EXPECT_THROW(read_problem(folder_ / "none.problem"), InputError);
  EXPECT_THROW(problem_files(folder_ / "none"), InputError);
  EXPECT_THROW(write_problem(folder_ / "none" / "a.problem", good), InputError);
}

}  // namespace
}  // namespace insula
