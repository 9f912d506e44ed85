// SPDX-License-Identifier: GPL-3.0-or-later
// Scans on the page of the case builder: what is taken and what is refused, that the author's file goes once its voxels
// are known, and that a crash loses nothing.
#include <zlib.h>

#include <nlohmann/json.hpp>

#include "core/base/input_error.h"
#include "viewer/gateway/scan_kind.h"
#include "viewer/gateway/studio_choices.h"
#include "viewer/gateway/studio_for_test.h"

namespace insula::gateway {
namespace {

std::string nifti(const char* magic = "n+1", bool big = false) {
  std::string s(400, '\0');
  if (big) s[2] = 1, s[3] = 0x5c;
  else s[0] = 0x5c, s[1] = 1;
  return s.replace(344, 3, magic);
}

std::string packed(const std::string& bytes) {
  z_stream z{};
  std::string out(bytes.size() + 100, '\0');
  deflateInit2(&z, 6, Z_DEFLATED, 16 + MAX_WBITS, 8, Z_DEFAULT_STRATEGY);
  z.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data()));
  z.avail_in = uInt(bytes.size());
  z.next_out = reinterpret_cast<Bytef*>(out.data());
  z.avail_out = uInt(out.size());
  deflate(&z, Z_FINISH);
  out.resize(z.total_out);
  deflateEnd(&z);
  return out;
}

const std::string meta = "ObjectType = Image\nNDims = 3\nDimSize = 2 2 2\nElementType = MET_SHORT\nElementDataFile = ";

TEST(ScanKind, IsToldByContent) {
  EXPECT_EQ(scan_kind(nifti()).extension, ".nii");
  EXPECT_EQ(scan_kind(nifti("n+1", true)).extension, ".nii");
  EXPECT_EQ(scan_kind(packed(nifti())).extension, ".nii.gz");
  EXPECT_EQ(scan_kind(meta + "LOCAL\n" + std::string(16, '\1')).extension, ".mha");
  EXPECT_EQ(scan_kind("NRRD0004\ntype: short\n\n").extension, ".nrrd");
  EXPECT_EQ(scan_kind("PK\x03\x04").extension, ".zip");
  EXPECT_EQ(scan_kind(std::string(128, '\0') + "DICM\2\0").extension, ".dcm");
}

TEST(ScanKind, WhatNeedsOtherFilesIsRefused) {
  for (const std::string& bytes : {nifti("ni1"), meta + "../../etc/passwd\n", meta + "LIST\n",
                                   std::string("NRRD0004\ndata file: /etc/passwd\n\n")})
    EXPECT_NE(scan_kind(bytes).refused.find("needs another file"), std::string::npos) << bytes;
  EXPECT_NE(scan_kind(packed("#!/bin/sh\n")).refused.find("no scan"), std::string::npos);
  EXPECT_NE(scan_kind("\x1f\x8b damaged").refused.find("no scan"), std::string::npos);
  for (const std::string& bytes : {std::string("solid a\n"), std::string("v 0 0 0\n"), std::string(400, '\0')}) {
    EXPECT_EQ(scan_kind(bytes).extension, "") << bytes;
    EXPECT_EQ(scan_kind(bytes).refused, "") << bytes;
  }
}

TEST(StudioChoices, OfAScanAreOptionsOfTheCommand) {
  using Words = std::vector<std::string>;
  const json c = changed_choices(first_choices(), {{"threshold", -123.25}, {"seed", {1, 2, 3}}, {"around_mm", 30}});
  EXPECT_EQ(intake_words(c), (Words{"--threshold", "-123.25", "--seed", "1.000 2.000 3.000 mm", "--around", "30 mm"}));
  EXPECT_EQ(intake_words(changed_choices(first_choices(), {{"label", 3}})), (Words{"--label", "3"}));
  EXPECT_TRUE(intake_words(changed_choices(first_choices(), {{"around_mm", 30}})).empty()) << "around nothing";
  for (const json& wrong : {json{{"threshold", "1; rm"}}, json{{"label", 1.5}}, json{{"label", 0}},
                            json{{"seed", {1, 2}}}, json{{"around_mm", 1}}, json{{"threshold", 3}, {"label", 1}}})
    EXPECT_THROW(changed_choices(first_choices(), wrong), InputError) << wrong;
}

class StudioScan : public StudioTest {
 protected:
  fs::path in(const std::string& name) { return folder_.path() / "data/studio" / name; }
  static std::string text(const fs::path& file) {
    std::ifstream stream(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(stream), {}};
  }
};

