// SPDX-License-Identifier: GPL-3.0-or-later
// Scans before a vessel is chosen in them: their formats, zipped series, what a page gets to see of them, and that no
// name of a person is kept.
#ifdef INSULA_WITH_ITK
#include <gtest/gtest.h>
#include <zip.h>

#include <nlohmann/json.hpp>

#include "core/base/input_error.h"
#include "core/model/formats/file_bytes.h"
#include "core/testing/example.h"
#include "tools/case_builder/inspect.h"
#include "tools/case_builder/intake.h"
#include "tools/case_builder/paint.h"
#include "tools/case_builder/scan_look.h"
#include "tools/case_builder/shapes_for_test.h"
#include "tools/case_builder/volume_input.h"

namespace insula::case_builder {
namespace {

constexpr std::array<int, 3> tube_size{54, 24, 32};
constexpr const char* person = "Doe^Jane";

std::string nrrd_text(const std::string& more = "") {
  std::string s =
      "NRRD0004\ntype: unsigned char\ndimension: 3\nspace: left-posterior-superior\nsizes: 54 24 32\n"
      "space directions: (0.3,0,0) (0,0.3,0) (0,0,0.3)\nkinds: domain domain domain\nendian: little\n"
      "encoding: raw\nspace origin: (1,2,3)\n" +
      more + "\n";
  for (int k = 0; k < tube_size[2]; ++k)
    for (int j = 0; j < tube_size[1]; ++j)
      for (int i = 0; i < tube_size[0]; ++i) s.push_back(char(test::tube_label(i, j, k)));
  return s;
}

std::string slice(int k, const std::string& name = "") {
  return test::dicom_text(
      {tube_size[0], tube_size[1]}, 0.3, k, [k](int i, int j) { return 900 * test::tube_label(i, j, k); }, "1.2.3.6",
      name);
}

void write_zip(const fs::path& file, const std::vector<std::pair<std::string, std::string>>& files) {
  int code = 0;
  zip_t* z = zip_open(file.c_str(), ZIP_CREATE | ZIP_TRUNCATE, &code);
  ASSERT_TRUE(z);
  for (const auto& [name, bytes] : files)
    zip_file_add(z, name.c_str(), zip_source_buffer(z, bytes.data(), bytes.size(), 0), ZIP_FL_ENC_UTF_8);
  ASSERT_EQ(zip_close(z), 0);
}

/// Whether a text is in any file below a folder.
bool occurs(const fs::path& folder, const std::string& text) {
  for (const auto& entry : fs::recursive_directory_iterator(folder))
    if (entry.is_regular_file() && read_file_bytes(entry.path()).find(text) != std::string::npos) return true;
  return false;
}

class Scan : public testing::Test {
 protected:
  insula::test::SceneFolder folder;
  Progress quiet;
  fs::path zip = folder.path() / "series.zip";
  std::vector<std::pair<std::string, std::string>> series(const std::string& name = "") {
    std::vector<std::pair<std::string, std::string>> out;
    for (int k = 0; k < tube_size[2]; ++k) out.emplace_back("../../IM" + std::to_string(k), slice(k, name));
    return out;
  }
  fs::path written(const std::string& name, const std::string& bytes) {
    folder.write(name, bytes);
    return folder.path() / name;
  }
  std::string refusal(const fs::path& file) {
    try {
      read_any_volume(file);
    } catch (const InputError& e) {
      return e.what();
    }
    return "";
  }
  Json look(const fs::path& file) {
    run_inspect(file, folder.path() / "look", {}, nullptr, quiet);
    return read_json(folder.path() / "look/scan.json");
  }
};

TEST_F(Scan, NrrdIsReadWithItsPlace) {
  const mesh_tool::NiftiVolume v = read_any_volume(written("tube.nrrd", nrrd_text()));
  EXPECT_EQ(v.size, tube_size);
  EXPECT_NEAR(v.to_world[0], -0.3, 1e-12);
  EXPECT_NEAR(v.to_world[3], -1, 1e-12);
  EXPECT_NEAR(v.to_world[7], -2, 1e-12);
  EXPECT_NEAR(v.to_world[11], 3, 1e-12);
  EXPECT_EQ(v.at(27, 12, 8), 1);
}

TEST_F(Scan, ANrrdThatEndsEarlyIsRefused) {
  const std::string text = nrrd_text();
  EXPECT_NE(refusal(written("tube.nrrd", text.substr(0, text.size() - 100))), "");
}

TEST_F(Scan, AZippedSeriesIsReadAndItsPathsAreNotUsed) {
  auto files = series();
  files.emplace_back("README.txt", "made by a scanner");
  write_zip(zip, files);
  const fs::path outside = folder.path().parent_path().parent_path() / "IM0";
  const mesh_tool::NiftiVolume v = read_any_volume(zip);
  EXPECT_EQ(v.size, tube_size);
  EXPECT_EQ(v.at(27, 12, 8), 900);
  EXPECT_FALSE(fs::exists(outside));
  for (const auto& entry : fs::directory_iterator(folder.path()))
    EXPECT_FALSE(entry.path().filename().string().starts_with(".series")) << "what was unpacked goes again";
}

TEST_F(Scan, AZipWithoutASeriesIsRefused) {
  write_zip(zip, {{"a.txt", "text"}, {"b.sh", "#!/bin/sh\n"}});
  EXPECT_NE(refusal(zip).find("holds no DICOM images"), std::string::npos) << refusal(zip);
  EXPECT_NE(refusal(written("no.zip", "PK\3\4 nothing")).find("is no zip"), std::string::npos);
  auto files = series();
  files.erase(files.begin() + 12);
  write_zip(zip, files);
  EXPECT_NE(refusal(zip).find("series.zip: its slices do not stand at even distances"), std::string::npos)
      << refusal(zip);
}

TEST_F(Scan, ABombIsNotUnpacked) {
  write_zip(zip, series());
  std::string bytes = read_file_bytes(zip);
  // The unpacked size of the first file, in the list at the end: 24 bytes behind its mark.
  const std::size_t list = bytes.find("PK\1\2");
  ASSERT_NE(list, std::string::npos);
  for (const auto& [size, said] :
       {std::pair(4'000'000'000u, "more than 1000000000 bytes"), std::pair(100u, "damaged")}) {
    std::memcpy(bytes.data() + list + 24, &size, 4);
    EXPECT_NE(refusal(written("bomb.zip", bytes)).find(said), std::string::npos) << refusal(folder.path() / "bomb.zip");
  }
}

TEST_F(Scan, NobodysNameIsKept) {
  write_zip(zip, series(person));
  ASSERT_NE(slice(0, person).find(person), std::string::npos);
  look(zip);
  folder.write("named.nrrd", nrrd_text("patient:=Doe^Jane\n"));
  run_inspect(folder.path() / "named.nrrd", folder.path() / "look/nrrd", {}, nullptr, quiet);
  EXPECT_FALSE(occurs(folder.path() / "look", person));
  EXPECT_FALSE(occurs(folder.path() / "look", "1.2.3.6")) << "nor the number of the series";
  // What is made of it says so.
  Options o;
  o.threshold = 450;
  const Intake in = take_in(zip, o, quiet);
  EXPECT_NE(to_json(in.notes).dump().find("No other tags were copied"), std::string::npos);
}

TEST_F(Scan, TheNamelessCopyIsTheSameVolume) {
  // Left-anterior-superior, with steps of three lengths, turned about the first axis.
  mesh_tool::NiftiVolume v;
  v.size = {3, 4, 5};
  const double c = std::cos(0.3), s = std::sin(0.3);
  v.to_world = {-0.5, 0, 0, 7, 0, 0.6 * c, -0.7 * s, 8, 0, 0.6 * s, 0.7 * c, -9.123456789};
  for (const auto& [scale, shift] : {std::pair(1.0f, 0.0f), std::pair(-3.0f, 2.0f), std::pair(0.25f, 0.0f)}) {
    v.value.clear();
    for (int k = 0; k < 60; ++k) v.value.push_back(scale * float(k) + shift);
    write_nameless(folder.path() / "copy.mha", v);
    const mesh_tool::NiftiVolume read = read_any_volume(folder.path() / "copy.mha");
    EXPECT_EQ(read.size, v.size);
    EXPECT_EQ(read.value, v.value);
    for (std::size_t k = 0; k < 12; ++k) EXPECT_NEAR(read.to_world[k], v.to_world[k], 1e-9) << k;
  }
}

TEST_F(Scan, IsShownWithValuesThresholdAndAxes) {
  folder.write("grey.nii", test::nifti_text(tube_size, 0.3, [](int i, int j, int k) {
                 return test::tube_label(i, j, k) ? 100 + (i + j) % 20 : 10 + (i * 7 + k * 3) % 20;
               }));
  const Json facts = look(folder.path() / "grey.nii");
  EXPECT_EQ(facts["size"], (Json{54, 24, 32}));
  EXPECT_EQ(facts["axes"], "RAS");
  EXPECT_EQ(facts["values"]["least"], 10);
  EXPECT_EQ(facts["values"]["most"], 119);
  EXPECT_TRUE(facts["labels"].empty() || facts["labels"].size() > 2);
  EXPECT_GT(facts["threshold"], 30);
  EXPECT_LT(facts["threshold"], 100);
  std::uint64_t all = 0;
  for (const Json& n : facts["histogram"]["counts"]) all += n.get<std::uint64_t>();
  EXPECT_EQ(all, 54u * 24 * 32);
  EXPECT_EQ(read_file_bytes(folder.path() / "look/scan.raw").size(), 54u * 24 * 32);
}

TEST_F(Scan, LabelsAreCounted) {
  folder.write("labels.nii", test::nifti_text({10, 10, 10}, 0.3, [](int i, int, int) {
                 return i < 2 ? 7 : i < 5 ? 3 : 0;
               }));
  EXPECT_EQ(look(folder.path() / "labels.nii")["labels"],
            (Json{{{"label", 3}, {"voxels", 300}}, {{"label", 7}, {"voxels", 200}}}));
}

/// The block lies to the right, forward and up, whatever axes the file has; where a voxel lies is told by its place.
TEST_F(Scan, TheBlockIsTurnedAndHasItsPlace) {
  mesh_tool::NiftiVolume v;
  v.size = {2, 300, 4};
  // First axis up, second to the left, third backwards.
  v.to_world = {0, -0.5, 0, 50, 0, 0, -2, 6, 1, 0, 0, -3};
  const auto x_of = [](int j) { return 50 - 0.5 * j; };
  for (int k = 0; k < 4; ++k)
    for (int j = 0; j < 300; ++j)
      for (int i = 0; i < 2; ++i) v.value.push_back(float(100 * k + 1000 * i) - float(2 * x_of(j)));
  const ScanLook look = look_at(v);
  EXPECT_EQ(look.facts["axes"], "SLP");
  const Json& block = look.facts["block"];
  EXPECT_EQ(block["size"], (Json{150, 4, 2}));
  EXPECT_EQ(block["bytes"], 2);
  ASSERT_EQ(look.block.size(), 2u * 150 * 4 * 2);
  const std::vector<double> m = block["to_world"];
  for (const auto& [i, j, k] : {std::array{0, 0, 0}, std::array{149, 3, 1}, std::array{20, 1, 0}}) {
    const double x = m[0] * i + m[3], y = m[5] * j + m[7], z = m[10] * k + m[11];
    std::int16_t stored = 0;
    std::memcpy(&stored, look.block.data() + 2 * (i + 150 * (j + 4 * k)), 2);
    const double value = block["offset"].get<double>() + block["scale"].get<double>() * stored;
    EXPECT_NEAR(value, 100 * (6 - y) / 2 + 1000 * (z + 3) - 2 * x, 0.6) << i << " " << j << " " << k;
  }
}

TEST_F(Scan, OnlyWhatIsNearTheSeedIsTaken) {
  folder.write("tube.nii",
               test::nifti_text(tube_size, 0.3, [](int i, int j, int k) { return test::tube_label(i, j, k); }));
  Options o;
  o.label = 1;
  o.seed = Point{8, 3.6, 2.4};
  o.around = 7;
  const Intake in = take_in(folder.path() / "tube.nii", o, quiet);
  ASSERT_EQ(in.surface.caps.size(), 2u);
  for (const artery::CapPlane& cap : in.surface.caps) EXPECT_NEAR(std::abs(cap.centre.x() - 8), 7, 0.7);
  o.seed = Point{80, 3.6, 2.4};
  EXPECT_THROW(take_in(folder.path() / "tube.nii", o, quiet), InputError);
  o.seed.reset();
  EXPECT_THROW(take_in(folder.path() / "tube.nii", o, quiet), InputError);
}

/// A branch is painted onto the tube, and the sac is erased.
TEST_F(Scan, StrokesArePaintedAndErased) {
  folder.write("tube.nii",
               test::nifti_text({54, 64, 32}, 0.3, [](int i, int j, int k) { return test::tube_label(i, j - 30, k); }));
  folder.write("paint.json",
               R"([{"erase": false, "radius_mm": 1.2, "points": [[4, 12.6, 2.4], [4, 6, 2.4], [4, 1, 2.4]]},
                   {"erase": true, "radius_mm": 2.6, "points": [[8, 12.6, 6.4]]}])");
  Options o;
  o.label = 1;
  o.paint = read_strokes(folder.path() / "paint.json");
  EXPECT_EQ(to_json(options_from_json(to_json(o))), to_json(o));
  for (const bool mirrored : {false, true}) {
    o.mirror = mirrored;
    const Intake in = take_in(folder.path() / "tube.nii", o, quiet);
    Vec3 low = Vec3::Constant(1e9), high = -low;
    for (const Vec3& p : in.surface.mesh.vertices) low = low.cwiseMin(p), high = high.cwiseMax(p);
    EXPECT_NEAR(low.y(), 0.5, 0.7) << "the branch, whose round end at -0.2 is cut";
    EXPECT_EQ(in.surface.caps.size(), 3u);
    EXPECT_LT(high.z(), 5) << "the sac was 8.2 mm high";
    EXPECT_NE(to_json(in.notes).dump().find("by hand with 2 strokes"), std::string::npos);
  }
  for (const char* wrong : {"{}", "[1]", R"([{"erase": true, "radius_mm": 99, "points": [[0, 0, 0]]}])",
                            R"([{"erase": true, "radius_mm": 1, "points": []}])"}) {
    folder.write("paint.json", wrong);
    EXPECT_THROW(read_strokes(folder.path() / "paint.json"), InputError) << wrong;
  }
}

TEST_F(Scan, RoundEndsAreCutAndCanBeCutFartherIn) {
  // It ends round before the border.
  folder.write("round.nii", test::nifti_text({64, 24, 32}, 0.3, [](int i, int j, int k) {
                 return i > 6 && i < 56 ? test::tube_label(i - 5, j, k) : 0;
               }));
  Options o;
  o.label = 1, o.smoothing = 3;
  const Inspection found = inspect(folder.path() / "round.nii", o, quiet);
  EXPECT_EQ(found.facts["openings"].size(), 2u) << found.facts["openings"];
  EXPECT_EQ(found.facts["problem"], "");
  o.cuts = {{6, 3.6, 2.4, -1, 0, 0}, {12, 3.6, 2.4, 1, 0, 0}};
  const Json openings = inspect(folder.path() / "round.nii", o, quiet).facts["openings"];
  ASSERT_EQ(openings.size(), 2u);
  const double a = openings[0]["centre"][0], b = openings[1]["centre"][0];
  EXPECT_NEAR(std::min(a, b), 6, 0.05);
  EXPECT_NEAR(std::max(a, b), 12, 0.05);
}

TEST_F(Scan, AVesselWithoutOpeningsIsShownSoThatItCanBeCut) {
  folder.write("ball.nii", test::nifti_text({40, 40, 40}, 0.3, [](int i, int j, int k) {
                 return std::hypot(i - 20, j - 20, k - 20) < 12 ? 1 : 0;
               }));
  Options o;
  o.label = 1;
  const Inspection found = inspect(folder.path() / "ball.nii", o, quiet);
  EXPECT_TRUE(found.facts["openings"].empty()) << found.facts["openings"];
  EXPECT_NE(found.facts["problem"].get<std::string>().find("cut its ends"), std::string::npos);
  EXPECT_GT(found.surface.triangles.size(), 500u);
}

}  // namespace
}  // namespace insula::case_builder
#endif
