// SPDX-License-Identifier: GPL-3.0-or-later
// Parameters of every type: values, ranges, fallbacks, messages.
#include "core/params/param.h"

#include <gtest/gtest.h>

#include <stdexcept>

#include "core/registry/component.h"

namespace insula {
namespace {

struct Sample : Component {
  Param<Force> closing_force{
      this, {.name = "closing_force", .fallback = "1.5 N", .min = "0.1 N", .max = "5 N", .doc = "force"}};
  Param<Pressure> young{this, {.name = "young", .min = "1 Pa", .doc = "stiffness"}};
  Param<Length> depth{this, {.name = "depth", .fallback = "1 mm", .max = "10 mm", .doc = "depth"}};
  Param<Scalar> ratio{this,
                      {.name = "ratio", .fallback = "0.45", .min = "0", .max = "0.499", .doc = "Poisson's ratio"}};
  Param<bool> on{this, {.name = "on", .fallback = "true", .doc = "switch"}};
  Param<int> count{this, {.name = "count", .fallback = "3", .min = "1", .max = "100", .doc = "how many"}};
  Param<std::string> text{this, {.name = "text", .fallback = "hello", .doc = "words"}};
  Param<Choice> side{this, {.name = "side", .fallback = "left", .choices = {"left", "right"}, .doc = "hand"}};
  Param<Vec<Length>> at{this, {.name = "at", .fallback = "0 0 0 m", .doc = "place"}};
  Param<Vec<Scalar>> axis{this, {.name = "axis", .fallback = "0 0 1", .min = "-1", .max = "1", .doc = "direction"}};
  Param<LengthUnit> unit{this, {.name = "unit", .fallback = "mm", .doc = "unit of the file"}};
  Param<File> file{this, {.name = "file", .fallback = "", .doc = "a file"}};
  Param<File> needed{this, {.name = "needed", .doc = "a file"}};
  Ref<Component> one{this, {.name = "one", .doc = "a part"}};
  RefList<Component> many{this, {.name = "many", .fallback = "", .doc = "parts"}};
};

std::string set(ParamBase& p, std::string_view text) { return p.assign(text, {"f.xml", 1, 2}); }

TEST(Param, DeclaredOnceKnownEverywhere) {
  Sample s;
  ASSERT_EQ(s.params().size(), 15u);
  EXPECT_EQ(s.params().front(), &s.closing_force);
  EXPECT_EQ(s.find_param("young"), &s.young);
  EXPECT_EQ(s.find_param("yuong"), nullptr);
  EXPECT_TRUE(s.young.required());
  EXPECT_FALSE(s.depth.required());
  EXPECT_EQ(s.young.type_name(), "pressure");
  EXPECT_EQ(s.young.si(), "Pa");
  EXPECT_DOUBLE_EQ(*s.closing_force.min(), 0.1);
  EXPECT_EQ(s.one.type_name(), "reference to a component");
}

TEST(Param, FallbackAndValue) {
  Sample s;
  for (ParamBase* p : s.params()) EXPECT_EQ(p->assign_fallback(), !p->required()) << p->name();
  EXPECT_DOUBLE_EQ(s.closing_force(), 1.5);
  EXPECT_DOUBLE_EQ(s.depth(), 1e-3);
  EXPECT_TRUE(s.on());
  EXPECT_EQ(s.count(), 3);
  EXPECT_EQ(s.text(), "hello");
  EXPECT_TRUE(s.side.is("left"));
  EXPECT_DOUBLE_EQ(s.unit(), 1e-3);
  EXPECT_TRUE(s.file.empty());
  EXPECT_FALSE(s.closing_force.given());
  EXPECT_EQ(set(s.closing_force, "2000 mN"), "");
  EXPECT_DOUBLE_EQ(s.closing_force(), 2);
  EXPECT_TRUE(s.closing_force.given());
  EXPECT_EQ(s.closing_force.text(), "2000 mN");
  EXPECT_EQ(s.closing_force.pos().column, 2);
}

TEST(Param, RangesSpeakTheAuthorsUnit) {
  Sample s;
  EXPECT_EQ(set(s.closing_force, "16 N"), "16 N is outside the allowed range 0.1 N to 5 N");
  EXPECT_EQ(set(s.closing_force, "16000 mN"), "16000 mN is outside the allowed range 100 mN to 5000 mN");
  EXPECT_EQ(set(s.young, "0.5 Pa"), "0.5 Pa is below the allowed minimum 1 Pa");
  EXPECT_EQ(set(s.young, "0.0005 kPa"), "0.0005 kPa is below the allowed minimum 0.001 kPa");
  EXPECT_EQ(set(s.depth, "2 cm"), "2 cm is above the allowed maximum 1 cm");
  EXPECT_EQ(set(s.ratio, "0.5"), "0.5 is outside the allowed range 0 to 0.499");
  EXPECT_EQ(set(s.axis, "0 0 2"), "each of 0 0 2 is outside the allowed range -1 to 1");
}

TEST(Param, BoundsAreInclusiveInAnyUnit) {
  Sample s;
  for (const char* text : {"0.1 N", "5 N", "100 mN", "5000 mN", "0.005 kN", "0.0001 kN"}) {
    EXPECT_EQ(set(s.closing_force, text), "") << text;
    EXPECT_GE(s.closing_force(), 0.1) << text;
    EXPECT_LE(s.closing_force(), 5.0) << text;
  }
  for (const char* text : {"0.0999999 N", "5.000001 N"}) EXPECT_NE(set(s.closing_force, text), "") << text;
}

TEST(Param, ARefusedValueChangesNothing) {
  Sample s;
  s.closing_force.assign_fallback();
  EXPECT_NE(set(s.closing_force, "nonsense"), "");
  EXPECT_DOUBLE_EQ(s.closing_force(), 1.5);
}

TEST(Param, Bool) {
  Sample s;
  EXPECT_EQ(set(s.on, "false"), "");
  EXPECT_FALSE(s.on());
  for (const char* text : {"", "yes", "1", "True", "false x"}) EXPECT_NE(set(s.on, text), "") << text;
}

TEST(Param, WholeNumbers) {
  Sample s;
  EXPECT_EQ(set(s.count, " +7 "), "");
  EXPECT_EQ(s.count(), 7);
  EXPECT_EQ(set(s.count, "0"), "0 is outside the allowed range 1 to 100");
  EXPECT_EQ(set(s.count, "101"), "101 is outside the allowed range 1 to 100");
  EXPECT_EQ(set(s.count, "3.5"), "\"3.5\" is not a whole number");
  EXPECT_EQ(set(s.count, "99999999999"), "\"99999999999\" is too large a number");
  for (const char* text : {"", "1e2", "0x10", "3 m", "1O", "+-3", "--3"}) EXPECT_NE(set(s.count, text), "") << text;
}

TEST(Param, Choices) {
  Sample s;
  EXPECT_EQ(set(s.side, "right"), "");
  EXPECT_EQ(set(s.side, "rigth"), "\"rigth\" is not a choice; did you mean \"right\"? (use one of left, right)");
  EXPECT_EQ(set(s.side, "up"), "\"up\" is not a choice (use one of left, right)");
}

TEST(Param, Vectors) {
  Sample s;
  EXPECT_EQ(set(s.at, "38 0 -15 mm"), "");
  EXPECT_LT((s.at() - Vec3(38e-3, 0, -15e-3)).norm(), 1e-15);
  EXPECT_EQ(set(s.at, "1 2 3m"), "");
  EXPECT_EQ(set(s.axis, "0 1 0"), "");
  for (const char* text :
       {"", "1 2 mm", "1 2 3", "1,2,3 mm", "1 2 3 4 mm", "1 mm 2 mm 3 mm", "1 x 3 mm", "1 2 nan mm", "1 2 3 N"})
    EXPECT_NE(set(s.at, text), "") << text;
  EXPECT_NE(set(s.axis, "0 1 0 mm"), "");
}

TEST(Param, UnitsOfFiles) {
  Sample s;
  EXPECT_EQ(set(s.unit, "cm"), "");
  EXPECT_DOUBLE_EQ(s.unit(), 1e-2);
  EXPECT_EQ(set(s.unit, "inch"), "\"inch\" is not a unit of length (use one of m, cm, mm, um)");
  EXPECT_NE(set(s.unit, ""), "");
}

TEST(Param, References) {
  Sample s;
  Sample a;
  EXPECT_EQ(set(s.one, "left"), "");
  EXPECT_EQ(s.one.ids(), std::vector<std::string>{"left"});
  EXPECT_EQ(s.one.resolve(0, &a), "");
  EXPECT_EQ(s.one.get(), &a);
  EXPECT_EQ(set(s.one, "left right"), "\"left right\" names 2 components; only one is allowed here");
  EXPECT_EQ(set(s.one, " "), "the value is empty; it must name a component");
  EXPECT_EQ(set(s.many, " a  b "), "");
  EXPECT_EQ(s.many.ids().size(), 2u);
  EXPECT_EQ(set(s.many, ""), "");
  EXPECT_NE(set(s.needed, ""), "");
}

template <class T>
struct Holder : Component {
  explicit Holder(ParamSpec spec) : p(this, std::move(spec)) {}
  T p;
};

TEST(Param, WrongDeclarationsAreFoundAtOnce) {
  using Q = Holder<Param<Force>>;
  EXPECT_THROW(Q({.name = "f", .min = "1 Pa", .doc = ""}), std::logic_error);
  EXPECT_THROW(Q({.name = "f", .min = "2 N", .max = "1 N", .doc = ""}), std::logic_error);
  EXPECT_THROW(Q({.name = "id", .doc = ""}), std::logic_error);
  EXPECT_THROW(Q({.name = "", .doc = ""}), std::logic_error);
  Q outside({.name = "f", .fallback = "3 N", .max = "1 N", .doc = ""});
  EXPECT_THROW(outside.p.assign_fallback(), std::logic_error);
  struct Twice : Component {
    Param<bool> a{this, {.name = "a", .doc = ""}};
    Param<bool> b{this, {.name = "a", .doc = ""}};
  };
  EXPECT_THROW(Twice(), std::logic_error);
}

}  // namespace
}  // namespace insula