TEST_F(StudioScan, IsReadOnceAndTheAuthorsFileGoes) {
  const std::string name = upload("head.stl", nifti())["name"];
  json now = wait(name, "scan");
  EXPECT_EQ(now["scan"]["state"], "done") << now;
  EXPECT_EQ(now["scan"]["facts"]["threshold"], 7);
  EXPECT_FALSE(fs::exists(in(name) / "upload"));
  EXPECT_EQ(text(in(name) / "input.mha"), "scan\n");
  EXPECT_EQ(studio_->file("scan", "name=" + name), in(name) / "scan/scan.raw");
  EXPECT_EQ(now["inspect"]["state"], "waiting") << "for a threshold";
  EXPECT_EQ(ask("build", name).status, 409);
  ask("choose", name, {{"choices", {{"threshold", 9}}}});
  now = wait(name, "inspect");
  EXPECT_EQ(now["inspect"]["state"], "done") << now;
  EXPECT_NE(text(folder_.path() / "bin/asked").find("input.mha"), std::string::npos);
  EXPECT_NE(now["command"].get<std::string>().find("--threshold 9"), std::string::npos);
  EXPECT_EQ(ask("undo", name).status, 200);
  EXPECT_EQ(project(name)["inspect"]["state"], "waiting");
  EXPECT_TRUE(project(name)["inspect"]["facts"].is_null());
}

TEST_F(StudioScan, StrokesAreGivenToTheBuilder) {
  const std::string name = upload("scan.nii", nifti())["name"];
  wait(name, "scan");
  const json stroke{{"erase", false}, {"radius_mm", 1.5}, {"points", {{1, 2, 3}, {2, 2, 3}}}};
  EXPECT_EQ(ask("choose", name, {{"choices", {{"threshold", 9}, {"paint", {stroke}}}}}).status, 200);
  wait(name, "inspect");
  EXPECT_EQ(json::parse(text(in(name) / "paint.json")), json{stroke});
  EXPECT_NE(text(folder_.path() / "bin/asked").find("--paint " + (in(name) / "paint.json").string()),
            std::string::npos);
  ask("choose", name, {{"choices", {{"paint", {stroke, stroke}}}}});
  const json now = wait(name, "inspect");
  EXPECT_EQ(now["inspect"]["number"], 2) << "another stroke is another surface";
  EXPECT_NE(now["command"].get<std::string>().find("--paint paint.json"), std::string::npos);
  json wrong = stroke;
  wrong["points"] = {{1, 2}};
  EXPECT_EQ(ask("choose", name, {{"choices", {{"paint", {wrong}}}}}).status, 400);
  wrong["points"] = json::array();
  EXPECT_EQ(ask("choose", name, {{"choices", {{"paint", {wrong}}}}}).status, 400);
}

TEST_F(StudioScan, ARefusedOneGoes) {
  behave("refuse");
  const std::string name = upload("series.zip", "PK\x03\x04")["name"];
  const json now = wait(name, "scan");
  EXPECT_EQ(now["scan"]["state"], "failed");
  EXPECT_EQ(now["scan"]["error"], "holds 2 DICOM series");
  EXPECT_FALSE(fs::exists(in(name) / "upload"));
}

TEST_F(StudioScan, ACrashLosesNothing) {
  behave("crash");
  const std::string name = upload("scan.nii", nifti())["name"];
  EXPECT_EQ(wait(name, "scan")["scan"]["state"], "failed");
  EXPECT_EQ(text(in(name) / "upload/scan.nii"), nifti());
  behave("");
  EXPECT_EQ(ask("again", name).status, 200);
  EXPECT_EQ(wait(name, "scan")["scan"]["state"], "done");
  ask("choose", name, {{"choices", {{"threshold", 9}}}});
  EXPECT_EQ(wait(name, "inspect")["inspect"]["state"], "done");
  restart();
  EXPECT_EQ(project(name)["choices"]["threshold"], 9);
  EXPECT_EQ(project(name)["scan"]["facts"]["threshold"], 7);
}

TEST_F(StudioScan, WhatAnEarlierRunLeftIsRemoved) {
  const fs::path left = studio_->incoming();
  std::ofstream(left) << "half a scan";
  restart();
  EXPECT_FALSE(fs::exists(left));
}

}  // namespace
}  // namespace insula::gateway
