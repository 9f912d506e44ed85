// SPDX-License-Identifier: GPL-3.0-or-later
// Contract of rigid bodies with links.
#include <gtest/gtest.h>

#include "core/testing/contracts.h"
#include "core/testing/example.h"

namespace insula::test {

void check_rigid_body(const std::filesystem::path& scene, const std::string& element) {
  auto s = load(scene);
  ASSERT_TRUE(s);
  run_script(*s, 20);
  int found = 0;
  for (Body* body : s->bodies()) {
    auto* tool = dynamic_cast<RigidBody*>(body);
    if (!tool || tool->element != element) continue;
    ++found;
    const Pose pose = tool->link_pose(0);
    const double opening = tool->opening();
    for (int link = 0; link < tool->links(); ++link) {
      SCOPED_TRACE(tool->id + ", link " + std::to_string(link));
      ASSERT_FALSE(tool->link_pieces(link).empty()) << "nothing to touch with";
      const MaterialPoint p = tool->link_point(link, tool->link_pieces(link).front().points.front());
      EXPECT_LT((tool->position(p) - tool->link_pose(link).apply(p.local)).norm(), 1e-15);
      const Vec3 d(0.6, -0.48, 0.64);
      BodyRows rows;
      rows.clear();
      rows.open(0);
      tool->add_row(rows, p, d);
      VecX h = VecX::Zero(3 * tool->blocks());
      for (std::size_t e = 0; e < rows.block.size(); ++e) h.segment<3>(3 * rows.block[e]) += rows.coeff[e];
      double free = 0;
      tool->compute_compliance(rows);
      tool->add_free_motion(rows, &free);
      EXPECT_NEAR(free, d.dot(tool->free_displacement(p)), 1e-12) << "H dq of the free motion";
      for (int k = 0; k < 3 * tool->blocks(); ++k) {
        const auto moved = [&](double by) {
          Vec6 change = Vec6::Zero();
          if (k < 6) change[k] = by;
          tool->place(displaced(pose, change), opening + (k == 6 ? by : 0));
          const double x = d.dot(tool->position(p));
          tool->place(pose, opening);
          return x;
        };
        EXPECT_NEAR((moved(1e-5) - moved(-1e-5)) / 2e-5, h[k], 1e-9) << "degree of freedom " << k;
      }
    }
  }
  EXPECT_GT(found, 0) << "its example holds no <" << element << ">";
  check_rows(scene, element, true);
}

}  // namespace insula::test
