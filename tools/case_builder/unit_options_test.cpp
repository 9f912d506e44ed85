// SPDX-License-Identifier: GPL-3.0-or-later
// Options with units: their values, and the advice of each error message.
#include "tools/case_builder/unit_options.h"

#include <gtest/gtest.h>

namespace insula::case_builder {
namespace {

const QuantityOption gap{.bare = "mm", .min = "0.1 mm", .max = "2 mm", .doc = {}};

std::string gap_error(const std::string& text) {
  std::string error;
  EXPECT_FALSE(read_with_unit(text, Length::units(), Length::name, gap, error)) << text;
  return error;
}

TEST(UnitOptions, LengthsAreReadInTheUnitOfTheOption) {
  std::string error;
  EXPECT_NEAR(read_with_unit("0.4 mm", Length::units(), Length::name, gap, error).value(), 0.4, 1e-15);
  EXPECT_NEAR(read_with_unit("400um", Length::units(), Length::name, gap, error).value(), 0.4, 1e-15);
  EXPECT_EQ(gap_error("0.4"), "\"0.4\" has no unit; write \"0.4 mm\"");
  EXPECT_NE(gap_error("3 mm").find("3 mm is outside the allowed range 0.1 mm to 2 mm"), std::string::npos);
  EXPECT_NE(gap_error("1 deg").find("\"deg\" is not a unit of length"), std::string::npos);
}

TEST(UnitOptions, PointsAndPlanesAreReadInMillimetres) {
  std::string error;
  using Numbers = std::vector<double>;
  EXPECT_EQ(read_shape("30 -20 55 mm", Shape::point, error), Numbers({30, -20, 55}));
  EXPECT_EQ(read_shape("3 -2 5.5cm", Shape::point, error).value()[1], -20);
  EXPECT_EQ(read_shape("12 4 -3 mm 0 0 -1", Shape::plane, error), Numbers({12, 4, -3, 0, 0, -1}));
  EXPECT_EQ(read_shape("1 2 3 mm 4 5 6 mm", Shape::two_points, error), Numbers({1, 2, 3, 4, 5, 6}));
}

TEST(UnitOptions, ErrorForAShapeWithoutUnitsShowsTheUnits) {
  const auto error_of = [](const char* text, Shape shape) {
    std::string error;
    EXPECT_FALSE(read_shape(text, shape, error)) << text;
    return error;
  };
  EXPECT_EQ(error_of("30 -20 55", Shape::point), "\"30 -20 55\" has no unit; write \"30 -20 55 mm\"");
  EXPECT_EQ(error_of("12 4 -3 0 0 -1", Shape::plane), "\"12 4 -3 0 0 -1\" has no unit; write \"12 4 -3 mm 0 0 -1\"");
  EXPECT_EQ(error_of("1 2 3 4 5 6", Shape::two_points), "\"1 2 3 4 5 6\" has no unit; write \"1 2 3 mm 4 5 6 mm\"");
  for (const char* wrong : {"", "1 2 mm", "1 2 3 N 0 0 1", "1 2 3 mm 0 0", "1 2 3 mm 0 0 1 4", "1 2 3 mm 0 0 1 mm"})
    EXPECT_NE(error_of(wrong, Shape::plane).find("is not of the form \"X Y Z mm NX NY NZ\""), std::string::npos);
}

TEST(UnitOptions, UnitsOfFiles) {
  std::string error;
  EXPECT_EQ(read_file_unit("m", error), 1000);
  EXPECT_EQ(read_file_unit("inch", error), 25.4);
  EXPECT_EQ(read_file_unit("0.35 mm", error), 0.35);
  EXPECT_FALSE(read_file_unit("0.35", error));
  EXPECT_EQ(error, "\"0.35\" has no unit; write \"0.35 mm\"");
  EXPECT_FALSE(read_file_unit("furlong", error));
  EXPECT_EQ(error, "\"furlong\" is no unit; write m, cm, mm, um, inch or a length");
}

TEST(UnitOptions, WordsOfAValueAreJoined) {
  using Words = std::vector<std::string>;
  const Words options{"--seed", "--gap"};
  EXPECT_EQ(joined_values({"new", "--seed", "30", "-20", "55", "mm", "a.stl"}, options),
            Words({"new", "--seed", "30 -20 55 mm", "a.stl"}));
  EXPECT_EQ(joined_values({"--gap", "0.4", "mm", "--label", "1", "12"}, options),
            Words({"--gap", "0.4 mm", "--label", "1", "12"}));
  EXPECT_EQ(joined_values({"--gap", "0.4 mm", "case"}, options), Words({"--gap", "0.4 mm", "case"}));
}

}  // namespace
}  // namespace insula::case_builder
