// SPDX-License-Identifier: GPL-3.0-or-later
// Batches of elements against formulas written out with Eigen: rotations, force and tangents; the same on every
// instruction set.
#include <gtest/gtest.h>

#include <Eigen/Eigenvalues>
#include <cstring>
#include <limits>

#include "core/base/random.h"
#include "core/linalg/instruction_set.h"
#include "core/testing/held.h"
#include "plugins/corotational_fem/compression_barrier.h"
#include "plugins/corotational_fem/polar.h"

namespace insula {
INSULA_TABLES(ElementKernels, element_table)
namespace {

std::vector<const ElementKernels*> every_set() {
  std::vector<const ElementKernels*> out;
  for (const auto set : {InstructionSet::sse2, InstructionSet::avx2, InstructionSet::avx512})
    if (processor_has(set)) out.push_back(every_element_table().table[std::size_t(set)]);
  return out;
}

Vec3 any(Random& r) { return Vec3(r.uniform(-1, 1), r.uniform(-1, 1), r.uniform(-1, 1)); }

/// Eight elements with four nodes each, whose F is what the test asks for.
struct Batch {
  ElementBatch e{};
  ElementWork work{};
  std::vector<double> x = std::vector<double>(3 * 4 * batch_lanes, 0.0);
  explicit Batch(int count = batch_lanes) {
    e.count = count;
    for (int l = 0; l < batch_lanes; ++l) {
      for (int k = 0; k < 4; ++k) e.node[k][l] = 4 * l + k;
      e.volume[l] = 1e-9 * (1 + l);
      for (int k = 0; k < 10; ++k) e.slot[k][l] = 10 * l + k;
      set(l, Mat3::Identity(), Mat3::Identity());
      guess(l, Quat::Identity());
    }
  }
  /// F, and the rest edges as columns.
  void set(int l, const Mat3& f, const Mat3& edges) {
    const Mat3 b = edges.inverse(), now = f * edges;
    for (int k = 0; k < 3; ++k)
      for (int c = 0; c < 3; ++c) {
        e.b[k][c][l] = b(k, c);
        x[std::size_t(3 * (4 * l + k + 1) + c)] = now(c, k) + 0.25;
        x[std::size_t(3 * 4 * l + c)] = 0.25;
      }
  }
  void guess(int l, const Quat& q) { e.q[0][l] = q.w(), e.q[1][l] = q.x(), e.q[2][l] = q.y(), e.q[3][l] = q.z(); }
  Mat3 r(int l) const { return matrix_of_lane(work.r, l); }
};

/// Symmetric positive, principal stretches between 0.2 and 2.2.
Mat3 stretch(Random& random) {
  const Mat3 axes = from_rotation_vector(any(random)).toRotationMatrix();
  return axes * Vec3(Vec3::Constant(1.2) + any(random)).asDiagonal() * axes.transpose();
}

TEST(ElementBatch, FindsTheRotationFromNearby) {
  for (const ElementKernels* kernel : every_set()) {
    Random random(1);
    for (int trial = 0; trial < 300; ++trial) {
      Batch b;
      Mat3 expected[batch_lanes];
      for (int l = 0; l < batch_lanes; ++l) {
        const Quat turn = from_rotation_vector(3 * any(random));
        expected[l] = turn.toRotationMatrix();
        b.set(l, expected[l] * stretch(random), Mat3::Identity());
        b.guess(l, (from_rotation_vector(0.3 * any(random)) * turn).normalized());
      }
      const unsigned failed = kernel->rotate(b.e, b.x.data(), b.work);
      for (int l = 0; l < batch_lanes; ++l) {
        if (failed >> l & 1) b.work.r[0][l] = 2;  // seen below
        EXPECT_TRUE(test::held("rotation of a stretched element", (b.r(l) - expected[l]).norm(), 1, 2e-13))
            << trial << " lane " << l;
        EXPECT_LT(
            (Quat(b.work.q[0][l], b.work.q[1][l], b.work.q[2][l], b.work.q[3][l]).toRotationMatrix() - b.r(l)).norm(),
            1e-14);
      }
    }
  }
}

TEST(ElementBatch, SaysWhereTheRotationIsFarOff) {
  Random random(3);
  int failures = 0;
  for (int trial = 0; trial < 300; ++trial) {
    Batch b;
    Mat3 expected[batch_lanes];
    for (int l = 0; l < batch_lanes; ++l) {
      expected[l] = from_rotation_vector(3 * any(random)).toRotationMatrix();
      b.set(l, expected[l] * stretch(random), Mat3::Identity());
    }
    const unsigned failed = element_kernels().rotate(b.e, b.x.data(), b.work);
    for (int l = 0; l < batch_lanes; ++l) {
      failures += int(failed >> l & 1);
      const Mat3 r = failed >> l & 1 ? rotation_by_svd(matrix_of_lane(b.work.f, l)) : b.r(l);
      EXPECT_LT((r - expected[l]).norm(), 1e-12);
    }
  }
  EXPECT_GT(failures, 100);
}

TEST(ElementBatch, InvertedAndFlatElementsGetAProperRotation) {
  Random random(2);
  for (int trial = 0; trial < 500; ++trial) {
    Mat3 f;
    f << any(random), any(random), any(random);
    if (trial % 5 == 0) f.col(1) = f.col(0);
    if (trial % 50 == 0) f.setZero();
    Batch b;
    b.set(3, f, Mat3::Identity());
    const bool failed = element_kernels().rotate(b.e, b.x.data(), b.work) >> 3 & 1;
    const Mat3 r = failed ? rotation_by_svd(f) : b.r(3);
    EXPECT_TRUE(r.allFinite());
    EXPECT_TRUE(test::held("det R = 1, of inverted and flat ones too", std::abs(r.determinant() - 1), 1, 1e-12));
    EXPECT_LT((r.transpose() * r - Mat3::Identity()).norm(), 1e-12);
    const Mat3 s = r.transpose() * f;
    if (std::abs(f.determinant()) > 1e-2) {
      EXPECT_LT((s - s.transpose()).norm(), 1e-10) << trial;
    }
    Eigen::SelfAdjointEigenSolver<Mat3> eigen(
        Mat3(0.5 * (s + s.transpose())));  // one stretch at most is negative, the least in size
    if (!failed) {
      EXPECT_GE(eigen.eigenvalues()[0] + eigen.eigenvalues()[1], -1e-9) << trial;
    }
  }
}

TEST(ElementBatch, AnElementDoesNotDependOnItsCompanions) {
  for (const ElementKernels* kernel : every_set()) {
    Random random(5);
    const Mat3 f = from_rotation_vector(0.4 * any(random)).toRotationMatrix() * stretch(random);
    Batch alone, crowd;
    for (int l = 0; l < batch_lanes; ++l) {
      if (l != 2) crowd.set(l, from_rotation_vector(any(random)).toRotationMatrix() * stretch(random), stretch(random));
      if (l == 6) crowd.set(l, Mat3::Zero(), Mat3::Identity());
    }
    alone.set(2, f, Mat3::Identity());
    crowd.set(2, f, Mat3::Identity());
    EXPECT_EQ(kernel->rotate(alone.e, alone.x.data(), alone.work) >> 2 & 1,
              kernel->rotate(crowd.e, crowd.x.data(), crowd.work) >> 2 & 1);
    for (int k = 0; k < 9; ++k) EXPECT_EQ(alone.work.r[k][2], crowd.work.r[k][2]);
  }
}

/// The formulas of corotational_fem.cpp, for one element: force of four nodes, 12x12 tangent, energy.
struct Plain {
  Eigen::Matrix<double, 12, 1> force;
  Eigen::Matrix<double, 12, 12> k;
  double energy;
  Plain(const Mat3& r, const Mat3& s, const Mat3& b, double volume, const ElementMaterial& m, double scale,
        SpinTerm spin) {
    const Mat3 e = s - Mat3::Identity();
    energy = volume * (m.mu * e.squaredNorm() + 0.5 * m.lambda * e.trace() * e.trace() - m.swelling_stress * e.trace());
    const Mat3 p = r * (2 * m.mu * e + (m.lambda * e.trace() - m.swelling_stress) * Mat3::Identity());
    Vec3 rest[4], g[4];
    rest[0].setZero();
    for (int i = 1; i < 4; ++i) rest[i] = b.row(i - 1), rest[0] -= rest[i];
    for (int i = 0; i < 4; ++i) g[i] = r * rest[i], force.segment<3>(3 * i) = -volume * p * rest[i];
    Eigen::SelfAdjointEigenSolver<Mat3> eigen(s);
    Vec3 resists;
    for (int i = 0; i < 3; ++i) {
      const double stress = 2 * m.mu - m.lambda * e.trace() + m.swelling_stress;
      resists[i] = 2 * m.mu - 2 * stress / (s.trace() - eigen.eigenvalues()[i]);
      if (spin == SpinTerm::positive) resists[i] = std::max(0.0, resists[i]);
      if (spin == SpinTerm::none) resists[i] = 0;
    }
    const Mat3 v = r * eigen.eigenvectors(), turn = v * resists.asDiagonal() * v.transpose();
    for (int i = 0; i < 4; ++i)
      for (int j = 0; j < 4; ++j)
        k.block<3, 3>(3 * i, 3 * j) =
            scale * volume *
            (m.mu * (g[i].dot(g[j]) * Mat3::Identity() + g[j] * g[i].transpose()) + m.lambda * g[i] * g[j].transpose() +
             0.5 * skew(g[i]).transpose() * turn * skew(g[j]));
  }
};

TEST(ElementBatch, ForceTangentAndEnergyAreThoseOfTheFormulas) {
  const double infinity = std::numeric_limits<double>::infinity();
  for (const ElementKernels* kernel : every_set())
    for (const SpinTerm spin : {SpinTerm::none, SpinTerm::exact, SpinTerm::positive}) {
      Random random(7);
      for (int trial = 0; trial < 60; ++trial) {
        Batch b(trial % 3 == 0 ? 5 : batch_lanes);  // a last batch that is not full
        const ElementMaterial m{700, 6500, infinity, trial % 4 == 1 ? 0.0 : 800 * (trial % 4 - 2)};
        Mat3 r[batch_lanes], s[batch_lanes];
        for (int l = 0; l < batch_lanes; ++l) {
          r[l] = from_rotation_vector(0.5 * any(random)).toRotationMatrix();
          s[l] = trial == 1 ? Mat3(Mat3::Identity()) : stretch(random);
          b.set(l, r[l] * s[l], 0.01 * (from_rotation_vector(any(random)).toRotationMatrix() * stretch(random)));
          b.guess(l, Quat(r[l]));
        }
        ASSERT_EQ(kernel->rotate(b.e, b.x.data(), b.work), 0u);
        std::vector<double> force(b.x.size(), 0.0), values(9 * 10 * batch_lanes, 0.0);
        EXPECT_EQ(kernel->force(b.e, m, b.work, force.data()), 0u);
        kernel->stiffness(b.e, m, b.work, 1.7, spin, values.data());
        for (int l = 0; l < batch_lanes; ++l) {
          Mat3 gradients;
          for (int i = 0; i < 9; ++i) gradients(i / 3, i % 3) = b.e.b[i / 3][i % 3][l];
          const Plain plain(r[l], s[l], gradients, l < b.e.count ? b.e.volume[l] : 0, m, 1.7, spin);
          const Eigen::Map<const Eigen::Matrix<double, 12, 1>> found(force.data() + 12 * l);
          const double size = b.e.volume[l] * m.lambda * gradients.norm();  // of a force at a strain of one
          EXPECT_LE((found - plain.force).norm(), 1e-11 * plain.force.norm() + 1e-13 * size) << trial << " lane " << l;
          for (int i = 0, k = 0; i < 4; ++i)
            for (int j = 0; j <= i; ++j, ++k) {
              const Eigen::Map<const Mat3> block(values.data() + 9 * (10 * l + k));
              EXPECT_LE((block - plain.k.block<3, 3>(3 * i, 3 * j)).norm(), 1e-11 * plain.k.norm())
                  << trial << " lane " << l << " block " << k;
            }
        }
        EXPECT_EQ(kernel->energy(b.e, m, b.work), 0u);
        for (int l = 0; l < b.e.count; ++l) {
          Mat3 gradients;
          for (int i = 0; i < 9; ++i) gradients(i / 3, i % 3) = b.e.b[i / 3][i % 3][l];
          const double expected = Plain(r[l], s[l], gradients, b.e.volume[l], m, 1, spin).energy;
          EXPECT_NEAR(b.work.out[0][l], expected, 1e-11 * std::abs(expected) + 1e-13 * b.e.volume[l] * m.lambda);
        }
      }
    }
}

TEST(ElementBatch, NamesTheLanesThatMayBeCrushed) {
  Batch b;
  b.set(1, Vec3(1, 1, 0.3).asDiagonal(), Mat3::Identity());
  b.set(5, Vec3(1, 1, 0.5).asDiagonal(), Mat3::Identity());
  std::vector<double> force(b.x.size(), 0.0);
  element_kernels().rotate(b.e, b.x.data(), b.work);
  EXPECT_EQ(element_kernels().force(b.e, {1, 1, 0.6 * 0.6}, b.work, force.data()), 2u);
  EXPECT_EQ(element_kernels().energy(b.e, {1, 1, 0.6 * 0.6}, b.work), 2u);
}

}  // namespace
}  // namespace insula
