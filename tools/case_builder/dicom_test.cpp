// SPDX-License-Identifier: GPL-3.0-or-later
// DICOM series: read by their threshold; with slices that are missing, there twice, cut off or of another series,
// refused by name.
#ifdef INSULA_WITH_ITK
#include <gtest/gtest.h>

#include "core/base/input_error.h"
#include "tools/case_builder/intake.h"
#include "tools/case_builder/shapes_for_test.h"

namespace insula::case_builder {
namespace {

/// A series of DICOM slices of the tube, but for the one that is left out.
void write_series(const insula::test::SceneFolder& folder, int missing) {
  for (int k = 0; k < 32; ++k)
    if (k != missing)
      folder.write("series/" + std::to_string(k) + ".dcm",
                   test::dicom_text({54, 24}, 0.3, k, [k](int i, int j) { return 900 * test::tube_label(i, j, k); }));
}

TEST(Volumes, ADicomSeriesIsReadByItsThreshold) {
  insula::test::SceneFolder folder;
  write_series(folder, -1);
  Progress quiet;
  Options o;
  o.threshold = 450;
  const Intake in = take_in(folder.path() / "series", o, quiet);
  ASSERT_EQ(in.surface.caps.size(), 2u);
  EXPECT_NEAR(in.surface.caps[0].radius, 1.4, 0.15);
  // Left and posterior of the file are right and anterior of the builder with the other sign: the sac stays on top.
  Vec3 top = Vec3::Zero();
  for (const Vec3& p : in.surface.mesh.vertices) top = p.z() > top.z() ? p : top;
  EXPECT_NEAR(top.x(), -8, 0.8);
  EXPECT_NEAR(top.z(), 2.4 + 3.4 + 2.4, 0.3);
  EXPECT_NEAR(signed_volume(in.surface.mesh), 15.6 * 3.14159 * 1.96 + 45, 15);
}

/// What is said of a series that is refused; empty: it is taken.
std::string refusal(const insula::test::SceneFolder& folder) {
  Progress quiet;
  Options o;
  o.threshold = 450;
  try {
    take_in(folder.path() / "series", o, quiet);
  } catch (const InputError& e) {
    return e.what();
  }
  return "";
}
std::string slice(int k, std::array<int, 2> size, const std::string& series) {
  return test::dicom_text(
      size, 0.3, k, [k](int i, int j) { return 900 * test::tube_label(i, j, k); }, series);
}

TEST(Volumes, AMissingSliceIsNamed) {
  insula::test::SceneFolder folder;
  write_series(folder, 12);
  const std::string said = refusal(folder);
  EXPECT_NE(said.find("even distances (between 11.dcm and 13.dcm)"), std::string::npos) << said;
}

TEST(Volumes, ASliceThatEndsEarlyIsNamed) {
  // Of some 3,100 bytes: within the picture, at its last byte, within the header (on which GDCM aborts), within the
  // meta information.
  for (const std::uintmax_t bytes : {2000, 3000, 300, 200}) {
    insula::test::SceneFolder folder;
    write_series(folder, -1);
    const fs::path cut = folder.path() / "series/7.dcm";
    ASSERT_GT(fs::file_size(cut), bytes);
    fs::resize_file(cut, bytes == 3000 ? fs::file_size(cut) - 1 : bytes);
    const std::string said = refusal(folder);
    EXPECT_NE(said.find("7.dcm"), std::string::npos) << said;
    EXPECT_NE(said.find("ends early"), std::string::npos) << said;
  }
}

TEST(Volumes, MixedSeriesAreListed) {
  insula::test::SceneFolder folder;
  write_series(folder, -1);
  for (int k = 0; k < 5; ++k) folder.write("series/other_" + std::to_string(k) + ".dcm", slice(k, {54, 24}, "1.2.3.7"));
  const std::string said = refusal(folder);
  EXPECT_NE(said.find("holds 2 DICOM series; put one into a folder of its own"), std::string::npos) << said;
  EXPECT_NE(said.find("32 images in"), std::string::npos) << said;
  EXPECT_NE(said.find("5 images in"), std::string::npos) << said;
}

TEST(Volumes, SlicesOfAnotherSizeAreNoPartOfASeries) {
  insula::test::SceneFolder folder;
  write_series(folder, 12);
  folder.write("series/12.dcm", slice(12, {40, 24}, "1.2.3.6"));
  const std::string said = refusal(folder);
  EXPECT_TRUE(said.find("holds 2 DICOM series") != std::string::npos || said.find("another size") != std::string::npos)
      << said;
}

TEST(Volumes, ASliceThatIsThereTwiceIsNamed) {
  insula::test::SceneFolder folder;
  write_series(folder, -1);
  folder.write("series/again.dcm", slice(5, {54, 24}, "1.2.3.6"));
  const std::string said = refusal(folder);
  EXPECT_NE(said.find("at the same place"), std::string::npos) << said;
  EXPECT_NE(said.find("again.dcm"), std::string::npos) << said;
}

}  // namespace
}  // namespace insula::case_builder
#endif
