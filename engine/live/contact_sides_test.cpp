// SPDX-License-Identifier: GPL-3.0-or-later
// A frame names both sides of each contact, and the bundle says what they are.
#include "engine/live/contact_sides.h"

#include <gtest/gtest.h>

#include <set>

#include "core/testing/block_mesh.h"
#include "core/testing/example.h"
#include "engine/live/frame.h"
#include "engine/live/shown_contacts.h"

namespace insula {
namespace {

using SidesJson = nlohmann::ordered_json;

/// A tool that stands on the floor, another one that stands on a soft block, and a third one on the first.
std::unique_ptr<Simulation> three_contacts(test::SceneFolder& folder) {
  TriMesh floor;
  floor.vertices = {{-0.05, -0.05, 0}, {0.05, -0.05, 0}, {0, 0.05, 0}};
  floor.triangles = {{0, 1, 2}};
  folder.write("meshes/floor.obj", test::obj_text(floor));
  folder.write("meshes/block.msh",
               test::gmsh_text(test::block_mesh({2, 2, 2}, {0.015, -0.005, 0.001}, {0.025, 0.005, 0.011})));
  folder.write("meshes/tool/probe.urdf", test::test_tool_urdf(0.001));
  folder.write("meshes/tool/tool.json", test::test_tool_json(0.001, 0));
  return test::load_text(R"(<scene>
  <obstacle id="rim"><surface id="rim_face" mesh="meshes/floor.obj" mesh_unit="m" material="bone"/></obstacle>
  <soft_body id="pad" mesh="meshes/block.msh" mesh_unit="m"><corotational_fem/><fixed region="beyond" centre="0 0 2 mm" normal="0 0 -1"/>
    <surface id="pad_face" material="cortex"/></soft_body>
  <retractor id="arm" hand="none" model="meshes/tool/probe.urdf" home="20 0 11 mm" shaft="0 0 1" flat="1 0 0"/>
  <dissector id="first" hand="right" model="meshes/tool/probe.urdf" home="0 0 0.5 mm" shaft="0 0 1" flat="1 0 0"/>
  <dissector id="other" hand="left" model="meshes/tool/probe.urdf" home="0 0 2.4 mm" shaft="0 0 1" flat="1 0 0"/>
  <contact between="first other rim"/>
  <contact between="arm pad"/>
</scene>)",
                         folder.path() / "scene.xml");
}

TEST(ContactSides, AreNamedInFramesAndDescribedInTheBundle) {
  test::SceneFolder folder;
  const auto simulation = three_contacts(folder);
  ASSERT_TRUE(simulation);
  simulation->step();
  const SidesJson sides = contact_sides_json(*simulation);
  ASSERT_EQ(sides.size(), 5u) << "three tools, two surfaces";
  for (std::size_t i = 0; i < sides.size(); ++i) EXPECT_EQ(sides[i].at("number"), i);
  insula_lcm::render_frame_t frame{};
  fill_frame(*simulation, frame);
  ASSERT_EQ(frame.contact_side.size(), std::size_t(frame.contacts));
  std::set<std::set<std::string>> owners;
  for (std::size_t i = 0; i < frame.contact_side.size(); ++i) {
    const ContactPoint& c = simulation->report().contacts[shown_contacts(simulation->report().contacts)[i]];
    const SidesJson& a = sides.at(std::size_t(frame.contact_side[i].at(0)));
    const SidesJson& b = sides.at(std::size_t(frame.contact_side[i].at(1)));
    EXPECT_EQ(a.at("owner"), c.a->id);
    EXPECT_EQ(b.at("owner"), c.b->id);
    owners.insert({c.a->id, c.b->id});
  }
  EXPECT_EQ(owners, (std::set<std::set<std::string>>{{"arm", "pad"}, {"first", "other"}, {"first", "rim"}}));
  const auto of = [&](const std::string& owner) {
    for (const SidesJson& s : sides)
      if (s.at("owner") == owner) return s;
    return SidesJson{};
  };
  EXPECT_EQ(of("rim").at("role"), "fixed");
  EXPECT_EQ(of("rim").at("part"), "rim_face");
  EXPECT_EQ(of("rim").at("material"), "bone");
  EXPECT_EQ(of("pad").at("role"), "deformable");
  EXPECT_EQ(of("pad").at("material"), "cortex");
  EXPECT_EQ(of("arm").at("role"), "instrument");
  EXPECT_EQ(of("arm").at("kind"), "retractor");
  EXPECT_EQ(of("arm").at("material"), simulation->instruments()[0]->tool().parts.at(0).material);
}

TEST(ShownContacts, AreThoseOfHandsAndThenTheStrongest) {
  test::SceneFolder folder;
  const auto simulation = three_contacts(folder);
  ASSERT_TRUE(simulation);
  const auto body = [&](const char* id) { return simulation->scene().find_as<Body>(id); };
  const auto touch = [&](const char* a, const char* b, double force) {
    ContactPoint c;
    c.a = body(a);
    c.b = body(b);
    c.normal_force = force;
    return c;
  };
  // No hand moves the arm. A hand presses the pad less than the arm does, and both hands' tools touch each other.
  const std::vector<ContactPoint> all{
      touch("arm", "pad", 0.2),   touch("arm", "pad", 0.5),     touch("pad", "first", 0.01),
      touch("arm", "pad", 0.5),   touch("rim", "other", 0),     touch("pad", "rim", 0.3),
      touch("first", "other", 1), touch("first", "first", 0.4), touch("arm", "first", 0.02)};
  EXPECT_EQ(shown_contacts(all), (std::vector<std::size_t>{6, 8, 2, 4, 1, 3, 7, 5, 0}));
  EXPECT_EQ(shown_contacts(all, 5), (std::vector<std::size_t>{6, 8, 2, 4, 1})) << "of equals the first one";
  std::vector<ContactPoint> many(300, touch("arm", "pad", 0.5));
  many[299] = touch("first", "pad", 1e-3);
  const std::vector<std::size_t> shown = shown_contacts(many);
  ASSERT_EQ(shown.size(), most_shown_contacts);
  EXPECT_EQ(shown.front(), 299u) << "a weak contact of a hand is shown";
}

TEST(ContactSides, OfWhatIsNotInTheSceneHaveNoNumber) {
  test::SceneFolder folder, elsewhere;
  const auto simulation = three_contacts(folder), other = three_contacts(elsewhere);
  ASSERT_TRUE(simulation && other);
  const ContactSides sides(*simulation);
  EXPECT_EQ(sides.number(*other->instruments()[0], {}), -1);
  EXPECT_EQ(sides.number(*other->bodies()[0], {other->surfaces()[0], 0}), -1);
}

}  // namespace
}  // namespace insula
