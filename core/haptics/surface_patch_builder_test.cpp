// SPDX-License-Identifier: GPL-3.0-or-later
// Patches of a real exercise: their compliance against that of the step's own contacts, and no effect on the step.
#include "core/haptics/surface_patch_builder.h"

#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cmath>

#include "core/constraint/solve.h"
#include "core/haptics/condense.h"
#include "core/haptics/contact_frame_prediction.h"
#include "core/haptics/haptic_update.h"
#include "core/sim/motion.h"
#include "core/testing/example.h"
#include "engine/live/command_script.h"

namespace insula {
namespace {

/// Exercise 1 with the right hand's tool led onto a lobe by a motion for haptic tests.
class SurfacePatchBuilderTest : public ::testing::Test {
 protected:
  void SetUp() override { load("1_sylvian_fissure", "drag"); }
  void load(const std::string& scene, const std::string& motion) {
    const std::filesystem::path root = INSULA_SOURCE_DIR;
    motion_ = load_motion(root / "scenes/haptics" / (motion + ".csv"));
    auto loaded = load_simulation(root / "scenes/training" / (scene + ".xml"), test::builtin(), 1);
    ASSERT_TRUE(loaded.simulation) << loaded.diagnostics.format();
    s_ = std::move(loaded.simulation);
    s_->set_collision_horizon(2 * s_->h());
  }
  void step() {
    for (int hand = 0; hand < 2; ++hand) {
      if (!motion_.has(hand)) continue;
      const HandSample at = motion_.at(hand, s_->time() + s_->h());
      s_->set_hand(hand, {true, at.pose, at.button1, at.button2});
    }
    s_->step();
  }
  /// Steps until a contact presses that the patches replace.
  const ConstraintProblem* pressed() {
    while (s_->time() < motion_.duration()) {
      step();
      const ConstraintProblem& p = build_(*s_, 200);
      build_.compute_modes();
      for (const ReplacedContact& r : p.patches.replaced)
        if (p.lambda[std::size_t(r.row)] > 5e-3) return &p;
    }
    return nullptr;
  }
  /// A problem reaches the servo only if its message is accepted.
  void expect_message(const ConstraintProblem& problem) {
    HapticUpdate update, got;
    update.step_s = s_->h();
    const std::array<bool, 2> none{};
    ASSERT_TRUE(encode_problem(update, condense_(problem, 200, condensed_), none, bytes_));
    ASSERT_TRUE(decode_problem(bytes_, got, why_)) << s_->time() << " s: " << why_;
    ASSERT_LT(bytes_.size(), 120'000u) << s_->time() << " s";
  }
  Condenser condense_;
  ConstraintProblem condensed_;
  std::vector<std::uint8_t> bytes_;
  std::string why_;
  Motion motion_;
  std::unique_ptr<Simulation> s_;
  SurfacePatchBuilder build_;
};

double by_tools(const ConstraintProblem& p, int i, int j) {
  double sum = 0;
  for (const ToolTerms& t : p.tools) sum += t.jacobian.row(i) * t.compliance * t.jacobian.row(j).transpose();
  return sum;
}

TEST_F(SurfacePatchBuilderTest, ReplacedContactsFollowFromTheVertices) {
  const ConstraintProblem* found = pressed();
  ASSERT_TRUE(found);
  const ConstraintProblem& p = *found;
  const SurfacePatches& s = p.patches;
  ASSERT_LE(p.rows, 240);
  ASSERT_FALSE(s.replaced.empty());
  int compared = 0;
  for (const SurfacePatch& patch : s.patches)
    for (int k = patch.first_replaced; k < patch.first_replaced + patch.replaced; ++k) {
      const ReplacedContact& r = s.replaced[std::size_t(k)];
      const auto& corner = s.triangles[std::size_t(r.triangle)].corner;
      for (int axis = 0; axis < 3; ++axis) {
        const Vec3 d = p.tools[std::size_t(patch.tool)].jacobian.block<1, 3>(r.row + axis, 0).transpose();
        // H of the contact on the surface is -d b_i at each corner, so its W with any row is that of the corners.
        for (int j = 0; j < p.rows; ++j) {
          double w = by_tools(p, r.row + axis, j);
          for (std::size_t i = 0; i < 3; ++i)
            if (const int row = s.vertices[std::size_t(corner[i])].row; row >= 0)
              for (int a = 0; a < 3; ++a) w -= r.bary[long(i)] * d[a] * p.w_at(row + a, j);
          EXPECT_NEAR(w, p.w_at(r.row + axis, j), 1e-9 * p.w_at(r.row + axis, r.row + axis));
          ++compared;
        }
      }
    }
  EXPECT_GT(compared, 100);
  // Vertices are where the step left them: their rows' delta is 0.
  AlignedVector<double> delta;
  full_delta(p, {p.delta_free.data(), std::size_t(p.rows)}, p.lambda.data(), delta);
  for (const Block& b : p.blocks)
    if (b.role == BlockRole::surface) {
      EXPECT_NEAR(delta[std::size_t(b.row)], 0, 1e-15);
      EXPECT_EQ(p.lambda[std::size_t(b.row)], 0);
      EXPECT_GT(p.w_at(b.row, b.row), 0);
      EXPECT_GT(p.retardation_time[std::size_t(b.row)], 0);
    }
}

/// What modes leave of W must not push back by itself, although they are those of the factor of the step before.
TEST_F(SurfacePatchBuilderTest, ModesLeaveAPositiveRestOfTheCompliance) {
  const ConstraintProblem* found = pressed();
  ASSERT_TRUE(found);
  const ConstraintProblem& p = *found;
  ASSERT_FALSE(p.reduced.empty());
  std::vector<int> rows;
  for (const PatchVertex& v : p.patches.vertices)
    for (int k = 0; k < 3 && v.row >= 0; ++k) rows.push_back(v.row + k);
  const long n = long(rows.size());
  MatX rest(n, n), whole(n, n);
  for (long i = 0; i < n; ++i)
    for (long j = 0; j < n; ++j) {
      const auto a = std::size_t(rows[std::size_t(i)]), b = std::size_t(rows[std::size_t(j)]);
      whole(i, j) = rest(i, j) = p.w_at(int(a), int(b));
      for (std::size_t s = 0; s < p.reduced.modes.size(); ++s) rest(i, j) -= p.reduced.row(a)[s] * p.reduced.row(b)[s];
    }
  EXPECT_LT(rest.trace(), 0.5 * whole.trace()) << "modes have most of it";
  EXPECT_GT(Eigen::SelfAdjointEigenSolver<MatX>(rest).eigenvalues().minCoeff(), -1e-3 * whole.diagonal().maxCoeff());
}

TEST_F(SurfacePatchBuilderTest, TheStepDoesNotDependOnPatches) {
  std::vector<std::uint64_t> hashes[2];
  for (const bool patches : {false, true}) {
    s_->reset();
    std::size_t built = 0;
    for (int k = 0; k < 60; ++k) {
      step();
      if (patches) built += !build_(*s_, 200).reduced.empty();
      if (patches) build_.compute_modes();
      hashes[patches].push_back(s_->state_hash());
    }
    EXPECT_EQ(built > 20, patches) << built;
  }
  EXPECT_EQ(hashes[0], hashes[1]);
}

TEST_F(SurfacePatchBuilderTest, AStepWithAClipDoesNotDependOnPatches) {
  load("3_clipping", "clip");
  std::vector<std::uint64_t> hashes[2];
  for (const bool patches : {false, true}) {
    s_->reset();
    CommandScript script(motion_.commands());
    for (int k = 0; s_->time() < motion_.duration(); ++k) {
      script.advance(*s_);
      step();
      if (patches) expect_message(build_(*s_, 200));
      if (patches) build_.compute_modes();
      hashes[patches].push_back(s_->state_hash());
    }
  }
  for (std::size_t k = 0; k < hashes[0].size(); ++k) ASSERT_EQ(hashes[0][k], hashes[1][k]) << k;
}

TEST_F(SurfacePatchBuilderTest, EveryMessageOfAnExerciseIsAccepted) {
  // Both hands part the lobes and cut strands, which are rows of two bodies.
  load("1_sylvian_fissure", "../training/1_sylvian_fissure_steady");
  CommandScript script(motion_.commands());
  ContactFramePrediction predict;
  int modelled = 0;
  while (s_->time() < 12) {
    script.advance(*s_);
    step();
    const ConstraintProblem& p = build_(*s_, 200);
    modelled += p.reduced.groups.size() > 1;
    expect_message(predict(*s_, p, 3e-3));
    if (HasFatalFailure()) return;
    build_.compute_modes();
  }
  EXPECT_GT(modelled, 100);
}

TEST_F(SurfacePatchBuilderTest, CondensedProblemsKeepThePatchesOfTheRowsThatStay) {
  const ConstraintProblem* full = pressed();
  ASSERT_TRUE(full);
  Condenser condense;
  ConstraintProblem small;
  const SurfacePatches& before = full->patches;
  condense(*full, full->rows - 12, small);
  ASSERT_EQ(small.patches.patches.size(), before.patches.size());
  EXPECT_FALSE(small.reduced.empty());
  for (std::size_t v = 0; v < before.vertices.size(); ++v) {
    if (before.vertices[v].row < 0) continue;
    const int row = small.patches.vertices[v].row;
    ASSERT_GE(row, 0);
    const Block* block = nullptr;
    for (const Block& b : small.blocks)
      if (b.row == row) block = &b;
    ASSERT_TRUE(block);
    EXPECT_EQ(block->role, BlockRole::surface);
    EXPECT_EQ(small.patches.vertices[v].position, before.vertices[v].position);
  }
  // With no room for all vertices, patches go. A contact then stays that of the step. For any number of rows, what is
  // left is whole.
  for (int rows = 3; rows < full->rows; ++rows) {
    condense(*full, rows, small);
    HapticUpdate update, got;
    update.problem = small;
    update.step_s = small.step_s;
    std::vector<std::uint8_t> bytes;
    std::string why;
    ASSERT_TRUE(encode_problem(update, bytes));
    ASSERT_TRUE(decode_problem(bytes, got, why)) << rows << ": " << why;
  }
  condense(*full, 30, small);
  EXPECT_TRUE(small.patches.empty());
}

}  // namespace
}  // namespace insula
