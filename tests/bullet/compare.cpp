// SPDX-License-Identifier: GPL-3.0-or-later
// Bullet's convex distance beside ours: time, accuracy and repeatability. Prints the table of docs/libraries.md; no
// part of a test run.
#include <fmt/format.h>

#include <chrono>
#include <cstring>

#include "core/collision/shapes/gjk.h"
#include "tests/bullet/pairs.h"

namespace insula::bullet {
namespace {

constexpr int count = 4000, repeats = 15;

struct Case {
  Pair pair;
  btConvexHullShape a, b;
  explicit Case(const Pair& p) : pair(p), a(hull(p.a)), b(hull(p.b)) {}
};

/// Least time of `repeats` runs, ns a pair.
template <class F>
double time(const std::vector<Case>& cases, F f) {
  double least = 1e300;
  for (int k = 0; k < repeats; ++k) {
    const auto start = std::chrono::steady_clock::now();
    for (const Case& c : cases) f(c);
    least = std::min(least, std::chrono::duration<double, std::nano>(std::chrono::steady_clock::now() - start).count());
  }
  return least / double(cases.size());
}

double doubt(const Pair& p, double d, const Vec3& a, const Vec3& b) {
  return d > 0 ? d - apart(p, (a - b).normalized()) : 0;
}

void compare(const char* name, int kind) {
  Random random(std::uint64_t(kind) + 1);
  std::vector<Case> cases;
  for (int i = 0; i < count; ++i) cases.emplace_back(random_pair(random, kind));
  double sum = 0;
  const double ours = time(cases, [&](const Case& c) { sum += hull_distance(c.pair.a, c.pair.b).distance; });
  const double bullet =
      time(cases, [&](const Case& c) { sum += distance(c.a, c.b, scaled(c.pair.a[0] - c.pair.b[0])).distance; });
  double off = 0, bullet_off = 0;
  int wrong = 0, starts = 0;
  for (const Case& c : cases) {
    const HullDistance d = hull_distance(c.pair.a, c.pair.b);
    off = std::max(off, doubt(c.pair, d.distance, d.a, d.b));
    const Answer b = distance(c.a, c.b, scaled(c.pair.a[0] - c.pair.b[0])),
                 other = distance(c.a, c.b, scaled(Vec3(0.3 * unit, 0.5 * unit, -0.7 * unit)));
    const double d2 = doubt(c.pair, b.distance, b.a, b.b);
    bullet_off = std::max(bullet_off, d2);
    wrong += d2 > 1e-9;
    starts += std::memcmp(&b.distance, &other.distance, sizeof(double)) != 0;
  }
  fmt::print("| {} | {:.0f} | {:.0f} | {:.2f} | {:.1e} | {:.1e} | {} of {} | {} |\n", name, ours, bullet, bullet / ours,
             off * 1e9, bullet_off * 1e9, wrong, count, starts);
  if (sum < 0) fmt::print("never\n");
}

/// Cores that meet: angle between EPA's direction out and the line between the middles, which tool against tool uses.
void compare_depths() {
  Random random(9);
  int meeting = 0;
  double longer = 0;
  std::vector<Case> cases;
  while (meeting < 2000) {
    Pair p = random_pair(random, 5);
    if (hull_distance(p.a, p.b).distance > 0) continue;
    Vec3 middle = Vec3::Zero(), n;
    for (const Vec3& x : p.a) middle += x / double(p.a.size());
    for (const Vec3& x : p.b) middle -= x / double(p.b.size());
    double d = 0;
    if (!depth(hull(p.a), hull(p.b), scaled(p.a[0] - p.b[0]), d, n) || !(d > 0)) continue;
    ++meeting;
    longer += -apart(p, middle.normalized()) / d / 2000;
    cases.emplace_back(p);
  }
  const double ns = time(cases, [&](const Case& c) {
    double d;
    Vec3 n;
    depth(c.a, c.b, scaled(c.pair.a[0] - c.pair.b[0]), d, n);
  });
  fmt::print(
      "hulls that meet: the way out along the middles is {:.2f} times EPA's on the mean; EPA takes {:.0f} ns a pair\n",
      longer, ns);
}

}  // namespace
}  // namespace insula::bullet

int main() {
  using namespace insula::bullet;
  fmt::print(
      "| pair | ours, ns | Bullet, ns | ratio | ours off by at most, nm | Bullet off by at most, nm | Bullet off by "
      "more than 1 nm | other bits from another start |\n");
  fmt::print("|---|---|---|---|---|---|---|---|\n");
  const char* names[6] = {"sphere, triangle", "capsule, triangle", "hull, triangle",
                          "sphere, hull",     "capsule, hull",     "hull, hull"};
  for (int kind = 0; kind < 6; ++kind) compare(names[kind], kind);
  compare_depths();
}
