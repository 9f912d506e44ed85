// SPDX-License-Identifier: GPL-3.0-or-later
// A shipped clip closes on the neck of a shipped aneurysm: its walls meet, and rows keep their names while nothing
// moves.
#include <fmt/format.h>
#include <gtest/gtest.h>

#include <algorithm>
#include <set>

#include "core/mechanics/shell_body.h"
#include "core/testing/example.h"
#include "plugins/clip/clip.h"
#include "plugins/contact/contact.h"
#include "plugins/self_contact/self_contact.h"

namespace insula {
namespace {

// The wall of scenes/parts/artery.xml under a pressure that does not pulsate; the clip closes across the neck as slowly
// as an applier lets it: one that snaps shut within two steps is thrown off.
const char* const scene =
    R"(<scene time_step="16.6667 ms"><solver max_sweeps="150" tolerance="1e-7 m" conjugate="true"/>
<shell_body id="artery" tangent_tolerance="0.1" wall="../../meshes/arteries/anterior_superior/vessel.json">
<membrane regions="parent superior inferior ends" thickness="0.3 mm" young="1.5 MPa" added_mass="1 kg/m2"/>
<membrane regions="neck" thickness="0.25 mm" young="1.2 MPa" added_mass="1 kg/m2"/>
<membrane regions="sac" thickness="0.2 mm" young="1.05 MPa" added_mass="1 kg/m2"/>
<membrane regions="bleb" thickness="0.1 mm" young="1.05 MPa" added_mass="1 kg/m2"/>
<anchor_springs regions="parent superior inferior" stiffness="1 kPa/mm"/>
<surface id="wall" material="vessel" thickness="0.3 mm"/></shell_body>
<pressure on="artery" systolic="93 mmHg" diastolic="93 mmHg"/>
<self_contact id="lumen" on="wall" thickness="0.22 mm" friction="0" max_contacts="40" spacing="0.8 mm" alarm="0.3 mm"/>
<clip id="straight" model="../../meshes/clips/straight/straight.urdf" start="field" home="{} {} {} mm" shaft="{} {} {}" flat="{} {} {}" start_opening="0.24 rad"/>
<contact id="blades" between="artery straight" friction="0.35" contact_geometry="vertices" patch="1.5 mm" max_contacts="60" alarm="0.12 mm" max_correction="0.1 mm"/></scene>)";

std::set<std::uint64_t> ids(const Simulation& s) {
  std::set<std::uint64_t> out;
  for (const Block& k : s.problem().blocks) out.insert(k.id);
  return out;
}

TEST(SelfContactNeck, RowsOfAClippedNeckKeepTheirNamesAtRest) {
  // Neck of vessel.json: the clip comes within its plane, along the component of the approach in that plane.
  const Vec3 centre(48.2289, 15.2891, -8.7169), normal = Vec3(0.682702, 0.160636, 0.712821).normalized();
  const Vec3 shaft = Vec3(0.678615, 0.222318, -0.700041).normalized(), flat = normal.cross(shaft).normalized();
  const Vec3 tip = centre + 0.4 * normal - 2.6 * shaft;
  auto s = test::load_text(
      fmt::format(fmt::runtime(scene), tip[0], tip[1], tip[2], shaft[0], shaft[1], shaft[2], flat[0], flat[1], flat[2]),
      std::filesystem::path(INSULA_SOURCE_DIR) / "scenes" / "training" / "neck.xml");
  ASSERT_TRUE(s);
  const auto* clip = s->scene().find_as<Clip>("straight");
  const auto* self = s->scene().find_as<SelfContact>("lumen");
  const auto* shell = s->scene().find_as<ShellBody>("artery");
  for (int i = 0; i < 240; ++i) {
    s->step();
    ASSERT_TRUE(s->report().finite) << i;
  }
  EXPECT_TRUE(clip->touched());
  EXPECT_GT(clip->force(), 1.0);
  ASSERT_GE(self->contacts().size(), 3u) << "the neck's walls have not met";
  const auto before = ids(*s);
  const VecX at = shell->q();
  ASSERT_GE(before.size(), 20u);
  std::size_t least = before.size(), most = 0;
  for (int i = 0; i < 60; ++i) {
    s->step();
    const auto now = ids(*s);
    std::size_t kept = 0;
    for (const std::uint64_t id : now) kept += before.count(id);
    least = std::min(least, kept);
    most = std::max(most, now.size());
  }
  ASSERT_LT((shell->q() - at).cwiseAbs().maxCoeff(), 20e-6) << "it moves";
  EXPECT_GE(double(least), 0.9 * double(before.size()));
  EXPECT_GE(double(least), 0.9 * double(most)) << "rows that come and go";
  RecordProperty("rows", int(before.size()));
  RecordProperty("kept", int(least));
}

}  // namespace
}  // namespace insula
