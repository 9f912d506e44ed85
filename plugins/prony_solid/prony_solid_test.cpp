// SPDX-License-Identifier: GPL-3.0-or-later
// Relaxation and creep against the closed form of the law as implicit Euler integrates it.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>

#include "core/mechanics/soft_body.h"
#include "core/testing/block_mesh.h"
#include "core/testing/example.h"
#include "core/testing/held.h"

namespace insula {
namespace {

constexpr double length = 0.06, width = 0.02;

std::unique_ptr<Simulation> bar(const test::SceneFolder& folder, const std::string& solid,
                                const std::string& attributes = "") {
  folder.write("meshes/bar.msh",
               test::gmsh_text(test::block_mesh({6, 2, 2}, Vec3::Zero(), Vec3(length, width, width))));
  return test::load_text(fmt::format(R"(<scene time_step="10 ms" gravity="0 0 0 m/s2">
<soft_body id="bar" mesh="meshes/bar.msh" mesh_unit="m" {}><prony_solid {}/>
<fixed region="beyond" centre="0.001 0 0 m" normal="-1 0 0"/></soft_body></scene>)",
                                     attributes, solid),
                         folder.path() / "bar.xml");
}

/// Elastic force, and that of the Maxwell elements as they are now.
std::pair<VecX, VecX> forces(ForceModel& model, const VecX& x) {
  VecX elastic = VecX::Zero(x.size()), viscous = elastic;
  const VecX rest = elastic;
  model.linearise(x.data(), elastic.data(), nullptr, 0, Tangent::system);
  model.linearise_damping(x.data(), rest.data(), viscous.data(), nullptr, 0);
  return {elastic, viscous};
}

TEST(PronySolid, AHeldStrainRelaxesToTheElasticForce) {
  test::SceneFolder folder;
  auto s = bar(folder, R"(young="1 kPa" poisson="0.3" young_1="3 kPa" time_1="40 ms" young_2="2 kPa" time_2="1.5 s")");
  ASSERT_TRUE(s);
  auto& body = *s->scene().find_as<SoftBody>("bar");
  ForceModel& model = *body.forces().front();
  StepContext context;
  context.h = 0.01;
  VecX x = test::deformed(body, 0.3, 1);  // a large strain: the law is exact in Green's
  double worst = 0;
  for (int n = 1; n <= 300; ++n) {
    model.finish(context, x.data());
    const auto [elastic, viscous] = forces(model, x);
    const double expected = 3 * std::pow(1 + context.h / 0.04, -n) + 2 * std::pow(1 + context.h / 1.5, -n);
    worst = std::max(worst, (viscous - expected * elastic).norm() / elastic.norm());
  }
  EXPECT_TRUE(test::held("relaxation, over the elastic force", worst, 1, 1e-10));
  model.reset();
  EXPECT_EQ(forces(model, x).second.norm(), 0);
}

/// Pulls the bar's free end by so many pascals.
void pull(SoftBody& body, double pressure) {
  for (const auto& t : boundary_triangles(body.rest())) {
    const auto at = [&](int k) -> const Vec3& { return body.rest().nodes[std::size_t(t[std::size_t(k)])]; };
    if (std::min({at(0).x(), at(1).x(), at(2).x()}) < length - 1e-6) continue;
    const double area = 0.5 * (at(1) - at(0)).cross(at(2) - at(0)).norm();
    for (const int n : t) body.external[3 * n] += pressure * area / 3;
  }
}

double end_strain(const SoftBody& body) {
  double sum = 0;
  int count = 0;
  for (int i = 0; i < body.nodes(); ++i)
    if (const double rest = body.rest().nodes[std::size_t(i)].x(); rest > length - 1e-6)
      sum += (body.q()[3 * i] - rest) / length, ++count;
  return sum / count;
}

// Hardly any inertia and hardly any strain, so that the bar is the one-dimensional law.
TEST(PronySolid, ABarUnderALoadCreeps) {
  constexpr double young = 5e8, young_1 = 1e9, time = 0.2, strain = 1e-7, h = 0.01;
  for (const char* kept : {"", R"(tangent_tolerance="0.1")"}) {
    test::SceneFolder folder;
    auto s = bar(folder, R"(young="0.5 GPa" poisson="0" density="0.001 g/cm3" young_1="1 GPa" time_1="200 ms")", kept);
    ASSERT_TRUE(s);
    ASSERT_DOUBLE_EQ(s->h(), h);
    auto& body = *s->scene().find_as<SoftBody>("bar");
    pull(body, young * strain);
    const double a = h / time, first = (1 + a) * young / (young_1 + (1 + a) * young),
                 ratio = (young + young_1) / (young + young_1 + a * young);
    double worst = 0;
    for (int n = 1; n <= 400; ++n) {
      s->step();
      worst = std::max(worst, std::abs(end_strain(body) / strain - (1 + (first - 1) * std::pow(ratio, n - 1))));
    }
    EXPECT_TRUE(test::held("creep, over the last strain", worst, 1, 1e-6));
    EXPECT_GT(end_strain(body) / strain, 0.99);
    EXPECT_LT(first, 0.4) << "at first the Maxwell element carries most";
  }
}

}  // namespace
}  // namespace insula
