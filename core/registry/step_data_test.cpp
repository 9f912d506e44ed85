// SPDX-License-Identifier: GPL-3.0-or-later
// Declarations of channels, drawables and events: what is taken, what is refused, and what a scene says of materials.
#include <gtest/gtest.h>

#include <cmath>

#include "core/registry/registry.h"
#include "core/sim/simulation.h"

namespace insula {
namespace {

template <class Declare>
std::string refusal(Declare declare) {
  Component owner;
  try {
    declare(&owner);
  } catch (const std::logic_error& e) {
    return e.what();
  }
  return "";
}

TEST(Channel, KnowsItsUnitsAndBounds) {
  Component owner;
  Channel<Pressure> p(&owner,
                      {.name = "p", .doc = "d", .min = "0 mmHg", .max = "300 mmHg", .display = "mmHg", .digits = 1});
  EXPECT_TRUE(std::isnan(p()));
  p.set(13332.2387415);
  EXPECT_EQ(p.text(p()), "100.0 mmHg");
  EXPECT_NEAR(*p.max(), 300 * 133.322387415, 1e-9);
  Channel<Scalar> share(&owner, {.name = "share", .doc = "d", .display = "%", .digits = 0});
  EXPECT_EQ(share.text(0.25), "25 %");
  EXPECT_EQ(share.text(-1e-9), "0 %");
  EXPECT_EQ(owner.channels().size(), 2u);
}

TEST(Channel, OfAGroupIsNamedByIt) {
  Component owner;
  ChannelGroup<FlowRate> flow(&owner, {.name = "flow", .doc = "d"});
  EXPECT_TRUE(flow.groups().empty());
  flow.declare({"superior", "inferior"});
  flow.set(1, 2e-6);
  EXPECT_EQ(flow.name(1), "inferior.flow");
  owner.id = "network";
  ChannelTable table;
  table.collect({&owner});
  std::vector<double> values;
  table.read(values);
  ASSERT_EQ(table.entries().size(), 2u);
  EXPECT_EQ(table.entries()[1].id, "network.inferior.flow");
  EXPECT_TRUE(std::isnan(values[0]));
  EXPECT_EQ(values[1], 2e-6);
}

TEST(Channel, RefusesAWrongDeclaration) {
  EXPECT_NE(refusal([](Component* c) { Channel<Force> x(c, {.name = "a.b", .doc = "d"}); }).find("dots"),
            std::string::npos);
  EXPECT_NE(refusal([](Component* c) { Channel<Force> x(c, {.name = "a", .doc = ""}); }).find("doc"),
            std::string::npos);
  EXPECT_NE(refusal([](Component* c) { Channel<Force> x(c, {.name = "a", .doc = "d", .max = "3 mm"}); }).find("mm"),
            std::string::npos);
  EXPECT_NE(refusal([](Component* c) {
              Channel<Force> x(c, {.name = "a", .doc = "d", .display = "mmHg"});
            }).find("no unit of force"),
            std::string::npos);
  EXPECT_NE(refusal([](Component* c) {
              Channel<Force> x(c, {.name = "a", .doc = "d", .min = "2 N", .max = "1 N"});
            }).find("minimum"),
            std::string::npos);
  EXPECT_NE(refusal([](Component* c) { Points x(c, {.name = "a", .doc = "d", .material = ""}); }).find("material"),
            std::string::npos);
  EXPECT_NE(refusal([](Component* c) {
              Polylines x(c, {.name = "a", .doc = "d", .material = "m", .radius = "0 mm"});
            }).find("radius"),
            std::string::npos);
  EXPECT_NE(refusal([](Component* c) { EventKind x(c, {.name = "two words", .doc = "d"}); }).find("one word"),
            std::string::npos);
}

class Thread final : public Constraint {
 public:
  Param<MaterialName> material{this, {.name = "material", .fallback = "steel", .doc = "for tests"}};
  Polylines line{this, {.name = "line", .doc = "for tests", .material = "steel"}};
  void prepare(PrepareContext&) override { line.set_material(material()); }
  void build(const StepContext&, ConstraintBuilder&) override {}
};

std::string messages(const std::string& scene) {
  Registry registry;
  register_builtin(registry);
  registry.add<Thread>("thread", Kind::constraint, "for tests");
  return load_simulation_text(scene, "/s.xml", registry, 1).diagnostics.format();
}

TEST(Materials, OfASceneAreFoundByName) {
  EXPECT_EQ(messages(R"(<scene><material id="silk" style="fibre" colour="1 1 0.9"/><thread material="silk"/></scene>)"),
            "");
  EXPECT_EQ(messages(R"(<scene><thread/></scene>)"), "");
}

TEST(Materials, AWrongNameIsALocatedErrorWithTheNearest) {
  const std::string text = messages("<scene>\n<material id=\"silk\"/>\n<thread material=\"silkk\"/></scene>");
  EXPECT_NE(text.find("s.xml:3:"), std::string::npos) << text;
  EXPECT_NE(text.find("did you mean \"silk\"?"), std::string::npos) << text;
  EXPECT_NE(messages("<scene><material style=\"fibre\"/></scene>").find("needs an id"), std::string::npos);
}

}  // namespace
}  // namespace insula
