// SPDX-License-Identifier: GPL-3.0-or-later
// Contract of rigid bodies with links.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include "core/testing/contracts.h"
#include "core/testing/example.h"
#include "core/testing/findings.h"

namespace insula::test {

namespace {

void check_link(Findings& findings, RigidBody& tool, int link) {
  const Pose pose = tool.link_pose(0);
  const double opening = tool.opening();
  if (!findings.expect(!tool.link_pieces(link).empty(), "a link has nothing to touch with")) return;
  const MaterialPoint p = tool.link_point(link, tool.link_pieces(link).front().points.front());
  findings.expect((tool.position(p) - tool.link_pose(link).apply(p.local)).norm() < 1e-15,
                  "position() of a link's point is not where its link is");
  const Vec3 d(0.6, -0.48, 0.64);
  BodyRows rows;
  rows.clear();
  rows.open(0);
  tool.add_row(rows, p, d);
  VecX h = VecX::Zero(3 * tool.blocks());
  for (std::size_t e = 0; e < rows.block.size(); ++e) h.segment<3>(3 * rows.block[e]) += rows.coeff[e];
  double w = 0, free = 0;
  tool.begin_compliance(rows);
  tool.add_response(rows, &w, 1, &free);
  findings.expect(std::abs(free - d.dot(tool.free_displacement(p))) <= 1e-12,
                  "H dq of the free motion is not the point's free displacement");
  for (int k = 0; k < 3 * tool.blocks(); ++k) {
    const auto moved = [&](double by) {
      Vec6 change = Vec6::Zero();
      if (k < 6) change[k] = by;
      tool.place(displaced(pose, change), opening + (k == 6 ? by : 0));
      const double x = d.dot(tool.position(p));
      tool.place(pose, opening);
      return x;
    };
    const double slope = (moved(1e-5) - moved(-1e-5)) / 2e-5;
    findings.expect(std::abs(slope - h[k]) <= 1e-9, "H of a link's point is not the derivative of its position",
                    fmt::format("degree of freedom {}: {:.6g}, expected {:.6g}", k, h[k], slope));
  }
}

}  // namespace

void check_rigid_body(const std::filesystem::path& scene, const std::string& element) {
  auto s = load(scene);
  ASSERT_TRUE(s);
  run_script(*s, 20);
  int found = 0;
  Findings none("<" + element + ">");
  for (Body* body : s->bodies()) {
    auto* tool = dynamic_cast<RigidBody*>(body);
    if (!tool || tool->element != element) continue;
    ++found;
    Findings findings("<" + element + "> " + tool->id);
    for (int link = 0; link < tool->links(); ++link) {
      findings.at("link " + std::to_string(link));
      check_link(findings, *tool, link);
    }
  }
  none.expect(found > 0, "its example holds none of it");
  check_rows(scene, element, true);
}

}  // namespace insula::test
