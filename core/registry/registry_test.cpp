// SPDX-License-Identifier: GPL-3.0-or-later
// The registry, and the bounds of every parameter of every element there is.
#include "core/registry/registry.h"

#include <fmt/format.h>
#include <gtest/gtest.h>

#include <cmath>
#include <stdexcept>

#include "core/base/text.h"

namespace insula {
namespace {

struct Plain : Component {
  Param<Force> force{this, {.name = "force", .fallback = "1 N", .min = "0.1 N", .max = "5 N", .doc = "force"}};
};
struct BadDefault : Component {
  Param<Force> force{this, {.name = "force", .fallback = "9 N", .max = "5 N", .doc = "force"}};
};

TEST(Registry, AddFindCreate) {
  Registry r;
  r.set_current_plugin("p");
  r.add<Plain>("plain", Kind::constraint, "a plain thing");
  const ComponentInfo* info = r.find("plain");
  ASSERT_NE(info, nullptr);
  EXPECT_EQ(info->plugin, "p");
  EXPECT_EQ(info->parents, std::vector<Kind>{Kind::scene});
  const auto made = r.create("plain");
  ASSERT_NE(made, nullptr);
  EXPECT_EQ(made->element, "plain");
  EXPECT_EQ(made->kind, Kind::constraint);
  EXPECT_DOUBLE_EQ(dynamic_cast<Plain&>(*made).force(), 1.0);
  EXPECT_EQ(r.create("plane"), nullptr);
  EXPECT_EQ(r.find("plane"), nullptr);
}

TEST(Registry, OrderDoesNotDependOnTheOrderOfAdding) {
  Registry a, b;
  a.add<Plain>("x", Kind::constraint, "");
  a.add<Plain>("y", Kind::body, "");
  b.add<Plain>("y", Kind::body, "");
  b.add<Plain>("x", Kind::constraint, "");
  ASSERT_EQ(a.all().size(), 2u);
  for (std::size_t i = 0; i < 2; ++i) EXPECT_EQ(a.all()[i]->element, b.all()[i]->element);
  EXPECT_EQ(a.all()[0]->element, "y");
}

TEST(Registry, RefusesWhatCannotWork) {
  Registry r;
  r.add<Plain>("plain", Kind::constraint, "");
  EXPECT_THROW(r.add<Plain>("plain", Kind::body, ""), std::logic_error);
  EXPECT_THROW(r.add<BadDefault>("bad_default", Kind::body, ""), std::logic_error);
  EXPECT_THROW(r.add<Plain>("not a name", Kind::body, ""), std::logic_error);
  EXPECT_THROW(r.add<Plain>("include", Kind::body, ""), std::logic_error);
  EXPECT_EQ(r.all().size(), 1u);
}

// --- contract of every element ------------------------------------------------------------------------------------

class EveryElement : public testing::Test {
 protected:
  void SetUp() override { register_builtin(registry_); }
  Registry registry_;
};

TEST_F(EveryElement, HasDocsAndKnownParents) {
  EXPECT_FALSE(registry_.all().empty());
  for (const auto* info : registry_.all()) {
    EXPECT_FALSE(info->doc.empty()) << info->element;
    EXPECT_EQ(info->doc.find('\n'), std::string::npos) << info->element;
    EXPECT_EQ(info->parents.empty(), info->kind == Kind::scene) << info->element;
    const auto made = registry_.create(info->element);
    for (const ParamBase* p : made->params()) {
      EXPECT_FALSE(p->spec().doc.empty()) << info->element << " " << p->name();
      EXPECT_EQ(p->spec().doc.find('\n'), std::string::npos) << info->element << " " << p->name();
    }
  }
}

/// The declared bound moved outwards by a millionth of itself (or of the range), in the bound's own unit.
std::string just_outside(const QuantityParam& p, std::string_view bound, bool lower) {
  const double si = lower ? *p.min() : *p.max();
  const double width = p.min() && p.max() ? *p.max() - *p.min() : std::abs(si);
  const double step = 1e-6 * (si != 0 ? std::abs(si) : width > 0 ? width : 1.0);
  double factor = 1;
  std::string symbol;
  const auto words = split_blanks(bound);
  for (std::size_t i = 1; i < words.size(); ++i) symbol += (i > 1 ? " " : "") + std::string(words[i]);
  for (const auto& u : p.units())
    if (u.symbol == symbol) factor = u.to_si;
  return fmt::format("{:.17g} {}", (si + (lower ? -step : step)) / factor, symbol);
}

TEST_F(EveryElement, NumbersAcceptTheirBoundsAndNothingBeyond) {
  int bounds = 0;
  for (const auto* info : registry_.all()) {
    const auto made = registry_.create(info->element);
    for (ParamBase* base : made->params()) {
      const std::string name = info->element + " " + base->name();
      const auto& spec = base->spec();
      if (!base->required() && !spec.fallback->empty()) {
        EXPECT_EQ(base->assign(*spec.fallback, {}), "") << name;
      }
      const auto* quantity = dynamic_cast<QuantityParam*>(base);
      const auto* whole = dynamic_cast<Param<int>*>(base);
      if (!quantity && !whole) continue;
      for (const bool lower : {true, false}) {
        const std::string_view bound = lower ? spec.min : spec.max;
        if (bound.empty()) continue;
        ++bounds;
        EXPECT_EQ(base->assign(bound, {}), "") << name << " at its bound " << bound;
        std::string outside;
        if (quantity) outside = just_outside(*quantity, bound, lower);
        else outside = std::to_string(std::stoll(std::string(bound)) + (lower ? -1 : 1));
        EXPECT_NE(base->assign(outside, {}), "") << name << " took " << outside;
      }
      for (const char* nonsense : {"", "nan", "inf", "abc", "1e999", "12O0", "0,5"})
        EXPECT_NE(base->assign(nonsense, {}), "") << name << " took " << nonsense;
    }
  }
  EXPECT_GT(bounds, 0);
}

TEST_F(EveryElement, ChoicesAreTaken) {
  for (const auto* info : registry_.all()) {
    const auto made = registry_.create(info->element);
    for (ParamBase* p : made->params()) {
      if (!dynamic_cast<Param<Choice>*>(p)) continue;
      EXPECT_FALSE(p->spec().choices.empty()) << info->element << " " << p->name();
      for (const auto choice : p->spec().choices)
        EXPECT_EQ(p->assign(choice, {}), "") << info->element << " " << choice;
    }
  }
}

}  // namespace
}  // namespace insula
