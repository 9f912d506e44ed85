// SPDX-License-Identifier: GPL-3.0-or-later
// Contacts found in each tick: equal to the step's contact where that stays, and to the closed form where it does not.
#include "haptic_server/patch_contacts.h"

#include <gtest/gtest.h>

#include <cmath>

#include "core/collision/shapes/shapes_for_test.h"
#include "haptic_server/patched_problem_for_test.h"
#include "haptic_server/servo.h"

namespace insula {
namespace {

using testing::ball_tool;
using testing::patched_radius_m;
using testing::soft_triangle;
using testing::SoftVertex;

ServoSettings exact() {
  ServoSettings s;
  s.substep = {.substep_compliance = true, .extrapolate_tissue = true, .incremental_slip = true, .find_contacts = true};
  s.tolerance_m = 1e-15;
  s.max_sweeps = 2000;
  s.max_operations = 1e9;
  return s;
}

ServoInput at(const Vec3& p) {
  ServoInput in;
  in.device[1].p = p;
  in.connected[1] = true;
  return in;
}

TEST(PatchContacts, AContactThatStaysGivesTheForceOfItsRows) {
  const SoftVertex vertex;
  const Vec3 centre(0, 0, patched_radius_m);
  for (const double load : {0.0, 0.01}) {
    const ConstraintProblem rows = soft_triangle(vertex, centre, 1.0 / 60, 0.3, true, load),
                            patch = soft_triangle(vertex, centre, 1.0 / 60, 0.3, false, load);
    Servo by_rows(exact()), by_patch(exact());
    by_rows.set_problem(&rows, {}, 3e-3);
    by_patch.set_problem(&patch, {}, 3e-3);
    for (int k = 1; k < 40; ++k) {
      const ServoInput in = at(centre - Vec3(0, 0, 5e-5 * k));
      const Vec3 a = by_rows.tick(in).hand[1].force, b = by_patch.tick(in).hand[1].force;
      EXPECT_NEAR((a - b).norm(), 0, 1e-9) << "tick " << k << ", " << a.transpose() << " and " << b.transpose();
      EXPECT_GT(a.z(), 0.01);
    }
  }
}

TEST(PatchContacts, AnOverlapWithTissueIsUndoneWithinAStep) {
  // The hand stands still and tissue is overlapped by 0.2 mm, since the step's own contact was off by so much. Rows
  // undo it in a tick, with a force that tissue answers slowly; patches do so at the rate of the engine.
  const SoftVertex vertex;
  const double h = 1.0 / 60;
  const Vec3 centre(0, 0, patched_radius_m - 0.2e-3);
  const ConstraintProblem patch = soft_triangle(vertex, centre, h, 0.3, false);
  Servo servo(exact());
  servo.set_problem(&patch, {}, 1e-3);
  double most = 0;
  for (int k = 0; k < 200; ++k) most = std::max(most, servo.tick(at(centre)).hand[1].force.z());
  // At rest, tool and tissue share the displacement as springs do.
  const double soft = 3 * vertex.stiffness, both = 300 * soft / (300 + soft);
  EXPECT_NEAR(servo.tick(at(centre)).hand[1].force.z(), both * 0.2e-3, 0.02 * both * 0.2e-3);
  EXPECT_LT(most, 1.25 * both * 0.2e-3);
}

/// Two rigid planes that meet at x = 0 and rise to both sides by an angle: a valley, or a ridge for a negative one.
ConstraintProblem rigid_roof(double angle, const Vec3& centre) {
  ConstraintProblem p;
  p.resize(0);
  p.step_s = 1.0 / 60;
  p.tools.push_back(ball_tool(centre, 0));
  const double a = 10e-3, z = a * std::tan(angle);
  testing::add_patch(p, {{-a, -a, z}, {0, -a, 0}, {0, a, 0}, {-a, a, z}, {a, -a, z}, {a, a, z}},
                     {{0, 1, 2}, {0, 2, 3}, {1, 4, 5}, {1, 5, 2}}, 1e-9);
  return p;
}

/// The place of a ball without friction on an isotropic spring: the feasible point nearest to the device.
Vec3 on_roof(double angle, const Vec3& device) {
  const Vec3 n[2] = {Vec3(std::sin(angle), 0, std::cos(angle)), Vec3(-std::sin(angle), 0, std::cos(angle))};
  Vec3 best = device;
  double least = 1e300;
  const auto offer = [&](const Vec3& x) {
    for (const Vec3& m : n)
      if (m.dot(x) < patched_radius_m - 1e-12) return;
    if ((x - device).norm() < least) {
      least = (x - device).norm();
      best = x;
    }
  };
  offer(device);
  for (const Vec3& m : n) offer(device + (patched_radius_m - m.dot(device)) * m);
  offer(Vec3(0, device.y(), patched_radius_m / std::cos(angle)));
  return best;
}

// One problem only: the normals of the step would be those of the first plane throughout.
TEST(PatchContacts, ABallCrossesAValleyAsTheClosedFormSays) {
  const double angle = 0.3;
  const auto device = [&](int k) {
    return Vec3(-4e-3 + 4e-5 * k, 0, 1e-3 - 2e-7 * k + 0.3 * std::abs(-4e-3 + 4e-5 * k));
  };
  const ConstraintProblem p = rigid_roof(angle, device(0));
  ServoSettings settings = exact();
  Servo servo(settings);
  servo.set_problem(&p, {}, 1e-3);
  double peak = 0;
  for (int k = 0; k <= 200; ++k) {
    const Vec3 force = servo.tick(at(device(k))).hand[1].force;
    const Vec3 expected = 300 * (on_roof(angle, device(k)) - device(k));
    EXPECT_NEAR((force - expected).norm(), 0, 1e-6)
        << "tick " << k << ": " << force.transpose() << " and " << expected.transpose();
    peak = std::max(peak, force.norm());
  }
  EXPECT_GT(peak, 0.01);
}

TEST(PatchContacts, ForcesOfAClosedPathDoNoWorkWithoutFriction) {
  const double angle = 0.3;  // the ball touches both planes at places that are farther apart than `spacing`
  const auto device = [&](int k) {
    const double t = 2 * M_PI * k / 4000;
    return Vec3(3e-3 * std::sin(t), 1e-3 * std::cos(t), 0.8e-3 + 0.1e-3 * std::cos(2 * t));
  };
  const ConstraintProblem p = rigid_roof(angle, device(0));
  Servo servo(exact());
  servo.set_problem(&p, {}, 1e-3);
  double work = 0, stored = 0;
  Vec3 last = servo.tick(at(device(0))).hand[1].force;
  for (int k = 1; k <= 4000; ++k) {
    const Vec3 force = servo.tick(at(device(k))).hand[1].force;
    work += 0.5 * (force + last).dot(device(k) - device(k - 1));
    stored = std::max(stored, force.squaredNorm() / 600);
    last = force;
  }
  EXPECT_GT(stored, 1e-6);
  EXPECT_NEAR(work, 0, 1e-4 * stored);
}

constexpr double round_m = 1.5e-3;

/// A rigid sphere or a tube about y, of this radius: as few triangles on the side of +z.
struct Round {
  bool sphere;
  std::vector<Vec3> vertices, normals;
  std::vector<std::array<int, 3>> triangles;

