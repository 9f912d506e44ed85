// SPDX-License-Identifier: GPL-3.0-or-later
// Shared plugins: a good one loads and works, every other is refused with its reason and leaves no trace.
#include <gtest/gtest.h>

#include <filesystem>
#include <fstream>

#include "core/registry/plugin_loader.h"
#include "core/registry/registry.h"
#include "core/scene/loader.h"

namespace insula {
namespace {
namespace fs = std::filesystem;

const fs::path folder = fs::path(INSULA_BINARY_DIR) / "tests" / "plugin_so";

TEST(SharedPlugin, LoadsAndServesScenes) {
  Registry r;
  ASSERT_EQ(load_plugin(r, folder / "tiny.so"), "");
  const auto* info = r.find("tiny_constraint");
  ASSERT_NE(info, nullptr);
  EXPECT_EQ(info->plugin, "tiny");
  EXPECT_TRUE(load_scene_text("<scene><tiny_constraint strength=\"500 mN\"/></scene>", "x.xml", r).ok());
  const auto bad = load_scene_text("<scene><tiny_constraint strength=\"5 N\"/></scene>", "x.xml", r);
  EXPECT_EQ(bad.diagnostics.format(), "x.xml:1:35: error: strength: 5 N is outside the allowed range 0 N to 2 N\n");
}

TEST(SharedPlugin, AnotherAbiIsRefusedAndBothAreNamed) {
  Registry r;
  const std::string error = load_plugin(r, folder / "tiny_wrong_abi.so");
  EXPECT_NE(error.find("tiny_wrong_abi.so"), std::string::npos) << error;
  EXPECT_NE(error.find("insula 0 of another compiler"), std::string::npos) << error;
  EXPECT_NE(error.find(abi_string()), std::string::npos) << error;
  EXPECT_TRUE(r.all().empty());
}

TEST(SharedPlugin, FailingHalfWayLeavesNothingBehind) {
  Registry r;
  const std::string error = load_plugin(r, folder / "tiny_twice.so");
  EXPECT_NE(error.find("already registered"), std::string::npos) << error;
  EXPECT_TRUE(r.all().empty());
}

TEST(SharedPlugin, SameElementTwiceIsRefused) {
  Registry r;
  ASSERT_EQ(load_plugin(r, folder / "tiny.so"), "");
  EXPECT_NE(load_plugin(r, folder / "tiny.so").find("already registered"), std::string::npos);
  EXPECT_EQ(r.all().size(), 1u);
}

TEST(SharedPlugin, StrangersAreRefused) {
  Registry r;
  EXPECT_NE(load_plugin(r, folder / "stranger.so").find("is not an Insula plugin"), std::string::npos);
  EXPECT_NE(load_plugin(r, folder / "missing.so").find("no such file"), std::string::npos);
  EXPECT_NE(load_plugin(r, folder).find("is not a file"), std::string::npos);
  const fs::path text = fs::path(testing::TempDir()) / "insula_text.so";
  std::ofstream(text) << "I am a text";
  EXPECT_NE(load_plugin(r, text).find("is not a shared library"), std::string::npos);
  std::ofstream(text) << "\177ELF and then nonsense";
  EXPECT_NE(load_plugin(r, text).find("cannot be loaded"), std::string::npos);
  fs::remove(text);
  EXPECT_TRUE(r.all().empty());
}

TEST(SharedPlugin, FolderIsReadInOrder) {
  const auto files = plugin_files(folder);
  ASSERT_EQ(files.size(), 4u);
  EXPECT_EQ(files[0].filename(), "stranger.so");
  EXPECT_EQ(files[1].filename(), "tiny.so");
  EXPECT_TRUE(plugin_files(folder / "nowhere").empty());
}

}  // namespace
}  // namespace insula
