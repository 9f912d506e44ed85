// SPDX-License-Identifier: GPL-3.0-or-later
// Lists of numbers: one unit for all, the range of each, and what is refused.
#include "core/params/list.h"

#include <gtest/gtest.h>

namespace insula {
namespace {

struct Lists : ParamSet {
  Param<List<Length>> lengths{this, {.name = "lengths", .fallback = "", .min = "1 mm", .max = "1 m", .doc = "lengths"}};
  Param<List<Scalar>> plain{this, {.name = "plain", .fallback = "1 2", .doc = "plain numbers"}};
  Param<List<int>> seeds{this, {.name = "seeds", .fallback = "", .min = "0", .max = "9", .doc = "whole numbers"}};
};

TEST(ListParam, OneUnitStandsForAll) {
  Lists l;
  EXPECT_EQ(l.lengths.assign(" 1 3  7.5 cm", {}), "");
  EXPECT_EQ(l.lengths(), (std::vector<double>{0.01, 0.03, 0.075}));
  EXPECT_EQ(l.lengths.assign("2 4mm", {}), "");
  EXPECT_EQ(l.lengths(), (std::vector<double>{0.002, 0.004}));
  EXPECT_EQ(l.plain.assign("1 -2e1", {}), "");
  EXPECT_EQ(l.plain(), (std::vector<double>{1, -20}));
  EXPECT_EQ(l.seeds.assign("3 1 2", {}), "");
  EXPECT_EQ(l.seeds(), (std::vector<int>{3, 1, 2}));
}

TEST(ListParam, DefaultsAreRead) {
  Lists l;
  for (ParamBase* p : l.params()) p->assign_fallback();
  EXPECT_TRUE(l.lengths().empty());
  EXPECT_EQ(l.plain(), (std::vector<double>{1, 2}));
}

TEST(ListParam, WhatIsRefused) {
  Lists l;
  EXPECT_EQ(l.lengths.assign("1 2", {}), "\"1\" has no unit; a length needs one of m, cm, mm, um");
  EXPECT_EQ(l.lengths.assign("", {}), "the value is empty");
  EXPECT_EQ(l.lengths.assign("mm", {}), "\"mm\" is not a number");
  EXPECT_EQ(l.lengths.assign("1 2 N", {}), "\"N\" is not a unit of length (use one of m, cm, mm, um)");
  EXPECT_NE(l.lengths.assign("1 0,5 mm", {}), "");
  EXPECT_NE(l.lengths.assign("1 cm 3 mm", {}), "");
  EXPECT_EQ(l.lengths.assign("1 2000 mm", {}), "2000 mm is outside the allowed range 1 mm to 1000 mm");
  EXPECT_EQ(l.seeds.assign("1 2.5", {}), "\"2.5\" is not a whole number");
  EXPECT_EQ(l.seeds.assign("1 12", {}), "12 is outside the allowed range 0 to 9");
  EXPECT_NE(l.seeds.assign(std::string(4000, '1').append(" 1"), {}), "");
}

}  // namespace
}  // namespace insula