  Round(bool is_sphere, const TriMesh& all, double least_z) : sphere(is_sphere) {
    std::vector<int> number(all.vertices.size(), -1);
    for (const auto& t : all.triangles) {
      Vec3 middle = Vec3::Zero();
      for (const int v : t) middle += all.vertices[std::size_t(v)] / 3;
      if (middle.z() < least_z) continue;
      auto& to = triangles.emplace_back();
      for (std::size_t k = 0; k < 3; ++k) {
        const auto v = std::size_t(t[k]);
        if (number[v] < 0) {
          number[v] = int(vertices.size());
          vertices.push_back(all.vertices[v]);
          normals.push_back(out(all.vertices[v]));
        }
        to[k] = number[v];
      }
    }
  }
  /// From the axis or the centre, unit.
  Vec3 out(const Vec3& p) const { return (sphere ? p : Vec3(p.x(), 0, p.z())).normalized(); }
};

Round round_tube() {
  TriMesh all = shapes::tube(round_m, 16, 5, 0.8e-3, 0);
  for (Vec3& v : all.vertices) v = Vec3(v.y(), v.z(), v.x());
  return {false, all, 0};
}

Round round_sphere() { return {true, shapes::sphere(Vec3::Zero(), round_m, 3), 0.72 * round_m}; }

// The facets are 29 um high on the tube, which are 9 mN on this coupling.
TEST(PatchContacts, ABallDrawnAlongACurvedSurfaceFeelsItsCurvatureWithoutFacets) {
  for (const Round& round : {round_tube(), round_sphere()}) {
    const double reach = round_m + patched_radius_m, depth = 0.1e-3;
    const double most = round.sphere ? 0.5 : 1.2;  // radians to each side
    const auto device = [&](double a) {
      const double turned = 0.2 + 0.4 * a;  // the path is oblique
      const Vec3 p = (reach - depth) * Vec3(std::sin(a), 0, std::cos(a));
      return round.sphere ? Vec3(p.x() * std::cos(turned), p.x() * std::sin(turned), p.z())
                          : Vec3(p + 1e-3 * Vec3(0, a, 0));
    };
    ConstraintProblem p;
    p.resize(0);
    p.step_s = 1.0 / 60;
    p.tools.push_back(ball_tool(device(-most), 0));
    testing::add_patch(p, round.vertices, round.triangles, 1e-9);
    p.patches.patches[0].curved = 1;
    for (std::size_t v = 0; v < round.normals.size(); ++v) p.patches.vertices[v].weighted_normal = round.normals[v];
    Servo servo(exact());
    servo.set_problem(&p, {}, 1e-3);
    double least = 1e300, largest = 0, work = 0;
    Vec3 last = servo.tick(at(device(-most))).hand[1].force;
    const int ticks = 4000;
    for (int k = 1; k <= 2 * ticks; ++k) {  // there and back
      const auto angle = [&](int i) { return most * (1 - std::abs(2.0 * (i - ticks) / ticks)); };
      const Vec3 x = device(angle(k)), force = servo.tick(at(x)).hand[1].force;
      least = std::min(least, force.norm());
      largest = std::max(largest, force.norm());
      EXPECT_LT(force.normalized().cross(round.out(x)).norm(), 0.02) << k;
      work += 0.5 * (force + last).dot(x - device(angle(k - 1)));
      last = force;
    }
    EXPECT_LT(largest - least, 0.3e-3) << (round.sphere ? "sphere" : "tube");
    EXPECT_NEAR(0.5 * (largest + least), 300 * depth, 0.02 * 300 * depth);
    // A tick's normal is that of the tick before, which is first order in the length of a tick.
    EXPECT_NEAR(work, 0, 5e-5 * 300 * depth * 4 * most * reach);
  }
}

}  // namespace
}  // namespace insula
